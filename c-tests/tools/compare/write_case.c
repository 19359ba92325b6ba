/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A case is all that the two support functions answered, direction by direction: asked again it
 * is played back, and a direction that was not asked is answered by the farthest of those points.
 * Their hull lies within the object and has the points that bound its depth from both sides, so
 * that its truth is the object's. What does not show the fault again is not kept, as a depth that
 * would do along another direction: it is counted alone. */

#define CASE_KEEPS
#include "tools/compare/judge_query.h"
#include "tools/compare/replay_case.h"

#include <string.h>

/* --- how wrong ---------------------------------------------------------------------- */

/* Metres off, a metre of the smaller object. A touch without a direction is hardly wrong. */
static double score_of(const sample_t *s, int side)
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

/* Where the case goes: an empty place, that of a case like it, or that of the least wrong;
 * NULL where none is to be had. Frame after frame a resting pair is wrong in the same way. */
static compare_kept_t *place_for(compare_kept_t *kept, int verdict, double score)
{
    compare_kept_t *least = NULL;
    for (int i = 0; i < COMPARE_KEPT; i++)
        if (kept[i].used && kept[i].verdict == (uint64_t)verdict && fabs(score - kept[i].score) <= 0.1 * kept[i].score)
            return score > kept[i].score ? &kept[i] : NULL;
    for (int i = 0; i < COMPARE_KEPT; i++) {
        if (!kept[i].used)
            return &kept[i];
        if (!least || kept[i].score < least->score)
            least = &kept[i];
    }
    return score > least->score ? least : NULL;
}

/* --- the case, and whether it shows the fault ------------------------------------------ */

/* Whether the library, asked about the case, is wrong in the same way. */
static int shows(const compare_t *compare, const sample_t *s, int side, const case_t *c)
{
    case_object_t object[2];
    answer_t answer;
    asked_t asked;
    ccd_t ccd;
    const query_t q = { s->q->call, { &object[0], &object[1] }, &ccd };
    case_prepare(c, object, &ccd);
    return sample_ask(&compare->library[side], &q, NULL, &asked, &answer) == GUARD_RETURNED
           && sample_verdict(&q, &answer, &c->truth) == s->verdict[side];
}

static void case_of(const sample_t *s, case_t *c)
{
    memset(c, 0, sizeof *c);
    c->call = s->q->call;
    c->max_iterations = s->q->ccd->max_iterations;
    c->epa_tolerance = c->mpr_tolerance = s->truth.tolerance; /* the one that is read */
    c->truth = s->truth;
    c->centred = s->seen->centred[0] && s->seen->centred[1];
    for (int which = 0; which < 2; which++) {
        c->rows[which] = s->seen->count[which];
        c->numbers[which] = (const double *)s->seen->point[which];
    }
    for (int k = 0; k < 3; k++) {
        c->truth_dir[k] = (double)s->truth_dir.v[k];
        c->first_dir[k] = s->seen->has_first_dir ? (double)s->seen->first_dir.v[k] : k == 0;
        for (int which = 0; which < 2; which++)
            c->centre[which][k] = c->centred ? (double)s->seen->centre[which].v[k] : 0;
    }
}

/* --- writing ------------------------------------------------------------------------- */

/* Numbers that C reads back as they are. */
static void put_number(FILE *f, double x)
{
    if (x == HUGE_VAL || x == -HUGE_VAL)
        fprintf(f, "%sHUGE_VAL", x < 0 ? "-" : "");
    else if (x != x)
        fputs("NAN", f);
    else
        fprintf(f, "%.17g", x);
}

static void put_row(FILE *f, const double *x, int n)
{
    for (int i = 0; i < n; i++) {
        put_number(f, x[i]);
        fputs(i + 1 < n ? ", " : "", f);
    }
}

/* A header of these tests, without what it includes of them. */
static int put_source(FILE *f, const char *dir, const char *name)
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

static void put_case(FILE *f, const case_t *c)
{
    for (int which = 0; which < 2; which++) {
        fprintf(f, "\nstatic const double numbers%d[] = {\n", which + 1);
        for (int i = 0; i < c->rows[which]; i++) {
            fputs("    ", f);
            put_row(f, c->numbers[which] + 6 * i, 6);
            fputs(",\n", f);
        }
        fputs("};\n", f);
    }
    fprintf(f, "\nstatic const case_t the_case = {\n    \"%s\",\n    %d, {%d, %d}, {numbers1, numbers2},\n    %d, {{", c->title, c->call,
            c->rows[0], c->rows[1], c->centred);
    put_row(f, c->centre[0], 3);
    fputs("}, {", f);
    put_row(f, c->centre[1], 3);
    fputs("}}, {", f);
    put_row(f, c->first_dir, 3);
    fprintf(f, "},\n    %luul, ", c->max_iterations & 0xffffffff);
    put_number(f, c->epa_tolerance);
    fputs(", ", f);
    put_number(f, c->mpr_tolerance);
    fputs(",\n    {", f);
    put_row(f, &c->truth.lower, 1);
    fputs(", ", f);
    put_row(f, &c->truth.upper, 1);
    fputs(", ", f);
    put_row(f, &c->truth.tolerance, 1);
    fputs(", ", f);
    put_row(f, &c->truth.contact_eps, 1);
    fputs("},\n    {", f);
    put_row(f, c->truth_dir, 3);
    fputs("},\n};\n\nint main(void) { return case_run(&the_case); }\n", f);
}

static int write_case(const compare_t *compare, const case_t *c, const char *path)
{
    FILE *f = fopen(path, "w");
    if (!f)
        return -1;
    fprintf(f,
            "/* A wrong answer that compare.sh of warmccd kept: %s.\n"
            " *\n"
            " *   sh c-tests/replay.sh FILE                     on libccd and on warmccd\n"
            " *   cc FILE -lccd -lm && ./a.out                  on one; exit code 1: the answer is wrong\n"
            " *\n"
            " * The objects are what their support functions answered, direction by direction, at the end. */\n\n",
            c->title);
    int bad = put_source(f, compare->case_source, "harness/verdict.h") | put_source(f, compare->case_source, "tools/compare/replay_case.h");
    put_case(f, c);
    return fclose(f) | bad;
}

/* Both libraries may be wrong; of each COMPARE_KEPT cases are kept. */
static void make_case(const compare_t *compare, const sample_t *s, int side, compare_kept_t *place, double score)
{
    char title[sizeof place->title], path[4096];
    case_t c;
    case_of(s, &c);
    snprintf(title, sizeof title, "%s of %s, %s: ", call_table[s->q->call].name, COMPARE_SIDE_NAME[side], VERDICT_NAME[s->verdict[side]]);
    if (s->answer[side].hit)
        snprintf(title + strlen(title), sizeof title - strlen(title), "depth %.6g, ", (double)s->answer[side].depth);
    snprintf(title + strlen(title), sizeof title - strlen(title), "the signed depth is at most %.6g", s->truth.upper);
    c.title = title;
    snprintf(path, sizeof path, "%s/%s-%d.c", compare->keep, COMPARE_SIDE_NAME[side], (int)(place - compare->counts->kept[side]) + 1);
    if (shows(compare, s, side, &c) && write_case(compare, &c, path) == 0) {
        place->used = 1;
        place->verdict = (uint64_t)s->verdict[side];
        place->score = score;
        memcpy(place->title, title, sizeof title);
    }
}

void keep_case(const compare_t *compare, const sample_t *s, int side)
{
    compare_counts_t *counts = compare->counts;
    const double score = score_of(s, side);
    /* One at a time; another thread's is let go rather than waited for, under a callback's lock */
    if (!(score >= 0) || !s->seen->count[0] || !s->seen->count[1] || __atomic_exchange_n(&counts->keeping, 1, __ATOMIC_ACQUIRE))
        return;
    compare_kept_t *place = place_for(counts->kept[side], s->verdict[side], score);
    if (place)
        make_case(compare, s, side, place, score);
    __atomic_store_n(&counts->keeping, 0, __ATOMIC_RELEASE);
}
