/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The rows of the judge's table: two shapes, the ratio of their sizes, a placement. Pair i
 * of a row is always the same pair. */

#ifndef STABILITY_WIDE_ROWS_H
#define STABILITY_WIDE_ROWS_H

#include "bounds.h"
#include "harness/tolerances.h"

enum { BODY_POINTS = 10000 };

/* Holds its bodies' points: refer to it by pointer, do not copy it. */
typedef struct {
    body_t body[2];
    double points[2][3 * BODY_POINTS];
    double size, largest; /* of D; of the coordinates; metres */
} wide_pair_t;

/* --- shapes, about 1 large ---------------------------------------------------------- */

typedef void make_t(rng_t *d, body_t *s, double *points);
#pragma GCC diagnostic ignored "-Wunused-parameter" /* few have points of their own */

static void set_part(part_t *s, part_kind_t kind, double p0, double p1, double p2, double p3)
{
    s->kind = kind;
    s->p[0] = p0;
    s->p[1] = p1;
    s->p[2] = p2;
    s->p[3] = p3;
}

static void set_points(body_t *s, const double *points, int n)
{
    set_part(&s->part, PART_POINTS, 2, 0, 0, 0);
    s->part.points = points;
    s->part.count = n;
}

static double some(rng_t *d) { return rng_uniform(d, .1, 1); }

static void make_thin(rng_t *d, body_t *s, double aspect, int needle)
{
    const double x = 1 / aspect, y = needle ? x * some(d) : some(d);
    switch (rng_below(d, 3)) {
    case 0:
        set_part(&s->part, PART_BOX, x, y, 1, 0);
        break;
    case 1:
        set_part(&s->part, PART_ELLIPSOID, x, y, 1, 0);
        break;
    default:
        if (needle) {
            set_part(&s->part, PART_SEGMENT, 1, 0, 0, 0);
            s->margin = x;
        } else {
            set_part(&s->part, PART_FRUSTUM, some(d), -x, some(d), x);
        }
        break;
    }
}

static void make_needle(rng_t *d, body_t *s, double *points)
{
    make_thin(d, s, rng_log_uniform(d, 1e2, 1e4), 1);
}

static void make_fine_needle(rng_t *d, body_t *s, double *points)
{
    make_thin(d, s, rng_log_uniform(d, 1e4, 1e6), 1);
}

static void make_plate(rng_t *d, body_t *s, double *points)
{
    make_thin(d, s, rng_log_uniform(d, 1e2, 1e6), 0);
}

static void make_frustum_plate(rng_t *d, body_t *s, double *points)
{
    const double x = rng_log_uniform(d, 1e-5, 1e-2);
    set_part(&s->part, PART_FRUSTUM, some(d), -x, some(d), x);
}

static void make_frustum(rng_t *d, body_t *s, double *points)
{
    const double x = some(d);
    set_part(&s->part, PART_FRUSTUM, some(d), -x, rng_below(d, 4) ? some(d) : 0, x);
}

/* A star, and a smaller one turned by some angle above it. */
static void make_star(rng_t *d, body_t *s, double *points)
{
    const int arms = 3 + rng_below(d, 10);
    const double inner = rng_uniform(d, .2, .9), top = some(d), turn = rng_uniform(d, 0, 1), high = rng_log_uniform(d, 1e-3, 1);
    set_points(s, points, 4 * arms);
    for (int i = 0; i < 4 * arms; i++) {
        const int up = i >= 2 * arms;
        const double angle = 3.14159265358979323846 * i / arms + up * turn, r = (i % 2 ? inner : 1) * (up ? top : 1);
        const double at[3] = {r * cos(angle), r * sin(angle), up ? high : -high};
        for (int k = 0; k < 3; k++)
            points[3 * i + k] = at[k];
    }
}

static void make_teardrop(rng_t *d, body_t *s, double *points)
{
    const double r = rng_uniform(d, .1, .7);
    set_part(&s->part, PART_TEARDROP, r, r * rng_uniform(d, 1.1, 4), 0, 0);
    s->centre[2] = rng_uniform(d, 0, .2) * r;
}

static void make_half_disc(rng_t *d, body_t *s, double *points)
{
    const double r = some(d);
    set_part(&s->part, PART_HALF_DISC, r, 0, 0, 0);
    s->centre[1] = .3 * r;
}

static void make_half_ball(rng_t *d, body_t *s, double *points)
{
    const double r = some(d);
    set_part(&s->part, PART_HALF_BALL, r, rng_below(d, 2) ? r * rng_uniform(d, .1, 2) : 0, 0, 0);
    s->centre[2] = -.3 * r;
}

static void make_cut_ball(rng_t *d, body_t *s, double *points)
{
    const double r = some(d);
    set_part(&s->part, PART_CUT_BALL, r, r * (1 - rng_log_uniform(d, 1e-3, .1)), 0, 0);
}

static void make_superellipsoid(rng_t *d, body_t *s, double *points)
{
    set_part(&s->part, PART_SUPERELLIPSOID, some(d), some(d), some(d), rng_log_uniform(d, 1.05, 8));
}

static void make_rounded_box(rng_t *d, body_t *s, double *points)
{
    set_part(&s->part, PART_BOX, some(d), some(d), some(d), 0);
    s->margin = rng_log_uniform(d, 1e-6, .5);
}

static void make_ball(rng_t *d, body_t *s, double *points)
{
    s->margin = some(d);
}

static void make_ellipsoid(rng_t *d, body_t *s, double *points)
{
    set_part(&s->part, PART_ELLIPSOID, some(d), some(d), some(d), 0);
}

static void make_box(rng_t *d, body_t *s, double *points)
{
    set_part(&s->part, PART_BOX, some(d), some(d), some(d), 0);
}

static void make_capsule(rng_t *d, body_t *s, double *points)
{
    set_part(&s->part, PART_SEGMENT, some(d), 0, 0, 0);
    s->margin = some(d);
}

static void make_sum(rng_t *d, body_t *s, double *points)
{
    (rng_below(d, 2) ? make_box : make_frustum)(d, s, points);
    switch (rng_below(d, 3)) {
    case 0: set_part(&s->child, PART_DISC, rng_log_uniform(d, 1e-3, 1), 0, 0, 0); break;
    case 1: set_part(&s->child, PART_SEGMENT, rng_log_uniform(d, 1e-3, 1), 0, 0, 0); break;
    default: set_part(&s->child, PART_ELLIPSOID, some(d), rng_log_uniform(d, 1e-3, 1), some(d), 0); break;
    }
    if (rng_below(d, 3) == 0)
        s->margin = rng_log_uniform(d, 1e-3, .3);
}

/* Thousands of vertices on a face that is hardly bent. */
static void make_bent(rng_t *d, body_t *s, double *points)
{
    const int n = (int)rng_log_uniform(d, 100, BODY_POINTS);
    const double bend = rng_log_uniform(d, 1e-12, 1e-2);
    set_points(s, points, n);
    for (int i = 0; i < n; i++, points += 3) {
        points[0] = rng_uniform(d, -1, 1);
        points[1] = rng_uniform(d, -1, 1);
        points[2] = i < n / 4 ? -.5 : .5 - bend * (points[0] * points[0] + points[1] * points[1]);
    }
}

static void make_hull(rng_t *d, body_t *s, double *points)
{
    const int n = 5 + rng_below(d, 60);
    const double x = some(d), y = some(d), z = some(d);
    set_points(s, points, n);
    for (int i = 0; i < n; i++, points += 3) {
        rng_unit_vector(d, points);
        points[0] *= x;
        points[1] *= y;
        points[2] *= z;
    }
    for (int i = 0; i < 3 * n; i++)
        s->centre[i % 3] += s->part.points[i] / n;
}

/* A coordinate where ties, coincidences and tiny differences are common. */
static double on_grid(rng_t *d)
{
    const double x = (rng_below(d, 5) - 2) / 2.;
    switch (rng_below(d, 10)) {
    case 0: return 8 * x * real_eps();
    case 1: return x + rng_uniform(d, -1e-6, 1e-6);
    default: return rng_below(d, 2) ? x : rng_uniform(d, -1, 1);
    }
}

/* The hull of a few points on a grid, perhaps inflated. */
static void make_grid(rng_t *d, body_t *s, double *points)
{
    const int n = 2 + rng_below(d, 8);
    set_points(s, points, n);
    s->margin = rng_below(d, 2) ? rng_uniform(d, 0, 1) : 0;
    for (int i = 0; i < 3 * n; i++) {
        points[i] = on_grid(d);
        s->centre[i % 3] += points[i] / n;
    }
}

static make_t *const plain[] = {make_box, make_ball, make_capsule, make_frustum, make_ellipsoid, make_hull};
static make_t *const odd[] = {make_star, make_teardrop, make_half_ball, make_superellipsoid, make_rounded_box, make_sum};

static void make_plain(rng_t *d, body_t *s, double *points) { plain[rng_below(d, 6)](d, s, points); }

static void make_any(rng_t *d, body_t *s, double *points)
{
    const int i = rng_below(d, 12);
    (i < 6 ? plain[i] : odd[i - 6])(d, s, points);
}

/* --- placements --------------------------------------------------------------------- */

enum {
    PLACE_RANDOM,    /* centres up to the sum of the reaches apart */
    PLACE_NEAR,      /* then to a depth or gap of 1e-12 to 0.1 of the smaller one */
    PLACE_PARALLEL,  /* turned alike but for 1e-12 to 1e-2 rad, and near */
    PLACE_TOUCHING,  /* turned alike or at random, and within 1e-14 of touching */
    PLACE_COINCIDENT, /* 1e-16 to 1e-2 apart and turned apart */
    PLACE_GRID        /* as they are: on one grid */
};

/* The orientation of a, and a small turn. */
static void place_alike(rng_t *d, const body_t *a, body_t *b, double least, double most)
{
    double u[3], r[9];
    rng_unit_vector(d, u);
    rotation_about(u[0], u[1], u[2], rng_log_uniform(d, least, most), r);
    rotation_times(r, a->m, b->m);
}

/* b to the depth (negative: the gap) along the direction of the least depth. */
static void place_at_depth(wide_pair_t *p, double depth)
{
    const bounds_t t = wide_bounds(&p->body[0], &p->body[1], 1e-8 * p->size, -HUGE_VAL, HUGE_VAL, 120);
    const double by = t.upper - depth;
    for (int i = 0; i < 3 && fabs(by) < HUGE_VAL; i++)
        p->body[1].at[i] += by * t.n[i];
}

static void place(rng_t *d, wide_pair_t *p, int placement)
{
    body_t *const a = &p->body[0], *const b = &p->body[1];
    const double small = fmin(body_reach(a), body_reach(b)), size = body_reach(a) + body_reach(b);
    double u[3], far;
    p->size = size;
    if (placement == PLACE_GRID) {
        for (int i = 0; i < 3 && rng_below(d, 4); i++)
            b->at[i] = on_grid(d);
        return;
    }
    rng_rotation(d, a->m);
    rng_rotation(d, b->m);
    if (placement == PLACE_PARALLEL || (placement == PLACE_TOUCHING && rng_below(d, 2)))
        place_alike(d, a, b, 1e-12, 1e-2);
    rng_unit_vector(d, u);
    far = rng_below(d, 2) ? rng_log_uniform(d, 1e-4, 1) : rng_uniform(d, 0, 1);
    if (placement == PLACE_COINCIDENT) {
        place_alike(d, a, b, 1e-16, 1e-2);
        far = rng_below(d, 4) ? rng_log_uniform(d, 1e-16, 1e-2) : 0;
    }
    for (int i = 0; i < 3; i++)
        b->at[i] = .6 * far * size * u[i];
    if (placement == PLACE_NEAR || placement == PLACE_PARALLEL)
        place_at_depth(p, (rng_below(d, 3) ? 1 : -1) * small * rng_log_uniform(d, 1e-12, .1));
    for (int once = 0; placement == PLACE_TOUCHING && once < 2; once++)
        place_at_depth(p, rng_uniform(d, -1e-14, 1e-14) * size);
}

/* --- rows --------------------------------------------------------------------------- */

typedef struct {
    const char *name;
    make_t *make[2];
    double ratio; /* of b's size to a's: down to this */
    int placement;
    double far; /* both bodies so far from the world's origin, metres */
} row_t;

static const row_t rows[] = {
    {"needles, aspect 1e2 to 1e4", {make_needle, make_needle}, .1, PLACE_RANDOM, 0},
    {"needles, 1e4 to 1e6", {make_fine_needle, make_fine_needle}, .1, PLACE_RANDOM, 0},
    {"needle and plate", {make_fine_needle, make_plate}, .1, PLACE_RANDOM, 0},
    {"plates", {make_plate, make_plate}, .1, PLACE_RANDOM, 0},
    {"plates, nearly parallel", {make_plate, make_plate}, .1, PLACE_PARALLEL, 0},
    {"frusta as plates, parallel", {make_frustum_plate, make_frustum_plate}, .1, PLACE_PARALLEL, 0},
    {"frusta, nearly parallel", {make_frustum, make_frustum}, .1, PLACE_PARALLEL, 0},
    {"star prism on frustum", {make_star, make_frustum}, .1, PLACE_PARALLEL, 0},
    {"star prism and any", {make_star, make_any}, .1, PLACE_RANDOM, 0},
    {"size 1e-6 on size 1", {make_any, make_plain}, 1e-6, PLACE_NEAR, 0},
    {"superellipsoids", {make_superellipsoid, make_superellipsoid}, .1, PLACE_NEAR, 0},
    {"teardrops", {make_teardrop, make_teardrop}, .3, PLACE_RANDOM, 0},
    {"teardrop and any", {make_teardrop, make_any}, .1, PLACE_NEAR, 0},
    {"half discs", {make_half_disc, make_half_disc}, .3, PLACE_RANDOM, 0},
    {"half disc and any", {make_half_disc, make_any}, .1, PLACE_RANDOM, 0},
    {"half balls, flat or tip", {make_half_ball, make_half_ball}, .3, PLACE_RANDOM, 0},
    {"rounded boxes", {make_rounded_box, make_rounded_box}, .1, PLACE_PARALLEL, 0},
    {"Minkowski sums", {make_sum, make_sum}, .1, PLACE_NEAR, 0},
    {"nearly coincident", {make_any, make_any}, 1, PLACE_COINCIDENT, 0},
    {"exactly touching", {make_any, make_any}, .1, PLACE_TOUCHING, 0},
    {"100 to 10,000 nearly coplanar vertices", {make_bent, make_bent}, .3, PLACE_PARALLEL, 0},
    {"1e5 m from the origin", {make_any, make_any}, .1, PLACE_NEAR, 1e5},
    {"ordinary", {make_plain, make_plain}, .3, PLACE_RANDOM, 0},
    {"ordinary, near", {make_plain, make_plain}, .3, PLACE_NEAR, 0},
    {"ball with a small flat, and ball", {make_cut_ball, make_ball}, .3, PLACE_RANDOM, 0},
    {"inflated hulls of points on a grid", {make_grid, make_grid}, 1, PLACE_GRID, 0},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

/* The same body is on both sides of a nearly coincident pair. */
static void scale_part(part_t *s, double k)
{
    for (int i = 0; i < (s->kind == PART_SUPERELLIPSOID ? 3 : 4); i++)
        s->p[i] *= k;
}

static void wide_pair(int row, uint64_t seed, uint64_t index, wide_pair_t *p)
{
    const row_t *const r = &rows[row];
    rng_t dd = rng(7000 + (uint64_t)row + 100 * seed, index), *d = &dd;
    double u[3];
    memset(p->body, 0, sizeof p->body);
    for (int k = 0; k < 2; k++) {
        p->body[k].m[0] = p->body[k].m[4] = p->body[k].m[8] = 1;
        r->make[k](d, &p->body[k], p->points[k]);
    }
    if (r->placement == PLACE_COINCIDENT) {
        p->body[1] = p->body[0];
    } else if (r->placement != PLACE_GRID) {
        const double ratio = rng_log_uniform(d, r->ratio, fmin(10 * r->ratio, 1)), by = ratio * body_reach(&p->body[0]) / body_reach(&p->body[1]);
        body_t *const b = &p->body[1];
        scale_part(&b->part, by);
        scale_part(&b->child, by);
        b->margin *= by;
        for (int i = 0; i < 3; i++)
            b->centre[i] *= by;
        for (int i = 0; i < 3 * b->part.count; i++)
            p->points[1][i] *= by;
    }
    if (r->placement != PLACE_COINCIDENT && rng_below(d, 2)) { /* either may be obj1 */
        const body_t a = p->body[0];
        p->body[0] = p->body[1];
        p->body[1] = a;
    }
    place(d, p, r->placement);
    rng_unit_vector(d, u);
    for (int k = 0; k < 2 && r->far > 0; k++)
        for (int i = 0; i < 3; i++)
            p->body[k].at[i] += r->far * u[i];
    p->largest = fmax(body_farthest(&p->body[0]), body_farthest(&p->body[1]));
}

/* The pair a frame later: b turned by up to so many rad and moved by as much of the size. */
static void wide_move(rng_t *d, wide_pair_t *p, double by)
{
    body_t *const b = &p->body[1];
    double u[3], r[9], m[9];
    rng_unit_vector(d, u);
    rotation_about(u[0], u[1], u[2], by * rng_uniform(d, 0, 1), r);
    rotation_times(r, b->m, m);
    memcpy(b->m, m, sizeof m);
    rng_unit_vector(d, u);
    for (int i = 0; i < 3; i++)
        b->at[i] += by * p->size * rng_uniform(d, 0, 1) * u[i];
}

#endif
