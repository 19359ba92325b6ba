/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Random convex hulls with their faces, as ODE and FCL want them. */

#ifndef ENGINES_HULL_H
#define ENGINES_HULL_H

#include "harness/random.h"

#include <ccd/vec3.h>
#include <stdio.h>
#include <stdlib.h>

enum { HULL_VERTICES = 16, HULL_FACES = 2 * HULL_VERTICES - 4 };

typedef struct {
    int vertices, faces;
    ccd_real_t vertex[3 * HULL_VERTICES];
    double plane[4 * HULL_FACES];     /* outward unit normal, offset */
    unsigned polygon[4 * HULL_FACES]; /* face by face: how many vertices, then they, counterclockwise from outside */
} hull_t;

/* Every triple of points, in general position, that has all others on one side
 * is a face: n^4 steps, for a dozen points. */
static inline void hull_make_faces(hull_t *s)
{
    const int n = s->vertices;
    s->faces = 0;
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++)
            for (int k = j + 1; k < n; k++) {
                const ccd_real_t *a = s->vertex + 3 * i, *b = s->vertex + 3 * j, *c = s->vertex + 3 * k;
                double u[3], v[3], m[3], d, length, sign, *plane;
                int above = 0, below = 0;
                for (int l = 0; l < 3; l++) {
                    u[l] = b[l] - a[l];
                    v[l] = c[l] - a[l];
                }
                m[0] = u[1] * v[2] - u[2] * v[1];
                m[1] = u[2] * v[0] - u[0] * v[2];
                m[2] = u[0] * v[1] - u[1] * v[0];
                length = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
                for (int l = 0; l < 3; l++)
                    m[l] /= length;
                d = m[0] * a[0] + m[1] * a[1] + m[2] * a[2];
                for (int l = 0; l < n; l++) {
                    const ccd_real_t *x = s->vertex + 3 * l;
                    if (l == i || l == j || l == k)
                        continue;
                    if (m[0] * x[0] + m[1] * x[1] + m[2] * x[2] > d)
                        above++;
                    else
                        below++;
                }
                if (above && below)
                    continue;
                if (s->faces == HULL_FACES) {
                    fprintf(stderr, "hull: points not in general position\n");
                    exit(2);
                }
                sign = above ? -1 : 1;
                plane = s->plane + 4 * s->faces;
                unsigned *polygon = s->polygon + 4 * s->faces;
                for (int l = 0; l < 3; l++)
                    plane[l] = sign * m[l];
                plane[3] = sign * d;
                polygon[0] = 3;
                polygon[1] = (unsigned)i;
                polygon[2] = (unsigned)(above ? k : j);
                polygon[3] = (unsigned)(above ? j : k);
                s->faces++;
            }
}

/* The distance of the origin from the nearest face plane, negative outside. */
static inline double hull_inradius(const hull_t *s)
{
    double least = HUGE_VAL;
    for (int i = 0; i < s->faces; i++)
        least = fmin(least, s->plane[4 * i + 3]);
    return least;
}

/* Random points on an ellipsoid with these radii, not too close to each other:
 * equal ones make needle faces. Rounded to float. */
static inline void hull_make_vertices(hull_t *s, const double r[3])
{
    int j;
    for (int i = 0; i < s->vertices; i++) {
        double v[3], length, nearest;
        do {
            for (j = 0; j < 3; j++)
                v[j] = uniform(-1, 1);
            length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            for (j = 0, nearest = 4; j < i && length > 0; j++) {
                const ccd_real_t *w = s->vertex + 3 * j;
                double x = v[0] / length - w[0] / r[0], y = v[1] / length - w[1] / r[1], z = v[2] / length - w[2] / r[2];
                nearest = fmin(nearest, x * x + y * y + z * z);
            }
        } while (length > 1 || length < 0.01 || nearest < 0.15);
        for (j = 0; j < 3; j++)
            s->vertex[3 * i + j] = (float)(r[j] * v[j] / length);
    }
}

/* A random hull that has the origin well inside, as ODE wants it. */
static inline void hull_random(hull_t *s, int vertices, double rx, double ry, double rz)
{
    double r[3];
    r[0] = rx;
    r[1] = ry;
    r[2] = rz;
    s->vertices = vertices;
    do {
        hull_make_vertices(s, r);
        hull_make_faces(s);
    } while (hull_inradius(s) < 0.2 * fmin(rx, fmin(ry, rz)));
}

/* A box with these half extents, as a hull of eight vertices and six faces. */
static inline void hull_box(hull_t *s, double x, double y, double z)
{
    const double half[3] = { x, y, z };
    s->vertices = 8;
    s->faces = 6;
    for (int i = 0; i < 8; i++)
        for (int j = 0; j < 3; j++)
            s->vertex[3 * i + j] = i >> j & 1 ? half[j] : -half[j];
    for (int i = 0; i < 6; i++) {
        /* the face across axis k, on its upper side for even i */
        const int k = i / 2, u = (k + 1) % 3, v = (k + 2) % 3, up = i % 2 == 0;
        const unsigned base = up ? 1u << k : 0, pu = 1u << u, pv = 1u << v;
        unsigned *polygon = s->polygon + 5 * i;
        for (int j = 0; j < 3; j++)
            s->plane[4 * i + j] = j == k ? (up ? 1 : -1) : 0;
        s->plane[4 * i + 3] = half[k];
        polygon[0] = 4;
        polygon[1] = base;
        polygon[2] = base | (up ? pu : pv);
        polygon[3] = base | pu | pv;
        polygon[4] = base | (up ? pv : pu);
    }
}

#endif
