/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Bounds the depth of a pair given only support functions: every recorded support value
 * is an upper bound of the signed depth that needs no proof; the lower one is
 * that of ccdPenetrationProven, and a support value below it refutes the proof. An answer
 * that is too deep, or a hit of objects that are apart, is thus found without trusting either
 * library; one that is missed or unsound, by the proof. */

#define _GNU_SOURCE
#include "tools/compare/compare.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* The truth is bounded to this part of the query's tolerance. */
static const double TRUTH_REL_TOL = 0.01;

/* Callbacks may be wrong in the directions of a symmetry alone: ODE's cylinder within 1e-15 rad of its axis. If they
 * contradict each other, the truth is bounded once more, by samples of its own, whose directions are all tilted by this
 * angle, radians. It leaves an error of 1e-15 / tilt of a radius, so the bounds are farther apart. */
static const double TRUTH_TILT = 1e-8, TILTED_TRUTH_REL_TOL = 0.5;

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

/* Runs a request for the query's answer; returns how it ended. */
static guard_t request_answer(const compare_t *compare, judged_t *s, int side, answer_t *answer)
{
    request_t r = request_of(REQUEST_ANSWER, &compare->library[side], s->q, s->samples);
    const guard_t end = guard_run(request_run, &r);
    s->calls[side] = r.calls;
    *answer = r.answer;
    return end;
}

static int has_bounds(const request_t *minimum) { return minimum->code == CCD_HIT || minimum->code == CCD_LIMIT; }

/* --- the truth ---------------------------------------------------------------------- */

/* Returns the diagonal of the box of an object's support points; raises the largest coordinate. */
static double extent(const samples_t *samples, int which, double *largest)
{
    double diagonal2 = 0;
    for (int k = 0; k < 3; k++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int i = 0; i < samples->count[which]; i++) {
            const double x = (double)samples->sample[which][i].point.v[k];
            low = fmin(low, x);
            high = fmax(high, x);
            *largest = fmax(*largest, fabs(x));
        }
        diagonal2 += high > low ? (high - low) * (high - low) : 0;
    }
    return sqrt(diagonal2);
}

/* Returns a request for a part of the truth. */
static request_t truth_request(request_kind_t kind, const compare_t *compare, const judged_t *s, samples_t *samples)
{
    request_t r = request_of(kind, &compare->library[COMPARE_OURS], s->q, samples);
    r.tilt = s->tilt;
    r.tolerance = (s->tilt > 0 ? TILTED_TRUTH_REL_TOL : TRUTH_REL_TOL) * query_tolerance(s->q);
    return r;
}

/* Bounds the signed depth. Returns 0, or -1 where callbacks did not return. */
static int bound_truth(const compare_t *compare, judged_t *s)
{
    request_t r = truth_request(REQUEST_MINIMUM, compare, s, s->samples);
    double largest = 0, size[2];
    if (guard_run(request_run, &r) != GUARD_RETURNED)
        return -1;
    size[0] = extent(s->samples, 0, &largest);
    size[1] = extent(s->samples, 1, &largest);
    s->size = fmin(size[0], size[1]) > 0 ? fmin(size[0], size[1]) : fmax(size[0], size[1]);
    s->truth.tolerance = query_tolerance(s->q);
    s->truth.contact_eps = 1e-9 * fmax(size[0], size[1]) + 16 * DBL_EPSILON * largest;
    s->truth.lower = has_bounds(&r) ? (double)r.least.depth_lower : -HUGE_VAL;
    return r.code == CCD_BAD_INPUT || r.code == CCD_NO_MEMORY ? -1 : 0;
}

/* --- judging ------------------------------------------------------------------------ */

/* Returns by how much the points for other directions, or the centre, exceed the support value of this
 * sample: of a convex shape by rounding alone. */
static double inconsistency_at(const samples_t *samples, int which, const support_sample_t *p)
{
    const double length = sqrt((double)ccdVec3Len2(&p->dir)), h = (double)ccdVec3Dot(&p->dir, &p->point);
    double beyond = samples->has_centre[which] ? (double)ccdVec3Dot(&p->dir, &samples->centre[which]) - h : 0;
    for (int i = 0; i < samples->count[which] && beyond < HUGE_VAL; i++) {
        const double further = (double)ccdVec3Dot(&p->dir, &samples->sample[which][i].point) - h;
        beyond = further <= beyond ? beyond : further == further ? further : HUGE_VAL; /* NaN is no point */
    }
    return beyond / length;
}

/* Returns the largest inconsistency of the direction that gave the upper bound and of at most so
 * many other directions of each object. */
static double inconsistency(const samples_t *samples, int most)
{
    double largest = 0;
    for (int which = 0; which < 2; which++) {
        const int n = samples->count[which];
        for (int i = 0; i < n; i += (n + most - 1) / most)
            largest = fmax(largest, inconsistency_at(samples, which, &samples->sample[which][i]));
        if (samples->least < HUGE_VAL)
            largest = fmax(largest, inconsistency_at(samples, which, &samples->least_sample[which]));
    }
    return largest;
}

/* Directions that are checked of each query, and of a query with a wrong answer. */
enum { CHECKED = 64, ALL = MAX_SAMPLES };

/* Returns the inconsistency beyond which the callbacks describe no convex shapes. */
static double most_inconsistency(const judged_t *s) { return fmax(s->truth.tolerance, 10 * s->truth.contact_eps); }

/* Returns whether two numbers are equal, or one is NaN: no output of the program. */
static int same_number(ccd_real_t x, ccd_real_t y) { return x == y || x != x || y != y; }

static int same_answer(int call, const answer_t *a, const answer_t *b)
{
    if (a->code != b->code)
        return 0;
    if (!a->hit || is_intersect(call))
        return 1;
    return same_number(a->depth, b->depth) && same_number(a->dir.v[0], b->dir.v[0]) && same_number(a->dir.v[1], b->dir.v[1])
           && same_number(a->dir.v[2], b->dir.v[2]);
}

/* A hit by a call that returns the depth. */
static int has_depth(const query_t *q, const answer_t *a) { return a->hit && a->depth > 0 && !is_intersect(q->call); }

/* A depth may be enough along another direction than that of the answer: where that is not the
 * normal of a plane that separates the objects after the move, queries the moved obj2. */
static void check_move(const compare_t *compare, judged_t *s, int side)
{
    const verdict_truth_t *t = &s->truth;
    const answer_t *a = &s->answer[side];
    ccd_vec3_t shift = a->dir;
    request_t value = truth_request(REQUEST_VALUE, compare, s, s->samples);
    request_t moved = truth_request(REQUEST_MINIMUM, compare, s, NULL);
    value.dir = &a->dir;
    if (guard_run(request_run, &value) != GUARD_RETURNED || (double)a->depth >= value.value - t->tolerance - t->contact_eps)
        return;
    s->slanted[side] = 1;
    ccdVec3Scale(&shift, a->depth);
    moved.shift = &shift;
    if (guard_run(request_run, &moved) == GUARD_RETURNED && has_bounds(&moved)
        && (double)moved.least.depth_lower > 2 * t->tolerance + t->contact_eps) {
        s->aside[side] = 1;
        s->verdict[side] = VERDICT_UNSOUND;
    }
}

/* --- times -------------------------------------------------------------------------- */

enum { ROUNDS = 3 };

typedef struct {
    const compare_t *compare;
    const query_t *q;
    double least[COMPARE_SIDES]; /* nanoseconds */
} timing_t;

/* Measures the least of several rounds, in turn, so that both meet the same states of the machine.
 * Quick queries run several times in a row: reading the clock takes as long as one. */
static void measure_times(void *argument)
{
    timing_t *t = (timing_t *)argument;
    int times = 1;
    for (int round = 0; round < ROUNDS; round++) {
        for (int side = 0; side < COMPARE_SIDES; side++) {
            answer_t answer;
            const uint64_t start = clock_now(CLOCK_MONOTONIC);
            for (int i = 0; i < times; i++)
                query_library(&t->compare->library[side], t->q, &answer);
            t->least[side] = fmin(t->least[side], (double)(clock_now(CLOCK_MONOTONIC) - start) / times);
        }
        times = t->least[0] + t->least[1] < 20e3 ? 4 : 1;
    }
}

static void count_times(const compare_t *compare, const judged_t *s)
{
    compare_call_t *c = &compare->counts->call[s->q->call];
    timing_t t = {compare, s->q, {HUGE_VAL, HUGE_VAL}};
    if (guard_run(measure_times, &t) != GUARD_RETURNED)
        return;
    count_add(&c->timed, 1);
    for (int side = 0; side < COMPARE_SIDES; side++)
        count_add(&c->side[side].nanoseconds, (uint64_t)t.least[side]);
}

/* --- counting ----------------------------------------------------------------------- */

static const double PICO = 1e12;

static void count_side(compare_side_t *to, const judged_t *s, int side)
{
    const answer_t *a = &s->answer[side];
    const verdict_answer_t judged = { a->hit, has_depth(s->q, a), (double)a->depth, 1 };
    count_add(&to->verdict[s->verdict[side]], 1);
    count_add(&to->hits, (uint64_t)a->hit);
    count_add(&to->calls, s->calls[side]);
    count_add(&to->slanted, (uint64_t)s->slanted[side]);
    count_add(&to->aside, (uint64_t)s->aside[side]);
    if (judged.has_depth && verdict_has_error(&judged, s->verdict[side])) {
        const uint64_t error = (uint64_t)(PICO * fmin(verdict_error(&judged, &s->truth), 1e6));
        count_add(&to->with_error, 1);
        count_add(&to->error_sum, error);
        count_largest(&to->error_max, error);
    }
}

/* --- one query ---------------------------------------------------------------------- */

/* Requests both answers. Returns 0, or -1 where there is none, and counts the reason. */
static int request_answers(const compare_t *compare, judged_t *s, const answer_t *own)
{
    compare_call_t *c = &compare->counts->call[s->q->call];
    answer_t again;
    const int base = compare->base, other = 1 - base;
    const guard_t end = request_answer(compare, s, base, &s->answer[base]);
    const guard_t other_end = request_answer(compare, s, other, &s->answer[other]);
    const unsigned long calls = s->calls[base];
    if (end == GUARD_ENDED || other_end == GUARD_ENDED) {
        count_add(&c->endless, 1);
        return -1;
    }
    if (end != GUARD_RETURNED || other_end != GUARD_RETURNED) {
        count_add(&c->threw, 1);
        return -1;
    }
    /* Repeats the first request, to find whether the others have changed its answer. */
    if (request_answer(compare, s, base, &again) != GUARD_RETURNED || !same_answer(s->q->call, own, &s->answer[base])
        || !same_answer(s->q->call, own, &again))
        count_add(&c->memory, 1);
    s->calls[base] = calls;
    return 0;
}

/* How a judgement ended. */
typedef enum { JUDGED, NO_SHAPE, THREW } judgement_t;

/* Judges both answers; returns how many are wrong. */
static int judge_answers(const compare_t *compare, judged_t *s)
{
    int wrong = 0;
    for (int side = 0; side < COMPARE_SIDES; side++) {
        s->slanted[side] = s->aside[side] = 0;
        s->verdict[side] = answer_verdict(s->q, &s->answer[side], &s->truth);
        if (s->verdict[side] == VERDICT_RIGHT && has_depth(s->q, &s->answer[side]))
            check_move(compare, s, side);
        wrong += s->verdict[side] != VERDICT_RIGHT;
    }
    return wrong;
}

/* Bounds the truth and judges both answers. Where one is wrong all directions are checked: callbacks that contradict each
 * other describe no shape or, within the tolerance, make a touch uncertain by as much for each object. */
static judgement_t judge(const compare_t *compare, judged_t *s)
{
    compare_call_t *c = &compare->counts->call[s->q->call];
    if (bound_truth(compare, s) != 0)
        return THREW;
    s->truth.upper = s->samples->least;
    s->truth_dir = s->samples->least_dir;
    if (inconsistency(s->samples, CHECKED) > most_inconsistency(s))
        return NO_SHAPE;
    if (s->truth.lower > s->truth.upper + s->truth.contact_eps) {
        if (s->truth.lower > s->truth.upper + s->truth.contact_eps + 2 * inconsistency(s->samples, ALL)) {
            count_add(&c->contradicted, 1);
            s->truth.lower = -HUGE_VAL; /* the upper bound alone still judges */
        } else
            s->truth.lower = s->truth.upper;
    }
    const int wrong = judge_answers(compare, s);
    if (wrong) {
        const double uncertain = inconsistency(s->samples, ALL);
        if (uncertain > most_inconsistency(s))
            return NO_SHAPE;
        s->truth.contact_eps += 2 * uncertain;
        count_add(&c->uncertain, judge_answers(compare, s) < wrong);
    }
    return JUDGED;
}

/* Replaces the samples by those of the same directions, tilted. Returns 0, or -1 where callbacks did not return. */
static int tilt_samples(const compare_t *compare, judged_t *s)
{
    samples_t *const samples = s->samples, *before = (samples_t *)malloc(sizeof *before);
    int end = before ? 0 : -1;
    if (before)
        memcpy(before, samples, sizeof *before);
    samples->count[0] = samples->count[1] = 0;
    samples->least = HUGE_VAL;
    for (int which = 0; which < 2; which++)
        for (int i = 0; end == 0 && i < before->count[which]; i++) {
            ccd_vec3_t dir = before->sample[which][i].dir;
            request_t value = truth_request(REQUEST_VALUE, compare, s, samples);
            ccdVec3Scale(&dir, which ? -1 : 1);
            value.dir = &dir;
            end = guard_run(request_run, &value) == GUARD_RETURNED ? 0 : -1;
        }
    free(before);
    return end;
}

void judge_query(const compare_t *compare, const query_t *q, const answer_t *own)
{
    compare_call_t *c = &compare->counts->call[q->call];
    judged_t s;
    memset(&s, 0, sizeof s);
    s.q = q;
    s.samples = (samples_t *)calloc(1, sizeof *s.samples);
    if (!s.samples)
        return;
    s.samples->least = HUGE_VAL;
    ccdVec3Set(&s.samples->first_dir, 1, 0, 0); /* of calls that ask for none */
    count_add(&c->sampled, 1);
    judgement_t end = THREW;
    if (request_answers(compare, &s, own) == 0) {
        end = judge(compare, &s);
        if (end == NO_SHAPE) {
            s.tilt = TRUTH_TILT;
            end = tilt_samples(compare, &s) == 0 ? judge(compare, &s) : THREW;
        }
        count_add(&c->no_shape, end == NO_SHAPE);
        count_add(&c->threw, end == THREW);
    }
    if (end == JUDGED) {
        count_add(&c->judged, 1);
        count_add(&c->overlaps, s.truth.lower > s.truth.contact_eps);
        for (int side = 0; side < COMPARE_SIDES; side++)
            count_side(&c->side[side], &s, side);
        if (compare->timed)
            count_times(compare, &s);
        for (int side = 0; side < COMPARE_SIDES && compare->keep; side++)
            if (s.verdict[side] != VERDICT_RIGHT)
                save_case(compare, &s, side);
    }
    free(s.samples);
}
