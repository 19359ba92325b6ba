/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Cylinders that lie side by side and layer on layer, in exact rows, in ODE: each touches its neighbours without a gap. Prints
 * the steps that were made.
 * usage: ode_rows STEPS */

#include <math.h>
#include <ode/ode.h>
#include <stdio.h>
#include <stdlib.h>

static dWorldID world;
static dJointGroupID group;

static void collide(void *data, dGeomID a, dGeomID b)
{
    dContact contact[8];
    const int n = dCollide(a, b, 8, &contact[0].geom, sizeof *contact);
    (void)data;
    for (int i = 0; i < n; i++) {
        contact[i].surface.mode = 0;
        contact[i].surface.mu = 1;
        dJointAttach(dJointCreateContact(world, group, &contact[i]), dGeomGetBody(a), dGeomGetBody(b));
    }
}

int main(int argc, char **argv)
{
    const int steps = argc > 1 ? atoi(argv[1]) : 1;
    dInitODE2(0);
    world = dWorldCreate();
    group = dJointGroupCreate(0);
    const dSpaceID space = dHashSpaceCreate(0);
    dWorldSetGravity(world, 0, 0, -9.81);
    dCreateBox(space, 10, 10, 1);
    for (int i = 0; i < 4 * 4 * 3; i++) {
        const int x = i % 4, y = i / 4 % 4, layer = i / 16;
        const dGeomID geom = dCreateCylinder(space, 0.25, 0.5);
        const dBodyID body = dBodyCreate(world);
        dMatrix3 lying;
        dMass mass;
        dRFromAxisAndAngle(lying, 1, 0, 0, M_PI / 2);
        dMassSetCylinderTotal(&mass, 1, 3, 0.25, 0.5);
        dBodySetMass(body, &mass);
        dGeomSetBody(geom, body);
        dBodySetRotation(body, lying);
        dBodySetPosition(body, 0.5 * x, y, 0.75 + 0.5 * layer);
    }
    for (int i = 0; i < steps; i++) {
        dSpaceCollide(space, NULL, collide);
        dWorldQuickStep(world, 0.01);
        dJointGroupEmpty(group);
    }
    printf("%d steps\n", steps);
    dCloseODE();
}
