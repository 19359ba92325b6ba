/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* FCL's collide over random pairs of every convex kind, held against their truth (pose_all of
 * poses.h), and its signed distance, of which there is a line for each:
 *
 *   distance VALUE TRUTH   VALUE: nan where FCL threw, or where one of the assertions failed that
 *                          Debian's FCL is built with
 *
 * usage: fcl_static SEED POSES   (POSES placed pairs of each two kinds) */

#include "engines/fcl_shapes.h"
#include "tools/compare/hooks.h"
#include "harness/identity.h"

#include <setjmp.h>
#include <signal.h>

/* A failed assertion comes back here; what FCL held is lost. */
static sigjmp_buf after_abort;
static void on_abort(int)
{
    siglongjmp(after_abort, 1);
}

/* Runs one query of FCL's; whether it answered. */
template <typename Query> static bool answers(Query query)
{
    if (sigsetjmp(after_abort, 1))
        return false;
    try {
        query();
    } catch (const std::exception &) {
        return false;
    }
    return true;
}

static body_t a, b;
static std::unique_ptr<fcl::CollisionObjectd> object_a, object_b;

static void make()
{
    object_a.reset(new fcl::CollisionObjectd(fcl_geometry(a), fcl_pose(a.shape)));
    object_b.reset(new fcl::CollisionObjectd(fcl_geometry(b), fcl_pose(b.shape)));
}

static void collide(const known_t &known)
{
    fcl::CollisionRequestd request(1, true);
    fcl::CollisionResultd result;
    const unsigned long before = compare_queries();
    request.gjk_solver_type = fcl::GST_LIBCCD;
    const bool answered = answers([&] { fcl::collide(object_a.get(), object_b.get(), request, result); });
    if (compare_queries() == before)
        return; /* FCL has a closed form for these two, or its boxes excluded them */
    if (!answered)
        threw++;
    else if (result.numContacts() == 0)
        pose_judge(&a, &b, &known, 0, 0, 0, 0);
    else
        pose_judge(&a, &b, &known, 0, 1, result.getContact(0).penetration_depth, result.getContact(0).normal.norm());
}

/* By FCL's own EPA on libccd's polytope functions. */
static void distance(const known_t &known)
{
    fcl::DistanceRequestd request(true, true);
    fcl::DistanceResultd result;
    const unsigned long before = compare_supports();
    static double value;
    request.gjk_solver_type = fcl::GST_LIBCCD;
    const bool answered = answers([&] { value = fcl::distance(object_a.get(), object_b.get(), request, result); });
    if (compare_supports() != before)
        printf("distance %.17g %.17g\n", answered ? value : NAN, -0.5 * (known.lower + known.upper));
}

static void ask(const known_t *known)
{
    object_b->setTransform(fcl_pose(b.shape));
    object_b->computeAABB();
    collide(*known);
    if (a.kind != KIND_TRIANGLE && b.kind != KIND_TRIANGLE)
        distance(*known);
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
    signal(SIGABRT, on_abort);
    print_library();
    uniform_seed(strtoull(argv[1], NULL, 10));
    pose_all(kinds, KINDS, atol(argv[2]), &a, &b, make, ask);
    return 0;
}
