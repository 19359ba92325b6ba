/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The truth of a recording, of every STRIDE-th pair, by truth.h from the very numbers in the file.
 *
 * usage: certify RECORDING STRIDE */

#include "tools/record/recording.h"
#include "harness/truth.h"

int main(int argc, char **argv)
{
    recording_t r;
    size_t k = 0, wrong = 0, checked = 0;
    double widest = 0;
    shape_t *body;
    const long stride = argc == 3 ? atol(argv[2]) : 0;
    if (stride < 1 || recording_read(argv[1], &r) != 0) {
        fprintf(stderr, "usage: certify RECORDING STRIDE\n");
        return 2;
    }
    body = (shape_t *)malloc(r.bodies * sizeof *body);
    for (uint32_t f = 0; body && f < r.frames; f++) {
        recording_place(&r, f, body);
        for (uint32_t i = 0; i < r.frame_pairs[f]; i++, k++) {
            unsigned a, b;
            double lower, upper;
            if (k % (size_t)stride)
                continue;
            recording_pair(&r, f, i, &a, &b);
            recording_truth(&r, k, &lower, &upper);
            truth_t t = truth_depth_within(&body[a], &body[b], 1e-10);
            checked++;
            widest = fmax(widest, upper - lower);
            /* both intervals hold the same number */
            if (!(lower <= t.depth + 1e-12 && t.lower <= upper + 1e-12)) {
                printf("pair %zu: the file says %.17g to %.17g, truth %.17g to %.17g\n", k, lower, upper, t.lower, t.depth);
                wrong++;
            }
        }
    }
    printf("%zu pairs, widest bounds %.1e m, %zu wrong\n", checked, widest, wrong);
    free(body);
    recording_free(&r);
    return checked == 0 || wrong != 0;
}
