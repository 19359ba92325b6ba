/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Is the minimum the minimum? ccdPenetrationProven and ccdGJKPenetration against the
 * exact truth, on random pairs of every kind of shapes, at a tolerance of 1e-6 and of
 * 1e-10 times the size (in single precision 1e-3 and what TOL_TIGHT says), at scales of
 * 1e-6 m to 1e6 m.
 *
 *   exact [pairs a kind [first pair [kind, -1 all]]]
 *
 * Pair i of a kind is always the same pair, so that a long campaign may be run in
 * parts. Prints a table and exits with 1 when an answer is
 *
 *   wrong     |depth - truth| > tolerance + the truth's own gap + 16 ulps
 *   unsound   the support value along dir is not the depth
 *   no proof  depth - depth_lower > 1.1 tolerances + 16 ulps (the bound is rounded down by its own
 *             error once the search has ended), or depth_lower above the truth
 *   bad code  anything but an answer (a touch to 16 ulps may be a miss); CCD_LIMIT only
 *             where minima form a curve or surface, or so nearly that a proof needs more
 *             points than the cap (counted apart), and then the depth must be right all
 *             the same
 *
 * with the first pairs that show it. */

#include "categories.h"

#include <time.h>

static const struct {
    const char *name;
    int a, b;
} kinds[] = {
    {"sphere, sphere", SHAPE_SPHERE, SHAPE_SPHERE},
    {"sphere, capsule", SHAPE_SPHERE, SHAPE_CAPSULE},
    {"capsule, capsule", SHAPE_CAPSULE, SHAPE_CAPSULE},
    {"box, box", SHAPE_BOX, SHAPE_BOX},
    {"box, sphere", SHAPE_BOX, SHAPE_SPHERE},
    {"box, capsule", SHAPE_BOX, SHAPE_CAPSULE},
    {"hull, hull", SHAPE_POLYTOPE, SHAPE_POLYTOPE},
    {"hull, box", SHAPE_POLYTOPE, SHAPE_BOX},
    {"hull, capsule", SHAPE_POLYTOPE, SHAPE_CAPSULE},
    {"cylinder, box", SHAPE_CYLINDER, SHAPE_BOX},
    {"cylinder, capsule", SHAPE_CYLINDER, SHAPE_CAPSULE},
    {"cone, cylinder", SHAPE_CONE, SHAPE_CYLINDER},
    {"cone, hull", SHAPE_CONE, SHAPE_POLYTOPE},
    {"ellipsoid, ellipsoid", SHAPE_ELLIPSOID, SHAPE_ELLIPSOID},
    {"ellipsoid, hull", SHAPE_ELLIPSOID, SHAPE_POLYTOPE},
};
enum { KINDS = sizeof kinds / sizeof kinds[0] };

/* Where the second shape is. */
enum { SCATTERED, DEEP, SHALLOW, ON_AXIS, NEARLY_CENTRED, CENTRED, PLACES };

static void exact_pair(int kind, uint64_t index, pair_t *p)
{
    dice_t dd = dice((uint64_t)kind + 1000, index), *d = &dd;
    double scale = pow(10, 3 * (dice_below(d, 5) - 2)), u[3], x;
    int place = dice_below(d, PLACES), k;
    memset(p, 0, sizeof *p);
    p->a = pair_shape(d, p->verts[0], kinds[kind].a, .1 * scale, scale);
    p->b = pair_shape(d, p->verts[1], kinds[kind].b, .1 * scale, scale);
    if (place != ON_AXIS || dice_below(d, 2)) {
        pair_turn(d, &p->a);
        if (place != ON_AXIS)
            pair_turn(d, &p->b);
        else
            shape_turn(&p->b, (double[9]){(double)p->a.rot[0], (double)p->a.rot[1], (double)p->a.rot[2], (double)p->a.rot[3],
                                           (double)p->a.rot[4], (double)p->a.rot[5], (double)p->a.rot[6], (double)p->a.rot[7],
                                           (double)p->a.rot[8]});
    }
    switch (place) {
    case SCATTERED:
    case SHALLOW:
        pair_scatter(d, p, 1, 1e-3 * scale);
        if (place == SHALLOW)
            pair_pull_out(p, pair_size(&p->a, &p->b) * dice_log(d, 1e-8, 1e-2));
        break;
    case DEEP:
        pair_scatter(d, p, .2, 1e-3 * scale);
        break;
    case ON_AXIS:
        x = dice_in(d, 0, .3) * scale;
        k = dice_below(d, 3);
        shape_move(&p->b, x * (double)p->a.rot[k], x * (double)p->a.rot[3 + k], x * (double)p->a.rot[6 + k]);
        break;
    case NEARLY_CENTRED:
        dice_unit(d, u);
        x = scale * dice_log(d, 1e-18, 1e-4);
        shape_move(&p->b, x * u[0], x * u[1], x * u[2]);
        break;
    default:
        break;
    }
    p->truth = truth_depth(&p->a, &p->b);
    /* a hull need not hold its centre */
    for (k = 0; k < 60 && !(p->truth.lower > 1e-9 * pair_size(&p->a, &p->b)); k++) {
        pair_pull_out(p, pair_size(&p->a, &p->b) * dice_log(d, 1e-8, .1));
        p->truth = truth_depth(&p->a, &p->b);
    }
    pair_grow(p);
}

typedef struct {
    int asked, wrong, unsound, unproven, bad, limit;
    double error; /* the worst, in tolerances */
    double calls;
} row_t;

static int shown;

static void show(const char *what, int kind, int pair, double tol, const entry_t *e, const pair_t *p, const answer_t *x)
{
    if (shown++ >= 8)
        return;
    printf("%s: %s, pair %d, tolerance %g, %s: truth %.17g (lower %.17g) along %.17g %.17g %.17g%s\n  ", what,
           kinds[kind].name, pair, tol, e->name, p->truth.depth, p->truth.lower, p->truth.n[0], p->truth.n[1], p->truth.n[2],
           pair_may_stop(p, tol * pair_size(&p->a, &p->b)) ? ", surface" : "");
    print_answer(stdout, x);
    printf("\n  ");
    print_shape(stdout, "a", &p->a);
    printf("  ");
    print_shape(stdout, "b", &p->b);
}

int main(int argc, char **argv)
{
    int pairs = argc > 1 ? atoi(argv[1]) : 1000, first = argc > 2 ? atoi(argv[2]) : 0, only = argc > 3 ? atoi(argv[3]) : -1;
    int kind, i, k, t, failed = 0;
    const int single = sizeof(ccd_real_t) == sizeof(float);
    const double tols[] = {single ? 1e-3 : 1e-6, single ? tolerance(TOL_TIGHT) : 1e-10};
    static row_t table[KINDS][ENTRIES][2];
    static pair_t p;
    if (pairs < 1) {
        fprintf(stderr, "usage: exact [pairs a kind [first pair [kind]]]\n");
        return 2;
    }
    judge_begin();
    for (kind = 0; kind < KINDS; kind++) {
        time_t began = time(NULL), told = began;
        if (only >= 0 && kind != only)
            continue;
        for (i = 0; i < pairs; i++) {
            exact_pair(kind, (uint64_t)first + (uint64_t)i, &p);
            if (time(NULL) > told + 4 || i == pairs - 1) {
                told = time(NULL);
                fprintf(stderr, "\r%d/%d %-22s %d/%d, %ld s", kind + 1, KINDS, kinds[kind].name, i + 1, pairs,
                        (long)(told - began));
            }
            for (k = 0; k < (int)ENTRIES; k++) {
                const entry_t *e = &entries[k];
                if (e->system || e->state != STATE_NONE || (e->ask != ASK_PROVEN && e->ask != ASK_GJK))
                    continue;
                for (t = 0; t < 2; t++) {
                    double tol = tols[t] * pair_size(&p.a, &p.b), noise = pair_noise(&p.a, &p.b);
                    answer_t x = ask(e, &p.a, &p.b, tol, p.truth.n, 400000);
                    row_t *r = &table[kind][k][t];
                    double error;
                    r->asked++;
                    r->calls += (double)x.calls;
                    if (x.code == CCD_MISS && p.truth.lower <= noise)
                        continue; /* touching, to rounding */
                    if (x.code != CCD_HIT && !(x.code == CCD_LIMIT && pair_may_stop(&p, tol))) {
                        r->bad++;
                        show("bad code", kind, first + i, tols[t], e, &p, &x);
                        continue;
                    }
                    r->limit += x.code == CCD_LIMIT;
                    /* the truth is between its two bounds */
                    error = fmax(x.depth - p.truth.depth, p.truth.lower - x.depth);
                    r->error = fmax(r->error, (error - noise) / tol);
                    if (!(error <= tol + noise + (p.truth.depth - p.truth.lower))) {
                        r->wrong++;
                        show("wrong", kind, first + i, tols[t], e, &p, &x);
                    }
                    if (!(fabs(truth_value(&p.a, &p.b, x.dir) - x.depth) <= noise)) {
                        r->unsound++;
                        show("unsound", kind, first + i, tols[t], e, &p, &x);
                    }
                    if (x.has_proof
                        && !((x.code == CCD_LIMIT || x.depth - x.lower <= tol + tolerance(TOL_PROOF_FLOOR) * pair_largest(&p.a, &p.b) + noise) && x.lower <= p.truth.depth + noise)) {
                        r->unproven++;
                        show("no proof", kind, first + i, tols[t], e, &p, &x);
                    }
                }
            }
        }
        fprintf(stderr, "\n");
    }
    printf("Pairs %d to %d of each kind, scales 1e-6 m to 1e6 m, from 1e-8 of the size deep to coincident centres.\n\n", first,
           first + pairs - 1);
    printf("| kind | query | tolerance / size | pairs | wrong | unsound | no proof | bad code | stopped at the cap (curve or "
           "surface) | worst error / tolerance | supports |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (kind = 0; kind < KINDS; kind++)
        for (k = 0; k < (int)ENTRIES; k++)
            for (t = 0; t < 2; t++) {
                const row_t *r = &table[kind][k][t];
                if (!r->asked)
                    continue;
                printf("| %s | %s | %g | %d | %d | %d | %d | %d | %d | %.2g | %.1f |\n", kinds[kind].name, entries[k].name,
                       tols[t], r->asked, r->wrong, r->unsound, r->unproven, r->bad, r->limit, r->error,
                       r->calls / r->asked / 2);
                failed += r->wrong + r->unsound + r->unproven + r->bad;
            }
    printf("\n%d failures\n", failed);
    return failed > 0;
}
