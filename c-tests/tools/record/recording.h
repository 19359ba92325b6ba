/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Reads the recorded contact sequence (format: README.md). */

#ifndef RECORD_RECORDING_H
#define RECORD_RECORDING_H

#include "harness/shapes.h"

#include <stdint.h>
#include <stdio.h>

enum { POSE_BYTES = 28, PAIR_BYTES = 4, BOUNDS_BYTES = 16 }; /* in the file */

typedef struct {
    uint32_t shapes, bodies, frames, pairs;
    shape_t *shape;          /* in their own frames */
    uint32_t *shape_of;      /* by body */
    unsigned char **frame;   /* poses of each frame, then its pairs */
    uint32_t *frame_pairs;
    unsigned char *bytes;    /* the whole file */
    size_t size, truth_at;   /* of the file; offset of the truth */
    ccd_real_t *vertices;
} recording_t;

static inline void recording_free(recording_t *r)
{
    free(r->shape);
    free(r->shape_of);
    free(r->frame);
    free(r->frame_pairs);
    free(r->bytes);
    free(r->vertices);
    memset(r, 0, sizeof *r);
}

/* Copies the next bytes of the file. Returns 0, or -1 if fewer are left. */
static inline int recording_copy(const recording_t *r, size_t *at, void *to, size_t bytes)
{
    if (r->size - *at < bytes)
        return -1;
    memcpy(to, r->bytes + *at, bytes);
    *at += bytes;
    return 0;
}

static inline int recording_parse(recording_t *r)
{
    size_t at = 0, vertices = 0;
    char magic[8];
    uint32_t head[4], i, j, total = 0;
    if (recording_copy(r, &at, magic, sizeof magic) || memcmp(magic, "CCDREC01", 8) != 0 ||
        recording_copy(r, &at, head, sizeof head))
        return -1;
    r->shapes = head[0];
    r->bodies = head[1];
    r->frames = head[2];
    r->pairs = head[3];
    if (!r->shapes || !r->bodies || r->bodies > 4096 || r->shapes > 4096 || r->frames > 1000000)
        return -1;
    r->shape = (shape_t *)calloc(r->shapes, sizeof *r->shape);
    r->shape_of = (uint32_t *)calloc(r->bodies, sizeof *r->shape_of);
    r->frame = (unsigned char **)calloc((size_t)r->frames + 1, sizeof *r->frame);
    r->frame_pairs = (uint32_t *)calloc((size_t)r->frames + 1, sizeof *r->frame_pairs);
    r->vertices = (ccd_real_t *)malloc(r->size / 8 * sizeof *r->vertices);
    if (!r->shape || !r->shape_of || !r->frame || !r->frame_pairs || !r->vertices)
        return -1;
    for (i = 0; i < r->shapes; i++) {
        uint32_t kind[2];
        double p[3], x;
        if (recording_copy(r, &at, kind, sizeof kind) || recording_copy(r, &at, p, sizeof p) || kind[0] > SHAPE_POLYTOPE ||
            kind[1] > 100000)
            return -1;
        for (j = 0; j < 3 * kind[1] && !recording_copy(r, &at, &x, sizeof x); j++)
            r->vertices[vertices + j] = (ccd_real_t)x;
        if (j < 3 * kind[1])
            return -1;
        r->shape[i] = kind[0] == SHAPE_POLYTOPE ? shape_polytope(r->vertices + vertices, (int)kind[1])
                                                : shape_make((int)kind[0], p[0], p[1], p[2]);
        vertices += j;
    }
    for (i = 0; i < r->bodies; i++)
        if (recording_copy(r, &at, &r->shape_of[i], 4) || r->shape_of[i] >= r->shapes)
            return -1;
    for (i = 0; i < r->frames; i++) {
        const size_t poses = POSE_BYTES * (size_t)r->bodies;
        if (recording_copy(r, &at, &r->frame_pairs[i], 4) ||
            (r->size - at) / PAIR_BYTES < poses / PAIR_BYTES + r->frame_pairs[i])
            return -1;
        r->frame[i] = r->bytes + at;
        at += poses + PAIR_BYTES * (size_t)r->frame_pairs[i];
        total += r->frame_pairs[i];
    }
    r->truth_at = at;
    return total == r->pairs && r->size - at == BOUNDS_BYTES * (size_t)r->pairs ? 0 : -1;
}

/* Returns 0, or -1 if the file is not a whole recording; recording_free it either way. */
static inline int recording_read(const char *path, recording_t *r)
{
    FILE *file = fopen(path, "rb");
    long size = -1;
    memset(r, 0, sizeof *r);
    if (!file)
        return -1;
    if (fseek(file, 0, SEEK_END) == 0)
        size = ftell(file);
    rewind(file);
    r->size = size > 0 ? (size_t)size : 0;
    r->bytes = size > 0 ? (unsigned char *)malloc((size_t)size) : NULL;
    int bad = !r->bytes || fread(r->bytes, r->size, 1, file) != 1 || recording_parse(r) != 0;
    fclose(file);
    return bad ? -1 : 0;
}

/* Places the bodies of frame f. */
static inline void recording_place(const recording_t *r, uint32_t f, shape_t *body)
{
    for (uint32_t i = 0; i < r->bodies; i++) {
        float pose[7];
        double rot[9];
        memcpy(pose, r->frame[f] + POSE_BYTES * (size_t)i, sizeof pose);
        body[i] = r->shape[r->shape_of[i]];
        rotation_quaternion((double)pose[6], (double)pose[3], (double)pose[4], (double)pose[5], rot);
        shape_move(&body[i], (double)pose[0], (double)pose[1], (double)pose[2]);
        shape_turn(&body[i], rot);
    }
}

/* Returns the two bodies of pair i of frame f. */
static inline void recording_pair(const recording_t *r, uint32_t f, uint32_t i, unsigned *a, unsigned *b)
{
    uint16_t pair[2];
    memcpy(pair, r->frame[f] + POSE_BYTES * (size_t)r->bodies + PAIR_BYTES * (size_t)i, sizeof pair);
    *a = pair[0];
    *b = pair[1];
}

/* Returns bounds on the signed depth of the k-th pair of the whole recording: positive is penetration, negative the
 * distance apart. */
static inline void recording_truth(const recording_t *r, size_t k, double *lower, double *upper)
{
    double bounds[2];
    memcpy(bounds, r->bytes + r->truth_at + sizeof bounds * k, sizeof bounds);
    *lower = bounds[0];
    *upper = bounds[1];
}

#endif
