/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The exact contact region of two polytopes whose vertices are known: the faces are the
 * vertices that lie within the slop below the support planes, the region is what their
 * hulls across the normal share, by clipping with half planes. Computed in long double,
 * from the shapes' own numbers. */

#ifndef TESTS_MANIFOLD_H
#define TESTS_MANIFOLD_H

#include "harness/truth.h"

enum { MANIFOLD_ROOM = 64 };

typedef struct {
    truth_real x, y;
} flat_t;

typedef struct {
    int n;
    flat_t p[MANIFOLD_ROOM];
} flats_t;

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

static inline flat_t manifold_flat(const frame_t *f, const truth_real p[3])
{
    const flat_t q = {truth_dot(f->e1, p), truth_dot(f->e2, p)};
    return q;
}

static inline truth_real flat_cross(flat_t a, flat_t b, flat_t c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Counterclockwise, without corners that lie on a side. */
static inline flats_t flat_hull(const flats_t *points)
{
    flats_t sorted = *points, hull;
    int j, half = 2, n = 0;
    for (int i = 1; i < sorted.n; i++) {
        const flat_t p = sorted.p[i];
        for (j = i; j > 0 && (p.x < sorted.p[j - 1].x || (p.x == sorted.p[j - 1].x && p.y < sorted.p[j - 1].y)); j--)
            sorted.p[j] = sorted.p[j - 1];
        sorted.p[j] = p;
    }
    if (sorted.n < 2)
        return sorted;
    /* along the lower side, and back along the upper one */
    for (int i = 0; i < 2 * sorted.n - 1; i++) {
        const flat_t p = sorted.p[i < sorted.n ? i : 2 * sorted.n - 2 - i];
        half = i == sorted.n ? n + 1 : half;
        while (n >= half && !(flat_cross(hull.p[n - 2], hull.p[n - 1], p) > 0))
            n--;
        hull.p[n++] = p;
    }
    hull.n = n - 1;
    return hull;
}

static inline truth_real flat_area(const flats_t *f)
{
    truth_real sum = 0;
    for (int i = 1; i + 1 < f->n; i++)
        sum += flat_cross(f->p[0], f->p[i], f->p[i + 1]) / 2;
    return sum;
}

static inline truth_real flat_perimeter(const flats_t *f)
{
    truth_real sum = 0;
    for (int i = 0; i < f->n; i++) {
        const flat_t a = f->p[i], b = f->p[(i + 1) % f->n];
        sum += hypotl(b.x - a.x, b.y - a.y);
    }
    return sum;
}

/* How far q is from a convex polygon, a segment or a point. */
static inline truth_real flat_distance(const flats_t *f, flat_t q)
{
    truth_real least = HUGE_VALL;
    int in = f->n > 2;
    for (int i = 0; i < f->n; i++) {
        const flat_t a = f->p[i], b = f->p[(i + 1) % f->n];
        const truth_real l = (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
        truth_real t = l > 0 ? ((q.x - a.x) * (b.x - a.x) + (q.y - a.y) * (b.y - a.y)) / l : 0;
        t = t < 0 ? 0 : t > 1 ? 1 : t;
        least = fminl(least, hypotl(a.x + t * (b.x - a.x) - q.x, a.y + t * (b.y - a.y) - q.y));
        if (flat_cross(a, b, q) < 0)
            in = 0;
    }
    return in ? 0 : least;
}

/* The largest distance from a corner of the one to the other. */
static inline truth_real flat_apart(const flats_t *a, const flats_t *b)
{
    truth_real most = 0;
    for (int i = 0; i < a->n; i++)
        most = fmaxl(most, flat_distance(b, a->p[i]));
    for (int i = 0; i < b->n; i++)
        most = fmaxl(most, flat_distance(a, b->p[i]));
    return most;
}

/* What a segment or polygon a shares with a polygon b of three corners or more. */
static inline flats_t flat_clip(const flats_t *a, const flats_t *b)
{
    flats_t rest = *a;
    for (int i = 0; i < b->n; i++) {
        const flat_t p = b->p[i], q = b->p[(i + 1) % b->n];
        flats_t next;
        next.n = 0;
        for (int k = 0; k < rest.n; k++) {
            const flat_t u = rest.p[k], v = rest.p[(k + 1) % rest.n];
            const truth_real at_u = flat_cross(p, q, u), at_v = flat_cross(p, q, v);
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
    return flat_hull(&rest);
}

/* The face that looks along sign * n: its hull, the height of its support plane along n; 0
 * when a vertex lies where the library may take it or leave it: between half the slop and the
 * slop low, or as steeply below the highest vertices as half the slop over the whole object.
 * noise is what rounding can do to a height: the slop is no less than twice that. */
static inline int manifold_face(const shape_t *s, const frame_t *f, int sign, double slop, double noise, flats_t *face,
                                double *top)
{
    static const ccd_real_t origin[3];
    static truth_core_t c;
    truth_real most = -HUGE_VALL, size = 0;
    double low[MANIFOLD_ROOM];
    flats_t all, in;
    int i, clear = 1;
    slop = fmax(slop, 2 * noise);
    truth_vertices(s, origin, &c);
    for (i = 0; i < c.nv; i++)
        most = fmaxl(most, sign * truth_dot(f->n, c.v[i]));
    in.n = 0;
    for (all.n = i = 0; i < c.nv; i++) {
        low[i] = (double)(most - sign * truth_dot(f->n, c.v[i]));
        all.p[all.n++] = manifold_flat(f, c.v[i]);
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
    *face = flat_hull(&in);
    *top = (double)(sign * most);
    return clear;
}

#endif
