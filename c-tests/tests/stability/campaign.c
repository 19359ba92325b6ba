/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Failure rates of both libraries by category of pair.
 *
 *   campaign [pairs a category [category, -1 all [compatible | proven | local]]]
 *
 * Prints a table of both libraries for each tie rule, at the default tolerance of
 * 1e-4 m, and exits with 1 when this library breaks a guarantee at that tolerance or
 * at a fine one (TOL_TIGHT of the size), with the first pairs that show it. */

#include "categories.h"

enum { DEFAULT, FINE, TOLERANCES };
enum { TIES = SHAPE_TIE_CENTRE + 1 };

typedef struct {
    int queries;
    int count[FAULT_BIT_COUNT];
    int limits; /* CCD_LIMIT where minima form a surface: allowed */
    double calls;
} rates_t;

static rates_t rates[TIES][ENTRIES][CATEGORY_COUNT][TOLERANCES];

/* faults of each entry point that were printed in full */
static int printed[TIES][ENTRIES];

/* Returns whether so many pairs of a sample are known to break the guarantee at either tolerance. */
static int is_known(const char *category, const char *entry, int fault, int at_default, int at_fine)
{
    static const struct {
        const char *category, *entry; /* entry: all whose name begins so */
        int fault, at_default, at_fine; /* of 100 pairs */
    } known[] = {
        {"coincident centres", "local", FAULT_BIT_LIMIT, 0, 1},
        {"near-coincident centres 1e-8 to 1e-18", "local", FAULT_BIT_LIMIT, 0, 1},
        {"centre offset along a shared axis", "local", FAULT_BIT_LIMIT, 0, 1},
        {"small fully inside big", "local", FAULT_BIT_LIMIT, 0, 1},
        {"segment or point and solid", "local", FAULT_BIT_LIMIT, 0, 1},
        {"sphere near a solid's centre", "local", FAULT_BIT_LIMIT, 0, 2},
        {"scale 1e-6 to 1e6, any depth", "local", FAULT_BIT_LIMIT, 0, 1},
        {"corners and rims that meet", "local", FAULT_BIT_WITNESS_INSIDE, 0, 1},
#ifdef CCD_SINGLE
        {"far from the origin 1e6", "penetration", FAULT_BIT_LIMIT, 2, 2},
        {"far from the origin 1e6", "minimum", FAULT_BIT_LIMIT, 7, 7},
        {"far from the origin 1e6", "distance", FAULT_BIT_LIMIT, 13, 13},
#endif
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(category, known[i].category) == 0 && strncmp(entry, known[i].entry, strlen(known[i].entry)) == 0
            && fault == known[i].fault)
            return at_default <= known[i].at_default && at_fine <= known[i].at_fine;
    return 0;
}

/* Judges an entry point on pair number i of a category. */
static void judge_pair(int category, int i, const pair_t *p, int k)
{
    const entry_t *e = &entries[k];
    const double tols[TOLERANCES] = {1e-4, tolerance(TOL_TIGHT) * pair_size(&p->a, &p->b)};
    const int tie = p->a.tie;
    for (int t = 0; t < (e->is_libccd ? FINE : TOLERANCES); t++) {
        const answer_t x = call_entry(e, &p->a, &p->b, tols[t], p->truth.n);
        rates_t *r = &rates[tie][k][category][t];
        criteria_t q = criteria_of(&p->a, &p->b, tols[t], &p->truth);
        q.surface = category == CATEGORY_CONCENTRIC ? ALL_AROUND : pair_may_reach_limit(p, tols[t]);
        const int faults = judge(e, &x, &p->a, &p->b, &q);
        r->queries++;
        r->calls += (double)x.calls;
        r->limits += x.code == CCD_LIMIT;
        for (int bit = 0; bit < FAULT_BIT_COUNT; bit++)
            r->count[bit] += faults >> bit & 1;
        if (!e->is_libccd && faults & FAULTS_FORBIDDEN & ~printed[tie][k]) {
            printed[tie][k] |= faults;
            printf("first seen: %s, pair %d, tolerance %g%s, ", category_text(category), i, tols[t],
                   q.surface ? ", surface" : "");
            print_faulty_answer(e, &x, faults & FAULTS_FORBIDDEN, &p->truth);
            print_shape("  a", &p->a);
            print_shape("  b", &p->b);
        }
    }
}

static void print_row(const char *name, int category, const rates_t *r)
{
    printf("| %s | %s |", category_text(category), name);
    for (int bit = 0; bit <= FAULT_BIT_DIR_BAD; bit++)
        printf(" %.1f |", 100. * r->count[bit] / r->queries);
    printf(" %.0f |\n", r->calls / r->queries);
}

static void print_rates(int pairs, int tie)
{
    printf("Rates in %% of %d pairs a category, tolerance 1e-4 m (fine: 1e-9 of the size), %s tie rule; calls of "
           "both support functions.\n\n| category | method |", pairs, tie == SHAPE_TIE_CENTRE ? "centre" : "sign");
    for (int bit = 0; bit <= FAULT_BIT_DIR_BAD; bit++)
        printf(" %s |", fault_text(bit));
    printf(" calls |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int category = 0; category < CATEGORY_COUNT; category++)
        for (int k = 0; k < (int)ENTRIES; k++) {
            const entry_t *e = &entries[k];
            const rates_t *r = rates[tie][k][category];
            const char *name = e->is_libccd ? e->name : e->call == CALL_MPR ? "**our MPR**" : e->call == CALL_GJK ? "**our GJK**"
                : e->call == CALL_PROVEN && e->state == STATE_NONE ? "**minimum**" : NULL;
            if (!name || !r[DEFAULT].queries)
                continue;
            print_row(name, category, &r[DEFAULT]);
            if (!e->is_libccd && e->call == CALL_MPR)
                print_row("**our MPR, fine**", category, &r[FINE]);
        }
    printf("\n");
}

/* Prints counts of CCD_LIMIT and broken guarantees; returns how many of these are not known. */
static int print_broken(int pairs, int tie)
{
    int broken = 0;
    for (int category = 0; category < CATEGORY_COUNT; category++)
        for (int k = 0; k < (int)ENTRIES; k++) {
            const rates_t *r = rates[tie][k][category];
            if (!entries[k].is_libccd && r[DEFAULT].limits + r[FINE].limits > 0)
                printf("stopped at the cap: %s, %s: %d (default), %d (fine) of %d\n", category_text(category), entries[k].name,
                       r[DEFAULT].limits, r[FINE].limits, pairs);
            for (int bit = 0; bit < FAULT_BIT_COUNT && !entries[k].is_libccd; bit++) {
                const int n = r[DEFAULT].count[bit], m = r[FINE].count[bit];
                if (!(FAULTS_FORBIDDEN >> bit & 1) || n + m == 0)
                    continue;
                const int known = is_known(category_text(category), entries[k].name, bit, n, m);
                printf("%s %s, %s: %s: %d (default), %d (fine) of %d\n", known ? "broken, as known:" : "BROKEN",
                       category_text(category), entries[k].name, fault_text(bit), n, m, pairs);
                broken += known ? 0 : n + m;
            }
        }
    printf("%d broken guarantees\n", broken);
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
            /* both tie rules have the same truth, which takes longer than the calls */
            category_pair(category, (uint64_t)i, SHAPE_TIE_SIGN, &p);
            for (int tie = 0; tie < TIES; tie++) {
                p.a.tie = p.b.tie = tie;
                for (int k = 0; k < (int)ENTRIES; k++)
                    if (entries[k].is_libccd || entry_in(&entries[k], group))
                        judge_pair(category, i, &p, k);
            }
        }
    }
    for (int tie = 0; tie < TIES; tie++) {
        print_rates(pairs, tie);
        broken += print_broken(pairs, tie);
    }
    return broken > 0;
}
