/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A run of one of the scenes pile, hulls, stack and roll (ode_pile.c says what they are):
 * its start, its steps, and what the second half of it looked like. */

#ifndef ODE_RUN_H
#define ODE_RUN_H

#include <math.h>
#include <stdio.h>
#include "swap/ode_scene.h"

typedef struct {
    double kinetic, depth; /* sums over the second half */
    double deepest, least, gained;
    long contacts;
    int escaped;
} run_t;

/* Makes the scene of that name, moved by the stream named seed. */
static inline void run_scene(scene_t *scene, const char *name, int bodies, unsigned long seed)
{
    const int stack = !strcmp(name, "stack"), roll = !strcmp(name, "roll");
    int i;
    scene_world(scene, 11);
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

static inline void run_step(run_t *run, scene_t *scene, long step, long steps)
{
    double height, moving, energy;
    scene_step(scene, 0.005);
    run->escaped |= scene_escaped(scene);
    run->deepest = fmax(run->deepest, scene->depth_max);
    moving = scene_energy(scene, &height);
    energy = moving + height;
    run->least = step ? fmin(run->least, energy) : energy;
    run->gained = fmax(run->gained, energy - run->least);
    if (2 * step >= steps) {
        run->kinetic += moving / (double)(steps - steps / 2);
        run->depth += scene->depth_sum;
        run->contacts += scene->contact_count;
    }
}

/* The line's start; the program adds what it counted. */
static inline void run_report(const run_t *run, const scene_t *scene)
{
    printf("pile kinetic %.9g depth %.9g deepest %.9g contacts %ld escaped %d bad %ld gained %.9g", run->kinetic,
           run->contacts ? run->depth / (double)run->contacts : 0, run->deepest, run->contacts, run->escaped,
           scene->bad_contacts, run->gained);
}

#endif
