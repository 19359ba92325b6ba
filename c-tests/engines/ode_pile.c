/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A simulation in ODE: boxes, cylinders, capsules and convex hulls in a pen of a floor and four walls.
 * Metres, kilograms, seconds; z is up. Scenes:
 *
 *   pile   boxes, cylinders, capsules and hulls fall into the pen and come to rest
 *   hulls  convex hulls alone
 *   stack  towers of flat boxes, ODE's own and hulls in turn
 *   roll   cylinders roll to and fro on the floor
 *   tower  one tower of flat hulls, stacked exactly
 *
 * All but the last start moved by up to 1e-3 m a coordinate, towers and cylinders 1e-5 m. Prints the deepest contact, the
 * energy gained, and what must not be: whether a body left the pen, and the number of contacts that are none.
 *
 * usage: ode_pile SEED STEPS BODIES SCENE */

#include "engines/ode_shapes.h"
#include "harness/identity.h"

#include <time.h>

enum { SCENE_BODIES = 96 };

typedef struct {
    dWorldID world;
    dSpaceID space;
    dJointGroupID contacts;
    int bodies;
    body_t shape[SCENE_BODIES];
    dGeomID geom[SCENE_BODIES];
    dBodyID body[SCENE_BODIES]; /* NULL for static ones */
    double half_width;          /* of the pen */
    double deepest;             /* contact, metres */
    double least, gained;       /* energy, and how far it rose above its least, joules */
    int escaped;
    long bad; /* contacts whose normal is not unit, or with a number that is not finite */
} scene_t;

static scene_t scene;

/* --- the scenes ---------------------------------------------------------------------- */

/* Adds a body whose shape is made; returns its index. */
static int scene_add_shape(void)
{
    const int i = scene.bodies++;
    scene.geom[i] = ode_geometry(scene.space, &scene.shape[i]);
    scene.body[i] = NULL;
    return i;
}

/* Adds a body of a primitive shape, or a box as a hull; returns its index. */
static int scene_add(int kind, double x, double y, double z)
{
    body_t *b = &scene.shape[scene.bodies];
    b->kind = kind;
    b->shape = shape_make(kind, x, y, z);
    if (kind == SHAPE_POLYTOPE) {
        hull_box(&b->hull, x, y, z);
        body_set_hull(b);
    }
    return scene_add_shape();
}

/* Gives the body density 1000; a hull has mass and inertia of a ball of its mean radius. */
static void scene_make_dynamic(int i)
{
    const body_t *b = &scene.shape[i];
    const double density = 1000, *p = b->shape.p;
    dMass mass;
    switch (b->kind) {
    case SHAPE_CAPSULE: dMassSetCapsule(&mass, density, 3, p[0], 2 * p[1]); break;
    case SHAPE_BOX: dMassSetBox(&mass, density, 2 * p[0], 2 * p[1], 2 * p[2]); break;
    case SHAPE_CYLINDER: dMassSetCylinder(&mass, density, 3, p[0], 2 * p[1]); break;
    default: {
        double r = 0;
        for (int v = 0; v < b->hull.vertices; v++)
            r += dCalcVectorLength3(b->hull.vertex + 3 * v) / b->hull.vertices;
        dMassSetSphere(&mass, density, 0.8 * r);
    }
    }
    scene.body[i] = dBodyCreate(scene.world);
    dBodySetMass(scene.body[i], &mass);
    dGeomSetBody(scene.geom[i], scene.body[i]);
}

/* Adds body i of a pile, about 0.1 m in size: a hull, or one of four kinds in turn. */
static int scene_add_random(int i, int hulls)
{
    static const int kinds[4] = { SHAPE_BOX, SHAPE_CYLINDER, SHAPE_CAPSULE, SHAPE_POLYTOPE };
    const int kind = hulls ? SHAPE_POLYTOPE : kinds[i % 4];
    body_t *b = &scene.shape[scene.bodies];
    double p[3];
    if (kind == SHAPE_POLYTOPE) {
        b->kind = kind;
        hull_random(&b->hull, 8 + i % 9, uniform(0.07, 0.14), uniform(0.07, 0.14), uniform(0.07, 0.14));
        body_set_hull(b);
        return scene_add_shape();
    }
    for (int j = 0; j < 3; j++)
        p[j] = (float)uniform(0.05, 0.13);
    return scene_add(kind, kind == SHAPE_CAPSULE ? (float)(0.75 * p[0]) : p[0], p[1], p[2]);
}

static void scene_world(unsigned long seed)
{
    scene.world = dWorldCreate();
    scene.space = dHashSpaceCreate(0);
    scene.contacts = dJointGroupCreate(0);
    dHashSpaceSetLevels(scene.space, -4, 2);
    dWorldSetGravity(scene.world, 0, 0, -9.81);
    dWorldSetERP(scene.world, 0.2);
    dWorldSetCFM(scene.world, 1e-6);
    dWorldSetContactSurfaceLayer(scene.world, 1e-3);
    dWorldSetContactMaxCorrectingVel(scene.world, 2);
    dWorldSetQuickStepNumIterations(scene.world, 30);
    dWorldSetLinearDamping(scene.world, 5e-4);
    dWorldSetAngularDamping(scene.world, 2e-3);
    dRandSetSeed(seed);
    uniform_seed(seed);
}

/* Floor (top at z = 0) and four walls: thick boxes. */
static void scene_pen(double half_width)
{
    scene.half_width = half_width;
    dGeomSetPosition(scene.geom[scene_add(SHAPE_BOX, 2, 2, 2)], 0, 0, -2);
    for (int i = 0; i < 4; i++) {
        const double at = (i & 1 ? 1 : -1) * (float)(half_width + 2);
        dGeomSetPosition(scene.geom[scene_add(SHAPE_BOX, 2, 2, 2)], i & 2 ? at : 0, i & 2 ? 0 : at, 1.5);
    }
}

/* Moves every body by up to `nudge` a coordinate, by a random stream of its own, so that
 * two starts differ in nothing else. */
static void scene_nudge(unsigned long seed, double nudge)
{
    uniform_seed(seed);
    for (int i = 0; i < scene.bodies; i++)
        if (scene.body[i]) {
            double at[3];
            for (int j = 0; j < 3; j++)
                at[j] = dBodyGetPosition(scene.body[i])[j] + uniform(-nudge, nudge);
            dBodySetPosition(scene.body[i], at[0], at[1], at[2]);
        }
    dRandSetSeed(seed);
}

/* Bodies in layers above the floor of a pen, turned at random. */
static void scene_pile(int bodies, int hulls)
{
    const double half_width = 0.55, pitch = 0.32, layer = 0.33;
    const int side = (int)((2 * half_width - 0.1) / pitch);
    scene_pen(half_width);
    for (int i = 0; i < bodies; i++) {
        const int b = scene_add_random(i, hulls);
        const int level = i / (side * side), x = i % side, y = i / side % side;
        dQuaternion q;
        scene_make_dynamic(b);
        uniform_rotation(q);
        dBodySetQuaternion(scene.body[b], q);
        dBodySetPosition(scene.body[b], (x - 0.5 * (side - 1)) * pitch + uniform(-0.02, 0.02),
                         (y - 0.5 * (side - 1)) * pitch + uniform(-0.02, 0.02), 0.25 + layer * level);
    }
}

/* Towers of five flat boxes in a pen, every second one an ODE box, the others hulls; or one in its
 * middle, of hulls alone. Each box begins exactly where the one below ends: a touch at first. */
static void scene_towers(int bodies, int one)
{
    scene_pen(0.8);
    for (int i = 0; i < bodies; i++) {
        const int b = scene_add(i % 2 || one ? SHAPE_POLYTOPE : SHAPE_BOX, 0.125, 0.125, 0.0625), level = one ? i : i % 5;
        scene_make_dynamic(b);
        const double x = one ? 0 : 0.4 * (i / 5 % 2) - 0.2, y = one ? 0 : 0.4 * (i / 10) - 0.2;
        dBodySetPosition(scene.body[b], x, y, 0.0625 + 0.125 * level);
    }
}

/* Cylinders that lie on a plate and roll, to and fro between the walls of a pen. The
 * plate is a hull: ODE collides a cylinder with a box without libccd. */
static void scene_roll(int count)
{
    const double half_width = 1.5, quarter = 0.5 * 3.14159265358979323846;
    scene_pen(half_width);
    dGeomSetPosition(scene.geom[scene_add(SHAPE_POLYTOPE, half_width, half_width, 0.05)], 0, 0, 0.05);
    for (int i = 0; i < count; i++) {
        const double radius = 0.06 + 0.01 * (i % 5);
        const int b = scene_add(SHAPE_CYLINDER, radius, 0.08 + 0.02 * (i % 3), 0);
        dQuaternion q;
        scene_make_dynamic(b);
        dQFromAxisAndAngle(q, 1, 0, 0, quarter); /* axis along y */
        dBodySetQuaternion(scene.body[b], q);
        dBodySetPosition(scene.body[b], -0.5 * half_width, (i + 0.5) * 2 * half_width / count - half_width, 0.1 + radius);
        dBodySetLinearVel(scene.body[b], 0.5, 0, 0);
        dBodySetAngularVel(scene.body[b], 0, 0.5 / radius, 0);
    }
}

/* Counts a contact; returns whether it is one. Negated so that NaN is none. */
static int scene_contact(const dContactGeom *g)
{
    if (!(fabs(dCalcVectorLengthSquare3(g->normal) - 1) < 1e-6) || !(fabs(g->pos[0] + g->pos[1] + g->pos[2]) < 1e6) ||
        !(fabs(g->depth) < 1e3)) {
        scene.bad++;
        return 0;
    }
    scene.deepest = fmax(scene.deepest, g->depth);
    return 1;
}

static void scene_near(void *data, dGeomID o1, dGeomID o2)
{
    enum { MAX_CONTACTS = 8 };
    dContact contact[MAX_CONTACTS];
    const dBodyID b1 = dGeomGetBody(o1), b2 = dGeomGetBody(o2);
    (void)data;
    if (!b1 && !b2)
        return;
    int n = dCollide(o1, o2, MAX_CONTACTS, &contact[0].geom, sizeof contact[0]);
    for (int i = 0; i < n; i++) {
        if (!scene_contact(&contact[i].geom))
            continue;
        contact[i].surface.mode = dContactApprox1;
        contact[i].surface.mu = 0.6;
        dJointAttach(dJointCreateContact(scene.world, scene.contacts, &contact[i]), b1, b2);
    }
}

/* Adds the energies of all bodies, and counts those that left the pen. */
static void scene_report_step(void)
{
    double energy = 0;
    for (int i = 0; i < scene.bodies; i++)
        if (scene.body[i]) {
            const dReal *v = dBodyGetLinearVel(scene.body[i]), *R = dBodyGetRotation(scene.body[i]);
            const dReal *w = dBodyGetAngularVel(scene.body[i]), *p = dBodyGetPosition(scene.body[i]);
            double local[3];
            dMass m;
            dBodyGetMass(scene.body[i], &m);
            for (int j = 0; j < 3; j++)
                local[j] = R[j] * w[0] + R[4 + j] * w[1] + R[8 + j] * w[2];
            energy += 0.5 * m.mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            for (int j = 0; j < 3; j++)
                for (int k = 0; k < 3; k++)
                    energy += 0.5 * local[j] * m.I[4 * j + k] * local[k];
            energy += 9.81 * m.mass * p[2];
            scene.escaped |= !(fabs(p[0]) < scene.half_width && fabs(p[1]) < scene.half_width && p[2] > 0 && p[2] < 20);
        }
    scene.least = fmin(scene.least, energy);
    scene.gained = fmax(scene.gained, energy - scene.least);
}

int main(int argc, char **argv)
{
    if (argc != 5) {
        fprintf(stderr, "usage: ode_pile SEED STEPS BODIES pile|hulls|stack|roll|tower\n");
        return 2;
    }
    const unsigned long seed = strtoul(argv[1], NULL, 10);
    const int bodies = atoi(argv[3]);
    const char *const name = argv[4];
    print_library();
    dInitODE2(0);
    scene_world(11);
    scene.least = HUGE_VAL;
    if (!strcmp(name, "tower")) {
        scene_towers(bodies, 1);
    } else if (!strcmp(name, "stack")) {
        scene_towers(bodies, 0);
        scene_nudge(seed, 1e-5);
    } else if (!strcmp(name, "roll")) {
        scene_roll(bodies);
        scene_nudge(seed, 1e-5);
    } else {
        scene_pile(bodies, !strcmp(name, "hulls"));
        scene_nudge(seed, 1e-3);
    }
    for (long step = 0; step < atol(argv[2]); step++) {
        dSpaceCollide(scene.space, NULL, scene_near);
        dWorldQuickStep(scene.world, 0.005);
        dJointGroupEmpty(scene.contacts);
        scene_report_step();
    }
    printf("pile deepest %.9g gained %.9g escaped %d bad %ld\n", scene.deepest, scene.gained, scene.escaped, scene.bad);
    printf("processor seconds %.6f\n", (double)clock() / CLOCKS_PER_SEC);
    dJointGroupDestroy(scene.contacts);
    dSpaceDestroy(scene.space);
    dWorldDestroy(scene.world);
    dCloseODE();
    return 0;
}
