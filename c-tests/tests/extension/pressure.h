/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Computes the center of pressure of two overlapping shapes, the exact `pos`: the centroid of their common
 * volume, by integration. */

#ifndef TESTS_PRESSURE_H
#define TESTS_PRESSURE_H

#include "harness/truth.h"

/* Interval on a line; empty where from > to. */
typedef struct { double from, to; } span_t;

static inline span_t span_intersection(span_t a, span_t b)
{
    const span_t s = {fmax(a.from, b.from), fmin(a.to, b.to)};
    return s;
}

/* Solves |p + t d| <= half: one coordinate of a box. */
static inline span_t span_slab(double p, double d, double half)
{
    span_t s = {-INFINITY, INFINITY};
    if (fabs(d) > 1e-300) {
        const double a = (-half - p) / d, b = (half - p) / d;
        s.from = fmin(a, b);
        s.to = fmax(a, b);
    } else if (fabs(p) > half) {
        s.from = 1;
        s.to = 0;
    }
    return s;
}

/* Solves w0 x^2 + w1 y^2 + w2 (z - center)^2 <= limit on the line p + t d: an ellipsoid, a cylinder where w2 is 0,
 * the lower nappe of a cone where w2 is negative. */
static inline span_t span_quadric(const double p[3], const double d[3], const double w[3], double center, double limit)
{
    const double q[3] = {p[0], p[1], p[2] - center};
    double a = 0, b = 0, c = -limit, root;
    span_t s = {-INFINITY, INFINITY};
    for (int i = 0; i < 3; i++) {
        a += w[i] * d[i] * d[i];
        b += w[i] * q[i] * d[i];
        c += w[i] * q[i] * q[i];
    }
    root = b * b - a * c;
    if (a > 1e-30 ? root < 0 : a > -1e-30 && c > 0) {
        s.from = 1;
        s.to = 0;
    } else if (a > 1e-30) {
        s.from = (-b - sqrt(root)) / a;
        s.to = (-b + sqrt(root)) / a;
    } else if (w[2] < 0 && root >= 0) {
        /* Inside is beyond both roots; one is on the lower nappe. */
        const double one = (-b - sqrt(root)) / a, two = (-b + sqrt(root)) / a;
        if (d[2] > 0)
            s.to = fmin(one, two);
        else
            s.from = fmax(one, two);
    }
    return s;
}

/* The half spaces n.x <= h of a polytope, in its frame. */
enum { MAX_FACES = 64 };
typedef struct {
    int count;
    double n[MAX_FACES][3], h[MAX_FACES];
} faces_t;

/* Finds the faces: planes through three vertices with no vertex above them. */
static inline void polytope_faces(const shape_t *s, faces_t *f)
{
    const int n = s->nverts;
    f->count = 0;
    for (int code = 0; code < n * n * n; code++) {
        const int corner[3] = {code % n, code / n % n, code / n / n};
        double v[3][3], normal[3], highest = -INFINITY;
        int same = 0;
        if (corner[0] >= corner[1] || corner[0] >= corner[2] || corner[1] == corner[2])
            continue;
        for (int k = 0; k < 3; k++) {
            v[0][k] = (double)s->verts[3 * corner[0] + k];
            v[1][k] = (double)s->verts[3 * corner[1] + k] - v[0][k];
            v[2][k] = (double)s->verts[3 * corner[2] + k] - v[0][k];
        }
        truth_cross3(v[1], v[2], normal);
        const double length = sqrt(truth_dot3(normal, normal));
        for (int k = 0; k < 3; k++)
            normal[k] /= length;
        const double height = truth_dot3(normal, v[0]);
        for (int i = 0; i < n; i++) {
            const double at[3] = {(double)s->verts[3 * i], (double)s->verts[3 * i + 1], (double)s->verts[3 * i + 2]};
            highest = fmax(highest, truth_dot3(normal, at) - height);
        }
        for (int i = 0; i < f->count; i++)
            same |= truth_dot3(normal, f->n[i]) > 1 - 1e-12;
        if (length > 0 && highest < 1e-9 && !same && f->count < MAX_FACES) {
            memcpy(f->n[f->count], normal, sizeof normal);
            f->h[f->count++] = height;
        }
    }
}

/* Returns the part of the line p + t d in the shape; `faces`: of a polytope. */
static inline span_t pressure_span(const shape_t *s, const faces_t *faces, const double p[3], const double d[3])
{
    static const double ball[3] = {1, 1, 1}, cylinder[3] = {1, 1, 0};
    const double p0 = (double)s->p[0], p1 = (double)s->p[1], r2 = p0 * p0;
    const double cone[3] = {1, 1, -r2 / (4 * p1 * p1)};
    double q[3], e[3], w[3];
    const span_t none = {1, 0};
    for (int i = 0; i < 3; i++) {
        q[i] = e[i] = 0;
        for (int j = 0; j < 3; j++) {
            q[i] += (double)s->rot[3 * j + i] * (p[j] - (double)s->pos[j]);
            e[i] += (double)s->rot[3 * j + i] * d[j];
        }
        w[i] = 1 / ((double)s->p[i] * (double)s->p[i]);
    }
    span_t slab = span_slab(q[2], e[2], p1);
    switch (s->type) {
    case SHAPE_SPHERE: return span_quadric(q, e, ball, 0, r2);
    case SHAPE_BOX:
        return span_intersection(span_intersection(span_slab(q[0], e[0], p0), span_slab(q[1], e[1], p1)),
                                 span_slab(q[2], e[2], (double)s->p[2]));
    case SHAPE_CYLINDER: return span_intersection(span_quadric(q, e, cylinder, 0, r2), slab);
    case SHAPE_CAPSULE: {
        const span_t part[3] = {span_intersection(span_quadric(q, e, cylinder, 0, r2), slab), span_quadric(q, e, ball, p1, r2),
                                span_quadric(q, e, ball, -p1, r2)};
        span_t all = {INFINITY, -INFINITY};
        for (int i = 0; i < 3; i++)
            if (part[i].from <= part[i].to) {
                all.from = fmin(all.from, part[i].from);
                all.to = fmax(all.to, part[i].to);
            }
        return all;
    }
    case SHAPE_CONE: return span_intersection(span_quadric(q, e, cone, p1, 0), slab);
    case SHAPE_ELLIPSOID: return span_quadric(q, e, w, 0, 1);
    case SHAPE_POLYTOPE: {
        span_t all = {-INFINITY, INFINITY};
        for (int i = 0; i < faces->count; i++) {
            const double below = faces->h[i] - truth_dot3(faces->n[i], q), slope = truth_dot3(faces->n[i], e);
            if (slope > 0)
                all.to = fmin(all.to, below / slope);
            else if (slope < 0)
                all.from = fmax(all.from, below / slope);
            else if (below < 0)
                return none;
        }
        return all;
    }
    default: break;
    }
    return none;
}

/* Integral over the plane of u and v through `origin`, of the chords along n in both shapes. */
typedef struct {
    const shape_t *a, *b;
    faces_t faces[2];
    double origin[3], u[3], v[3], n[3];
    double volume, moment[3];
    double radius; /* the largest distance of the region's edge from `origin` */
} pressure_t;

/* Returns the common chord at the point (x, y) of the plane. */
static inline span_t pressure_chord(const pressure_t *c, double x, double y)
{
    double p[3];
    for (int i = 0; i < 3; i++)
        p[i] = c->origin[i] + x * c->u[i] + y * c->v[i];
    return span_intersection(pressure_span(c->a, &c->faces[0], p, c->n), pressure_span(c->b, &c->faces[1], p, c->n));
}

/* Finds the edge of the region in the direction `angle` by bisection: the length of a chord is concave. */
static inline void pressure_edge(pressure_t *c, double angle, double out[2])
{
    const double x = cos(angle), y = sin(angle);
    double in = 0, beyond = 4;
    for (int k = 0; k < 56; k++) {
        const double r = 0.5 * (in + beyond);
        const span_t s = pressure_chord(c, r * x, r * y);
        if (s.to > s.from)
            in = r;
        else
            beyond = r;
    }
    out[0] = in * x;
    out[1] = in * y;
    c->radius = fmax(c->radius, in);
}

/* Adds the integral over the triangle of `origin`, p and q, by Gauss points. */
static inline void pressure_triangle(pressure_t *c, const double p[2], const double q[2])
{
    /* abscissas and weights */
    static const double gauss[2][4] = {{0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970262},
                                       {0.17392742256872692, 0.32607257743127307, 0.32607257743127307, 0.17392742256872692}};
    const double area = p[0] * q[1] - p[1] * q[0];
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            const double t = gauss[0][i], s = gauss[0][j];
            const double x = t * (p[0] + s * (q[0] - p[0])), y = t * (p[1] + s * (q[1] - p[1]));
            const span_t chord = pressure_chord(c, x, y);
            const double w = area * t * gauss[1][i] * gauss[1][j] * fmax(chord.to - chord.from, 0);
            if (!(w > 0))
                continue;
            c->volume += w;
            for (int k = 0; k < 3; k++)
                c->moment[k] += w * (c->origin[k] + x * c->u[k] + y * c->v[k] + 0.5 * (chord.from + chord.to) * c->n[k]);
        }
}

/* Adds the integral over a sector, split until its arc is short. */
static inline void pressure_sector(pressure_t *c, double from, const double p[2], double to, const double q[2])
{
    if (hypot(q[0] - p[0], q[1] - p[1]) > 0.03 * c->radius && to - from > 1e-8) {
        double middle[2];
        const double angle = 0.5 * (from + to);
        pressure_edge(c, angle, middle);
        pressure_sector(c, from, p, angle, middle);
        pressure_sector(c, angle, middle, to, q);
    } else {
        pressure_triangle(c, p, q);
    }
}

/* Computes the centroid of the common volume of a and b, by chords along the unit vector n, from a point `place` in
 * it. Returns the volume, 0 where it is empty. */
static inline double center_of_pressure(const shape_t *a, const shape_t *b, const double n[3], const double place[3],
                                     double center[3])
{
    enum { SECTORS = 24 };
    const double turn = 8 * atan(1.0) / SECTORS;
    double edge[SECTORS][2];
    pressure_t c;
    const int least = fabs(n[0]) <= fabs(n[1]) && fabs(n[0]) <= fabs(n[2]) ? 0 : fabs(n[1]) <= fabs(n[2]) ? 1 : 2;
    memset(&c, 0, sizeof c);
    c.a = a;
    c.b = b;
    if (a->type == SHAPE_POLYTOPE)
        polytope_faces(a, &c.faces[0]);
    if (b->type == SHAPE_POLYTOPE)
        polytope_faces(b, &c.faces[1]);
    memcpy(c.n, n, sizeof c.n);
    memcpy(c.origin, place, sizeof c.origin);
    for (int i = 0; i < 3; i++)
        c.u[i] = (i == least) - n[least] * n[i];
    const double length = sqrt(truth_dot3(c.u, c.u));
    for (int i = 0; i < 3; i++)
        c.u[i] /= length;
    truth_cross3(n, c.u, c.v);
    for (int i = 0; i < SECTORS; i++)
        pressure_edge(&c, i * turn, edge[i]);
    for (int i = 0; i < SECTORS; i++)
        pressure_sector(&c, i * turn, edge[i], (i + 1) * turn, edge[(i + 1) % SECTORS]);
    for (int i = 0; i < 3; i++)
        center[i] = c.moment[i] / c.volume;
    return c.volume;
}

#endif
