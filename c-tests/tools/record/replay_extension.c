/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Replays the recorded contact sequence through this library's extension, with
 * one warm state for each pair of bodies, and cold for comparison.
 *
 * usage: replay_extension RECORDING [PASSES] */

#define _POSIX_C_SOURCE 199309L
#include "tools/record/replay.h"
#include "harness/this_library.h"

static ccd_warm_t *state;
static size_t states;

/* all zeros: cold */
static void forget(void)
{
    memset(state, 0, states * sizeof *state);
}

typedef struct {
    int ask; /* of call_by_number */
    int warm, pos;
} how_t;

static int asked(const recording_query_t *q, const void *how, recording_answer_t *out)
{
    const how_t *h = (const how_t *)how;
    ccd_penetration_t p;
    call_rest_t rest = {.want = CCD_WANT_ALL, .depth = &out->depth, .dir = &out->dir, .full = &p};
    rest.warm = h->warm ? &state[q->pair] : NULL;
    rest.pos = h->pos ? &out->pos : NULL;
    int code = call_by_number(h->ask, q->obj1, q->obj2, q->ccd, &rest);
    if (h->ask == CALL_MPR || h->ask == CALL_MPR_WARM || (code != CCD_HIT && code != CCD_LIMIT))
        return code;
    out->depth = p.depth;
    out->dir = p.dir;
    out->pos = p.pos;
    return 0;
}

int main(int argc, char **argv)
{
    /* without pos: for who moves bodies apart, or asks ccdContacts */
    static const how_t how[] = {{CALL_MPR, 0, 1}, {CALL_MPR_WARM, 1, 1}, {CALL_MPR, 0, 0}, {CALL_MPR_WARM, 1, 0},
                                {CALL_LOCAL, 0, 1}, {CALL_LOCAL, 1, 1}, {CALL_PROVEN, 0, 1}, {CALL_PROVEN, 1, 1}};
    static tally_t tally[] = {
        {"MPR, cold", asked, &how[0]}, {"MPR, warm", asked, &how[1]}, {"no pos, cold", asked, &how[2]},
        {"no pos, warm", asked, &how[3]}, {"local, cold", asked, &how[4]}, {"local, warm", asked, &how[5]},
        {"minimum, cold", asked, &how[6]}, {"minimum, warm", asked, &how[7]},
    };
    recording_t r;
    int passes, failed = 1;
    if (replay_arguments(argc, argv, &r, &passes) != 0)
        return 2;
    states = (size_t)r.bodies * r.bodies;
    state = (ccd_warm_t *)malloc(states * sizeof *state);
    if (state)
        failed = recording_replay(&r, tally, sizeof tally / sizeof tally[0], passes, forget);
    free(state);
    recording_free(&r);
    return failed;
}
