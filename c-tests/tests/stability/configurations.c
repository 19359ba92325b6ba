/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Every configuration on every entry point, judged by the exact truth.
 *
 *   configurations [compatible | proven | local]   a line for each wrong answer of these entry
 *                                                  points; exit code 1 if there is one
 *   configurations --ledger                        a Markdown table of those where
 *                                                  libccd is wrong */

#include "judge.h"

#include "configurations.h"

static int ledger, failed, checked;
static const char *group;

static void describe(const answer_t *x, char text[32])
{
    if (x->code == ANSWER_LOOP)
        snprintf(text, 32, "endless");
    else if (x->code == ANSWER_CRASH)
        snprintf(text, 32, "crash");
    else if (x->code == CCD_MISS)
        snprintf(text, 32, "miss");
    else if (x->code != CCD_HIT && x->code != CCD_LIMIT)
        snprintf(text, 32, "code %d", x->code);
    else if (truth_dot3(x->dir, x->dir) == 0)
        snprintf(text, 32, "%.6g, dir 0", x->depth);
    else if (!isfinite(truth_dot3(x->dir, x->dir)))
        snprintf(text, 32, "%.6g, dir NaN", x->depth);
    else
        snprintf(text, 32, "%.8g%s", x->depth, x->code == CCD_LIMIT ? " (limit)" : "");
}

static void check(const configuration_t *c)
{
    truth_t truth = truth_depth(&c->a, &c->b);
    double tol = tolerance(TOL_TIGHT) * pair_size(&c->a, &c->b);
    char text[ENTRIES][32];
    int bad = 0, theirs = 0;
    if (c->not_single && in_single())
        return;
    criteria_t q = criteria_of(&c->a, &c->b, tol, &truth);
    q.surface = c->surface;
    q.touching = q.touching || c->touching;
    checked++;
    if (!ledger && isfinite(c->expected) && !(fabs(truth.depth - c->expected) <= c->within)) {
        printf("%-28s truth %.17g, expected %.17g\n", c->id, truth.depth, c->expected);
        failed++;
    }
    for (int i = 0; i < (int)ENTRIES; i++) {
        const entry_t *e = &entries[i];
        if (!e->is_libccd && !entry_in(e, group))
            continue;
        /* libccd is asked as its users do: with its default tolerance */
        answer_t x = call_entry(e, &c->a, &c->b, e->is_libccd ? 1e-4 : tol, truth.n);
        int faults = judge(e, &x, &c->a, &c->b, &q);
        if (c->missed && x.code != CCD_MISS && e->state != STATE_MARGINS)
            faults |= FAULT_FALSE_HIT;
        describe(&x, text[i]);
        if (e->is_libccd) {
            theirs |= faults & ~(FAULT_MISS_SHALLOW | FAULT_MISSED);
            continue;
        }
        faults &= FAULTS_FORBIDDEN;
        bad += faults != 0;
        if (faults && !ledger) {
            printf("FAILED %s, ", c->id);
            print_faulty_answer(e, &x, faults, &truth);
        }
    }
    failed += bad > 0;
    if (ledger && theirs)
        printf("| %s: %s | %.8g | %s | %s | %s | %s |\n", c->id, c->what, truth.depth, text[0], text[1], text[2], text[3]);
}

int main(int argc, char **argv)
{
    ledger = argc > 1 && strcmp(argv[1], "--ledger") == 0;
    group = argc > 1 && !ledger ? argv[1] : NULL;
    catch_crashes();
    if (ledger)
        printf("| configuration | true depth | libccd MPR | libccd GJK | our MPR | our GJK |\n|---|---|---|---|---|---|\n");
    for_each_configuration(check);
    if (!ledger)
        printf("%d configurations, %d failed\n", checked, failed);
    return !ledger && failed > 0;
}
