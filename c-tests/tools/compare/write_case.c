/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Writes the worst answer of each kind of either library as a case (case.h). A fault that the case does not show again is
 * not written, such as a depth that would be enough along another direction: it is counted alone. */

#include "tools/compare/case.h"

#include <stdio.h>

/* Returns the error in metres, a metre of the smaller object. A touch without a direction is hardly wrong. */
static double score_of(const judged_t *s, int side)
{
    const double depth = (double)s->answer[side].depth, upper = s->truth.upper, lower = s->truth.lower;
    double off = 0;
    switch (s->verdict[side]) {
    case VERDICT_MISSED: off = lower; break;
    case VERDICT_SPURIOUS: off = -upper; break;
    case VERDICT_DEEP: off = depth - upper; break;
    case VERDICT_UNSOUND: off = depth < lower ? lower - depth : lower; break;
    default: off = fmax(upper, 0); break;
    }
    return s->size > 0 ? off / s->size : off;
}

/* Of the query, as a file keeps it. */
static unsigned long max_iterations(const judged_t *s) { return s->q->ccd->max_iterations & 0xffffffff; }

/* Returns whether the library's answer to the case is wrong in the same way. */
static int shows_fault(const compare_t *compare, const judged_t *s, int side)
{
    case_object_t object[2];
    ccd_t ccd;
    const query_t q = {s->q->call, {&object[0], &object[1]}, &ccd};
    request_t r = request_of(REQUEST_ANSWER, &compare->library[side], &q, NULL);
    case_prepare(s->samples, max_iterations(s), s->truth.tolerance, object, &ccd);
    return guard_run(request_run, &r) == GUARD_RETURNED && answer_verdict(&q, &r.answer, &s->truth) == s->verdict[side];
}

static void write_vectors(FILE *f, const ccd_vec3_t *v, int n)
{
    for (int i = 0; i < n; i++)
        fprintf(f, "%.17g %.17g %.17g%s", (double)v[i].v[0], (double)v[i].v[1], (double)v[i].v[2], i + 1 < n ? " " : "\n");
}

static int write_case(const judged_t *s, const char *title, const char *path)
{
    const samples_t *samples = s->samples;
    FILE *f = fopen(path, "w");
    if (!f)
        return -1;
    fprintf(f, "%s\n%d %lu\n", title, s->q->call, max_iterations(s));
    fprintf(f, "%.17g %.17g %.17g %.17g ", s->truth.lower, s->truth.upper, s->truth.tolerance, s->truth.contact_eps);
    write_vectors(f, &s->truth_dir, 1);
    for (int which = 0; which < 2; which++) {
        fprintf(f, "%d %d ", samples->has_centre[which], samples->count[which]);
        write_vectors(f, &samples->centre[which], 1);
    }
    write_vectors(f, &samples->first_dir, 1);
    for (int which = 0; which < 2; which++)
        for (int i = 0; i < samples->count[which]; i++)
            write_vectors(f, (const ccd_vec3_t *)&samples->sample[which][i], 2);
    return fclose(f);
}

static void save_in(const compare_t *compare, const judged_t *s, int side, saved_case_t *slot, double score)
{
    char title[sizeof slot->title], path[4096], depth[32] = "";
    if (s->answer[side].hit)
        snprintf(depth, sizeof depth, "depth %.6g, ", (double)s->answer[side].depth);
    snprintf(title, sizeof title, "%s of %s, %s: %sthe signed depth is at most %.6g", call_table[s->q->call].name,
             COMPARE_SIDE_NAME[side], VERDICT_NAME[s->verdict[side]], depth, s->truth.upper);
    snprintf(path, sizeof path, CASE_PATH, compare->keep, COMPARE_SIDE_NAME[side], CASE_NAME[s->verdict[side]]);
    if (shows_fault(compare, s, side) && write_case(s, title, path) == 0) {
        slot->used = 1;
        slot->score = score;
        memcpy(slot->title, title, sizeof title);
    }
}

void save_case(const compare_t *compare, const judged_t *s, int side)
{
    compare_counts_t *counts = compare->counts;
    const double score = score_of(s, side);
    /* One at a time; another thread's case is dropped rather than waited for, under a callback's lock */
    if (!(score >= 0) || !s->samples->count[0] || !s->samples->count[1]
        || __atomic_exchange_n(&counts->saving, 1, __ATOMIC_ACQUIRE))
        return;
    saved_case_t *slot = &counts->saved[side][s->verdict[side]];
    if (!slot->used || score > slot->score)
        save_in(compare, s, side, slot, score);
    __atomic_store_n(&counts->saving, 0, __ATOMIC_RELEASE);
}
