/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* How often each library fails, by category of pair.
 *
 *   campaign [pairs a category [category, -1 all [compatible | proven | local]]]
 *
 * Prints a table of both libraries for each tie rule, at the default tolerance of
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

enum { TIES = SHAPE_TIE_CENTRE + 1 };

/* At the default tolerance, and at the fine one for ours. */
static row_t table[TIES][ENTRIES][CATEGORY_COUNT], fine[TIES][ENTRIES][CATEGORY_COUNT];

/* which fault of which entry point has been shown in full */
static int shown[TIES][ENTRIES];

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

/* Pair number i of a category, put to an entry point. */
static void ask_pair(int category, int i, const pair_t *p, int k)
{
    const entry_t *e = &entries[k];
    const double tols[2] = {1e-4, tolerance(TOL_TIGHT) * pair_size(&p->a, &p->b)};
    const int tie = p->a.tie;
    for (int t = 0; t < (e->is_libccd ? 1 : 2); t++) {
        criteria_t q = criteria_of(&p->a, &p->b, tols[t], &p->truth);
        answer_t x = call_entry(e, &p->a, &p->b, tols[t], p->truth.n);
        q.surface = category == CATEGORY_CONCENTRIC ? ALL_AROUND : pair_may_stop(p, tols[t]);
        int faults = judge(e, &x, &p->a, &p->b, &q);
        tally(t ? &fine[tie][k][category] : &table[tie][k][category], &x, faults);
        if (!e->is_libccd && faults & FAULTS_FORBIDDEN & ~shown[tie][k]) {
            shown[tie][k] |= faults;
            printf("first seen: %s, pair %d, tolerance %g%s, ", category_text(category), i, tols[t], q.surface ? ", surface" : "");
            print_faulty_answer(e, &x, faults & FAULTS_FORBIDDEN, &p->truth);
            print_shape("  a", &p->a);
            print_shape("  b", &p->b);
        }
    }
}

/* Prints the rates; returns how many rows. */
static int print_rates(int pairs, int tie)
{
    int rows = 0;
    printf("Rates in %% of %d pairs a category, tolerance 1e-4 m (fine: 1e-9 of the size), %s tie rule; calls of "
           "both support functions.\n\n", pairs, tie == SHAPE_TIE_CENTRE ? "centre" : "sign");
    printf("| category | method | loop | crash | NaN | dir 0 | deep miss | shallow miss | false hit | over | under | depth ~0 | "
           "unsound | bad dir | calls |\n");
    printf("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int category = 0; category < CATEGORY_COUNT; category++)
        for (int k = 0; k < (int)ENTRIES; k++) {
            const entry_t *e = &entries[k];
            int rated = e->call == CALL_MPR || e->call == CALL_GJK || (e->call == CALL_PROVEN && e->state == STATE_NONE);
            if (!rated || !table[tie][k][category].asked)
                continue;
            report(e->is_libccd ? e->name : e->call == CALL_MPR ? "**our MPR**" : e->call == CALL_GJK ? "**our GJK**" : "**minimum**",
                   category_text(category), &table[tie][k][category]);
            if (!e->is_libccd && e->call == CALL_MPR)
                report("**our MPR, fine**", category_text(category), &fine[tie][k][category]);
            rows++;
        }
    printf("\n");
    return rows;
}

/* Prints what stopped at the cap, and broken promises; returns how many of these are not known. */
static int print_broken(int pairs, int tie)
{
    int broken = 0;
    for (int category = 0; category < CATEGORY_COUNT; category++)
        for (int k = 0; k < (int)ENTRIES; k++)
            if (!entries[k].is_libccd && (table[tie][k][category].limit || fine[tie][k][category].limit))
                printf("stopped at the cap: %s, %s: %d (default), %d (fine) of %d\n", category_text(category), entries[k].name,
                       table[tie][k][category].limit, fine[tie][k][category].limit, pairs);
    for (int category = 0; category < CATEGORY_COUNT; category++)
        for (int k = 0; k < (int)ENTRIES; k++)
            for (int i = 0; i < FAULT_BIT_COUNT && !entries[k].is_libccd; i++) {
                int n = table[tie][k][category].count[i], m = fine[tie][k][category].count[i];
                if (!(FAULTS_FORBIDDEN >> i & 1) || n + m == 0)
                    continue;
                if (is_known(category_text(category), entries[k].name, fault_text(i), n, m)) {
                    printf("broken, as known: %s, %s: %s\n", category_text(category), entries[k].name, fault_text(i));
                    continue;
                }
                printf("BROKEN %s, %s: %s: %d (default), %d (fine) of %d\n", category_text(category), entries[k].name,
                       fault_text(i), n, m, pairs);
                broken += n + m;
            }
    return broken;
}

int main(int argc, char **argv)
{
    const int pairs = argc > 1 ? atoi(argv[1]) : 2000, only = argc > 2 ? atoi(argv[2]) : -1;
    const char *group = argc > 3 ? argv[3] : NULL;
    static pair_t p;
    int broken = 0;
    if (pairs < 1) {
        fprintf(stderr, "usage: campaign [pairs a category [category [group]]]\n");
        return 2;
    }
    catch_crashes();
    for (int category = 0; category < CATEGORY_COUNT; category++) {
        if (only >= 0 && category != only)
            continue;
        fprintf(stderr, "%d/%d %s\n", category + 1, CATEGORY_COUNT, category_text(category));
        for (int i = 0; i < pairs; i++) {
            /* Its truth, which takes longer than the calls, is that of both rules. */
            category_pair(category, (uint64_t)i, SHAPE_TIE_SIGN, &p);
            for (int tie = 0; tie < TIES; tie++) {
                p.a.tie = p.b.tie = tie;
                for (int k = 0; k < (int)ENTRIES; k++)
                    if (entries[k].is_libccd || entry_in(&entries[k], group))
                        ask_pair(category, i, &p, k);
            }
        }
    }
    for (int tie = 0; tie < TIES; tie++) {
        const int rows = print_rates(pairs, tie), unknown = print_broken(pairs, tie);
        printf("%d rows, %d broken promises\n", rows, unknown);
        broken += unknown;
    }
    return broken > 0;
}
