/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Promises of this library, one by one, and whether it is known to break them. A
 * promise that is broken and not marked so fails the test; one that is marked and
 * holds fails it too, so that the mark goes when the fault does. */

#ifndef STABILITY_KNOWN_H
#define STABILITY_KNOWN_H

#include "categories.h"

typedef struct {
    const char *id, *what;
    int (*holds)(int which); /* prints its figures on the line that the id began */
    int which;
    int known; /* known to be broken */
} promise_t;

/* The part of its depth, or of the tolerance, by which an answer of ccdMPRPenetration
 * may be above the least depth; MPR_POINTS support points later it is only LATE. */
enum { MPR_POINTS = 160 };

static inline int mpr_within(double depth, double least, double tol, double noise, unsigned long supports)
{
    least = fmax(least, 0);
    return depth <= least + fmax(tol, tolerance(TOL_PROMISED) * least) + noise
        || (supports >= MPR_POINTS && depth <= least + fmax(tol, tolerance(TOL_LATE) * least) + noise);
}

static inline unsigned long answer_supports(const answer_t *x) { return x->calls / 2; }

/* Runs those whose id begins with only (NULL: all). Returns how many surprise. */
static inline int promises_run(const promise_t *p, int n, const char *only)
{
    int i, broken = 0, surprises = 0;
    judge_begin();
    for (i = 0; i < n; i++) {
        int holds;
        if (only && strncmp(p[i].id, only, strlen(only)) != 0)
            continue;
        printf("%-6s%s: ", p[i].id, p[i].what);
        fflush(stdout);
        holds = p[i].holds(p[i].which);
        broken += !holds;
        surprises += holds == p[i].known;
        printf(" -- %s\n", holds ? p[i].known ? "FAILED: holds, and is marked as known to be broken" : "holds"
                                 : p[i].known ? "broken, as known" : "FAILED");
    }
    printf("%d promises, %d broken, %d not as marked\n", n, broken, surprises);
    return surprises;
}

#endif
