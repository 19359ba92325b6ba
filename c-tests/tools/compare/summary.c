/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Prints the counts of all processes at the end of a run.
 *
 * usage: screen DIR EVERY EXIT SAVED LIMIT   the screen; SAVED: the folder of wrong answers, or empty; LIMIT: seconds, or 0
 *        screen DIR fields                   `counted key value key value ...`, for the tables of engines/
 *        screen DIR libccd                   the path of the libccd that was compared with
 * DIR/runs has a line for each run of the program alone: its library, exit code, nanoseconds. */

#include "tools/compare/counts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double PICO = 1e-12;

static compare_counts_t all;

/* Both consist of 64-bit numbers; only the largest error is no sum. */
static void add_call(compare_call_t *to, const compare_call_t *from)
{
    uint64_t most[COMPARE_SIDES];
    for (size_t i = 0; i < COMPARE_SIDES; i++)
        most[i] = to->side[i].error_max > from->side[i].error_max ? to->side[i].error_max : from->side[i].error_max;
    for (size_t i = 0; i < sizeof *to / sizeof(uint64_t); i++)
        ((uint64_t *)to)[i] += ((const uint64_t *)from)[i];
    for (size_t i = 0; i < COMPARE_SIDES; i++)
        to->side[i].error_max = most[i];
}

static double part(uint64_t n, uint64_t of) { return of ? (double)n / (double)of : 0; }

/* Returns memory for a short text, which lasts for the next seven. */
static char *short_text(void)
{
    static char text[8][48];
    static int next;
    return text[next++ % 8];
}

static const char *thousands(uint64_t n)
{
    char *out = short_text() + 47;
    int digits = 0;
    *out = '\0';
    do {
        if (digits && digits % 3 == 0)
            *--out = ',';
        *--out = (char)('0' + n % 10);
        digits++;
    } while (n /= 10);
    return out;
}

/* Returns a length with a unit that a person reads, right-aligned. */
static const char *length_text(double picometres, int width)
{
    static const struct {
        double size;
        const char *name;
    } unit[] = {{1e15, "km"}, {1e12, "m"}, {1e9, "mm"}, {1e6, "µm"}, {1e3, "nm"}, {1, "pm"}};
    size_t i = 0;
    char number[24], *out = short_text();
    if (picometres <= 0)
        snprintf(number, sizeof number, "0");
    else {
        while (i < 5 && picometres < 0.9995 * unit[i].size)
            i++;
        const double value = picometres / unit[i].size;
        snprintf(number, sizeof number, "%.*f %s", value < 9.995 ? 2 : value < 99.95 ? 1 : 0, value, unit[i].name);
    }
    const int letters = (int)strlen(number) - (strstr(number, "µ") != NULL); /* of two bytes */
    snprintf(out, 48, "%*s%s", letters < width ? width - letters : 0, "", number);
    return out;
}

/* --- the parts of the screen ---------------------------------------------------------- */

static void print_calls(compare_call_t *sum)
{
    printf("%-20s %12s %8s %12s %10s\n", "call", "queries", "hits", "judged", "overlaps");
    for (int i = 0; i < LIBCCD_CALL_COUNT; i++) {
        const compare_call_t *c = &all.call[i];
        if (!c->queries)
            continue;
        printf("%-20s %12s %6.1f %% %12s %10s\n", call_table[i].name, thousands(c->queries), 100 * part(c->hits, c->returned),
               thousands(c->judged), thousands(c->overlaps));
        add_call(sum, c);
    }
    if (all.raw_supports)
        printf("%-20s %12s   support points of another algorithm, not judged (FCL's own GJK and EPA)\n", "__ccdSupport",
               thousands(all.raw_supports));
    if (sum->broken)
        printf("%s of all %s hits, judged or not, had no unit direction (zero, NaN) or no finite depth: %s's. ODE ends there.\n",
               thousands(sum->broken), thousands(sum->hits), all.base == COMPARE_THEIRS ? "libccd" : "this library");
    if (sum->queries > sum->returned)
        printf("%s did not return: an exception or a jump out of a callback\n", thousands(sum->queries - sum->returned));
}

static void print_side(const char *name, const compare_side_t *s, const compare_call_t *c)
{
    const uint64_t *v = s->verdict;
    printf("%-20s %7s %6s %7s %7s %8s", name, thousands(v[VERDICT_MISSED]), thousands(v[VERDICT_SPURIOUS]),
           thousands(v[VERDICT_INVALID]), thousands(v[VERDICT_DEEP]), thousands(v[VERDICT_UNSOUND]));
    printf(" %s %s %9.2f %7.0f\n", length_text(part(s->error_sum, s->with_error), 10), length_text((double)s->error_max, 9),
           0.5 * part(s->calls, c->judged), part(s->nanoseconds, c->timed));
}

static void print_wrong(const compare_call_t *c, const char *call)
{
    printf("\n%-20s %7s %6s %7s %7s %8s %10s %9s %9s %7s\n", call, "missed", "false", "broken", "> 1 %", "unsound", "mean error",
           "largest", "supports", "ns");
    print_side("libccd", &c->side[COMPARE_THEIRS], c);
    print_side("this library", &c->side[COMPARE_OURS], c);
}

/* Prints why queries were not judged, and faults of the callbacks. */
static void print_notes(const compare_call_t *sum)
{
    const struct {
        uint64_t count;
        const char *text;
    } notes[] = {
        {sum->no_shape, "queries were about no convex shape (a callback returns a point that is not the farthest in its direction,\n"
                        "  or the centre lies outside): no answer can be right there, none was judged"},
        {sum->memory, "queries were answered differently when repeated: callbacks with memory. The calls made for this screen may\n"
                      "  have changed the program; `--every 0` makes none"},
        {sum->threw, "queries were not judged: when repeated, a callback threw or jumped, or returned NaN"},
        {sum->endless, "queries were not judged: a library did not end within 100,000 calls of the callbacks"},
        {sum->contradicted, "proofs of this library were wrong: a support value lies below their bound. Please report them."},
    };
    for (size_t i = 0; i < sizeof notes / sizeof *notes; i++)
        if (notes[i].count)
            printf("%s %s\n", thousands(notes[i].count), notes[i].text);
}

/* --- the price ------------------------------------------------------------------------ */

/* Returns the time of a program on this library over that on libccd, by its queries' times; 0: unknown. */
static double forecast(const compare_call_t *sum)
{
    const double own = (double)all.process_nanoseconds - (double)all.judge_nanoseconds;
    double queries[COMPARE_SIDES], program[COMPARE_SIDES];
    if (!sum->timed || own <= 0)
        return 0;
    for (int side = 0; side < COMPARE_SIDES; side++)
        queries[side] = (double)sum->queries * part(sum->side[side].nanoseconds, sum->timed);
    for (int side = 0; side < COMPARE_SIDES; side++)
        program[side] = own + queries[side] - queries[all.base];
    return program[COMPARE_THEIRS] > 0 ? program[COMPARE_OURS] / program[COMPARE_THEIRS] : 0;
}

/* Runs of the program alone on one library. */
enum { MAX_RUNS = 1000 };
typedef struct {
    double seconds[MAX_RUNS]; /* of those that ended by themselves; ascending */
    int ended, late, failed;  /* late: ended at the limit; failed: by a signal */
    int code;                 /* of the last that failed */
} runs_t;

static runs_t runs[COMPARE_SIDES];

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int has_runs(void) { return runs[COMPARE_THEIRS].ended + runs[COMPARE_THEIRS].late + runs[COMPARE_THEIRS].failed > 0; }

static void read_runs(const char *dir)
{
    char path[4096], side[8];
    int code;
    double nanoseconds;
    snprintf(path, sizeof path, "%s/runs", dir);
    FILE *file = fopen(path, "r");
    while (file && fscanf(file, "%7s %d %lf", side, &code, &nanoseconds) == 3) {
        runs_t *r = &runs[strcmp(side, "ours") == 0 ? COMPARE_OURS : COMPARE_THEIRS];
        if (code == 124 || code == 137)
            r->late++;
        else if (code > 124) {
            r->failed++;
            r->code = code;
        } else if (r->ended < MAX_RUNS)
            r->seconds[r->ended++] = 1e-9 * nanoseconds;
    }
    if (file)
        fclose(file);
    for (int i = 0; i < COMPARE_SIDES; i++)
        qsort(runs[i].seconds, (size_t)runs[i].ended, sizeof(double), by_size);
}

static double median(const runs_t *r) { return (r->seconds[(r->ended - 1) / 2] + r->seconds[r->ended / 2]) / 2; }

static int all_ended(const runs_t *r) { return r->ended > 0 && !r->late && !r->failed; }

static void print_runs(void)
{
    static const char *const name[COMPARE_SIDES] = {"libccd", "this library"};
    if (!has_runs())
        return;
    printf("The program alone, the libraries in turn:\n");
    for (int i = 0; i < COMPARE_SIDES; i++) {
        const runs_t *r = &runs[i];
        printf("  %-13s", name[i]);
        if (r->ended)
            printf(" %.3f s, the median of %d runs of %.3f to %.3f s;", median(r), r->ended, r->seconds[0],
                   r->seconds[r->ended - 1]);
        if (r->late)
            printf(" %d ended at the limit;", r->late);
        if (r->failed)
            printf(" %d ended with exit code %d;", r->failed, r->code);
        printf("\n");
    }
}

/* More time on warm caches is even more in the program. */
static const char *bound(double ratio) { return ratio > 1 ? "at least" : "about"; }

/* Prints what the queries cost this program on either library. */
static void print_price(const compare_call_t *sum)
{
    const uint64_t theirs = sum->side[COMPARE_THEIRS].nanoseconds, ours = sum->side[COMPARE_OURS].nanoseconds;
    const double own = (double)all.process_nanoseconds - (double)all.judge_nanoseconds, ratio = forecast(sum);
    if (!sum->timed || !theirs)
        return;
    printf("A query takes %.2f times libccd's time.\n", (double)ours / (double)theirs);
    if (ratio > 0)
        printf("  Queries are %.1f %% of this program's %.2f s. On this library it takes %s %.2f times its time on libccd:\n"
               "  %s, for queries are timed on warm caches, and other contacts give a program other work.%s\n",
               100 * (double)sum->queries * part(sum->side[all.base].nanoseconds, sum->timed) / own, 1e-9 * own, bound(ratio),
               ratio, ratio > 1 ? "a lower bound" : "an estimate", has_runs() ? "" : " `--runs 5` measures it.");
}

/* --- the verdict ---------------------------------------------------------------------- */

/* Prints one library's wrong answers: `162 of 534 overlaps more than 1 % too deep, 2 missed`, or 0. */
static void print_wrong_answers(const compare_call_t *sum, int side)
{
    static const struct {
        verdict_t verdict;
        const char *text;
    } kind[] = {{VERDICT_DEEP, "more than 1 % too deep"}, {VERDICT_MISSED, "missed"}, {VERDICT_UNSOUND, "not moved apart"},
                {VERDICT_INVALID, "hits without a direction"}, {VERDICT_SPURIOUS, "false hits"}};
    const char *before = "";
    for (size_t i = 0; i < sizeof kind / sizeof *kind; i++) {
        const uint64_t n = sum->side[side].verdict[kind[i].verdict];
        if (!n)
            continue;
        printf("%s%s ", before, thousands(n));
        if (!*before && i < 3)
            printf("of %s overlaps ", thousands(sum->overlaps));
        printf("%s", kind[i].text);
        before = ", ";
    }
    if (!*before)
        printf(side == COMPARE_THEIRS ? "0 of %s judged answers wrong" : "0", thousands(sum->judged));
}

/* Prints how a program that did not end, or by a signal, did so: on `name`. */
static int print_end(const char *name, int late, int code, const char *limit)
{
    if (late)
        printf("; on %s the program does not end in %s s", name, limit);
    else if (code > 125)
        printf("; on %s the program ends with exit code %d", name, code);
    return late || code > 125;
}

/* Prints the last line: what is wrong on either library, and the price. */
static void print_verdict(const compare_call_t *sum, int code, const char *limit)
{
    const runs_t *theirs = &runs[COMPARE_THEIRS], *ours = &runs[COMPARE_OURS];
    const double ratio = forecast(sum);
    if (sum->judged) {
        printf("libccd: ");
        print_wrong_answers(sum, COMPARE_THEIRS);
        printf("; this library: ");
        print_wrong_answers(sum, COMPARE_OURS);
    } else
        printf("No answer was judged; %s of %s hits without a direction on %s", thousands(sum->broken), thousands(sum->hits),
               all.base == COMPARE_THEIRS ? "libccd" : "this library");
    if (all_ended(theirs) && all_ended(ours))
        printf("; the program takes %.2f times the time", median(ours) / median(theirs));
    else if (has_runs()) {
        print_end("libccd", theirs->late, theirs->code, limit);
        print_end("this library", ours->late, ours->code, limit);
    } else if (!print_end(all.base == COMPARE_THEIRS ? "libccd" : "this library", code == 124 || code == 137, code, limit)
               && ratio > 0)
        printf("; the program takes %s %.2f times the time", bound(ratio), ratio);
    printf(".\n");
}

static void print_saved(const char *dir)
{
    int none = 1;
    for (int side = 0; side < COMPARE_SIDES; side++)
        for (int i = 0; i < VERDICTS; i++)
            if (all.saved[side][i].used) {
                printf(CASE_PATH " %s\n", dir, COMPARE_SIDE_NAME[side], CASE_NAME[i], all.saved[side][i].title);
                none = 0;
            }
    if (none)
        printf("No wrong answer to keep.\n");
}

static void print_screen(const char *every, const char *code, compare_call_t *sum)
{
    const char *who = all.base == COMPARE_THEIRS ? "libccd" : "this library";
    printf("\n== %s, exit code %s, on the answers of %s; ", all.program, code, who);
    if (strcmp(every, "0") == 0)
        printf("none was judged");
    else if (strcmp(every, "1") == 0)
        printf("every query judged");
    else
        printf("one query in %s judged", every);
    if (all.processes > 1)
        printf("; %d processes", (int)all.processes);
    printf("\n   libccd: %s\n   this library: %s\n\n", all.theirs, all.ours);
    print_calls(sum);
    for (int i = 0; i < LIBCCD_CALL_COUNT; i++)
        if (all.call[i].judged)
            print_wrong(&all.call[i], call_table[i].name);
    printf("\n");
    print_notes(sum);
    print_price(sum);
    print_runs();
}

/* --- for programs --------------------------------------------------------------------- */

/* Prints the first members of a struct, all of 64 bits, by these names after a prefix. */
static void print_numbers(const char *prefix, const char *names, const void *numbers)
{
    const uint64_t *n = (const uint64_t *)numbers;
    while (*names) {
        const size_t length = strcspn(names, " ");
        printf(" %s%.*s %llu", prefix, (int)length, names, (unsigned long long)*n++);
        names += length + (names[length] == ' ');
    }
}

static void print_fields(void)
{
    static compare_call_t sum;
    static const char *const name[COMPARE_SIDES] = { "theirs_", "ours_" };
    for (int i = 0; i < LIBCCD_CALL_COUNT; i++)
        add_call(&sum, &all.call[i]);
    printf("counted");
    print_numbers("", "queries returned hits broken sampled judged overlaps timed threw endless memory no_shape uncertain contradicted",
                  &sum);
    for (int i = 0; i < COMPARE_SIDES; i++) {
        const compare_side_t *s = &sum.side[i];
        print_numbers(name[i], "right missed spurious broken deep unsound hits calls slanted aside", s);
        printf(" %ssupports %llu %serror_max %.9g", name[i], (unsigned long long)(s->calls + 1) / 2, name[i],
               PICO * (double)s->error_max);
    }
    printf("\n");
}

/* Exit code 3: there was no query. */
int main(int argc, char **argv)
{
    char path[4096];
    if (argc != 3 && argc != 6) {
        fprintf(stderr, "usage: screen DIR EVERY EXIT SAVED LIMIT | screen DIR fields | screen DIR libccd\n");
        return 2;
    }
    snprintf(path, sizeof path, "%s/counts", argv[1]);
    FILE *file = fopen(path, "rb");
    if (!file || fread(&all, sizeof all, 1, file) != 1)
        all.processes = 0;
    if (file)
        fclose(file);
    if (argc == 3 && strcmp(argv[2], "libccd") == 0)
        printf("%s\n", all.theirs);
    else if (argc == 3)
        print_fields();
    else if (all.processes) {
        static compare_call_t sum;
        read_runs(argv[1]);
        print_screen(argv[2], argv[3], &sum);
        if (*argv[4])
            print_saved(argv[4]);
        print_verdict(&sum, atoi(argv[3]), argv[5]);
    }
    return all.processes ? 0 : 3;
}
