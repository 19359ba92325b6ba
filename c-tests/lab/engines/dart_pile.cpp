/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A pile in DART over FCL: random boxes, spheres and ellipsoids, of SEED, fall on a plate with walls.
 *
 * usage: dart_pile SEED STEPS BODIES */

#include "harness/identity.h"
#include "harness/random.h"

#include <dart/collision/fcl/FCLCollisionDetector.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/EllipsoidShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>
#include <time.h>

using namespace dart;
using Eigen::Vector3d;

static dynamics::ShapePtr random_shape(int i)
{
    const Vector3d size(uniform(0.1, 0.24), uniform(0.1, 0.24), uniform(0.1, 0.24));
    switch (i % 3) {
    case 0: return std::make_shared<dynamics::EllipsoidShape>(size);
    case 1: return std::make_shared<dynamics::BoxShape>(size);
    default: return std::make_shared<dynamics::SphereShape>(size[0] / 2);
    }
}

static void add_wall(dynamics::BodyNode *pen, const Vector3d &size, const Vector3d &at)
{
    const auto box = std::make_shared<dynamics::BoxShape>(size);
    pen->createShapeNodeWith<dynamics::CollisionAspect, dynamics::DynamicsAspect>(box)->setRelativeTranslation(at);
}

static dynamics::SkeletonPtr make_pen()
{
    auto pen = dynamics::Skeleton::create("pen");
    auto *ground = pen->createJointAndBodyNodePair<dynamics::WeldJoint>().second;
    pen->setMobile(false);
    add_wall(ground, Vector3d(4, 4, 1), Vector3d(0, 0, -0.5));
    for (int side : {-1, 1}) {
        add_wall(ground, Vector3d(1, 4, 4), Vector3d(side * 1.05, 0, 1));
        add_wall(ground, Vector3d(4, 1, 4), Vector3d(0, side * 1.05, 1));
    }
    return pen;
}

static dynamics::SkeletonPtr make_body(int i)
{
    auto skeleton = dynamics::Skeleton::create("body" + std::to_string(i));
    auto pair = skeleton->createJointAndBodyNodePair<dynamics::FreeJoint>();
    const auto shape = random_shape(i);
    const double mass = 1000 * shape->getVolume();
    double q[4];
    pair.second->createShapeNodeWith<dynamics::CollisionAspect, dynamics::DynamicsAspect>(shape);
    pair.second->setInertia(dynamics::Inertia(mass, Vector3d::Zero(), shape->computeInertia(mass)));
    uniform_rotation(q);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    pose.translation() = Vector3d(0.34 * (i % 3 - 1), 0.34 * (i / 3 % 3 - 1), 0.25 + 0.33 * (i / 9));
    pose.translation() += Vector3d(uniform(-.02, .02), uniform(-.02, .02), 0);
    pair.first->setPositions(dynamics::FreeJoint::convertToPositions(pose));
    return skeleton;
}

int main(int argc, char **argv)
{
    if (argc != 4) {
        fprintf(stderr, "usage: dart_pile SEED STEPS BODIES\n");
        return 2;
    }
    print_library();
    uniform_seed(strtoull(argv[1], NULL, 10));
    auto world = simulation::World::create();
    auto fcl = collision::FCLCollisionDetector::create();
    fcl->setPrimitiveShapeType(collision::FCLCollisionDetector::PRIMITIVE);
    fcl->setContactPointComputationMethod(collision::FCLCollisionDetector::FCL);
    world->getConstraintSolver()->setCollisionDetector(fcl);
    world->setTimeStep(0.002);
    world->addSkeleton(make_pen());
    for (int i = 0; i < atoi(argv[3]); i++)
        world->addSkeleton(make_body(i));
    for (long step = 0; step < atol(argv[2]); step++)
        world->step();
    printf("processor seconds %.6f\n", (double)clock() / CLOCKS_PER_SEC);
    return 0;
}
