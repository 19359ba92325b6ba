/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Every entry point that runs callbacks, asked in one way, so that a test can go through all
 * of them. Compiled with -DOURS_ALONE. */

#ifndef CONTRACT_EVERY_CALL_H
#define CONTRACT_EVERY_CALL_H

#include "check.h"
#include "harness/this_library.h"
#include "polytope.h"
#include "harness/shapes.h"

typedef struct {
    ccd_real_t depth;
    ccd_vec3_t dir, pos, normal; /* normal: of the extension's alone */
    support_t support;
} outputs_t;

/* __ccdSupport as an entry like the others. */
static const call_t support_entry = {"__ccdSupport", PAIR_CALL_COUNT, 0, 0, 0, 0, 0};

static inline int stored(int code, const ccd_penetration_t *p, outputs_t *out)
{
    if (code == CCD_HIT || code == CCD_LIMIT) {
        out->depth = p->depth;
        out->dir = p->dir;
        out->normal = p->normal;
        out->pos = p->pos;
        return CCD_HIT;
    }
    return code;
}

static inline int stored_distance(int code, const ccd_distance_t *d, outputs_t *out)
{
    /* Open bounds have a sign too. */
    if (code == CCD_LIMIT)
        code = d->distance < 0 ? CCD_HIT : CCD_MISS;
    if (code == CCD_HIT) {
        out->depth = -d->distance;
        out->dir = d->normal;
        for (int i = 0; i < 3; i++)
            out->pos.v[i] = (d->point1.v[i] + d->point2.v[i]) / 2;
    }
    return code;
}

/* Asks an entry for what is wanted. The extension's are asked from a cold state, and with that state
 * again; out is the second answer. */
static inline int run_wanting(int want, const call_t *entry, const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    const ccd_vec3_t along = {{1, 2, -2}}, plane = {{0, 0, 3}}, up = {{0, 1, 0}};
    ccd_contact_t contacts[4];
    ccd_manifold_cache_t cache;
    ccd_penetration_t full;
    ccd_distance_t distance;
    ccd_warm_t warm;
    call_args_t rest;
    int number = entry->number, code;
    if (number == PAIR_CALL_COUNT) {
        __ccdSupport(a, b, &up, ccd, &out->support);
        return 0;
    }
    memset(&warm, 0, sizeof warm);
    memset(&rest, 0, sizeof rest);
    rest.warm = &warm;
    rest.along = number == CALL_PLANAR ? &plane : &along;
    rest.max_distance = INFINITY;
    rest.slop = CCD_REAL(0.01);
    rest.want = want;
    rest.max = 4;
    rest.penetration = &full;
    rest.distance = &distance;
    memset(&cache, 0, sizeof cache);
    rest.cache = &cache;
    rest.contacts = contacts;
    if (number == CALL_CONTACTS) {
        code = call_library(number, a, b, ccd, &rest);
        if (code < 1)
            return code;
        /* Contacts whatever the pose is; what it returns is whether the pair overlaps. */
        number = CALL_LOCAL;
    }
    if (entry->traits & EXTENSION)
        call_library(number, a, b, ccd, &rest);
    rest.depth = &out->depth;
    rest.dir = &out->dir;
    rest.pos = want & CCD_WANT_POS ? &out->pos : NULL;
    code = call_library(number, a, b, ccd, &rest);
    if (number == CALL_DISTANCE)
        return stored_distance(code, &distance, out);
    /* The others of the extension fill a struct, and libccd's the outputs themselves. */
    return (entry->traits & EXTENSION) && (entry->traits & STORES) && number != CALL_MPR_WARM ? stored(code, &full, out) : code;
}

/* The same for everything. */
static inline int run(const call_t *entry, const void *a, const void *b, const ccd_t *ccd, outputs_t *out)
{
    return run_wanting(CCD_WANT_ALL, entry, a, b, ccd, out);
}

/* --- pairs ------------------------------------------------------------------ */

/* A random shape of unit size, near the origin. */
static inline shape_t random_shape(void)
{
    static const ccd_real_t corners[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, -1, -1, 0, 0, -1, -1, 0.5, 0.5, 0.5, -0.5, 0.5, -0.5};
    double p = uniform(0.3, 1), q = uniform(0.3, 1), r = uniform(0.3, 1), rot[9];
    int type = random_below(SHAPE_TYPES);
    shape_t s = type == SHAPE_POLYTOPE ? shape_polytope(corners, 7) : shape_make(type, p, q, r);
    rotation_quaternion(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), rot);
    shape_turn(&s, rot);
    return s;
}

/* A random polygon in the plane z = 0, for a planar query. */
static inline shape_t random_polygon(void)
{
    static const ccd_real_t corners[] = {1, 0, 0, 0, 1, 0, -1, 0.2f, 0, -0.3f, -0.8f, 0, 0.5f, -0.9f, 0};
    double rot[9];
    shape_t s = shape_polytope(corners, 5);
    rotation_about(0, 0, 1, uniform(0, 6), rot);
    shape_turn(&s, rot);
    return s;
}

/* A pair that certainly overlaps (deep) or certainly does not, and its query. What the
 * entry does not use is NULL. */
static inline void random_pair(const call_t *entry, int overlapping, shape_t *a, shape_t *b, ccd_t *ccd)
{
    const int planar = entry->number == CALL_PLANAR;
    double angle = uniform(0, 6.28), z = planar ? 0 : uniform(-1, 1), across = sqrt(1 - z * z);
    double distance = overlapping ? uniform(0, 0.1) : uniform(4, 6);
    *a = planar ? random_polygon() : random_shape();
    *b = planar ? random_polygon() : random_shape();
    shape_move(b, distance * across * cos(angle), distance * across * sin(angle), distance * z);
    *ccd = shape_query();
    if (entry->traits & FROM_FIRST_DIR)
        ccd->center1 = ccd->center2 = NULL;
    if (entry->traits & FROM_CENTERS)
        ccd->first_dir = NULL;
}

#endif
