/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Prints the counts of all processes at the end of a run.
 *
 * usage: screen DIR EVERY EXIT SAVED   the screen; SAVED: the folder of wrong answers, or empty
 *        screen DIR fields            `counted key value key value ...`, for the tables of engines/ */

#include "tools/compare/counts.h"

#include <stdio.h>
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
    printf(" %8.3g %8.3g %9.2f %7.0f\n", 1e6 * PICO * part(s->error_sum, s->with_error), 1e6 * PICO * (double)s->error_max,
           0.5 * part(s->calls, c->judged), part(s->nanoseconds, c->timed));
}

static void print_wrong(const compare_call_t *c, const char *call)
{
    printf("\n%-20s %7s %6s %7s %7s %8s %8s %8s %9s %7s\n", call, "missed", "false", "broken", "> 1 %", "unsound", "mean um",
           "max um", "supports", "ns");
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

/* Prints what the queries cost this program on the other library. */
static void print_price(const compare_call_t *sum)
{
    const uint64_t theirs = sum->side[COMPARE_THEIRS].nanoseconds, ours = sum->side[COMPARE_OURS].nanoseconds;
    if (!sum->timed || !theirs)
        return;
    printf("A query takes %.2f times libccd's time.\n", (double)ours / (double)theirs);
    if (all.process_nanoseconds > all.judge_nanoseconds) {
        const double own = (double)(all.process_nanoseconds - all.judge_nanoseconds), queries = (double)sum->queries;
        const double share = queries * part(sum->side[all.base].nanoseconds, sum->timed) / own;
        const double other = queries * part(sum->side[1 - all.base].nanoseconds, sum->timed) / own;
        printf("  Queries are %.1f %% of this program's %.2f s; on %s the program would take %+.1f %%.\n", 100 * share,
               1e-9 * own, all.base == COMPARE_THEIRS ? "this library" : "libccd", 100 * (other - share));
    }
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

static void print_screen(const char *every, const char *code)
{
    static compare_call_t sum;
    const char *who = all.base == COMPARE_THEIRS ? "libccd" : "this library";
    printf("\n== %s, exit code %s, on the answers of %s; ", all.program, code, who);
    if (strcmp(every, "0") != 0)
        printf("one query in %s judged", every);
    else
        printf("none was judged");
    if (all.processes > 1)
        printf("; %d processes", (int)all.processes);
    printf("\n   libccd: %s\n   this library: %s\n\n", all.theirs, all.ours);
    print_calls(&sum);
    for (int i = 0; i < LIBCCD_CALL_COUNT; i++)
        if (all.call[i].judged)
            print_wrong(&all.call[i], call_table[i].name);
    printf("\n");
    print_notes(&sum);
    print_price(&sum);
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
    if (argc != 3 && argc != 5) {
        fprintf(stderr, "usage: screen DIR EVERY EXIT SAVED | screen DIR fields\n");
        return 2;
    }
    snprintf(path, sizeof path, "%s/counts", argv[1]);
    FILE *file = fopen(path, "rb");
    if (!file || fread(&all, sizeof all, 1, file) != 1)
        all.processes = 0;
    if (file)
        fclose(file);
    if (argc == 3)
        print_fields();
    else if (all.processes) {
        print_screen(argv[2], argv[3]);
        if (*argv[4])
            print_saved(argv[4]);
    }
    return all.processes ? 0 : 3;
}
