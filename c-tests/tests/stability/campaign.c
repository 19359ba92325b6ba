/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* How often each library fails, by category of pair.
 *
 *   campaign [pairs a category [tie rule: 0 sign of zero, 1 centre [category, -1 all
 *             [compatible | proven | local]]]]
 *
 * Prints one table for libccd and one for this library, at the default tolerance of
 * 1e-4 m, and exits with 1 when this library breaks a promise at that tolerance or
 * at a fine one (TOL_TIGHT of the size), with the first pairs that show it. */

#include "categories.h"

/* columns of the tables */
typedef struct {
    int asked;
    int count[FAULT_BIT_COUNT];
    int limit; /* CCD_LIMIT where minima form a surface: allowed */
    double calls;
} row_t;

/* which fault of which entry point has been shown in full */
static int shown[ENTRIES];

static void tally(row_t *r, const answer_t *x, int faults)
{
    r->asked++;
    r->calls += (double)x->calls;
    for (int bit = 0; bit < FAULT_BIT_COUNT; bit++)
        r->count[bit] += faults >> bit & 1;
    r->limit += x->code == CCD_LIMIT;
}

static void report(const char *name, const char *category, row_t *r)
{
    static const int columns[] = {FAULT_BIT_LOOP,      FAULT_BIT_CRASH,        FAULT_BIT_NAN,       FAULT_BIT_DIR0,
                                  FAULT_BIT_MISS_DEEP, FAULT_BIT_MISS_SHALLOW, FAULT_BIT_FALSE_HIT, FAULT_BIT_OVER,
                                  FAULT_BIT_UNDER,     FAULT_BIT_ZERO,         FAULT_BIT_UNSOUND,   FAULT_BIT_DIR_BAD};
    double n = r->asked ? r->asked : 1;
    printf("| %s | %s |", category, name);
    for (size_t i = 0; i < sizeof columns / sizeof columns[0]; i++)
        printf(" %.1f |", 100 * r->count[columns[i]] / n);
    printf(" %.0f |\n", r->calls / n);
}

/* Promises that one pair of a sample is known to break, at the fine tolerance alone or at both; of
 * all entry points whose name begins so. */
static int is_known(const char *category, const char *entry, const char *fault, int at_default, int at_fine)
{
    static const struct {
        const char *category, *entry, *fault;
        int at_default, at_fine; /* of 100 pairs */
    } known[] = {
        {"coincident centres", "local", "stopped at the cap", 0, 1},
        {"near-coincident centres 1e-8 to 1e-18", "local", "stopped at the cap", 0, 1},
        {"centre offset along a shared axis", "local", "stopped at the cap", 0, 1},
        {"small fully inside big", "local", "stopped at the cap", 0, 1},
        {"segment or point and solid", "local", "stopped at the cap", 0, 1},
        {"sphere near a solid's centre", "local", "stopped at the cap", 0, 2},
        {"scale 1e-6 to 1e6, any depth", "local", "stopped at the cap", 0, 1},
        {"corners and rims that meet", "local", "witness points outside the shapes", 0, 1},
#ifdef CCD_SINGLE
        {"far from the origin 1e6", "penetration", "stopped at the cap", 2, 2},
        {"far from the origin 1e6", "minimum", "stopped at the cap", 7, 7},
        {"far from the origin 1e6", "distance", "stopped at the cap", 13, 13},
#endif
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(category, known[i].category) == 0 && strncmp(entry, known[i].entry, strlen(known[i].entry)) == 0
            && strcmp(fault, known[i].fault) == 0)
            return at_default <= known[i].at_default && at_fine <= known[i].at_fine;
    return 0;
}

int main(int argc, char **argv)
{
    int pairs = argc > 1 ? atoi(argv[1]) : 2000, tie = argc > 2 ? atoi(argv[2]) : SHAPE_TIE_SIGN;
    const char *group = argc > 4 ? argv[4] : NULL;
    int only = argc > 3 ? atoi(argv[3]) : -1, category, i, k, broken = 0, rows = 0;
    /* [entry][category] at the default tolerance, and the fine one for ours */
    static row_t table[ENTRIES][CATEGORY_COUNT], fine[ENTRIES][CATEGORY_COUNT];
    static pair_t p;
    if (pairs < 1) {
        fprintf(stderr, "usage: campaign [pairs a category [tie rule [category [group]]]]\n");
        return 2;
    }
    judge_begin();
    for (category = 0; category < CATEGORY_COUNT; category++) {
        if (only >= 0 && category != only)
            continue;
        fprintf(stderr, "%d/%d %s\n", category + 1, CATEGORY_COUNT, category_text(category));
        for (i = 0; i < pairs; i++) {
            category_pair(category, (uint64_t)i, tie, &p);
            for (k = 0; k < (int)ENTRIES; k++) {
                const entry_t *e = &entries[k];
                double tols[2];
                if (!e->system && !entry_in(e, group))
                    continue;
                tols[0] = 1e-4;
                tols[1] = tolerance(TOL_TIGHT) * pair_size(&p.a, &p.b);
                for (int t = 0; t < (e->system ? 1 : 2); t++) {
                    question_t q = question(&p.a, &p.b, tols[t], &p.truth);
                    answer_t x = ask(e, &p.a, &p.b, tols[t], p.truth.n, most_calls(e));
                    q.surface = category == CATEGORY_CONCENTRIC ? ALL_AROUND : pair_may_stop(&p, tols[t]);
                    int faults = judge(e, &x, &p.a, &p.b, &q);
                    tally(t ? &fine[k][category] : &table[k][category], &x, faults);
                    if (!e->system && faults & FAULTS_NEVER & ~shown[k]) {
                        shown[k] |= faults;
                        printf("first seen: %s, pair %d, tolerance %g%s, ", category_text(category), i, tols[t], q.surface ? ", surface" : "");
                        print_wrong(e, &x, faults & FAULTS_NEVER, &p.truth);
                        print_shape(stdout, "  a", &p.a);
                        print_shape(stdout, "  b", &p.b);
                    }
                }
            }
        }
    }
    printf("Rates in %% of %d pairs a category, tolerance 1e-4 m (fine: 1e-9 of the size), %s tie rule; calls of "
           "both support functions.\n\n", pairs, tie == SHAPE_TIE_CENTRE ? "centre" : "sign");
    printf("| category | method | loop | crash | NaN | dir 0 | deep miss | shallow miss | false hit | over | under | depth ~0 | "
           "unsound | bad dir | calls |\n");
    printf("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (category = 0; category < CATEGORY_COUNT; category++)
        for (k = 0; k < (int)ENTRIES; k++) {
            const entry_t *e = &entries[k];
            int rated = e->ask == ASK_MPR || e->ask == ASK_GJK || (e->ask == ASK_PROVEN && e->state == STATE_NONE);
            if (!rated || !table[k][category].asked)
                continue;
            report(e->system ? e->name : e->ask == ASK_MPR ? "**our MPR**" : e->ask == ASK_GJK ? "**our GJK**" : "**minimum**",
                   category_text(category), &table[k][category]);
            if (!e->system && e->ask == ASK_MPR)
                report("**our MPR, fine**", category_text(category), &fine[k][category]);
            rows++;
        }
    printf("\n");
    for (category = 0; category < CATEGORY_COUNT; category++)
        for (k = 0; k < (int)ENTRIES; k++)
            if (!entries[k].system && (table[k][category].limit || fine[k][category].limit))
                printf("stopped at the cap: %s, %s: %d (default), %d (fine) of %d\n", category_text(category), entries[k].name,
                       table[k][category].limit, fine[k][category].limit, pairs);
    for (category = 0; category < CATEGORY_COUNT; category++)
        for (k = 0; k < (int)ENTRIES; k++)
            for (i = 0; i < FAULT_BIT_COUNT && !entries[k].system; i++) {
                int n = table[k][category].count[i], m = fine[k][category].count[i];
                if (!(FAULTS_NEVER >> i & 1) || n + m == 0)
                    continue;
                if (is_known(category_text(category), entries[k].name, fault_text(i), n, m)) {
                    printf("broken, as known: %s, %s: %s\n", category_text(category), entries[k].name, fault_text(i));
                    continue;
                }
                printf("BROKEN %s, %s: %s: %d (default), %d (fine) of %d\n", category_text(category), entries[k].name,
                       fault_text(i), n, m, pairs);
                broken += n + m;
            }
    printf("%d rows, %d broken promises\n", rows, broken);
    return broken > 0;
}
