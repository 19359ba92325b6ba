/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The tests' shapes as FCL's geometries, in the precision of ccd_real_t. */

#ifndef ENGINES_FCL_SHAPES_H
#define ENGINES_FCL_SHAPES_H

#include "engines/poses.h"

#include <fcl/fcl.h>
#include <time.h>

typedef fcl::Vector3<ccd_real_t> vec;
typedef fcl::CollisionObject<ccd_real_t> object;
typedef std::shared_ptr<fcl::CollisionGeometry<ccd_real_t>> geometry;

/* FCL's types for a single triangle: a mesh of one, TriangleP, or a hull as of more points. */
enum triangle_t { TRIANGLE_MESH, TRIANGLE_SHAPE, TRIANGLE_HULL };

static inline geometry fcl_polytope(const shape_t &s, triangle_t triangle)
{
    typedef ccd_real_t S;
    auto vertices = std::make_shared<std::vector<vec>>();
    for (int i = 0; i < s.nverts; i++)
        vertices->emplace_back(s.verts[3 * i], s.verts[3 * i + 1], s.verts[3 * i + 2]);
    if (s.nverts == 3 && triangle == TRIANGLE_SHAPE)
        return std::make_shared<fcl::TriangleP<S>>((*vertices)[0], (*vertices)[1], (*vertices)[2]);
    if (s.nverts == 3 && triangle == TRIANGLE_MESH) {
        auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSS<S>>>();
        mesh->beginModel();
        mesh->addTriangle((*vertices)[0], (*vertices)[1], (*vertices)[2]);
        mesh->endModel();
        return mesh;
    }
    /* One face of all vertices: of a few dozen FCL reads no edges. */
    auto face = std::make_shared<std::vector<int>>(1, s.nverts);
    for (int i = 0; i < s.nverts; i++)
        face->push_back(i);
    return std::make_shared<fcl::Convex<S>>(vertices, 1, face);
}

static inline geometry fcl_geometry(const shape_t &s, triangle_t triangle)
{
    typedef ccd_real_t S;
    const S *p = s.p;
    switch (s.type) {
    case SHAPE_SPHERE: return std::make_shared<fcl::Sphere<S>>(p[0]);
    case SHAPE_CAPSULE: return std::make_shared<fcl::Capsule<S>>(p[0], 2 * p[1]);
    case SHAPE_BOX: return std::make_shared<fcl::Box<S>>(2 * p[0], 2 * p[1], 2 * p[2]);
    case SHAPE_CYLINDER: return std::make_shared<fcl::Cylinder<S>>(p[0], 2 * p[1]);
    case SHAPE_CONE: return std::make_shared<fcl::Cone<S>>(p[0], 2 * p[1]);
    case SHAPE_ELLIPSOID: return std::make_shared<fcl::Ellipsoid<S>>(p[0], p[1], p[2]);
    default: return fcl_polytope(s, triangle);
    }
}

/* Makes an ellipsoid with these radii, of `rings - 1` rings of `around` corners, with its planar faces. */
static inline std::shared_ptr<fcl::Convex<ccd_real_t>> fcl_globe(int rings, int around, const vec &radii)
{
    typedef ccd_real_t S;
    const double pi = 3.14159265358979323846;
    auto vertices = std::make_shared<std::vector<vec>>();
    auto faces = std::make_shared<std::vector<int>>();
    for (int i = 1; i < rings; i++)
        for (int k = 0; k < around; k++) {
            const double t = pi * i / rings, p = 2 * pi * k / around;
            vertices->push_back(radii.cwiseProduct(vec(S(sin(t) * cos(p)), S(sin(t) * sin(p)), S(cos(t)))));
        }
    for (int i = 0; i + 2 < rings; i++)
        for (int k = 0; k < around; k++) {
            const int next = (k + 1) % around, at = i * around;
            for (int v : {4, at + k, at + around + k, at + around + next, at + next})
                faces->push_back(v);
        }
    for (int cap = 0; cap < 2; cap++) {
        faces->push_back(around);
        for (int k = 0; k < around; k++)
            faces->push_back(cap ? (rings - 2) * around + around - 1 - k : k);
    }
    return std::make_shared<fcl::Convex<S>>(vertices, (rings - 2) * around + 2, faces, true);
}

static inline fcl::Transform3<ccd_real_t> fcl_pose(const shape_t &s)
{
    fcl::Transform3<ccd_real_t> t = fcl::Transform3<ccd_real_t>::Identity();
    t.linear() = Eigen::Map<const Eigen::Matrix<ccd_real_t, 3, 3, Eigen::RowMajor>>(s.rot);
    t.translation() = vec(s.pos[0], s.pos[1], s.pos[2]);
    return t;
}

/* Returns whether the point is outside of the shape by more than `bound`. */
static inline bool is_outside(const shape_t &shape, const vec &p, double bound, double width)
{
    shape_t point = shape_sphere(0);
    shape_move(&point, p[0], p[1], p[2]);
    return !(-truth_depth_within(&shape, &point, width).lower <= bound);
}

/* Returns the processor time of this thread. */
static inline double thread_seconds()
{
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
