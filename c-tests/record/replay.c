/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Replays the recorded contact sequence through libccd's two penetration
 * methods and judges every answer against the certified truth.
 *
 * This program knows libccd alone: one binary, built against libccd's interface,
 * runs on whichever libccd.so.2 the dynamic linker finds.
 *
 * usage: replay RECORDING */

#define _POSIX_C_SOURCE 199309L
#include "record/replay.h"

static int mpr(const recording_query_t *q, recording_answer_t *out)
{
    return ccdMPRPenetration(q->obj1, q->obj2, q->ccd, &out->depth, &out->dir, &out->pos);
}

static int gjk_epa(const recording_query_t *q, recording_answer_t *out)
{
    return ccdGJKPenetration(q->obj1, q->obj2, q->ccd, &out->depth, &out->dir, &out->pos);
}

int main(int argc, char **argv)
{
    recording_t r;
    int bad;
    if (argc != 2 || recording_read(argv[1], &r) != 0 || !r.truth_at) {
        fprintf(stderr, "usage: replay RECORDING (a whole one, with its truth)\n");
        return 2;
    }
    printf("%u frames, %u bodies, %u pairs\n\n", (unsigned)r.frames, (unsigned)r.bodies, (unsigned)r.pairs);
    tally_head();
    bad = recording_replay(&r, "MPR", mpr) != 0 || recording_replay(&r, "GJK + EPA", gjk_epa) != 0;
    recording_free(&r);
    return bad;
}
