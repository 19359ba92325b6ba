/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Gives a recording its truth: bounds on the signed depth of every pair, from
 * truth.h, about the very numbers in the file.
 *
 * usage: certify RECORDING          appends the truth (or renews it)
 *        certify RECORDING STRIDE   checks that of every STRIDE-th pair instead */

#include "record/recording.h"
#include "truth.h"

/* What the bounds are closed to, metres. */
static const double WIDTH = 1e-10;

int main(int argc, char **argv)
{
    recording_t r;
    uint32_t f, i;
    size_t k = 0, wrong = 0, checked = 0;
    double widest = 0;
    double *truth;
    shape_t *body;
    const long stride = argc == 3 ? atol(argv[2]) : 1;
    if (argc < 2 || argc > 3 || stride < 1 || recording_read(argv[1], &r) != 0 || (argc == 3 && !r.truth_at)) {
        fprintf(stderr, "usage: certify RECORDING [STRIDE]\n");
        return 2;
    }
    truth = (double *)calloc(r.pairs + 1, RECORDING_TRUTH * sizeof *truth);
    body = (shape_t *)malloc(r.bodies * sizeof *body);
    if (!truth || !body)
        return 2;
    for (f = 0; f < r.frames; f++) {
        recording_place(&r, f, body);
        for (i = 0; i < r.frame_pairs[f]; i++, k++) {
            unsigned a, b;
            truth_t t;
            if (k % (size_t)stride)
                continue;
            recording_pair(&r, f, i, &a, &b);
            t = truth_depth_within(&body[a], &body[b], WIDTH);
            checked++;
            widest = fmax(widest, t.depth - t.lower);
            truth[RECORDING_TRUTH * k] = t.lower;
            truth[RECORDING_TRUTH * k + 1] = t.depth;
            if (argc == 3) {
                double lower, upper;
                recording_truth(&r, k, &lower, &upper);
                /* both intervals hold the same number */
                if (!(lower <= t.depth + 1e-12 && t.lower <= upper + 1e-12)) {
                    printf("pair %zu: the file says %.17g to %.17g, truth %.17g to %.17g\n", k, lower, upper, t.lower, t.depth);
                    wrong++;
                }
            }
        }
        if (argc == 2 && f % 30 == 0)
            fprintf(stderr, "frame %u of %u, widest bounds so far %.1e m\n", (unsigned)f, (unsigned)r.frames, widest);
    }
    if (argc == 2) {
        FILE *file = fopen(argv[1], "r+b");
        const size_t at = r.truth_at ? r.truth_at : r.size;
        if (!file || fseek(file, (long)at, SEEK_SET) != 0
            || fwrite(truth, RECORDING_TRUTH * sizeof *truth, r.pairs, file) != r.pairs || fclose(file) != 0) {
            perror(argv[1]);
            return 2;
        }
    }
    printf("%zu pairs, widest bounds %.1e m, %zu wrong\n", checked, widest, wrong);
    free(truth);
    free(body);
    recording_free(&r);
    return wrong != 0;
}
