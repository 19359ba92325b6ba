/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Reads the recorded contact sequence (format: README.md). */

#ifndef RECORD_RECORDING_H
#define RECORD_RECORDING_H

#include "harness/shapes.h"

#include <stdint.h>
#include <stdio.h>

typedef struct {
    uint16_t a, b;       /* bodies */
    double lower, upper; /* bounds on the signed depth: positive is penetration, negative the distance apart */
} recording_pair_t;

/* Lives as long as the program. */
typedef struct {
    uint32_t shapes, bodies, frames, pairs;
    shape_t *shape;        /* in their own frames */
    uint32_t *shape_of;    /* by body */
    float (*pose)[7];      /* of all bodies, frame by frame: position, quaternion */
    uint32_t *frame_pairs; /* number of pairs of each frame */
    recording_pair_t *pair; /* frame by frame */
} recording_t;

/* Reads n items. Returns whether the file has them. */
static inline int recording_items(FILE *file, void *to, size_t size, size_t n) { return fread(to, size, n, file) == n; }

static inline int recording_shape(FILE *file, shape_t *shape)
{
    uint32_t kind[2];
    double p[3], x;
    if (!recording_items(file, kind, 4, 2) || !recording_items(file, p, 8, 3) || kind[0] > SHAPE_POLYTOPE)
        return 0;
    ccd_real_t *vertices = (ccd_real_t *)malloc((3 * (size_t)kind[1] + 1) * sizeof(ccd_real_t));
    for (uint32_t j = 0; j < 3 * kind[1]; j++) {
        if (!vertices || !recording_items(file, &x, 8, 1))
            return 0;
        vertices[j] = (ccd_real_t)x;
    }
    *shape = kind[0] == SHAPE_POLYTOPE ? shape_polytope(vertices, (int)kind[1]) : shape_make((int)kind[0], p[0], p[1], p[2]);
    return 1;
}

static inline int recording_parse(FILE *file, recording_t *r)
{
    char magic[8];
    uint32_t head[4], k = 0;
    if (!recording_items(file, magic, 8, 1) || memcmp(magic, "CCDREC01", 8) != 0 || !recording_items(file, head, 4, 4))
        return 0;
    r->shapes = head[0];
    r->bodies = head[1];
    r->frames = head[2];
    r->pairs = head[3];
    r->shape = (shape_t *)calloc(r->shapes, sizeof *r->shape);
    r->shape_of = (uint32_t *)calloc(r->bodies, sizeof *r->shape_of);
    r->pose = (float (*)[7])calloc((size_t)r->frames * r->bodies, sizeof *r->pose);
    r->frame_pairs = (uint32_t *)calloc(r->frames, sizeof *r->frame_pairs);
    r->pair = (recording_pair_t *)calloc(r->pairs, sizeof *r->pair);
    if (!r->shape || !r->shape_of || !r->pose || !r->frame_pairs || !r->pair)
        return 0;
    for (uint32_t i = 0; i < r->shapes; i++)
        if (!recording_shape(file, &r->shape[i]))
            return 0;
    for (uint32_t i = 0; i < r->bodies; i++)
        if (!recording_items(file, &r->shape_of[i], 4, 1) || r->shape_of[i] >= r->shapes)
            return 0;
    for (uint32_t f = 0; f < r->frames; f++) {
        if (!recording_items(file, &r->frame_pairs[f], 4, 1) || r->frame_pairs[f] > r->pairs - k ||
            !recording_items(file, r->pose[(size_t)f * r->bodies], sizeof *r->pose, r->bodies))
            return 0;
        for (uint32_t last = k + r->frame_pairs[f]; k < last; k++)
            if (!recording_items(file, &r->pair[k].a, 2, 1) || !recording_items(file, &r->pair[k].b, 2, 1) ||
                r->pair[k].a >= r->bodies || r->pair[k].b >= r->bodies)
                return 0;
    }
    for (uint32_t i = 0; i < k; i++)
        if (!recording_items(file, &r->pair[i].lower, 8, 1) || !recording_items(file, &r->pair[i].upper, 8, 1))
            return 0;
    return k == r->pairs && fgetc(file) == EOF;
}

/* Returns 0, or -1 if the file is not a whole recording. */
static inline int recording_read(const char *path, recording_t *r)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return -1;
    const int is_whole = recording_parse(file, r);
    fclose(file);
    return is_whole ? 0 : -1;
}

/* Places the bodies of frame f. */
static inline void recording_place(const recording_t *r, uint32_t f, shape_t *body)
{
    for (uint32_t i = 0; i < r->bodies; i++) {
        const float *p = r->pose[(size_t)f * r->bodies + i];
        double rot[9];
        body[i] = r->shape[r->shape_of[i]];
        rotation_quaternion((double)p[6], (double)p[3], (double)p[4], (double)p[5], rot);
        shape_move(&body[i], (double)p[0], (double)p[1], (double)p[2]);
        shape_turn(&body[i], rot);
    }
}

#endif
