/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* ccdSignedDistance: pairs of certified depth moved along their normal, from deep to apart,
 * where the signed distance is the way left; margins; max_distance; objects without area. (Every
 * category of pairs is the campaign's, states of every kind are in answers.c.)
 *
 *   distance [pair set...] */

#include "stability/categories.h"

#include "contract/check.h"
#include "ours.h"
#include "pairs.h"

#include <float.h>
#include <math.h>

static const int single = sizeof(ccd_real_t) == sizeof(float);

static double dot3(const ccd_vec3_t *a, const ccd_vec3_t *b)
{
    return (double)a->v[0] * b->v[0] + (double)a->v[1] * b->v[1] + (double)a->v[2] * b->v[2];
}

static double support_value(const ccd_t *ccd, const void *a, const void *b, const ccd_vec3_t *n)
{
    ccd_vec3_t back = {{-n->v[0], -n->v[1], -n->v[2]}}, p, q;
    ccd->support1(a, n, &p);
    ccd->support2(b, &back, &q);
    return dot3(n, &p) - dot3(n, &q);
}

static double between(const ccd_vec3_t *p, const ccd_vec3_t *q)
{
    double x = p->v[0] - q->v[0], y = p->v[1] - q->v[1], z = p->v[2] - q->v[2];
    return sqrt(x * x + y * y + z * z);
}

static void move_along(shape_t *s, const double n[3], double by)
{
    shape_move(s, s->pos[0] + by * n[0], s->pos[1] + by * n[1], s->pos[2] + by * n[2]);
}

/* What holds of every answer; `error` is what rounding may do. */
static void sound(int code, const ccd_distance_t *d, const ccd_t *ccd, const void *a, const void *b, double margin,
                  double error, const char *what)
{
    double h = support_value(ccd, a, b, &d->normal), apart = between(&d->point1, &d->point2);
    CHECK(fabs(dot3(&d->normal, &d->normal) - 1) < 16 * (single ? FLT_EPSILON : DBL_EPSILON), "%s: normal", what);
    CHECK(d->distance <= -h - margin + error, "%s: distance %g, along normal %g", what, (double)d->distance, -h - margin);
    CHECK(d->distance_upper >= d->distance, "%s: %g above %g", what, (double)d->distance, (double)d->distance_upper);
    CHECK(!(d->distance == 0 && signbit((double)d->distance)), "%s: -0", what);
    CHECK(code == CCD_LIMIT || (code == CCD_HIT) == (d->distance < 0), "%s: code %d, distance %g", what, code,
          (double)d->distance);
    if (d->distance > 0)
        CHECK(fabs(apart - (double)d->distance_upper) <= error, "%s: points %g apart, not %g", what, apart,
              (double)d->distance_upper);
}

/* --- certified pairs ---------------------------------------------------------- */

static const double ways[] = {-0.5, -1e-2, -1e-4, -1e-7, 0, 1e-7, 1e-4, 1e-2, 0.1, 1};
enum { WAYS = sizeof ways / sizeof ways[0] };

static void certified(const char *path, int poses)
{
    pair_set_t set;
    int i, k, pass;
    if (pair_set_read(path, &set) != 0) {
        CHECK(0, "cannot read %s", path);
        return;
    }
    for (i = 0; i < set.n; i += set.n / poses > 0 ? set.n / poses : 1) {
        ccd_warm_t warm;
        pair_truth_t truth;
        shape_t a, b;
        ccd_t ccd;
        memset(&warm, 0, sizeof warm);
        shape_query(&ccd);
        ccd.max_iterations = 500;
        pair_set_pose(&set, i, &a, &b, &truth);
        for (k = 0; k < WAYS; k++)
            for (pass = 0; pass < 3; pass++) {
                double way = ways[k], error = single ? 2e-5 : 1e-9 + truth.gap, r1 = 0, r2 = 0, tolerance, width;
                shape_t moved = b;
                ccd_distance_t d;
                char what[200];
                int code;
                if (way < -truth.depth)
                    continue;
                move_along(&moved, truth.normal, truth.depth + way);
                /* Cold; with margins, apart to rounding; warm, whatever came before. */
                if (pass == 1)
                    r1 = random_in(0, 0.3), r2 = random_in(0, 0.3);
                tolerance = way > 0 && pass == 1 ? 0 : 1e-6;
                ccd.dist_tolerance = (ccd_real_t)tolerance;
                code = OURS(ccdSignedDistance)(&a, &moved, &ccd, (ccd_real_t)r1, (ccd_real_t)r2, INFINITY,
                                               pass == 2 ? &warm : NULL, CCD_WANT_ALL, &d);
                sprintf(what, "%.120s %d way %g pass %d", strrchr(path, '/') + 1, i, way, pass);
                sound(code, &d, &ccd, &a, &moved, r1 + r2, error, what);
                CHECK(fabs(d.distance - (way - r1 - r2)) <= tolerance + error, "%s: %.12g", what, (double)d.distance);
                CHECK(d.distance_upper >= way - r1 - r2 - error, "%s: upper %.12g", what, (double)d.distance_upper);
                width = d.distance_upper - d.distance;
                CHECK(code == CCD_LIMIT || width <= tolerance + error, "%s: open by %g", what, width);
                CHECK(way <= 0 || code != CCD_LIMIT, "%s: limit", what);
            }
    }
    pair_set_free(&set);
}

/* --- spheres and capsules as cores ---------------------------------------------- */

static void cores(void)
{
    double supports = 0;
    int i, count = 0;
    for (i = 0; i < 2000; i++) {
        double r1 = random_in(0.1, 1), r2 = random_in(0.1, 1), error = single ? 1e-5 : 2e-9, rot[9];
        int one = random_below(2), other = random_below(2);
        shape_t a = one ? shape_capsule(r1, 0.5) : shape_sphere(r1), b = other ? shape_capsule(r2, 0.7) : shape_sphere(r2);
        shape_t p = one ? shape_capsule(0, 0.5) : shape_sphere(0), q = other ? shape_capsule(0, 0.7) : shape_sphere(0);
        ccd_distance_t full, core;
        ccd_vec3_t to = random_vec3(3);
        ccd_t ccd;
        int code;
        shape_query(&ccd);
        ccd.max_iterations = 500;
        ccd.dist_tolerance = CCD_REAL(1e-6);
        rotation_quaternion(random_in(-1, 1), random_in(-1, 1), random_in(-1, 1), random_in(-1, 1), rot);
        shape_turn(&b, rot), shape_turn(&q, rot);
        shape_move(&b, to.v[0], to.v[1], to.v[2]), shape_move(&q, to.v[0], to.v[1], to.v[2]);
        OURS(ccdSignedDistance)(&a, &b, &ccd, 0, 0, INFINITY, NULL, CCD_WANT_ALL, &full);
        code = OURS(ccdSignedDistance)(&p, &q, &ccd, (ccd_real_t)r1, (ccd_real_t)r2, INFINITY, NULL, CCD_WANT_ALL, &core);
        sound(code, &core, &ccd, &p, &q, r1 + r2, error, "cores");
        CHECK(code == CCD_HIT || code == CCD_MISS, "cores: %d", code);
        CHECK(core.distance <= full.distance_upper + error && full.distance <= core.distance_upper + error,
              "cores %d: %g and %g", i, (double)core.distance, (double)full.distance);
        supports += core.support_calls, count++;
    }
    printf("spheres and capsules as cores: %.2f supports\n", supports / count);
    CHECK(supports / count <= 3.5, "%g supports", supports / count);
}

/* --- max_distance ------------------------------------------------------------------- */

static void max_distance(void)
{
    int i;
    for (i = 0; i < 300; i++) {
        pair_t p;
        ccd_distance_t d, far;
        ccd_t ccd;
        double error = single ? 1e-4 : 1e-8, limit = random_in(0, 1);
        category_pair(0, (uint64_t)i, 0, &p);
        shape_move(&p.b, p.b.pos[0] + random_in(0, 4), p.b.pos[1], p.b.pos[2]);
        shape_query(&ccd);
        ccd.max_iterations = 500;
        ccd.dist_tolerance = CCD_REAL(1e-6);
        OURS(ccdSignedDistance)(&p.a, &p.b, &ccd, 0, 0, INFINITY, NULL, CCD_WANT_ALL, &d);
        OURS(ccdSignedDistance)(&p.a, &p.b, &ccd, 0, 0, (ccd_real_t)limit, NULL, CCD_WANT_ALL, &far);
        CHECK(far.support_calls <= d.support_calls, "max_distance: %lu above %lu", far.support_calls, d.support_calls);
        CHECK(far.distance <= d.distance_upper + error && far.distance_upper >= d.distance - error, "max_distance: %g, %g",
              (double)far.distance, (double)d.distance);
        CHECK(d.distance <= limit + 1e-6 || far.distance > limit, "max_distance %g: %g", limit, (double)far.distance);
    }
}

/* --- objects without area, touches ------------------------------------------------- */

static double of_points(const ccd_real_t *p, int np, const ccd_real_t *q, int nq, double z, int *code)
{
    shape_t a = shape_polytope(p, np), b = shape_polytope(q, nq);
    ccd_distance_t d;
    ccd_t ccd;
    shape_move(&b, 0, 0, z);
    shape_query(&ccd);
    ccd.max_iterations = 500;
    ccd.dist_tolerance = 0;
    *code = OURS(ccdSignedDistance)(&a, &b, &ccd, 0, 0, INFINITY, NULL, CCD_WANT_ALL, &d);
    sound(*code, &d, &ccd, &a, &b, 0, 1e-6, "flat");
    return d.distance;
}

static void flat(void)
{
    static const ccd_real_t point[3] = {0, 0, 0}, along_x[6] = {-1, 0, 0, 1, 0, 0}, along_y[6] = {0, -1, 0, 0, 1, 0},
                            square[12] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0},
                            beside[12] = {1.5, -1, 0, 3, -1, 0, 3, 1, 0, 1.5, 1, 0};
    static const ccd_real_t *shapes[] = {point, along_x, along_y, square};
    static const int counts[] = {1, 2, 2, 4};
    int i, k, code;
    for (i = 0; i < 4; i++)
        for (k = 0; k < 4; k++) {
            double error = single ? 1e-6 : 1e-14, d;
            d = of_points(shapes[i], counts[i], shapes[k], counts[k], 0.5, &code);
            CHECK(code == CCD_MISS && fabs(d - 0.5) <= error, "%d over %d: %d, %g", i, k, code, d);
            /* Through each other: a touch. */
            d = of_points(shapes[i], counts[i], shapes[k], counts[k], 0, &code);
            CHECK(code == CCD_MISS && d == 0, "%d on %d: %d, %g", i, k, code, d);
        }
    CHECK(fabs(of_points(square, 4, beside, 4, 0, &code) - 0.5) < 1e-6 && code == CCD_MISS, "side by side: %d", code);
}

int main(int argc, char **argv)
{
    int i;
    flat();
    cores();
    max_distance();
    for (i = 1; i < argc; i++)
        certified(argv[i], 12);
    return checks_end();
}
