// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause
//
// A program that knows FCL alone: a box and a cone in 500 poses. newcomer.sh compiles it.

#include <fcl/fcl.h>

#include <cstdio>
#include <random>

int main()
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> part(-0.5, 0.5);
    const fcl::CollisionObjectd box(std::make_shared<fcl::Boxd>(1, 0.5, 0.3));
    const auto cone = std::make_shared<fcl::Coned>(0.4, 0.9);
    int hits = 0;
    for (int i = 0; i < 500; i++) {
        fcl::Transform3d pose = fcl::Transform3d::Identity();
        for (int k = 0; k < 3; k++)
            pose.translation()[k] = part(random);
        fcl::Vector3d axis;
        for (int k = 0; k < 3; k++)
            axis[k] = part(random);
        pose.linear() = fcl::AngleAxisd(6 * part(random), axis.normalized()).toRotationMatrix();
        const fcl::CollisionObjectd other(cone, pose);
        fcl::CollisionRequestd request(1, true);
        fcl::CollisionResultd result;
        hits += fcl::collide(&box, &other, request, result) > 0;
    }
    std::printf("%d of 500 overlap\n", hits);
}
