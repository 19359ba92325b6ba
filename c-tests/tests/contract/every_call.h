/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Every entry point that runs callbacks, called in one way, so that a test can loop over all of them.
 * Compiled with -DOURS_ALONE. */

#ifndef CONTRACT_EVERY_CALL_H
#define CONTRACT_EVERY_CALL_H

#include "check.h"
#include "harness/this_library.h"
#include "polytope.h"
#include "harness/shapes.h"

#include <stddef.h>

/* Memory for the outputs of any call. */
typedef struct {
    ccd_penetration_t penetration;
    ccd_distance_t distance;
    ccd_contact_t contacts[4];
    ccd_real_t depth;
    ccd_vec3_t dir, pos;
    support_t support;
} results_t;

static inline void clear_results(results_t *r) { memset(r, 0x5a, sizeof *r); }

/* Returns whether nothing was written to results that had been cleared. */
static inline int are_clear(const results_t *r)
{
    results_t clear;
    clear_results(&clear);
    return same_bits(r, &clear, sizeof clear);
}

/* Returns whether all outputs are the same bits, without padding. */
static inline int same_results(const results_t *x, const results_t *y)
{
    int is_same = same_bits(&x->penetration, &y->penetration, offsetof(ccd_penetration_t, status) + sizeof x->penetration.status)
        && same_bits(&x->distance, &y->distance, offsetof(ccd_distance_t, status) + sizeof x->distance.status)
        && same_bits(&x->depth, &y->depth, sizeof x->depth) && same_bits(&x->dir, &y->dir, sizeof x->dir)
        && same_bits(&x->pos, &y->pos, sizeof x->pos) && same_bits(&x->support, &y->support, sizeof x->support);
    for (int i = 0; i < 4; i++)
        is_same &= same_bits(&x->contacts[i], &y->contacts[i], offsetof(ccd_contact_t, id) + sizeof x->contacts[i].id);
    return is_same;
}

/* Returns whether a code is right for objects that overlap, or are apart: CCD_LIMIT is a hit except of a distance that is
 * not negative, and ccdContacts returns contacts of both. */
static inline int is_right(const call_t *call, int code, const results_t *results, int overlapping)
{
    if (call->kind == KIND_MANIFOLD)
        return code >= 1;
    if (call->bad == CCD_BAD_INPUT && code == CCD_LIMIT)
        return overlapping == (call->kind != KIND_DISTANCE || results->distance.distance < 0);
    return code == (overlapping ? call->hit : call->miss);
}

/* __ccdSupport as an entry like the others. */
static const call_t support_entry = {"__ccdSupport", PAIR_CALL_COUNT, 0, 0, 0, 0, 0};

/* Returns valid arguments of a call, without a state, whose outputs are in `results`. */
static inline call_args_t valid_arguments(const call_t *entry, results_t *results)
{
    static const ccd_vec3_t along = {{1, 2, -2}}, plane = {{0, 0, 3}}, normal = {{2, 0, 0}};
    call_args_t args;
    memset(&args, 0, sizeof args);
    args.along = entry->number == CALL_PLANAR ? &plane : entry->number == CALL_CONTACTS ? &normal : &along;
    args.max_distance = INFINITY;
    args.slop = CCD_REAL(1e-3);
    args.want = CCD_WANT_ALL;
    args.max = 4;
    args.depth = &results->depth;
    args.dir = &results->dir;
    args.pos = &results->pos;
    args.penetration = &results->penetration;
    args.distance = &results->distance;
    args.contacts = results->contacts;
    return args;
}

/* Runs a call and requests the results `want`; returns its code. A call of the extension runs from a cold state, and again
 * from the state that it left, for `out`. */
static inline int run_wanting(unsigned want, const call_t *entry, const void *a, const void *b, const ccd_t *ccd, results_t *out)
{
    const ccd_vec3_t up = {{0, 1, 0}};
    ccd_manifold_cache_t cache;
    ccd_warm_t warm;
    memset(&warm, 0, sizeof warm);
    memset(&cache, 0, sizeof cache);
    clear_results(out);
    call_args_t args = valid_arguments(entry, out);
    args.warm = &warm;
    args.cache = &cache;
    args.want = want;
    args.pos = want & CCD_WANT_POS ? args.pos : NULL;
    if (entry->number == PAIR_CALL_COUNT) {
        __ccdSupport(a, b, &up, ccd, &out->support);
        return 0;
    }
    if (entry->traits & EXTENSION)
        call_library(entry->number, a, b, ccd, &args);
    return call_library(entry->number, a, b, ccd, &args);
}

/* Runs a call and requests all results. */
static inline int run(const call_t *entry, const void *a, const void *b, const ccd_t *ccd, results_t *out)
{
    return run_wanting(CCD_WANT_ALL, entry, a, b, ccd, out);
}

/* --- pairs ------------------------------------------------------------------ */

/* Returns a random shape of unit size near the origin. */
static inline shape_t random_shape(void)
{
    static const ccd_real_t corners[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, -1, -1, 0, 0, -1, -1, 0.5, 0.5, 0.5, -0.5, 0.5, -0.5};
    double p = uniform(0.3, 1), q = uniform(0.3, 1), r = uniform(0.3, 1);
    int type = random_below(SHAPE_TYPES);
    shape_t s = type == SHAPE_POLYTOPE ? shape_polytope(corners, 7) : shape_make(type, p, q, r);
    turn_at_random(&s);
    return s;
}

/* Returns a random polygon in the plane z = 0. */
static inline shape_t flat_polygon(void)
{
    static const ccd_real_t corners[] = {1, 0, 0, 0, 1, 0, -1, 0.2f, 0, -0.3f, -0.8f, 0, 0.5f, -0.9f, 0};
    double rot[9];
    shape_t s = shape_polytope(corners, 5);
    rotation_about(0, 0, 1, uniform(0, 6), rot);
    shape_turn(&s, rot);
    return s;
}

/* Makes a pair that overlaps deeply or is far apart, and its ccd_t, in which callbacks that the call does not use
 * are NULL. */
static inline void random_pair(const call_t *entry, int overlapping, shape_t *a, shape_t *b, ccd_t *ccd)
{
    const int planar = entry->number == CALL_PLANAR;
    double angle = uniform(0, 6.28), z = planar ? 0 : uniform(-1, 1), across = sqrt(1 - z * z);
    double distance = overlapping ? uniform(0, 0.1) : uniform(4, 6);
    *a = planar ? flat_polygon() : random_shape();
    *b = planar ? flat_polygon() : random_shape();
    shape_move(b, distance * across * cos(angle), distance * across * sin(angle), distance * z);
    *ccd = shape_query();
    if (entry->traits & FROM_FIRST_DIR)
        ccd->center1 = ccd->center2 = NULL;
    if (entry->traits & FROM_CENTERS)
        ccd->first_dir = NULL;
}

#endif
