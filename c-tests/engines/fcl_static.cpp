/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* FCL's collide over random pairs of every convex kind (pose_all of poses.h), whose queries compare.sh judges, and its
 * contact positions, a millimetre deep, against the centroid of the volume that the
 * bodies share: bodies of a quarter metre that stand, lie and rock on a cylinder a metre wide. Prints
 * their root mean square error, metres, of each kind of body, after `position`.
 *
 * usage: fcl_static SEED POSES   (POSES placed pairs of each two kinds; ten times as many positions) */

#include "engines/fcl_shapes.h"
#include "tests/extension/pressure.h"
#include "harness/identity.h"

static body_t a, b;
static std::unique_ptr<fcl::CollisionObjectd> object_a, object_b;

static std::unique_ptr<fcl::CollisionObjectd> make_object(const body_t &body)
{
    return std::make_unique<fcl::CollisionObjectd>(fcl_geometry(body), fcl_pose(body.shape));
}

static void make()
{
    object_a = make_object(a);
    object_b = make_object(b);
}

static fcl::CollisionResultd collide()
{
    fcl::CollisionRequestd request(1, true);
    fcl::CollisionResultd result;
    request.gjk_solver_type = fcl::GST_LIBCCD;
    fcl::collide(object_a.get(), object_b.get(), request, result);
    return result;
}

static long threw;

static void query(void)
{
    object_b->setTransform(fcl_pose(b.shape));
    object_b->computeAABB();
    try {
        collide();
    } catch (const std::exception &) {
        threw++;
    }
}

/* --- positions ---------------------------------------------------------------------- */

typedef struct {
    const char *name;
    shape_t shape;
    double axis[3], angle; /* how it lies, before it rocks */
} lying_t;

/* The deepest point of the body. */
static ccd_vec3_t lowest(const shape_t &s)
{
    const ccd_vec3_t down = {{0, 0, -1}};
    ccd_vec3_t p;
    shape_support(&s, &down, &p);
    return p;
}

static double position_error(const lying_t &lying, int poses)
{
    double square = 0;
    int judged = 0;
    b.kind = SHAPE_CYLINDER;
    b.shape = shape_cylinder(0.5, 0.1);
    shape_move(&b.shape, 0, 0, -0.1);
    for (int i = 0; i < poses; i++) {
        const double depth = 1e-3, tilt = uniform(-0.02, 0.02), turn = uniform(0, 6.28);
        double first[9], second[9], third[9], both[9], all[9], truth[3];
        rotation_about(lying.axis[0], lying.axis[1], lying.axis[2], lying.angle, first);
        rotation_about(cos(turn), sin(turn), 0, tilt, second);
        rotation_about(0, 0, 1, uniform(0, 6.28), third);
        rotation_times(third, first, both);
        rotation_times(second, both, all);
        a.kind = lying.shape.type;
        a.shape = lying.shape;
        shape_turn(&a.shape, all);
        shape_move(&a.shape, uniform(-0.1, 0.1), uniform(-0.1, 0.1), 0);
        shape_move(&a.shape, a.shape.pos[0], a.shape.pos[1], -depth - lowest(a.shape).v[2]);
        make();
        const fcl::CollisionResultd result = collide();
        if (result.numContacts() == 0)
            continue;
        const fcl::Vector3d pos = result.getContact(0).pos;
        const ccd_vec3_t below = lowest(a.shape);
        const double up[3] = {0, 0, 1}, within[3] = {below.v[0], below.v[1], -depth / 2};
        if (!(center_of_pressure(&a.shape, &b.shape, up, within, truth) > 0))
            continue;
        square += (pos[0] - truth[0]) * (pos[0] - truth[0]) + (pos[1] - truth[1]) * (pos[1] - truth[1]);
        judged++;
    }
    return sqrt(square / judged); /* NaN where no pose was judged */
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
    int kinds[KINDS];
    if (argc != 3) {
        fprintf(stderr, "usage: fcl_static SEED POSES\n");
        return 2;
    }
    for (int i = 0; i < KINDS; i++)
        kinds[i] = i;
    print_library();
    uniform_seed(strtoull(argv[1], NULL, 10));
    printf("poses queried %ld", pose_all(kinds, KINDS, atol(argv[2]), &a, &b, make, query));
    printf(" threw %ld\n", threw);
    uniform_seed(strtoull(argv[1], NULL, 10));
    printf("position");
    for (const lying_t &lying : all)
        printf(" %s %.6g", lying.name, position_error(lying, 10 * atoi(argv[2])));
    printf("\n");
    return 0;
}
