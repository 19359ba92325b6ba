/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The signed depth that every test is judged by, as a proven interval, in long double (64 bits on x86).
 *
 * With D = A - B and its support value h(n) = max over D of n.x, the signed depth
 * is the minimum of h over all unit n: the penetration depth when the shapes
 * overlap, minus their distance when they do not. Every h(n) is an upper bound.
 *
 * The lower bound comes from branch and bound over the sphere of directions, which
 * shares neither code nor idea with the library. On a spherical triangle with
 * corners n_i and any convex combination g of support points,
 * h(n) >= g.n >= min g.n_i (h(n) >= g.n because g lies in D; the second because
 * n = (sum l_i n_i) / |sum l_i n_i| with |..| <= 1). g is the best combination of
 * the three corners' support points, a matrix game of three rows and columns. The
 * error of that bound falls with the square of the triangle. Triangles are split
 * in four, the one with the least bound first, until the bounds meet. Balls are
 * taken off before and added after: h of a sum with a ball is larger by its radius. */

#ifndef TESTS_TRUTH_H
#define TESTS_TRUTH_H

#include "harness/shapes.h"

#include <float.h>

enum { TRUTH_SPLITS = 20000 };

typedef struct {
    double depth;  /* upper bound of the signed depth, attained by n */
    double lower;  /* proven lower bound */
    double n[3];   /* unit: B leaves along it */
} truth_t;

typedef long double truth_real;

static inline double truth_dot3(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static inline void truth_cross3(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static inline truth_real truth_dot(const truth_real a[3], const truth_real b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void truth_minus(const truth_real a[3], const truth_real b[3], truth_real out[3])
{
    out[0] = a[0] - b[0];
    out[1] = a[1] - b[1];
    out[2] = a[2] - b[2];
}

static inline void truth_product(const truth_real a[3], const truth_real b[3], truth_real out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Writes unit a x b. Returns 0 when they are parallel within long double. */
static inline int truth_cross(const truth_real a[3], const truth_real b[3], truth_real out[3])
{
    truth_real l, scale = sqrtl(truth_dot(a, a) * truth_dot(b, b));
    truth_product(a, b, out);
    l = sqrtl(truth_dot(out, out));
    if (!(l > 1e-15L * scale))
        return 0;
    out[0] /= l;
    out[1] /= l;
    out[2] /= l;
    return 1;
}

/* --- support in long double ---------------------------------------------------- */

/* Writes the farthest vertex in long double, of those that are farthest in double. */
static inline void truth_farthest(const shape_t *s, const truth_real d[3], truth_real v[3])
{
    const double n[3] = {(double)d[0], (double)d[1], (double)d[2]};
    const double length = fabs(n[0]) + fabs(n[1]) + fabs(n[2]);
    double most = -HUGE_VAL, size = 0;
    truth_real best = -HUGE_VALL;
    const ccd_real_t *p = s->verts;
    for (int i = 0; i < s->nverts; i++, p += 3) {
        const double x = (double)p[0] * n[0] + (double)p[1] * n[1] + (double)p[2] * n[2];
        const double reach = fabs((double)p[0]) + fabs((double)p[1]) + fabs((double)p[2]);
        most = x > most ? x : most;
        size = reach > size ? reach : size;
    }
    p = s->verts;
    for (int i = 0; i < s->nverts; i++, p += 3)
        if ((double)p[0] * n[0] + (double)p[1] * n[1] + (double)p[2] * n[2] >= most - 1e-14 * size * length) {
            const truth_real x = p[0] * d[0] + p[1] * d[1] + p[2] * d[2];
            if (x > best) {
                best = x;
                v[0] = p[0];
                v[1] = p[1];
                v[2] = p[2];
            }
        }
}

#define REAL truth_real
#define FN(name) truth_##name
#define ROOT sqrtl
#define POWER powl
#include "harness/shape_support.h"
#undef REAL
#undef FN
#undef ROOT
#undef POWER

/* Writes the support point of one shape along w, of any length, relative to origin. */
static inline void truth_support_from(const shape_t *s, const ccd_real_t origin[3], const truth_real w[3], truth_real out[3])
{
    truth_real d[3], v[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++)
        d[i] = s->rot[i] * w[0] + s->rot[3 + i] * w[1] + s->rot[6 + i] * w[2];
    truth_local_support(s, d, v);
    for (int i = 0; i < 3; i++)
        out[i] = s->rot[3 * i] * v[0] + s->rot[3 * i + 1] * v[1] + s->rot[3 * i + 2] * v[2] + ((truth_real)s->pos[i] - origin[i]);
}

/* Writes the support point of D = A - B along n. */
static inline void truth_difference(const shape_t *a, const shape_t *b, const truth_real n[3], truth_real out[3])
{
    const truth_real m[3] = {-n[0], -n[1], -n[2]};
    truth_real x[3], y[3];
    truth_support_from(a, a->pos, n, x);
    truth_support_from(b, a->pos, m, y);
    truth_minus(x, y, out);
}

/* Returns h(n) per unit length, for a direction of any length but zero. */
static inline double truth_support_value(const shape_t *a, const shape_t *b, const double dir[3])
{
    const truth_real n[3] = {dir[0], dir[1], dir[2]};
    truth_real s[3];
    truth_difference(a, b, n, s);
    return (double)(truth_dot(n, s) / sqrtl(truth_dot(n, n)));
}

/* Writes the support point along w in double, relative to origin. */
static inline void truth_support(const shape_t *s, const double origin[3], const double w[3], double out[3])
{
    const truth_real n[3] = {w[0], w[1], w[2]};
    const ccd_real_t world[3] = {0, 0, 0};
    truth_real point[3];
    truth_support_from(s, world, n, point);
    for (int i = 0; i < 3; i++)
        out[i] = (double)(point[i] - origin[i]);
}

/* Returns the radius of a ball about the shape's position that encloses it. */
static inline double shape_reach(const shape_t *s)
{
    const double p0 = (double)s->p[0], p1 = (double)s->p[1], p2 = (double)s->p[2], p3 = (double)s->p[3];
    double most = 0;
    switch (s->type) {
    case SHAPE_SPHERE:
        return p0;
    case SHAPE_CAPSULE:
        return p0 + p1;
    case SHAPE_BOX:
        return sqrt(p0 * p0 + p1 * p1 + p2 * p2);
    case SHAPE_CYLINDER:
    case SHAPE_CONE:
        return sqrt(p0 * p0 + p1 * p1);
    case SHAPE_ELLIPSOID:
        return fmax(p0, fmax(p1, p2));
    case SHAPE_POLYTOPE:
        for (int i = 0; i < s->nverts; i++) {
            double x = (double)s->verts[3 * i], y = (double)s->verts[3 * i + 1], z = (double)s->verts[3 * i + 2];
            most = fmax(most, sqrt(x * x + y * y + z * z));
        }
        break;
    case SHAPE_FRUSTUM:
        return fmax(sqrt(p0 * p0 + p1 * p1), sqrt(p2 * p2 + p3 * p3));
    case SHAPE_SUPERELLIPSOID:
        return sqrt(p0 * p0 + p1 * p1 + p2 * p2);
    case SHAPE_TEARDROP:
    case SHAPE_HALF_BALL:
        return fmax(p0, p1);
    case SHAPE_HALF_DISC:
    case SHAPE_CUT_BALL:
        return p0;
    case SHAPE_SUM:
        return shape_reach(s->parts) + shape_reach(s->parts + 1) + p0;
    }
    return most;
}

/* The unit of length that relative tolerances refer to: both reaches. */
static inline double pair_size(const shape_t *a, const shape_t *b) { return shape_reach(a) + shape_reach(b); }

/* The largest coordinate that a callback computes with: what one ulp refers to. */
static inline double largest_coordinate(const shape_t *a, const shape_t *b)
{
    double most = 0;
    for (int i = 0; i < 3; i++)
        most = fmax(most, fmax(fabs((double)a->pos[i]), fabs((double)b->pos[i])));
    return most + pair_size(a, b);
}

/* --- branch and bound --------------------------------------------------------- */

typedef struct {
    truth_real n[3][3]; /* corners, unit */
    truth_real s[3][3]; /* support points there */
    truth_real bound;
} truth_triangle_t;

static inline truth_real truth_least(const truth_real x[3])
{
    const truth_real least = x[0] < x[1] ? x[0] : x[1];
    return least < x[2] ? least : x[2];
}

/* Returns the value of the 3 x 3 matrix game: the largest, over convex weights of the rows, of the least
 * column. Candidates: single rows, two rows where two columns are equal, all three where all columns
 * are; each is a lower bound. */
static inline truth_real truth_game(truth_real m[3][3])
{
    truth_real best = -HUGE_VALL, mixed[3], value, d[3], e[3], w[3], sum;
    for (int k = 0; k < 3; k++) {
        const truth_real *p = m[k], *q = m[(k + 1) % 3];
        value = truth_least(p);
        best = value > best ? value : best;
        for (int i = 0; i < 3; i++) {
            const truth_real u = p[i] - p[(i + 1) % 3], v = q[i] - q[(i + 1) % 3];
            const truth_real t = u / (u - v); /* weight of q where the columns meet */
            if (!(t > 0 && t < 1))
                continue;
            for (int c = 0; c < 3; c++)
                mixed[c] = (1 - t) * p[c] + t * q[c];
            value = truth_least(mixed);
            best = value > best ? value : best;
        }
        d[k] = m[k][0] - m[k][1];
        e[k] = m[k][0] - m[k][2];
    }
    /* weights with equal columns: across both column differences */
    truth_product(d, e, w);
    sum = w[0] + w[1] + w[2];
    if (sum != 0 && w[0] / sum >= 0 && w[1] / sum >= 0 && w[2] / sum >= 0) {
        for (int c = 0; c < 3; c++)
            mixed[c] = (w[0] * m[0][c] + w[1] * m[1][c] + w[2] * m[2][c]) / sum;
        value = truth_least(mixed);
        best = value > best ? value : best;
    }
    return best;
}

/* Returns the square of the longest edge. */
static inline truth_real truth_edge2(const truth_triangle_t *t)
{
    truth_real most = 0, e[3], l;
    for (int k = 0; k < 3; k++) {
        truth_minus(t->n[k], t->n[(k + 1) % 3], e);
        l = truth_dot(e, e);
        most = l > most ? l : most;
    }
    return most;
}

/* Returns a lower bound of h in the triangle. */
static inline truth_real truth_bound(const truth_triangle_t *t)
{
    truth_real m[3][3], value;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            m[k][i] = truth_dot(t->s[k], t->n[i]);
    value = truth_game(m);
    if (value < 0)
        /* then |sum l_i n_i| counts: its square is 1 - sum l_i l_j |n_i - n_j|^2 over
         * the three edges, and sum l_i l_j is at most 1/3 */
        value /= sqrtl(1 - truth_edge2(t) / 3);
    return value;
}

/* What is found, and a heap of triangles. */
typedef struct {
    const shape_t *a, *b;
    truth_real depth, n[3]; /* the least h, and its direction */
    truth_triangle_t *heap;
    int count;
} truth_branch_t;

static inline void truth_push(truth_branch_t *h, const truth_triangle_t *t)
{
    int i = h->count++;
    while (i > 0 && h->heap[(i - 1) / 2].bound > t->bound) {
        h->heap[i] = h->heap[(i - 1) / 2];
        i = (i - 1) / 2;
    }
    h->heap[i] = *t;
}

static inline void truth_pop(truth_branch_t *h, truth_triangle_t *top)
{
    truth_triangle_t *last = &h->heap[--h->count];
    int i = 0;
    *top = h->heap[0];
    for (int c = 1; c < h->count; c = 2 * i + 1) {
        if (c + 1 < h->count && h->heap[c + 1].bound < h->heap[c].bound)
            c++;
        if (!(h->heap[c].bound < last->bound))
            break;
        h->heap[i] = h->heap[c];
        i = c;
    }
    h->heap[i] = *last;
}

/* Samples D along n, of any length but zero, which becomes unit; stores the direction if it is the best. */
static inline void truth_sample(truth_branch_t *h, truth_real n[3], truth_real s[3])
{
    truth_real l = sqrtl(truth_dot(n, n)), value;
    for (int i = 0; i < 3; i++)
        n[i] /= l;
    truth_difference(h->a, h->b, n, s);
    value = truth_dot(n, s);
    if (value < h->depth) {
        h->depth = value;
        memcpy(h->n, n, sizeof h->n);
    }
}

/* Samples the plane of the three support points, and the middles of the edges; adds the four parts. */
static inline void truth_split(truth_branch_t *h, const truth_triangle_t *t)
{
    truth_real mid[3][3], point[3][3], u[3], v[3], x[3], s[3];
    truth_triangle_t child;
    truth_minus(t->s[1], t->s[0], u);
    truth_minus(t->s[2], t->s[0], v);
    truth_product(u, v, x);
    if (truth_dot(x, t->n[0]) + truth_dot(x, t->n[1]) + truth_dot(x, t->n[2]) < 0)
        truth_product(v, u, x);
    if (truth_dot(x, x) > 0)
        truth_sample(h, x, s);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++)
            mid[k][i] = t->n[k][i] + t->n[(k + 1) % 3][i];
        truth_sample(h, mid[k], point[k]);
    }
    for (int m = 0; m < 4; m++) {
        for (int k = 0; k < 3; k++) {
            /* child m < 3 keeps corner m; the fourth is the middle one */
            const int corner = m < 3 && k == m;
            const int edge = m == 3 ? k : (k == (m + 1) % 3 ? m : (m + 2) % 3);
            memcpy(child.n[k], corner ? t->n[k] : mid[edge], sizeof child.n[k]);
            memcpy(child.s[k], corner ? t->s[k] : point[edge], sizeof child.s[k]);
        }
        child.bound = truth_bound(&child);
        child.bound = child.bound > t->bound ? child.bound : t->bound;
        if (child.bound < h->depth)
            truth_push(h, &child);
    }
}

/* Where branch and bound ends: with bounds this close, after so many splits, with an upper bound below `apart` or a
 * lower one above `deep`. */
typedef struct {
    double width;
    int splits;
    double apart, deep;
} truth_end_t;

/* Takes the ball off a shape, and returns its radius. */
static inline truth_real truth_take_ball(shape_t *s)
{
    const ccd_real_t radius = s->type == SHAPE_SPHERE || s->type == SHAPE_CAPSULE || s->type == SHAPE_SUM ? s->p[0] : 0;
    s->p[0] -= radius;
    return radius;
}

/* Returns bounds of the signed depth. */
static inline truth_t truth_depth_until(const shape_t *a, const shape_t *b, truth_end_t end)
{
    /* As fine as long double can split. */
    const truth_real finest2 = 2.5e5L * LDBL_EPSILON * LDBL_EPSILON;
    shape_t core[2] = {*a, *b};
    const truth_real ball = truth_take_ball(&core[0]) + truth_take_ball(&core[1]);
    truth_branch_t h = {&core[0], &core[1], HUGE_VALL, {0, 0, 0}, NULL, 0};
    truth_real lower = -HUGE_VALL;
    truth_t out = {HUGE_VAL, -HUGE_VAL, {0, 0, 0}};
    truth_triangle_t t;
    h.heap = (truth_triangle_t *)malloc(sizeof *h.heap * (size_t)(3 * end.splits + 8));
    if (!h.heap)
        return out;
    for (int m = 0; m < 8; m++) {
        for (int i = 0; i < 3; i++) {
            t.n[i][0] = t.n[i][1] = t.n[i][2] = 0;
            t.n[i][i] = m >> i & 1 ? -1 : 1;
            truth_sample(&h, t.n[i], t.s[i]);
        }
        t.bound = truth_bound(&t);
        truth_push(&h, &t);
    }
    for (int splits = 0;; splits++) {
        lower = h.count ? h.heap[0].bound : h.depth;
        lower = lower > h.depth ? h.depth : lower; /* rounding */
        if (h.count == 0 || h.depth - lower <= end.width || splits == end.splits || h.depth + ball < end.apart
            || lower + ball > end.deep || truth_edge2(&h.heap[0]) < finest2)
            break;
        truth_pop(&h, &t);
        truth_split(&h, &t);
    }
    free(h.heap);
    out.depth = (double)(h.depth + ball);
    out.lower = (double)(lower + ball);
    for (int i = 0; i < 3; i++)
        out.n[i] = (double)h.n[i];
    return out;
}

/* --- signed depth, and depth along a direction --------------------------------- */

/* Returns the signed depth, within bounds that are `width` apart. */
static inline truth_t truth_depth_within(const shape_t *a, const shape_t *b, double width)
{
    const truth_end_t end = {width, TRUTH_SPLITS, -HUGE_VAL, HUGE_VAL};
    return truth_depth_until(a, b, end);
}

static inline truth_t truth_depth(const shape_t *a, const shape_t *b)
{
    return truth_depth_within(a, b, 1e-15 * pair_size(a, b));
}

/* Returns how far b must move along the unit vector dir until it is apart: the root of the signed
 * depth over that distance, by Newton's steps from beyond it, which never pass it as the function is
 * concave. The shapes must overlap. */
static inline truth_t truth_along(const shape_t *a, const shape_t *b, const double dir[3])
{
    double distance = 2 * pair_size(a, b), step;
    truth_t t;
    int tries = 0;
    do {
        shape_t moved = *b;
        shape_shift(&moved, distance, dir);
        t = truth_depth(a, &moved);
        step = t.depth / truth_dot3(t.n, dir);
        distance += step;
    } while (++tries < 50 && -step > 1e-13 * pair_size(a, b));
    t.lower = distance - (t.depth - t.lower) / truth_dot3(t.n, dir);
    t.depth = distance;
    return t;
}

#endif
