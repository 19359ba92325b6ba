/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Categories of pairs, which penetration methods fail at different rates. Pair i of a
 * category is always the same pair. */

#ifndef STABILITY_CATEGORIES_H
#define STABILITY_CATEGORIES_H

#include "judge.h"

#include <stddef.h>

/* --- pairs ---------------------------------------------------------------------- */

enum { HULL_VERTICES = 20, PAIR_VERTICES = 10000 };

/* Owns the parts of its sums and the vertices of its polytopes: refer to it by pointer, do not copy it. */
typedef struct {
    shape_t a, b;
    truth_t truth;
    double growth[2]; /* of h from the true normal: (h - depth) / angle^2, the least and across it */
    shape_t parts[2][2];
    ccd_real_t verts[2][3 * PAIR_VERTICES];
} pair_t;

/* Clears all but the vertices. */
static inline void pair_clear(pair_t *p) { memset(p, 0, offsetof(pair_t, verts)); }

static inline shape_t *pair_side(pair_t *p, int k) { return k ? &p->b : &p->a; }

/* Moves b to that distance along n. */
static inline void pair_place(pair_t *p, double at, const double n[3]) { shape_move(&p->b, at * n[0], at * n[1], at * n[2]); }

static inline void pair_turn(rng_t *d, shape_t *s)
{
    double r[9];
    rng_rotation(d, r);
    shape_turn(s, r);
}

/* Makes a hull of 4 to HULL_VERTICES points on an ellipsoid of the given size. */
static inline shape_t random_hull(rng_t *d, ccd_real_t *verts, double size)
{
    const int n = 4 + rng_below(d, HULL_VERTICES - 3);
    double axis[3];
    for (int k = 0; k < 3; k++)
        axis[k] = size * rng_uniform(d, .3, 1);
    rng_on_ellipsoid(d, verts, n, axis);
    return shape_polytope(verts, n);
}

/* Makes a convex polygon of 3 to 8 corners in the plane z = 0. */
static inline shape_t random_polygon(rng_t *d, ccd_real_t *verts, double size)
{
    int i, n = 3 + rng_below(d, 6);
    double turn = rng_uniform(d, 0, 6), stretch = rng_uniform(d, .2, 1);
    for (i = 0; i < n; i++) {
        double angle = turn + 6.283185307179586 * (i + rng_uniform(d, 0, .7)) / n;
        verts[3 * i] = (ccd_real_t)(size * cos(angle));
        verts[3 * i + 1] = (ccd_real_t)(size * stretch * sin(angle));
        verts[3 * i + 2] = 0;
    }
    return shape_polytope(verts, n);
}

static inline shape_t random_shape_of(rng_t *d, ccd_real_t *verts, shape_type_t type, double low, double high)
{
    double x = rng_uniform(d, low, high), y = rng_uniform(d, low, high), z = rng_uniform(d, low, high);
    return type == SHAPE_POLYTOPE ? random_hull(d, verts, x) : shape_make(type, x, y, z);
}

static const int all_types[] = {SHAPE_SPHERE, SHAPE_CAPSULE,   SHAPE_BOX,     SHAPE_CYLINDER,
                                SHAPE_CONE,   SHAPE_ELLIPSOID, SHAPE_POLYTOPE};

/* Makes one side a shape of one of these types. */
static inline void pair_set_random(rng_t *d, pair_t *p, int side, const int *kinds, int n, double low, double high)
{
    *pair_side(p, side) = random_shape_of(d, p->verts[side], (shape_type_t)kinds[rng_below(d, n)], low, high);
}

/* Makes both sides shapes of these types, turned at random. */
static inline void pair_set_both(rng_t *d, pair_t *p, const int *kinds, int n)
{
    for (int k = 0; k < 2; k++)
        pair_set_random(d, p, k, kinds, n, .1, 1);
    for (int k = 0; k < 2; k++)
        pair_turn(d, pair_side(p, k));
}

/* Moves b by up to part of both reaches, until they overlap by more than depth; negative: until they are farther
 * apart than that. */
static inline void pair_scatter(rng_t *d, pair_t *p, double part, double depth)
{
    for (int tries = 0; tries < 60; tries++) {
        double u[3];
        const double at = part * pair_size(&p->a, &p->b) * rng_uniform(d, 0, 1);
        rng_unit_vector(d, u);
        pair_place(p, at, u);
        truth_t t = truth_depth(&p->a, &p->b);
        if (depth < 0 ? t.depth < depth : t.lower > depth)
            return;
    }
    /* as last resort deep inside, or far out */
    shape_move(&p->b, depth < 0 ? 10 : 0, 0, 0);
}

/* Moves b along the true normal until only depth is left: exact, because the
 * minimum of h(n) - s n.m over n stays where it was. */
static inline void pair_set_depth(pair_t *p, double depth)
{
    const truth_t t = truth_depth(&p->a, &p->b);
    shape_shift(&p->b, t.depth - depth, t.n);
}

/* Returns h of the direction at angle psi of a circle about the true normal. */
static inline double value_around(const pair_t *p, const double u[3], const double v[3], double angle, double psi)
{
    double m[3];
    for (int k = 0; k < 3; k++)
        m[k] = p->truth.n[k] + angle * (cos(psi) * u[k] + sin(psi) * v[k]);
    return truth_support_value(&p->a, &p->b, m);
}

/* Computes how h grows from the true normal: in the tangent direction of least growth, and across it. */
static inline void pair_set_growth(pair_t *p)
{
    const double *n = p->truth.n, angle = .05, step = .1;
    double u[3], v[3], axis[3] = {0, 0, 0}, l, psi, best = 0, least = HUGE_VAL;
    int i;
    axis[fabs(n[0]) < .6 ? 0 : fabs(n[1]) < .6 ? 1 : 2] = 1;
    truth_cross3(n, axis, u);
    l = sqrt(truth_dot3(u, u));
    for (int k = 0; k < 3; k++)
        u[k] /= l;
    truth_cross3(n, u, v);
    for (psi = 0; psi < 6.3; psi += step)
        if (value_around(p, u, v, angle, psi) < least) {
            least = value_around(p, u, v, angle, psi);
            best = psi;
        }
    /* the minimum may be narrow: shrink the last interval by thirds */
    for (i = 0, l = step; i < 60; i++, l *= 2. / 3)
        for (int k = -1; k <= 1; k += 2)
            if (value_around(p, u, v, angle, best + k * l / 3) < least) {
                best += k * l / 3;
                least = value_around(p, u, v, angle, best);
            }
    p->growth[0] = fmax(least - p->truth.depth, 0) / (angle * angle);
    p->growth[1] = fmax(fmin(value_around(p, u, v, angle, best + 1.570796), value_around(p, u, v, angle, best - 1.570796))
                        - p->truth.depth, 0) / (angle * angle);
}

/* Returns whether a proof to this tolerance may need more support points than the library takes. At an
 * angle x from the minimum a face may be as wide as the square root of (tol + growth x^2) / size: in
 * all about size / growth times the logarithm of growth / tol, within a fifth of the counts. The limit
 * is half of the library's 350, because nearly concentric shapes have two minima. */
static inline int pair_may_reach_limit(const pair_t *p, double tol)
{
    /* the tolerance in force */
    double size = pair_size(&p->a, &p->b), x = fmax(fmin(tol, 1e-3 * size), pair_noise(&p->a, &p->b) / 2);
    double both = sqrt((p->growth[0] + x) * (p->growth[1] + x));
    return 1.2 * size / both * log(1 + 2 * both / x) > 180;
}

/* --- the categories --------------------------------------------------------------- */

#define CATEGORIES(X) \
    X(GENERIC, "generic random pose") \
    X(SHALLOW3, "shallow: depth 1e-3 of the size") \
    X(SHALLOW5, "shallow: depth 1e-5 of the size") \
    X(TOUCHING, "touching +-1e-12") \
    X(COINCIDENT, "coincident centres") \
    X(NEAR_COINCIDENT, "near-coincident centres 1e-8 to 1e-18") \
    X(GRID, "aligned boxes on a 1/8 grid") \
    X(KISSING, "tilted kissing boxes +-1e-15 to 1e-6") \
    X(AXIS, "centre offset along a shared axis") \
    X(TIES, "cube in cube: diagonal and face ties") \
    X(INSIDE, "small fully inside big") \
    X(THIN_BOXES, "boxes, aspect 1e2 to 1e6") \
    X(THIN_CAPSULES, "capsules, aspect 1e2 to 1e5") \
    X(FLAT, "flat polygon and solid") \
    X(FLAT_CENTRED, "flat polygon and solid, same centre") \
    X(SEGMENT, "segment or point and solid") \
    X(CAPSULES, "capsules parallel, coaxial, crossing") \
    X(CAPS, "cylinder caps face to face") \
    X(APEX, "cone apex on a face") \
    X(EDGES, "box edge on box edge") \
    X(ELLIPSOIDS, "ellipsoids, aspect 1 to 20") \
    X(CORNERS, "corners and rims that meet") \
    X(DISCS, "cylinders and cones resting on one axis") \
    X(CENTRED_SPHERE, "sphere near a solid's centre") \
    X(SCALED, "scale 1e-6 to 1e6, any depth") \
    X(FAR_6, "far from the origin 1e6") \
    X(FAR_8, "far from the origin 1e8") \
    X(APART, "separated") \
    X(CONCENTRIC, "nearly concentric round objects")

enum {
#define STABILITY_CATEGORY(name, text) CATEGORY_##name,
    CATEGORIES(STABILITY_CATEGORY)
#undef STABILITY_CATEGORY
        CATEGORY_COUNT
};

static inline const char *category_text(int category)
{
    static const char *const texts[] = {
#define STABILITY_CATEGORY_TEXT(name, text) text,
        CATEGORIES(STABILITY_CATEGORY_TEXT)
#undef STABILITY_CATEGORY_TEXT
    };
    return texts[category];
}

/* Makes two shapes that touch with their support points in a random direction, and pushes them into each
 * other by at most a thousandth of the size: corners and rims meet. */
static inline void make_corners(rng_t *d, pair_t *p)
{
    static const int kinds[] = {SHAPE_BOX, SHAPE_POLYTOPE, SHAPE_CYLINDER, SHAPE_CONE};
    double part = rng_log_uniform(d, 1e-5, 1e-3), deep;
    pair_set_both(d, p, kinds, 4);
    do {
        double u[3];
        truth_real s[3];
        deep = part * pair_size(&p->a, &p->b);
        rng_unit_vector(d, u);
        const truth_real n[3] = {u[0], u[1], u[2]};
        shape_move(&p->b, 0, 0, 0);
        truth_difference(&p->a, &p->b, n, s);
        shape_move(&p->b, (double)s[0], (double)s[1], (double)s[2]);
        shape_shift(&p->b, -deep, u);
        part *= 1.01; /* a thin edge may be thinner than that */
    } while (!(truth_depth(&p->a, &p->b).lower > deep / 10));
}

/* Makes a pair with minima all around: spheres, nearly round ellipsoids, a short capsule and a sphere,
 * cylinders on one axis. */
static inline void make_concentric(rng_t *d, pair_t *p)
{
    const double r = rng_uniform(d, .1, 1), s = rng_uniform(d, .1, 1), at = rng_log_uniform(d, 1e-12, .1) * (r + s);
    double u[3];
    const int which = rng_below(d, 4);
    p->a = which == 0 ? shape_sphere(r)
        : which == 1 ? shape_ellipsoid(r, r * rng_uniform(d, .98, 1), r * rng_uniform(d, .98, 1))
        : which == 2 ? shape_capsule(r, r * rng_log_uniform(d, 1e-4, .1))
                     : shape_cylinder(r, s);
    p->b = which == 1 ? shape_ellipsoid(s, s * rng_uniform(d, .98, 1), s * rng_uniform(d, .98, 1))
        : which == 3 ? shape_cylinder(s, r)
                     : shape_sphere(s);
    pair_turn(d, &p->a);
    if (which == 3)
        memcpy(p->b.rot, p->a.rot, sizeof p->b.rot);
    rng_unit_vector(d, u);
    pair_place(p, at, u);
}

/* Makes any two shapes, 1e-6 to 1e6 m large: apart to deep, on a shared axis, about one centre. */
static inline void make_scaled(rng_t *d, pair_t *p)
{
    enum { SCATTERED, DEEP, SHALLOW, ON_AXIS, NEARLY_CENTRED, CENTRED, PLACES };
    const double scale = pow(10, 3 * (rng_below(d, 5) - 2));
    const int place = rng_below(d, PLACES);
    double u[3], x;
    int k;
    for (k = 0; k < 2; k++)
        pair_set_random(d, p, k, all_types, SHAPE_TYPES, .1 * scale, scale);
    if (place != ON_AXIS || rng_below(d, 2))
        pair_turn(d, &p->a);
    if (place == ON_AXIS)
        memcpy(p->b.rot, p->a.rot, sizeof p->b.rot);
    else
        pair_turn(d, &p->b);
    switch (place) {
    case SCATTERED:
    case SHALLOW:
        pair_scatter(d, p, 1, 1e-3 * scale);
        if (place == SHALLOW)
            pair_set_depth(p, pair_size(&p->a, &p->b) * rng_log_uniform(d, 1e-8, 1e-2));
        break;
    case DEEP:
        pair_scatter(d, p, .2, 1e-3 * scale);
        break;
    case ON_AXIS:
        x = rng_uniform(d, 0, .3) * scale;
        k = rng_below(d, 3);
        shape_move(&p->b, x * (double)p->a.rot[k], x * (double)p->a.rot[3 + k], x * (double)p->a.rot[6 + k]);
        break;
    case NEARLY_CENTRED:
        rng_unit_vector(d, u);
        pair_place(p, scale * rng_log_uniform(d, 1e-18, 1e-4), u);
        break;
    default:
        break;
    }
}

/* Makes two capsules: parallel, coaxial, crossing or nearly. */
static inline void make_capsules(rng_t *d, pair_t *p)
{
    double x, r[9];
    p->a = shape_capsule(rng_uniform(d, .1, .5), rng_uniform(d, .1, 1));
    p->b = shape_capsule(rng_uniform(d, .1, .5), rng_uniform(d, .1, 1));
    x = (double)p->a.p[0] + (double)p->b.p[0];
    switch (rng_below(d, 3)) {
    case 0:
        shape_move(&p->b, rng_uniform(d, .1, .9) * x, 0, rng_uniform(d, -.3, .3));
        break;
    case 1:
        shape_move(&p->b, 0, 0, rng_uniform(d, 0, (double)p->a.p[1]));
        break;
    default:
        rotation_about(1, 0, 0, rng_uniform(d, .1, 1.5707963267949), r);
        shape_turn(&p->b, r);
        shape_move(&p->b, rng_below(d, 2) ? 0 : rng_uniform(d, 0, .9) * x, 0, 0);
        break;
    }
}

static inline double random_eighths(rng_t *d, int least, int n) { return (least + rng_below(d, n)) / 8.; }

/* Zero, half of the time. */
static inline double random_offset(rng_t *d, double by) { return rng_below(d, 2) ? 0 : rng_uniform(d, -by, by); }

/* Makes pair number index of a category, with its truth. */
static inline void category_pair(int category, uint64_t index, int tie, pair_t *p)
{
    static const int solid[] = {SHAPE_CYLINDER, SHAPE_POLYTOPE, SHAPE_BOX};
    static const double pi = 3.14159265358979323846;
    rng_t dd = rng((uint64_t)category + 1, index), *d = &dd;
    double u[3], r[9], x, y, z;
    int k;
    pair_clear(p);
    switch (category) {
    case CATEGORY_GENERIC:
    case CATEGORY_APART:
        pair_set_both(d, p, all_types, SHAPE_TYPES);
        pair_scatter(d, p, category == CATEGORY_APART ? 1.5 : 1, category == CATEGORY_APART ? -1e-3 : 1e-3);
        break;
    case CATEGORY_SHALLOW3:
    case CATEGORY_SHALLOW5:
    case CATEGORY_TOUCHING:
        pair_set_both(d, p, all_types, SHAPE_TYPES);
        pair_scatter(d, p, 1, 1e-3);
        x = pair_size(&p->a, &p->b);
        pair_set_depth(p, category == CATEGORY_SHALLOW3   ? 1e-3 * x
                          : category == CATEGORY_SHALLOW5 ? 1e-5 * x
                                                          : rng_sign(d) * 1e-12);
        break;
    case CATEGORY_COINCIDENT:
    case CATEGORY_NEAR_COINCIDENT:
        pair_set_both(d, p, all_types, SHAPE_TYPES);
        if (category == CATEGORY_NEAR_COINCIDENT) {
            rng_unit_vector(d, u);
            pair_place(p, rng_log_uniform(d, 1e-18, 1e-8), u);
        }
        break;
    case CATEGORY_GRID:
        for (k = 0; k < 2; k++)
            *pair_side(p, k) = shape_box(random_eighths(d, 1, 8), random_eighths(d, 1, 8), random_eighths(d, 1, 8));
        shape_move(&p->b, random_eighths(d, -4, 9), random_eighths(d, -4, 9), random_eighths(d, -4, 9));
        break;
    case CATEGORY_KISSING: {
        const double gap = rng_sign(d) * rng_log_uniform(d, 1e-15, 1e-6);
        const int axis = rng_below(d, 3);
        rng_rotation(d, r);
        p->a = random_shape_of(d, NULL, SHAPE_BOX, .1, 1);
        shape_turn(&p->a, r);
        p->b = p->a;
        for (k = 0; k < 3; k++)
            u[k] = r[3 * k + axis];
        pair_place(p, 2 * (double)p->a.p[axis] + gap, u);
        break;
    }
    case CATEGORY_AXIS: {
        const int kind = rng_below(d, SHAPE_POLYTOPE); /* all types before it: no hull */
        p->a = random_shape_of(d, NULL, kind, .1, 1);
        p->b = random_shape_of(d, NULL, rng_below(d, 2) ? kind : rng_below(d, SHAPE_POLYTOPE), .1, 1);
        x = rng_uniform(d, 0, .9) * .3;
        p->b.pos[rng_below(d, 3)] = (ccd_real_t)x;
        break;
    }
    case CATEGORY_TIES:
        x = rng_uniform(d, .3, 1);
        y = x * rng_uniform(d, .1, 1);
        p->a = shape_box(x, x, x);
        p->b = rng_below(d, 3) ? shape_box(y, y, y) : shape_sphere(y);
        z = rng_uniform(d, 0, x);
        k = rng_below(d, 3);
        shape_move(&p->b, z, k < 2 ? z : 0, k < 1 ? z : 0);
        break;
    case CATEGORY_INSIDE:
        for (k = 0; k < 2; k++) {
            pair_set_random(d, p, k, all_types, SHAPE_TYPES, k ? .01 : .5, k ? .1 : 1);
            pair_turn(d, pair_side(p, k));
        }
        pair_scatter(d, p, .3, 2 * shape_reach(&p->b));
        break;
    case CATEGORY_THIN_BOXES:
        for (k = 0; k < 2; k++) {
            x = rng_log_uniform(d, 1e2, 1e6);
            *pair_side(p, k) = rng_below(d, 2) ? shape_box(1, rng_uniform(d, .3, 1), 1 / x)
                                               : shape_box(1, 1 / x, rng_uniform(d, .5, 2) / x);
            pair_turn(d, pair_side(p, k));
        }
        pair_scatter(d, p, .1, 0);
        break;
    case CATEGORY_THIN_CAPSULES:
        x = rng_log_uniform(d, 1e2, 1e5);
        p->a = shape_capsule(1 / x, 1);
        p->b = shape_capsule(rng_uniform(d, .5, 2) / x, rng_uniform(d, .5, 1));
        pair_turn(d, &p->a);
        pair_turn(d, &p->b);
        rng_unit_vector(d, u);
        /* axes at most this far apart; then moved along a's axis */
        pair_place(p, rng_uniform(d, 0, 1) / x, u);
        for (k = 0; k < 3; k++)
            u[k] = (double)p->a.rot[3 * k + 2];
        shape_shift(&p->b, rng_uniform(d, -.5, .5), u);
        break;
    case CATEGORY_FLAT:
    case CATEGORY_FLAT_CENTRED:
        p->a = random_polygon(d, p->verts[0], rng_uniform(d, .1, 1));
        pair_turn(d, &p->a);
        pair_set_random(d, p, 1, all_types, SHAPE_TYPES, .1, 1);
        pair_turn(d, &p->b);
        if (category == CATEGORY_FLAT) {
            pair_scatter(d, p, .7, 1e-4);
        } else {
            ccd_vec3_t ca, cb;
            shape_center(&p->a, &ca);
            shape_center(&p->b, &cb);
            shape_move(&p->b, (double)(ca.v[0] - cb.v[0]), (double)(ca.v[1] - cb.v[1]), (double)(ca.v[2] - cb.v[2]));
        }
        break;
    case CATEGORY_SEGMENT:
        x = rng_below(d, 2) ? rng_uniform(d, .1, 1) : 0;
        memset(p->verts[0], 0, 6 * sizeof *p->verts[0]);
        p->verts[0][2] = (ccd_real_t)-x;
        p->verts[0][5] = (ccd_real_t)x;
        p->a = shape_polytope(p->verts[0], x > 0 ? 2 : 1);
        pair_turn(d, &p->a);
        pair_set_random(d, p, 1, all_types, SHAPE_TYPES, .1, 1);
        pair_turn(d, &p->b);
        pair_scatter(d, p, .5, 1e-4);
        break;
    case CATEGORY_CAPSULES:
        make_capsules(d, p);
        break;
    case CATEGORY_CAPS:
        p->a = shape_cylinder(rng_uniform(d, .2, 1), rng_uniform(d, .1, 1));
        p->b = shape_cylinder(rng_uniform(d, .2, 1), rng_uniform(d, .1, 1));
        x = rng_log_uniform(d, 1e-4, .05);
        shape_move(&p->b, random_offset(d, .1), random_offset(d, .1), (double)p->a.p[1] + (double)p->b.p[1] - x);
        break;
    case CATEGORY_APEX:
        p->a = rng_below(d, 2) ? shape_box(rng_uniform(d, .3, 1), rng_uniform(d, .3, 1), rng_uniform(d, .1, 1))
                                : shape_cylinder(rng_uniform(d, .3, 1), rng_uniform(d, .1, 1));
        p->b = shape_cone(rng_uniform(d, .1, 1), rng_uniform(d, .1, 1));
        rotation_about(1, 0, 0, pi, r);
        shape_turn(&p->b, r);
        x = rng_log_uniform(d, 1e-6, .3);
        z = (double)p->a.p[p->a.type == SHAPE_BOX ? 2 : 1];
        shape_move(&p->b, random_offset(d, .2), random_offset(d, .2), z + (double)p->b.p[1] - x);
        break;
    case CATEGORY_EDGES:
        x = rng_uniform(d, .2, 1);
        y = rng_uniform(d, .2, 1);
        p->a = shape_box(x, x, rng_uniform(d, .5, 1));
        p->b = shape_box(y, rng_uniform(d, .5, 1), y);
        for (k = 0; k < 2; k++) {
            rotation_about(0, k, !k, pi / 4, r);
            shape_turn(pair_side(p, k), r);
        }
        shape_move(&p->b, (x + y) * sqrt(2) - rng_log_uniform(d, 1e-6, .1), rng_uniform(d, -.2, .2), rng_uniform(d, -.2, .2));
        break;
    case CATEGORY_ELLIPSOIDS:
        for (k = 0; k < 2; k++) {
            x = rng_uniform(d, .3, 1);
            *pair_side(p, k) = shape_ellipsoid(x, x / rng_log_uniform(d, 1, 20), x / rng_log_uniform(d, 1, 20));
            pair_turn(d, pair_side(p, k));
        }
        pair_scatter(d, p, .7, 1e-4);
        break;
    case CATEGORY_CORNERS:
        make_corners(d, p);
        break;
    case CATEGORY_DISCS:
        for (k = 0; k < 2; k++)
            *pair_side(p, k) = (rng_below(d, 2) ? shape_cylinder : shape_cone)(rng_uniform(d, .1, 1), rng_uniform(d, .1, 1));
        x = rng_uniform(d, 0, 6.28);
        y = rng_uniform(d, 0, (double)p->a.p[0]);
        u[0] = y * cos(x);
        u[1] = y * sin(x);
        u[2] = (double)p->a.p[1] + (double)p->b.p[1] - rng_sign(d) * rng_log_uniform(d, 1e-12, 1e-2);
        rng_rotation(d, r);
        shape_turn(&p->a, r);
        shape_turn(&p->b, r);
        shape_move(&p->b, truth_dot3(r, u), truth_dot3(r + 3, u), truth_dot3(r + 6, u));
        break;
    case CATEGORY_CENTRED_SPHERE:
        pair_set_random(d, p, 0, solid, 3, .1, 1);
        pair_turn(d, &p->a);
        p->b = shape_sphere(rng_uniform(d, .1, 1));
        rng_unit_vector(d, u);
        pair_place(p, rng_log_uniform(d, 1e-3, .3) * shape_reach(&p->a), u);
        break;
    case CATEGORY_SCALED:
        make_scaled(d, p);
        break;
    case CATEGORY_FAR_6:
    case CATEGORY_FAR_8:
        pair_set_both(d, p, all_types, SHAPE_TYPES);
        pair_scatter(d, p, 1, 1e-3);
        rng_unit_vector(d, u);
        for (k = 0; k < 2; k++)
            shape_shift(pair_side(p, k), category == CATEGORY_FAR_6 ? 1e6 : 1e8, u);
        break;
    default:
        make_concentric(d, p);
        break;
    }
    p->a.tie = p->b.tie = tie;
    /* with minima all around only as close as it is judged */
    p->truth = truth_depth_within(&p->a, &p->b, (category == CATEGORY_CONCENTRIC ? 1e-5 : 1e-12) * pair_size(&p->a, &p->b));
    pair_set_growth(p);
}

#endif
