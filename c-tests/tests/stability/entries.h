/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Calls any entry point of either library, from any state. The table of entry points is `entries`. An endless loop and a
 * crash are answers too. */

#ifndef STABILITY_ENTRIES_H
#define STABILITY_ENTRIES_H

#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif

#include "harness/random.h"
#include "harness/this_library.h"
#include "harness/truth.h"

#include <setjmp.h>
#include <signal.h>
#include <unistd.h>

enum { /* the warm state of a call; of a distance, its arguments */
    STATE_NONE,    /* NULL */
    STATE_ZERO,    /* all bytes 0 */
    STATE_KEPT,    /* left by a call before the objects moved */
    STATE_OWN,     /* left by the same call just before */
    STATE_SWAPPED, /* left by the call with the objects swapped */
    STATE_OPPOSITE_GUESS, /* a guess opposite to the true normal */
    STATE_TILTED_GUESS,   /* a guess up to 120 degrees off: the normal's coordinates in another order */
    STATE_MARGINS,      /* NULL: a margin around each object */
    STATE_MAX_DISTANCE  /* NULL: no refinement beyond a tenth of the size */
};

typedef struct {
    const char *name;
    int is_libccd;   /* else this library */
    int call, state; /* call: CALL_ of this_library.h */
    int without_centres;
} entry_t;

/* codes beside those of the libraries */
enum { ANSWER_LOOP = -100, ANSWER_CRASH = -101, ANSWER_NONE = -102 /* not called */ };

typedef struct {
    int code;
    double depth, dir[3], pos[3];
    int has_pos, has_bounds;
    int wrote_outputs; /* though there was no answer */
    double lower, normal[3], point1[3], point2[3]; /* with has_bounds */
    double distance, margins, max_distance; /* of ccdSignedDistance, whose depth and lower are without margins */
    double value;                           /* h of the normal, or of the direction, with has_value */
    int has_value;
    unsigned long calls;                    /* of both support functions */
    unsigned long supports;                 /* as reported, with has_bounds */
} answer_t;

static const entry_t entries[] = {
#ifndef OURS_ALONE
    {"libccd MPR", 1, CALL_MPR, STATE_NONE, 0},
    {"libccd GJK", 1, CALL_GJK, STATE_NONE, 0},
#endif
    {"MPR", 0, CALL_MPR, STATE_NONE, 0},
    {"GJK", 0, CALL_GJK, STATE_NONE, 0},
    {"separate", 0, CALL_SEPARATE, STATE_NONE, 0},
    {"MPR intersect", 0, CALL_MPR_INTERSECT, STATE_NONE, 0},
    {"GJK intersect", 0, CALL_GJK_INTERSECT, STATE_NONE, 0},
    {"intersect", 0, CALL_INTERSECT, STATE_NONE, 0},
    {"penetration", 0, CALL_PENETRATION, STATE_NONE, 0},
    {"penetration, no centres", 0, CALL_PENETRATION, STATE_NONE, 1},
    {"local", 0, CALL_LOCAL, STATE_NONE, 0},
    {"local, no centres", 0, CALL_LOCAL, STATE_NONE, 1},
    {"minimum", 0, CALL_PROVEN, STATE_NONE, 0},
    {"minimum, no centres", 0, CALL_PROVEN, STATE_NONE, 1},
    {"along", 0, CALL_ALONG, STATE_NONE, 0},
    {"incremental", 0, CALL_INCREMENTAL, STATE_NONE, 0},
    {"MPR, zero state", 0, CALL_MPR_WARM, STATE_ZERO, 0},
    {"MPR, again", 0, CALL_MPR_WARM, STATE_OWN, 0},
    {"MPR, swapped state", 0, CALL_MPR_WARM, STATE_SWAPPED, 0},
    {"MPR, opposite guess", 0, CALL_MPR_WARM, STATE_OPPOSITE_GUESS, 0},
    {"MPR, tilted guess", 0, CALL_MPR_WARM, STATE_TILTED_GUESS, 0},
    {"MPR intersect, again", 0, CALL_MPR_INTERSECT_WARM, STATE_OWN, 0},
    {"penetration, again", 0, CALL_PENETRATION, STATE_OWN, 0},
    {"local, again", 0, CALL_LOCAL, STATE_OWN, 0},
    {"local, swapped state", 0, CALL_LOCAL, STATE_SWAPPED, 0},
    {"local, opposite guess", 0, CALL_LOCAL, STATE_OPPOSITE_GUESS, 0},
    {"local, tilted guess", 0, CALL_LOCAL, STATE_TILTED_GUESS, 0},
    {"minimum, again", 0, CALL_PROVEN, STATE_OWN, 0},
    {"minimum, opposite guess", 0, CALL_PROVEN, STATE_OPPOSITE_GUESS, 0},
    {"minimum, tilted guess", 0, CALL_PROVEN, STATE_TILTED_GUESS, 0},
    {"along, again", 0, CALL_ALONG, STATE_OWN, 0},
    {"distance", 0, CALL_DISTANCE, STATE_NONE, 0},
    {"distance, again", 0, CALL_DISTANCE, STATE_OWN, 0},
    {"distance, opposite guess", 0, CALL_DISTANCE, STATE_OPPOSITE_GUESS, 0},
    {"distance, margins", 0, CALL_DISTANCE, STATE_MARGINS, 0},
    {"distance, max_distance", 0, CALL_DISTANCE, STATE_MAX_DISTANCE, 0},
};
enum { ENTRIES = sizeof entries / sizeof entries[0] };

/* Returns whether it is one of libccd's calls, or the same with a state. */
static inline int entry_is_compatible(const entry_t *e)
{
    return !(call_table[e->call].traits & EXTENSION) || e->call == CALL_MPR_WARM || e->call == CALL_MPR_INTERSECT_WARM
        || e->call == CALL_INTERSECT || e->call == CALL_PENETRATION;
}

/* Returns whether the depth is the global minimum within the tolerance. */
static inline int entry_is_minimum(const entry_t *e)
{
    return !e->is_libccd && (e->call == CALL_GJK || e->call == CALL_SEPARATE || e->call == CALL_PROVEN);
}

/* Returns whether the depth is the global minimum within the larger of the tolerance and 0.1 % of it. */
static inline int entry_is_mpr(const entry_t *e)
{
    return e->call == CALL_MPR || e->call == CALL_MPR_WARM || e->call == CALL_PENETRATION;
}

static inline int entry_is_boolean(const entry_t *e)
{
    return call_table[e->call].kind == KIND_BOOLEAN || call_table[e->call].kind == KIND_BOOLEAN_WARM;
}

/* From so many calls of both support functions on it counts as an endless loop. */
static inline unsigned long call_limit(const entry_t *e)
{
    if (e->is_libccd)
        return e->call == CALL_MPR ? 40000 : 4000;
    const int is_portal = e->call == CALL_ALONG || e->call == CALL_PLANAR || e->call == CALL_INCREMENTAL;
    return entry_is_mpr(e) || is_portal ? 2 * 400 : 2 * 500;
}

static unsigned wanted_outputs = CCD_WANT_ALL; /* CCD_WANT_ flags */
static double margin_size = 1; /* the size that margins and largest distances are parts of, metres */

static sigjmp_buf before_call;
static volatile unsigned long support_calls, support_call_limit;

static inline void counting_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    if (++support_calls > support_call_limit)
        siglongjmp(before_call, ANSWER_LOOP);
    shape_support(obj, dir, out);
}

static void leave_call(int number)
{
    siglongjmp(before_call, number == SIGALRM ? ANSWER_LOOP : ANSWER_CRASH);
}

/* Turns crashes and endless loops into answers from here on. An alarm ends a loop without
 * support calls. */
static inline void catch_crashes(void)
{
    static const int numbers[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM};
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = leave_call;
    action.sa_flags = SA_NODEFER;
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        sigaction(numbers[i], &action, NULL);
}

static inline void to_double(const ccd_vec3_t *v, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (double)v->v[i];
}

/* Reads a signed distance as a depth: its upper and lower bound change places with the sign. */
static inline void read_distance(const ccd_distance_t *d, const call_args_t *x, answer_t *out)
{
    out->has_bounds = out->code == CCD_HIT || out->code == CCD_MISS || out->code == CCD_LIMIT;
    if (!out->has_bounds)
        return;
    out->distance = (double)d->distance;
    out->margins = (double)x->margin1 + (double)x->margin2;
    out->max_distance = (double)x->max_distance;
    out->supports = d->support_points;
    out->depth = -(double)d->distance - out->margins;
    out->lower = -(double)d->distance_upper - out->margins;
    to_double(&d->normal, out->dir);
    to_double(&d->normal, out->normal);
    to_double(&d->point1, out->point1);
    to_double(&d->point2, out->point2);
}

/* Makes one call. */
static inline void call_once(const entry_t *e, const void *a, const void *b, const ccd_t *ccd, ccd_warm_t *warm,
                             const ccd_vec3_t *along, answer_t *out)
{
    struct {
        ccd_penetration_t full;
        ccd_real_t depth;
        ccd_vec3_t dir, pos;
    } outputs, unwritten;
    ccd_distance_t distance;
    const ccd_real_t margin = (ccd_real_t)(e->state == STATE_MARGINS ? .1 * margin_size : 0);
    const call_args_t args = {.warm = warm, .along = along, .want = wanted_outputs, .depth = &outputs.depth, .dir = &outputs.dir,
                              .pos = wanted_outputs & CCD_WANT_POS ? &outputs.pos : NULL, .penetration = &outputs.full,
                              .margin1 = margin, .margin2 = margin / 3, .distance = &distance,
                              .max_distance = (ccd_real_t)(e->state == STATE_MAX_DISTANCE ? .1 * margin_size : HUGE_VAL)};
    memset(&outputs, 0xa5, sizeof outputs);
    memset(&unwritten, 0xa5, sizeof unwritten);
    out->code = e->is_libccd ? call_libccd(e->call, a, b, ccd, &args) : call_library(e->call, a, b, ccd, &args);
    if (entry_is_boolean(e))
        out->code = out->code ? CCD_HIT : CCD_MISS;
    if (e->call == CALL_DISTANCE) {
        read_distance(&distance, &args, out);
        return;
    }
    if (out->code != CCD_HIT && out->code != CCD_LIMIT) {
        out->wrote_outputs = memcmp(&outputs, &unwritten, sizeof outputs) != 0;
        return;
    }
    out->has_bounds = e->call >= CALL_PENETRATION;
    out->has_pos = out->has_bounds || e->call == CALL_MPR || e->call == CALL_GJK || e->call == CALL_MPR_WARM;
    if (out->has_bounds) {
        const ccd_penetration_t *p = &outputs.full;
        outputs.depth = p->depth;
        outputs.dir = p->dir;
        outputs.pos = p->pos;
        out->lower = (double)p->depth_lower;
        out->supports = p->support_points;
        to_double(&p->normal, out->normal);
        to_double(&p->point1, out->point1);
        to_double(&p->point2, out->point2);
    }
    out->depth = (double)outputs.depth;
    to_double(&outputs.dir, out->dir);
    to_double(&outputs.pos, out->pos);
    if (e->call == CALL_SEPARATE) { /* a vector: the direction times the depth */
        out->depth = sqrt(truth_dot3(out->dir, out->dir));
        for (int i = 0; i < 3; i++)
            out->dir[i] = out->depth > 0 ? out->dir[i] / out->depth : 0;
    }
}

/* Makes one call whose endless loops and crashes are caught. limit: of support calls. */
static inline answer_t call_guarded(const entry_t *e, const void *a, const void *b, const ccd_t *ccd, ccd_warm_t *warm,
                                    const ccd_vec3_t *along, unsigned long limit)
{
    static answer_t out; /* static: survives a siglongjmp */
    memset(&out, 0, sizeof out);
    support_call_limit = limit;
    support_calls = 0;
    int code = sigsetjmp(before_call, 1);
    if (code == 0) {
        alarm(10);
        call_once(e, a, b, ccd, warm, along, &out);
    } else {
        out.code = code;
    }
    alarm(0);
    out.calls = support_calls;
    return out;
}

/* Settings for shapes whose support points are counted, with one tolerance for every call. */
static inline ccd_t counting_query(double tol)
{
    ccd_t ccd = shape_query();
    ccd.support1 = ccd.support2 = counting_support;
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = (ccd_real_t)tol;
    return ccd;
}

/* Calls the entry point for two shapes, from the state that it names, which is left in `warm`. normal: the true one,
 * which wrong guesses are made of; the direction of "along". */
static inline answer_t call_entry(const entry_t *e, const shape_t *a, const shape_t *b, double tol, const double normal[3],
                                  ccd_warm_t *warm)
{
    const unsigned long limit = call_limit(e);
    shape_t sa = *a, sb = *b;
    ccd_vec3_t along, guess;
    ccd_t ccd = counting_query(tol);
    if (e->without_centres)
        ccd.center1 = ccd.center2 = NULL;
    margin_size = pair_size(a, b);
    for (int i = 0; i < 3; i++) {
        along.v[i] = (ccd_real_t)normal[i];
        guess.v[i] = (ccd_real_t)(e->state == STATE_TILTED_GUESS ? normal[(i + 1) % 3] : -normal[i]);
    }
    if (e->state != STATE_KEPT)
        memset(warm, 0, sizeof *warm);
    if (e->state == STATE_OPPOSITE_GUESS || e->state == STATE_TILTED_GUESS)
        OURS(ccdWarmGuess)(warm, &guess);
    if (e->state == STATE_OWN)
        call_guarded(e, &sa, &sb, &ccd, warm, &along, limit);
    if (e->state == STATE_SWAPPED)
        call_guarded(e, &sb, &sa, &ccd, warm, &along, limit);
    return call_guarded(e, &sa, &sb, &ccd, e->state == STATE_NONE || e->state >= STATE_MARGINS ? NULL : warm, &along, limit);
}

#endif
