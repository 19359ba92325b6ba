/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Support points of the shapes, once for each number type. The includer defines REAL (the type), FN (the functions'
 * names), ROOT, POWER, and the function FN(farthest), the support point of a polytope. */

/* Returns h with the sign of d; at zero by the tie rule. */
static inline REAL FN(toward)(REAL d, ccd_real_t h, int tie)
{
    if (d > 0)
        return h;
    if (d < 0)
        return -h;
    return tie == SHAPE_TIE_CENTRE ? (REAL)0 : (REAL)copysign((double)h, (double)d);
}

/* Rim point of a disc of radius r in the xy plane; the zero direction is a tie. */
static inline void FN(rim)(const REAL d[3], ccd_real_t r, int tie, REAL v[3])
{
    REAL l = ROOT(d[0] * d[0] + d[1] * d[1]);
    if (l > 0) {
        v[0] = r * (d[0] / l);
        v[1] = r * (d[1] / l);
    } else {
        v[0] = tie == SHAPE_TIE_CENTRE ? (REAL)0 : (REAL)copysign((double)r, (double)d[0]);
        v[1] = 0;
    }
}

/* A function of its own, and the other inline: benchmarks count the instructions of users' shapes. */
__attribute__((noinline)) static void FN(hard_support)(const shape_t *s, const REAL d[3], REAL v[3]);

/* Support point in the local frame for a local direction of any length. */
__attribute__((always_inline)) static inline void FN(local_support)(const shape_t *s, const REAL d[3], REAL v[3])
{
    const ccd_real_t *p = s->p;
    REAL l, e[3];
    switch (s->type) {
    case SHAPE_SPHERE:
    case SHAPE_CAPSULE:
        l = ROOT(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        l = l > 0 ? p[0] / l : (REAL)0;
        v[0] = d[0] * l;
        v[1] = d[1] * l;
        v[2] = d[2] * l;
        if (s->type == SHAPE_CAPSULE)
            v[2] += FN(toward)(d[2], p[1], s->tie);
        break;
    case SHAPE_BOX:
        v[0] = FN(toward)(d[0], p[0], s->tie);
        v[1] = FN(toward)(d[1], p[1], s->tie);
        v[2] = FN(toward)(d[2], p[2], s->tie);
        break;
    case SHAPE_CYLINDER:
        FN(rim)(d, p[0], s->tie, v);
        v[2] = FN(toward)(d[2], p[1], s->tie);
        break;
    case SHAPE_CONE: {
        /* apex against rim: equal along a slant line, then its middle or the apex */
        FN(rim)(d, p[0], s->tie, v);
        v[2] = -p[1];
        REAL gain = 2 * p[1] * d[2] - (v[0] * d[0] + v[1] * d[1]);
        if (gain > 0 || (gain == 0 && s->tie != SHAPE_TIE_CENTRE)) {
            v[0] = v[1] = 0;
            v[2] = p[1];
        } else if (gain == 0) {
            v[0] /= 2;
            v[1] /= 2;
            v[2] = 0;
        }
        break;
    }
    case SHAPE_ELLIPSOID:
        e[0] = p[0] * d[0];
        e[1] = p[1] * d[1];
        e[2] = p[2] * d[2];
        l = ROOT(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
        l = l > 0 ? 1 / l : (REAL)0;
        v[0] = p[0] * (e[0] * l);
        v[1] = p[1] * (e[1] * l);
        v[2] = p[2] * (e[2] * l);
        break;
    case SHAPE_POLYTOPE:
        FN(farthest)(s, d, v);
        break;
    case SHAPE_FRUSTUM:
    case SHAPE_SUPERELLIPSOID:
    case SHAPE_HALF_DISC:
    case SHAPE_TEARDROP:
    case SHAPE_HALF_BALL:
    case SHAPE_CUT_BALL:
    case SHAPE_SUM: {
        /* copies, so that the others' points stay in registers */
        const REAL direction[3] = {d[0], d[1], d[2]};
        FN(hard_support)(s, direction, e);
        v[0] = e[0];
        v[1] = e[1];
        v[2] = e[2];
        break;
    }
    }
}

/* The same for the shapes of the stability tests alone. */
static void FN(hard_support)(const shape_t *s, const REAL d[3], REAL v[3])
{
    const ccd_real_t *p = s->p;
    const REAL rim = ROOT(d[0] * d[0] + d[1] * d[1]), round = ROOT(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    REAL e[3];
    switch ((int)s->type) {
    case SHAPE_FRUSTUM: {
        const int low = p[0] * rim + p[1] * d[2] >= p[2] * rim + p[3] * d[2];
        FN(rim)(d, low ? p[0] : p[2], s->tie, v);
        v[2] = low ? p[1] : p[3];
        break;
    }
    case SHAPE_SUPERELLIPSOID: { /* by the dual exponent */
        const REAL q = p[3] / ((REAL)p[3] - 1);
        REAL most = 0, sum = 0;
        for (int i = 0; i < 3; i++) {
            e[i] = d[i] < 0 ? -p[i] * d[i] : p[i] * d[i];
            most = e[i] > most ? e[i] : most;
        }
        for (int i = 0; i < 3; i++) {
            e[i] /= most;
            v[i] = POWER(e[i], q);
            sum += v[i];
        }
        sum = POWER(sum, 1 / (REAL)p[3]);
        for (int i = 0; i < 3; i++)
            v[i] = e[i] > 0 ? (d[i] < 0 ? -p[i] : p[i]) * (v[i] / e[i]) / sum : 0;
        break;
    }
    case SHAPE_HALF_DISC:
        FN(rim)(d, p[0], s->tie, v);
        v[2] = 0;
        if (!(d[1] > 0)) {
            v[0] = FN(toward)(d[0], p[0], s->tie);
            v[1] = 0;
        }
        break;
    case SHAPE_TEARDROP:
    case SHAPE_HALF_BALL:
    case SHAPE_CUT_BALL: {
        const int is_half = s->type == SHAPE_HALF_BALL, is_cut = s->type == SHAPE_CUT_BALL;
        if (is_cut ? p[0] * d[2] > p[1] * round : is_half && d[2] > 0) { /* the rim of the flat */
            FN(rim)(d, is_cut ? (ccd_real_t)sqrt((double)(p[0] * p[0] - p[1] * p[1])) : p[0], s->tie, v);
            v[2] = is_cut ? p[1] : 0;
        } else {
            for (int i = 0; i < 3; i++)
                v[i] = p[0] * d[i] / round;
        }
        if (!is_cut && p[1] * d[2] > p[0] * (is_half && d[2] > 0 ? rim : round)) { /* the tip */
            v[0] = v[1] = 0;
            v[2] = p[1];
        }
        break;
    }
    case SHAPE_SUM:
        FN(local_support)(s->parts, d, v);
        FN(local_support)(s->parts + 1, d, e);
        for (int i = 0; i < 3; i++)
            v[i] += e[i] + p[0] * d[i] / round;
        break;
    }
}
