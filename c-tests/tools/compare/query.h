/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A query of the program's, and putting it to a library: as it is, or through callbacks that
 * write down what was asked and answered. The libraries hand the object pointers through and
 * never look at them, so what stands between lies behind those pointers, on the stack of the
 * one who asks: no thread-local state, and nothing to clear up when a callback does not return. */

#ifndef COMPARE_QUERY_H
#define COMPARE_QUERY_H

#include "tools/compare/counts.h"

#include <stddef.h>

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
typedef int (*minimum_fn)(const void *, const void *, const ccd_t *, ccd_warm_t *, unsigned, ccd_penetration_t *);

typedef struct {
    void (*call[LIBCCD_CALL_COUNT])(void); /* by number, each of its own type */
    raw_support_fn raw_support;
    minimum_fn minimum; /* NULL in libccd */
} library_t;

/* Records the answers of the callbacks of one query: of each object apart, and the
 * least support value of the difference, which no right depth exceeds. */
enum { SEEN = 1024 };
typedef struct {
    ccd_vec3_t dir, point;
} seen_point_t;

typedef struct {
    seen_point_t point[2][SEEN];
    int count[2];
    ccd_vec3_t centre[2], first_dir;
    int centred[2], has_first_dir;
    double least;
    ccd_vec3_t least_dir;
    seen_point_t least_point[2]; /* the directions and points that gave the least value */
} seen_t;

/* How a query went: support points of the difference, and where to write. */
typedef struct {
    seen_t *seen; /* NULL: nothing is written down */
    unsigned long calls;
    unsigned long most; /* calls, beyond which guard_end; 0: no end */
    const ccd_vec3_t *shift; /* NULL, or by how much obj2 is moved */
    const ccd_vec3_t *pending; /* the direction of support1, whose support2 comes next */
    ccd_vec3_t pending_dir, pending_point;
} asked_t;

/* Opens a library; returns 0, or -1 after a line on stderr. `ours`: whether it is to be this one. */
int library_open(library_t *library, const char *path, int ours);

static inline int is_hit(int call, int code) { return code == call_table[call].hit; }

/* Whether the call answers yes or no alone. */
static inline int is_verdict(int call) { return call_table[call].kind == KIND_BOOLEAN; }

/* By its number. */
int ask_call(const library_t *library, int call, const void *a, const void *b, const ccd_t *ccd, const call_args_t *x);

/* Makes depth and direction of the vector that ccdGJKSeparate answers. */
void answer_by_length(answer_t *out);

/* As the program asks: its callbacks and objects, no detour. */
void ask_plainly(const library_t *library, const query_t *q, answer_t *out);

/* Through callbacks that count in `asked`. */
void ask_watched(const library_t *library, const query_t *q, asked_t *asked, answer_t *out);

/* The proven minimum, trusting no centre. */
int ask_minimum(const library_t *ours, const query_t *q, double tolerance, asked_t *asked, ccd_penetration_t *out);

/* The support value of the difference along a unit direction: how far obj2 must move that way. */
double ask_value(const query_t *q, asked_t *asked, const ccd_vec3_t *dir);

/* Of the call: metres; CCD_INIT's where it is none. */
double query_tolerance(const query_t *q);

/* A program of the tests may define this: it is shown every support point of its own queries, and
 * may change it. */
typedef void (*audit_fn)(const void *obj, ccd_center_fn center, const ccd_vec3_t *dir, ccd_vec3_t *point);
extern audit_fn ask_audit;

#endif
