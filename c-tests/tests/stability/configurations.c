/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Judges every entry point on every configuration by the exact truth.
 *
 *   configurations [compatible | proven | local]   a line for each wrong answer of these entry
 *                                                  points; exit code 1 if there is one
 *   configurations --ledger                        a Markdown table of those where
 *                                                  libccd is wrong */

#include "judge.h"

#include "configurations.h"

static int is_ledger, failed, checked;
static const char *group;

static void describe(const answer_t *x, char text[32])
{
    const double length2 = truth_dot3(x->dir, x->dir);
    if (x->code == ANSWER_LOOP || x->code == ANSWER_CRASH || x->code == CCD_MISS)
        snprintf(text, 32, "%s", x->code == ANSWER_LOOP ? "endless" : x->code == ANSWER_CRASH ? "crash" : "miss");
    else if (x->code != CCD_HIT && x->code != CCD_LIMIT)
        snprintf(text, 32, "code %d", x->code);
    else if (length2 == 0 || !isfinite(length2))
        snprintf(text, 32, "%.6g, dir %s", x->depth, length2 == 0 ? "0" : "NaN");
    else
        snprintf(text, 32, "%.8g%s", x->depth, x->code == CCD_LIMIT ? " (limit)" : "");
}

static void check(const configuration_t *c)
{
    const truth_t truth = truth_depth(&c->a, &c->b);
    const double tol = tolerance(TOL_TIGHT) * pair_size(&c->a, &c->b);
    criteria_t q = criteria_of(&c->a, &c->b, tol, &truth);
    char text[ENTRIES][32];
    int is_bad, is_libccd_wrong = 0;
    if (c->flags & NOT_IN_SINGLE && in_single())
        return;
    q.surface = (c->flags & SURFACE) != 0;
    q.touching |= (c->flags & TOUCHING) != 0;
    checked++;
    is_bad = isfinite(c->expected) && !(fabs(truth.depth - c->expected) <= c->within);
    if (is_bad)
        printf("%-28s truth %.17g, expected %.17g\n", c->id, truth.depth, c->expected);
    for (int i = 0; i < (int)ENTRIES; i++) {
        const entry_t *e = &entries[i];
        if (!e->is_libccd && !entry_in(e, group))
            continue;
        /* libccd with its default tolerance, which its users have */
        answer_t x = call_entry(e, &c->a, &c->b, e->is_libccd ? 1e-4 : tol, truth.n);
        int faults = judge(e, &x, &c->a, &c->b, &q);
        if (c->flags & MISSED && x.code != CCD_MISS && e->state != STATE_MARGINS)
            faults |= FAULT_FALSE_HIT;
        describe(&x, text[i]);
        if (e->is_libccd) {
            is_libccd_wrong |= (faults & ~(FAULT_MISS_SHALLOW | FAULT_MISSED)) != 0;
        } else if (faults & FAULTS_FORBIDDEN && !is_ledger) {
            is_bad = 1;
            printf("FAILED %s, ", c->id);
            print_faulty_answer(e, &x, faults & FAULTS_FORBIDDEN, &truth);
        }
    }
    failed += is_bad;
    if (is_ledger && is_libccd_wrong)
        printf("| %s: %s | %.8g | %s | %s | %s | %s |\n", c->id, c->what, truth.depth, text[0], text[1], text[2], text[3]);
}

int main(int argc, char **argv)
{
    is_ledger = argc > 1 && strcmp(argv[1], "--ledger") == 0;
    group = argc > 1 && !is_ledger ? argv[1] : NULL;
    catch_crashes();
    if (is_ledger)
        printf("| configuration | true depth | libccd MPR | libccd GJK | our MPR | our GJK |\n|---|---|---|---|---|---|\n");
    for_each_configuration(check);
    if (!is_ledger)
        printf("%d configurations, %d failed\n", checked, failed);
    return !is_ledger && failed > 0;
}
