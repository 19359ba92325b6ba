/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The same pair swapped, rotated, translated and scaled (the tolerance with it) gives
 * the same answer, within two tolerances; for polytopes within rounding.
 *
 *   metamorphic [pairs]
 *
 * Asserted for every entry point that proves its minimum. MPR proves it up to a
 * thousandth of the depth, and may differ by that. */

#include "categories.h"

enum { SWAPPED, ROTATED, TRANSLATED, SCALED, CHANGES };
static const char *const change_text[] = {"swapped", "rotated", "translated", "scaled"};

/* The pair changed; scale is the factor of all lengths. */
static void change(const pair_t *p, int what, dice_t *d, shape_t *a, shape_t *b, ccd_real_t verts[2][3 * PAIR_VERTICES],
                   double *scale)
{
    shape_t *s[2];
    double r[9], turned[9], rot[9], factor = dice_below(d, 2) ? 1024 : 1. / 1024;
    int i, k, m;
    *scale = 1;
    *a = what == SWAPPED ? p->b : p->a;
    *b = what == SWAPPED ? p->a : p->b;
    s[0] = a;
    s[1] = b;
    dice_rotation(d, r);
    for (k = 0; k < 2; k++)
        switch (what) {
        case ROTATED:
            for (i = 0; i < 9; i++)
                rot[i] = (double)s[k]->rot[i];
            rotation_times(r, rot, turned);
            {
                double x = (double)s[k]->pos[0], y = (double)s[k]->pos[1], z = (double)s[k]->pos[2];
                shape_turn(s[k], turned);
                shape_move(s[k], r[0] * x + r[1] * y + r[2] * z, r[3] * x + r[4] * y + r[5] * z, r[6] * x + r[7] * y + r[8] * z);
            }
            break;
        case TRANSLATED:
            for (i = 0; i < 3; i++)
                s[k]->pos[i] += (ccd_real_t)(i + 3.25);
            break;
        case SCALED: /* a power of two: no rounding */
            *scale = factor;
            for (i = 0; i < 3; i++) {
                s[k]->pos[i] *= (ccd_real_t)factor;
                s[k]->p[i] *= (ccd_real_t)factor;
                s[k]->centre[i] *= (ccd_real_t)factor;
            }
            for (m = 0; m < 3 * s[k]->nverts; m++)
                verts[k][m] = s[k]->verts[m] * (ccd_real_t)factor;
            if (s[k]->nverts)
                s[k]->verts = verts[k];
            break;
        default:
            break;
        }
}

static int polyhedral(const shape_t *s) { return s->type == SHAPE_BOX || s->type == SHAPE_POLYTOPE; }

int main(int argc, char **argv)
{
    int pairs = argc > 1 ? atoi(argv[1]) : 2000, i, k, what, failed = 0;
    static int differ[ENTRIES][CHANGES], asked[ENTRIES];
    static pair_t p;
    static ccd_real_t verts[2][3 * PAIR_VERTICES];
    judge_begin();
    for (i = 0; i < pairs; i++) {
        category_pair(i % 2 ? CATEGORY_GENERIC : CATEGORY_SHALLOW3, (uint64_t)(i / 2), SHAPE_TIE_SIGN, &p);
        for (k = 0; k < (int)ENTRIES; k++) {
            const entry_t *e = &entries[k];
            int exact = polyhedral(&p.a) && polyhedral(&p.b);
            double tol = (exact ? real_ulp() : tolerance(TOL_TIGHT)) * pair_size(&p.a, &p.b), bound, scale;
            answer_t x, y;
            if (e->system || e->state != STATE_NONE || e->ask == ASK_LOCAL || e->ask == ASK_ALONG)
                continue;
            x = ask(e, &p.a, &p.b, tol, p.truth.n, 100000);
            asked[k]++;
            for (what = 0; what < CHANGES; what++) {
                dice_t d = dice(2000 + (uint64_t)what, (uint64_t)i);
                shape_t a, b;
                truth_t t;
                int wrong = 0;
                change(&p, what, &d, &a, &b, verts, &scale);
                t = truth_depth(&a, &b);
                y = ask(e, &a, &b, tol * scale, t.n, 100000);
                bound = 4 * (pair_noise(&p.a, &p.b) + pair_noise(&a, &b) / scale);
                bound += exact ? 0 : 2 * tol;
                if (entry_is_mpr(e))
                    bound += tolerance(TOL_PROMISED) * p.truth.depth;
                if (x.code != y.code) {
                    wrong = 1;
                } else if (x.code == CCD_HIT && e->ask != ASK_MPR_INTERSECT && e->ask != ASK_GJK_INTERSECT) {
                    /* same depth, and the changed answer's direction serves the changed pair
                     * as well: minima that tie may trade places */
                    double by = fmax(fabs(y.depth / scale - x.depth), truth_value(&a, &b, y.dir) / scale - x.depth);
                    wrong = !(by <= bound);
                }
                differ[k][what] += wrong;
                if (wrong && failed++ < 10) {
                    printf("FAILED %s, %s, pair %d: depth %.17g (code %d), then %.17g (code %d), truth %.17g\n", e->name,
                           change_text[what], i, x.depth, x.code, y.depth / scale, y.code, p.truth.depth);
                    print_shape(stdout, "a", &p.a);
                    print_shape(stdout, "b", &p.b);
                }
            }
        }
    }
    for (k = 0; k < (int)ENTRIES; k++)
        if (asked[k]) {
            printf("%-16s", entries[k].name);
            for (what = 0; what < CHANGES; what++) {
                double percent = 100. * differ[k][what] / asked[k];
                printf("  %s %.2f %%", change_text[what], percent);
            }
            printf("\n");
        }
    printf("%d pairs, %d failures\n", pairs, failed);
    return failed > 0;
}
