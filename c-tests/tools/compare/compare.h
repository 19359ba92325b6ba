/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A query of the program's, a request of it to a library through callbacks that record what the program's
 * own return, and its judgement.
 *
 * The libraries pass the object pointers through and never read them, so all state of a request
 * lies behind those pointers, on the caller's stack: nothing is thread-local, and nothing
 * has to be released when a callback does not return. */

#ifndef COMPARE_COMPARE_H
#define COMPARE_COMPARE_H

#include "tools/compare/counts.h"
#include "tools/compare/guard.h"

#include <time.h>

typedef struct {
    int call; /* of libccd's, by number */
    const void *obj[2];
    const ccd_t *ccd;
} query_t;

/* dir and depth of ccdGJKSeparate are its vector's. */
typedef struct {
    int code, hit;
    ccd_real_t depth;
    ccd_vec3_t dir, pos;
} answer_t;

typedef struct _ccd_support_t ccd_support_t;
typedef void (*raw_support_fn)(const void *, const void *, const ccd_vec3_t *, const ccd_t *, ccd_support_t *);
typedef int (*proven_fn)(const void *, const void *, const ccd_t *, ccd_warm_t *, unsigned, ccd_penetration_t *);

typedef struct {
    void (*call[LIBCCD_CALL_COUNT])(void); /* by number, each of its own type */
    raw_support_fn raw_support;
    proven_fn proven;                   /* NULL in libccd */
    const char *(*implementation)(void); /* likewise */
} library_t;

/* Opens a library, this one or libccd; returns 0, or -1 after a line on stderr. */
int library_open(library_t *library, const char *path, int is_ours);

/* Looks a function up; returns 0, or -1 where there is none. */
int find_symbol(void *handle, const char *name, void *function);

/* Calls a function of libccd's by its number. */
int library_call(const library_t *library, int call, const void *a, const void *b, const ccd_t *ccd, const call_args_t *x);

/* Puts the program's query to a library: its own callbacks and objects. */
void query_library(const library_t *library, const query_t *q, answer_t *out);

/* Makes depth and direction of the vector that ccdGJKSeparate returns. */
void answer_by_length(answer_t *out);

verdict_t answer_verdict(const query_t *q, const answer_t *answer, const verdict_truth_t *truth);

static inline int is_hit(int call, int code) { return code == call_table[call].hit; }

/* Returns whether the call returns yes or no alone. */
static inline int is_intersect(int call) { return call_table[call].kind == KIND_BOOLEAN; }

/* Returns the tolerance that the call reads, metres; CCD_INIT's where it is invalid. */
double query_tolerance(const query_t *q);

/* --- requests ------------------------------------------------------------------------- */

/* Support samples of each object from the requests of one query, and the least support
 * value of the difference, which is an upper bound of the depth. */
enum { MAX_SAMPLES = 1024 };
typedef struct {
    ccd_vec3_t dir, point;
} support_sample_t;

typedef struct {
    support_sample_t sample[2][MAX_SAMPLES];
    int count[2];
    ccd_vec3_t centre[2], first_dir;
    int has_centre[2];
    double least;
    ccd_vec3_t least_dir;
    support_sample_t least_sample[2]; /* of least_dir */
} samples_t;

typedef enum {
    REQUEST_ANSWER,  /* the query itself */
    REQUEST_MINIMUM, /* the proven minimum, without the centres */
    REQUEST_VALUE    /* the support value of the difference along dir */
} request_kind_t;

typedef struct {
    request_kind_t kind;
    const library_t *library;
    const query_t *q;
    samples_t *samples;      /* NULL: nothing is recorded */
    const ccd_vec3_t *shift; /* NULL, or a translation of obj2 */
    double tolerance;        /* of the minimum */
    double tilt;             /* of the directions that the callbacks receive, radians */
    const ccd_vec3_t *dir;   /* unit */
    /* results */
    unsigned long calls; /* of the callbacks */
    answer_t answer;
    int code; /* of the minimum */
    ccd_penetration_t least;
    double value;
    /* the last sample of obj1, until that of obj2 comes */
    int has_pending;
    support_sample_t pending;
} request_t;

/* Returns a request that ends within MAX_CALLS calls of the callbacks: a hundred times
 * what either library needs on degenerate shapes. */
enum { MAX_CALLS = 100000 };
request_t request_of(request_kind_t kind, const library_t *library, const query_t *q, samples_t *samples);

/* Runs a request (request_t *). What the callbacks throw passes through. */
void request_run(void *request);

/* --- judgement ------------------------------------------------------------------------ */

typedef struct {
    compare_counts_t *counts;
    library_t library[COMPARE_SIDES];
    int base;         /* whose answers the program got */
    int timed;        /* whether times are measured */
    const char *keep; /* folder of wrong answers; NULL: none is written */
} compare_t;

typedef struct {
    const query_t *q;
    samples_t *samples;
    double tilt; /* of the directions of the truth, radians */
    verdict_truth_t truth;
    ccd_vec3_t truth_dir; /* of the upper bound */
    double size;          /* of the smaller object */
    answer_t answer[COMPARE_SIDES];
    verdict_t verdict[COMPARE_SIDES];
    int slanted[COMPARE_SIDES], aside[COMPARE_SIDES]; /* as counted: counts.h */
    unsigned long calls[COMPARE_SIDES];
} judged_t;

/* Puts a query of the program's to libccd, to this library and to the proven minimum, judges the answers
 * and adds to the counts. own: what the program got; fields without an output pointer are NaN. */
void judge_query(const compare_t *compare, const query_t *q, const answer_t *own);

/* write_case.c: writes the answer of one library as a file if it is its worst of this kind and the file shows it
 * again. */
void save_case(const compare_t *compare, const judged_t *s, int side);

/* Nanoseconds. */
uint64_t clock_now(clockid_t id);

/* Adds atomically. */
void count_add(uint64_t *to, uint64_t n);

#endif
