/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Bodies of 15 to 25 cm on a wide plate, anywhere but at its edge: the line of the centers is nearly parallel to
 * the plate. */

#ifndef TESTS_FLOOR_H
#define TESTS_FLOOR_H

#include "harness/random.h"

typedef enum { FLOOR_BOXES, FLOOR_ROUND, FLOOR_HULLS } floor_kind_t;
enum { FLOOR_CORNERS = 162 };

/* Makes a body of the kind, its center at the origin: a box that stands or is tipped; a cylinder that stands or lies, a
 * capsule that lies, a ball, a cone that stands; a hull of 42 or 162 corners, which verts must have room for. */
static inline shape_t floor_body(rng_t *r, floor_kind_t kind, ccd_real_t *verts)
{
    static const double half[] = {.2, .15, .25};
    const double lying = 1.57079632679489661923;
    double rot[9];
    shape_t s;
    rotation_about(1, 0, 0, 0, rot);
    if (kind == FLOOR_HULLS) {
        const int n = rng_below(r, 2) ? FLOOR_CORNERS : 42;
        rng_on_ellipsoid(r, verts, n, half);
        s = shape_polytope(verts, n);
        rng_rotation(r, rot);
    } else if (kind == FLOOR_BOXES) {
        s = shape_box(half[0], half[1], half[2]);
        if (rng_below(r, 2))
            rotation_about(1, .3, 0, .4, rot);
    } else {
        const int which = (int)rng_below(r, 5);
        s = which == 0   ? shape_sphere(.15)
            : which == 1 ? shape_cone(.15, .2)
            : which == 2 ? shape_capsule(.15, .2)
                         : shape_cylinder(.15, .2);
        if (which == 2 || which == 3)
            rotation_about(1, 0, 0, lying, rot);
    }
    shape_turn(&s, rot);
    return s;
}

/* Makes a plate of this half width and a body whose lowest point is so high above it, less than 0 in it; the body is `along`
 * further along the plate. The pair is turned at random. Writes the plate's normal. */
static inline void floor_pair(rng_t *r, floor_kind_t kind, double half, double height, double along, ccd_real_t *verts,
                              shape_t *plate, shape_t *body, double normal[3])
{
    const double thickness = .2, part = .7;
    const ccd_vec3_t down = {{0, 0, -1}};
    ccd_vec3_t lowest;
    double rot[9];
    *plate = shape_box(half, half, thickness);
    *body = floor_body(r, kind, verts);
    shape_support(body, &down, &lowest);
    rotation_about(0, 0, 1, rng_uniform(r, 0, 6.28), rot);
    shape_turn_by(body, rot, 0, 0, 0);
    const double x = part * half * rng_uniform(r, -1, 1), y = part * half * rng_uniform(r, -1, 1);
    shape_move(body, x + along, y, thickness + height - (double)lowest.v[2]);
    rng_rotation(r, rot);
    shape_turn_by(plate, rot, 0, 0, 0);
    shape_turn_by(body, rot, 0, 0, 0);
    for (int k = 0; k < 3; k++)
        normal[k] = rot[3 * k + 2];
    plate->calls = body->calls = 0;
}

#endif
