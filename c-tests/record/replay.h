/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Puts every pair of a recording to a penetration method and judges the answers
 * by the recording's truth. Settings are those of the simulators: tolerance
 * 1e-6 m, at most 500 iterations. */

#ifndef RECORD_REPLAY_H
#define RECORD_REPLAY_H

#include "record/recording.h"

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

typedef int (*recording_method_fn)(const recording_query_t *, recording_answer_t *);

typedef struct {
    const char *name;
    unsigned long queries, hits, missed, spurious, deep, shallow, broken, supports;
    double error_sum, error_max;
    double *error; /* of each hit that is one, for the percentile */
    size_t errors;
    double nanoseconds;
} tally_t;

static const double REPLAY_TOLERANCE = 1e-6; /* metres */

/* Depths within this are neither hit nor miss: the bodies measure decimetres. */
static const double REPLAY_TOUCH = 1e-9;

static inline int tally_make(tally_t *t, const char *name, size_t pairs)
{
    memset(t, 0, sizeof *t);
    t->name = name;
    t->error = (double *)malloc((pairs + 1) * sizeof *t->error);
    return t->error ? 0 : -1;
}

/* One answer: hit or not, and where hit its depth and direction, against the truth. */
static inline void tally_add(tally_t *t, const recording_answer_t *answer, double lower, double upper)
{
    const double depth = (double)answer->depth;
    t->queries++;
    if (answer->code != 0) {
        t->missed += lower > REPLAY_TOUCH;
        return;
    }
    t->hits++;
    if (upper < -REPLAY_TOUCH) {
        t->spurious++;
        return;
    }
    /* negated: NaN is broken */
    if (!(fabs((double)ccdVec3Len2(&answer->dir) - 1) < 1e-6) || !(depth >= 0 && depth < HUGE_VAL)) {
        t->broken++;
        return;
    }
    {
        const double slack = 2 * REPLAY_TOLERANCE;
        const double error = depth > upper ? depth - upper : depth < lower ? lower - depth : 0;
        t->deep += depth > 1.01 * upper + slack;
        t->shallow += depth < lower - slack;
        t->error_sum += error;
        t->error_max = error > t->error_max ? error : t->error_max;
        t->error[t->errors++] = error;
    }
}

static inline int tally_order(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static inline void tally_head(void)
{
    printf("| method | queries | hits | misses | missed overlaps | spurious hits | NaN or zero dir | depth error mean, um | p99, um | max, um "
           "| > 1 %% too deep | unsound | supports a query | ns a query |\n"
           "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

/* Prints the table's row; the tally is finished with. */
static inline void tally_print(tally_t *t)
{
    const double hits = t->errors ? (double)t->errors : 1, queries = t->queries ? (double)t->queries : 1;
    qsort(t->error, t->errors, sizeof *t->error, tally_order);
    printf("| %s | %lu | %lu | %lu | %lu | %lu | %lu | %.3g | %.3g | %.3g | %.2f %% | %.2f %% | %.2f | %.0f |\n", t->name, t->queries,
           t->hits, t->queries - t->hits, t->missed, t->spurious, t->broken, 1e6 * t->error_sum / hits,
           t->errors ? 1e6 * t->error[(size_t)(0.99 * (double)(t->errors - 1))] : 0, 1e6 * t->error_max,
           100 * (double)t->deep / hits, 100 * (double)t->shallow / hits, (double)t->supports / queries, t->nanoseconds / queries);
    free(t->error);
}

static inline double replay_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e9 * (double)now.tv_sec + (double)now.tv_nsec;
}

/* One row of the table. Returns 0, or -1 without memory. */
static inline int recording_replay(const recording_t *r, const char *name, recording_method_fn method)
{
    ccd_t ccd;
    tally_t tally;
    uint32_t f, i, most = 0;
    size_t k = 0;
    shape_t *body = (shape_t *)malloc(r->bodies * sizeof *body);
    recording_answer_t *answer;
    for (f = 0; f < r->frames; f++)
        most = r->frame_pairs[f] > most ? r->frame_pairs[f] : most;
    answer = (recording_answer_t *)malloc(((size_t)most + 1) * sizeof *answer);
    shape_query(&ccd);
    ccd.mpr_tolerance = ccd.epa_tolerance = (ccd_real_t)REPLAY_TOLERANCE;
    ccd.max_iterations = 500;
    if (!body || !answer || tally_make(&tally, name, r->pairs) != 0) {
        free(body);
        free(answer);
        return -1;
    }
    for (f = 0; f < r->frames; f++) {
        double start;
        recording_place(r, f, body);
        start = replay_clock();
        for (i = 0; i < r->frame_pairs[f]; i++) {
            recording_query_t q;
            unsigned a, b;
            recording_pair(r, f, i, &a, &b);
            q.obj1 = &body[a];
            q.obj2 = &body[b];
            q.ccd = &ccd;
            q.pair = a * r->bodies + b;
            answer[i].code = method(&q, &answer[i]);
        }
        tally.nanoseconds += replay_clock() - start;
        for (i = 0; i < r->frame_pairs[f]; i++) {
            double lower, upper;
            recording_truth(r, k++, &lower, &upper);
            tally_add(&tally, &answer[i], lower, upper);
        }
        for (i = 0; i < r->bodies; i++)
            tally.supports += body[i].calls;
    }
    tally.supports /= 2; /* a support of the difference asks both shapes */
    tally_print(&tally);
    free(body);
    free(answer);
    return 0;
}

#endif
