/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Calls any entry point of either library, and judges the answer by the exact truth. The
 * table of entry points is `entries`. An endless loop and a crash are answers too. */

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

/* --- calling ----------------------------------------------------------------- */

enum { /* the warm state of a call; of a distance, its arguments */
    STATE_NONE,    /* NULL */
    STATE_ZERO,    /* all bytes 0 */
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
} entry_t;

/* codes beside those of the libraries */
enum { ANSWER_LOOP = -100, ANSWER_CRASH = -101 };

typedef struct {
    int code;
    double depth, dir[3], pos[3];
    int has_pos, has_bounds;
    int wrote_outputs; /* though there was no answer */
    double lower, normal[3], point1[3], point2[3]; /* with has_bounds */
    double distance, margins, max_distance; /* of ccdSignedDistance, whose depth and lower are without margins */
    unsigned long calls;                    /* of both support functions */
    unsigned long supports;                 /* as reported, with has_bounds */
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
    {"MPR, again", 0, CALL_MPR_WARM, STATE_OWN},
    {"MPR, swapped state", 0, CALL_MPR_WARM, STATE_SWAPPED},
    {"MPR, opposite guess", 0, CALL_MPR_WARM, STATE_OPPOSITE_GUESS},
    {"MPR, tilted guess", 0, CALL_MPR_WARM, STATE_TILTED_GUESS},
    {"MPR intersect, again", 0, CALL_MPR_INTERSECT_WARM, STATE_OWN},
    {"penetration, again", 0, CALL_PENETRATION, STATE_OWN},
    {"local, again", 0, CALL_LOCAL, STATE_OWN},
    {"local, swapped state", 0, CALL_LOCAL, STATE_SWAPPED},
    {"local, opposite guess", 0, CALL_LOCAL, STATE_OPPOSITE_GUESS},
    {"local, tilted guess", 0, CALL_LOCAL, STATE_TILTED_GUESS},
    {"minimum, again", 0, CALL_PROVEN, STATE_OWN},
    {"minimum, opposite guess", 0, CALL_PROVEN, STATE_OPPOSITE_GUESS},
    {"minimum, tilted guess", 0, CALL_PROVEN, STATE_TILTED_GUESS},
    {"along, again", 0, CALL_ALONG, STATE_OWN},
    {"distance", 0, CALL_DISTANCE, STATE_NONE},
    {"distance, again", 0, CALL_DISTANCE, STATE_OWN},
    {"distance, opposite guess", 0, CALL_DISTANCE, STATE_OPPOSITE_GUESS},
    {"distance, margins", 0, CALL_DISTANCE, STATE_MARGINS},
    {"distance, max_distance", 0, CALL_DISTANCE, STATE_MAX_DISTANCE},
};
enum { ENTRIES = sizeof entries / sizeof entries[0] };

/* Returns whether the entry point is in this group: "compatible" (libccd's calls and the same with a
 * state), "local" or "proven" (the extension's calls with a lower bound that closes). NULL: any. */
static inline int entry_in(const entry_t *e, const char *group)
{
    const int is_proven = e->call == CALL_PROVEN || e->call == CALL_ALONG || e->call == CALL_DISTANCE;
    return !group || strcmp(group, e->call == CALL_LOCAL ? "local" : is_proven ? "proven" : "compatible") == 0;
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
    return entry_is_mpr(e) ? 2 * 400 : 2 * 500;
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

/* Calls the entry point for two shapes, from the state that it names. normal: the true one, which wrong
 * guesses are made of; the direction of "along". */
static inline answer_t call_entry(const entry_t *e, const shape_t *a, const shape_t *b, double tol, const double normal[3])
{
    const ccd_t ccd = counting_query(tol);
    const unsigned long limit = call_limit(e);
    shape_t sa = *a, sb = *b;
    ccd_warm_t warm;
    ccd_vec3_t along, guess;
    memset(&warm, 0, sizeof warm);
    margin_size = pair_size(a, b);
    for (int i = 0; i < 3; i++) {
        along.v[i] = (ccd_real_t)normal[i];
        guess.v[i] = (ccd_real_t)(e->state == STATE_TILTED_GUESS ? normal[(i + 1) % 3] : -normal[i]);
    }
    if (e->state == STATE_OPPOSITE_GUESS || e->state == STATE_TILTED_GUESS)
        OURS(ccdWarmGuess)(&warm, &guess);
    if (e->state == STATE_OWN)
        call_guarded(e, &sa, &sb, &ccd, &warm, &along, limit);
    if (e->state == STATE_SWAPPED)
        call_guarded(e, &sb, &sa, &ccd, &warm, &along, limit);
    return call_guarded(e, &sa, &sb, &ccd, e->state == STATE_NONE || e->state >= STATE_MARGINS ? NULL : &warm, &along, limit);
}

/* --- judging ------------------------------------------------------------------ */

/* Faults of an answer: up to DIR_BAD those of the rate table, the same for both libraries; then
 * breaches of what this library guarantees. */
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
    X(NOT_MPR_MINIMUM, "deeper than MPR guarantees") \
    X(FALSE_PROOF, "lower bound above the truth") \
    X(NO_PROOF, "gap above tolerance") \
    X(LIMIT, "stopped at the cap") \
    X(WITNESS_DEPTH, "witness points not the depth apart") \
    X(WITNESS_PLANE, "witness points off the supporting planes") \
    X(WITNESS_INSIDE, "witness points outside the shapes") \
    X(WITNESS_ACROSS, "witness points apart across the normal") \
    X(POSITION, "position not between the witness points") \
    X(MISCOUNTED, "supports miscounted") \
    X(WROTE_OUTPUTS, "outputs written without an answer") \
    X(TAIL, "too many support points")

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
    FAULTS_FORBIDDEN = ~(FAULT_MISS_SHALLOW | FAULT_OVER | FAULT_UNDER | FAULT_ZERO | FAULT_DIR_BAD | FAULT_TAIL)
};

/* Value of criteria_t.surface: nearly every direction is a minimum, so no proof ends and MPR's tolerance holds. */
enum { ALL_AROUND = 2 };

/* The criteria by which an answer about a pair is judged. */
typedef struct {
    double size, noise; /* metres; noise: the rounding error of a depth */
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

/* Returns how far a point may be off: as far as the depth may be, and where an open gap between the
 * bounds is allowed, by that. */
static inline double point_tolerance(const entry_t *e, const answer_t *x, const criteria_t *q)
{
    const double allowed = entry_is_mpr(e) ? fmax(q->tol, tolerance(TOL_MPR) * x->depth) : q->tol;
    const double reached = x->code == CCD_LIMIT || e->call == CALL_PROVEN ? fmax(allowed, x->depth - x->lower) : allowed;
    return reached + q->noise + tolerance(TOL_WITNESS) * q->size;
}

/* Returns the signed distance of a point from the shape's supporting plane along the unit vector n. */
static inline double distance_from_plane(const shape_t *s, const double n[3], const double point[3])
{
    double origin[3], relative[3], support[3];
    for (int i = 0; i < 3; i++) {
        origin[i] = (double)s->pos[i];
        relative[i] = point[i] - origin[i];
    }
    truth_support(s, origin, n, support);
    return truth_dot3(relative, n) - truth_dot3(support, n);
}

/* Returns whether a point is farther than this outside of the shape, by 26 supporting planes. */
static inline int is_outside(const shape_t *s, const double point[3], double bound)
{
    int outside = 0;
    for (int i = 0; i < 27; i++) {
        double n[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}, l = sqrt(truth_dot3(n, n));
        for (int k = 0; k < 3; k++)
            n[k] /= l;
        outside |= l > 0 && !(distance_from_plane(s, n, point) <= bound);
    }
    return outside;
}

/* pos is within half the depth of both shapes, and a hair: in a shape thinner than the depth the middle
 * of the chord is outside. */
static inline int judge_position(const entry_t *e, const answer_t *x, const shape_t *a, const shape_t *b, const criteria_t *q)
{
    const double bound = point_tolerance(e, x, q) + (0.5 + 1.0 / 256) * x->depth;
    return is_outside(a, x->pos, bound) || is_outside(b, x->pos, bound) ? FAULT_POSITION : 0;
}

static inline int judge_unit(const double n[3])
{
    return fabs(sqrt(truth_dot3(n, n)) - 1) <= tolerance(TOL_UNIT_LENGTH) ? 0 : FAULT_NOT_UNIT;
}

/* Witness points: each in its shape and at its supporting plane, their difference the depth; pos their
 * middle where no centre of pressure is guaranteed. */
static inline int judge_witness(const entry_t *e, const answer_t *x, const shape_t *a, const shape_t *b, const criteria_t *q)
{
    const double bound = point_tolerance(e, x, q), value = x->depth * truth_dot3(x->dir, x->normal);
    const int has_centre = x->code == CCD_HIT && e->call != CALL_ALONG && e->call != CALL_PLANAR;
    double d[3], m[3], across2 = 0;
    int faults = has_centre ? judge_position(e, x, a, b, q) : 0;
    for (int i = 0; i < 3; i++) {
        m[i] = -x->normal[i];
        d[i] = x->point1[i] - x->point2[i];
        across2 += (d[i] - x->depth * x->dir[i]) * (d[i] - x->depth * x->dir[i]);
        if (!has_centre && !(fabs(x->point1[i] - d[i] / 2 - x->pos[i]) <= q->noise))
            faults |= FAULT_POSITION;
    }
    if (!(fabs(truth_dot3(d, x->normal) - value) <= bound))
        faults |= FAULT_WITNESS_DEPTH;
    across2 -= pow(truth_dot3(d, x->normal) - value, 2);
    if (!(sqrt(fmax(across2, 0)) <= sqrt(2 * (x->depth + bound) * bound) + bound))
        faults |= FAULT_WITNESS_ACROSS;
    if (!(distance_from_plane(a, x->normal, x->point1) >= -bound) || !(distance_from_plane(b, m, x->point2) >= -bound))
        faults |= FAULT_WITNESS_PLANE;
    if (is_outside(a, x->point1, bound) || is_outside(b, x->point2, bound))
        faults |= FAULT_WITNESS_INSIDE;
    return faults;
}

enum {
    MPR_POINTS = 160,    /* support points after which a depth of MPR is only within TOL_MPR_CAPPED */
    MINIMUM_POINTS = 340 /* support points after which a minimum is given up: the compatible calls cannot report it */
};

static inline int is_mpr_minimum(double depth, double least, double tol, double noise, unsigned long supports)
{
    const double part = tolerance(supports >= MPR_POINTS ? TOL_MPR_CAPPED : TOL_MPR);
    return depth <= fmax(least, 0) + fmax(tol, part * fmax(least, 0)) + noise;
}

/* Judges a signed distance: its sign agrees with the code, the plane is at the reported distance, the bounds
 * enclose the truth and close up to max_distance, and the points are in the objects; those of a gap are its upper
 * bound apart. If minima form a surface, the distance at the iteration limit must still be right. */
static inline int judge_distance(const entry_t *e, const answer_t *x, const shape_t *a, const shape_t *b, const criteria_t *q)
{
    const truth_t *t = &q->truth;
    const double rounding = 2 * q->noise + t->depth - t->lower, floor = tolerance(TOL_PROOF_FLOOR) * largest_coordinate(a, b);
    const double within = x->code == CCD_LIMIT ? fmax(q->tol, tolerance(TOL_MPR) * fabs(t->depth)) : q->tol;
    const double bound = point_tolerance(e, x, q) + x->margins;
    double apart2 = 0;
    int faults = 0;
    if (!x->has_bounds)
        return FAULT_CODE;
    if (x->code == CCD_LIMIT && !q->surface)
        faults |= FAULT_LIMIT;
    if (!isfinite(x->depth) || !isfinite(x->lower) || !isfinite(truth_dot3(x->normal, x->normal)))
        return faults | FAULT_NAN;
    faults |= judge_unit(x->normal);
    if ((x->code != CCD_LIMIT && (x->code == CCD_HIT) != (x->distance < 0)) || (x->distance == 0 && signbit(x->distance)))
        faults |= FAULT_CODE;
    if (x->depth < truth_support_value(a, b, x->normal) - 2 * q->noise)
        faults |= FAULT_UNSOUND;
    if (x->lower > x->depth || x->lower > t->depth + rounding)
        faults |= FAULT_FALSE_PROOF;
    if (x->code != CCD_LIMIT && x->distance <= x->max_distance && x->depth - x->lower > q->tol + floor + 2 * q->noise)
        faults |= FAULT_NO_PROOF;
    if (x->distance <= x->max_distance && x->depth > t->depth + within + rounding)
        faults |= FAULT_NOT_MINIMUM;
    if (is_outside(a, x->point1, bound) || is_outside(b, x->point2, bound))
        faults |= FAULT_WITNESS_INSIDE;
    for (int i = 0; i < 3; i++)
        apart2 += (x->point1[i] - x->point2[i]) * (x->point1[i] - x->point2[i]);
    if (x->distance > 0 && !(fabs(sqrt(apart2) + x->lower + x->margins) <= 2 * q->noise + tolerance(TOL_WITNESS) * q->size))
        faults |= FAULT_WITNESS_DEPTH;
    return faults;
}

/* The faults of the rate table in a depth. value: h of the answer's direction. */
static inline int judge_rates(const answer_t *x, double value, const criteria_t *q)
{
    const truth_t *t = &q->truth;
    const double within = q->noise
        + fmin(tolerance(TOL_TABLE) * fmax(t->depth, 0) + 2 * q->tol, tolerance(TOL_TABLE_CAP) * q->size);
    int faults = 0;
    if (x->depth > t->depth + within)
        faults |= FAULT_OVER;
    if (x->depth < t->lower - within)
        faults |= FAULT_UNDER;
    if (x->depth < tolerance(TOL_TABLE) * t->lower - q->noise)
        faults |= FAULT_ZERO;
    if (x->depth < value - within)
        faults |= FAULT_UNSOUND;
    if (value > t->depth + within)
        faults |= FAULT_DIR_BAD;
    return faults;
}

/* Breaches of what this library guarantees for a depth. */
static inline int judge_guarantees(const entry_t *e, const answer_t *x, double value, const shape_t *a, const shape_t *b,
                                   const criteria_t *q)
{
    const truth_t *t = &q->truth;
    const double open = t->depth - t->lower, floor = tolerance(TOL_PROOF_FLOOR) * largest_coordinate(a, b);
    const double noise = open + 2 * q->noise, least = fmax(t->depth, 0);
    int faults = 0;
    if (x->has_bounds) {
        faults |= judge_unit(x->normal) | judge_witness(e, x, a, b, q);
        if (!(truth_dot3(x->dir, x->normal) > 0))
            faults |= FAULT_NOT_UNIT;
        if (e->call != CALL_ALONG && memcmp(x->dir, x->normal, sizeof x->dir) != 0)
            faults |= FAULT_NOT_NORMAL;
        if (!(x->lower >= 0 && x->lower <= x->depth) || x->lower > t->depth + q->noise + open)
            faults |= FAULT_FALSE_PROOF;
        /* pairs of calls, the last of which may lack one: a position queries one object at a time */
        if (x->supports != (x->calls + 1) / 2)
            faults |= FAULT_MISCOUNTED;
    } else if (x->has_pos) {
        faults |= judge_position(e, x, a, b, q);
    }
    /* h(dir) itself rounds by up to the noise, and a depth is never below 0 */
    if (!(fabs(x->depth - fmax(value, 0)) <= 2 * q->noise))
        faults |= x->depth < value ? FAULT_NOT_SUPPORT | FAULT_UNSOUND : FAULT_NOT_SUPPORT;
    if (entry_is_minimum(e)) {
        const int at_limit = x->code == CCD_LIMIT || (!x->has_bounds && x->calls / 2 >= MINIMUM_POINTS);
        const double within = q->surface == ALL_AROUND || at_limit ? fmax(q->tol, tolerance(TOL_MPR) * t->depth) : q->tol;
        if (!(x->depth <= least + within + noise))
            faults |= FAULT_NOT_MINIMUM;
    }
    if (x->code == CCD_HIT
        && ((e->call == CALL_PROVEN && !(x->depth - x->lower <= q->tol + floor + 2 * q->noise))
            || (e->call == CALL_PENETRATION
                && !(x->depth - x->lower <= fmax(q->tol, tolerance(TOL_MPR) * x->depth) + 2 * q->noise))))
        faults |= FAULT_NO_PROOF;
    if (entry_is_mpr(e) && !is_mpr_minimum(x->depth, t->depth, q->tol, noise, x->calls / 2))
        faults |= FAULT_NOT_MPR_MINIMUM;
    if (e->call == CALL_ALONG && x->depth > least + q->tol + noise)
        faults |= FAULT_NOT_MINIMUM; /* the direction is the true normal */
    return faults;
}

/* Returns all faults of an answer. */
static inline int judge(const entry_t *e, const answer_t *x, const shape_t *a, const shape_t *b, const criteria_t *q)
{
    const truth_t *t = &q->truth;
    double value;
    int faults = 0, is_finite;
    if (x->code == ANSWER_LOOP)
        return FAULT_LOOP;
    if (x->code == ANSWER_CRASH)
        return FAULT_CRASH;
    if (e->call == CALL_DISTANCE)
        return judge_distance(e, x, a, b, q);
    if (x->wrote_outputs)
        faults |= FAULT_WROTE_OUTPUTS;
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
    if (x->code == CCD_LIMIT && !x->has_bounds)
        faults |= FAULT_CODE;
    /* ccdPenetration gives up after 160 support points */
    if (x->code == CCD_LIMIT && !q->surface && !(e->call == CALL_PENETRATION && x->calls >= 2 * MPR_POINTS))
        faults |= FAULT_LIMIT;
    if (t->depth < -q->noise && !q->touching)
        return faults | FAULT_FALSE_HIT;
    if (entry_is_boolean(e))
        return faults;
    if (e->call == CALL_SEPARATE && x->depth == 0)
        return faults | (t->depth > q->tol + q->noise ? FAULT_ZERO | FAULT_UNSOUND : 0);

    is_finite = isfinite(x->depth);
    for (int i = 0; i < 3; i++)
        is_finite = is_finite && isfinite(x->dir[i]) && (!x->has_pos || isfinite(x->pos[i]));
    if (!is_finite)
        return faults | FAULT_NAN;
    if (truth_dot3(x->dir, x->dir) == 0)
        return faults | FAULT_DIR0;
    if (e->call != CALL_SEPARATE)
        faults |= judge_unit(x->dir);
    /* along a direction that is not the normal the plane is farther */
    value = x->has_bounds ? truth_support_value(a, b, x->normal) / truth_dot3(x->dir, x->normal)
                          : truth_support_value(a, b, x->dir);
    faults |= judge_rates(x, value, q);
    if (e->is_libccd)
        return faults;
    if (entry_is_minimum(e) && faults & (FAULT_OVER | FAULT_UNDER))
        faults |= FAULT_NOT_MINIMUM;
    return faults | judge_guarantees(e, x, value, a, b, q);
}

/* Prints the faults' names. */
static inline void print_faults(int faults)
{
    int n = 0;
    for (int bit = 0; bit < FAULT_BIT_COUNT; bit++)
        if (faults >> bit & 1)
            printf("%s%s", n++ ? ", " : "", fault_text(bit));
}

static inline void print_answer(const answer_t *x)
{
    printf("code %d depth %.17g dir %.17g %.17g %.17g pos %.9g %.9g %.9g calls %lu", x->code, x->depth,
            x->dir[0], x->dir[1], x->dir[2], x->pos[0], x->pos[1], x->pos[2], x->calls);
    if (x->has_bounds)
        printf(" lower %.17g normal %.9g %.9g %.9g point1 %.9g %.9g %.9g point2 %.9g %.9g %.9g supports %lu",
                x->lower, x->normal[0], x->normal[1], x->normal[2], x->point1[0], x->point1[1], x->point1[2],
                x->point2[0], x->point2[1], x->point2[2], x->supports);
}

/* Prints a faulty answer on one line. */
static inline void print_faulty_answer(const entry_t *e, const answer_t *x, int faults, const truth_t *truth)
{
    printf("%s: ", e->name);
    print_faults(faults);
    printf(": ");
    print_answer(x);
    printf(", truth %.17g (lower %.17g) along %.17g %.17g %.17g\n", truth->depth, truth->lower, truth->n[0], truth->n[1],
           truth->n[2]);
}

/* Prints everything that makes the shape again. */
static inline void print_shape(const char *name, const shape_t *s)
{
    printf("%s: type %d p %.17g %.17g %.17g tie %d pos %.17g %.17g %.17g rot", name, (int)s->type, (double)s->p[0],
            (double)s->p[1], (double)s->p[2], s->tie, (double)s->pos[0], (double)s->pos[1], (double)s->pos[2]);
    for (int i = 0; i < 9; i++)
        printf(" %.17g", (double)s->rot[i]);
    if (s->type == SHAPE_POLYTOPE) {
        printf(" verts %d", s->nverts);
        for (int i = 0; i < 3 * s->nverts; i++)
            printf(" %.17g", (double)s->verts[i]);
    }
    printf("\n");
}

#endif
