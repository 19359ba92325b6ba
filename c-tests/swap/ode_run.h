/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A run of one of the scenes pile, hulls, stack and roll (ode_pile.c says what they are):
 * its start and its steps. */

#ifndef ODE_RUN_H
#define ODE_RUN_H

#include "swap/ode_scene.h"

/* Makes the scene of that name, moved by the stream named seed. */
static inline void run_scene(scene_t *scene, const char *name, int bodies, unsigned long seed, long steps)
{
    const int stack = !strcmp(name, "stack"), roll = !strcmp(name, "roll");
    int i;
    scene_world(scene, 11);
    scene->pile = pile_of(steps);
    if (!strcmp(name, "tower")) {
        scene_tower(scene, bodies);
        return;
    }
    if (stack) {
        scene_stack(scene, (bodies + 4) / 5, 0.8);
    } else if (roll) {
        scene_roll(scene, bodies, 1.5);
    } else {
        for (i = 0; i < 4 && !strcmp(name, "hulls"); i++)
            scene->kinds[i] = SCENE_HULL;
        scene_pile(scene, bodies, 0.55, 0.33);
    }
    scene_nudge(scene, seed, stack || roll ? 1e-5 : 1e-3);
}

static inline void run_step(scene_t *scene, long step)
{
    double height, moving;
    scene->pile.step = step;
    scene_step(scene, 0.005);
    scene->pile.escaped |= scene_escaped(scene);
    moving = scene_energy(scene, &height);
    pile_energy(&scene->pile, moving, height);
}

#endif
