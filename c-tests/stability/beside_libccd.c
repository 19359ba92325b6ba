/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Both libraries in one process over random and degenerate pairs, compared with each
 * other and with the exact truth:
 *
 * - where they disagree on hit or miss, the truth is on our side, or the pair touches;
 * - our MPR is never deeper than libccd's, beyond its own promise (the tolerance or a
 *   thousandth of the depth);
 * - our GJK is never farther from the truth than libccd's, beyond the tolerance.
 *
 *   beside_libccd [pairs a category] */

#include "categories.h"
#include "harness/identity.h"

static int failed;

static void fail(const char *what, int category, int i, const pair_t *p, const answer_t *theirs, const answer_t *ours)
{
    if (failed++ >= 10)
        return;
    printf("FAILED %s, %s, pair %d, truth %.17g\n  libccd ", what, category_text(category), i, p->truth.depth);
    print_answer(stdout, theirs);
    printf("\n  ours   ");
    print_answer(stdout, ours);
    printf("\n  ");
    print_shape(stdout, "a", &p->a);
    printf("  ");
    print_shape(stdout, "b", &p->b);
}

int main(int argc, char **argv)
{
    static const entry_t mpr[2] = {{"libccd MPR", 1, ASK_MPR, STATE_NONE}, {"MPR", 0, ASK_MPR, STATE_NONE}};
    static const entry_t gjk[2] = {{"libccd GJK", 1, ASK_GJK, STATE_NONE}, {"GJK", 0, ASK_GJK, STATE_NONE}};
    int pairs = argc > 1 ? atoi(argv[1]) : 200, category, i, k, t, differ = 0, compared = 0;
    static pair_t p;
    judge_begin();
    /* ours is ours, and the plain names are not */
    if (strncmp(OURS(ccdImplementation)(), "warmccd ", 8) != 0 || running_ccd() != NULL) {
        printf("FAILED not two libraries in this process\n");
        return 1;
    }
    for (category = 0; category < CATEGORY_COUNT; category++)
        for (i = 0; i < pairs; i++)
            for (t = 0; t < 2; t++) {
                double tol;
                question_t q;
                answer_t x[2], g[2];
                category_pair(category, (uint64_t)i, i % 2 ? SHAPE_TIE_CENTRE : SHAPE_TIE_SIGN, &p);
                tol = t ? 1e-6 * pair_size(&p.a, &p.b) : 1e-4;
                q = question(&p.a, &p.b, tol, &p.truth);
                for (k = 0; k < 2; k++) {
                    x[k] = ask(&mpr[k], &p.a, &p.b, tol, p.truth.n, 40000);
                    g[k] = ask(&gjk[k], &p.a, &p.b, tol, p.truth.n, 40000);
                }
                compared++;
                for (k = 0; k < 2; k++) {
                    const answer_t *y = k ? g : x;
                    if ((y[0].code == CCD_HIT) == (y[1].code == CCD_HIT))
                        continue;
                    differ++;
                    if (!q.touching && (y[1].code == CCD_HIT) != (p.truth.depth > 0))
                        fail(k ? "GJK verdict" : "MPR verdict", category, i, &p, &y[0], &y[1]);
                }
                if (x[0].code == CCD_HIT && x[1].code == CCD_HIT && isfinite(x[0].depth)) {
                    /* libccd's depth is the distance along its direction: what it would
                     * really have to be is the support value there */
                    double theirs = truth_dot3(x[0].dir, x[0].dir) > 0 ? truth_value(&p.a, &p.b, x[0].dir) : x[0].depth;
                    if (x[1].depth > fmax(theirs, x[0].depth) + fmax(tol, tolerance(TOL_PROMISED) * p.truth.depth) + 2 * q.noise)
                        fail("deeper than libccd's MPR", category, i, &p, &x[0], &x[1]);
                }
                if (g[0].code == CCD_HIT && g[1].code == CCD_HIT && isfinite(g[0].depth)
                    && fabs(g[1].depth - p.truth.depth) > fabs(g[0].depth - p.truth.depth) + tol + 2 * q.noise + p.truth.depth - p.truth.lower)
                    fail("farther from the truth than libccd's GJK", category, i, &p, &g[0], &g[1]);
            }
    printf("%d questions, %d verdicts differ, %d failures\n", compared, differ, failed);
    return failed > 0;
}
