/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A case is first made of the hulls of all points that the two support functions answered, and
 * of some hundred more, all around and near the directions that matter. The truth is then that
 * of these hulls. If the library's answer to them is wrong in the same way, that is the case;
 * else the answers themselves are played back, direction by direction. What shows the fault
 * neither way is not kept, as a depth that would do along another direction: it is counted alone. */

#define CASE_KEEPS
#include "compare/sample.h"
#include "compare/case.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { AROUND = 300, NEAR = 40, POINTS = SEEN };

static const char *const SIDE_NAME[COMPARE_SIDES] = { "libccd", "warmccd" };

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
    int i;
    for (i = 0; i < COMPARE_KEPT; i++)
        if (kept[i].used && kept[i].verdict == (uint64_t)verdict && fabs(score - kept[i].score) <= 0.1 * kept[i].score)
            return score > kept[i].score ? &kept[i] : NULL;
    for (i = 0; i < COMPARE_KEPT; i++) {
        if (!kept[i].used)
            return &kept[i];
        if (!least || kept[i].score < least->score)
            least = &kept[i];
    }
    return score > least->score ? least : NULL;
}

/* --- points ------------------------------------------------------------------------- */

typedef struct {
    const query_t *q;
    const sample_t *s;
    double point[2][POINTS][3];
    int count[2];
} points_t;

static void add_point(points_t *p, int which, const ccd_vec3_t *point)
{
    double x[3];
    int i;
    for (i = 0; i < 3; i++)
        x[i] = (double)point->v[i];
    for (i = 0; i < p->count[which]; i++)
        if (memcmp(p->point[which][i], x, sizeof x) == 0)
            return;
    if (p->count[which] < POINTS)
        memcpy(p->point[which][p->count[which]++], x, sizeof x);
}

static void ask_both(points_t *p, double x, double y, double z)
{
    const double length = sqrt(x * x + y * y + z * z);
    ccd_vec3_t dir, point;
    if (!(length > 0))
        return;
    ccdVec3Set(&dir, (ccd_real_t)(x / length), (ccd_real_t)(y / length), (ccd_real_t)(z / length));
    p->q->ccd->support1(p->q->obj[0], &dir, &point);
    add_point(p, 0, &point);
    ccdVec3Scale(&dir, -1);
    p->q->ccd->support2(p->q->obj[1], &dir, &point);
    add_point(p, 1, &point);
}

/* Evenly over the sphere: the golden angle on a spiral. Number i of n. */
static void spiral(int i, int n, double out[3])
{
    const double z = 1 - (2 * i + 1.0) / n, r = sqrt(1 - z * z), angle = 2.399963229728653 * i;
    out[0] = r * cos(angle);
    out[1] = r * sin(angle);
    out[2] = z;
}

static void ask_near(points_t *p, const ccd_vec3_t *dir, double width)
{
    int i;
    for (i = 0; i < NEAR; i++) {
        double d[3];
        spiral(i, NEAR, d);
        ask_both(p, (double)dir->v[0] + width * d[0], (double)dir->v[1] + width * d[1], (double)dir->v[2] + width * d[2]);
    }
}

static void work_points(void *argument)
{
    points_t *p = (points_t *)argument;
    const sample_t *s = p->s;
    int i, side;
    for (i = 0; i < 2 * s->seen->count[0] || i < 2 * s->seen->count[1]; i++)
        if (i / 2 < s->seen->count[i % 2])
            add_point(p, i % 2, &s->seen->point[i % 2][i / 2].point);
    for (i = 0; i < AROUND; i++) {
        double d[3];
        spiral(i, AROUND, d);
        ask_both(p, d[0], d[1], d[2]);
    }
    ask_near(p, &s->truth_dir, 0.1);
    ask_near(p, &s->truth_dir, 0.01);
    for (side = 0; side < COMPARE_SIDES; side++)
        if (s->answer[side].hit && isfinite((double)ccdVec3Len2(&s->answer[side].dir)))
            ask_near(p, &s->answer[side].dir, 0.05);
}

/* --- the case, and whether it shows the fault ------------------------------------------ */

/* Asks the library about the case; with hulls the truth is made anew. */
static int shows(const compare_t *compare, const sample_t *s, int side, case_t *c)
{
    case_object_t object[2];
    answer_t answer;
    asked_t asked;
    ccd_t ccd;
    const query_t q = { s->q->call, { &object[0], &object[1] }, &ccd };
    case_prepare(c, object, &ccd);
    if (sample_ask(&compare->library[side], &q, NULL, &asked, &answer) != GUARD_RETURNED)
        return 0;
    if (c->columns == 3) {
        seen_t *seen = (seen_t *)malloc(sizeof *seen);
        sample_t again;
        uint64_t calls;
        int bad, k;
        if (!seen)
            return 0;
        seen_clear(seen);
        bad = sample_truth(&compare->library[COMPARE_OURS], &q, seen, &again, &calls);
        free(seen);
        if (bad)
            return 0;
        c->truth = again.truth;
        for (k = 0; k < 3; k++)
            c->truth_dir[k] = (double)again.truth_dir.v[k];
    }
    return sample_verdict(&q, &answer, &c->truth) == s->verdict[side];
}

static void settings_of(const sample_t *s, case_t *c)
{
    int which, k;
    c->call = s->q->call;
    c->max_iterations = s->q->ccd->max_iterations;
    c->epa_tolerance = c->mpr_tolerance = s->truth.tolerance; /* the one that is read */
    c->truth = s->truth;
    c->centred = s->seen->centred[0] && s->seen->centred[1];
    for (k = 0; k < 3; k++) {
        c->truth_dir[k] = (double)s->truth_dir.v[k];
        c->first_dir[k] = s->seen->has_first_dir ? (double)s->seen->first_dir.v[k] : k == 0;
        for (which = 0; which < 2; which++)
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
    int i;
    for (i = 0; i < n; i++) {
        put_number(f, x[i]);
        fputs(i + 1 < n ? ", " : "", f);
    }
}

/* A header of these tests, without what it includes of them. */
static int put_source(FILE *f, const char *dir, const char *name)
{
    char path[4096], line[1024];
    FILE *in;
    snprintf(path, sizeof path, "%s/%s", dir, name);
    in = fopen(path, "r");
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
    int which, i;
    for (which = 0; which < 2; which++) {
        fprintf(f, "\nstatic const double numbers%d[] = {\n", which + 1);
        for (i = 0; i < c->rows[which]; i++) {
            fputs("    ", f);
            put_row(f, c->numbers[which] + c->columns * i, c->columns);
            fputs(",\n", f);
        }
        fputs("};\n", f);
    }
    fprintf(f, "\nstatic const case_t the_case = {\n    \"%s\",\n    %d, %d, {%d, %d}, {numbers1, numbers2},\n    %d, {{", c->title, c->call,
            c->columns, c->rows[0], c->rows[1], c->centred);
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
    put_row(f, &c->truth.touch, 1);
    fputs("},\n    {", f);
    put_row(f, c->truth_dir, 3);
    fputs("},\n};\n\nint main(void) { return case_run(&the_case); }\n", f);
}

static int write_case(const compare_t *compare, const case_t *c, const char *path)
{
    FILE *f = fopen(path, "w");
    int bad;
    if (!f)
        return -1;
    fprintf(f,
            "/* A wrong answer that compare.sh of warmccd kept: %s.\n"
            " *\n"
            " *   sh c-tests/replay.sh FILE                     on libccd and on warmccd\n"
            " *   cc FILE -lccd -lm && ./a.out                  on one; exit code 1: the answer is wrong\n"
            " *\n"
            " * The objects are %s; the numbers are at the end. */\n\n",
            c->title,
            c->columns == 3 ? "the hulls of points that their support functions answered"
                            : "what their support functions answered, direction by direction");
    bad = put_source(f, compare->case_source, "verdict.h") | put_source(f, compare->case_source, "compare/case.h");
    put_case(f, c);
    return fclose(f) | bad;
}

/* Both libraries may be wrong; of each COMPARE_KEPT cases are kept. */
static void make_case(const compare_t *compare, const sample_t *s, int side, compare_kept_t *place, double score)
{
    points_t *p = (points_t *)calloc(1, sizeof *p);
    char title[sizeof place->title], path[4096];
    case_t c;
    int which;
    if (!p)
        return;
    memset(&c, 0, sizeof c);
    p->q = s->q;
    p->s = s;
    settings_of(s, &c);
    snprintf(title, sizeof title, "%s of %s, %s: ", COMPARE_CALL_NAME[s->q->call], SIDE_NAME[side], VERDICT_NAME[s->verdict[side]]);
    if (s->answer[side].hit)
        snprintf(title + strlen(title), sizeof title - strlen(title), "depth %.6g, ", (double)s->answer[side].depth);
    snprintf(title + strlen(title), sizeof title - strlen(title), "the signed depth is at most %.6g", s->truth.upper);
    c.title = title;
    c.columns = 3;
    if (guard_run(work_points, p) != GUARD_RETURNED)
        p->count[0] = 0;
    for (which = 0; which < 2; which++) {
        c.rows[which] = p->count[which];
        c.numbers[which] = &p->point[which][0][0];
    }
    if (!c.rows[0] || !c.rows[1] || !shows(compare, s, side, &c)) {
        settings_of(s, &c);
        c.columns = 6;
        for (which = 0; which < 2; which++) {
            c.rows[which] = s->seen->count[which];
            c.numbers[which] = (const double *)s->seen->point[which];
        }
    }
    snprintf(path, sizeof path, "%s/.%ld-%d-%d.c", compare->keep, (long)compare->counts->process, side,
             (int)(place - compare->counts->kept[side]));
    if ((c.columns == 3 || shows(compare, s, side, &c)) && write_case(compare, &c, path) == 0) {
        place->used = 1;
        place->verdict = (uint64_t)s->verdict[side];
        place->score = score;
        memcpy(place->title, title, sizeof title);
    }
    free(p);
}

void keep_case(const compare_t *compare, const sample_t *s, int side)
{
    compare_counts_t *counts = compare->counts;
    const double score = score_of(s, side);
    compare_kept_t *place;
    /* One at a time; another thread's is let go rather than waited for, under a callback's lock */
    if (!(score >= 0) || !s->seen->count[0] || !s->seen->count[1] || __atomic_exchange_n(&counts->keeping, 1, __ATOMIC_ACQUIRE))
        return;
    place = place_for(counts->kept[side], s->verdict[side], score);
    if (place)
        make_case(compare, s, side, place, score);
    __atomic_store_n(&counts->keeping, 0, __ATOMIC_RELEASE);
}
