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
    ccd_t ccd = shape_query();
    ccd.support1 = ccd.support2 = support;
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = (ccd_real_t)TOLERANCE;
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

/* Checks every call on one pair. `depth`: the signed depth, metres, not within a tolerance of 0. */
static void check_calls(const shape_t *a, const shape_t *b, double depth)
{
    enum { DEPTHS = 6 }; /* the first calls return depths */
    static const int calls[] = {CALL_MPR, CALL_MPR_WARM, CALL_GJK, CALL_PENETRATION, CALL_PROVEN, CALL_LOCAL, CALL_DISTANCE,
                                CALL_MPR_INTERSECT, CALL_GJK_INTERSECT, CALL_INTERSECT};
    const ccd_t ccd = settings();
    for (int i = 0; i < (int)(sizeof calls / sizeof calls[0]); i++) {
        ccd_warm_t warm = {0};
        ccd_real_t found = 0;
        ccd_vec3_t dir, pos;
        ccd_penetration_t hit = {0};
        ccd_distance_t distance;
        int is_hit = 0;
        switch (calls[i]) {
        case CALL_MPR: is_hit = OURS(ccdMPRPenetration)(a, b, &ccd, &found, &dir, &pos) == 0; break;
        case CALL_MPR_WARM: is_hit = OURS(ccdMPRPenetrationWarm)(a, b, &ccd, &warm, &found, &dir, &pos) == 0; break;
        case CALL_GJK: is_hit = OURS(ccdGJKPenetration)(a, b, &ccd, &found, &dir, &pos) == 0; break;
        case CALL_PENETRATION: is_hit = OURS(ccdPenetration)(a, b, &ccd, &warm, 0, &hit) >= 0; break;
        case CALL_PROVEN: is_hit = OURS(ccdPenetrationProven)(a, b, &ccd, &warm, 0, &hit) >= 0; break;
        case CALL_LOCAL: is_hit = OURS(ccdPenetrationLocal)(a, b, &ccd, &warm, 0, &hit) >= 0; break;
        case CALL_DISTANCE:
            is_hit = OURS(ccdSignedDistance)(a, b, &ccd, 0, 0, (ccd_real_t)HUGE_VAL, &warm, 0, &distance) != CCD_MISS;
            CHECK(fabs((double)distance.distance + depth) <= 2 * TOLERANCE, "distance %g, not %g", (double)distance.distance, -depth);
            break;
        case CALL_MPR_INTERSECT: is_hit = OURS(ccdMPRIntersect)(a, b, &ccd); break;
        case CALL_GJK_INTERSECT: is_hit = OURS(ccdGJKIntersect)(a, b, &ccd); break;
        case CALL_INTERSECT: is_hit = OURS(ccdIntersect)(a, b, &ccd, &warm); break;
        }
        const int has_bounds = calls[i] == CALL_PENETRATION || calls[i] == CALL_PROVEN;
        const double value = has_bounds || calls[i] == CALL_LOCAL ? (double)hit.depth : (double)found;
        CHECK(is_hit == (depth > 0), "call %d: %s, signed depth %g", calls[i], is_hit ? "hit" : "miss", depth);
        if (is_hit && i < DEPTHS)
            CHECK(fabs(value - depth) <= 2 * TOLERANCE + 1e-3 * depth, "call %d: depth %g, not %g", calls[i], value, depth);
        if (is_hit && has_bounds)
            CHECK((double)hit.depth_lower <= depth + TOLERANCE, "call %d: bound %g above %g", calls[i], (double)hit.depth_lower, depth);
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
