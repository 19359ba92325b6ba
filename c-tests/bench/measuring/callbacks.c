/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The support functions and pair sets of the C tests, as a shared object for the
 * benchmark: every method measured calls these same callbacks. Shapes are opaque
 * to the benchmark; it owns their memory and asks here for their size. */

#include "harness/pairs.h"
#include "tools/record/recording.h"

size_t bench_shape_size(void) { return sizeof(shape_t); }

void bench_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out) { shape_support(obj, dir, out); }

void bench_center(const void *obj, ccd_vec3_t *out) { shape_center(obj, out); }

unsigned long bench_calls(const shape_t *s) { return s->calls; }

/* Where a shape is: position and rotation, row by row. */
void bench_pose(const shape_t *s, double pos[3], double rot[9])
{
    memcpy(pos, s->pos, sizeof s->pos);
    memcpy(rot, s->rot, sizeof s->rot);
}

/* A pair set, with how many poses and steps of one motion (0: independent poses); NULL where there
 * is none. It stays: shapes refer to its vertices. */
pair_set_t *bench_set(const char *path, int *n, int *trajectory)
{
    pair_set_t *set = (pair_set_t *)malloc(sizeof *set);
    if (!set || pair_set_read(path, set) != 0)
        return NULL;
    *n = set->n;
    *trajectory = set->trajectory;
    return set;
}

void bench_set_pose(const pair_set_t *set, int i, shape_t *a, shape_t *b, pair_truth_t *truth)
{
    pair_set_pose(set, i, a, b, truth);
}

/* Where a profiler is told to begin and to end a part of its output. */
__attribute__((noinline)) void bench_begin(void) { __asm__ volatile(""); }

__attribute__((noinline)) void bench_end(void) { __asm__ volatile(""); }

typedef struct {
    unsigned a, b, frame;
    double lower, upper; /* of the signed depth */
} bench_recorded_t;

/* How many pairs the first frames of a recording ask about, 0 where there is none; where not NULL, the
 * two shapes of each go to shape and what is known of it to out. */
size_t bench_recording(const char *path, unsigned frames, shape_t *shape, bench_recorded_t *out)
{
    static recording_t r; /* it stays: shapes refer to its vertices */
    shape_t *body;
    size_t k = 0;
    if (!r.bytes && recording_read(path, &r) != 0)
        return 0;
    body = (shape_t *)malloc(r.bodies * sizeof *body);
    for (unsigned f = 0; body && f < frames && f < r.frames; f++) {
        recording_place(&r, f, body);
        for (unsigned i = 0; i < r.frame_pairs[f]; i++, k++)
            if (shape) {
                recording_pair(&r, f, i, &out[k].a, &out[k].b);
                recording_truth(&r, k, &out[k].lower, &out[k].upper);
                out[k].frame = f;
                shape[2 * k] = body[out[k].a];
                shape[2 * k + 1] = body[out[k].b];
            }
    }
    free(body);
    return k;
}
