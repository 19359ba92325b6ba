/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Stores the states of pairs in C: a small hash table, to be copied. Bodies have indices; a pair is
 * queried with the lower index first, which is the order of its state. The world is one of boxes that
 * move on circles. */

#include <ccd/warm.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct {
    unsigned first, second;
    unsigned long frame; /* of the last query; 0: an empty slot */
    ccd_warm_t warm;
} slot_t;

typedef struct { /* all zeros: empty */
    slot_t *entry;
    size_t size, used; /* size: a power of two, at least 2 * used */
    unsigned long frame;
} states_t;

/* Returns the slot of a pair, or the empty one for it. */
static slot_t *find_slot(slot_t *entry, size_t size, unsigned first, unsigned second)
{
    size_t i = (first * 2654435761u ^ second * 2246822519u) >> 7;
    for (i &= size - 1; entry[i].frame; i = (i + 1) & (size - 1))
        if (entry[i].first == first && entry[i].second == second)
            break;
    return &entry[i];
}

/* Removes pairs without a query in this frame and the last, and resizes the table. */
static int resize(states_t *s)
{
    size_t remaining = 0, size = 64;
    slot_t *entry;
    for (size_t i = 0; i < s->size; i++)
        remaining += s->entry[i].frame && s->entry[i].frame + 1 >= s->frame;
    while (size < 4 * (remaining + 1))
        size *= 2;
    entry = calloc(size, sizeof *entry); /* zeros: empty slots, cold states */
    if (!entry)
        return 0;
    for (size_t i = 0; i < s->size; i++)
        if (s->entry[i].frame && s->entry[i].frame + 1 >= s->frame)
            *find_slot(entry, size, s->entry[i].first, s->entry[i].second) = s->entry[i];
    free(s->entry);
    s->entry = entry;
    s->size = size;
    s->used = remaining;
    return 1;
}

/* Returns the state of a pair, first < second, valid until the next call; cold where the pair is new.
 * NULL without memory, which is cold too. */
static ccd_warm_t *state_of(states_t *s, unsigned first, unsigned second)
{
    if (2 * (s->used + 1) > s->size && !resize(s))
        return NULL;
    slot_t *e = find_slot(s->entry, s->size, first, second);
    s->used += !e->frame;
    e->first = first;
    e->second = second;
    e->frame = s->frame;
    return &e->warm;
}

/* --- the world ---------------------------------------------------------------------- */

enum { BODIES = 60, FRAMES = 120 };
typedef struct { ccd_vec3_t pos, half; } body_t;
static unsigned long calls;

static void support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const body_t *b = obj;
    calls++;
    for (int i = 0; i < 3; i++)
        out->v[i] = b->pos.v[i] + (dir->v[i] < 0 ? -b->half.v[i] : b->half.v[i]);
}

static void center(const void *obj, ccd_vec3_t *out) { *out = ((const body_t *)obj)->pos; }

int main(void)
{
    static body_t body[BODIES];
    states_t states = {0};
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = center;
    for (states.frame = 1; states.frame <= FRAMES; states.frame++) {
        unsigned long pairs = 0, overlap = 0, cold = 0;
        calls = 0;
        for (unsigned i = 0; i < BODIES; i++) {
            const double turn = 0.7 * i + 0.0002 * (i % 9 + 1) * states.frame, radius = 0.5 + 0.4 * (i % 7);
            const double z = 0.05 * (i % 5);
            ccdVec3Set(&body[i].pos, (ccd_real_t)(radius * cos(turn)), (ccd_real_t)(radius * sin(turn)), (ccd_real_t)z);
            ccdVec3Set(&body[i].half, CCD_REAL(0.4), CCD_REAL(0.35), CCD_REAL(0.3));
        }
        for (unsigned i = 0; i < BODIES; i++)
            for (unsigned j = i + 1; j < BODIES; j++) {
                ccd_penetration_t hit;
                if (ccdVec3Dist2(&body[i].pos, &body[j].pos) > 1) /* a broad phase */
                    continue;
                pairs++;
                overlap += ccdPenetration(&body[i], &body[j], &ccd, state_of(&states, i, j), 0, &hit) >= 0;
                cold -= calls; /* the same without states */
                ccdPenetration(&body[i], &body[j], &ccd, NULL, 0, &hit);
                cold += calls;
            }
        if (states.frame % 20 == 0)
            printf("frame %lu: %lu pairs near, %lu overlap, %.1f callbacks a pair, %.1f without states, %lu slots\n",
                   states.frame, pairs, overlap, (double)(calls - cold) / (double)pairs, (double)cold / (double)pairs,
                   (unsigned long)states.size);
    }
    free(states.entry);
    return 0;
}
