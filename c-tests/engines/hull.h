/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Random convex hulls with their faces, as ODE and FCL want them. */

#ifndef ENGINES_HULL_H
#define ENGINES_HULL_H

#include "harness/truth.h"
#include "harness/random.h"

#include <stdio.h>

enum { HULL_VERTICES = 16, HULL_FACES = 2 * HULL_VERTICES - 4 };

typedef struct {
    int vertices, faces;
    ccd_real_t vertex[3 * HULL_VERTICES];
    double plane[4 * HULL_FACES];     /* outward unit normal, offset */
    unsigned polygon[4 * HULL_FACES]; /* of each face: number of vertices, their indices counterclockwise from outside */
} hull_t;

/* Computes unit normal and offset of the plane through three vertices; returns twice their triangle's area. */
static inline double hull_plane(const hull_t *s, int i, int j, int k, double plane[4])
{
    const ccd_real_t *a = s->vertex + 3 * i, *b = s->vertex + 3 * j, *c = s->vertex + 3 * k;
    const double p[3] = { a[0], a[1], a[2] }, u[3] = { b[0] - a[0], b[1] - a[1], b[2] - a[2] };
    const double v[3] = { c[0] - a[0], c[1] - a[1], c[2] - a[2] };
    truth_cross3(u, v, plane);
    const double length = sqrt(truth_dot3(plane, plane));
    for (int l = 0; l < 3; l++)
        plane[l] /= length;
    plane[3] = truth_dot3(plane, p);
    return length;
}

/* Every triple of points, in general position, that has all others on one side
 * is a face: n^4 steps, for a dozen points. */
static inline void hull_make_faces(hull_t *s)
{
    const int n = s->vertices;
    s->faces = 0;
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++)
            for (int k = j + 1; k < n; k++) {
                double plane[4];
                int above = 0, below = 0;
                hull_plane(s, i, j, k, plane);
                for (int l = 0; l < n; l++) {
                    const ccd_real_t *x = s->vertex + 3 * l;
                    const int is_above = plane[0] * x[0] + plane[1] * x[1] + plane[2] * x[2] > plane[3];
                    if (l != i && l != j && l != k)
                        *(is_above ? &above : &below) += 1;
                }
                if (above && below)
                    continue;
                if (s->faces == HULL_FACES) {
                    fprintf(stderr, "hull: points not in general position\n");
                    exit(2);
                }
                for (int l = 0; l < 4; l++)
                    s->plane[4 * s->faces + l] = above ? -plane[l] : plane[l];
                unsigned *polygon = s->polygon + 4 * s->faces++;
                polygon[0] = 3;
                polygon[1] = (unsigned)i;
                polygon[2] = (unsigned)(above ? k : j);
                polygon[3] = (unsigned)(above ? j : k);
            }
}

/* Returns the distance of the origin from the nearest face plane, negative outside. */
static inline double hull_inradius(const hull_t *s)
{
    double least = HUGE_VAL;
    for (int i = 0; i < s->faces; i++)
        least = fmin(least, s->plane[4 * i + 3]);
    return least;
}

/* Makes random points on an ellipsoid with these radii, rounded to float, not too close to each other:
 * equal ones make needle faces. */
static inline void hull_make_vertices(hull_t *s, const double r[3])
{
    int j;
    for (int i = 0; i < s->vertices; i++) {
        double v[3], length, nearest;
        do {
            for (j = 0; j < 3; j++)
                v[j] = uniform(-1, 1);
            length = sqrt(truth_dot3(v, v));
            for (j = 0, nearest = 4; j < i && length > 0; j++) {
                const ccd_real_t *w = s->vertex + 3 * j;
                const double d[3] = { v[0] / length - w[0] / r[0], v[1] / length - w[1] / r[1], v[2] / length - w[2] / r[2] };
                nearest = fmin(nearest, truth_dot3(d, d));
            }
        } while (length > 1 || length < 0.01 || nearest < 0.15);
        for (j = 0; j < 3; j++)
            s->vertex[3 * i + j] = (float)(r[j] * v[j] / length);
    }
}

/* Makes a random hull that has the origin well inside, as ODE wants it. */
static inline void hull_random(hull_t *s, int vertices, double rx, double ry, double rz)
{
    const double r[3] = { rx, ry, rz };
    s->vertices = vertices;
    do {
        hull_make_vertices(s, r);
        hull_make_faces(s);
    } while (hull_inradius(s) < 0.2 * fmin(rx, fmin(ry, rz)));
}

/* Makes a box with these half extents, of eight vertices and six faces. */
static inline void hull_box(hull_t *s, double x, double y, double z)
{
    /* +x, -x, +y, -y, +z, -z; bit k of a vertex's index: on the upper side of axis k */
    static const unsigned polygon[30] = { 4, 1, 3, 7, 5, 4, 0, 4, 6, 2, 4, 2, 6, 7, 3,
                                          4, 0, 1, 5, 4, 4, 4, 5, 7, 6, 4, 0, 2, 3, 1 };
    const double half[3] = { x, y, z };
    s->vertices = 8;
    s->faces = 6;
    memcpy(s->polygon, polygon, sizeof polygon);
    for (int i = 0; i < 8; i++)
        for (int j = 0; j < 3; j++)
            s->vertex[3 * i + j] = i >> j & 1 ? half[j] : -half[j];
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 3; j++)
            s->plane[4 * i + j] = j == i / 2 ? 1 - 2 * (i % 2) : 0;
        s->plane[4 * i + 3] = half[i / 2];
    }
}

#endif
