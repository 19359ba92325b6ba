/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Bounds of the minimum of h(n) = n.s(n) over all unit n of D = A - B, in 128 bits.
 *
 * An incremental hull of support points, expanded at the face whose plane has the least
 * signed distance from the origin. Every h(n) evaluated is an upper bound: a negative one proves
 * that the bodies are apart. Where all planes have the origin inside, the least distance is
 * a lower bound: the hull lies in D. Planes are off by some 1e-30 of the size, so the
 * bounds hold in double precision without a margin.
 *
 * It shares nothing with the library's polytope: planes come from corners, visible faces from a
 * flood fill, and a hull that rounding has spoilt ends the search. */

#ifndef STABILITY_WIDE_BOUNDS_H
#define STABILITY_WIDE_BOUNDS_H

#include "body.h"

enum { BOUNDS_POINTS = 512, BOUNDS_FACES = 4 * BOUNDS_POINTS };

typedef struct {
    double upper, lower; /* metres; lower is -infinity where nothing is proven */
    double n[3];         /* unit, of upper */
    int supports;
} bounds_t;

typedef struct {
    int corner[3], twin[3]; /* twin[i]: the face beyond the edge from corner i to i + 1 */
    int visible;            /* the last point that saw it */
    quad_t n[3], d;
    double length, key;     /* of n; the signed distance, infinity out of use */
} wide_face_t;

typedef struct {
    const body_t *a, *b;
    double size;
    quad_t v[BOUNDS_POINTS][3];
    int points, faces, free[BOUNDS_FACES], frees;
    wide_face_t face[BOUNDS_FACES];
    bounds_t found;
} wide_hull_t;

static quad_t quad_dot(const quad_t a[3], const quad_t b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void quad_cross(const quad_t a[3], const quad_t b[3], quad_t o[3])
{
    o[0] = a[1] * b[2] - a[2] * b[1];
    o[1] = a[2] * b[0] - a[0] * b[2];
    o[2] = a[0] * b[1] - a[1] * b[0];
}

static void quad_less(const quad_t a[3], const quad_t b[3], quad_t o[3])
{
    for (int i = 0; i < 3; i++)
        o[i] = a[i] - b[i];
}

/* Writes the support point of D along n, of any length, and returns n.s. Points are relative to the
 * position of a, so that nothing is lost far from the world's origin. */
static quad_t wide_difference(const body_t *a, const body_t *b, const quad_t n[3], quad_t s[3])
{
    quad_t m[3], t[3];
    for (int i = 0; i < 3; i++)
        m[i] = -n[i];
    wide_body(a, a->pos, n, s);
    wide_body(b, a->pos, m, t);
    quad_less(s, t, s);
    return quad_dot(n, s);
}

/* Returns h of a direction of any length. */
static double wide_value(const body_t *a, const body_t *b, const double n[3])
{
    const quad_t q[3] = {n[0], n[1], n[2]};
    quad_t s[3];
    return (double)(wide_difference(a, b, q, s) / quad_root(quad_dot(q, q)));
}

/* Evaluates the support function along n: the point becomes number `points`, the upper bound falls if it
 * can. Returns n.s. */
static quad_t hull_sample(wide_hull_t *w, const quad_t n[3])
{
    const quad_t h = wide_difference(w->a, w->b, n, w->v[w->points]), l = quad_root(quad_dot(n, n));
    w->found.supports++;
    if (l > 0 && (double)(h / l) < w->found.upper) {
        w->found.upper = (double)(h / l);
        for (int i = 0; i < 3; i++)
            w->found.n[i] = (double)(n[i] / l);
    }
    return h;
}

/* Makes a face and its plane. Returns 0 where it has no area. */
static int hull_face(wide_hull_t *w, int i, int j, int k, int *made)
{
    quad_t e[3], g[3];
    const int at = w->frees ? w->free[--w->frees] : w->faces++;
    *made = at;
    wide_face_t *f = &w->face[at];
    f->corner[0] = i;
    f->corner[1] = j;
    f->corner[2] = k;
    f->visible = -1;
    quad_less(w->v[j], w->v[i], e);
    quad_less(w->v[k], w->v[i], g);
    quad_cross(e, g, f->n);
    f->d = quad_dot(f->n, w->v[i]);
    f->length = sqrt((double)quad_dot(f->n, f->n));
    f->key = (double)f->d / f->length;
    return f->length > 1e-40 * w->size * w->size && isfinite(f->key);
}

/* Samples along n; the point replaces the last of the first `points` if it is farther from the first, or
 * from the line through it along `line`. */
static void hull_extend(wide_hull_t *w, int points, const quad_t n[3], const quad_t *line, quad_t *farthest2)
{
    quad_t x[3], across[3];
    w->points = points;
    hull_sample(w, n);
    quad_less(w->v[points], w->v[0], x);
    if (line) {
        quad_cross(line, x, across);
        memcpy(x, across, sizeof x);
    }
    if (quad_dot(x, x) > *farthest2) {
        *farthest2 = quad_dot(x, x);
        memcpy(w->v[points - 1], w->v[points], sizeof w->v[points]);
    }
}

/* Makes a tetrahedron. Returns 0 where D has no volume. */
static int hull_begin(wide_hull_t *w)
{
    static const int corners[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    static const int twins[4][3] = {{1, 2, 3}, {3, 2, 0}, {1, 3, 0}, {2, 1, 0}};
    static const quad_t axes[6][3] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
    quad_t u[3] = {0.9, 0.3, 0.31}, n[3], x[3], farthest2, h;
    int i, made;
    w->points = w->faces = w->frees = 0;
    hull_sample(w, u);
    for (i = 0; i < 3; i++)
        u[i] = -u[i];
    w->points = 1;
    hull_sample(w, u);
    /* farthest from the first, then from the line, then from the plane */
    quad_less(w->v[1], w->v[0], x);
    for (farthest2 = quad_dot(x, x), i = 0; i < 6; i++)
        hull_extend(w, 2, axes[i], NULL, &farthest2);
    if (!(farthest2 > 0))
        return 0;
    quad_less(w->v[1], w->v[0], u);
    for (farthest2 = 0, i = 0; i < 6; i++) {
        quad_cross(u, axes[i], n);
        hull_extend(w, 3, n, u, &farthest2);
    }
    if (!(farthest2 > 0))
        return 0;
    quad_less(w->v[2], w->v[0], x);
    quad_cross(u, x, n);
    h = hull_sample(w, n) - quad_dot(n, w->v[0]);
    memcpy(w->v[4], w->v[3], sizeof w->v[4]);
    for (int k = 0; k < 3; k++)
        n[k] = -n[k];
    if (!(hull_sample(w, n) - quad_dot(n, w->v[0]) > h)) {
        memcpy(w->v[3], w->v[4], sizeof w->v[3]);
        for (int k = 0; k < 3; k++)
            n[k] = -n[k];
    }
    /* v3 is on the side of n; outside the face 0 1 2 is the other */
    quad_less(w->v[3], w->v[0], x);
    if (!(quad_dot(n, x) > 1e-25 * (double)quad_root(quad_dot(n, n)) * w->size))
        return 0;
    quad_less(w->v[1], w->v[0], u);
    quad_less(w->v[2], w->v[0], x);
    quad_cross(u, x, u);
    if (quad_dot(u, n) > 0) {
        memcpy(x, w->v[1], sizeof x);
        memcpy(w->v[1], w->v[2], sizeof x);
        memcpy(w->v[2], x, sizeof x);
    }
    w->points = 4;
    for (i = 0; i < 4; i++) {
        if (!hull_face(w, corners[i][0], corners[i][1], corners[i][2], &made))
            return 0;
        memcpy(w->face[made].twin, twins[i], sizeof twins[i]);
    }
    return 1;
}

/* Returns whether the face is visible from point p. */
static int hull_is_visible(const wide_hull_t *w, int f, int p)
{
    const wide_face_t *x = &w->face[f];
    return quad_dot(x->n, w->v[p]) - x->d > 1e-29 * x->length * w->size;
}

/* Adds the newest point, from which face `first` is visible. Returns 0 where rounding has spoilt the hull. */
static int hull_insert(wide_hull_t *w, int first)
{
    static int stack[BOUNDS_FACES], made[BOUNDS_FACES], start[BOUNDS_POINTS];
    static int horizon[BOUNDS_FACES][3]; /* two corners, the face beyond */
    const int p = w->points;
    int depth = 1, edges = 0, seen = 0, i, k;
    stack[0] = first;
    w->face[first].visible = p;
    /* the visible faces stay in `stack` */
    while (seen < depth) {
        const int f = stack[seen++];
        for (i = 0; i < 3; i++) {
            const int g = w->face[f].twin[i];
            if (w->face[g].visible == p)
                continue;
            if (hull_is_visible(w, g, p)) {
                w->face[g].visible = p;
                stack[depth++] = g;
            }
        }
    }
    for (i = 0; i < p; i++)
        start[i] = -1;
    for (seen = 0; seen < depth; seen++)
        for (i = 0; i < 3; i++) {
            const wide_face_t *f = &w->face[stack[seen]];
            if (w->face[f->twin[i]].visible == p)
                continue;
            if (start[f->corner[i]] >= 0 || edges == BOUNDS_FACES)
                return 0;
            start[f->corner[i]] = edges;
            horizon[edges][0] = f->corner[i];
            horizon[edges][1] = f->corner[(i + 1) % 3];
            horizon[edges++][2] = f->twin[i];
        }
    /* one loop */
    for (i = 0, k = 0; edges && i < edges; i++) {
        k = start[horizon[k][1]];
        if (k < 0 || (k == 0) != (i == edges - 1))
            return 0;
    }
    if (!edges || w->faces + edges > BOUNDS_FACES)
        return 0;
    for (i = 0; i < edges; i++)
        if (!hull_face(w, horizon[i][0], horizon[i][1], p, &made[i]))
            return 0;
    for (i = 0; i < edges; i++) {
        const int next = start[horizon[i][1]];
        wide_face_t *beyond = &w->face[horizon[i][2]];
        w->face[made[i]].twin[0] = horizon[i][2];
        w->face[made[i]].twin[1] = made[next];
        w->face[made[next]].twin[2] = made[i];
        for (k = 0; k < 3; k++)
            if (beyond->corner[k] == horizon[i][1] && beyond->corner[(k + 1) % 3] == horizon[i][0])
                beyond->twin[k] = made[i];
    }
    for (seen = 0; seen < depth; seen++) {
        w->face[stack[seen]].key = HUGE_VAL;
        w->free[w->frees++] = stack[seen];
    }
    w->points++;
    return 1;
}

/* Returns bounds no more than `gap` apart, by at most so many support points; or earlier, once the
 * upper bound is below `apart` or the lower above `deep`. */
static bounds_t wide_bounds(const body_t *a, const body_t *b, double gap, double apart, double deep, int most)
{
    static wide_hull_t w;
    w.a = a;
    w.b = b;
    w.size = body_reach(a) + body_reach(b);
    w.found.upper = HUGE_VAL;
    w.found.lower = -HUGE_VAL;
    w.found.supports = 0;
    if (!hull_begin(&w)) /* flat: sampled along its normal, and it touches at most */
        return w.found;
    while (w.points + 1 < BOUNDS_POINTS && w.found.supports < most) {
        double least = HUGE_VAL;
        int near = -1;
        for (int f = 0; f < w.faces; f++)
            if (w.face[f].key < least) {
                least = w.face[f].key;
                near = f;
            }
        if (least >= 0)
            w.found.lower = fmax(w.found.lower, least);
        if (near < 0 || w.found.upper - least <= gap || w.found.upper < apart || w.found.lower > deep)
            break;
        hull_sample(&w, w.face[near].n);
        if (!hull_is_visible(&w, near, w.points) || !hull_insert(&w, near))
            break;
    }
    return w.found;
}

#endif
