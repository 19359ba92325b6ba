/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The bodies of poses.h as ODE's geometries. */

#ifndef ENGINES_ODE_SHAPES_H
#define ENGINES_ODE_SHAPES_H

#include "engines/poses.h"

#include <ode/ode.h>

/* Returns a geometry of any body but a triangle; ODE refers to the body's hull. */
static inline dGeomID ode_geometry(dSpaceID space, const body_t *b)
{
    const double *p = b->shape.p;
    switch (b->kind) {
    case SHAPE_SPHERE: return dCreateSphere(space, p[0]);
    case SHAPE_CAPSULE: return dCreateCapsule(space, p[0], 2 * p[1]);
    case SHAPE_BOX:
    case KIND_PLATE: return dCreateBox(space, 2 * p[0], 2 * p[1], 2 * p[2]);
    case SHAPE_CYLINDER: return dCreateCylinder(space, p[0], 2 * p[1]);
    default:
        return dCreateConvex(space, b->hull.plane, (unsigned)b->hull.faces, b->hull.vertex, (unsigned)b->hull.vertices,
                             b->hull.polygon);
    }
}

#endif
