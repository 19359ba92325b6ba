/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The bodies of poses.h as FCL's geometries, in the precision of ccd_real_t. */

#ifndef ENGINES_FCL_SHAPES_H
#define ENGINES_FCL_SHAPES_H

#include "engines/poses.h"

#include <fcl/fcl.h>
#include <time.h>

typedef fcl::Vector3<ccd_real_t> vec;
typedef std::shared_ptr<fcl::CollisionGeometry<ccd_real_t>> geometry;

/* FCL's types for a single triangle: a mesh of one, or TriangleP. */
enum triangle_t { TRIANGLE_MESH, TRIANGLE_SHAPE };

static inline std::shared_ptr<std::vector<vec>> fcl_vertices(const shape_t &s)
{
    auto vertices = std::make_shared<std::vector<vec>>();
    for (int i = 0; i < s.nverts; i++)
        vertices->emplace_back(s.verts[3 * i], s.verts[3 * i + 1], s.verts[3 * i + 2]);
    return vertices;
}

static inline geometry fcl_geometry(const body_t &b, triangle_t triangle = TRIANGLE_MESH)
{
    typedef ccd_real_t S;
    const S *p = b.shape.p;
    switch (b.kind) {
    case SHAPE_SPHERE: return std::make_shared<fcl::Sphere<S>>(p[0]);
    case SHAPE_CAPSULE: return std::make_shared<fcl::Capsule<S>>(p[0], 2 * p[1]);
    case KIND_PLATE:
    case SHAPE_BOX: return std::make_shared<fcl::Box<S>>(2 * p[0], 2 * p[1], 2 * p[2]);
    case SHAPE_CYLINDER: return std::make_shared<fcl::Cylinder<S>>(p[0], 2 * p[1]);
    case SHAPE_CONE: return std::make_shared<fcl::Cone<S>>(p[0], 2 * p[1]);
    case SHAPE_ELLIPSOID: return std::make_shared<fcl::Ellipsoid<S>>(p[0], p[1], p[2]);
    default: break;
    }
    auto vertices = fcl_vertices(b.shape);
    if (b.kind == KIND_TRIANGLE && triangle == TRIANGLE_SHAPE)
        return std::make_shared<fcl::TriangleP<S>>((*vertices)[0], (*vertices)[1], (*vertices)[2]);
    if (b.kind == KIND_TRIANGLE) {
        auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSS<S>>>();
        mesh->beginModel();
        mesh->addTriangle((*vertices)[0], (*vertices)[1], (*vertices)[2]);
        mesh->endModel();
        return mesh;
    }
    auto faces = std::make_shared<std::vector<int>>();
    for (int i = 0; i < 4 * b.hull.faces; i++)
        faces->push_back((int)b.hull.polygon[i]);
    return std::make_shared<fcl::Convex<S>>(vertices, b.hull.faces, faces, true);
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
