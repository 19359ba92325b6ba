/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A pile in ODE: bodies fall into a pen and come to rest, from a start that is
 * moved by up to 1e-3 m a coordinate, by a stream named SEED.
 * Prints what the second half of the run looked like.
 *
 * usage: ode_pile SEED STEPS BODIES */

#include "swap/ode_scene.h"
#include "swap/watch.h"

int main(int argc, char **argv)
{
    static scene_t scene;
    double kinetic = 0, depth = 0, deepest = 0;
    long step, contacts = 0, bad = 0;
    int escaped = 0;
    if (argc != 4) {
        fprintf(stderr, "usage: ode_pile SEED STEPS BODIES\n");
        return 2;
    }
    const long steps = atol(argv[2]);
    dInitODE2(0);
    watch_library();
    scene_world(&scene, 11);
    scene_pile(&scene, atoi(argv[3]), 0.55, 0.33, strtoul(argv[1], NULL, 10), 1e-3);
    for (step = 0; step < steps; step++) {
        scene_step(&scene, 0.005);
        escaped |= scene_escaped(&scene);
        deepest = fmax(deepest, scene.depth_max);
        if (2 * step >= steps) {
            kinetic += scene_energy(&scene, NULL) / (steps - steps / 2);
            depth += scene.depth_sum;
            contacts += scene.contact_count;
        }
    }
    bad = scene.bad_contacts;
    printf("pile kinetic %.9g depth %.9g deepest %.9g contacts %ld escaped %d bad %ld\n", kinetic,
           contacts ? depth / (double)contacts : 0, deepest, contacts, escaped, bad);
    watch_report();
    scene_free(&scene);
    dCloseODE();
    return 0;
}
