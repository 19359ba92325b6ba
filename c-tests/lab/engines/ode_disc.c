/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Discs of three heights that rock on a floor for 10 s in ODE, from six leans and three spins each, by one contact: once at the
 * position that the library returns, once at the center of pressure of the round face, a sum over strips. By that one a disc rocks
 * on as well, slower and slower, for one contact holds no moment. Prints how much the position adds:
 *
 *   disc runs N rocking SPEED off MEAN worst MOST   SPEED: the mean rotation at the end by the center of pressure, rad/s;
 *                                                   MEAN, MOST: of how much the nine groups' means by the library differ
 *
 * usage: ode_disc */

#include "harness/identity.h"

#include <math.h>
#include <ode/ode.h>

static const double RADIUS = 0.125, LEAN = 0.05, STEP = 0.001;
enum { HEIGHTS = 3, SPINS = 3, STARTS = 6, STEPS = 10000 };

typedef struct {
    dWorldID world;
    dJointGroupID contacts;
    dGeomID disc;
    double half_height;
    int is_exact;
} scene_t;

/* Moves a contact of the disc with the floor to the center of pressure of its round face. */
static void center_of_pressure(const scene_t *scene, dContactGeom *contact)
{
    enum { STRIPS = 2000 };
    const dReal *at = dGeomGetPosition(scene->disc), *rotation = dGeomGetRotation(scene->disc);
    const double up = copysign(1, rotation[10]), x = up * rotation[2], y = up * rotation[6], z = up * rotation[10];
    const double sine = hypot(x, y), depth = RADIUS * sine + scene->half_height * z - at[2];
    double volume = 0, moment = 0;
    for (int i = 0; i < STRIPS; i++) {
        const double along = RADIUS * (2 * (i + 0.5) / STRIPS - 1), below = fmax(depth - (RADIUS - along) * sine, 0);
        const double part = below * sqrt(RADIUS * RADIUS - along * along);
        volume += part;
        moment += part * along;
    }
    /* The axis leans to where the face is lowest. */
    const double far = sine > 0 ? (volume > 0 ? moment / volume : RADIUS) * z / sine : 0;
    contact->pos[0] = at[0] + x * (far - scene->half_height);
    contact->pos[1] = at[1] + y * (far - scene->half_height);
}

static void collide(void *data, dGeomID a, dGeomID b)
{
    const scene_t *scene = (const scene_t *)data;
    dContact contact;
    memset(&contact, 0, sizeof contact);
    if (dCollide(a, b, 1, &contact.geom, sizeof contact) < 1)
        return;
    if (scene->is_exact)
        center_of_pressure(scene, &contact.geom);
    contact.surface.mode = dContactApprox1;
    contact.surface.mu = 0.5;
    dJointAttach(dJointCreateContact(scene->world, scene->contacts, &contact), dGeomGetBody(a), dGeomGetBody(b));
}

/* Makes a floor of 8 m whose top is z = 0, convex: ODE itself collides a cylinder with its box. */
static void make_floor(dSpaceID space)
{
    static double planes[] = {1, 0, 0, 4, -1, 0, 0, 4, 0, 1, 0, 4, 0, -1, 0, 4, 0, 0, 1, 0.5, 0, 0, -1, 0.5}, points[24];
    static unsigned sides[] = {4, 1, 3, 7, 5, 4, 0, 4, 6, 2, 4, 2, 6, 7, 3, 4, 0, 1, 5, 4, 4, 4, 5, 7, 6, 4, 0, 2, 3, 1};
    for (int i = 0; i < 24; i++)
        points[i] = (i / 3 >> i % 3 & 1 ? 1 : -1) * (i % 3 < 2 ? 4 : 0.5);
    dGeomSetPosition(dCreateConvex(space, planes, 6, points, 8, sides), 0, 0, -0.5);
}

/* Returns how fast a disc rotates at the end, rad/s. */
static double rotation_at_end(double half_height, double spin, int start, int is_exact)
{
    scene_t scene = {dWorldCreate(), dJointGroupCreate(0), NULL, half_height, is_exact};
    const dSpaceID space = dSimpleSpaceCreate(0);
    const dBodyID body = dBodyCreate(scene.world);
    dMatrix3 leaning;
    dMass mass;
    dWorldSetGravity(scene.world, 0, 0, -9.81);
    make_floor(space);
    scene.disc = dCreateCylinder(space, RADIUS, 2 * half_height);
    dMassSetCylinderTotal(&mass, 1, 3, RADIUS, 2 * half_height);
    dBodySetMass(body, &mass);
    dGeomSetBody(scene.disc, body);
    dRFromAxisAndAngle(leaning, cos(1.1 * start), sin(1.1 * start), 0, LEAN);
    dBodySetRotation(body, leaning);
    dBodySetPosition(body, 0.1 * start, 0.05 * start, half_height * cos(LEAN) + RADIUS * sin(LEAN) + 1e-4);
    dBodySetAngularVel(body, 0, 0, spin);
    for (int i = 0; i < STEPS; i++) {
        dSpaceCollide(space, &scene, collide);
        dWorldStep(scene.world, STEP);
        dJointGroupEmpty(scene.contacts);
    }
    const dReal *w = dBodyGetAngularVel(body);
    const double rotation = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    dSpaceDestroy(space);
    dJointGroupDestroy(scene.contacts);
    dWorldDestroy(scene.world);
    return rotation;
}

int main(void)
{
    static const double half_heights[HEIGHTS] = {0.1, 0.02, 0.005}, spins[SPINS] = {0, 3, 10};
    double rocking = 0, off = 0, worst = 0;
    print_library();
    dInitODE2(0);
    for (int group = 0; group < HEIGHTS * SPINS; group++) {
        double mean[2] = {0, 0};
        for (int run = 0; run < 2 * STARTS; run++)
            mean[run % 2] += rotation_at_end(half_heights[group / SPINS], spins[group % SPINS], run / 2, run % 2) / STARTS;
        printf("group height %g spin %g rotation %.3f exact %.3f\n", 2 * half_heights[group / SPINS], spins[group % SPINS], mean[0], mean[1]);
        rocking += mean[1] / (HEIGHTS * SPINS);
        off += fabs(mean[0] - mean[1]) / (HEIGHTS * SPINS);
        worst = fmax(worst, fabs(mean[0] - mean[1]));
    }
    printf("disc runs %d rocking %.4f off %.4f worst %.4f\n", HEIGHTS * SPINS * STARTS, rocking, off, worst);
    dCloseODE();
    return 0;
}
