/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A simulation of falling bodies, for every engine: its arguments, its start, and a summary of its second
 * half in one line. */

#ifndef ENGINES_PILE_H
#define ENGINES_PILE_H

#include "harness/identity.h"
#include "harness/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

typedef struct {
    unsigned long seed;
    long step, steps;
    int bodies;
    const char *scene;
    double kinetic, depth; /* sums over the second half */
    double deepest, least, gained;
    long contacts, bad;
    int escaped;
} pile_t;

/* Reads the arguments SEED STEPS BODIES SCENE and prints the library. */
static inline pile_t pile_start(int argc, char **argv, const char *scenes)
{
    pile_t p = {0, 0, 0, 0, NULL, 0, 0, 0, HUGE_VAL, 0, 0, 0, 0};
    if (argc != 5) {
        fprintf(stderr, "usage: %s SEED STEPS BODIES %s\n", argv[0], scenes);
        exit(2);
    }
    p.seed = strtoul(argv[1], NULL, 10);
    p.steps = atol(argv[2]);
    p.bodies = atoi(argv[3]);
    p.scene = argv[4];
    print_library();
    return p;
}

/* Computes the start of body i: three by three in a layer, 0.34 apart. */
static inline void pile_place(int i, double lowest, double at[3])
{
    at[1] = 0.34 * (i / 3 % 3 - 1) + uniform(-.02, .02);
    at[0] = 0.34 * (i % 3 - 1) + uniform(-.02, .02);
    at[2] = lowest + 0.33 * (i / 9);
}

/* Counts a body outside the pen, whose floor is at `floor`, or whose position is not a number. */
static inline void pile_body(pile_t *p, const double at[3], double half_width, double floor)
{
    p->escaped |= !(fabs(at[0]) < half_width && fabs(at[1]) < half_width && at[2] > floor && at[2] < 20);
}

static inline int pile_is_late(const pile_t *p) { return 2 * p->step >= p->steps; }

/* Adds a step's kinetic and potential energy, joules. */
static inline void pile_energy(pile_t *p, double kinetic, double potential)
{
    p->least = fmin(p->least, kinetic + potential);
    p->gained = fmax(p->gained, kinetic + potential - p->least);
    if (pile_is_late(p))
        p->kinetic += kinetic / (double)(p->steps - p->steps / 2);
}

/* Adds a contact, given the square of its normal's length and its depth; returns whether they are valid.
 * Negated so that NaN is not. */
static inline int pile_contact(pile_t *p, double length2, double depth)
{
    if (!(fabs(length2 - 1) < 1e-6) || !(fabs(depth) < 1e3)) {
        p->bad++;
        return 0;
    }
    p->deepest = fmax(p->deepest, depth);
    if (pile_is_late(p)) {
        p->depth += depth;
        p->contacts++;
    }
    return 1;
}

static inline void pile_report(const pile_t *p)
{
    printf("pile kinetic %.9g depth %.9g deepest %.9g contacts %ld escaped %d bad %ld gained %.9g\n", p->kinetic,
           p->contacts ? p->depth / (double)p->contacts : 0, p->deepest, p->contacts, p->escaped, p->bad, p->gained);
    printf("processor seconds %.6f\n", (double)clock() / CLOCKS_PER_SEC);
}

#endif
