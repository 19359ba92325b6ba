/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Puts every pair of a recording to penetration methods and judges the answers
 * by the recording's truth; prints one line of text a method, 80 columns. Settings are those of the simulators: tolerance
 * 1e-6 m, at most 500 iterations. */

#ifndef RECORD_REPLAY_H
#define RECORD_REPLAY_H

#include "tools/record/recording.h"
#include "harness/verdict.h"

#include <time.h>

typedef struct {
    const shape_t *obj1, *obj2;
    const ccd_t *ccd;
    unsigned pair; /* a number of these two bodies' own, the same in every frame, below bodies * bodies */
} recording_query_t;

typedef struct {
    int code;
    ccd_real_t depth;
    ccd_vec3_t dir, pos;
} recording_answer_t;

/* how: the method's own. */
typedef int (*recording_method_fn)(const recording_query_t *, const void *how, recording_answer_t *);

typedef struct {
    const char *name;
    recording_method_fn method;
    const void *how;
    unsigned long queries, supports, judged;
    unsigned long wrong[VERDICTS];
    double error_sum, error_max; /* metres, of those judged: hits that are hits */
    unsigned long overlaps;
    double *frame[2];            /* nanoseconds of each frame, of its fastest pass: pairs apart, pairs that overlap */
} tally_t;

static const double REPLAY_TOLERANCE = 1e-6; /* metres */

/* Depths within this are neither hit nor miss: the bodies measure decimetres. */
static const double REPLAY_TOUCH = 1e-9;

/* One answer: hit or not, and where hit its depth and direction, against the truth. */
static inline void tally_add(tally_t *t, const recording_answer_t *answer, double lower, double upper)
{
    const verdict_truth_t truth = { lower, upper, REPLAY_TOLERANCE, REPLAY_TOUCH };
    const verdict_answer_t judged = { answer->code == 0, 1, (double)answer->depth, (double)ccdVec3Len2(&answer->dir) };
    const verdict_t v = verdict(&judged, &truth);
    t->queries++;
    t->wrong[v]++;
    if (verdict_has_error(&judged, v)) {
        const double error = verdict_error(&judged, &truth);
        t->error_sum += error;
        t->error_max = error > t->error_max ? error : t->error_max;
        t->judged++;
    }
}

static inline void tally_head(const recording_t *r)
{
    unsigned long overlaps = 0;
    for (size_t k = 0; k < r->pairs; k++) {
        double lower, upper;
        recording_truth(r, k, &lower, &upper);
        overlaps += lower > 0;
    }
    printf("%u bodies, %u frames, %u pairs, %lu of them overlap\n\n", (unsigned)r->bodies, (unsigned)r->frames, (unsigned)r->pairs,
           overlaps);
    printf("%-13s %6s %5s %6s %5s %7s %7s %6s %8s %5s %5s\n", "method", "missed", "false", "broken", "deep", "unsound", "mean um", "max um",
           "supports", "hit", "ns");
}

/* Nanoseconds of all frames, of the pairs apart (0) or of those that overlap (1). */
static inline double replay_time(const tally_t *t, uint32_t frames, int overlap)
{
    double sum = 0;
    for (uint32_t f = 0; f < frames; f++)
        sum += t->frame[overlap][f];
    return sum;
}

static inline void tally_print(const tally_t *t, uint32_t frames)
{
    const double judged = t->judged ? (double)t->judged : 1, queries = t->queries ? (double)t->queries : 1;
    const double overlaps = t->overlaps ? (double)t->overlaps : 1, hits = replay_time(t, frames, 1);
    printf("%-13s %6lu %5lu %6lu %5lu %7lu %7.3g %6.0f %8.2f %5.0f %5.0f\n", t->name, t->wrong[VERDICT_MISSED],
           t->wrong[VERDICT_SPURIOUS], t->wrong[VERDICT_BROKEN], t->wrong[VERDICT_DEEP], t->wrong[VERDICT_UNSOUND],
           1e6 * t->error_sum / judged, 1e6 * t->error_max, (double)t->supports / queries, hits / overlaps,
           (hits + replay_time(t, frames, 0)) / queries);
}

/* Of this process alone: another job's time on the processor is none of ours. */
static inline double replay_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e9 * (double)now.tv_sec + (double)now.tv_nsec;
}

/* Room for what a method is measured by. Returns 0, or -1 without memory. */
static inline int tally_begin(tally_t *t, const recording_t *r)
{
    for (int k = 0; k < 2 && !t->frame[k]; k++)
        if (!(t->frame[k] = (double *)calloc((size_t)r->frames + 1, sizeof *t->frame[k])))
            return -1;
    return 0;
}

/* Queries the pairs of a frame that overlap (or do not), which are all of its that truth says so
 * of, and keeps the time where it is the least so far. */
static inline void recording_frame(const recording_t *r, tally_t *t, uint32_t f, size_t first_pair, int overlap, const shape_t *body,
                                   const ccd_t *ccd, recording_answer_t *answer)
{
    double start = replay_clock();
    for (uint32_t i = 0; i < r->frame_pairs[f]; i++) {
        recording_query_t q;
        unsigned a, b;
        double lower, upper;
        recording_truth(r, first_pair + i, &lower, &upper);
        if ((lower > 0) != overlap)
            continue;
        recording_pair(r, f, i, &a, &b);
        q.obj1 = &body[a];
        q.obj2 = &body[b];
        q.ccd = ccd;
        q.pair = a * r->bodies + b;
        answer[i].code = t->method(&q, t->how, &answer[i]);
    }
    start = replay_clock() - start;
    if (t->frame[overlap][f] <= 0 || start < t->frame[overlap][f])
        t->frame[overlap][f] = start;
}

/* Queries every pair. The first pass is judged; of each frame the fastest one's time is kept.
 * Returns 0, or -1 without memory. */
static inline int recording_pass(const recording_t *r, tally_t *tally)
{
    const int first = tally->queries == 0;
    uint32_t most = 0;
    size_t k = 0;
    shape_t *body = (shape_t *)malloc(r->bodies * sizeof *body);
    recording_answer_t *answer;
    for (uint32_t f = 0; f < r->frames; f++)
        most = r->frame_pairs[f] > most ? r->frame_pairs[f] : most;
    answer = (recording_answer_t *)malloc(((size_t)most + 1) * sizeof *answer);
    ccd_t ccd = shape_query();
    ccd.mpr_tolerance = ccd.epa_tolerance = (ccd_real_t)REPLAY_TOLERANCE;
    ccd.max_iterations = 500;
    if (!body || !answer || tally_begin(tally, r) != 0) {
        free(body);
        free(answer);
        return -1;
    }
    for (uint32_t f = 0; f < r->frames; k += r->frame_pairs[f++]) {
        recording_place(r, f, body);
        recording_frame(r, tally, f, k, 1, body, &ccd, answer);
        recording_frame(r, tally, f, k, 0, body, &ccd, answer);
        for (uint32_t i = 0; first && i < r->frame_pairs[f]; i++) {
            double lower, upper;
            recording_truth(r, k + i, &lower, &upper);
            tally_add(tally, &answer[i], lower, upper);
            tally->overlaps += lower > 0;
        }
        for (uint32_t i = 0; first && i < r->bodies; i++)
            tally->supports += body[i].calls;
    }
    if (first)
        tally->supports /= 2; /* a support point of the difference takes a call of each shape */
    free(body);
    free(answer);
    return 0;
}

enum { REPLAY_SUPPORTS = 8 };

/* Calls both support functions in one direction after another, for their price alone. */
static inline int replay_supports(const recording_query_t *q, const void *how, recording_answer_t *out)
{
    for (int i = 0; i < REPLAY_SUPPORTS; i++) {
        ccd_vec3_t dir, back, point;
        ccdVec3Set(&dir, (ccd_real_t)(i & 1 ? .6 : -.6), (ccd_real_t)(i & 2 ? .48 : -.48), (ccd_real_t)(i & 4 ? .64 : -.64));
        ccdVec3Set(&back, -dir.v[0], -dir.v[1], -dir.v[2]);
        q->ccd->support1(q->obj1, &dir, &point);
        q->ccd->support2(q->obj2, &back, &point);
    }
    (void)how;
    (void)out;
    return -1;
}

/* Every method in turn, so that all of them meet the same moments of the machine;
 * forget, where not NULL, is called before each. Prints the table. Returns an exit
 * code: 0, or 1 without memory. */
static inline int recording_replay(const recording_t *r, tally_t *tally, size_t methods, int passes, void (*forget)(void))
{
    tally_t alone = { .name = "support points", .method = replay_supports };
    for (int pass = 0; pass < passes; pass++) {
        if (recording_pass(r, &alone) != 0)
            return 1;
        for (size_t m = 0; m < methods; m++) {
            if (forget)
                forget();
            if (recording_pass(r, &tally[m]) != 0)
                return 1;
        }
    }
    tally_head(r);
    for (size_t m = 0; m < methods; m++) {
        tally_print(&tally[m], r->frames);
        free(tally[m].frame[0]);
        free(tally[m].frame[1]);
    }
    printf("\na support point alone: %.1f ns\n",
           (replay_time(&alone, r->frames, 0) + replay_time(&alone, r->frames, 1)) / (double)alone.queries / REPLAY_SUPPORTS);
    free(alone.frame[0]);
    free(alone.frame[1]);
    return 0;
}

/* The command line of a replaying program: reads the recording, and how many passes (default 1). Returns 0, or -1 after saying the usage. */
static inline int replay_arguments(int argc, char **argv, recording_t *r, int *passes)
{
    *passes = argc == 3 ? atoi(argv[2]) : 1;
    if ((argc == 2 || argc == 3) && *passes > 0 && recording_read(argv[1], r) == 0)
        return 0;
    fprintf(stderr, "usage: %s RECORDING [PASSES] (a whole recording, with its truth)\n", argv[0]);
    return -1;
}

#endif
