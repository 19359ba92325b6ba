/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A body of an ODE scene as the shape that the truth and the queries know. */

#ifndef SWAP_ODE_SHAPE_H
#define SWAP_ODE_SHAPE_H

#include "shapes.h"
#include "swap/ode_scene.h"

static inline shape_t ode_shape(const scene_shape_t *s, dGeomID geom)
{
    const dReal *p = dGeomGetPosition(geom), *R = dGeomGetRotation(geom);
    const double rot[9] = { R[0], R[1], R[2], R[4], R[5], R[6], R[8], R[9], R[10] };
    shape_t out = s->kind == SCENE_HULL ? shape_polytope(s->hull.vertex, s->hull.vertices) : shape_make(s->kind, s->p[0], s->p[1], s->p[2]);
    shape_move(&out, p[0], p[1], p[2]);
    shape_turn(&out, rot);
    return out;
}

#endif
