/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Replays the recorded contact sequence through this library's extension, with
 * one warm state for each pair of bodies, and cold for comparison.
 *
 * usage: warm RECORDING */

#define _POSIX_C_SOURCE 199309L
#include "record/replay.h"
#include "ours.h"

static ccd_warm_t *state;

static int mpr(const recording_query_t *q, recording_answer_t *out)
{
    return OURS(ccdMPRPenetration)(q->obj1, q->obj2, q->ccd, &out->depth, &out->dir, &out->pos);
}

static int mpr_warm(const recording_query_t *q, recording_answer_t *out)
{
    return OURS(ccdMPRPenetrationWarm)(q->obj1, q->obj2, q->ccd, &state[q->pair], &out->depth, &out->dir, &out->pos);
}

typedef int (*extended_fn)(const void *, const void *, const ccd_t *, ccd_warm_t *, ccd_penetration_t *);

static int extended(extended_fn method, const recording_query_t *q, ccd_warm_t *warm, recording_answer_t *out)
{
    ccd_penetration_t p;
    const int code = method(q->obj1, q->obj2, q->ccd, warm, &p);
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
    return extended(OURS(ccdPenetrationMinimum), q, NULL, out);
}

static int minimum_warm(const recording_query_t *q, recording_answer_t *out)
{
    return extended(OURS(ccdPenetrationMinimum), q, &state[q->pair], out);
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        recording_method_fn method;
    } row[] = {
        { "MPR, cold", mpr },         { "MPR, warm", mpr_warm },         { "local, cold", local },
        { "local, warm", local_warm }, { "minimum, cold", minimum }, { "minimum, warm", minimum_warm },
    };
    recording_t r;
    size_t i;
    int bad = 0;
    if (argc != 2 || recording_read(argv[1], &r) != 0 || !r.truth_at) {
        fprintf(stderr, "usage: warm RECORDING (a whole one, with its truth)\n");
        return 2;
    }
    printf("%s: %u frames, %u bodies, %u pairs\n\n", OURS(ccdImplementation)(), (unsigned)r.frames, (unsigned)r.bodies,
           (unsigned)r.pairs);
    tally_head();
    for (i = 0; i < sizeof row / sizeof row[0] && !bad; i++) {
        /* all zeros: cold */
        state = (ccd_warm_t *)calloc((size_t)r.bodies * r.bodies, sizeof *state);
        bad = !state || recording_replay(&r, row[i].name, row[i].method) != 0;
        free(state);
    }
    recording_free(&r);
    return bad;
}
