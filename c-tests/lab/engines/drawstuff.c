/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The library drawstuff of ODE's demos without a window: makes DEMO_STEPS steps, and presses a key of DEMO_KEYS before each tenth.
 * (A C function that ignores its arguments may be called with any.) */

#include <stdlib.h>

typedef struct {
    int version;
    void (*start)(void);
    void (*step)(int pause);
    void (*command)(int key);
    void (*stop)(void);
} functions_t;

static int is_stopped;

void dsSimulationLoop(int argc, char **argv, int width, int height, const functions_t *demo)
{
    const char *keys = getenv("DEMO_KEYS"), *steps = getenv("DEMO_STEPS");
    (void)argc;
    (void)argv;
    (void)width;
    (void)height;
    demo->start();
    for (int i = 1; i <= (steps ? atoi(steps) : 0) && !is_stopped; i++) {
        if (keys && *keys && demo->command && i % 10 == 0)
            demo->command(*keys++);
        demo->step(0);
    }
    if (demo->stop)
        demo->stop();
}

void dsStop(void) { is_stopped = 1; }
double dsElapsedTime(void) { return 0.01; }
void dsGetViewpoint(float at[3], float angles[3])
{
    for (int i = 0; i < 3; i++)
        at[i] = angles[i] = 0;
}

#define DRAWS_NOTHING(name) \
    void name(void) {}
DRAWS_NOTHING(dsError) DRAWS_NOTHING(dsDebug) DRAWS_NOTHING(dsPrint) DRAWS_NOTHING(dsSetViewpoint)
DRAWS_NOTHING(dsSetTexture) DRAWS_NOTHING(dsSetColor) DRAWS_NOTHING(dsSetColorAlpha) DRAWS_NOTHING(dsSetDrawMode)
DRAWS_NOTHING(dsSetSphereQuality) DRAWS_NOTHING(dsSetCapsuleQuality)
DRAWS_NOTHING(dsDrawBox) DRAWS_NOTHING(dsDrawSphere) DRAWS_NOTHING(dsDrawTriangle) DRAWS_NOTHING(dsDrawTriangles)
DRAWS_NOTHING(dsDrawCylinder) DRAWS_NOTHING(dsDrawCapsule) DRAWS_NOTHING(dsDrawLine) DRAWS_NOTHING(dsDrawConvex)
DRAWS_NOTHING(dsDrawBoxD) DRAWS_NOTHING(dsDrawSphereD) DRAWS_NOTHING(dsDrawTriangleD) DRAWS_NOTHING(dsDrawTrianglesD)
DRAWS_NOTHING(dsDrawCylinderD) DRAWS_NOTHING(dsDrawCapsuleD) DRAWS_NOTHING(dsDrawLineD) DRAWS_NOTHING(dsDrawConvexD)
