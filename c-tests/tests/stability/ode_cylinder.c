/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* ODE's cylinder callback is wrong within about 1e-15 rad of the cylinder's axis: it divides what rounding leaves of the
 * direction across the axis by its length, and adds a radius of that, which has a part along the axis. The normal of a
 * cap is such a direction. Cylinders with this callback stand on parallel faces, a known depth deep or apart; every call
 * must find that depth. Then a pair at rest is queried with a state again and again: its direction must not turn.
 *
 *   ode_cylinder [poses, equal queries] */

#include "categories.h"

#include "tests/contract/check.h"

static const double TOLERANCE = 1e-6;

static void cylinder_support(const shape_t *s, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const ccd_real_t axis[3] = {s->rot[2], s->rot[5], s->rot[8]};
    const ccd_real_t along = dir->v[0] * axis[0] + dir->v[1] * axis[1] + dir->v[2] * axis[2];
    ccd_real_t across[3], length2 = 0;
    for (int i = 0; i < 3; i++) {
        across[i] = dir->v[i] - along * axis[i];
        length2 += across[i] * across[i];
        out->v[i] = s->pos[i] + (along > 0 ? s->p[1] : -s->p[1]) * axis[i];
    }
    const ccd_real_t length = (ccd_real_t)sqrt((double)length2);
    if (length > (ccd_real_t)real_eps())
        for (int i = 0; i < 3; i++)
            out->v[i] += across[i] * (s->p[0] / length);
}

static void support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const shape_t *s = (const shape_t *)obj;
    if (s->type == SHAPE_CYLINDER)
        cylinder_support(s, dir, out);
    else
        shape_support(obj, dir, out);
}

static ccd_t settings(void)
{
    ccd_t ccd = counting_query(TOLERANCE);
    ccd.support1 = ccd.support2 = support;
    ccd.max_iterations = 500;
    return ccd;
}

/* Places b on the cap of cylinder a, `depth` into it along the axis, which is by far the least depth: turned about the
 * axis, and shifted along the cap by at most a third of the radius. */
static void place(rng_t *r, shape_t *a, shape_t *b, double depth)
{
    double q[4], frame[9], turn[9], rot[9], x = 0, y = 0, z;
    for (int i = 0; i < 4; i++)
        q[i] = rng_uniform(r, -1, 1);
    rotation_quaternion(q[0], q[1], q[2], q[3], frame);
    rotation_about(0, 0, 1, rng_uniform(r, 0, 6), turn);
    rotation_times(frame, turn, rot);
    shape_turn(a, frame);
    shape_turn(b, rng_below(r, 2) ? rot : frame);
    if (rng_below(r, 2)) {
        x = rng_uniform(r, -0.1, 0.1);
        y = rng_uniform(r, -0.1, 0.1);
    }
    z = (double)a->p[1] + (double)(b->type == SHAPE_BOX ? b->p[2] : b->p[1]) - depth;
    for (int i = 0; i < 3; i++)
        q[i] = rng_uniform(r, -1, 1);
    shape_move(a, q[0], q[1], q[2]);
    shape_move(b, q[0] + frame[0] * x + frame[1] * y + frame[2] * z, q[1] + frame[3] * x + frame[4] * y + frame[5] * z,
               q[2] + frame[6] * x + frame[7] * y + frame[8] * z);
}

/* Checks every call on one pair. `depth`: the signed depth, metres, not within a tolerance of 0. (A published method, and
 * a direction of the caller's, are not evaluated in general position.) */
static void check_calls(const shape_t *a, const shape_t *b, double depth)
{
    const ccd_t ccd = settings();
    for (const entry_t *e = entries; e < entries + ENTRIES; e++) {
        ccd_warm_t warm = {0};
        answer_t x = {0};
        if (e->is_libccd || e->state > STATE_ZERO || e->without_centres || e->call == CALL_ALONG || e->call == CALL_INCREMENTAL)
            continue;
        call_once(e, a, b, &ccd, &warm, NULL, &x);
        const int is_distance = e->call == CALL_DISTANCE, is_hit = is_distance ? x.code != CCD_MISS : x.code >= CCD_HIT;
        const double within = 2 * TOLERANCE + (is_distance ? 0 : 1e-3 * depth);
        CHECK(is_hit == (depth > 0), "%s: %s, signed depth %g", e->name, is_hit ? "hit" : "miss", depth);
        if (!entry_is_boolean(e) && (is_hit || is_distance))
            CHECK(fabs(x.depth - depth) <= within, "%s: depth %g, not %g", e->name, x.depth, depth);
        CHECK(!x.has_bounds || x.lower <= depth + TOLERANCE, "%s: bound %g above %g", e->name, x.lower, depth);
    }
}

/* Queries a pair at rest with a state. */
static void check_rest(const shape_t *a, const shape_t *b, int queries)
{
    const ccd_t ccd = settings();
    ccd_warm_t warm[3];
    double first[3][3] = {{0}}, turned = 0;
    memset(warm, 0, sizeof warm);
    for (int k = 0; k < queries; k++) {
        ccd_penetration_t hit[3];
        const int is_hit = OURS(ccdPenetration)(a, b, &ccd, &warm[0], 0, &hit[0]) >= 0
            && OURS(ccdPenetrationProven)(a, b, &ccd, &warm[1], 0, &hit[1]) >= 0
            && OURS(ccdPenetrationLocal)(a, b, &ccd, &warm[2], 0, &hit[2]) >= 0;
        CHECK(is_hit, "query %d of a pair at rest is a miss", k);
        for (int i = 0; i < 3 && is_hit; i++)
            for (int j = 0; j < 3; j++) {
                if (k == 1)
                    first[i][j] = (double)hit[i].dir.v[j];
                if (k > 1)
                    turned = fmax(turned, fabs((double)hit[i].dir.v[j] - first[i][j]));
            }
    }
    CHECK(turned <= 16 * real_eps(), "the direction of a pair at rest turns by %g rad", turned);
}

int main(int argc, char **argv)
{
    const int poses = argc > 1 ? atoi(argv[1]) : 2000, queries = argc > 2 ? atoi(argv[2]) : 10000;
    for (int k = 0; k < poses; k++) {
        rng_t r = rng(4100, (uint64_t)k);
        shape_t a = shape_cylinder(.35, .4), b = k % 3 == 0 ? shape_box(.5, .4, .2) : shape_cylinder(k % 3 == 1 ? .35 : .2, .3);
        const double depth = rng_sign(&r) * rng_log_uniform(&r, 1e-5, 2e-2);
        place(&r, &a, &b, depth);
        check_calls(&a, &b, depth);
        check_calls(&b, &a, depth);
        if (k % (poses / 4 + 1) == 0 && depth > 0)
            check_rest(&a, &b, queries);
    }
    return checks_end();
}
