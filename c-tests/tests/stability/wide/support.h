/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Support functions of the bodies, once for each number type: body.h includes this with REAL
 * (the type), FN (the functions' names), ROOT and POWER. */

/* Writes the support point of a part along d, of any length. */
static void FN(part)(const part_t *s, const REAL d[3], REAL o[3])
{
    const double *p = s->p;
    REAL l = ROOT(d[0] * d[0] + d[1] * d[1]), x;
    int i;
    o[0] = o[1] = o[2] = 0;
    switch (s->kind) {
    case PART_POINT:
        break;
    case PART_POINTS:
        FN(farthest)(s, d, o);
        break;
    case PART_BOX:
        for (i = 0; i < 3; i++)
            o[i] = d[i] < 0 ? -p[i] : p[i];
        break;
    case PART_SEGMENT:
        o[2] = d[2] < 0 ? -p[0] : p[0];
        break;
    case PART_ELLIPSOID:
        for (i = 0, x = 0; i < 3; i++)
            x += p[i] * d[i] * p[i] * d[i];
        x = ROOT(x);
        for (i = 0; i < 3 && x > 0; i++)
            o[i] = p[i] * p[i] * d[i] / x;
        break;
    case PART_SUPERELLIPSOID: { /* sum |x / p|^e <= 1; the dual exponent */
        const REAL q = p[3] / ((REAL)p[3] - 1);
        REAL y[3], most = 0, sum = 0;
        for (i = 0; i < 3; i++) {
            y[i] = d[i] < 0 ? -p[i] * d[i] : p[i] * d[i];
            most = y[i] > most ? y[i] : most;
        }
        for (i = 0; i < 3 && most > 0; i++)
            sum += POWER(y[i] / most, q);
        for (i = 0; i < 3 && most > 0; i++)
            o[i] = (d[i] < 0 ? -p[i] : p[i]) * POWER(y[i] / most, q - 1) / POWER(sum, 1 / (REAL)p[3]);
        break;
    }
    case PART_DISC:
    case PART_HALF_DISC:
        if (s->kind == PART_HALF_DISC && !(d[1] > 0)) {
            o[0] = d[0] < 0 ? -p[0] : p[0];
        } else if (l > 0) {
            o[0] = p[0] * d[0] / l;
            o[1] = p[0] * d[1] / l;
        }
        break;
    case PART_FRUSTUM: { /* radius and height of either end */
        const int low = p[0] * l + p[1] * d[2] >= p[2] * l + p[3] * d[2];
        o[2] = low ? p[1] : p[3];
        for (i = 0; i < 2 && l > 0; i++)
            o[i] = (low ? p[0] : p[2]) * d[i] / l;
        break;
    }
    case PART_TEARDROP: /* a ball and a tip above it */
    case PART_HALF_BALL: /* its lower half, and a tip above the flat or in it */
        x = ROOT(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        if (p[1] * d[2] > p[0] * (s->kind == PART_HALF_BALL && d[2] > 0 ? l : x)) {
            o[2] = p[1];
        } else if (s->kind == PART_HALF_BALL && d[2] > 0) {
            for (i = 0; i < 2 && l > 0; i++)
                o[i] = p[0] * d[i] / l;
        } else {
            for (i = 0; i < 3; i++)
                o[i] = p[0] * d[i] / x;
        }
        break;
    case PART_CUT_BALL: { /* a ball without its cap above p[1] */
        const REAL rim = ROOT((REAL)p[0] * p[0] - (REAL)p[1] * p[1]);
        x = ROOT(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (i = 0; i < 3; i++)
            o[i] = !(p[0] * d[2] > p[1] * x) ? p[0] * d[i] / x : i == 2 ? p[1] : l > 0 ? rim * d[i] / l : 0;
        break;
    }
    }
}

/* Writes the support point of a body along d, relative to `origin`. */
static void FN(body)(const body_t *s, const double origin[3], const REAL d[3], REAL o[3])
{
    REAL e[3], x[3], t[3], l;
    int k;
    for (int i = 0; i < 3; i++)
        e[i] = s->rot[i] * d[0] + s->rot[3 + i] * d[1] + s->rot[6 + i] * d[2];
    FN(part)(&s->part, e, x);
    if (s->child.kind != PART_POINT) {
        FN(part)(&s->child, e, t);
        for (int i = 0; i < 3; i++)
            x[i] += t[i];
    }
    if (s->margin > 0) {
        l = ROOT(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
        for (int i = 0; i < 3; i++)
            x[i] += s->margin * e[i] / l;
    }
    for (int i = 0; i < 3; i++)
        for (o[i] = (REAL)s->pos[i] - origin[i], k = 0; k < 3; k++)
            o[i] += s->rot[3 * i + k] * x[k];
}
