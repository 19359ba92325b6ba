/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A case is all support samples of a query. Replayed, a sampled direction is answered with its
 * point, any other with the farthest of all points.
 * Their hull lies within the object and has the points that bound its depth from both sides, so
 * that its truth is the object's. A fault that the case does not show again is not written, such as a depth
 * that would be enough along another direction: it is counted alone. */

#define CASE_WRITER
#include "tools/compare/compare.h"
#include "tools/compare/replay_case.h"

#include <float.h>
#include <string.h>

/* --- how wrong ---------------------------------------------------------------------- */

/* Error in metres, a metre of the smaller object. A touch without a direction is hardly wrong. */
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

/* Returns the slot of the case: a free one, that of a similar case, or that of the least wrong;
 * NULL if it is less wrong than those. Frame after frame a resting pair is wrong in the same way. */
static saved_case_t *find_slot(saved_case_t *saved, int verdict, double score)
{
    saved_case_t *least = NULL;
    for (int i = 0; i < MAX_SAVED; i++)
        if (saved[i].used && saved[i].verdict == (uint64_t)verdict && fabs(score - saved[i].score) <= 0.1 * saved[i].score)
            return score > saved[i].score ? &saved[i] : NULL;
    for (int i = 0; i < MAX_SAVED; i++) {
        if (!saved[i].used)
            return &saved[i];
        if (!least || saved[i].score < least->score)
            least = &saved[i];
    }
    return score > least->score ? least : NULL;
}

/* --- the case ------------------------------------------------------------------------ */

/* Returns whether the library's answer to the case is wrong in the same way. */
static int shows_fault(const compare_t *compare, const judged_t *s, int side, const case_t *c)
{
    case_object_t object[2];
    ccd_t ccd;
    const query_t q = { s->q->call, { &object[0], &object[1] }, &ccd };
    request_t r;
    case_prepare(c, object, &ccd);
    r = request_of(REQUEST_ANSWER, &compare->library[side], &q, NULL);
    return guard_run(request_run, &r) == GUARD_RETURNED && answer_verdict(&q, &r.answer, &c->truth) == s->verdict[side];
}

static case_t make_case(const judged_t *s)
{
    const samples_t *samples = s->samples;
    case_t c;
    memset(&c, 0, sizeof c);
    c.call = s->q->call;
    c.max_iterations = s->q->ccd->max_iterations & 0xffffffff;
    c.truth = s->truth;
    c.truth.lower = fmax(c.truth.lower, -DBL_MAX); /* C has no literal of infinity */
    c.truth.upper = fmin(c.truth.upper, DBL_MAX);
    c.has_centres = samples->has_centre[0] && samples->has_centre[1];
    for (int which = 0; which < 2; which++) {
        c.count[which] = samples->count[which];
        c.samples[which] = (const double *)samples->sample[which];
    }
    for (int k = 0; k < 3; k++) {
        c.truth_dir[k] = (double)s->truth_dir.v[k];
        c.first_dir[k] = samples->has_first_dir ? (double)samples->first_dir.v[k] : k == 0;
        for (int which = 0; which < 2; which++)
            c.centre[which][k] = c.has_centres ? (double)samples->centre[which].v[k] : 0;
    }
    return c;
}

/* --- writing ------------------------------------------------------------------------- */

/* Copies a header of these tests, without its includes of others. */
static int copy_header(FILE *f, const char *dir, const char *name)
{
    char path[4096], line[1024];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    FILE *in = fopen(path, "r");
    if (!in)
        return -1;
    while (fgets(line, sizeof line, in))
        if (strncmp(line, "#include \"", 10) != 0 && !strstr(line, "SPDX"))
            fputs(line, f);
    fclose(in);
    return 0;
}

/* Numbers that C reads back as they are. */
#define VECTOR "{%.17g, %.17g, %.17g}"
#define COMPONENTS(v) (v)[0], (v)[1], (v)[2]

static void write_numbers(FILE *f, const case_t *c)
{
    const verdict_truth_t *t = &c->truth;
    for (int which = 0; which < 2; which++) {
        fprintf(f, "\nstatic const double samples%d[] = {\n", which + 1);
        for (int i = 0; i < 2 * c->count[which]; i++) {
            const double *v = c->samples[which] + 3 * i;
            fprintf(f, "%s%.17g, %.17g, %.17g,%s", i % 2 ? "" : "    ", COMPONENTS(v), i % 2 ? "\n" : " ");
        }
        fputs("};\n", f);
    }
    fprintf(f, "\nstatic const case_t the_case = {\n    \"%s\",\n", c->title);
    fprintf(f, "    %d, {%d, %d}, {samples1, samples2},\n    %d, ", c->call, c->count[0], c->count[1], c->has_centres);
    fprintf(f, "{" VECTOR ", " VECTOR "}, ", COMPONENTS(c->centre[0]), COMPONENTS(c->centre[1]));
    fprintf(f, VECTOR ",\n    %luul,\n", COMPONENTS(c->first_dir), c->max_iterations);
    fprintf(f, "    {%.17g, %.17g, %.17g, %.17g}, ", t->lower, t->upper, t->tolerance, t->contact_eps);
    fprintf(f, VECTOR ",\n};\n", COMPONENTS(c->truth_dir));
    fputs("\nint main(void) { return case_run(&the_case); }\n", f);
}

static int write_case(const compare_t *compare, const case_t *c, const char *path)
{
    FILE *f = fopen(path, "w");
    if (!f)
        return -1;
    fprintf(f,
            "/* A wrong answer, written by compare.sh of warmccd: %s.\n"
            " *\n"
            " *   sh c-tests/replay.sh FILE                     on libccd and on warmccd\n"
            " *   cc FILE -lccd -lm && ./a.out                  on one; exit code 1: the answer is wrong\n"
            " *\n"
            " * The objects are the points that their support functions returned, direction by direction, at the end. */\n\n",
            c->title);
    int bad = copy_header(f, compare->case_source, "harness/verdict.h");
    bad |= copy_header(f, compare->case_source, "tools/compare/replay_case.h");
    write_numbers(f, c);
    return fclose(f) | bad;
}

static void save_in(const compare_t *compare, const judged_t *s, int side, saved_case_t *slot, double score)
{
    char title[sizeof slot->title], path[4096], depth[32] = "";
    case_t c = make_case(s);
    if (s->answer[side].hit)
        snprintf(depth, sizeof depth, "depth %.6g, ", (double)s->answer[side].depth);
    snprintf(title, sizeof title, "%s of %s, %s: %sthe signed depth is at most %.6g", call_table[s->q->call].name,
             COMPARE_SIDE_NAME[side], VERDICT_NAME[s->verdict[side]], depth, s->truth.upper);
    c.title = title;
    snprintf(path, sizeof path, "%s/%s-%d.c", compare->keep, COMPARE_SIDE_NAME[side],
             (int)(slot - compare->counts->saved[side]) + 1);
    if (shows_fault(compare, s, side, &c) && write_case(compare, &c, path) == 0) {
        slot->used = 1;
        slot->verdict = (uint64_t)s->verdict[side];
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
    saved_case_t *slot = find_slot(counts->saved[side], s->verdict[side], score);
    if (slot)
        save_in(compare, s, side, slot, score);
    __atomic_store_n(&counts->saving, 0, __ATOMIC_RELEASE);
}
