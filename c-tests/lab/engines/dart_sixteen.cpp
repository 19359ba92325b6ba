/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Sixteen cylinders, boxes and ellipsoids of 1 kg and some 0.2 m fall on a plate, in DART over FCL with its own shapes. Prints
 * the deepest contact so far after each 50 steps of 1 ms.
 *
 * usage: dart_sixteen STEPS */

#include "harness/identity.h"

#include <dart/collision/fcl/FCLCollisionDetector.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/CylinderShape.hpp>
#include <dart/dynamics/EllipsoidShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>
#include <time.h>

using namespace dart;
using Eigen::Vector3d;

enum { BODIES = 16 };

static void add_shape(dynamics::BodyNode *body, const dynamics::ShapePtr &shape)
{
    body->createShapeNodeWith<dynamics::CollisionAspect, dynamics::DynamicsAspect>(shape);
}

static dynamics::SkeletonPtr make_plate()
{
    auto plate = dynamics::Skeleton::create("plate");
    auto pair = plate->createJointAndBodyNodePair<dynamics::WeldJoint>();
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().z() = -0.1;
    pair.first->setTransformFromParentBodyNode(pose);
    add_shape(pair.second, std::make_shared<dynamics::BoxShape>(Vector3d(6, 6, 0.2)));
    return plate;
}

static dynamics::ShapePtr make_shape(int i)
{
    switch (i % 3) {
    case 0: return std::make_shared<dynamics::CylinderShape>(0.1, 0.3);
    case 1: return std::make_shared<dynamics::BoxShape>(Vector3d(0.2, 0.2, 0.25));
    default: return std::make_shared<dynamics::EllipsoidShape>(Vector3d(0.2, 0.25, 0.3));
    }
}

static dynamics::SkeletonPtr make_body(int i)
{
    auto skeleton = dynamics::Skeleton::create("body" + std::to_string(i));
    auto pair = skeleton->createJointAndBodyNodePair<dynamics::FreeJoint>();
    const auto shape = make_shape(i);
    add_shape(pair.second, shape);
    pair.second->setInertia(dynamics::Inertia(1, Vector3d::Zero(), shape->computeInertia(1)));
    Eigen::Isometry3d pose(Eigen::AngleAxisd(0.7 * i, Vector3d(1, 0.3, 0.2).normalized()));
    pose.translation() = Vector3d(0.3 * (i % 3 - 1), 0.3 * (i / 3 % 2), 0.3 + 0.35 * (i / 6));
    pair.first->setPositions(dynamics::FreeJoint::convertToPositions(pose));
    return skeleton;
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: dart_sixteen STEPS\n");
        return 2;
    }
    print_library();
    auto world = simulation::World::create();
    auto fcl = collision::FCLCollisionDetector::create();
    fcl->setPrimitiveShapeType(collision::FCLCollisionDetector::PRIMITIVE);
    world->getConstraintSolver()->setCollisionDetector(fcl);
    world->addSkeleton(make_plate());
    for (int i = 0; i < BODIES; i++)
        world->addSkeleton(make_body(i));
    double deepest = 0;
    for (long step = 1; step <= atol(argv[1]); step++) {
        world->step();
        for (const auto &contact : world->getLastCollisionResult().getContacts())
            deepest = std::max(deepest, contact.penetrationDepth);
        if (step % 50 == 0) {
            printf("deepest contact of %ld steps %.2f m, then %zu contacts, %.1f s\n", step, deepest,
                   world->getLastCollisionResult().getNumContacts(), (double)clock() / CLOCKS_PER_SEC);
            fflush(stdout);
        }
    }
    return 0;
}
