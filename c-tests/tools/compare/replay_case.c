/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Repeats a case (case.h). Exits with 1 where the answer is wrong.
 *
 * usage: replay_case FILE LIBRARY libccd|warmccd */

#include "tools/compare/case.h"

#include <stdio.h>
#include <stdlib.h>

/* Recording callbacks take no part. */
void guard_end(void) { abort(); }

/* Reads so many numbers; ends the program where there are fewer. */
static void read_numbers(FILE *f, double *to, int n)
{
    for (int i = 0; i < n; i++)
        if (fscanf(f, "%lf", &to[i]) != 1) {
            fprintf(stderr, "replay_case: no whole case\n");
            exit(2);
        }
}

static void read_vectors(FILE *f, ccd_vec3_t *to, int n)
{
    for (int i = 0; i < n; i++) {
        double x[3];
        read_numbers(f, x, 3);
        ccdVec3Set(&to[i], (ccd_real_t)x[0], (ccd_real_t)x[1], (ccd_real_t)x[2]);
    }
}

int main(int argc, char **argv)
{
    static samples_t samples;
    char title[512] = "";
    double head[6], object_head[2];
    ccd_vec3_t truth_dir;
    library_t library;
    case_object_t object[2];
    ccd_t ccd;
    answer_t answer;
    FILE *f = argc == 4 ? fopen(argv[1], "r") : NULL;
    if (!f || library_open(&library, argv[2], strcmp(argv[3], "libccd") != 0) != 0) {
        fprintf(stderr, "usage: replay_case FILE LIBRARY libccd|warmccd\n");
        return 2;
    }
    if (!fgets(title, sizeof title, f))
        title[0] = '\0';
    read_numbers(f, head, 6);
    read_vectors(f, &truth_dir, 1);
    for (int which = 0; which < 2; which++) {
        read_numbers(f, object_head, 2);
        samples.has_centre[which] = object_head[0] != 0;
        samples.count[which] = object_head[1] >= 1 && object_head[1] <= MAX_SAMPLES ? (int)object_head[1] : 1;
        read_vectors(f, &samples.centre[which], 1);
    }
    read_vectors(f, &samples.first_dir, 1);
    for (int which = 0; which < 2; which++)
        for (int i = 0; i < samples.count[which]; i++)
            read_vectors(f, (ccd_vec3_t *)&samples.sample[which][i], 2);
    fclose(f);
    const verdict_truth_t truth = {head[2], head[3], head[4], head[5]};
    const query_t q = {head[0] >= 0 && head[0] < LIBCCD_CALL_COUNT ? (int)head[0] : 0, {&object[0], &object[1]}, &ccd};
    case_prepare(&samples, (unsigned long)head[1], truth.tolerance, object, &ccd);
    query_library(&library, &q, &answer);
    const verdict_t v = answer_verdict(&q, &answer, &truth);
    printf("then:  %snow:   %s: %s", title, call_table[q.call].name, answer.hit ? "hit" : "miss");
    if (answer.hit && !is_intersect(q.call))
        printf(", depth %.9g along (%.6g, %.6g, %.6g)", (double)answer.depth, (double)answer.dir.v[0], (double)answer.dir.v[1],
               (double)answer.dir.v[2]);
    printf(": %s\ntruth: signed depth at most %.9g (along (%.6g, %.6g, %.6g)), at least %.9g; tolerance %.3g\n", VERDICT_NAME[v],
           truth.upper, (double)truth_dir.v[0], (double)truth_dir.v[1], (double)truth_dir.v[2], truth.lower, truth.tolerance);
    return v != VERDICT_RIGHT;
}
