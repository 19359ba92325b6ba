/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Flat ellipses and discs in a common plane, judged by the support values of all directions in the plane: overlaps are
 * hits and gaps are misses, the depth is a local minimum over the directions, and no query takes more support points
 * than documented. The queries along a direction and incremental return a miss for them, since flat bodies only touch;
 * for the same bodies with a thickness they return what the planar query returns.
 *
 *   planar [pairs] */

#include "tests/stability/categories.h"

#include "tests/contract/check.h"

enum { PAIRS = 300, DIRECTIONS = 720, MAX_SUPPORT_POINTS = 400 };

static double plane[9]; /* a rotation: its last column is the normal of the plane */

/* An ellipse in the plane, and the prism on it. */
typedef struct {
    shape_t flat, thick, parts[2];
} ellipse_t;

static void make_ellipse(ellipse_t *e, int is_disc)
{
    double yaw[9], rot[9];
    const double x = uniform(.3, 1), y = is_disc ? x : uniform(.3, 1);
    e->parts[0] = e->flat = shape_ellipsoid(x, y, 0);
    e->parts[1] = shape_capsule(0, .5); /* a segment */
    rotation_about(0, 0, 1, uniform(0, 6.3), yaw);
    rotation_times(plane, yaw, rot);
    shape_turn(&e->flat, rot);
}

static void make_prism(ellipse_t *e)
{
    e->thick = e->flat;
    e->thick.type = SHAPE_SUM;
    e->thick.p[0] = 0;
    e->thick.parts = e->parts;
}

/* Writes a direction in the plane. */
static void direction(double angle, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = plane[3 * i] * cos(angle) + plane[3 * i + 1] * sin(angle);
}

/* Returns the support value of the difference along an angle in the plane. */
static double value(const ellipse_t *a, const ellipse_t *b, double angle)
{
    double n[3];
    direction(angle, n);
    return truth_support_value(&a->flat, &b->flat, n);
}

/* Returns the least support value over all directions in the plane. */
static double least_value(const ellipse_t *a, const ellipse_t *b)
{
    const double step = 2 * acos(-1) / DIRECTIONS;
    double best = HUGE_VAL, at = 0;
    for (int i = 0; i < DIRECTIONS; i++)
        if (value(a, b, i * step) < best)
            best = value(a, b, at = i * step);
    for (double width = step; width > 1e-9; width *= .7)
        for (int side = -1; side <= 1; side += 2)
            if (value(a, b, at + side * width) < best)
                best = value(a, b, at += side * width);
    return best;
}

enum { MISSED, FALSE_HIT, NO_MINIMUM, KINDS };
static unsigned long most, limits, wrong[KINDS];

static void count_support_points(int code, const ccd_penetration_t *out)
{
    if ((code == CCD_HIT || code == CCD_LIMIT) && out->support_points > most)
        most = out->support_points;
}

static void check(int is_wrong, int kind, const char *what, double tol, double truth, const ccd_penetration_t *out)
{
    wrong[kind] += (unsigned long)is_wrong;
    CHECK(!is_wrong, "%s, tolerance %g: truth %.17g, depth %.17g", what, tol, truth, (double)out->depth);
}

/* Makes the calls for one pair at one tolerance. */
static void check_pair(const ellipse_t *a, const ellipse_t *b, double tol, int has_centers, double truth)
{
    ccd_penetration_t out;
    ccd_vec3_t normal, along;
    ccd_t ccd = shape_query();
    ccd.center1 = ccd.center2 = has_centers ? shape_center : NULL;
    ccd.mpr_tolerance = (ccd_real_t)tol;
    const double noise = 64 * real_eps();
    double u[3];
    direction(uniform(0, 6.3), u);
    for (int i = 0; i < 3; i++) {
        normal.v[i] = (ccd_real_t)plane[3 * i + 2];
        along.v[i] = (ccd_real_t)u[i];
    }
    if (fabs(truth) <= noise)
        return;

    memset(&out, 0, sizeof out);
    int code = OURS(ccdPenetrationPlanar)(&a->flat, &b->flat, &ccd, &normal, NULL, CCD_WANT_POINTS, &out);
    count_support_points(code, &out);
    check(truth > 0 && code != CCD_HIT && code != CCD_LIMIT, MISSED, "planar: missed", tol, truth, &out);
    check(truth < 0 && code != CCD_MISS, FALSE_HIT, "planar: a false hit", tol, truth, &out);
    limits += code == CCD_LIMIT;
    if (code == CCD_HIT) {
        double x = 0, y = 0, lowest = HUGE_VAL;
        for (int i = 0; i < 3; i++) {
            x += plane[3 * i] * (double)out.dir.v[i];
            y += plane[3 * i + 1] * (double)out.dir.v[i];
        }
        for (int i = -20; i <= 20; i++)
            lowest = fmin(lowest, value(a, b, atan2(y, x) + i * 5e-4));
        check(!(fabs((double)out.depth - value(a, b, atan2(y, x))) <= noise), NO_MINIMUM, "planar: no support value", tol, truth, &out);
        check((double)out.depth > lowest + 10 * tol + noise, NO_MINIMUM, "planar: no local minimum", tol, truth, &out);
    }

    /* Flat, they touch; thick, they overlap exactly where the ellipses do. */
    for (int thick = 0; thick < 2; thick++) {
        const shape_t *const s1 = thick ? &a->thick : &a->flat, *const s2 = thick ? &b->thick : &b->flat;
        code = OURS(ccdPenetrationAlong)(s1, s2, &ccd, &along, NULL, 0, &out);
        count_support_points(code, &out);
        check(thick && truth > 0 && code != CCD_HIT && code != CCD_LIMIT, MISSED, "along: missed", tol, truth, &out);
        check((!thick || truth < 0) && code != CCD_MISS, FALSE_HIT, "along: a false hit", tol, truth, &out);
        code = OURS(ccdPenetrationIncremental)(s1, s2, &ccd, NULL, 0, &out);
        check(thick && truth > 0 && code != CCD_HIT && code != CCD_LIMIT, MISSED, "incremental: missed", tol, truth, &out);
        check((!thick || truth < 0) && code != CCD_MISS, FALSE_HIT, "incremental: a false hit", tol, truth, &out);
        count_support_points(code, &out);
    }
}

/* Makes incremental queries of bodies that hardly overlap: the proof of the overlap then takes most support points. */
static void check_limit_of_proofs(void)
{
    for (uint64_t i = 700; i < 800; i++) {
        static pair_t p;
        category_pair(CATEGORY_TOUCHING, i, SHAPE_TIE_SIGN, &p);
        ccd_t ccd = shape_query();
        ccd_penetration_t out;
        ccd.mpr_tolerance = (ccd_real_t)(1e-9 * pair_size(&p.a, &p.b));
        for (int has_centers = 0; has_centers < 2; has_centers++) {
            ccd.center1 = ccd.center2 = has_centers ? shape_center : NULL;
            count_support_points(OURS(ccdPenetrationIncremental)(&p.a, &p.b, &ccd, NULL, CCD_WANT_ALL, &out), &out);
        }
    }
}

int main(int argc, char **argv)
{
    const int pairs = argc > 1 ? atoi(argv[1]) : PAIRS;
    const int is_single = sizeof(ccd_real_t) == sizeof(float);
    for (int n = 0; n < pairs; n++) {
        ellipse_t a, b;
        const double distance = uniform(0, 1) * (n % 5 ? 1 : 2.5), far_off = n % 3 ? 0 : uniform(-5, 5);
        double u[3], x[3];
        rotation_quaternion(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), plane);
        make_ellipse(&a, n % 2);
        make_ellipse(&b, n % 2);
        direction(0, x);
        direction(uniform(0, 6.3), u);
        shape_shift(&a.flat, far_off, x);
        b.flat.pos[0] = a.flat.pos[0];
        b.flat.pos[1] = a.flat.pos[1];
        b.flat.pos[2] = a.flat.pos[2];
        shape_shift(&b.flat, distance, u);
        make_prism(&a);
        make_prism(&b);
        const double truth = least_value(&a, &b);
        for (int exponent = is_single ? 3 : 5; exponent <= (is_single ? 5 : 9); exponent++)
            for (int has_centers = 0; has_centers < 2; has_centers++)
                check_pair(&a, &b, pow(10, -exponent), has_centers, truth);
    }
    check_limit_of_proofs();
    CHECK(most <= MAX_SUPPORT_POINTS, "%lu support points", most);
    printf("missed %lu, false hits %lu, no minimum %lu, limits %lu, at most %lu support points\n", wrong[MISSED],
           wrong[FALSE_HIT], wrong[NO_MINIMUM], limits, most);
    return checks_end();
}
