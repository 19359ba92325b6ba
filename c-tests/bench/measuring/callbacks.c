/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The support functions and pairs of the C tests, as a shared object for the benchmark: every method measured calls
 * these same callbacks. Shapes are opaque to the benchmark. */

#include "harness/pairs.h"
#include "tools/record/recording.h"

void bench_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out) { shape_support(obj, dir, out); }

void bench_center(const void *obj, ccd_vec3_t *out) { shape_center(obj, out); }

unsigned long bench_calls(const shape_t *s) { return s->calls; }

/* Returns the position of a shape, and its rotation, row by row. */
void bench_pose(const shape_t *s, double pos[3], double rot[9])
{
    memcpy(pos, s->pos, sizeof s->pos);
    memcpy(rot, s->rot, sizeof s->rot);
}

/* Mark for a profiler the begin and the end of a part of its output. */
__attribute__((noinline)) void bench_begin(void) { __asm__ volatile(""); }

__attribute__((noinline)) void bench_end(void) { __asm__ volatile(""); }

typedef struct {
    shape_t *a, *b;
    pair_truth_t truth;
    size_t motion, frame; /* poses of one motion with consecutive frames follow each other */
} bench_pose_t;

/* Returns room for n poses with their shapes, or NULL. */
static bench_pose_t *new_poses(size_t n)
{
    bench_pose_t *pose = (bench_pose_t *)calloc(n, sizeof *pose);
    shape_t *shape = (shape_t *)calloc(2 * n, sizeof *shape);
    for (size_t k = 0; pose && shape && k < n; k++) {
        pose[k].a = &shape[2 * k];
        pose[k].b = &shape[2 * k + 1];
    }
    return shape ? pose : NULL;
}

static size_t read_pair_set(const pair_set_t *set, bench_pose_t *pose)
{
    for (int i = 0; pose && i < set->n; i++, pose++) {
        pair_set_pose(set, i, pose->a, pose->b, &pose->truth);
        pose->motion = (size_t)(set->trajectory > 0 ? i / set->trajectory : i);
        pose->frame = (size_t)i;
    }
    return pose ? (size_t)set->n : 0;
}

static size_t read_recording(const recording_t *r, bench_pose_t *pose)
{
    size_t k = 0;
    shape_t *body = (shape_t *)malloc(r->bodies * sizeof *body);
    for (uint32_t f = 0; pose && body && f < r->frames; f++) {
        recording_place(r, f, body);
        for (uint32_t i = 0; i < r->frame_pairs[f]; i++, k++, pose++) {
            const recording_pair_t *pair = &r->pair[k];
            ccd_vec3_t center[2], d;
            *pose->a = body[pair->a];
            *pose->b = body[pair->b];
            shape_center(pose->a, &center[0]);
            shape_center(pose->b, &center[1]);
            ccdVec3Sub2(&d, &center[1], &center[0]);
            if (ccdVec3Len2(&d) > 0)
                ccdVec3Normalize(&d);
            else
                ccdVec3Set(&d, 1, 0, 0);
            memcpy(pose->truth.cold, d.v, sizeof d.v);
            pose->truth.depth = (pair->lower + pair->upper) / 2;
            pose->truth.gap = pair->upper - pair->lower;
            pose->motion = (size_t)pair->a * r->bodies + pair->b;
            pose->frame = f;
        }
    }
    free(body);
    return k;
}

/* Reads the poses of a pair set or of a recording. Returns their number, 0 on failure. Nothing is ever freed. */
size_t bench_scene(const char *path, bench_pose_t **poses)
{
    pair_set_t set;
    recording_t r;
    if (pair_set_read(path, &set) == 0)
        return read_pair_set(&set, *poses = new_poses((size_t)set.n));
    return recording_read(path, &r) == 0 ? read_recording(&r, *poses = new_poses(r.pairs)) : 0;
}
