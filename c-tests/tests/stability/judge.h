/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Asks any entry point of either library one question, and judges the answer by
 * the exact truth. The table of entry points is `entries`; a question that does
 * not come back within a number of support calls, or crashes, is an answer too. */

#ifndef STABILITY_JUDGE_H
#define STABILITY_JUDGE_H

#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif

#include "harness/this_library.h"
#include "harness/tolerances.h"

#include <setjmp.h>
#include <signal.h>
#include <stdio.h>
#include <unistd.h>

/* --- asking ------------------------------------------------------------------ */

enum { /* what the warm state holds, or how else a distance is asked */
    STATE_NONE,  /* NULL */
    STATE_ZERO,  /* all bytes 0 */
    STATE_AGAIN, /* left by the same question asked a moment ago */
    STATE_SWAPPED, /* the same of the swapped pair */
    STATE_AGAINST, /* a guess opposite to the true normal */
    STATE_BESIDE,  /* one up to 120 degrees off: its coordinates in another order */
    STATE_MARGINS, /* none: a ball all around each object */
    STATE_NEAR     /* none: what is farther apart than a part of the size is not refined */
};

typedef struct {
    const char *name;
    int system; /* libccd's, else ours */
    int call, state; /* call: CALL_ of this_library.h */
} entry_t;

/* codes beside those of the libraries */
enum { ANSWER_LOOP = -100, ANSWER_CRASH = -101 };

typedef struct {
    int code;
    double depth, dir[3], pos[3];
    int has_pos, has_proof;
    int touched; /* an output was written though there was no answer */
    double lower, normal[3], point1[3], point2[3]; /* with has_proof */
    double distance, margins, near; /* of ccdSignedDistance: the first as it is said, depth and lower without margins */
    unsigned long calls;                           /* of both support functions */
    unsigned long supports;                        /* as reported, with has_proof */
} answer_t;

static const entry_t entries[] = {
#ifndef OURS_ALONE
    {"libccd MPR", 1, CALL_MPR, STATE_NONE},
    {"libccd GJK", 1, CALL_GJK, STATE_NONE},
#endif
    {"MPR", 0, CALL_MPR, STATE_NONE},
    {"GJK", 0, CALL_GJK, STATE_NONE},
    {"separate", 0, CALL_SEPARATE, STATE_NONE},
    {"MPR intersect", 0, CALL_MPR_INTERSECT, STATE_NONE},
    {"GJK intersect", 0, CALL_GJK_INTERSECT, STATE_NONE},
    {"intersect", 0, CALL_INTERSECT, STATE_NONE},
    {"penetration", 0, CALL_PENETRATION, STATE_NONE},
    {"local", 0, CALL_LOCAL, STATE_NONE},
    {"minimum", 0, CALL_PROVEN, STATE_NONE},
    {"along", 0, CALL_ALONG, STATE_NONE},
    {"MPR, zero state", 0, CALL_MPR_WARM, STATE_ZERO},
    {"MPR, again", 0, CALL_MPR_WARM, STATE_AGAIN},
    {"MPR, swapped state", 0, CALL_MPR_WARM, STATE_SWAPPED},
    {"MPR, wrong guess", 0, CALL_MPR_WARM, STATE_AGAINST},
    {"MPR, guess beside", 0, CALL_MPR_WARM, STATE_BESIDE},
    {"MPR intersect, again", 0, CALL_MPR_INTERSECT_WARM, STATE_AGAIN},
    {"penetration, again", 0, CALL_PENETRATION, STATE_AGAIN},
    {"local, again", 0, CALL_LOCAL, STATE_AGAIN},
    {"local, swapped state", 0, CALL_LOCAL, STATE_SWAPPED},
    {"local, wrong guess", 0, CALL_LOCAL, STATE_AGAINST},
    {"local, guess beside", 0, CALL_LOCAL, STATE_BESIDE},
    {"minimum, again", 0, CALL_PROVEN, STATE_AGAIN},
    {"minimum, wrong guess", 0, CALL_PROVEN, STATE_AGAINST},
    {"minimum, guess beside", 0, CALL_PROVEN, STATE_BESIDE},
    {"along, again", 0, CALL_ALONG, STATE_AGAIN},
    {"distance", 0, CALL_DISTANCE, STATE_NONE},
    {"distance, again", 0, CALL_DISTANCE, STATE_AGAIN},
    {"distance, wrong guess", 0, CALL_DISTANCE, STATE_AGAINST},
    {"distance, margins", 0, CALL_DISTANCE, STATE_MARGINS},
    {"distance, if near", 0, CALL_DISTANCE, STATE_NEAR},
};
enum { ENTRIES = sizeof entries / sizeof entries[0] };

/* Is the entry point of this group: "compatible", libccd's or the same with a state; of
 * the extension's own "local", or "proven", which have a lower bound that closes? NULL: any. */
static inline int entry_in(const entry_t *e, const char *group)
{
    int local = e->call == CALL_LOCAL, proven = e->call == CALL_PROVEN || e->call == CALL_ALONG || e->call == CALL_DISTANCE;
    return !group || strcmp(group, local ? "local" : proven ? "proven" : "compatible") == 0;
}

/* Whether the answer claims to be the global minimum within the tolerance. */
static inline int entry_is_minimum(const entry_t *e)
{
    return !e->system && (e->call == CALL_GJK || e->call == CALL_SEPARATE || e->call == CALL_PROVEN);
}

/* Whether it promises the global minimum within the larger of the tolerance and 0.1 % of the depth. */
static inline int entry_is_mpr(const entry_t *e)
{
    return e->call == CALL_MPR || e->call == CALL_MPR_WARM || e->call == CALL_PENETRATION;
}

static inline int entry_is_verdict(const entry_t *e)
{
    return e->call == CALL_MPR_INTERSECT || e->call == CALL_GJK_INTERSECT || e->call == CALL_MPR_INTERSECT_WARM || e->call == CALL_INTERSECT;
}

/* From so many calls of both support functions on it counts as looping: no query is slower. */
static inline unsigned long call_limit(const entry_t *e)
{
    if (e->system)
        return e->call == CALL_MPR ? 40000 : 4000;
    return entry_is_mpr(e) ? 2 * 400 : 2 * 1500;
}

/* What of an answer is wanted: CCD_WANT_ flags; and the size of the pair, metres. */
static unsigned wanted_outputs = CCD_WANT_ALL;
static double judge_size = 1;

static sigjmp_buf judge_back;
static volatile unsigned long judge_calls, judge_limit;

static inline void judge_count(void)
{
    if (++judge_calls > judge_limit)
        siglongjmp(judge_back, ANSWER_LOOP);
}

static inline void judge_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    judge_count();
    shape_support(obj, dir, out);
}

static void judge_signal(int number)
{
    siglongjmp(judge_back, number == SIGALRM ? ANSWER_LOOP : ANSWER_CRASH);
}

/* Crashes and endless loops become answers from here on. A loop without support
 * calls is ended by an alarm. */
static inline void catch_crashes(void)
{
    static const int numbers[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM};
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = judge_signal;
    action.sa_flags = SA_NODEFER;
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        sigaction(numbers[i], &action, NULL);
}

/* Outputs hold this until they are written. */
static const unsigned char judge_blank = 0xa5;

static inline int judge_is_blank(const void *memory, size_t size)
{
    const unsigned char *byte = (const unsigned char *)memory;
    for (size_t i = 0; i < size; i++)
        if (byte[i] != judge_blank)
            return 0;
    return 1;
}

static inline void judge_vec(const ccd_vec3_t *v, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (double)v->v[i];
}

static inline int judge_libccd(const entry_t *e, const void *a, const void *b, const ccd_t *ccd, const call_args_t *x)
{
#ifdef OURS_ALONE
    return call_library(e->call, a, b, ccd, x); /* no entry asks for it */
#else
    return e->call == CALL_MPR ? ccdMPRPenetration(a, b, ccd, x->depth, x->dir, x->pos)
                             : ccdGJKPenetration(a, b, ccd, x->depth, x->dir, x->pos);
#endif
}

/* A signed distance, as a depth: its upper and lower bound change places with the sign. */
static inline void judge_distance(const ccd_distance_t *d, const call_args_t *x, answer_t *out)
{
    out->has_proof = out->code == CCD_HIT || out->code == CCD_MISS || out->code == CCD_LIMIT;
    if (!out->has_proof)
        return;
    out->distance = (double)d->distance;
    out->margins = (double)x->margin1 + (double)x->margin2;
    out->near = (double)x->max_distance;
    out->supports = d->support_points;
    out->depth = -(double)d->distance - out->margins;
    out->lower = -(double)d->distance_upper - out->margins;
    judge_vec(&d->normal, out->dir);
    judge_vec(&d->normal, out->normal);
    judge_vec(&d->point1, out->point1);
    judge_vec(&d->point2, out->point2);
}

/* One call of the function itself. */
static inline void ask_once(const entry_t *e, const void *a, const void *b, const ccd_t *ccd, ccd_warm_t *warm,
                            const ccd_vec3_t *along, answer_t *out)
{
    ccd_penetration_t p;
    ccd_distance_t distance;
    ccd_real_t depth;
    ccd_vec3_t dir, pos;
    const ccd_real_t margin = (ccd_real_t)(e->state == STATE_MARGINS ? .1 * judge_size : 0);
    const call_args_t rest = {.warm = warm, .along = along, .want = wanted_outputs, .depth = &depth, .dir = &dir,
                              .pos = wanted_outputs & CCD_WANT_POS ? &pos : NULL, .penetration = &p, .margin1 = margin, .margin2 = margin / 3,
                              .max_distance = (ccd_real_t)(e->state == STATE_NEAR ? .1 * judge_size : HUGE_VAL), .distance = &distance};
    const int full = e->call >= CALL_PENETRATION;
    memset(&p, judge_blank, sizeof p);
    memset(&depth, judge_blank, sizeof depth);
    memset(&dir, judge_blank, sizeof dir);
    memset(&pos, judge_blank, sizeof pos);
    int code = e->system ? judge_libccd(e, a, b, ccd, &rest) : call_library(e->call, a, b, ccd, &rest);
    if (entry_is_verdict(e))
        code = code ? CCD_HIT : CCD_MISS;
    if (e->call == CALL_SEPARATE && code == 0) {
        /* a zero vector keeps no direction: give it the answer's own */
        double v[3], l;
        judge_vec(&dir, v);
        l = sqrt(truth_dot3(v, v));
        depth = (ccd_real_t)l;
        for (int i = 0; i < 3; i++)
            dir.v[i] = (ccd_real_t)(l > 0 ? v[i] / l : 0);
    }
    out->code = code;
    if (e->call == CALL_DISTANCE) {
        judge_distance(&distance, &rest, out);
        return;
    }
    if (code != CCD_HIT && code != CCD_LIMIT) {
        out->touched = !judge_is_blank(&p, sizeof p) || !judge_is_blank(&depth, sizeof depth)
            || !judge_is_blank(&dir, sizeof dir) || !judge_is_blank(&pos, sizeof pos);
        return;
    }
    out->has_proof = full;
    out->has_pos = full || e->call == CALL_MPR || e->call == CALL_GJK || e->call == CALL_MPR_WARM;
    if (full) {
        depth = p.depth;
        dir = p.dir;
        pos = p.pos;
        out->lower = (double)p.depth_lower;
        out->supports = p.support_points;
        judge_vec(&p.normal, out->normal);
        judge_vec(&p.point1, out->point1);
        judge_vec(&p.point2, out->point2);
    }
    out->depth = (double)depth;
    judge_vec(&dir, out->dir);
    judge_vec(&pos, out->pos);
}

/* One call that comes back whatever happens in it. Support functions count by
 * judge_count; more calls than limit are a loop. */
static inline answer_t call_guarded(const entry_t *e, const void *a, const void *b, const ccd_t *ccd, ccd_warm_t *warm,
                                   const ccd_vec3_t *along, unsigned long limit)
{
    static answer_t out; /* static: kept over a siglongjmp */
    memset(&out, 0, sizeof out);
    judge_limit = limit;
    judge_calls = 0;
    int code = sigsetjmp(judge_back, 1);
    if (code == 0) {
        alarm(10);
        ask_once(e, a, b, ccd, warm, along, &out);
    } else {
        out.code = code;
    }
    alarm(0);
    out.calls = judge_calls;
    return out;
}

/* The question put with any objects and callbacks, from the state that the entry
 * names. normal: the start of a wrong guess, and what "along" asks about. */
static inline answer_t ask_objects(const entry_t *e, const void *a, const void *b, const ccd_t *ccd,
                                   const double normal[3], unsigned long limit)
{
    ccd_warm_t warm;
    ccd_vec3_t along, guess;
    ccd_t swapped = *ccd;
    memset(&warm, 0, sizeof warm);
    for (int i = 0; i < 3; i++) {
        along.v[i] = (ccd_real_t)normal[i];
        guess.v[i] = (ccd_real_t)(e->state == STATE_BESIDE ? normal[(i + 1) % 3] : -normal[i]);
    }
    swapped.support1 = ccd->support2;
    swapped.support2 = ccd->support1;
    swapped.center1 = ccd->center2;
    swapped.center2 = ccd->center1;
    if (e->state == STATE_AGAINST || e->state == STATE_BESIDE)
        OURS(ccdWarmGuess)(&warm, &guess);
    if (e->state == STATE_AGAIN)
        call_guarded(e, a, b, ccd, &warm, &along, limit);
    if (e->state == STATE_SWAPPED)
        call_guarded(e, b, a, &swapped, &warm, &along, limit);
    return call_guarded(e, a, b, ccd, e->state == STATE_NONE || e->state >= STATE_MARGINS ? NULL : &warm, &along, limit);
}

/* Of shapes, whose support points are counted, to one tolerance for every call. */
static inline ccd_t counting_query(double tol)
{
    ccd_t ccd = shape_query();
    ccd.support1 = ccd.support2 = judge_support;
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = (ccd_real_t)tol;
    return ccd;
}

/* The question about two shapes. limit: support calls until it is a loop. */
static inline answer_t ask(const entry_t *e, const shape_t *a, const shape_t *b, double tol,
                           const double normal[3], unsigned long limit)
{
    const ccd_t ccd = counting_query(tol);
    shape_t sa = *a, sb = *b;
    judge_size = pair_size(a, b);
    return ask_objects(e, &sa, &sb, &ccd, normal, limit);
}

/* --- judging ------------------------------------------------------------------ */

/* Faults of an answer. The first group is the rate table's, the same
 * for both libraries; the second is what this library promises. */
#define FAULTS(X) \
    X(LOOP, "loop") \
    X(CRASH, "crash") \
    X(NAN, "NaN") \
    X(DIR0, "zero direction") \
    X(MISS_DEEP, "deep miss") \
    X(MISS_SHALLOW, "shallow miss") \
    X(FALSE_HIT, "false hit") \
    X(OVER, "too deep") \
    X(UNDER, "too shallow") \
    X(ZERO, "depth nearly 0") \
    X(UNSOUND, "unsound") \
    X(DIR_BAD, "bad direction") \
    X(CODE, "undocumented code") \
    X(MISSED, "missed an overlap") \
    X(NOT_UNIT, "direction not unit") \
    X(NOT_NORMAL, "direction not the normal") \
    X(NOT_SUPPORT, "depth is not the support value of its direction") \
    X(NOT_MINIMUM, "not the minimum within tolerance") \
    X(NOT_PROMISED, "deeper than MPR promises") \
    X(FALSE_PROOF, "lower bound above the truth") \
    X(NO_PROOF, "gap above tolerance") \
    X(LIMIT, "stopped at the cap") \
    X(WITNESS_DEPTH, "witness points not the depth apart") \
    X(WITNESS_PLANE, "witness points off the supporting planes") \
    X(WITNESS_INSIDE, "witness points outside the shapes") \
    X(WITNESS_ACROSS, "witness points apart across the normal") \
    X(POSITION, "position not between the witness points") \
    X(MISCOUNTED, "supports miscounted") \
    X(TOUCHED, "outputs written without an answer") \
    X(STACK, "stack") \
    X(TAIL, "tail")

enum {
#define STABILITY_FAULT_BIT(name, text) FAULT_BIT_##name,
    FAULTS(STABILITY_FAULT_BIT)
#undef STABILITY_FAULT_BIT
        FAULT_BIT_COUNT
};
enum {
#define STABILITY_FAULT(name, text) FAULT_##name = 1 << FAULT_BIT_##name,
    FAULTS(STABILITY_FAULT)
#undef STABILITY_FAULT
};

static inline const char *fault_text(int bit)
{
    static const char *const texts[] = {
#define STABILITY_FAULT_TEXT(name, text) text,
        FAULTS(STABILITY_FAULT_TEXT)
#undef STABILITY_FAULT_TEXT
    };
    return texts[bit];
}

/* Faults that this library never has, whatever the entry point. */
enum {
    FAULTS_FORBIDDEN = FAULT_LOOP | FAULT_CRASH | FAULT_NAN | FAULT_DIR0 | FAULT_MISS_DEEP | FAULT_FALSE_HIT
        | FAULT_UNSOUND | FAULT_CODE | FAULT_MISSED | FAULT_NOT_UNIT | FAULT_NOT_NORMAL | FAULT_NOT_SUPPORT | FAULT_NOT_MINIMUM | FAULT_NOT_PROMISED
        | FAULT_FALSE_PROOF | FAULT_NO_PROOF | FAULT_LIMIT | FAULT_WITNESS_DEPTH
        | FAULT_WITNESS_PLANE | FAULT_WITNESS_INSIDE | FAULT_WITNESS_ACROSS | FAULT_POSITION | FAULT_MISCOUNTED | FAULT_TOUCHED
};

/* Where minima are nearly everywhere no proof ends, and the search stops as MPR does. */
enum { ALL_AROUND = 2 };

typedef struct {
    double size, noise; /* metres */
    double tol;         /* the query's, metres */
    truth_t truth;
    int surface;        /* minima form a curve or surface: CCD_LIMIT is an answer */
    int touching;       /* within rounding of touching: hit or miss */
} criteria_t;

static inline criteria_t criteria_of(const shape_t *a, const shape_t *b, double tol, const truth_t *truth)
{
    criteria_t q;
    q.size = pair_size(a, b);
    q.noise = pair_noise(a, b);
    q.tol = tol;
    q.truth = *truth;
    q.surface = 0;
    q.touching = truth->lower <= q.noise && truth->depth >= -q.noise;
    return q;
}

/* Support value of one shape, in full precision, relative to origin. */
static inline double judge_reach(const shape_t *s, const double origin[3], const double n[3])
{
    double p[3];
    truth_support(s, origin, n, p);
    return truth_dot3(p, n);
}

/* How far an answer's points may be off: as far as the depth may be, and where a bound is given, and
 * the cap or rounding, by no more than FAULT_NO_PROOF allows, left it open, by that. */
static inline double judge_bound(const entry_t *e, const answer_t *x, const criteria_t *q)
{
    const double promised = entry_is_mpr(e) ? fmax(q->tol, tolerance(TOL_MPR) * x->depth) : q->tol;
    const double reached = x->code == CCD_LIMIT || e->call == CALL_PROVEN ? fmax(promised, x->depth - x->lower) : promised;
    return reached + q->noise + tolerance(TOL_WITNESS) * q->size;
}

/* Is a point, told relative to origin, farther than this outside of the shape? By 26 planes. */
static inline int judge_outside(const shape_t *s, const double origin[3], const double p[3], double bound)
{
    int outside = 0;
    for (int i = 0; i < 27; i++) {
        double n[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}, l = sqrt(truth_dot3(n, n));
        if (l == 0)
            continue;
        n[0] /= l;
        n[1] /= l;
        n[2] /= l;
        outside |= !(truth_dot3(p, n) - judge_reach(s, origin, n) <= bound);
    }
    return outside;
}

/* pos is within half the depth of both shapes; deeper than an object is thick the middle of the chord
 * is beyond it. And a hair. */
static inline int judge_position(const entry_t *e, const answer_t *x, const shape_t *a, const shape_t *b, const criteria_t *q)
{
    const double inside = judge_bound(e, x, q) + (0.5 + 1.0 / 256) * x->depth;
    double origin[3], p[3];
    for (int i = 0; i < 3; i++) {
        origin[i] = (double)a->pos[i];
        p[i] = x->pos[i] - origin[i];
    }
    return judge_outside(a, origin, p, inside) || judge_outside(b, origin, p, inside) ? FAULT_POSITION : 0;
}

/* Witness points: each in its shape and at its supporting plane, their difference
 * the depth; pos their middle where no centre of pressure is promised. */
static inline int judge_witness(const entry_t *e, const answer_t *x, const shape_t *a, const shape_t *b, const criteria_t *q)
{
    double bound = judge_bound(e, x, q), origin[3], d[3], m[3], p1[3], p2[3], value, l2;
    const int has_centre = x->code == CCD_HIT && e->call != CALL_ALONG && e->call != CALL_PLANAR;
    int faults = 0, i;
    for (i = 0; i < 3; i++) {
        origin[i] = (double)a->pos[i];
        m[i] = -x->normal[i];
        p1[i] = x->point1[i] - origin[i];
        p2[i] = x->point2[i] - origin[i];
        d[i] = p1[i] - p2[i];
        if (!has_centre && !(fabs((p1[i] + p2[i]) / 2 - (x->pos[i] - origin[i])) <= q->noise))
            faults |= FAULT_POSITION;
    }
    value = x->depth * truth_dot3(x->dir, x->normal);
    if (!(fabs(truth_dot3(d, x->normal) - value) <= bound))
        faults |= FAULT_WITNESS_DEPTH;
    for (i = 0, l2 = 0; i < 3; i++) {
        double c = d[i] - x->depth * x->dir[i];
        l2 += c * c;
    }
    l2 -= pow(truth_dot3(d, x->normal) - value, 2);
    if (!(sqrt(fmax(l2, 0)) <= sqrt(2 * (x->depth + bound) * bound) + bound))
        faults |= FAULT_WITNESS_ACROSS;
    if (!(judge_reach(a, origin, x->normal) - truth_dot3(p1, x->normal) <= bound)
        || !(judge_reach(b, origin, m) - truth_dot3(p2, m) <= bound))
        faults |= FAULT_WITNESS_PLANE;
    if (judge_outside(a, origin, p1, bound) || judge_outside(b, origin, p2, bound))
        faults |= FAULT_WITNESS_INSIDE;
    if (has_centre)
        faults |= judge_position(e, x, a, b, q);
    return faults;
}

/* The part of its depth, or of the tolerance, by which an answer of ccdMPRPenetration
 * may be above the least depth; MPR_POINTS support points later it is only LATE. */
enum { MPR_POINTS = 160 };

/* After so many a minimum is given up: the compatible calls cannot say so. */
enum { MINIMUM_POINTS = 340 };

static inline int mpr_within(double depth, double least, double tol, double noise, unsigned long supports)
{
    least = fmax(least, 0);
    return depth <= least + fmax(tol, tolerance(TOL_MPR) * least) + noise
        || (supports >= MPR_POINTS && depth <= least + fmax(tol, tolerance(TOL_MPR_CAPPED) * least) + noise);
}

/* A signed distance, overlapping or not: the sign is the code's, the plane is as far as it says, the
 * bounds close about the truth, but of what is too far, and the points are in the objects, of a gap as
 * far apart as its upper bound; at the cap, where minima form a surface, the distance is right all the
 * same. */
static inline int judge_signed(const entry_t *e, const answer_t *x, const shape_t *a, const shape_t *b, const criteria_t *q)
{
    const truth_t *t = &q->truth;
    const double rounding = 2 * q->noise + t->depth - t->lower, floor = tolerance(TOL_PROOF_FLOOR) * largest_coordinate(a, b);
    const double within = x->code == CCD_LIMIT ? fmax(q->tol, tolerance(TOL_MPR) * fabs(t->depth)) : q->tol;
    const double bound = judge_bound(e, x, q) + x->margins;
    double origin[3], p[2][3], apart = 0;
    int faults = 0;
    if (!x->has_proof)
        return FAULT_CODE;
    if (x->code == CCD_LIMIT && !q->surface)
        faults |= FAULT_LIMIT;
    if (!isfinite(x->depth) || !isfinite(x->lower) || !isfinite(truth_dot3(x->normal, x->normal)))
        return faults | FAULT_NAN;
    if (!(fabs(sqrt(truth_dot3(x->normal, x->normal)) - 1) <= tolerance(TOL_UNIT_LENGTH)))
        faults |= FAULT_NOT_UNIT;
    if ((x->code != CCD_LIMIT && (x->code == CCD_HIT) != (x->distance < 0)) || (x->distance == 0 && signbit(x->distance)))
        faults |= FAULT_CODE;
    if (x->depth < truth_support_value(a, b, x->normal) - 2 * q->noise)
        faults |= FAULT_UNSOUND;
    if (x->lower > x->depth || x->lower > t->depth + rounding)
        faults |= FAULT_FALSE_PROOF;
    if (x->code != CCD_LIMIT && x->distance <= x->near && x->depth - x->lower > q->tol + floor + 2 * q->noise)
        faults |= FAULT_NO_PROOF;
    if (x->distance <= x->near && x->depth > t->depth + within + rounding)
        faults |= FAULT_NOT_MINIMUM;
    for (int i = 0; i < 3; i++) {
        origin[i] = (double)a->pos[i];
        p[0][i] = x->point1[i] - origin[i];
        p[1][i] = x->point2[i] - origin[i];
        apart += (p[0][i] - p[1][i]) * (p[0][i] - p[1][i]);
    }
    if (judge_outside(a, origin, p[0], bound) || judge_outside(b, origin, p[1], bound))
        faults |= FAULT_WITNESS_INSIDE;
    if (x->distance > 0 && !(fabs(sqrt(apart) + x->lower + x->margins) <= 2 * q->noise + tolerance(TOL_WITNESS) * q->size))
        faults |= FAULT_WITNESS_DEPTH;
    return faults;
}

/* All that is wrong with the answer. */
static inline int judge(const entry_t *e, const answer_t *x, const shape_t *a, const shape_t *b, const criteria_t *q)
{
    const truth_t *t = &q->truth;
    double gap = t->depth - t->lower, value, table, l2;
    int faults = 0, finite;
    if (x->code == ANSWER_LOOP)
        return FAULT_LOOP;
    if (x->code == ANSWER_CRASH)
        return FAULT_CRASH;
    if (e->call == CALL_DISTANCE)
        return judge_signed(e, x, a, b, q);
    if (x->touched)
        faults |= FAULT_TOUCHED;
    if (x->code == CCD_MISS) {
        if (t->lower > tolerance(TOL_DEEP) * q->size + q->noise)
            faults |= FAULT_MISS_DEEP;
        else if (t->lower > 0)
            faults |= FAULT_MISS_SHALLOW;
        if (t->lower > q->noise && !q->touching)
            faults |= FAULT_MISSED;
        return faults;
    }
    if (x->code != CCD_HIT && x->code != CCD_LIMIT)
        return faults | FAULT_CODE;
    if (x->code == CCD_LIMIT && !x->has_proof)
        faults |= FAULT_CODE;
    /* ccdPenetration gives up after 160 support points */
    if (x->code == CCD_LIMIT && !q->surface && !(e->call == CALL_PENETRATION && x->calls >= 2 * MPR_POINTS))
        faults |= FAULT_LIMIT;
    if (t->depth < -q->noise && !q->touching)
        return faults | FAULT_FALSE_HIT;
    if (entry_is_verdict(e))
        return faults;
    if (e->call == CALL_SEPARATE && x->depth == 0)
        return faults | (t->depth > q->tol + q->noise ? FAULT_ZERO | FAULT_UNSOUND : 0);

    finite = isfinite(x->depth);
    for (int i = 0; i < 3; i++)
        finite = finite && isfinite(x->dir[i]) && (!x->has_pos || isfinite(x->pos[i]));
    if (!finite)
        return faults | FAULT_NAN;
    l2 = truth_dot3(x->dir, x->dir);
    if (l2 == 0)
        return faults | FAULT_DIR0;
    if (!(fabs(sqrt(l2) - 1) <= tolerance(TOL_UNIT_LENGTH)) && e->call != CALL_SEPARATE)
        faults |= FAULT_NOT_UNIT;

    /* the rate table's verdicts; along a direction that is not the normal the plane is farther */
    value = x->has_proof ? truth_support_value(a, b, x->normal) / truth_dot3(x->dir, x->normal) : truth_support_value(a, b, x->dir);
    table = fmin(tolerance(TOL_TABLE) * fmax(t->depth, 0) + 2 * q->tol, tolerance(TOL_TABLE_CAP) * q->size) + q->noise;
    if (x->depth > t->depth + table)
        faults |= FAULT_OVER;
    if (x->depth < t->lower - table)
        faults |= FAULT_UNDER;
    if (x->depth < tolerance(TOL_TABLE) * t->lower - q->noise)
        faults |= FAULT_ZERO;
    if (x->depth < value - table)
        faults |= FAULT_UNSOUND;
    if (value > t->depth + table)
        faults |= FAULT_DIR_BAD;
    if (e->system)
        return faults;

    /* the promises */
    if (x->has_proof) {
        double along = truth_dot3(x->dir, x->normal), n2 = truth_dot3(x->normal, x->normal);
        if (!(fabs(sqrt(n2) - 1) <= tolerance(TOL_UNIT_LENGTH)) || !(along > 0))
            faults |= FAULT_NOT_UNIT;
        if (e->call != CALL_ALONG && memcmp(x->dir, x->normal, sizeof x->dir) != 0)
            faults |= FAULT_NOT_NORMAL;
        faults |= judge_witness(e, x, a, b, q);
        if (!(x->lower >= 0 && x->lower <= x->depth) || x->lower > t->depth + q->noise + gap)
            faults |= FAULT_FALSE_PROOF;
        /* supports counts pairs of calls, of which the last may lack one: for a position the objects are asked one by one */
        if (x->supports != (x->calls + 1) / 2)
            faults |= FAULT_MISCOUNTED;
    }
    if (x->has_pos && !x->has_proof)
        faults |= judge_position(e, x, a, b, q);
    /* h(dir) itself rounds by up to the noise, and a depth is never below 0 */
    if (!(fabs(x->depth - fmax(value, 0)) <= 2 * q->noise))
        faults |= x->depth < value ? FAULT_NOT_SUPPORT | FAULT_UNSOUND : FAULT_NOT_SUPPORT;
    if (entry_is_minimum(e)) {
        if (faults & (FAULT_OVER | FAULT_UNDER))
            faults |= FAULT_NOT_MINIMUM;
        const int at_limit = x->code == CCD_LIMIT || (!x->has_proof && x->calls / 2 >= MINIMUM_POINTS);
        const double within = q->surface == ALL_AROUND || at_limit ? fmax(q->tol, tolerance(TOL_MPR) * t->depth) : q->tol;
        if (!(x->depth <= fmax(t->depth, 0) + within + gap + 2 * q->noise))
            faults |= FAULT_NOT_MINIMUM;
        if (e->call == CALL_PROVEN && x->code == CCD_HIT
            && !(x->depth - x->lower <= q->tol + tolerance(TOL_PROOF_FLOOR) * largest_coordinate(a, b) + 2 * q->noise))
            faults |= FAULT_NO_PROOF;
    }
    if (e->call == CALL_PENETRATION && x->code == CCD_HIT
        && !(x->depth - x->lower <= fmax(q->tol, tolerance(TOL_MPR) * x->depth) + 2 * q->noise))
        faults |= FAULT_NO_PROOF;
    if (entry_is_mpr(e) && !mpr_within(x->depth, t->depth, q->tol, gap + 2 * q->noise, x->calls / 2))
        faults |= FAULT_NOT_PROMISED;
    if (e->call == CALL_ALONG && x->depth > fmax(t->depth, 0) + q->tol + gap + 2 * q->noise)
        faults |= FAULT_NOT_MINIMUM; /* asked along the true normal */
    return faults;
}

/* Prints the faults' names; returns how many. */
static inline int print_faults(FILE *file, int faults)
{
    int n = 0;
    for (int bit = 0; bit < FAULT_BIT_COUNT; bit++)
        if (faults >> bit & 1)
            fprintf(file, "%s%s", n++ ? ", " : "", fault_text(bit));
    return n;
}

static inline void print_answer(FILE *file, const answer_t *x)
{
    fprintf(file, "code %d depth %.17g dir %.17g %.17g %.17g pos %.9g %.9g %.9g calls %lu", x->code, x->depth,
            x->dir[0], x->dir[1], x->dir[2], x->pos[0], x->pos[1], x->pos[2], x->calls);
    if (x->has_proof)
        fprintf(file, " lower %.17g normal %.9g %.9g %.9g point1 %.9g %.9g %.9g point2 %.9g %.9g %.9g supports %lu",
                x->lower, x->normal[0], x->normal[1], x->normal[2], x->point1[0], x->point1[1], x->point1[2],
                x->point2[0], x->point2[1], x->point2[2], x->supports);
}

/* An answer that is wrong, on one line. */
static inline void print_faulty_answer(const entry_t *e, const answer_t *x, int faults, const truth_t *truth)
{
    printf("%s: ", e->name);
    print_faults(stdout, faults);
    printf(": ");
    print_answer(stdout, x);
    printf(", truth %.17g (lower %.17g) along %.17g %.17g %.17g\n", truth->depth, truth->lower, truth->n[0], truth->n[1], truth->n[2]);
}

/* A pair as C that makes it again. */
static inline void print_shape(FILE *file, const char *name, const shape_t *s)
{
    fprintf(file, "%s: type %d p %.17g %.17g %.17g tie %d pos %.17g %.17g %.17g rot", name, (int)s->type, (double)s->p[0],
            (double)s->p[1], (double)s->p[2], s->tie, (double)s->pos[0], (double)s->pos[1], (double)s->pos[2]);
    for (int i = 0; i < 9; i++)
        fprintf(file, " %.17g", (double)s->rot[i]);
    if (s->type == SHAPE_POLYTOPE) {
        fprintf(file, " verts %d", s->nverts);
        for (int i = 0; i < 3 * s->nverts && i < 3 * 16; i++)
            fprintf(file, " %.17g", (double)s->verts[i]);
    }
    fprintf(file, "\n");
}

#endif
