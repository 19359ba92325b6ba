/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Replays the recorded contact sequence through this library's extension, with
 * one warm state for each pair of bodies, and cold for comparison.
 *
 * usage: warm RECORDING [PASSES] */

#define _POSIX_C_SOURCE 199309L
#include "record/replay.h"
#include "ours.h"

static ccd_warm_t *state;
static size_t states;

/* all zeros: cold */
static void forget(void)
{
    memset(state, 0, states * sizeof *state);
}

static int mpr(const recording_query_t *q, recording_answer_t *out)
{
    return OURS(ccdMPRPenetration)(q->obj1, q->obj2, q->ccd, &out->depth, &out->dir, &out->pos);
}

static int mpr_warm(const recording_query_t *q, recording_answer_t *out)
{
    return OURS(ccdMPRPenetrationWarm)(q->obj1, q->obj2, q->ccd, &state[q->pair], &out->depth, &out->dir, &out->pos);
}

/* For who moves bodies apart, or asks ccdContacts. */
static int mpr_bare(const recording_query_t *q, recording_answer_t *out)
{
    return OURS(ccdMPRPenetration)(q->obj1, q->obj2, q->ccd, &out->depth, &out->dir, NULL);
}

static int mpr_warm_bare(const recording_query_t *q, recording_answer_t *out)
{
    return OURS(ccdMPRPenetrationWarm)(q->obj1, q->obj2, q->ccd, &state[q->pair], &out->depth, &out->dir, NULL);
}

typedef int (*extended_fn)(const void *, const void *, const ccd_t *, ccd_warm_t *, unsigned, ccd_penetration_t *);

static int extended(extended_fn method, const recording_query_t *q, ccd_warm_t *warm, recording_answer_t *out)
{
    ccd_penetration_t p;
    const int code = method(q->obj1, q->obj2, q->ccd, warm, CCD_WANT_ALL, &p);
    if (code == CCD_HIT || code == CCD_LIMIT) {
        out->depth = p.depth;
        out->dir = p.dir;
        out->pos = p.pos;
        return 0;
    }
    return code;
}

static int local(const recording_query_t *q, recording_answer_t *out)
{
    return extended(OURS(ccdPenetrationLocal), q, NULL, out);
}

static int local_warm(const recording_query_t *q, recording_answer_t *out)
{
    return extended(OURS(ccdPenetrationLocal), q, &state[q->pair], out);
}

static int minimum(const recording_query_t *q, recording_answer_t *out)
{
    return extended(OURS(ccdPenetrationProven), q, NULL, out);
}

static int minimum_warm(const recording_query_t *q, recording_answer_t *out)
{
    return extended(OURS(ccdPenetrationProven), q, &state[q->pair], out);
}

int main(int argc, char **argv)
{
    static tally_t tally[] = {
        { .name = "MPR, cold", .method = mpr },         { .name = "MPR, warm", .method = mpr_warm },
        { .name = "no pos, cold", .method = mpr_bare }, { .name = "no pos, warm", .method = mpr_warm_bare },
        { .name = "local, cold", .method = local },     { .name = "local, warm", .method = local_warm },
        { .name = "minimum, cold", .method = minimum }, { .name = "minimum, warm", .method = minimum_warm },
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
