/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks that `pos` is near both objects: half the depth away at most, a tolerance apart. Random pairs of slender hulls,
 * boxes, cylinders, cones, capsules and ellipsoids, of all depths: of 200,000 such hits 14 were farther away, one of
 * them 1e11 m, while the fan of an edge could be clockwise.
 *
 *   position [N]   one hit in N of two million */

#include "tests/contract/check.h"
#include "harness/shapes.h"
#include "harness/this_library.h"

#include <float.h>

enum { HITS = 2000000, VERTICES = 40 };

static const int single = sizeof(ccd_real_t) == sizeof(float);
static const double TOLERANCES[3] = {1e-4, 1e-6, 1e-8};

static void point_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    (void)dir;
    *out = *(const ccd_vec3_t *)obj;
}

static void point_center(const void *obj, ccd_vec3_t *out) { *out = *(const ccd_vec3_t *)obj; }

/* Returns the distance of a point from a shape; negative inside. */
static double distance_from(const shape_t *s, const ccd_vec3_t *point)
{
    ccd_distance_t found;
    ccd_t ccd = shape_query();
    ccd.support2 = point_support;
    ccd.center2 = point_center;
    ccd.max_iterations = 500;
    ccd.dist_tolerance = ccd.epa_tolerance = ccd.mpr_tolerance = (ccd_real_t)(single ? 1e-5 : 1e-7);
    const int code = OURS(ccdSignedDistance)(s, point, &ccd, 0, 0, (ccd_real_t)HUGE_VAL, NULL, 0, &found);
    CHECK(code >= 0 || code == CCD_MISS, "distance: %d", code);
    return (double)found.distance;
}

/* Makes a body of about a metre: a hull for kind SHAPE_POLYTOPE, with its vertices in `verts`. */
static shape_t random_body(int kind, ccd_real_t verts[3 * VERTICES])
{
    const double x = uniform(0.02, 0.5), y = uniform(0.02, 0.5), z = uniform(0.1, 1);
    double q[4], rot[9];
    shape_t s = shape_make(kind, x, kind == SHAPE_CONE || kind == SHAPE_CAPSULE || kind == SHAPE_CYLINDER ? z : y, z);
    if (kind == SHAPE_POLYTOPE) {
        const int n = 4 + (int)uniform(0, VERTICES - 4);
        for (int i = 0; i < n; i++) {
            const double u = uniform(-1, 1), v = uniform(-1, 1), w = uniform(-1, 1), r = sqrt(u * u + v * v + w * w);
            verts[3 * i] = (ccd_real_t)(x * u / r);
            verts[3 * i + 1] = (ccd_real_t)(y * v / r);
            verts[3 * i + 2] = (ccd_real_t)(z * w / r);
        }
        s = shape_polytope(verts, n);
    }
    uniform_rotation(q);
    rotation_quaternion(q[0], q[1], q[2], q[3], rot);
    shape_turn(&s, rot);
    return s;
}

int main(int argc, char **argv)
{
    static const int kinds[] = {SHAPE_POLYTOPE, SHAPE_BOX, SHAPE_POLYTOPE, SHAPE_CYLINDER, SHAPE_CONE, SHAPE_CAPSULE, SHAPE_ELLIPSOID};
    const long hits = HITS / (argc > 1 ? atol(argv[1]) : 1);
    /* Known: 5 of two million, slender curved pairs, whose mirror images are no support points; by up to 1 mm. */
    const long known = hits / 400000;
    long farther = 0;
    double worst = 0;
    uniform_seed(12);
    for (long k = 0, n = 0; n < hits; k++) {
        ccd_real_t verts[2][3 * VERTICES];
        shape_t a = random_body(SHAPE_POLYTOPE, verts[0]), b = random_body(kinds[k % 7], verts[1]);
        ccd_penetration_t p;
        ccd_t ccd = shape_query();
        double move;
        const double tolerance = single ? 1e-5 : TOLERANCES[k % 3];
        ccd.max_iterations = 500;
        ccd.mpr_tolerance = (ccd_real_t)tolerance;
        if (OURS(ccdPenetration)(&a, &b, &ccd, NULL, 0, &p) != CCD_HIT)
            continue;
        /* Most pairs are shallow: a share of the depth that is evenly distributed in its logarithm. */
        move = (double)p.depth * (1 - exp(uniform(log(1e-4), 0)));
        shape_move(&b, move * (double)p.dir.v[0], move * (double)p.dir.v[1], move * (double)p.dir.v[2]);
        if (OURS(ccdPenetration)(&a, &b, &ccd, NULL, CCD_WANT_POS, &p) != CCD_HIT)
            continue;
        n++;
        for (int i = 0; i < 2; i++) {
            const double away = distance_from(i ? &b : &a, &p.pos) - 0.5 * (double)p.depth;
            worst = fmax(worst, away);
            farther += !(away <= 0.01 * (double)p.depth + tolerance);
            CHECK(farther <= known && away <= 1.1e-3, "pair %ld, %g deep: pos is %g m and half the depth from obj%d", k,
                  (double)p.depth, away, i + 1);
        }
    }
    printf("%ld hits: pos at most half the depth and %.3g m from both objects, in %ld cases farther than half the depth\n", hits, worst, farther);
    return checks_end();
}
