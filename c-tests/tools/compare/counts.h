/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Counters of all processes of a run. They lie in a file that each maps, so that they survive
 * any end of a process; every field is counted by atomic additions, so that threads,
 * children and other programs may count at once. Lengths are in picometres, times in
 * nanoseconds: whole numbers, whose sum depends on no order. */

#ifndef COMPARE_COUNTS_H
#define COMPARE_COUNTS_H

#include "harness/this_library.h"
#include "harness/verdict.h"

#include <ccd/ccd.h>
#include <stdint.h>

enum { COMPARE_THEIRS, COMPARE_OURS, COMPARE_SIDES };

/* One library on the judged queries of one call. */
typedef struct {
    uint64_t verdict[VERDICTS];
    uint64_t hits, calls; /* of support functions: two are a support point */
    uint64_t slanted; /* hits whose direction is not the normal of a plane that separates the objects after the move */
    uint64_t aside;   /* of these, counted as unsound: the depth would be enough along another direction */
    uint64_t nanoseconds; /* of `timed` queries */
    uint64_t with_error, error_sum, error_max;
} compare_side_t;

typedef struct {
    uint64_t queries, returned, hits; /* of the program; an exception or a jump left the others */
    uint64_t broken; /* hits of the program with a direction that is not unit, or a number that is not finite */
    uint64_t sampled, judged, overlaps, timed;
    /* reasons why sampled queries were not judged; memory: answered differently when repeated */
    uint64_t threw, endless, memory, no_shape;
    uint64_t uncertain; /* an answer is right only within the error of callbacks that contradict each other */
    uint64_t contradicted; /* a proven lower bound above a support value: this library's fault */
    compare_side_t side[COMPARE_SIDES];
} compare_call_t;

static const char *const COMPARE_SIDE_NAME[COMPARE_SIDES] = { "libccd", "warmccd" };

/* Cases written: the worst of each wrong verdict of each library. */
#define CASE_PATH "%s/%s-%s.txt"
static const char *const CASE_NAME[VERDICTS] = { "right", "missed", "false", "broken", "deep", "unsound" };
typedef struct {
    uint64_t used;
    double score; /* the error, metres a metre of the smaller object */
    char title[192];
} saved_case_t;

typedef struct {
    uint64_t processes;
    char program[256]; /* of the first */
    char theirs[512], ours[512]; /* the libraries */
    uint64_t base;               /* whose answers the program gets */
    compare_call_t call[LIBCCD_CALL_COUNT];
    uint64_t raw_supports; /* __ccdSupport, which FCL's own GJK calls */
    uint64_t process_nanoseconds, judge_nanoseconds; /* processor time of all, and of it the tool's */
    uint64_t saving; /* a lock */
    saved_case_t saved[COMPARE_SIDES][VERDICTS];
} compare_counts_t;

#endif
