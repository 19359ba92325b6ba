/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Rows of pairs of bodies that are hard for one method or another: two kinds of bodies, the ratio of their sizes, a
 * placement. Pair i of a row is always the same pair. */

#ifndef STABILITY_BODIES_H
#define STABILITY_BODIES_H

#include "categories.h"

/* --- bodies, about 1 large ---------------------------------------------------------- */

typedef enum {
    BODY_BOX, BODY_BALL, BODY_CAPSULE, BODY_FRUSTUM, BODY_ELLIPSOID, BODY_HULL, ORDINARY_BODIES,
    BODY_STAR = ORDINARY_BODIES, BODY_TEARDROP, BODY_HALF_BALL, BODY_SUPERELLIPSOID, BODY_ROUNDED_BOX, BODY_SUM, ANY_BODIES,
    BODY_NEEDLE = ANY_BODIES, BODY_FINE_NEEDLE, BODY_PLATE, BODY_FRUSTUM_PLATE, BODY_HALF_DISC, BODY_CUT_BALL, BODY_BENT_FACE,
    BODY_ON_GRID,
    BODY_ORDINARY, BODY_ANY /* a random one of the first line, of the first two */
} body_kind_t;

static double random_size(rng_t *r) { return rng_uniform(r, .1, 1); }

static shape_t shape_make4(int type, double p0, double p1, double p2, double p3)
{
    shape_t s = shape_make(type, p0, p1, p2);
    s.p[3] = (ccd_real_t)p3;
    return s;
}

static void set_vertex(ccd_real_t *v, double x, double y, double z)
{
    v[0] = (ccd_real_t)x;
    v[1] = (ccd_real_t)y;
    v[2] = (ccd_real_t)z;
}

/* Adds another shape and a ball to the shape of a side. */
static void add_parts(pair_t *p, int side, shape_t other, double radius)
{
    shape_t *s = pair_side(p, side);
    p->parts[side][0] = *s;
    p->parts[side][1] = other;
    *s = shape_make(SHAPE_SUM, radius, 0, 0);
    s->parts = p->parts[side];
    memcpy(s->centre, s->parts[0].centre, sizeof s->centre);
}

/* Needles are thin in two directions, plates in one. */
static shape_t make_thin(rng_t *r, double aspect, int is_needle)
{
    const double x = 1 / aspect, y = is_needle ? x * random_size(r) : random_size(r);
    const int kind = rng_below(r, 3);
    if (kind < 2)
        return shape_make(kind ? SHAPE_ELLIPSOID : SHAPE_BOX, x, y, 1);
    if (is_needle)
        return shape_capsule(x, 1);
    const double low = random_size(r);
    return shape_make4(SHAPE_FRUSTUM, low, -x, random_size(r), x);
}

/* A star, and a smaller one turned by some angle above it. */
static shape_t make_star(rng_t *r, ccd_real_t *verts)
{
    const int arms = 3 + rng_below(r, 10);
    const double inner = rng_uniform(r, .2, .9), top = random_size(r), turn = rng_uniform(r, 0, 1);
    const double height = rng_log_uniform(r, 1e-3, 1);
    for (int i = 0; i < 4 * arms; i++) {
        const int is_top = i >= 2 * arms;
        const double angle = 3.14159265358979323846 * i / arms + is_top * turn;
        const double radius = (i % 2 ? inner : 1) * (is_top ? top : 1);
        set_vertex(verts + 3 * i, radius * cos(angle), radius * sin(angle), is_top ? height : -height);
    }
    shape_t s = shape_polytope(verts, 4 * arms);
    memset(s.centre, 0, sizeof s.centre);
    return s;
}

/* Thousands of vertices on a face that is hardly bent. */
static shape_t make_bent_face(rng_t *r, ccd_real_t *verts)
{
    const int n = (int)rng_log_uniform(r, 100, PAIR_VERTICES);
    const double bend = rng_log_uniform(r, 1e-12, 1e-2);
    for (int i = 0; i < n; i++) {
        const double x = rng_uniform(r, -1, 1), y = rng_uniform(r, -1, 1);
        set_vertex(verts + 3 * i, x, y, i < n / 4 ? -.5 : .5 - bend * (x * x + y * y));
    }
    shape_t s = shape_polytope(verts, n);
    memset(s.centre, 0, sizeof s.centre);
    return s;
}

static shape_t make_hull(rng_t *r, ccd_real_t *verts)
{
    const int n = 5 + rng_below(r, 60);
    const double x = random_size(r), y = random_size(r), z = random_size(r), axis[3] = {x, y, z};
    rng_on_ellipsoid(r, verts, n, axis);
    return shape_polytope(verts, n);
}

/* A coordinate where ties, coincidences and tiny differences are common. */
static ccd_real_t grid_coordinate(rng_t *r)
{
    const double x = (rng_below(r, 5) - 2) / 2.;
    switch (rng_below(r, 10)) {
    case 0: return (ccd_real_t)(8 * x * real_eps());
    case 1: return (ccd_real_t)(x + rng_uniform(r, -1e-6, 1e-6));
    default: return (ccd_real_t)(rng_below(r, 2) ? x : rng_uniform(r, -1, 1));
    }
}

/* Makes one side a body of this kind. */
static void make_body(body_kind_t kind, rng_t *r, pair_t *p, int side)
{
    shape_t *s = pair_side(p, side);
    ccd_real_t *verts = p->verts[side];
    const double x = random_size(r), y = random_size(r), z = random_size(r), w = random_size(r);
    switch (kind) {
    case BODY_BOX: *s = shape_box(x, y, z); break;
    case BODY_BALL: *s = shape_sphere(x); break;
    case BODY_CAPSULE: *s = shape_capsule(x, y); break;
    case BODY_FRUSTUM: *s = shape_make4(SHAPE_FRUSTUM, x, -y, rng_below(r, 4) ? z : 0, y); break;
    case BODY_ELLIPSOID: *s = shape_ellipsoid(x, y, z); break;
    case BODY_HULL: *s = make_hull(r, verts); break;
    case BODY_STAR: *s = make_star(r, verts); break;
    case BODY_TEARDROP:
        *s = shape_make(SHAPE_TEARDROP, x, x * rng_uniform(r, 1.1, 4), 0);
        s->centre[2] = (ccd_real_t)(rng_uniform(r, 0, .2) * x);
        break;
    case BODY_HALF_BALL:
        *s = shape_make(SHAPE_HALF_BALL, x, rng_below(r, 2) ? x * rng_uniform(r, .1, 2) : 0, 0);
        s->centre[2] = (ccd_real_t)(-.3 * x);
        break;
    case BODY_SUPERELLIPSOID: *s = shape_make4(SHAPE_SUPERELLIPSOID, x, y, z, rng_log_uniform(r, 1.05, 8)); break;
    case BODY_ROUNDED_BOX:
        *s = shape_box(x, y, z);
        add_parts(p, side, shape_sphere(0), rng_log_uniform(r, 1e-6, .5));
        break;
    case BODY_SUM: {
        const double thin = rng_log_uniform(r, 1e-3, 1), radius = rng_below(r, 3) ? 0 : rng_log_uniform(r, 1e-3, .3);
        const shape_t others[] = {shape_make4(SHAPE_FRUSTUM, thin, 0, thin, 0), shape_capsule(0, thin), shape_ellipsoid(w, thin, y)};
        make_body(rng_below(r, 2) ? BODY_BOX : BODY_FRUSTUM, r, p, side);
        add_parts(p, side, others[rng_below(r, 3)], radius);
        break;
    }
    case BODY_NEEDLE: *s = make_thin(r, rng_log_uniform(r, 1e2, 1e4), 1); break;
    case BODY_FINE_NEEDLE: *s = make_thin(r, rng_log_uniform(r, 1e4, 1e6), 1); break;
    case BODY_PLATE: *s = make_thin(r, rng_log_uniform(r, 1e2, 1e6), 0); break;
    case BODY_FRUSTUM_PLATE: {
        const double thin = rng_log_uniform(r, 1e-5, 1e-2);
        *s = shape_make4(SHAPE_FRUSTUM, x, -thin, y, thin);
        break;
    }
    case BODY_HALF_DISC:
        *s = shape_make(SHAPE_HALF_DISC, x, 0, 0);
        s->centre[1] = (ccd_real_t)(.3 * x);
        break;
    case BODY_CUT_BALL: *s = shape_make(SHAPE_CUT_BALL, x, x * (1 - rng_log_uniform(r, 1e-3, .1)), 0); break;
    case BODY_BENT_FACE: *s = make_bent_face(r, verts); break;
    case BODY_ON_GRID: {
        const int n = 2 + rng_below(r, 8);
        for (int i = 0; i < 3 * n; i++)
            verts[i] = grid_coordinate(r);
        *s = shape_polytope(verts, n);
        if (rng_below(r, 2))
            add_parts(p, side, shape_sphere(0), w);
        break;
    }
    case BODY_ORDINARY: make_body((body_kind_t)rng_below(r, ORDINARY_BODIES), r, p, side); break;
    case BODY_ANY: make_body((body_kind_t)rng_below(r, ANY_BODIES), r, p, side); break;
    }
}

static void scale_shape(shape_t *s, double k)
{
    for (int i = 0; i < (s->type == SHAPE_SUPERELLIPSOID ? 3 : 4); i++)
        s->p[i] *= (ccd_real_t)k;
}

/* Makes one side k times as large. */
static void scale_side(pair_t *p, int side, double k)
{
    shape_t *s = pair_side(p, side);
    scale_shape(s, k);
    for (int i = 0; i < 3; i++)
        s->centre[i] *= (ccd_real_t)k;
    for (int i = 0; i < 2; i++)
        scale_shape(&p->parts[side][i], k);
    const int n = s->type == SHAPE_SUM ? s->parts[0].nverts : s->nverts;
    for (int i = 0; i < 3 * n; i++)
        p->verts[side][i] *= (ccd_real_t)k;
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

/* Turns the shape about its position by the angle, about a random axis. */
static void turn_by(rng_t *d, shape_t *s, double angle)
{
    const shape_t old = *s;
    double u[3], r[9];
    rng_unit_vector(d, u);
    rotation_about(u[0], u[1], u[2], angle, r);
    shape_turn_by(s, r, 0, 0, 0);
    memcpy(s->pos, old.pos, sizeof s->pos);
}

/* Gives b the orientation of a and a small turn. */
static void orient_alike(rng_t *d, pair_t *p, double least)
{
    memcpy(p->b.rot, p->a.rot, sizeof p->b.rot);
    turn_by(d, &p->b, rng_log_uniform(d, least, 1e-2));
}

/* Sets the truth of a hard pair: to a quarter of the rounding error of a depth, or after so many splits. */
static void hard_truth(pair_t *p)
{
    const truth_end_t end = {pair_noise(&p->a, &p->b) / 4, 3000, -HUGE_VAL, HUGE_VAL};
    p->truth = truth_depth_until(&p->a, &p->b, end);
}

/* Moves b along the true normal to this depth. */
static void set_hard_depth(pair_t *p, double depth)
{
    hard_truth(p);
    shape_shift(&p->b, p->truth.depth - depth, p->truth.n);
}

static void place(rng_t *d, pair_t *p, int placement)
{
    const double small = fmin(shape_reach(&p->a), shape_reach(&p->b)), size = pair_size(&p->a, &p->b);
    double u[3], far;
    if (placement == PLACE_GRID) {
        for (int i = 0; i < 3 && rng_below(d, 4); i++)
            p->b.pos[i] = grid_coordinate(d);
        return;
    }
    pair_turn(d, &p->a);
    pair_turn(d, &p->b);
    if (placement == PLACE_PARALLEL || (placement == PLACE_TOUCHING && rng_below(d, 2)))
        orient_alike(d, p, 1e-12);
    rng_unit_vector(d, u);
    far = rng_below(d, 2) ? rng_log_uniform(d, 1e-4, 1) : rng_uniform(d, 0, 1);
    if (placement == PLACE_COINCIDENT) {
        orient_alike(d, p, 1e-16);
        far = rng_below(d, 4) ? rng_log_uniform(d, 1e-16, 1e-2) : 0;
    }
    pair_place(p, far * size, u);
    if (placement == PLACE_NEAR || placement == PLACE_PARALLEL)
        set_hard_depth(p, (rng_below(d, 3) ? 1 : -1) * small * rng_log_uniform(d, 1e-12, .1));
    for (int pass = 0; placement == PLACE_TOUCHING && pass < 2; pass++)
        set_hard_depth(p, rng_uniform(d, -1e-14, 1e-14) * size);
}

/* --- rows --------------------------------------------------------------------------- */

static const struct {
    const char *name;
    body_kind_t kind[2];
    double ratio; /* of b's size to a's: down to this */
    int placement;
    double far; /* both bodies so far from the world's origin, metres */
} hard_rows[] = {
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
enum { HARD_ROWS = sizeof hard_rows / sizeof hard_rows[0] };

static void hard_pair(int row, uint64_t seed, uint64_t index, pair_t *p)
{
    const int placement = hard_rows[row].placement;
    rng_t dd = rng(7000 + (uint64_t)row + 100 * seed, index), *d = &dd;
    double u[3];
    pair_clear(p);
    for (int k = 0; k < 2; k++)
        make_body(hard_rows[row].kind[k], d, p, k);
    if (placement == PLACE_COINCIDENT) {
        p->b = p->a; /* the same body twice */
    } else if (placement != PLACE_GRID) {
        const double ratio = rng_log_uniform(d, hard_rows[row].ratio, fmin(10 * hard_rows[row].ratio, 1));
        scale_side(p, 1, ratio * shape_reach(&p->a) / shape_reach(&p->b));
    }
    if (placement != PLACE_COINCIDENT && rng_below(d, 2)) { /* either may be obj1 */
        const shape_t a = p->a;
        p->a = p->b;
        p->b = a;
    }
    place(d, p, placement);
    rng_unit_vector(d, u);
    for (int k = 0; k < 2; k++)
        shape_shift(pair_side(p, k), hard_rows[row].far, u);
    hard_truth(p);
}

/* Makes the pair a frame later: b turned by up to so many rad and moved by as much of the size. */
static void hard_move(rng_t *d, pair_t *p, double by)
{
    double u[3];
    turn_by(d, &p->b, by * rng_uniform(d, 0, 1));
    rng_unit_vector(d, u);
    shape_shift(&p->b, by * pair_size(&p->a, &p->b) * rng_uniform(d, 0, 1), u);
    hard_truth(p);
}

#endif
