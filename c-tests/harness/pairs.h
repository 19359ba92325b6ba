/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Reader of the pair sets in c-tests/bench/pairs (format: README.md there): two shapes,
 * many poses, the certified global minimum of each. */

#ifndef TESTS_PAIRS_H
#define TESTS_PAIRS_H

#include "harness/shapes.h"

#include <stdint.h>
#include <stdio.h>

enum { PAIR_RECORD = 41 }; /* doubles a pose */

typedef struct {
    int n;              /* poses */
    int trajectory;     /* steps of one motion, 0: independent poses */
    shape_t a, b;       /* the shapes in their own frames */
    ccd_real_t *verts[2];
    double *records;
} pair_set_t;

/* The certified depth of one pose, to within gap, and start directions. */
typedef struct {
    double depth, gap;
    double normal[3]; /* b leaves along it */
    double init5[3], init25[3], init45[3]; /* so many degrees from normal */
    double cold[3];   /* the centre difference */
} pair_truth_t;

static inline int pair_read_shape(FILE *file, shape_t *s, ccd_real_t **verts)
{
    int32_t head[4];
    double p[3], x;
    *verts = NULL;
    if (fread(head, sizeof head, 1, file) != 1 || fread(p, sizeof p, 1, file) != 1)
        return -1;
    if (head[0] < SHAPE_SPHERE || head[0] > SHAPE_POLYTOPE || head[1] < 0 || head[2] < 0
        || head[1] > 1000000 || head[2] > 1000000)
        return -1;
    *s = shape_make(head[0], p[0], p[1], p[2]);
    *verts = (ccd_real_t *)malloc(sizeof(ccd_real_t) * 3 * ((size_t)head[1] + 1));
    if (!*verts)
        return -1;
    for (int i = 0; i < 3 * head[1]; i++) {
        if (fread(&x, sizeof x, 1, file) != 1)
            return -1;
        (*verts)[i] = (ccd_real_t)x;
    }
    for (int i = 0; i < 3 * head[2]; i++) {
        int32_t t;
        if (fread(&t, sizeof t, 1, file) != 1 || t < 0 || t >= head[1])
            return -1;
    }
    s->verts = *verts;
    s->nverts = head[1];
    return 0;
}

static inline void pair_set_free(pair_set_t *set)
{
    for (int i = 0; i < 2; i++)
        free(set->verts[i]);
    free(set->records);
    memset(set, 0, sizeof *set);
}

/* Returns 0, or -1 when the file is no complete pair set; free it in both cases. */
static inline int pair_set_read(const char *path, pair_set_t *set)
{
    char magic[8];
    int32_t count[2];
    FILE *file = fopen(path, "rb");
    memset(set, 0, sizeof *set);
    if (!file)
        return -1;
    int bad = fread(magic, 8, 1, file) != 1 || memcmp(magic, "PDBN0001", 8) != 0
        || fread(count, sizeof count, 1, file) != 1 || count[0] < 1 || count[0] > 10000000
        || pair_read_shape(file, &set->a, &set->verts[0]) != 0
        || pair_read_shape(file, &set->b, &set->verts[1]) != 0;
    if (!bad) {
        set->n = count[0];
        set->trajectory = count[1];
        set->records = (double *)malloc(sizeof(double) * PAIR_RECORD * (size_t)set->n);
        bad = !set->records
            || fread(set->records, sizeof(double) * PAIR_RECORD, (size_t)set->n, file) != (size_t)set->n;
    }
    fclose(file);
    return bad ? -1 : 0;
}

/* Writes the two placed shapes of pose i and, unless truth is NULL, its certified depth. */
static inline void pair_set_pose(const pair_set_t *set, int i, shape_t *a, shape_t *b, pair_truth_t *truth)
{
    const double *r = set->records + (size_t)PAIR_RECORD * (size_t)i;
    *a = set->a;
    *b = set->b;
    shape_move(a, r[0], r[1], r[2]);
    shape_turn(a, r + 3);
    shape_move(b, r[12], r[13], r[14]);
    shape_turn(b, r + 15);
    if (!truth)
        return;
    truth->depth = r[24];
    memcpy(truth->normal, r + 25, sizeof truth->normal);
    truth->gap = r[28];
    memcpy(truth->init5, r + 29, sizeof truth->init5);
    memcpy(truth->init25, r + 32, sizeof truth->init25);
    memcpy(truth->init45, r + 35, sizeof truth->init45);
    memcpy(truth->cold, r + 38, sizeof truth->cold);
}

#endif
