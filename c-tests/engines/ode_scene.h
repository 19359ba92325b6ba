/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/*
 * A pen of falling bodies in ODE: boxes, cylinders, capsules and convex hulls
 * between a floor and four walls. Metres, kilograms, seconds; z is up.
 * The simulations of the swap test share it.
 */
#ifndef ODE_SCENE_H
#define ODE_SCENE_H

#include <string.h>
#include <ode/ode.h>
#include "harness/identity.h"
#include "harness/shapes.h"
#include "engines/hull.h"
#include "engines/pile.h"

enum { SCENE_BODIES = 96, SCENE_SHAPES = 96 };

typedef struct {
    int kind;                   /* of shapes.h; the numbers go into files */
    double p[3];                /* capsule, cylinder: radius, half length; box: half extents */
    hull_t hull;
} scene_shape_t;

typedef struct {
    dWorldID world;
    dSpaceID space;
    dJointGroupID contacts;
    int shapes, bodies;
    scene_shape_t shape[SCENE_SHAPES];
    int shape_of[SCENE_BODIES];
    dGeomID geom[SCENE_BODIES];
    dBodyID body[SCENE_BODIES]; /* NULL for what stands still */
    double half_width;          /* the pen is 2 half_width wide */
    int kinds[4];               /* of a pile, by turns */
    pile_t pile;
} scene_t;

/* Where set, makes the geoms in ODE's place. */
static dGeomID (*scene_make_geom)(const scene_shape_t *s);

/* Where set, told every pair the broad phase lets through, and the contacts ODE made of it. */
static void (*scene_on_pair)(int a, int b, const dContact *contact, int contacts);

static inline dGeomID scene_geom(scene_t *scene, const scene_shape_t *s)
{
    if (scene_make_geom) {
        const dGeomID geom = scene_make_geom(s);
        dSpaceAdd(scene->space, geom);
        return geom;
    }
    switch (s->kind) {
    case SHAPE_CAPSULE: return dCreateCapsule(scene->space, s->p[0], 2 * s->p[1]);
    case SHAPE_BOX: return dCreateBox(scene->space, 2 * s->p[0], 2 * s->p[1], 2 * s->p[2]);
    case SHAPE_CYLINDER: return dCreateCylinder(scene->space, s->p[0], 2 * s->p[1]);
    default: return dCreateConvex(scene->space, s->hull.plane, (unsigned)s->hull.faces, s->hull.vertex, (unsigned)s->hull.vertices,
                                   s->hull.polygon);
    }
}

/* A shape; of a hull, the box with these half extents. */
static inline int scene_shape(scene_t *scene, int kind, double x, double y, double z)
{
    scene_shape_t *s = &scene->shape[scene->shapes];
    memset(s, 0, sizeof *s);
    s->kind = kind;
    s->p[0] = x;
    s->p[1] = y;
    s->p[2] = z;
    if (kind == SHAPE_POLYTOPE)
        hull_box(&s->hull, x, y, z);
    return scene->shapes++;
}

static inline int scene_add(scene_t *scene, int shape)
{
    const scene_shape_t *s = &scene->shape[shape];
    const int i = scene->bodies++;
    scene->shape_of[i] = shape;
    scene->geom[i] = scene_geom(scene, s);
    dGeomSetData(scene->geom[i], (void *)(intptr_t)i);
    scene->body[i] = NULL;
    return i;
}

/* A body of density 1000. A hull is given the mass and inertia of a ball of its mean radius. */
static inline void scene_make_dynamic(scene_t *scene, int i)
{
    const scene_shape_t *s = &scene->shape[scene->shape_of[i]];
    const double density = 1000;
    dMass mass;
    switch (s->kind) {
    case SHAPE_CAPSULE: dMassSetCapsule(&mass, density, 3, s->p[0], 2 * s->p[1]); break;
    case SHAPE_BOX: dMassSetBox(&mass, density, 2 * s->p[0], 2 * s->p[1], 2 * s->p[2]); break;
    case SHAPE_CYLINDER: dMassSetCylinder(&mass, density, 3, s->p[0], 2 * s->p[1]); break;
    default: {
        double r = 0;
        for (int v = 0; v < s->hull.vertices; v++)
            r += dCalcVectorLength3(s->hull.vertex + 3 * v) / s->hull.vertices;
        dMassSetSphere(&mass, density, 0.8 * r);
    }
    }
    scene->body[i] = dBodyCreate(scene->world);
    dBodySetMass(scene->body[i], &mass);
    dGeomSetBody(scene->geom[i], scene->body[i]);
}

/* Shape number for body i of a pile: kinds by turns, sizes around 0.1 m, as floats. */
static inline int scene_pile_shape(scene_t *scene, int i)
{
    scene_shape_t *s = &scene->shape[scene->shapes];
    memset(s, 0, sizeof *s);
    s->kind = scene->kinds[i % 4];
    if (s->kind == SHAPE_POLYTOPE)
        hull_random(&s->hull, 8 + i % 9, uniform(0.07, 0.14), uniform(0.07, 0.14), uniform(0.07, 0.14));
    else
        for (int j = 0; j < 3; j++)
            s->p[j] = (float)uniform(0.05, 0.13);
    if (s->kind == SHAPE_CAPSULE)
        s->p[0] *= 0.75;
    s->p[0] = (float)s->p[0];
    return scene->shapes++;
}

static inline void scene_world(scene_t *scene, unsigned long seed)
{
    static const int all[4] = { SHAPE_BOX, SHAPE_CYLINDER, SHAPE_CAPSULE, SHAPE_POLYTOPE };
    memset(scene, 0, sizeof *scene);
    memcpy(scene->kinds, all, sizeof all);
    scene->world = dWorldCreate();
    scene->space = dHashSpaceCreate(0);
    scene->contacts = dJointGroupCreate(0);
    dHashSpaceSetLevels(scene->space, -4, 2);
    dWorldSetGravity(scene->world, 0, 0, -9.81);
    dWorldSetERP(scene->world, 0.2);
    dWorldSetCFM(scene->world, 1e-6);
    dWorldSetContactSurfaceLayer(scene->world, 1e-3);
    dWorldSetContactMaxCorrectingVel(scene->world, 2);
    dWorldSetQuickStepNumIterations(scene->world, 30);
    dWorldSetLinearDamping(scene->world, 5e-4);
    dWorldSetAngularDamping(scene->world, 2e-3);
    dRandSetSeed(seed);
    uniform_seed(seed);
}

/* Floor (top at z = 0) and four walls: thick boxes. */
static inline void scene_pen(scene_t *scene, double half_width)
{
    const int wall = scene_shape(scene, SHAPE_BOX, 2, 2, 2);
    scene->half_width = half_width;
    dGeomSetPosition(scene->geom[scene_add(scene, wall)], 0, 0, -2);
    for (int i = 0; i < 4; i++) {
        const double at = (i & 1 ? 1 : -1) * (float)(half_width + 2);
        dGeomSetPosition(scene->geom[scene_add(scene, wall)], i & 2 ? at : 0, i & 2 ? 0 : at, 1.5);
    }
}

/* Moves every start by up to `nudge` a coordinate, by a stream of its own, so that
 * two nudged starts differ in nothing else. */
static inline void scene_nudge(scene_t *scene, unsigned long nudge_seed, double nudge)
{
    uniform_seed(nudge_seed);
    for (int i = 0; i < scene->bodies; i++)
        if (scene->body[i]) {
            double at[3];
            for (int j = 0; j < 3; j++)
                at[j] = dBodyGetPosition(scene->body[i])[j] + uniform(-nudge, nudge);
            dBodySetPosition(scene->body[i], at[0], at[1], at[2]);
        }
    dRandSetSeed(nudge_seed);
}

/*
 * The pile: `count` bodies in layers, `layer` apart, above the floor of a pen, turned at
 * random.
 */
static inline void scene_pile(scene_t *scene, int count, double half_width, double layer)
{
    const double pitch = 0.32;
    const int side = (int)((2 * half_width - 0.1) / pitch);
    scene_pen(scene, half_width);
    for (int i = 0; i < count; i++) {
        const int b = scene_add(scene, scene_pile_shape(scene, i));
        const int level = i / (side * side), x = i % side, y = i / side % side;
        dQuaternion q;
        scene_make_dynamic(scene, b);
        uniform_rotation(q);
        dBodySetQuaternion(scene->body[b], q);
        dBodySetPosition(scene->body[b], (x - 0.5 * (side - 1)) * pitch + uniform(-0.02, 0.02),
                         (y - 0.5 * (side - 1)) * pitch + uniform(-0.02, 0.02), 0.25 + layer * level);
    }
}

/* Towers of five flat boxes in a pen, every second one an ODE box, the others hulls; or one in its
 * middle, of hulls alone. Each box begins exactly where the one below ends: a touch at first. */
static inline void scene_towers(scene_t *scene, int bodies, int one)
{
    int i, shape[2];
    scene_pen(scene, 0.8);
    for (i = 0; i < 2; i++)
        shape[i] = scene_shape(scene, i || one ? SHAPE_POLYTOPE : SHAPE_BOX, 0.125, 0.125, 0.0625);
    for (i = 0; i < bodies; i++) {
        const int b = scene_add(scene, shape[i % 2]), level = one ? i : i % 5;
        scene_make_dynamic(scene, b);
        dBodySetPosition(scene->body[b], one ? 0 : 0.4 * (i / 5 % 2) - 0.2, one ? 0 : 0.4 * (i / 10) - 0.2, 0.0625 + 0.125 * level);
    }
}

/* Cylinders that lie on a plate and roll, to and fro between the walls of a pen. The
 * plate is a hull: for a cylinder on a box of its own ODE does not ask libccd. */
static inline void scene_roll(scene_t *scene, int count, double half_width)
{
    scene_pen(scene, half_width);
    int i = scene_add(scene, scene_shape(scene, SHAPE_POLYTOPE, half_width, half_width, 0.05));
    dGeomSetPosition(scene->geom[i], 0, 0, 0.05);
    for (i = 0; i < count; i++) {
        const double radius = 0.06 + 0.01 * (i % 5);
        const int b = scene_add(scene, scene_shape(scene, SHAPE_CYLINDER, radius, 0.08 + 0.02 * (i % 3), 0));
        dQuaternion q;
        scene_make_dynamic(scene, b);
        dQFromAxisAndAngle(q, 1, 0, 0, 0.5 * 3.14159265358979323846); /* axis along y */
        dBodySetQuaternion(scene->body[b], q);
        dBodySetPosition(scene->body[b], -0.5 * half_width, (i + 0.5) * 2 * half_width / count - half_width, 0.1 + radius);
        dBodySetLinearVel(scene->body[b], 0.5, 0, 0);
        dBodySetAngularVel(scene->body[b], 0, 0.5 / radius, 0);
    }
}

static inline void scene_near(void *data, dGeomID o1, dGeomID o2)
{
    scene_t *scene = (scene_t *)data;
    enum { MOST = 8 };
    dContact contact[MOST];
    const dBodyID b1 = dGeomGetBody(o1), b2 = dGeomGetBody(o2);
    if (!b1 && !b2)
        return;
    int n = dCollide(o1, o2, MOST, &contact[0].geom, sizeof contact[0]);
    if (scene_on_pair)
        scene_on_pair((int)(intptr_t)dGeomGetData(o1), (int)(intptr_t)dGeomGetData(o2), contact, n);
    for (int i = 0; i < n; i++) {
        const dContactGeom *g = &contact[i].geom;
        const int somewhere = fabs(g->pos[0] + g->pos[1] + g->pos[2]) < 1e6;
        if (!pile_contact(&scene->pile, somewhere ? dCalcVectorLengthSquare3(g->normal) : NAN, g->depth))
            continue;
        contact[i].surface.mode = dContactApprox1;
        contact[i].surface.mu = 0.6;
        dJointAttach(dJointCreateContact(scene->world, scene->contacts, &contact[i]), b1, b2);
    }
}

static inline void scene_step(scene_t *scene, double h)
{
    dSpaceCollide(scene->space, scene, scene_near);
    dWorldQuickStep(scene->world, h);
    dJointGroupEmpty(scene->contacts);
}

/* Joules of motion; and, in `potential`, of height above the floor. */
static inline double scene_energy(const scene_t *scene, double *potential)
{
    double kinetic = 0, height = 0;
    for (int i = 0; i < scene->bodies; i++)
        if (scene->body[i]) {
            const dReal *v = dBodyGetLinearVel(scene->body[i]), *R = dBodyGetRotation(scene->body[i]);
            const dReal *w = dBodyGetAngularVel(scene->body[i]);
            double local[3];
            dMass m;
            dBodyGetMass(scene->body[i], &m);
            for (int j = 0; j < 3; j++)
                local[j] = R[j] * w[0] + R[4 + j] * w[1] + R[8 + j] * w[2];
            kinetic += 0.5 * m.mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            for (int j = 0; j < 3; j++)
                for (int k = 0; k < 3; k++)
                    kinetic += 0.5 * local[j] * m.I[4 * j + k] * local[k];
            height += 9.81 * m.mass * dBodyGetPosition(scene->body[i])[2];
        }
    *potential = height;
    return kinetic;
}

/* Bodies whose centre is outside the pen, below the floor, or nowhere. */
static inline int scene_escaped(const scene_t *scene)
{
    int out = 0;
    for (int i = 0; i < scene->bodies; i++)
        if (scene->body[i]) {
            const dReal *p = dBodyGetPosition(scene->body[i]);
            out += !(fabs(p[0]) < scene->half_width && fabs(p[1]) < scene->half_width && p[2] > 0 && p[2] < 20);
        }
    return out;
}

/* A body as the shape that the truth and the queries know. */
static inline shape_t scene_shape_of(const scene_shape_t *s, dGeomID geom)
{
    const dReal *p = dGeomGetPosition(geom), *R = dGeomGetRotation(geom);
    const double rot[9] = { R[0], R[1], R[2], R[4], R[5], R[6], R[8], R[9], R[10] };
    shape_t out = s->kind == SHAPE_POLYTOPE ? shape_polytope(s->hull.vertex, s->hull.vertices) : shape_make(s->kind, s->p[0], s->p[1], s->p[2]);
    shape_move(&out, p[0], p[1], p[2]);
    shape_turn(&out, rot);
    return out;
}

static inline void scene_free(scene_t *scene)
{
    dJointGroupDestroy(scene->contacts);
    dSpaceDestroy(scene->space);
    dWorldDestroy(scene->world);
}

/* --- a run of one of the scenes that ode_pile.c names ------------------------------------ */

/* Makes it, moved by the stream named seed. */
static inline void run_scene(scene_t *scene, const char *name, int bodies, unsigned long seed, long steps)
{
    const int stack = !strcmp(name, "stack"), roll = !strcmp(name, "roll");
    scene_world(scene, 11);
    scene->pile = pile_of(steps);
    if (!strcmp(name, "tower")) {
        scene_towers(scene, bodies, 1);
        return;
    }
    if (stack) {
        scene_towers(scene, bodies, 0);
    } else if (roll) {
        scene_roll(scene, bodies, 1.5);
    } else {
        for (int i = 0; i < 4 && !strcmp(name, "hulls"); i++)
            scene->kinds[i] = SHAPE_POLYTOPE;
        scene_pile(scene, bodies, 0.55, 0.33);
    }
    scene_nudge(scene, seed, stack || roll ? 1e-5 : 1e-3);
}

/* SEED STEPS BODIES SCENE of the command line; prints what the run looked like, but for the line's end. */
static inline void run(scene_t *scene, char **argv)
{
    const long steps = atol(argv[2]);
    print_library();
    run_scene(scene, argv[4], atoi(argv[3]), strtoul(argv[1], NULL, 10), steps);
    for (long step = 0; step < steps; step++) {
        double height, moving;
        scene->pile.step = step;
        scene_step(scene, 0.005);
        scene->pile.escaped |= scene_escaped(scene);
        moving = scene_energy(scene, &height);
        pile_energy(&scene->pile, moving, height);
    }
    pile_report(&scene->pile);
    scene_free(scene);
}

#endif
