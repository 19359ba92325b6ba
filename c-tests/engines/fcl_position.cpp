/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* FCL's contact positions, a millimetre deep, against the centroid of the volume that the bodies
 * share: bodies of a quarter metre that stand, lie and rock on a cylinder a metre wide. FCL
 * hands the position on as the query gave it.
 *
 *   position KIND poses N rms METRES
 *
 * usage: fcl_position SEED POSES */

#include "engines/fcl_shapes.h"
#include "tests/extension/pressure.h"
#include "harness/identity.h"

typedef struct {
    const char *name;
    shape_t shape;
    double axis[3], angle; /* how it lies, before it rocks */
} lying_t;

/* The deepest place of the body, from its support point downwards. */
static ccd_vec3_t lowest(const shape_t &s)
{
    const ccd_vec3_t down = {{0, 0, -1}};
    ccd_vec3_t p;
    shape_support(&s, &down, &p);
    return p;
}

static void judge(const lying_t &lying, int poses)
{
    const shape_t ground = shape_cylinder(0.5, 0.1);
    double square = 0;
    int judged = 0;
    for (int i = 0; i < poses; i++) {
        const double depth = 1e-3, tilt = uniform(-0.02, 0.02), turn = uniform(0, 6.28);
        double first[9], second[9], third[9], both[9], all[9], truth[3];
        body_t body = body_t(), floor = body_t();
        rotation_about(lying.axis[0], lying.axis[1], lying.axis[2], lying.angle, first);
        rotation_about(cos(turn), sin(turn), 0, tilt, second);
        rotation_about(0, 0, 1, uniform(0, 6.28), third);
        rotation_times(third, first, both);
        rotation_times(second, both, all);
        body.kind = lying.shape.type;
        body.shape = lying.shape;
        shape_turn(&body.shape, all);
        shape_move(&body.shape, uniform(-0.1, 0.1), uniform(-0.1, 0.1), 0);
        shape_move(&body.shape, body.shape.pos[0], body.shape.pos[1], -depth - lowest(body.shape).v[2]);
        floor.kind = SHAPE_CYLINDER;
        floor.shape = ground;
        shape_move(&floor.shape, 0, 0, -0.1);

        fcl::CollisionRequestd request(1, true);
        fcl::CollisionResultd result;
        request.gjk_solver_type = fcl::GST_LIBCCD;
        const geometry one = fcl_geometry(body), two = fcl_geometry(floor);
        fcl::collide(one.get(), fcl_pose(body.shape), two.get(), fcl_pose(floor.shape), request, result);
        if (result.numContacts() == 0)
            continue;
        const fcl::Contactd contact = result.getContact(0);
        const ccd_vec3_t below = lowest(body.shape);
        const double up[3] = {0, 0, 1}, within[3] = {below.v[0], below.v[1], -depth / 2};
        if (!(pressure_centre(&body.shape, &floor.shape, up, within, truth) > 0))
            continue;
        const double off = hypot(contact.pos[0] - truth[0], contact.pos[1] - truth[1]);
        square += off * off;
        judged++;
    }
    printf("position %s poses %d rms %.6g\n", lying.name, judged, sqrt(square / judged));
}

int main(int argc, char **argv)
{
    const double quarter = 1.5707963267948966;
    const lying_t all[] = {
        {"box", shape_box(0.125, 0.1, 0.08), {0, 0, 1}, 0},
        {"standing-cylinder", shape_cylinder(0.1, 0.125), {0, 0, 1}, 0},
        {"lying-cylinder", shape_cylinder(0.1, 0.125), {0, 1, 0}, quarter},
        {"lying-capsule", shape_capsule(0.1, 0.125), {0, 1, 0}, quarter},
        {"standing-cone", shape_cone(0.125, 0.125), {0, 0, 1}, 0},
        {"ellipsoid", shape_ellipsoid(0.125, 0.1, 0.06), {0, 0, 1}, 0},
    };
    if (argc != 3)
        return 2;
    print_library();
    uniform_seed((unsigned long)atol(argv[1]));
    for (const lying_t &lying : all)
        judge(lying, atoi(argv[2]));
}
