/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The truth about a pair of which only support functions are known: every support value seen,
 * whoever asked, is an upper bound of the signed depth that needs no proof; the lower one is
 * that of ccdPenetrationProven, and a support value below it convicts the proof. An answer
 * that is too deep, or a hit of objects that are apart, is thus told without trusting either
 * library; that one is missed or unsound, by the proof. */

#define _GNU_SOURCE
#include "tools/compare/judge_query.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* The truth is bounded to this part of the query's tolerance. */
static const double FINER = 0.01;

void count_add(uint64_t *to, uint64_t n)
{
    if (n)
        __atomic_fetch_add(to, n, __ATOMIC_RELAXED);
}

static void count_largest(uint64_t *to, uint64_t n)
{
    uint64_t old = __atomic_load_n(to, __ATOMIC_RELAXED);
    while (old < n && !__atomic_compare_exchange_n(to, &old, n, 1, __ATOMIC_RELAXED, __ATOMIC_RELAXED))
        ;
}

uint64_t clock_now(clockid_t id)
{
    struct timespec t;
    clock_gettime(id, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

void seen_clear(seen_t *seen)
{
    seen->count[0] = seen->count[1] = 0;
    seen->centred[0] = seen->centred[1] = seen->has_first_dir = 0;
    seen->least = HUGE_VAL;
}

/* --- asking, guarded ---------------------------------------------------------------- */

typedef struct {
    const library_t *library;
    const query_t *q;
    asked_t *asked;
    answer_t *answer;
    double tolerance, value;
    ccd_penetration_t least;
    int code;
} work_t;

static work_t work_on(const library_t *library, const query_t *q, asked_t *asked, answer_t *answer)
{
    work_t w;
    memset(&w, 0, sizeof w);
    w.library = library;
    w.q = q;
    w.asked = asked;
    w.answer = answer;
    w.tolerance = FINER * query_tolerance(q);
    return w;
}

static asked_t asked_for(seen_t *seen)
{
    asked_t asked;
    memset(&asked, 0, sizeof asked);
    asked.seen = seen;
    asked.most = ENDLESS;
    return asked;
}

static void work_watched(void *argument)
{
    work_t *w = (work_t *)argument;
    ask_watched(w->library, w->q, w->asked, w->answer);
}

guard_t sample_ask(const library_t *library, const query_t *q, seen_t *seen, asked_t *asked, answer_t *answer)
{
    work_t w = work_on(library, q, asked, answer);
    *asked = asked_for(seen);
    return guard_run(work_watched, &w);
}

static void work_minimum(void *argument)
{
    work_t *w = (work_t *)argument;
    w->code = ask_minimum(w->library, w->q, w->tolerance, w->asked, &w->least);
}

static void work_value(void *argument)
{
    work_t *w = (work_t *)argument;
    w->value = ask_value(w->q, w->asked, &w->answer->dir);
}

static double extent(const seen_t *seen, int which, double *largest)
{
    double diagonal2 = 0;
    for (int k = 0; k < 3; k++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int i = 0; i < seen->count[which]; i++) {
            const double x = (double)seen->point[which][i].point.v[k];
            low = fmin(low, x);
            high = fmax(high, x);
            *largest = fmax(*largest, fabs(x));
        }
        diagonal2 += high > low ? (high - low) * (high - low) : 0;
    }
    return sqrt(diagonal2);
}

int sample_truth(const library_t *ours, const query_t *q, seen_t *seen, sample_t *s, uint64_t *calls)
{
    asked_t asked = asked_for(seen);
    work_t w = work_on(ours, q, &asked, NULL);
    double largest = 0, size[2];
    if (guard_run(work_minimum, &w) != GUARD_RETURNED)
        return -1;
    *calls = asked.calls;
    size[0] = extent(seen, 0, &largest);
    size[1] = extent(seen, 1, &largest);
    s->size = fmin(size[0], size[1]) > 0 ? fmin(size[0], size[1]) : fmax(size[0], size[1]);
    s->truth.tolerance = query_tolerance(q);
    s->truth.contact_eps = 1e-9 * fmax(size[0], size[1]) + 16 * DBL_EPSILON * largest;
    s->truth.lower = w.code == CCD_HIT || w.code == CCD_LIMIT ? (double)w.least.depth_lower : -HUGE_VAL;
    s->truth.upper = seen->least;
    s->truth_dir = seen->least_dir;
    return w.code == CCD_BAD_INPUT || w.code == CCD_NO_MEMORY ? -1 : 0;
}

/* --- judging ------------------------------------------------------------------------ */

verdict_t sample_verdict(const query_t *q, const answer_t *answer, const verdict_truth_t *truth)
{
    verdict_answer_t a = { answer->hit, 1, (double)answer->depth, (double)ccdVec3Len2(&answer->dir) };
    a.has_depth = !is_verdict(q->call);
    if (q->call == CALL_SEPARATE && answer->depth == 0)
        a.length2 = 1; /* a vector of no length has no direction */
    return verdict(&a, truth);
}

/* Returns how far the points answered for other directions, or the centre, are beyond the point
 * answered for this one: of a convex shape nothing but rounding. */
static double inconsistency_at(const seen_t *seen, int which, const seen_point_t *p)
{
    const double length = sqrt((double)ccdVec3Len2(&p->dir)), h = (double)ccdVec3Dot(&p->dir, &p->point);
    double beyond = seen->centred[which] ? (double)ccdVec3Dot(&p->dir, &seen->centre[which]) - h : 0;
    for (int i = 0; i < seen->count[which] && beyond < HUGE_VAL; i++) {
        const double further = (double)ccdVec3Dot(&p->dir, &seen->point[which][i].point) - h;
        beyond = further <= beyond ? beyond : further == further ? further : HUGE_VAL; /* NaN is no point */
    }
    return beyond / length;
}

/* Returns the largest inconsistency of the direction that gave the upper bound and of at most so
 * many other directions of each object. */
static double inconsistency(const seen_t *seen, int most)
{
    double largest = 0;
    for (int which = 0; which < 2; which++) {
        const int n = seen->count[which];
        for (int i = 0; i < n; i += (n + most - 1) / most)
            largest = fmax(largest, inconsistency_at(seen, which, &seen->point[which][i]));
        if (seen->least < HUGE_VAL)
            largest = fmax(largest, inconsistency_at(seen, which, &seen->least_point[which]));
    }
    return largest;
}

/* Directions that are checked of each query, and of a query with a wrong answer: all. */
enum { CHECKED = 64, ALL = SEEN };

/* Whether the callbacks describe convex shapes: what is within the tolerance changes no verdict. */
static int is_shape(const sample_t *s, int most)
{
    return inconsistency(s->seen, most) <= fmax(s->truth.tolerance, 10 * s->truth.contact_eps);
}

static int same_answer(int call, const answer_t *a, const answer_t *b)
{
    if (a->code != b->code)
        return 0;
    if (!a->hit || is_verdict(call))
        return 1;
    /* bits: what is NaN in one alone was not asked for */
    return (a->depth == b->depth || a->depth != a->depth || b->depth != b->depth)
           && ((a->dir.v[0] == b->dir.v[0] && a->dir.v[1] == b->dir.v[1] && a->dir.v[2] == b->dir.v[2]) || a->dir.v[0] != a->dir.v[0]
               || b->dir.v[0] != b->dir.v[0]);
}

int sample_has_depth(const query_t *q, const answer_t *a)
{
    return a->hit && a->depth > 0 && !is_verdict(q->call);
}

/* An answer that is deep enough may still point elsewhere: where its direction is not the
 * normal of a plane that the move brings apart, the moved obj2 is asked about. */
static void check_move(const compare_t *compare, sample_t *s, int side)
{
    const verdict_truth_t *t = &s->truth;
    answer_t *a = &s->answer[side];
    ccd_vec3_t shift = a->dir;
    asked_t asked = asked_for(s->seen);
    work_t w = work_on(&compare->library[COMPARE_OURS], s->q, &asked, a);
    if (guard_run(work_value, &w) != GUARD_RETURNED || (double)a->depth >= w.value - t->tolerance - t->contact_eps)
        return;
    s->slanted[side] = 1;
    ccdVec3Scale(&shift, a->depth);
    asked.seen = NULL; /* of another pose */
    asked.shift = &shift;
    if (guard_run(work_minimum, &w) == GUARD_RETURNED && (w.code == CCD_HIT || w.code == CCD_LIMIT)
        && (double)w.least.depth_lower > 2 * t->tolerance + t->contact_eps) {
        s->aside[side] = 1;
        s->verdict[side] = VERDICT_UNSOUND;
    }
}

/* --- what it costs ------------------------------------------------------------------ */

enum { ROUNDS = 3, PAIRS = 8 };

enum { TIME_MINIMUM = COMPARE_SIDES, TIME_CALLBACKS, TIMES };

typedef struct {
    const compare_t *compare;
    const query_t *q;
    const seen_t *seen;
    double least[TIMES]; /* nanoseconds of one: of either library, of the proven minimum, of PAIRS support points */
} timing_t;

static void ask_timed(const timing_t *t, int what)
{
    const library_t *const library = t->compare->library;
    const query_t *q = t->q;
    if (what < COMPARE_SIDES) {
        answer_t answer;
        ask_plainly(&library[what], q, &answer);
    } else if (what == TIME_MINIMUM) {
        ccd_penetration_t out;
        ccd_t ccd = *q->ccd;
        ccd.epa_tolerance = (ccd_real_t)query_tolerance(q);
        library[COMPARE_OURS].minimum(q->obj[0], q->obj[1], &ccd, NULL, CCD_WANT_POS, &out);
    } else {
        /* in the directions that the queries asked */
        ccd_vec3_t point;
        for (int i = 0; i < PAIRS; i++) {
            q->ccd->support1(q->obj[0], &t->seen->point[0][i % t->seen->count[0]].dir, &point);
            q->ccd->support2(q->obj[1], &t->seen->point[1][i % t->seen->count[1]].dir, &point);
        }
    }
}

/* The least of several rounds, in turn, so that all meet the same moments of the machine.
 * Quick queries are asked several times in a row: the clock is as slow as they are. */
static void work_timing(void *argument)
{
    timing_t *t = (timing_t *)argument;
    int times = 1;
    for (int what = 0; what < TIMES; what++)
        t->least[what] = HUGE_VAL;
    for (int round = 0; round < ROUNDS; round++) {
        for (int what = 0; what < TIMES; what++) {
            const uint64_t start = clock_now(CLOCK_MONOTONIC);
            for (int i = 0; i < times; i++)
                ask_timed(t, what);
            t->least[what] = fmin(t->least[what], (double)(clock_now(CLOCK_MONOTONIC) - start) / times);
        }
        times = t->least[0] + t->least[1] < 20e3 ? 4 : 1;
    }
}

static void take_times(const compare_t *compare, const sample_t *s)
{
    compare_call_t *c = &compare->counts->call[s->q->call];
    timing_t t;
    t.compare = compare;
    t.q = s->q;
    t.seen = s->seen;
    if (!s->seen->count[0] || !s->seen->count[1] || guard_run(work_timing, &t) != GUARD_RETURNED)
        return;
    count_add(&c->timed, 1);
    for (int side = 0; side < COMPARE_SIDES; side++)
        count_add(&c->side[side].nanoseconds, (uint64_t)t.least[side]);
    count_add(&c->minimum_nanoseconds, (uint64_t)t.least[TIME_MINIMUM]);
    count_add(&compare->counts->callback_pairs, PAIRS);
    count_add(&compare->counts->callback_nanoseconds, (uint64_t)t.least[TIME_CALLBACKS]);
}

/* --- counting ----------------------------------------------------------------------- */

static const double PICO = 1e12;

static void count_side(compare_side_t *to, const sample_t *s, int side)
{
    const answer_t *a = &s->answer[side];
    const verdict_answer_t judged = { a->hit, sample_has_depth(s->q, a), (double)a->depth, 1 };
    count_add(&to->verdict[s->verdict[side]], 1);
    count_add(&to->hits, (uint64_t)a->hit);
    count_add(&to->calls, s->asked[side].calls);
    count_add(&to->slanted, (uint64_t)s->slanted[side]);
    count_add(&to->aside, (uint64_t)s->aside[side]);
    if (judged.has_depth && verdict_has_error(&judged, s->verdict[side])) {
        const uint64_t error = (uint64_t)(PICO * fmin(verdict_error(&judged, &s->truth), 1e6));
        count_add(&to->with_error, 1);
        count_add(&to->error_sum, error);
        count_largest(&to->error_max, error);
    }
}

static void count_change(compare_call_t *to, const sample_t *s)
{
    const answer_t *theirs = &s->answer[COMPARE_THEIRS], *ours = &s->answer[COMPARE_OURS];
    count_add(&to->found, ours->hit && !theirs->hit);
    count_add(&to->gone, theirs->hit && !ours->hit);
    if (sample_has_depth(s->q, theirs) && sample_has_depth(s->q, ours)) {
        count_add(&to->both, 1);
        count_add(&to->deeper, theirs->depth > (ccd_real_t)1.01 * ours->depth);
        count_add(&to->turned, !((double)ccdVec3Dot(&theirs->dir, &ours->dir) > 0.9848)); /* the cosine of 10 degrees */
    }
}

/* --- one query ---------------------------------------------------------------------- */

/* Asks all; returns 0 where the query can be judged, and counts why where not. */
static int ask_all(const compare_t *compare, sample_t *s, const answer_t *own)
{
    compare_call_t *c = &compare->counts->call[s->q->call];
    answer_t again;
    guard_t how[COMPARE_SIDES];
    const int base = compare->base, other = 1 - base;
    asked_t unused;
    how[base] = sample_ask(&compare->library[base], s->q, s->seen, &s->asked[base], &s->answer[base]);
    how[other] = sample_ask(&compare->library[other], s->q, s->seen, &s->asked[other], &s->answer[other]);
    if (how[base] == GUARD_ENDED || how[other] == GUARD_ENDED) {
        count_add(&c->endless, 1);
        return -1;
    }
    if (how[base] != GUARD_RETURNED || how[other] != GUARD_RETURNED
        || sample_truth(&compare->library[COMPARE_OURS], s->q, s->seen, s, &s->minimum_calls) != 0) {
        count_add(&c->threw, 1);
        return -1;
    }
    /* Once more: what all these questions have changed. */
    if (sample_ask(&compare->library[base], s->q, s->seen, &unused, &again) != GUARD_RETURNED || !same_answer(s->q->call, own, &s->answer[base])
        || !same_answer(s->q->call, own, &again))
        count_add(&c->memory, 1);
    s->truth.upper = s->seen->least;
    s->truth_dir = s->seen->least_dir;
    if (!is_shape(s, CHECKED)) {
        count_add(&c->no_shape, 1);
        return -1;
    }
    if (s->truth.lower > s->truth.upper + s->truth.contact_eps) {
        if (s->truth.lower > s->truth.upper + s->truth.contact_eps + 2 * inconsistency(s->seen, ALL)) {
            count_add(&c->contradicted, 1);
            s->truth.lower = -HUGE_VAL; /* what rests on the upper bound alone is judged all the same */
        } else
            s->truth.lower = s->truth.upper;
    }
    return 0;
}

/* Judges both answers. Returns 0, or -1 where one is wrong and the callbacks, checked in full, are
 * to blame; that is counted. */
static int judge(const compare_t *compare, sample_t *s)
{
    int wrong = 0;
    for (int side = 0; side < COMPARE_SIDES; side++) {
        s->verdict[side] = sample_verdict(s->q, &s->answer[side], &s->truth);
        if (s->verdict[side] == VERDICT_RIGHT && sample_has_depth(s->q, &s->answer[side]))
            check_move(compare, s, side);
        wrong |= s->verdict[side] != VERDICT_RIGHT;
    }
    if (wrong && !is_shape(s, ALL)) {
        count_add(&compare->counts->call[s->q->call].no_shape, 1);
        return -1;
    }
    return 0;
}

void sample_query(const compare_t *compare, const query_t *q, const answer_t *own)
{
    compare_call_t *c = &compare->counts->call[q->call];
    sample_t s;
    memset(&s, 0, sizeof s);
    s.q = q;
    s.seen = (seen_t *)malloc(sizeof *s.seen);
    if (!s.seen)
        return;
    seen_clear(s.seen);
    count_add(&c->sampled, 1);
    if (ask_all(compare, &s, own) == 0 && judge(compare, &s) == 0) {
        count_add(&c->judged, 1);
        count_add(&c->minimum_calls, s.minimum_calls);
        count_add(&c->overlaps, s.truth.lower > s.truth.contact_eps);
        for (int side = 0; side < COMPARE_SIDES; side++)
            count_side(&c->side[side], &s, side);
        count_change(c, &s);
        if (compare->timed)
            take_times(compare, &s);
        for (int side = 0; side < COMPARE_SIDES && compare->keep; side++)
            if (s.verdict[side] != VERDICT_RIGHT)
                keep_case(compare, &s, side);
    }
    free(s.seen);
}
