/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Replays the recorded contact sequence through libccd's two penetration
 * methods and judges every answer against the certified truth.
 *
 * This program knows libccd alone: one binary, built against libccd's interface,
 * runs on whichever libccd.so.2 the dynamic linker finds.
 *
 * usage: replay RECORDING [PASSES] */

#define _POSIX_C_SOURCE 199309L
#include "tools/record/replay.h"

static int mpr(const recording_query_t *q, const void *how, recording_answer_t *out)
{
    (void)how;
    return ccdMPRPenetration(q->obj1, q->obj2, q->ccd, &out->depth, &out->dir, &out->pos);
}

static int gjk_epa(const recording_query_t *q, const void *how, recording_answer_t *out)
{
    (void)how;
    return ccdGJKPenetration(q->obj1, q->obj2, q->ccd, &out->depth, &out->dir, &out->pos);
}

int main(int argc, char **argv)
{
    static tally_t tally[] = { { .name = "MPR", .method = mpr }, { .name = "GJK + EPA", .method = gjk_epa } };
    recording_t r;
    int passes, failed;
    if (replay_arguments(argc, argv, &r, &passes) != 0)
        return 2;
    failed = recording_replay(&r, tally, sizeof tally / sizeof tally[0], passes, NULL);
    recording_free(&r);
    return failed;
}
