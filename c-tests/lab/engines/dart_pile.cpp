/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A pile in DART falls on a plate with walls. Scenes:
 *
 *   fcl  FCL's detector: boxes, spheres, ellipsoids
 *   ode  ODE's detector: cylinders, capsules, boxes
 *
 * usage: dart_pile SEED STEPS BODIES fcl|ode */

#include "engines/pile.h"

#include <dart/collision/fcl/FCLCollisionDetector.hpp>
#include <dart/config.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/CapsuleShape.hpp>
#include <dart/dynamics/CylinderShape.hpp>
#include <dart/dynamics/EllipsoidShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>

using namespace dart;

static dynamics::ShapePtr shape_of(int i, const std::string &scene)
{
    enum { BOX, SPHERE, ELLIPSOID, CAPSULE, CYLINDER };
    static const int ode[] = { CYLINDER, CAPSULE, BOX }, fcl[] = { ELLIPSOID, BOX, SPHERE };
    const double r = uniform(0.05, 0.12), h = uniform(0.1, 0.24), z = uniform(0.05, 0.12);
    switch (scene == "ode" ? ode[i % 3] : fcl[i % 3]) {
    case BOX: return std::make_shared<dynamics::BoxShape>(Eigen::Vector3d(2 * r, h, 2 * z));
    case SPHERE: return std::make_shared<dynamics::SphereShape>(r);
    case ELLIPSOID: return std::make_shared<dynamics::EllipsoidShape>(Eigen::Vector3d(2 * r, h, 2 * z));
    case CAPSULE: return std::make_shared<dynamics::CapsuleShape>(0.75 * r, h);
    default: return std::make_shared<dynamics::CylinderShape>(r, h);
    }
}

static void add_wall(dynamics::BodyNode *pen, const Eigen::Vector3d &size, const Eigen::Vector3d &at)
{
    auto box = std::make_shared<dynamics::BoxShape>(size);
    auto node = pen->createShapeNodeWith<dynamics::CollisionAspect, dynamics::DynamicsAspect>(box);
    node->setRelativeTranslation(at);
}

int main(int argc, char **argv)
{
    pile_t pile = pile_start(argc, argv, "fcl|ode");
    const std::string scene = pile.scene;
    const double half_width = 0.55;
    auto world = simulation::World::create();
    world->setTimeStep(0.002);
    if (scene == "ode") {
        /* the library registers its detector when it is loaded; its header would need one more package */
        auto *factory = collision::CollisionDetector::getFactory();
        const std::string detector = "libdart-collision-ode.so." + std::to_string(DART_MAJOR_VERSION) + "." +
                                     std::to_string(DART_MINOR_VERSION);
        if (!dlopen(detector.c_str(), RTLD_NOW | RTLD_GLOBAL) || !factory->canCreate("ode")) {
            fprintf(stderr, "no ODE detector\n");
            return 2;
        }
        world->getConstraintSolver()->setCollisionDetector(factory->create("ode"));
    } else {
        auto fcl = collision::FCLCollisionDetector::create();
        fcl->setPrimitiveShapeType(collision::FCLCollisionDetector::PRIMITIVE);
        fcl->setContactPointComputationMethod(collision::FCLCollisionDetector::FCL);
        world->getConstraintSolver()->setCollisionDetector(fcl);
    }
    auto pen = dynamics::Skeleton::create("pen");
    auto *ground = pen->createJointAndBodyNodePair<dynamics::WeldJoint>().second;
    pen->setMobile(false);
    add_wall(ground, Eigen::Vector3d(4, 4, 1), Eigen::Vector3d(0, 0, -0.5));
    for (int i = 0; i < 4; i++) {
        Eigen::Vector3d at(0, 0, 1), size(4, 4, 4);
        at[i & 1] = (i & 2 ? 1 : -1) * (half_width + 0.5);
        size[i & 1] = 1;
        add_wall(ground, size, at);
    }
    world->addSkeleton(pen);
    std::vector<dynamics::BodyNode *> falling;
    uniform_seed(3);
    for (int i = 0; i < pile.bodies; i++) {
        auto skeleton = dynamics::Skeleton::create("body" + std::to_string(i));
        auto pair = skeleton->createJointAndBodyNodePair<dynamics::FreeJoint>();
        auto shape = shape_of(i, scene);
        double q[4], at[3];
        pair.second->createShapeNodeWith<dynamics::CollisionAspect, dynamics::DynamicsAspect>(shape);
        const double mass = 1000 * shape->getVolume();
        pair.second->setInertia(dynamics::Inertia(mass, Eigen::Vector3d::Zero(), shape->computeInertia(mass)));
        uniform_rotation(q);
        pile_place(i, 0.25, at);
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
        pose.translation() = Eigen::Vector3d(at[0], at[1], at[2]);
        pair.first->setPositions(dynamics::FreeJoint::convertToPositions(pose));
        world->addSkeleton(skeleton);
        falling.push_back(pair.second);
    }
    uniform_seed(pile.seed);
    for (auto *body : falling) {
        auto *joint = body->getParentJoint();
        for (int j = 3; j < 6; j++)
            joint->setPosition(j, joint->getPosition(j) + uniform(-1e-3, 1e-3));
    }
    for (; pile.step < pile.steps; pile.step++) {
        try {
            world->step();
        } catch (const std::exception &e) {
            fprintf(stderr, "step %ld: %s\n", pile.step, e.what());
            pile.bad++;
            break;
        }
        double kinetic = 0, potential = 0;
        for (auto *body : falling) {
            const Eigen::Vector3d p = body->getTransform().translation();
            pile_body(&pile, p.data(), half_width, 0);
            kinetic += body->computeKineticEnergy();
            potential += 9.81 * body->getMass() * p[2];
        }
        pile_energy(&pile, kinetic, potential);
        for (const auto &contact : world->getLastCollisionResult().getContacts())
            pile_contact(&pile, contact.point.norm() < 1e6 ? contact.normal.squaredNorm() : NAN, contact.penetrationDepth);
    }
    pile_report(&pile);
    return 0;
}
