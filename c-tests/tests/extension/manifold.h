/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Computes the exact contact region of two polytopes from their vertices, in long double. A face is the
 * hull, across the normal, of the vertices within the slop of the support plane; the region is the
 * intersection of the two faces, by clipping with half planes. */

#ifndef TESTS_MANIFOLD_H
#define TESTS_MANIFOLD_H

#include "harness/truth.h"

enum { MAX_CORNERS = 64 };

typedef struct {
    truth_real x, y;
} point2_t;

typedef struct {
    int n;
    point2_t p[MAX_CORNERS];
} polygon_t;

typedef struct {
    truth_real n[3], e1[3], e2[3]; /* unit, right-handed */
} frame_t;

static inline frame_t manifold_frame(const double normal[3])
{
    truth_real axis[3] = {0, 0, 0}, l;
    frame_t f;
    int i, least = 0;
    for (i = 0; i < 3; i++) {
        f.n[i] = normal[i];
        least = fabs(normal[i]) < fabs(normal[least]) ? i : least;
    }
    for (i = 0, l = sqrtl(truth_dot(f.n, f.n)); i < 3; i++)
        f.n[i] /= l;
    axis[least] = 1;
    truth_cross(f.n, axis, f.e1);
    truth_cross(f.n, f.e1, f.e2);
    return f;
}

static inline point2_t manifold_project(const frame_t *f, const truth_real p[3])
{
    const point2_t q = {truth_dot(f->e1, p), truth_dot(f->e2, p)};
    return q;
}

static inline truth_real polygon_cross(point2_t a, point2_t b, point2_t c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Returns the hull, counterclockwise, without corners on a side. */
static inline polygon_t polygon_hull(const polygon_t *points)
{
    polygon_t sorted = *points, hull;
    int j, half = 2, n = 0;
    for (int i = 1; i < sorted.n; i++) {
        const point2_t p = sorted.p[i];
        for (j = i; j > 0 && (p.x < sorted.p[j - 1].x || (p.x == sorted.p[j - 1].x && p.y < sorted.p[j - 1].y)); j--)
            sorted.p[j] = sorted.p[j - 1];
        sorted.p[j] = p;
    }
    if (sorted.n < 2)
        return sorted;
    /* the lower chain, then the upper one */
    for (int i = 0; i < 2 * sorted.n - 1; i++) {
        const point2_t p = sorted.p[i < sorted.n ? i : 2 * sorted.n - 2 - i];
        half = i == sorted.n ? n + 1 : half;
        while (n >= half && !(polygon_cross(hull.p[n - 2], hull.p[n - 1], p) > 0))
            n--;
        hull.p[n++] = p;
    }
    hull.n = n - 1;
    return hull;
}

static inline double polygon_area(const polygon_t *f)
{
    truth_real sum = 0;
    for (int i = 1; i + 1 < f->n; i++)
        sum += polygon_cross(f->p[0], f->p[i], f->p[i + 1]) / 2;
    return (double)sum;
}

/* Returns the distance of q from a convex polygon, a segment or a point. */
static inline double polygon_distance(const polygon_t *f, point2_t q)
{
    truth_real least = HUGE_VALL;
    int in = f->n > 2;
    for (int i = 0; i < f->n; i++) {
        const point2_t a = f->p[i], b = f->p[(i + 1) % f->n];
        const truth_real l = (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
        truth_real t = l > 0 ? ((q.x - a.x) * (b.x - a.x) + (q.y - a.y) * (b.y - a.y)) / l : 0;
        t = t < 0 ? 0 : t > 1 ? 1 : t;
        least = fminl(least, hypotl(a.x + t * (b.x - a.x) - q.x, a.y + t * (b.y - a.y) - q.y));
        if (polygon_cross(a, b, q) < 0)
            in = 0;
    }
    return in ? 0 : (double)least;
}

/* Returns the largest distance from a corner of one polygon to the other. */
static inline double polygon_difference(const polygon_t *a, const polygon_t *b)
{
    double most = 0;
    for (int i = 0; i < a->n; i++)
        most = fmax(most, polygon_distance(b, a->p[i]));
    for (int i = 0; i < b->n; i++)
        most = fmax(most, polygon_distance(a, b->p[i]));
    return most;
}

/* Returns the intersection of a segment or polygon a with a polygon b of three corners or more. */
static inline polygon_t polygon_clip(const polygon_t *a, const polygon_t *b)
{
    polygon_t rest = *a;
    for (int i = 0; i < b->n; i++) {
        const point2_t p = b->p[i], q = b->p[(i + 1) % b->n];
        polygon_t next;
        next.n = 0;
        for (int k = 0; k < rest.n; k++) {
            const point2_t u = rest.p[k], v = rest.p[(k + 1) % rest.n];
            const truth_real at_u = polygon_cross(p, q, u), at_v = polygon_cross(p, q, v);
            if (at_u >= 0)
                next.p[next.n++] = u;
            if ((at_u >= 0) != (at_v >= 0)) {
                const truth_real t = at_u / (at_u - at_v);
                next.p[next.n].x = u.x + t * (v.x - u.x);
                next.p[next.n++].y = u.y + t * (v.y - u.y);
            }
        }
        rest = next;
    }
    return polygon_hull(&rest);
}

/* Writes the vertices of a box or polytope in the world; returns how many. */
static inline int manifold_vertices(const shape_t *s, truth_real v[MAX_CORNERS][3])
{
    const int is_box = s->type == SHAPE_BOX, count = is_box ? 8 : s->nverts;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            v[i][k] = s->pos[k];
            for (int m = 0; m < 3; m++)
                v[i][k] += (truth_real)s->rot[3 * k + m] * (!is_box ? s->verts[3 * i + m] : i >> m & 1 ? s->p[m] : -s->p[m]);
        }
    return count;
}

/* Computes the face along sign * n. Returns 0 where the
 * library may or may not count a vertex to the face: it is between half the slop and the slop low, or as
 * steeply below the highest vertices as half the slop over the whole object. The slop is at least twice
 * `noise`, the rounding of a height. */
static inline int manifold_face(const shape_t *s, const frame_t *f, int sign, double slop, double noise, polygon_t *face)
{
    truth_real v[MAX_CORNERS][3];
    truth_real most = -HUGE_VALL, size = 0;
    double low[MAX_CORNERS];
    polygon_t all, in;
    const int count = manifold_vertices(s, v);
    int i, clear = 1;
    slop = fmax(slop, 2 * noise);
    for (i = 0; i < count; i++)
        most = fmaxl(most, sign * truth_dot(f->n, v[i]));
    in.n = 0;
    for (all.n = i = 0; i < count; i++) {
        low[i] = (double)(most - sign * truth_dot(f->n, v[i]));
        all.p[all.n++] = manifold_project(f, v[i]);
        if (low[i] <= slop)
            in.p[in.n++] = all.p[i];
        for (int k = 0; k < i; k++)
            size = fmaxl(size, hypotl(all.p[i].x - all.p[k].x, all.p[i].y - all.p[k].y));
    }
    for (i = 0; i < all.n; i++) {
        truth_real aside = HUGE_VALL;
        for (int k = 0; k < all.n; k++)
            if (low[k] <= noise)
                aside = fminl(aside, hypotl(all.p[i].x - all.p[k].x, all.p[i].y - all.p[k].y));
        if (low[i] > noise && low[i] < slop + 2 * noise && (truth_real)low[i] > (truth_real)(0.5 * slop) * aside / size)
            clear = 0;
    }
    *face = polygon_hull(&in);
    return clear;
}

#endif
