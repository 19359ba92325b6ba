/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* FCL's continuous collision by conservative advancement, which takes the normal from the witness points of the distance; and
 * these points of boxes that nearly touch. Prints
 *
 *   head_on pairs N missed N    bodies that move along x onto a side of a box
 *   turned pairs N missed N     bodies turned at random, one of which moves into the other's center
 *   near pairs N threw N unequal N aside N    equal boxes beside each other, a gap of -1e-15 to 1e-9 of their size: the
 *                               points are not |distance| apart, their difference is more than 1e-3 off the normal
 *
 * All pairs of the first two sets meet. usage: fcl_continuous PAIRS */

#include "harness/identity.h"
#include "harness/random.h"

#include <fcl/fcl.h>

#include <memory>

typedef fcl::Vector3d vec;
typedef std::shared_ptr<fcl::CollisionGeometryd> geometry;

static fcl::Transform3d random_pose(const vec &at)
{
    double q[4];
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    uniform_rotation(q);
    pose.linear() = fcl::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    pose.translation() = at;
    return pose;
}

static vec random_point() { return vec(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)); }

/* Makes a body of 10 to 30 cm across; kinds for which FCL's advancement is defined. */
static geometry body(long kind, double radius)
{
    switch (kind % 4) {
    case 0:
        return geometry(new fcl::Boxd(2 * radius, .4, .4));
    case 1:
        return geometry(new fcl::Capsuled(radius, .5));
    case 2:
        return geometry(new fcl::Cylinderd(radius, .5));
    default:
        return geometry(new fcl::Coned(radius, .5));
    }
}

/* Returns whether FCL finds an impact of a resting body and one that moves to `end` without turning. */
static bool meets(const geometry &resting, const fcl::Transform3d &at, const geometry &moving, const fcl::Transform3d &start,
                  const vec &end)
{
    fcl::Transform3d last = start;
    fcl::ContinuousCollisionRequestd request;
    fcl::ContinuousCollisionResultd result;
    last.translation() = end;
    request.ccd_motion_type = fcl::CCDM_TRANS;
    request.ccd_solver_type = fcl::CCDC_CONSERVATIVE_ADVANCEMENT;
    request.gjk_solver_type = fcl::GST_LIBCCD;
    request.num_max_iterations = 1000;
    request.toc_err = 1e-6;
    fcl::continuousCollide(resting.get(), at, at, moving.get(), start, last, request, result);
    return result.is_collide;
}

static void move_head_on(long pairs)
{
    long missed = 0;
    for (long i = 0; i < pairs; i++) {
        const geometry box(new fcl::Boxd(1, 1, 1)), moving = body(i % 3, uniform(.1, .3));
        fcl::Transform3d start = fcl::Transform3d::Identity();
        start.translation() = vec(uniform(1.7, 2.3), uniform(-.3, .3), uniform(-.2, .2));
        const vec end(-1.5, start.translation()[1], start.translation()[2]);
        missed += !meets(box, fcl::Transform3d::Identity(), moving, start, end);
    }
    printf("head_on pairs %ld missed %ld\n", pairs, missed);
}

static void move_turned(long pairs)
{
    long missed = 0;
    for (long i = 0; i < pairs; i++) {
        /* Two capsules are a closed form of FCL, which never asks libccd. */
        const long kind = i % 16 == 5 ? 2 : i / 4;
        const geometry resting = body(i, uniform(.1, .3)), moving = body(kind, uniform(.1, .3));
        const fcl::Transform3d at = random_pose(random_point());
        const vec way = random_point().normalized();
        missed += !meets(resting, at, moving, random_pose(at.translation() + 2 * way), at.translation());
    }
    printf("turned pairs %ld missed %ld\n", pairs, missed);
}

static void measure_near(long pairs)
{
    static const double gaps[] = {0, 1e-16, -1e-16, 1e-15, -1e-15, 1e-14, 1e-12, 1e-9};
    long threw = 0, unequal = 0, aside = 0;
    for (long i = 0; i < pairs; i++) {
        const double size = uniform(.1, 1);
        const geometry box(new fcl::Boxd(size, size, size));
        const fcl::Transform3d first = random_pose(random_point());
        fcl::Transform3d second = first;
        const vec normal = first.linear().col(i % 3);
        second.translation() += normal * (size * (1 + gaps[i % 8]));
        fcl::DistanceRequestd request(true, false, 0, 0, 1e-6, fcl::GST_LIBCCD);
        fcl::DistanceResultd result;
        try {
            fcl::distance(box.get(), first, box.get(), second, request, result);
        } catch (const std::exception &) {
            threw++;
            continue;
        }
        const vec way = result.nearest_points[1] - result.nearest_points[0];
        if (result.min_distance < 0)
            continue;
        unequal += !(fabs(way.norm() - result.min_distance) <= 1e-14);
        aside += !((way.normalized() - normal).norm() <= 1e-3);
    }
    printf("near pairs %ld threw %ld unequal %ld aside %ld\n", pairs, threw, unequal, aside);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: fcl_continuous PAIRS\n");
        return 2;
    }
    print_library();
    uniform_seed(46);
    move_head_on(atol(argv[1]));
    move_turned(atol(argv[1]));
    measure_near(atol(argv[1]));
    return 0;
}
