/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Small hulls that lie on a floor: the contact position must be where the hull is.
 * A floor is the hard case, for its own support points are metres away.
 *
 * usage: contact_position POSES */

#include "shapes.h"
#include "swap/hull.h"

int main(int argc, char **argv)
{
    const int poses = argc == 2 ? atoi(argv[1]) : 0;
    const double reach = 0.1;
    hull_t hull;
    int k, i, outside = 0, missed = 0;
    uniform_seed(1);
    for (k = 0; k < poses; k++) {
        const double depth = uniform(1e-4, 5e-3);
        shape_t floor_box = shape_box(2, 2, 2), small;
        double q[4], rot[9], low = 1;
        ccd_t ccd;
        ccd_real_t found;
        ccd_vec3_t dir, pos;
        if (k % 50 == 0)
            hull_random(&hull, 8 + k / 50 % 8, reach, reach, reach);
        small = shape_polytope(hull.vertex, hull.vertices);
        uniform_rotation(q);
        rotation_quaternion(q[0], q[1], q[2], q[3], rot);
        shape_turn(&small, rot);
        for (i = 0; i < hull.vertices; i++)
            low = fmin(low, rot[6] * hull.vertex[3 * i] + rot[7] * hull.vertex[3 * i + 1] + rot[8] * hull.vertex[3 * i + 2]);
        shape_move(&floor_box, 0, 0, -2);
        shape_move(&small, uniform(-0.5, 0.5), uniform(-0.5, 0.5), -low - depth);
        shape_query(&ccd);
        ccd.mpr_tolerance = 1e-6;
        ccd.max_iterations = 500;
        if (ccdMPRPenetration(&small, &floor_box, &ccd, &found, &dir, &pos) != 0) {
            missed++;
            continue;
        }
        /* negated: NaN is outside */
        outside += !(hypot(pos.v[0] - small.pos[0], pos.v[1] - small.pos[1]) < reach + 1e-3 && fabs(pos.v[2]) < 2 * depth + 1e-3);
    }
    printf("%d poses: %d missed, %d contacts outside the hull\n", poses, missed, outside);
    return missed || outside || poses == 0;
}
