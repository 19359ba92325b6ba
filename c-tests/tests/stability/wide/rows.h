/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The rows of the table: two kinds of bodies, the ratio of their sizes, a placement. Pair i
 * of a row is always the same pair. */

#ifndef STABILITY_WIDE_ROWS_H
#define STABILITY_WIDE_ROWS_H

#include "bounds.h"
#include "harness/tolerances.h"

enum { BODY_POINTS = 10000 };

/* Owns its bodies' points: refer to it by pointer, do not copy it. */
typedef struct {
    body_t body[2];
    double points[2][3 * BODY_POINTS];
    double size, largest; /* of D; of the coordinates; metres */
} wide_pair_t;

/* --- bodies, about 1 large ---------------------------------------------------------- */

typedef enum {
    BODY_BOX, BODY_BALL, BODY_CAPSULE, BODY_FRUSTUM, BODY_ELLIPSOID, BODY_HULL, ORDINARY_BODIES,
    BODY_STAR = ORDINARY_BODIES, BODY_TEARDROP, BODY_HALF_BALL, BODY_SUPERELLIPSOID, BODY_ROUNDED_BOX, BODY_SUM, ANY_BODIES,
    BODY_NEEDLE = ANY_BODIES, BODY_FINE_NEEDLE, BODY_PLATE, BODY_FRUSTUM_PLATE, BODY_HALF_DISC, BODY_CUT_BALL, BODY_BENT_FACE,
    BODY_ON_GRID,
    BODY_ORDINARY, BODY_ANY /* a random one of the first line, of the first two */
} body_kind_t;

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

static double random_size(rng_t *r) { return rng_uniform(r, .1, 1); }

/* Needles are thin in two directions, plates in one. */
static void make_thin(rng_t *r, body_t *s, double aspect, int is_needle)
{
    const double x = 1 / aspect, y = is_needle ? x * random_size(r) : random_size(r);
    const int kind = rng_below(r, 3);
    if (kind < 2) {
        set_part(&s->part, kind ? PART_ELLIPSOID : PART_BOX, x, y, 1, 0);
    } else if (is_needle) {
        set_part(&s->part, PART_SEGMENT, 1, 0, 0, 0);
        s->margin = x;
    } else {
        set_part(&s->part, PART_FRUSTUM, random_size(r), -x, random_size(r), x);
    }
}

/* A star, and a smaller one turned by some angle above it. */
static void make_star(rng_t *r, body_t *s, double *points)
{
    const int arms = 3 + rng_below(r, 10);
    const double inner = rng_uniform(r, .2, .9), top = random_size(r), turn = rng_uniform(r, 0, 1);
    const double height = rng_log_uniform(r, 1e-3, 1);
    set_points(s, points, 4 * arms);
    for (int i = 0; i < 4 * arms; i++, points += 3) {
        const int is_top = i >= 2 * arms;
        const double angle = 3.14159265358979323846 * i / arms + is_top * turn;
        const double radius = (i % 2 ? inner : 1) * (is_top ? top : 1);
        points[0] = radius * cos(angle);
        points[1] = radius * sin(angle);
        points[2] = is_top ? height : -height;
    }
}

/* Thousands of vertices on a face that is hardly bent. */
static void make_bent_face(rng_t *r, body_t *s, double *points)
{
    const int n = (int)rng_log_uniform(r, 100, BODY_POINTS);
    const double bend = rng_log_uniform(r, 1e-12, 1e-2);
    set_points(s, points, n);
    for (int i = 0; i < n; i++, points += 3) {
        points[0] = rng_uniform(r, -1, 1);
        points[1] = rng_uniform(r, -1, 1);
        points[2] = i < n / 4 ? -.5 : .5 - bend * (points[0] * points[0] + points[1] * points[1]);
    }
}

static void set_centre_to_mean(body_t *s)
{
    for (int i = 0; i < 3 * s->part.count; i++)
        s->centre[i % 3] += s->part.points[i] / s->part.count;
}

static void make_hull(rng_t *r, body_t *s, double *points)
{
    const int n = 5 + rng_below(r, 60);
    const double x = random_size(r), y = random_size(r), z = random_size(r);
    set_points(s, points, n);
    for (int i = 0; i < n; i++, points += 3) {
        rng_unit_vector(r, points);
        points[0] *= x;
        points[1] *= y;
        points[2] *= z;
    }
    set_centre_to_mean(s);
}

/* A coordinate where ties, coincidences and tiny differences are common. */
static double grid_coordinate(rng_t *r)
{
    const double x = (rng_below(r, 5) - 2) / 2.;
    switch (rng_below(r, 10)) {
    case 0: return 8 * x * real_eps();
    case 1: return x + rng_uniform(r, -1e-6, 1e-6);
    default: return rng_below(r, 2) ? x : rng_uniform(r, -1, 1);
    }
}

/* The hull of a few points on a grid, perhaps inflated. */
static void make_on_grid(rng_t *r, body_t *s, double *points)
{
    const int n = 2 + rng_below(r, 8);
    set_points(s, points, n);
    s->margin = rng_below(r, 2) ? rng_uniform(r, 0, 1) : 0;
    for (int i = 0; i < 3 * n; i++)
        points[i] = grid_coordinate(r);
    set_centre_to_mean(s);
}

static void make_body(body_kind_t kind, rng_t *r, body_t *s, double *points)
{
    double x;
    switch (kind) {
    case BODY_BOX: set_part(&s->part, PART_BOX, random_size(r), random_size(r), random_size(r), 0); break;
    case BODY_BALL: s->margin = random_size(r); break;
    case BODY_CAPSULE:
        set_part(&s->part, PART_SEGMENT, random_size(r), 0, 0, 0);
        s->margin = random_size(r);
        break;
    case BODY_FRUSTUM:
        x = random_size(r);
        set_part(&s->part, PART_FRUSTUM, random_size(r), -x, rng_below(r, 4) ? random_size(r) : 0, x);
        break;
    case BODY_ELLIPSOID: set_part(&s->part, PART_ELLIPSOID, random_size(r), random_size(r), random_size(r), 0); break;
    case BODY_HULL: make_hull(r, s, points); break;
    case BODY_STAR: make_star(r, s, points); break;
    case BODY_TEARDROP:
        x = rng_uniform(r, .1, .7);
        set_part(&s->part, PART_TEARDROP, x, x * rng_uniform(r, 1.1, 4), 0, 0);
        s->centre[2] = rng_uniform(r, 0, .2) * x;
        break;
    case BODY_HALF_BALL:
        x = random_size(r);
        set_part(&s->part, PART_HALF_BALL, x, rng_below(r, 2) ? x * rng_uniform(r, .1, 2) : 0, 0, 0);
        s->centre[2] = -.3 * x;
        break;
    case BODY_SUPERELLIPSOID:
        set_part(&s->part, PART_SUPERELLIPSOID, random_size(r), random_size(r), random_size(r), rng_log_uniform(r, 1.05, 8));
        break;
    case BODY_ROUNDED_BOX:
        make_body(BODY_BOX, r, s, points);
        s->margin = rng_log_uniform(r, 1e-6, .5);
        break;
    case BODY_SUM:
        make_body(rng_below(r, 2) ? BODY_BOX : BODY_FRUSTUM, r, s, points);
        switch (rng_below(r, 3)) {
        case 0: set_part(&s->child, PART_DISC, rng_log_uniform(r, 1e-3, 1), 0, 0, 0); break;
        case 1: set_part(&s->child, PART_SEGMENT, rng_log_uniform(r, 1e-3, 1), 0, 0, 0); break;
        default: set_part(&s->child, PART_ELLIPSOID, random_size(r), rng_log_uniform(r, 1e-3, 1), random_size(r), 0); break;
        }
        if (rng_below(r, 3) == 0)
            s->margin = rng_log_uniform(r, 1e-3, .3);
        break;
    case BODY_NEEDLE: make_thin(r, s, rng_log_uniform(r, 1e2, 1e4), 1); break;
    case BODY_FINE_NEEDLE: make_thin(r, s, rng_log_uniform(r, 1e4, 1e6), 1); break;
    case BODY_PLATE: make_thin(r, s, rng_log_uniform(r, 1e2, 1e6), 0); break;
    case BODY_FRUSTUM_PLATE:
        x = rng_log_uniform(r, 1e-5, 1e-2);
        set_part(&s->part, PART_FRUSTUM, random_size(r), -x, random_size(r), x);
        break;
    case BODY_HALF_DISC:
        x = random_size(r);
        set_part(&s->part, PART_HALF_DISC, x, 0, 0, 0);
        s->centre[1] = .3 * x;
        break;
    case BODY_CUT_BALL:
        x = random_size(r);
        set_part(&s->part, PART_CUT_BALL, x, x * (1 - rng_log_uniform(r, 1e-3, .1)), 0, 0);
        break;
    case BODY_BENT_FACE: make_bent_face(r, s, points); break;
    case BODY_ON_GRID: make_on_grid(r, s, points); break;
    case BODY_ORDINARY: make_body((body_kind_t)rng_below(r, ORDINARY_BODIES), r, s, points); break;
    case BODY_ANY: make_body((body_kind_t)rng_below(r, ANY_BODIES), r, s, points); break;
    }
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

/* Gives b the orientation of a and a small turn. */
static void orient_alike(rng_t *d, const body_t *a, body_t *b, double least, double most)
{
    double u[3], r[9];
    rng_unit_vector(d, u);
    rotation_about(u[0], u[1], u[2], rng_log_uniform(d, least, most), r);
    rotation_times(r, a->rot, b->rot);
}

/* Moves b to the depth (negative: the gap) along the penetration direction. */
static void place_at_depth(wide_pair_t *p, double depth)
{
    const bounds_t t = wide_bounds(&p->body[0], &p->body[1], 1e-8 * p->size, -HUGE_VAL, HUGE_VAL, 120);
    const double by = t.upper - depth;
    for (int i = 0; i < 3 && fabs(by) < HUGE_VAL; i++)
        p->body[1].pos[i] += by * t.n[i];
}

static void place(rng_t *d, wide_pair_t *p, int placement)
{
    body_t *const a = &p->body[0], *const b = &p->body[1];
    const double small = fmin(body_reach(a), body_reach(b)), size = body_reach(a) + body_reach(b);
    double u[3], far;
    p->size = size;
    if (placement == PLACE_GRID) {
        for (int i = 0; i < 3 && rng_below(d, 4); i++)
            b->pos[i] = grid_coordinate(d);
        return;
    }
    rng_rotation(d, a->rot);
    rng_rotation(d, b->rot);
    if (placement == PLACE_PARALLEL || (placement == PLACE_TOUCHING && rng_below(d, 2)))
        orient_alike(d, a, b, 1e-12, 1e-2);
    rng_unit_vector(d, u);
    far = rng_below(d, 2) ? rng_log_uniform(d, 1e-4, 1) : rng_uniform(d, 0, 1);
    if (placement == PLACE_COINCIDENT) {
        orient_alike(d, a, b, 1e-16, 1e-2);
        far = rng_below(d, 4) ? rng_log_uniform(d, 1e-16, 1e-2) : 0;
    }
    for (int i = 0; i < 3; i++)
        b->pos[i] = .6 * far * size * u[i];
    if (placement == PLACE_NEAR || placement == PLACE_PARALLEL)
        place_at_depth(p, (rng_below(d, 3) ? 1 : -1) * small * rng_log_uniform(d, 1e-12, .1));
    for (int pass = 0; placement == PLACE_TOUCHING && pass < 2; pass++)
        place_at_depth(p, rng_uniform(d, -1e-14, 1e-14) * size);
}

/* --- rows --------------------------------------------------------------------------- */

typedef struct {
    const char *name;
    body_kind_t kind[2];
    double ratio; /* of b's size to a's: down to this */
    int placement;
    double far; /* both bodies so far from the world's origin, metres */
} row_t;

static const row_t rows[] = {
    {"needles, aspect 1e2 to 1e4", {BODY_NEEDLE, BODY_NEEDLE}, .1, PLACE_RANDOM, 0},
    {"needles, 1e4 to 1e6", {BODY_FINE_NEEDLE, BODY_FINE_NEEDLE}, .1, PLACE_RANDOM, 0},
    {"needle and plate", {BODY_FINE_NEEDLE, BODY_PLATE}, .1, PLACE_RANDOM, 0},
    {"plates", {BODY_PLATE, BODY_PLATE}, .1, PLACE_RANDOM, 0},
    {"plates, nearly parallel", {BODY_PLATE, BODY_PLATE}, .1, PLACE_PARALLEL, 0},
    {"frusta as plates, parallel", {BODY_FRUSTUM_PLATE, BODY_FRUSTUM_PLATE}, .1, PLACE_PARALLEL, 0},
    {"frusta, nearly parallel", {BODY_FRUSTUM, BODY_FRUSTUM}, .1, PLACE_PARALLEL, 0},
    {"star prism on frustum", {BODY_STAR, BODY_FRUSTUM}, .1, PLACE_PARALLEL, 0},
    {"star prism and any", {BODY_STAR, BODY_ANY}, .1, PLACE_RANDOM, 0},
    {"size 1e-6 on size 1", {BODY_ANY, BODY_ORDINARY}, 1e-6, PLACE_NEAR, 0},
    {"superellipsoids", {BODY_SUPERELLIPSOID, BODY_SUPERELLIPSOID}, .1, PLACE_NEAR, 0},
    {"teardrops", {BODY_TEARDROP, BODY_TEARDROP}, .3, PLACE_RANDOM, 0},
    {"teardrop and any", {BODY_TEARDROP, BODY_ANY}, .1, PLACE_NEAR, 0},
    {"half discs", {BODY_HALF_DISC, BODY_HALF_DISC}, .3, PLACE_RANDOM, 0},
    {"half disc and any", {BODY_HALF_DISC, BODY_ANY}, .1, PLACE_RANDOM, 0},
    {"half balls, flat or tip", {BODY_HALF_BALL, BODY_HALF_BALL}, .3, PLACE_RANDOM, 0},
    {"rounded boxes", {BODY_ROUNDED_BOX, BODY_ROUNDED_BOX}, .1, PLACE_PARALLEL, 0},
    {"Minkowski sums", {BODY_SUM, BODY_SUM}, .1, PLACE_NEAR, 0},
    {"nearly coincident", {BODY_ANY, BODY_ANY}, 1, PLACE_COINCIDENT, 0},
    {"exactly touching", {BODY_ANY, BODY_ANY}, .1, PLACE_TOUCHING, 0},
    {"100 to 10,000 nearly coplanar vertices", {BODY_BENT_FACE, BODY_BENT_FACE}, .3, PLACE_PARALLEL, 0},
    {"1e5 m from the origin", {BODY_ANY, BODY_ANY}, .1, PLACE_NEAR, 1e5},
    {"ordinary", {BODY_ORDINARY, BODY_ORDINARY}, .3, PLACE_RANDOM, 0},
    {"ordinary, near", {BODY_ORDINARY, BODY_ORDINARY}, .3, PLACE_NEAR, 0},
    {"ball with a small flat, and ball", {BODY_CUT_BALL, BODY_BALL}, .3, PLACE_RANDOM, 0},
    {"inflated hulls of points on a grid", {BODY_ON_GRID, BODY_ON_GRID}, 1, PLACE_GRID, 0},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

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
        p->body[k].rot[0] = p->body[k].rot[4] = p->body[k].rot[8] = 1;
        make_body(r->kind[k], d, &p->body[k], p->points[k]);
    }
    if (r->placement == PLACE_COINCIDENT) {
        p->body[1] = p->body[0]; /* the same body twice */
    } else if (r->placement != PLACE_GRID) {
        const double ratio = rng_log_uniform(d, r->ratio, fmin(10 * r->ratio, 1));
        const double by = ratio * body_reach(&p->body[0]) / body_reach(&p->body[1]);
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
            p->body[k].pos[i] += r->far * u[i];
    p->largest = fmax(body_farthest(&p->body[0]), body_farthest(&p->body[1]));
}

/* The pair a frame later: b turned by up to so many rad and moved by as much of the size. */
static void wide_move(rng_t *d, wide_pair_t *p, double by)
{
    body_t *const b = &p->body[1];
    double u[3], r[9], m[9];
    rng_unit_vector(d, u);
    rotation_about(u[0], u[1], u[2], by * rng_uniform(d, 0, 1), r);
    rotation_times(r, b->rot, m);
    memcpy(b->rot, m, sizeof m);
    rng_unit_vector(d, u);
    for (int i = 0; i < 3; i++)
        b->pos[i] += by * p->size * rng_uniform(d, 0, 1) * u[i];
}

#endif
