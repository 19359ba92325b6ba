/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Judges one answer about a pair, given bounds on its signed depth. The recorded
 * contacts (tools/record/replay.c), the tool (tools/compare/) and the cases that it writes are judged by this. */

#ifndef TESTS_VERDICT_H
#define TESTS_VERDICT_H

#include <math.h>

typedef enum {
    VERDICT_RIGHT,
    VERDICT_MISSED,   /* a miss of objects that overlap */
    VERDICT_SPURIOUS, /* a hit of objects that are apart */
    VERDICT_INVALID,   /* a direction that is not unit, a depth that is negative or no number */
    VERDICT_DEEP,     /* more than 1 % and two tolerances deeper than the least depth */
    VERDICT_UNSOUND,  /* moving obj2 by depth * dir leaves them overlapping */
    VERDICTS
} verdict_t;

/* Programs use a part of this file. */
#define VERDICT_UNUSED __attribute__((unused))

VERDICT_UNUSED static const char *const VERDICT_NAME[VERDICTS] = {"right",        "overlap missed", "false hit",
                                                                  "no direction", "too deep",       "unsound"};

/* Metres. The signed depth: positive overlapping, negative the gap. */
typedef struct {
    double lower, upper;
    double tolerance; /* of the query */
    double contact_eps; /* of depths and gaps within this both hit and miss are right */
} verdict_truth_t;

/* An answer; booleans have neither depth nor direction. */
typedef struct {
    int hit, has_depth;
    double depth, length2; /* square of the direction's length */
} verdict_answer_t;

VERDICT_UNUSED static inline verdict_t verdict(const verdict_answer_t *answer, const verdict_truth_t *truth)
{
    if (!answer->hit)
        return truth->lower > truth->contact_eps ? VERDICT_MISSED : VERDICT_RIGHT;
    if (truth->upper < -truth->contact_eps)
        return VERDICT_SPURIOUS;
    if (!answer->has_depth)
        return VERDICT_RIGHT;
    /* negated: NaN is broken */
    if (!(fabs(answer->length2 - 1) < 1e-6) || !(answer->depth >= 0 && answer->depth < HUGE_VAL))
        return VERDICT_INVALID;
    if (answer->depth > 1.01 * truth->upper + 2 * truth->tolerance)
        return VERDICT_DEEP;
    return answer->depth < truth->lower - 2 * truth->tolerance ? VERDICT_UNSOUND : VERDICT_RIGHT;
}

/* Returns whether the depth can be compared with the truth: of a true hit, and a number. */
VERDICT_UNUSED static inline int verdict_has_error(const verdict_answer_t *answer, verdict_t v)
{
    return answer->hit && answer->has_depth && v != VERDICT_SPURIOUS && v != VERDICT_INVALID;
}

/* Returns how far the depth is off the bounds, metres. */
VERDICT_UNUSED static inline double verdict_error(const verdict_answer_t *answer, const verdict_truth_t *truth)
{
    if (answer->depth > truth->upper)
        return answer->depth - truth->upper;
    return answer->depth < truth->lower ? truth->lower - answer->depth : 0;
}

#endif
