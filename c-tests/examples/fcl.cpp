/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Collides moving bodies with FCL's broad phase and this library, with a state for each pair.
 *
 * In the repository, after the swap of README.md (-lccd would find libccd-dev's, which libfcl-dev brings):
 *
 *     g++ -O2 -Iinclude -I/usr/include/eigen3 c-tests/examples/fcl.cpp target/swap/libccd.so.2 -Wl,-rpath,"$PWD/target/swap" -lfcl && ./a.out
 *
 * A box and a ball fall onto a table; each frame prints the contacts, and the distance of the two. */

#include <ccd/fcl.hpp>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

#include <cstdio>
#include <memory>

static void move_to(fcl::CollisionObjectd &object, double x, double z)
{
    object.setTranslation(fcl::Vector3d(x, 0, z));
    object.computeAABB();
}

int main()
{
    fcl::CollisionObjectd table(std::make_shared<fcl::Boxd>(2, 2, 0.1));
    fcl::CollisionObjectd box(std::make_shared<fcl::Boxd>(0.4, 0.4, 0.4));
    fcl::CollisionObjectd ball(std::make_shared<fcl::Sphered>(0.2));
    move_to(table, 0, -0.05);
    fcl::DynamicAABBTreeCollisionManagerd manager;
    for (fcl::CollisionObjectd *object : {&table, &box, &ball})
        manager.registerObject(object);
    manager.setup();

    ccd_fcl::PairCache cache; /* of all frames, one for each thread */
    for (int frame = 0; frame < 4; frame++) {
        move_to(box, -0.3, 0.23 - 0.011 * frame);
        move_to(ball, 0.3 - 0.02 * frame, 0.23 - 0.011 * frame);
        manager.update();

        ccd_fcl::CollisionData<double> data(cache);
        data.request.enable_contact = true;
        data.request.num_max_contacts = 100;
        manager.collide(&data, ccd_fcl::CollisionFunction<double>);

        fcl::DistanceResultd between; /* negative for an overlap */
        ccd_fcl::distance(&box, &ball, fcl::DistanceRequestd(), between, cache);
        cache.next_frame(); /* removes pairs that were not queried */

        const std::size_t count = data.result.numContacts();
        std::printf("frame %d: %zu contacts, box and ball %.3f m apart\n", frame, count, between.min_distance);
        for (std::size_t i = 0; i < count; i++) {
            const fcl::Contactd &c = data.result.getContact(i);
            std::printf("  at (%.3f, %.3f, %.3f), %.1f mm deep\n", c.pos[0], c.pos[1], c.pos[2], 1000 * c.penetration_depth);
        }
    }
    return 0;
}
