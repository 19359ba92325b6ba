/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* One query of the program's, put to libccd, to this library and to the proven minimum, and
 * judged; what is found is added to the counts. */

#ifndef COMPARE_JUDGE_QUERY_H
#define COMPARE_JUDGE_QUERY_H

#include "tools/compare/query.h"
#include "tools/compare/catch.h"

#include <time.h>

typedef struct {
    compare_counts_t *counts;
    library_t library[COMPARE_SIDES];
    int base;         /* whose answer the program got */
    int timed;        /* whether times are taken */
    const char *keep; /* where wrong answers are kept; NULL: nowhere */
    const char *case_source; /* what a kept case ends with */
} compare_t;

/* How a judged query went, for whoever keeps it. */
typedef struct {
    const query_t *q;
    seen_t *seen;
    verdict_truth_t truth;
    ccd_vec3_t truth_dir; /* of the upper bound */
    double size;          /* of the smaller object */
    answer_t answer[COMPARE_SIDES];
    verdict_t verdict[COMPARE_SIDES];
    int slanted[COMPARE_SIDES], aside[COMPARE_SIDES]; /* as counted: counts.h */
    asked_t asked[COMPARE_SIDES];
    uint64_t minimum_calls;
} sample_t;

/* Calls of the callbacks that a query may make before it counts as endless: a hundred times
 * what either library needs on shapes that are hard. */
enum { ENDLESS = 100000 };

/* own: what the program got; fields that it did not ask for are NaN. */
void sample_query(const compare_t *compare, const query_t *q, const answer_t *own);

/* Puts a query to a library, through wrappers, and stays with the tool whatever the callbacks do. */
guard_t sample_ask(const library_t *library, const query_t *q, seen_t *seen, asked_t *asked, answer_t *answer);

/* Bounds on the signed depth. Returns 0, or -1 where callbacks left or did not end. */
int sample_truth(const library_t *ours, const query_t *q, seen_t *seen, sample_t *s, uint64_t *calls);

verdict_t sample_verdict(const query_t *q, const answer_t *answer, const verdict_truth_t *truth);

/* A hit by a call that answers how deep. */
int sample_has_depth(const query_t *q, const answer_t *a);

/* write_case.c: keeps the answer of one library as a C file, where it is among its worst and its file
 * shows it again. */
void keep_case(const compare_t *compare, const sample_t *s, int side);

void seen_clear(seen_t *seen);

/* Nanoseconds. */
uint64_t clock_now(clockid_t id);

/* Atomic; n of the counts' own unit. */
void count_add(uint64_t *to, uint64_t n);

#endif
