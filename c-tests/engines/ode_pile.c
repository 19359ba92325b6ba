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
 * All but the last start moved by up to 1e-3 m a coordinate, towers and cylinders 1e-5 m.
 *
 * Compiled plain, ODE queries libccd. With CONTACTS, the most contacts of a pair, this library
 * collides the geometries: a class of dCreateGeomClass, with a state for each pair, and one contact at
 * `pos` or those of ccdContacts.
 *
 * usage: ode_pile SEED STEPS BODIES SCENE */

#include "engines/ode_shapes.h"
#include "engines/pile.h"

#include <ccd/warm.h>
#include <string.h>

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
    pile_t pile;
} scene_t;

static scene_t scene;

#ifdef CONTACTS

/* --- geometries that this library collides ------------------------------------------ */

/* Returns the shape of a body at the pose of its geometry. */
static shape_t shape_at(int i)
{
    const dReal *p = dGeomGetPosition(scene.geom[i]), *R = dGeomGetRotation(scene.geom[i]);
    const double rot[9] = { R[0], R[1], R[2], R[4], R[5], R[6], R[8], R[9], R[10] };
    shape_t shape = scene.shape[i].shape;
    shape_move(&shape, p[0], p[1], p[2]);
    shape_turn(&shape, rot);
    return shape;
}

static int index_of(dGeomID geom) { return (int)(intptr_t)dGeomGetData(geom); }

static ccd_warm_t warm[SCENE_BODIES][SCENE_BODIES];
static ccd_manifold_cache_t cache[SCENE_BODIES][SCENE_BODIES];
static unsigned long queries, supports, limits;

/* Distance of a corner from its face that still is a contact: the layer that ODE lets contacts
 * sink into. */
static const double SLOP = 1e-3;

static void aabb(dGeomID geom, dReal box[6])
{
    const shape_t s = shape_at(index_of(geom));
    for (int k = 0; k < 3; k++)
        for (int side = 0; side < 2; side++) {
            ccd_vec3_t dir = {{0, 0, 0}}, v;
            dir.v[k] = side ? 1 : -1;
            shape_support(&s, &dir, &v);
            box[2 * k + side] = v.v[k];
        }
}

/* The first body leaves along ODE's normal. */
static int collide(dGeomID o1, dGeomID o2, int flags, dContactGeom *out, int skip)
{
    const int i = index_of(o1), j = index_of(o2), low = i < j ? i : j, high = i < j ? j : i;
    const int room = flags & 0xffff, max = room < CONTACTS ? room : CONTACTS;
    shape_t a = shape_at(i), b = shape_at(j);
    ccd_contact_t contact[CONTACTS];
    ccd_penetration_t hit;
    int n = 1, written = 0;
    ccd_t ccd = shape_query();
    ccd.mpr_tolerance = 1e-6; /* as ODE's */
    /* One state for both orders of the pair. */
    if (i > j)
        ccdWarmFlip(&warm[low][high]);
    const int code = ccdPenetrationLocal(&a, &b, &ccd, &warm[low][high], max > 1 ? 0 : CCD_WANT_POS, &hit);
    if (i > j)
        ccdWarmFlip(&warm[low][high]);
    queries++;
    limits += code == CCD_LIMIT;
    if (code != CCD_HIT && code != CCD_LIMIT)
        return 0;
    contact[0].point1 = contact[0].point2 = hit.pos;
    contact[0].depth = hit.depth;
    if (max > 1)
        n = ccdContacts(&a, &b, &ccd, &hit.normal, SLOP, &cache[low][high], contact, max);
    supports += a.calls;
    for (int k = 0; k < n; k++) {
        dContactGeom *g = (dContactGeom *)((char *)out + written * skip);
        if (!(contact[k].depth >= 0))
            continue;
        for (int m = 0; m < 3; m++) {
            g->pos[m] = 0.5 * (contact[k].point1.v[m] + contact[k].point2.v[m]);
            g->normal[m] = -hit.normal.v[m];
        }
        g->depth = contact[k].depth;
        g->g1 = o1;
        g->g2 = o2;
        g->side1 = g->side2 = -1;
        written++;
    }
    return written;
}

static dColliderFn *collider(int other)
{
    (void)other;
    return collide;
}

static dGeomID make_geometry(const body_t *b)
{
    static int convex; /* the class */
    dGeomClass description = { 0, collider, aabb, NULL, NULL };
    (void)b;
    if (!convex)
        convex = dCreateGeomClass(&description);
    const dGeomID geom = dCreateGeom(convex);
    dSpaceAdd(scene.space, geom);
    return geom;
}

#else
static dGeomID make_geometry(const body_t *b) { return ode_geometry(scene.space, b); }
#endif

/* --- the scenes ---------------------------------------------------------------------- */

/* Adds a body whose shape is made; returns its index. */
static int scene_add_shape(void)
{
    const int i = scene.bodies++;
    scene.geom[i] = make_geometry(&scene.shape[i]);
    dGeomSetData(scene.geom[i], (void *)(intptr_t)i);
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
static void scene_nudge(double nudge)
{
    uniform_seed(scene.pile.seed);
    for (int i = 0; i < scene.bodies; i++)
        if (scene.body[i]) {
            double at[3];
            for (int j = 0; j < 3; j++)
                at[j] = dBodyGetPosition(scene.body[i])[j] + uniform(-nudge, nudge);
            dBodySetPosition(scene.body[i], at[0], at[1], at[2]);
        }
    dRandSetSeed(scene.pile.seed);
}

/* Bodies in layers above the floor of a pen, turned at random. */
static void scene_pile(int hulls)
{
    const double half_width = 0.55, pitch = 0.32, layer = 0.33;
    const int side = (int)((2 * half_width - 0.1) / pitch);
    scene_pen(half_width);
    for (int i = 0; i < scene.pile.bodies; i++) {
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
static void scene_towers(int one)
{
    scene_pen(0.8);
    for (int i = 0; i < scene.pile.bodies; i++) {
        const int b = scene_add(i % 2 || one ? SHAPE_POLYTOPE : SHAPE_BOX, 0.125, 0.125, 0.0625), level = one ? i : i % 5;
        scene_make_dynamic(b);
        const double x = one ? 0 : 0.4 * (i / 5 % 2) - 0.2, y = one ? 0 : 0.4 * (i / 10) - 0.2;
        dBodySetPosition(scene.body[b], x, y, 0.0625 + 0.125 * level);
    }
}

/* Cylinders that lie on a plate and roll, to and fro between the walls of a pen. The
 * plate is a hull: ODE collides a cylinder with a box without libccd. */
static void scene_roll(void)
{
    const double half_width = 1.5, quarter = 0.5 * 3.14159265358979323846;
    const int count = scene.pile.bodies;
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
        const dContactGeom *g = &contact[i].geom;
        const int is_valid = fabs(g->pos[0] + g->pos[1] + g->pos[2]) < 1e6;
        if (!pile_contact(&scene.pile, is_valid ? dCalcVectorLengthSquare3(g->normal) : NAN, g->depth))
            continue;
        contact[i].surface.mode = dContactApprox1;
        contact[i].surface.mu = 0.6;
        dJointAttach(dJointCreateContact(scene.world, scene.contacts, &contact[i]), b1, b2);
    }
}

/* Adds the energies of all bodies, and counts those that left the pen. */
static void scene_report_step(void)
{
    double kinetic = 0, potential = 0;
    for (int i = 0; i < scene.bodies; i++)
        if (scene.body[i]) {
            const dReal *v = dBodyGetLinearVel(scene.body[i]), *R = dBodyGetRotation(scene.body[i]);
            const dReal *w = dBodyGetAngularVel(scene.body[i]), *p = dBodyGetPosition(scene.body[i]);
            double local[3];
            dMass m;
            dBodyGetMass(scene.body[i], &m);
            for (int j = 0; j < 3; j++)
                local[j] = R[j] * w[0] + R[4 + j] * w[1] + R[8 + j] * w[2];
            kinetic += 0.5 * m.mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            for (int j = 0; j < 3; j++)
                for (int k = 0; k < 3; k++)
                    kinetic += 0.5 * local[j] * m.I[4 * j + k] * local[k];
            potential += 9.81 * m.mass * p[2];
            pile_body(&scene.pile, p, scene.half_width, 0);
        }
    pile_energy(&scene.pile, kinetic, potential);
}

int main(int argc, char **argv)
{
    scene.pile = pile_start(argc, argv, "pile|hulls|stack|roll|tower");
    dInitODE2(0);
    scene_world(11);
    const char *name = scene.pile.scene;
    if (!strcmp(name, "tower")) {
        scene_towers(1);
    } else if (!strcmp(name, "stack")) {
        scene_towers(0);
        scene_nudge(1e-5);
    } else if (!strcmp(name, "roll")) {
        scene_roll();
        scene_nudge(1e-5);
    } else {
        scene_pile(!strcmp(name, "hulls"));
        scene_nudge(1e-3);
    }
    for (; scene.pile.step < scene.pile.steps; scene.pile.step++) {
        dSpaceCollide(scene.space, NULL, scene_near);
        dWorldQuickStep(scene.world, 0.005);
        dJointGroupEmpty(scene.contacts);
        scene_report_step();
    }
    pile_report(&scene.pile);
#ifdef CONTACTS
    printf("own queries %lu supports %lu limits %lu\n", queries, supports, limits);
#endif
    dJointGroupDestroy(scene.contacts);
    dSpaceDestroy(scene.space);
    dWorldDestroy(scene.world);
    dCloseODE();
    return 0;
}
