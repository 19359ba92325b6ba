/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* T25: local minima. Random overlapping boxes, asked cold and warm from guesses that
 * are wrong by 5 to 180 degrees. ccdMPRPenetration, cold or warm, is more than 1 %
 * above the global minimum in at most 1 % of them; ccdPenetrationLocal is the bare
 * method, whose rate is printed; ccdPenetrationProven never is.
 *
 * And the planar query: polygons in a common plane. Its answer stays in the plane, is
 * sound there, and never below the least over all directions of the plane.
 *
 *   starts [pairs] */

#include "categories.h"

static const double mpr_percent = 1;

static int planar(int pairs)
{
    static const double pi = 3.14159265358979323846;
    int i, k, failed = 0, hits = 0, least = 0;
    for (i = 0; i < pairs; i++) {
        static pair_t p;
        dice_t d = dice(5001, (uint64_t)i);
        double r[9], normal[3], u[3], v[3], at, angle, truth = HUGE_VAL, tol = 1e-6, noise;
        ccd_vec3_t plane;
        ccd_penetration_t x;
        ccd_t ccd;
        int code;
        dice_rotation(&d, r);
        p.a = pair_polygon(&d, p.verts[0], dice_in(&d, .2, 1));
        p.b = pair_polygon(&d, p.verts[1], dice_in(&d, .2, 1));
        shape_turn(&p.a, r);
        shape_turn(&p.b, r);
        for (k = 0; k < 3; k++) {
            u[k] = r[3 * k];
            v[k] = r[3 * k + 1];
            normal[k] = r[3 * k + 2];
            plane.v[k] = (ccd_real_t)(2 * normal[k]);
        }
        at = dice_in(&d, 0, 1.2) * pair_size(&p.a, &p.b) / 2;
        angle = dice_in(&d, 0, 2 * pi);
        shape_move(&p.b, at * (cos(angle) * u[0] + sin(angle) * v[0]), at * (cos(angle) * u[1] + sin(angle) * v[1]),
                   at * (cos(angle) * u[2] + sin(angle) * v[2]));
        /* the plane's directions by a fine sweep, then thirds of the best interval */
        for (k = 0; k < 2000; k++) {
            double c = cos(k * pi / 1000), s = sin(k * pi / 1000), m[3];
            m[0] = c * u[0] + s * v[0];
            m[1] = c * u[1] + s * v[1];
            m[2] = c * u[2] + s * v[2];
            if (truth_value(&p.a, &p.b, m) < truth) {
                truth = truth_value(&p.a, &p.b, m);
                angle = k * pi / 1000;
            }
        }
        for (at = pi / 1000; at > 1e-13; at *= 2. / 3)
            for (k = -1; k <= 1; k += 2) {
                double c = cos(angle + k * at / 3), s = sin(angle + k * at / 3), m[3];
                m[0] = c * u[0] + s * v[0];
                m[1] = c * u[1] + s * v[1];
                m[2] = c * u[2] + s * v[2];
                if (truth_value(&p.a, &p.b, m) < truth) {
                    truth = truth_value(&p.a, &p.b, m);
                    angle += k * at / 3;
                }
            }
        noise = pair_noise(&p.a, &p.b);
        shape_query(&ccd);
        ccd.mpr_tolerance = (ccd_real_t)tol;
        code = OURS(ccdPenetrationPlanar)(&p.a, &p.b, &ccd, &plane, NULL, CCD_WANT_ALL, &x);
        if (code == CCD_MISS ? truth > noise + 1e-12 : code != CCD_HIT || truth < -noise - 1e-12) {
            if (failed++ < 5)
                printf("FAILED planar %d: code %d, truth %.17g\n", i, code, truth);
            continue;
        }
        if (code == CCD_HIT) {
            double n[3], out;
            for (k = 0; k < 3; k++)
                n[k] = (double)x.dir.v[k];
            out = fabs(truth_dot3(n, normal));
            hits++;
            least += (double)x.depth <= 1.01 * truth + tol + 2 * noise;
            if (!(out <= 4 * tolerance(TOL_UNIT)) || !(fabs(sqrt(truth_dot3(n, n)) - 1) <= tolerance(TOL_UNIT))
                || !(fabs((double)x.depth - fmax(truth_value(&p.a, &p.b, n), 0)) <= 2 * noise)
                || !((double)x.depth >= truth - 2 * noise - 1e-12)) {
                if (failed++ < 5)
                    printf("FAILED planar %d: depth %.17g truth %.17g h(dir) %.17g out of plane %.3g\n", i, (double)x.depth,
                           truth, truth_value(&p.a, &p.b, n), out);
            }
        }
    }
    printf("planar: %d of %d overlap, %.2f %% are the least in the plane, %d failures\n", hits, pairs, 100. * least / hits, failed);
    return failed;
}

int main(int argc, char **argv)
{
    static const double degrees[] = {-1, 5, 25, 45, 80, 120, 180}; /* -1: cold */
    enum { STARTS = sizeof degrees / sizeof degrees[0] };
    static const entry_t methods[] = {
        {"MPR", 0, ASK_MPR_WARM, STATE_ZERO}, {"local", 0, ASK_LOCAL, STATE_ZERO}, {"minimum", 0, ASK_PROVEN, STATE_ZERO}};
    const int local = argc > 2 && strcmp(argv[2], "local") == 0;
    int pairs = argc > 1 ? atoi(argv[1]) : 1500, i, k, s, failed = 0, deep[3][STARTS];
    double calls[3][STARTS];
    memset(deep, 0, sizeof deep);
    for (k = 0; k < 3; k++)
        for (s = 0; s < STARTS; s++)
            calls[k][s] = 0;
    judge_begin();
    for (i = 0; i < pairs; i++) {
        static pair_t p;
        dice_t d = dice(5000, (uint64_t)i);
        do {
            double u[3], at;
            p.a = pair_shape(&d, p.verts[0], SHAPE_BOX, .1, 1);
            p.b = pair_shape(&d, p.verts[1], SHAPE_BOX, .1, 1);
            pair_turn(&d, &p.a);
            pair_turn(&d, &p.b);
            dice_unit(&d, u);
            at = dice_in(&d, 0, 1) * pair_size(&p.a, &p.b);
            shape_move(&p.b, at * u[0], at * u[1], at * u[2]);
            p.truth = truth_depth(&p.a, &p.b);
        } while (!(p.truth.depth > 1e-3));
        for (s = 0; s < STARTS; s++) {
            double axis[3], r[9], g[3], angle = degrees[s] * 3.14159265358979 / 180, l;
            ccd_vec3_t guess;
            /* turned about a random axis across the true normal */
            do {
                double w[3];
                dice_unit(&d, w);
                axis[0] = p.truth.n[1] * w[2] - p.truth.n[2] * w[1];
                axis[1] = p.truth.n[2] * w[0] - p.truth.n[0] * w[2];
                axis[2] = p.truth.n[0] * w[1] - p.truth.n[1] * w[0];
                l = truth_dot3(axis, axis);
            } while (!(l > .01));
            rotation_about(axis[0], axis[1], axis[2], angle, r);
            for (k = 0; k < 3; k++) {
                g[k] = r[3 * k] * p.truth.n[0] + r[3 * k + 1] * p.truth.n[1] + r[3 * k + 2] * p.truth.n[2];
                guess.v[k] = (ccd_real_t)g[k];
            }
            for (k = 0; k < 3; k++) {
                ccd_warm_t warm;
                ccd_t ccd;
                shape_t a = p.a, b = p.b;
                question_t q = question(&a, &b, 1e-6, &p.truth);
                answer_t x;
                int faults;
                memset(&warm, 0, sizeof warm);
                if (degrees[s] >= 0)
                    OURS(ccdWarmGuess)(&warm, &guess);
                shape_query(&ccd);
                ccd.support1 = ccd.support2 = judge_support;
                ccd.mpr_tolerance = ccd.epa_tolerance = (ccd_real_t)q.tol;
                x = ask_guarded(&methods[k], &a, &b, &ccd, &warm, &guess, 100000);
                calls[k][s] += (double)x.calls;
                faults = judge(&methods[k], &x, &a, &b, &q);
                deep[k][s] += (faults & FAULT_DEEPER) != 0;
                if (faults & FAULTS_NEVER && (local || methods[k].ask != ASK_LOCAL) && failed++ < 10) {
                    printf("FAILED %s from %g degrees, pair %d, truth %.17g: ", methods[k].name, degrees[s], i, p.truth.depth);
                    print_faults(stdout, faults & FAULTS_NEVER);
                    printf(": ");
                    print_answer(stdout, &x);
                    printf("\n");
                }
            }
        }
    }
    printf("more than 1 %% above the minimum, %% of %d box pairs (support points of D a query)\n", pairs);
    for (k = 0; k < 3; k++) {
        printf("%-8s", methods[k].name);
        for (s = 0; s < STARTS; s++) {
            double percent = 100. * deep[k][s] / pairs;
            char from[16];
            snprintf(from, sizeof from, degrees[s] < 0 ? "cold" : "%g deg", degrees[s]);
            printf("  %s %.2f (%.1f)", from, percent, calls[k][s] / 2 / pairs);
            if ((k == 0 && percent > mpr_percent) || (k == 2 && deep[k][s])) {
                printf(" FAILED");
                failed++;
            }
        }
        printf("\n");
    }
    failed += planar(pairs);
    printf("%d failures\n", failed);
    return failed > 0;
}
