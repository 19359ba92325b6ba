/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The exact signed depth that every test is judged by.
 *
 * With D = A - B and its support value h(n) = max over D of n.x, the signed depth
 * is the minimum of h over all unit n: the penetration depth when the shapes
 * overlap, minus their distance when they do not. Two methods, neither of which
 * shares code or idea with the library:
 *
 * Enumeration, for shapes that are a polytope with at most TRUTH_ENUMERATED
 * vertices (boxes, polygons, segments, points among them) plus a ball (spheres,
 * capsules). With D = core + ball(rho) the minimum of h is rho plus the core's.
 * The core's is attained at a facet normal of the core (a face normal of A or B or
 * a cross product of two edges) or, where the origin lies outside, also along the
 * nearest point of one of its edges or vertices. h(n) is never below the minimum
 * for any unit n, so candidates that turn out to be no facet do no harm and
 * nothing depends on finding faces robustly. Computed in long double.
 *
 * Branch and bound over the sphere of directions, for all others. On a spherical
 * triangle with corners n_i and any convex combination g of support points,
 * h(n) >= g.n >= min g.n_i (h(n) >= g.n because g lies in D; the second because
 * n = (sum l_i n_i) / |sum l_i n_i| with |..| <= 1). g is the best combination of
 * the three corners' support points, a matrix game of three rows and columns. The
 * error of that bound falls with the square of the triangle. Triangles are split
 * in four, the one with the least bound first, until the bounds meet. */

#ifndef TESTS_TRUTH_H
#define TESTS_TRUTH_H

#include "harness/shapes.h"

#include <float.h>

enum { TRUTH_ENUMERATED = 32 };

typedef struct {
    double depth;  /* upper bound of the signed depth, attained by n */
    double lower;  /* proven lower bound; equal to depth within rounding if enumerated */
    double n[3];   /* unit: B leaves along it */
    int enumerated;
} truth_t;

typedef long double truth_real;

static inline double truth_dot3(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static inline void truth_cross3(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* --- support in full precision ---------------------------------------------- */

/* Writes the support point of one shape in double, relative to origin, for unit w. */
static inline void truth_support(const shape_t *s, const double origin[3], const double w[3], double out[3])
{
    double d[3], v[3] = {0, 0, 0}, p[3], l;
    for (int i = 0; i < 3; i++) {
        p[i] = (double)s->p[i];
        d[i] = (double)s->rot[i] * w[0] + (double)s->rot[3 + i] * w[1] + (double)s->rot[6 + i] * w[2];
    }
    switch (s->type) {
    case SHAPE_SPHERE:
    case SHAPE_CAPSULE:
        l = sqrt(truth_dot3(d, d));
        for (int i = 0; i < 3; i++)
            v[i] = p[0] * d[i] / l;
        if (s->type == SHAPE_CAPSULE)
            v[2] += d[2] < 0 ? -p[1] : p[1];
        break;
    case SHAPE_BOX:
        for (int i = 0; i < 3; i++)
            v[i] = d[i] < 0 ? -p[i] : p[i];
        break;
    case SHAPE_CYLINDER:
    case SHAPE_CONE:
        l = sqrt(d[0] * d[0] + d[1] * d[1]);
        if (s->type == SHAPE_CONE && p[1] * d[2] >= p[0] * l - p[1] * d[2]) {
            v[2] = p[1];
            break;
        }
        if (l > 0) {
            v[0] = p[0] * d[0] / l;
            v[1] = p[0] * d[1] / l;
        }
        v[2] = s->type == SHAPE_CONE || d[2] < 0 ? -p[1] : p[1];
        break;
    case SHAPE_ELLIPSOID:
        l = 0;
        for (int i = 0; i < 3; i++)
            l += p[i] * d[i] * p[i] * d[i];
        l = sqrt(l);
        for (int i = 0; i < 3 && l > 0; i++)
            v[i] = p[i] * p[i] * d[i] / l;
        break;
    case SHAPE_POLYTOPE: {
        int best = 0;
        double most = -HUGE_VAL;
        for (int k = 0; k < s->nverts; k++) {
            double x = 0;
            for (int i = 0; i < 3; i++)
                x += (double)s->verts[3 * k + i] * d[i];
            if (x > most) {
                most = x;
                best = k;
            }
        }
        for (int i = 0; i < 3; i++)
            v[i] = (double)s->verts[3 * best + i];
        break;
    }
    }
    for (int i = 0; i < 3; i++)
        out[i] = (double)s->rot[3 * i] * v[0] + (double)s->rot[3 * i + 1] * v[1]
            + (double)s->rot[3 * i + 2] * v[2] + ((double)s->pos[i] - origin[i]);
}

/* Writes the support point of D = A - B in unit direction n. */
static inline void truth_difference_support(const shape_t *a, const shape_t *b, const double n[3], double out[3])
{
    double origin[3], m[3], x[3], y[3];
    for (int i = 0; i < 3; i++) {
        origin[i] = (double)a->pos[i];
        m[i] = -n[i];
    }
    truth_support(a, origin, n, x);
    truth_support(b, origin, m, y);
    for (int i = 0; i < 3; i++)
        out[i] = x[i] - y[i];
}

/* Returns h(n) per unit length, for a direction of any length but zero. */
static inline double truth_support_value(const shape_t *a, const shape_t *b, const double dir[3])
{
    double n[3], s[3], l = sqrt(truth_dot3(dir, dir));
    for (int i = 0; i < 3; i++)
        n[i] = dir[i] / l;
    truth_difference_support(a, b, n, s);
    return truth_dot3(n, s);
}

/* Returns the radius of a ball about the shape's position that encloses it. */
static inline double shape_reach(const shape_t *s)
{
    double p0 = (double)s->p[0], p1 = (double)s->p[1], p2 = (double)s->p[2], most = 0;
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

/* --- enumeration ------------------------------------------------------------- */

enum { TRUTH_EDGES = TRUTH_ENUMERATED * (TRUTH_ENUMERATED - 1) / 2 };

typedef struct {
    int nv, ne, has_faces;
    truth_real v[TRUTH_ENUMERATED][3]; /* world, relative to A's position */
    int e[TRUTH_EDGES][2];
    truth_real rho;
} truth_core_t;

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

/* Writes unit a x b. Returns 0 when they are parallel within long double. */
static inline int truth_cross(const truth_real a[3], const truth_real b[3], truth_real out[3])
{
    truth_real l, scale = sqrtl(truth_dot(a, a) * truth_dot(b, b));
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
    l = sqrtl(truth_dot(out, out));
    if (!(l > 1e-15L * scale))
        return 0;
    out[0] /= l;
    out[1] /= l;
    out[2] /= l;
    return 1;
}

static inline void truth_add_edge(truth_core_t *c, int i, int j)
{
    for (int k = 0; k < c->ne; k++)
        if (c->e[k][0] == i && c->e[k][1] == j)
            return;
    c->e[c->ne][0] = i;
    c->e[c->ne][1] = j;
    c->ne++;
}

/* Splits a shape into a polytope's vertices and a ball. Returns 0 for a shape that is no such sum. */
static inline int truth_vertices(const shape_t *s, const ccd_real_t origin[3], truth_core_t *c)
{
    truth_real local[TRUTH_ENUMERATED][3];
    memset(local, 0, sizeof local);
    c->nv = c->ne = c->has_faces = 0;
    c->rho = 0;
    switch (s->type) {
    case SHAPE_SPHERE:
        c->rho = s->p[0];
        c->nv = 1;
        break;
    case SHAPE_CAPSULE:
        c->rho = s->p[0];
        c->nv = 2;
        local[0][2] = -s->p[1];
        local[1][2] = s->p[1];
        break;
    case SHAPE_BOX:
        c->nv = 8;
        for (int i = 0; i < 8; i++)
            for (int k = 0; k < 3; k++)
                local[i][k] = i >> k & 1 ? s->p[k] : -s->p[k];
        break;
    case SHAPE_POLYTOPE:
        if (s->nverts > TRUTH_ENUMERATED)
            return 0;
        c->nv = s->nverts;
        for (int i = 0; i < s->nverts; i++)
            for (int k = 0; k < 3; k++)
                local[i][k] = s->verts[3 * i + k];
        break;
    case SHAPE_CYLINDER:
    case SHAPE_CONE:
    case SHAPE_ELLIPSOID:
        return 0;
    }
    for (int i = 0; i < c->nv; i++)
        for (int k = 0; k < 3; k++) {
            c->v[i][k] = (truth_real)s->pos[k] - origin[k];
            for (int m = 0; m < 3; m++)
                c->v[i][k] += s->rot[3 * k + m] * local[i][m];
        }
    return 1;
}

typedef struct {
    truth_core_t a, b;
    truth_real best, n[3], rho;
} truth_search_t;

/* Takes unit n as a candidate. Returns early once it cannot be the best. */
static inline void truth_try(truth_search_t *t, const truth_real n[3])
{
    const truth_real limit = t->best - t->rho;
    truth_real most = -LDBL_MAX, least = LDBL_MAX, x;
    for (int i = 0; i < t->a.nv; i++) {
        x = truth_dot(n, t->a.v[i]);
        if (x > most)
            most = x;
    }
    for (int i = 0; i < t->b.nv; i++) {
        x = truth_dot(n, t->b.v[i]);
        if (x < least) {
            least = x;
            if (!(most - least < limit))
                return;
        }
    }
    t->best = most - least + t->rho;
    memcpy(t->n, n, sizeof t->n);
}

static inline void truth_try_both(truth_search_t *t, const truth_real n[3])
{
    truth_real m[3];
    m[0] = -n[0];
    m[1] = -n[1];
    m[2] = -n[2];
    truth_try(t, n);
    truth_try(t, m);
}

/* Finds the edges of a core's hull and takes the normals of its faces as candidates: of the planes through
 * three vertices that have all others on one side, within 1e-9 of the size (a face too many does no harm).
 * Where there is no such plane (segment, point) every pair of vertices is an edge; a point has one of
 * length 0. */
static inline void truth_faces(truth_search_t *t, truth_core_t *c)
{
    truth_real size = 0, d[3], e[3], n[3];
    for (int i = 1; i < c->nv; i++) {
        truth_minus(c->v[i], c->v[0], d);
        size = fmaxl(size, sqrtl(truth_dot(d, d)));
    }
    for (int i = 0; i < c->nv; i++)
        for (int j = i + 1; j < c->nv; j++)
            for (int k = j + 1; k < c->nv; k++) {
                int above = 0, below = 0;
                truth_minus(c->v[j], c->v[i], d);
                truth_minus(c->v[k], c->v[i], e);
                if (!truth_cross(d, e, n))
                    continue;
                for (int m = 0; m < c->nv && !(above && below); m++) {
                    truth_minus(c->v[m], c->v[i], d);
                    truth_real x = truth_dot(d, n);
                    above += x > 1e-9L * size;
                    below += x < -1e-9L * size;
                }
                if (above && below)
                    continue;
                c->has_faces = 1;
                truth_try_both(t, n);
                truth_add_edge(c, i, j);
                truth_add_edge(c, i, k);
                truth_add_edge(c, j, k);
            }
    for (int i = 0; i < c->nv && !c->has_faces; i++)
        for (int j = c->nv > 1 ? i + 1 : 0; j < c->nv; j++)
            truth_add_edge(c, i, j);
}

/* Writes the point of segment p q closest to the origin, if closer than all before. */
static inline void truth_closest(const truth_real p[3], const truth_real q[3], truth_real *least, truth_real point[3])
{
    truth_real d[3], c[3], t, l;
    truth_minus(q, p, d);
    l = truth_dot(d, d);
    t = l > 0 ? -truth_dot(p, d) / l : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    for (int i = 0; i < 3; i++)
        c[i] = t <= 0.5L ? p[i] + t * d[i] : q[i] - (1 - t) * d[i];
    l = truth_dot(c, c);
    if (l < *least) {
        *least = l;
        memcpy(point, c, sizeof c);
    }
}

static inline void truth_enumerate(truth_search_t *t)
{
    const truth_core_t *a = &t->a, *b = &t->b;
    truth_real d[3], e[3], n[3], p[3], q[3], least = LDBL_MAX, point[3] = {0, 0, 0};
    static const truth_real axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    t->best = LDBL_MAX;
    for (int i = 0; i < 3; i++)
        truth_try_both(t, axes[i]);
    truth_faces(t, &t->a);
    truth_faces(t, &t->b);
    for (int i = 0; i < a->ne; i++) {
        truth_minus(a->v[a->e[i][1]], a->v[a->e[i][0]], d);
        for (int j = 0; j < b->ne; j++) {
            truth_minus(b->v[b->e[j][1]], b->v[b->e[j][0]], e);
            if (truth_cross(d, e, n)) {
                /* h(n) is at least this edge pair's own value */
                truth_minus(a->v[a->e[i][0]], b->v[b->e[j][0]], p);
                truth_real x = truth_dot(p, n);
                for (int k = 0; k < 3; k++)
                    q[k] = -n[k];
                if (x < t->best - t->rho)
                    truth_try(t, n);
                if (-x < t->best - t->rho)
                    truth_try(t, q);
            }
            /* edges of cores in one plane: its normal, and the normal of the edge in it */
            truth_minus(a->v[a->e[i][0]], b->v[b->e[j][0]], p);
            if (truth_cross(d, p, n)) {
                truth_try_both(t, n);
                if (truth_cross(d, n, q))
                    truth_try_both(t, q);
            }
        }
    }
    /* a core without faces: directions normal to its edges, which no pair of edges may have */
    for (int j = 0; j < 2 && !(a->has_faces && b->has_faces); j++) {
        const truth_core_t *c = j ? b : a;
        for (int i = 0; i < 3 * c->ne; i++) {
            truth_minus(c->v[c->e[i / 3][1]], c->v[c->e[i / 3][0]], d);
            if (truth_cross(d, axes[i % 3], n))
                truth_try_both(t, n);
        }
    }
    /* origin outside the core: along its closest edge or vertex */
    for (int side = 0; side < 2; side++) {
        const truth_core_t *c = side ? b : a, *o = side ? a : b;
        for (int i = 0; i < c->nv; i++)
            for (int j = 0; j < o->ne; j++) {
                truth_minus(c->v[i], o->v[o->e[j][0]], p);
                truth_minus(c->v[i], o->v[o->e[j][1]], q);
                truth_closest(p, q, &least, point);
            }
    }
    if (least > 0) {
        least = sqrtl(least);
        for (int k = 0; k < 3; k++)
            n[k] = -point[k] / least;
        truth_try_both(t, n);
    }
}

/* --- branch and bound --------------------------------------------------------- */

typedef struct {
    double n[3][3]; /* corners, unit */
    double s[3][3]; /* support points there */
    double bound;
} truth_triangle_t;

/* Returns the value of the 3 x 3 matrix game: the largest, over convex weights of the rows, of the least
 * column. Candidates: single rows, two rows where two columns are equal, all three where all columns
 * are; each is a lower bound. */
static inline double truth_game(double m[3][3])
{
    double best = -HUGE_VAL;
    int j;
    for (int k = 0; k < 3; k++)
        best = fmax(best, fmin(m[k][0], fmin(m[k][1], m[k][2])));
    for (int k = 0; k < 3; k++) {
        const double *p = m[k], *q = m[(k + 1) % 3];
        for (int i = 0; i < 3; i++) {
            j = (i + 1) % 3;
            double u = p[i] - p[j];
            double v = q[i] - q[j];
            double t = u / (u - v); /* weight of q; columns i and j meet */
            if (t > 0 && t < 1)
                best = fmax(best, fmin((1 - t) * p[0] + t * q[0],
                                       fmin((1 - t) * p[1] + t * q[1], (1 - t) * p[2] + t * q[2])));
        }
    }
    {
        /* weights w with equal columns: w across both column differences */
        double d[3], e[3], w[3], sum;
        for (int k = 0; k < 3; k++) {
            d[k] = m[k][0] - m[k][1];
            e[k] = m[k][0] - m[k][2];
        }
        truth_cross3(d, e, w);
        sum = w[0] + w[1] + w[2];
        if (sum != 0) {
            for (int k = 0; k < 3; k++)
                w[k] /= sum;
            if (w[0] >= 0 && w[1] >= 0 && w[2] >= 0) {
                double c[3];
                for (int i = 0; i < 3; i++)
                    c[i] = w[0] * m[0][i] + w[1] * m[1][i] + w[2] * m[2][i];
                best = fmax(best, fmin(c[0], fmin(c[1], c[2])));
            }
        }
    }
    return best;
}

/* Returns the square of the longest edge. */
static inline double truth_edge2(const truth_triangle_t *t)
{
    double most = 0;
    for (int k = 0; k < 3; k++) {
        double e[3];
        for (int i = 0; i < 3; i++)
            e[i] = t->n[k][i] - t->n[(k + 1) % 3][i];
        most = fmax(most, truth_dot3(e, e));
    }
    return most;
}

/* Returns a lower bound of h in the triangle. */
static inline double truth_bound(const truth_triangle_t *t)
{
    double m[3][3], value;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            m[k][i] = truth_dot3(t->s[k], t->n[i]);
    value = truth_game(m);
    if (value < 0)
        /* then |sum l_i n_i| counts: its square is 1 - sum l_i l_j |n_i - n_j|^2 over
         * the three edges, and sum l_i l_j is at most 1/3 */
        value /= sqrt(1 - truth_edge2(t) / 3);
    return value;
}

typedef struct {
    truth_triangle_t *heap;
    int n, room;
} truth_heap_t;

static inline void truth_push(truth_heap_t *h, const truth_triangle_t *t)
{
    int i = h->n++;
    while (i > 0 && h->heap[(i - 1) / 2].bound > t->bound) {
        h->heap[i] = h->heap[(i - 1) / 2];
        i = (i - 1) / 2;
    }
    h->heap[i] = *t;
}

static inline void truth_pop(truth_heap_t *h, truth_triangle_t *top)
{
    truth_triangle_t *last = &h->heap[--h->n];
    int i = 0;
    *top = h->heap[0];
    for (int c = 1; c < h->n; c = 2 * i + 1) {
        if (c + 1 < h->n && h->heap[c + 1].bound < h->heap[c].bound)
            c++;
        if (!(h->heap[c].bound < last->bound))
            break;
        h->heap[i] = h->heap[c];
        i = c;
    }
    h->heap[i] = *last;
}

/* Samples D along n, of any length but zero, which becomes unit; stores the direction if it is the best. */
static inline void truth_sample(const shape_t *a, const shape_t *b, truth_t *out, double n[3], double s[3])
{
    double l = sqrt(truth_dot3(n, n)), h;
    for (int i = 0; i < 3; i++)
        n[i] /= l;
    truth_difference_support(a, b, n, s);
    h = truth_dot3(n, s);
    if (h < out->depth) {
        out->depth = h;
        memcpy(out->n, n, sizeof out->n);
    }
}

/* Splits triangles until the bounds are closer than width, or budget triangles are in use. */
static inline truth_t truth_branch(const shape_t *a, const shape_t *b, double width, int budget)
{
    static const double octahedron[6][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    truth_t out;
    truth_heap_t heap;
    truth_triangle_t t, child;
    memset(&out, 0, sizeof out);
    out.depth = HUGE_VAL;
    out.lower = -HUGE_VAL;
    heap.n = 0;
    heap.room = budget + 16;
    heap.heap = (truth_triangle_t *)malloc(sizeof *heap.heap * (size_t)heap.room);
    if (!heap.heap)
        return out;
    for (int m = 0; m < 8; m++) {
        for (int i = 0; i < 3; i++) {
            memcpy(t.n[i], octahedron[i + (m >> i & 1 ? 3 : 0)], sizeof t.n[i]);
            truth_sample(a, b, &out, t.n[i], t.s[i]);
        }
        t.bound = truth_bound(&t);
        truth_push(&heap, &t);
    }
    for (;;) {
        double mid[3][3], point[3][3], u[3], v[3], x[3], s[3], c;
        out.lower = heap.n ? heap.heap[0].bound : out.depth;
        if (out.lower > out.depth)
            out.lower = out.depth; /* rounding */
        if (heap.n == 0 || out.depth - out.lower <= width || heap.n + 4 > heap.room)
            break;
        if (truth_edge2(&heap.heap[0]) < 1e-26)
            break; /* as fine as double can split: the gap stays what it is */
        truth_pop(&heap, &t);
        /* the plane of the three support points, as a candidate */
        for (int i = 0; i < 3; i++) {
            u[i] = t.s[1][i] - t.s[0][i];
            v[i] = t.s[2][i] - t.s[0][i];
        }
        truth_cross3(u, v, x);
        c = truth_dot3(x, t.n[0]) + truth_dot3(x, t.n[1]) + truth_dot3(x, t.n[2]);
        if (truth_dot3(x, x) > 0) {
            for (int i = 0; i < 3 && c < 0; i++)
                x[i] = -x[i];
            truth_sample(a, b, &out, x, s);
        }
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < 3; i++)
                mid[k][i] = t.n[k][i] + t.n[(k + 1) % 3][i];
            truth_sample(a, b, &out, mid[k], point[k]);
        }
        for (int m = 0; m < 4; m++) {
            for (int k = 0; k < 3; k++) {
                /* child m < 3 keeps corner m; the fourth is the middle one */
                int corner = m < 3 && k == m;
                int edge = m == 3 ? k : (k == (m + 1) % 3 ? m : (m + 2) % 3);
                memcpy(child.n[k], corner ? t.n[k] : mid[edge], sizeof child.n[k]);
                memcpy(child.s[k], corner ? t.s[k] : point[edge], sizeof child.s[k]);
            }
            child.bound = fmax(t.bound, truth_bound(&child));
            if (child.bound < out.depth)
                truth_push(&heap, &child);
        }
    }
    free(heap.heap);
    return out;
}

/* --- signed depth, and depth along a direction --------------------------------- */

/* Returns the signed depth. Where it is not enumerated, its bounds close to width (1e-12 of the size is
 * about the limit of double). */
static inline truth_t truth_depth_within(const shape_t *a, const shape_t *b, double width)
{
    truth_search_t t;
    truth_t out;
    if (!truth_vertices(a, a->pos, &t.a) || !truth_vertices(b, a->pos, &t.b))
        return truth_branch(a, b, width, 40000);
    t.rho = t.a.rho + t.b.rho;
    truth_enumerate(&t);
    out.depth = out.lower = (double)t.best;
    for (int i = 0; i < 3; i++)
        out.n[i] = (double)t.n[i];
    out.enumerated = 1;
    return out;
}

static inline truth_t truth_depth(const shape_t *a, const shape_t *b)
{
    return truth_depth_within(a, b, 1e-12 * pair_size(a, b));
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
