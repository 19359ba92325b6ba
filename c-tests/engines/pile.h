/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Summarises the second half of a simulation in one line, for every engine. */

#ifndef ENGINES_PILE_H
#define ENGINES_PILE_H

#include <math.h>
#include <stdio.h>

typedef struct {
    long step, steps;
    double kinetic, depth; /* sums over the second half */
    double deepest, least, gained;
    long contacts, bad;
    int escaped;
} pile_t;

static inline pile_t pile_of(long steps)
{
    pile_t p = {0, 0, 0, 0, 0, HUGE_VAL, 0, 0, 0, 0};
    p.steps = steps;
    return p;
}

static inline int pile_is_late(const pile_t *p) { return 2 * p->step >= p->steps; }

/* Joules of motion, and of height above the floor. */
static inline void pile_energy(pile_t *p, double moving, double height)
{
    p->least = fmin(p->least, moving + height);
    p->gained = fmax(p->gained, moving + height - p->least);
    if (pile_is_late(p))
        p->kinetic += moving / (double)(p->steps - p->steps / 2);
}

/* A contact by the square of its normal's length and its depth; returns whether it is one. Negated so
 * that NaN counts as bad. */
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

/* The line's start; the program adds what it counted. */
static inline void pile_report(const pile_t *p)
{
    printf("pile kinetic %.9g depth %.9g deepest %.9g contacts %ld escaped %d bad %ld gained %.9g", p->kinetic,
           p->contacts ? p->depth / (double)p->contacts : 0, p->deepest, p->contacts, p->escaped, p->bad, p->gained);
}

#endif
