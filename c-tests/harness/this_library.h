/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Names of this library's functions in tests, and calls by number.
 *
 * A program that links system libccd beside this library links this one's archive
 * with every symbol renamed to rs_...: OURS(ccdMPRPenetration) is then
 * rs_ccdMPRPenetration, and the plain name is libccd's. A program that links this
 * library alone (also every single-precision one: Debian's libccd is double) is
 * compiled with -DOURS_ALONE, and OURS(name) is the plain name. */

#ifndef TESTS_THIS_LIBRARY_H
#define TESTS_THIS_LIBRARY_H

#include "harness/calls.h"

#include <ccd/paper.h>
#include <ccd/warm.h>

#ifdef OURS_ALONE
#define OURS(name) name
#else
#define OURS(name) rs_##name

#ifdef __cplusplus
extern "C" {
#endif
#define DECLARE(name, traits) extern __typeof__(name) rs_##name;
#define DECLARE_PAIR_CALL(name, word, kind, traits) DECLARE(name, traits)
PAIR_CALLS(DECLARE_PAIR_CALL)
OTHER_CALLS(DECLARE)
#undef DECLARE_PAIR_CALL
#undef DECLARE
#ifdef __cplusplus
}
#endif
#endif

enum {
#define CALL_NUMBER(name, word, kind, traits) CALL_##word,
    PAIR_CALLS(CALL_NUMBER)
#undef CALL_NUMBER
        PAIR_CALL_COUNT
};
enum {
#define COUNT_CALL(name, word, kind, traits) + 1
    LIBCCD_CALL_COUNT = 0 LIBCCD_CALLS(COUNT_CALL) /* the first of them are libccd's */
#undef COUNT_CALL
};

enum {
#define CALL_KIND(kind, hit, miss, bad) KIND_##kind,
    CALL_KINDS(CALL_KIND)
#undef CALL_KIND
};
enum {
#define CALL_CODES(kind, hit, miss, bad) HIT_##kind = hit, MISS_##kind = miss, BAD_##kind = bad,
    CALL_KINDS(CALL_CODES)
#undef CALL_CODES
};

typedef struct {
    const char *name;
    int number; /* of call_library */
    int kind, traits;
    int hit, miss, bad; /* return codes */
} call_t;

static const call_t call_table[] = {
#define CALL_ROW(name, word, kind, traits) {#name, CALL_##word, KIND_##kind, traits, HIT_##kind, MISS_##kind, BAD_##kind},
    PAIR_CALLS(CALL_ROW)
#undef CALL_ROW
};

/* Arguments and outputs of all calls besides the objects and their ccd_t. */
typedef struct {
    ccd_warm_t *warm;
    const ccd_vec3_t *along; /* or the normal of the plane, of the contacts */
    ccd_real_t margin1, margin2, max_distance, slop;
    unsigned want;
    int max;
    ccd_real_t *depth;
    ccd_vec3_t *dir, *pos; /* dir: of ccdGJKSeparate too */
    ccd_penetration_t *penetration;
    ccd_distance_t *distance;
    ccd_manifold_cache_t *cache;
    ccd_contact_t *contacts;
} call_args_t;

#define PASS_BOOLEAN(f) f(a, b, ccd)
#define PASS_BOOLEAN_WARM(f) f(a, b, ccd, x->warm)
#define PASS_SEPARATION(f) f(a, b, ccd, x->dir)
#define PASS_DEPTH(f) f(a, b, ccd, x->depth, x->dir, x->pos)
#define PASS_DEPTH_WARM(f) f(a, b, ccd, x->warm, x->depth, x->dir, x->pos)
#define PASS_PENETRATION(f) f(a, b, ccd, x->warm, x->want, x->penetration)
#define PASS_PENETRATION_ALONG(f) f(a, b, ccd, x->along, x->warm, x->want, x->penetration)
#define PASS_MANIFOLD(f) f(a, b, ccd, x->along, x->slop, x->cache, x->contacts, x->max)
#define PASS_DISTANCE(f) f(a, b, ccd, x->margin1, x->margin2, x->max_distance, x->warm, x->want, x->distance)

/* Calls this library's function of that number. */
static inline int call_library(int number, const void *a, const void *b, const ccd_t *ccd, const call_args_t *x)
{
    switch (number) {
#define CALL_CASE(name, word, kind, traits) \
    case CALL_##word: return PASS_##kind(OURS(name));
        PAIR_CALLS(CALL_CASE)
#undef CALL_CASE
    default: return CCD_BAD_INPUT;
    }
}

/* Calls system libccd's MPR or GJK, where it is linked. */
static inline int call_libccd(int number, const void *a, const void *b, const ccd_t *ccd, const call_args_t *x)
{
#ifdef OURS_ALONE
    return call_library(number, a, b, ccd, x);
#else
    return number == CALL_MPR ? PASS_DEPTH(ccdMPRPenetration) : PASS_DEPTH(ccdGJKPenetration);
#endif
}

#endif
