/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* FCL's collide over random pairs of every convex kind (pose_all of poses.h), whose queries compare.sh judges.
 *
 * usage: fcl_static SEED POSES   (POSES placed pairs of each two kinds) */

#include "engines/fcl_shapes.h"
#include "harness/identity.h"

static body_t a, b;
static std::unique_ptr<object> object_a, object_b;

static void make()
{
    object_a.reset(new object(fcl_geometry(a.shape, TRIANGLE_MESH), fcl_pose(a.shape)));
    object_b.reset(new object(fcl_geometry(b.shape, TRIANGLE_MESH), fcl_pose(b.shape)));
}

static long threw;

static void query()
{
    fcl::CollisionRequestd request(1, true);
    fcl::CollisionResultd result;
    request.gjk_solver_type = fcl::GST_LIBCCD;
    object_b->setTransform(fcl_pose(b.shape));
    object_b->computeAABB();
    try {
        fcl::collide(object_a.get(), object_b.get(), request, result);
    } catch (const std::exception &) {
        threw++;
    }
}

int main(int argc, char **argv)
{
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
    return 0;
}
