/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/*
 * Records a contact sequence: a pile of boxes, cylinders, capsules and convex
 * hulls falls and settles in ODE, and every pair that ODE's broad phase lets
 * through is written with the shapes and the poses. The file's format is in
 * README.md; the poses in it are floats, and the truth (certify.c) is about
 * those, not about the simulation's own doubles.
 *
 * usage: recorder FILE
 */
#include "swap/ode_scene.h"

enum { BODIES = 40, FRAMES = 360, STEPS_PER_FRAME = 2, MOST_PAIRS = 4096 };

static uint16_t pair[MOST_PAIRS][2];
static uint32_t pairs;

static void on_pair(void *user, int a, int b, const dContact *contact, int contacts)
{
    (void)user;
    (void)contact;
    (void)contacts;
    if (pairs == MOST_PAIRS) {
        fprintf(stderr, "too many pairs in one frame\n");
        exit(2);
    }
    pair[pairs][0] = (uint16_t)a;
    pair[pairs++][1] = (uint16_t)b;
}

static void put(FILE *f, const void *data, size_t bytes)
{
    if (fwrite(data, bytes, 1, f) != 1) {
        perror("write");
        exit(2);
    }
}

int main(int argc, char **argv)
{
    static scene_t scene;
    uint32_t head[4] = { 0, 0, FRAMES, 0 };
    int frame, i, step;
    FILE *f;
    if (argc != 2 || !(f = fopen(argv[1], "wb"))) {
        fprintf(stderr, "usage: recorder FILE\n");
        return 2;
    }
    dInitODE2(0);
    scene_world(&scene, 7);
    scene_pile(&scene, BODIES, 0.55, 1.2);
    scene_nudge(&scene, 1, 0);
    scene.on_pair = on_pair;
    head[0] = (uint32_t)scene.shapes;
    head[1] = (uint32_t)scene.bodies;
    put(f, "CCDREC01", 8);
    put(f, head, sizeof head);
    for (i = 0; i < scene.shapes; i++) {
        const scene_shape_t *s = &scene.shape[i];
        const uint32_t kind[2] = { (uint32_t)s->kind, (uint32_t)s->hull.vertices };
        put(f, kind, sizeof kind);
        put(f, s->p, sizeof s->p);
        if (s->hull.vertices)
            put(f, s->hull.vertex, 24 * (size_t)s->hull.vertices);
    }
    for (i = 0; i < scene.bodies; i++) {
        const uint32_t shape = (uint32_t)scene.shape_of[i];
        put(f, &shape, sizeof shape);
    }
    for (frame = 0; frame < FRAMES; frame++) {
        float pose[SCENE_BODIES][7];
        for (step = 1; step < STEPS_PER_FRAME; step++)
            scene_step(&scene, 0.005);
        for (i = 0; i < scene.bodies; i++) {
            const dReal *p = dGeomGetPosition(scene.geom[i]);
            dQuaternion q;
            int j;
            dGeomGetQuaternion(scene.geom[i], q);
            for (j = 0; j < 3; j++)
                pose[i][j] = (float)p[j];
            for (j = 0; j < 4; j++)
                pose[i][3 + j] = (float)q[(j + 1) % 4];
        }
        pairs = 0;
        scene_step(&scene, 0.005);
        put(f, &pairs, sizeof pairs);
        put(f, pose, 28 * (size_t)scene.bodies);
        if (pairs)
            put(f, pair, 4 * (size_t)pairs);
        head[3] += pairs;
        if (frame % 30 == 0)
            fprintf(stderr, "frame %d: %u pairs, kinetic energy %.3g J\n", frame, pairs, scene_energy(&scene, NULL));
    }
    fseek(f, 8, SEEK_SET);
    put(f, head, sizeof head);
    i = scene_escaped(&scene);
    scene_free(&scene);
    dCloseODE();
    if (fclose(f) || i || scene.pile.bad) {
        fprintf(stderr, "%d bodies escaped, %ld bad contacts\n", i, scene.pile.bad);
        return 1;
    }
    printf("%u shapes, %u bodies, %u frames, %u pairs\n", head[0], head[1], head[2], head[3]);
    return 0;
}
