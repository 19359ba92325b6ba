/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks every call with every kind of argument: invalid values and NULL; support functions that return NaN or
 * arbitrary points; few iterations; degenerate objects; unused fields of ccd_t; the requested results. Each call
 * returns a documented code, writes outputs only with a result, and ends: the number of support points is bounded.
 *
 *   arguments [percent of the random inputs] */

#include "every_call.h"
#include <math.h>
#include <stddef.h>

static int percent = 100;

static const ccd_vec3_t dir = {{1, 2, -2}};
static const ccd_real_t tiny = -CCD_REAL(1e-9), inf = (ccd_real_t)INFINITY, nan_value = (ccd_real_t)NAN;

/* Two square slabs that overlap by 0.25 along x, and their ccd_t. */
static shape_t slab1, slab2;
static ccd_t slabs;

static void set_slabs(void)
{
    slab1 = slab2 = shape_box(1, 1, 1);
    shape_move(&slab2, 1.75, 0.25, 0);
    slabs = shape_query();
    slabs.mpr_tolerance = slabs.epa_tolerance = slabs.dist_tolerance = CCD_REAL(1e-6);
}

/* --- invalid arguments --------------------------------------------------------------- */

/* Arguments that calls read, beside the traits of calls.h. */
enum { READS_DIR = 1 << 16, READS_WANT = 1 << 17, NEEDS_OUT = 1 << 18, READS_MARGINS = 1 << 19, READS_SLOP = 1 << 20 };

static int reads(const call_t *call)
{
    static const int of_kind[] = {[KIND_PENETRATION] = READS_WANT | NEEDS_OUT,
                                  [KIND_PENETRATION_ALONG] = READS_WANT | NEEDS_OUT | READS_DIR,
                                  [KIND_MANIFOLD] = NEEDS_OUT | READS_DIR | READS_SLOP,
                                  [KIND_DISTANCE] = READS_WANT | NEEDS_OUT | READS_MARGINS};
    return call->traits | of_kind[call->kind];
}

/* The code of the slabs: an overlap, or four contacts. */
static int valid_code(const call_t *call) { return call->kind == KIND_MANIFOLD ? 4 : call->hit; }

static results_t results, blank_results; /* static: their padding is equal */
static int evaluations, returned_invalid;

static void clear_results(void)
{
    memset(&blank_results, 0x5a, sizeof blank_results);
    memcpy(&results, &blank_results, sizeof results);
    evaluations = returned_invalid = 0;
}

/* Calls without a state and with one. Checks the code, which is call->bad where a callback returned an invalid
 * point, and that call->bad leaves state and outputs unchanged. */
static void expect(const call_t *call, const ccd_t *ccd, const call_args_t *arguments, int code, const char *what)
{
    for (int has_state = 0; has_state < 2; has_state++) {
        call_args_t args = *arguments;
        ccd_warm_t guess, warm;
        ccdWarmGuess(&guess, &dir);
        warm = guess;
        if (has_state)
            args.warm = &warm;
        clear_results();
        const int returned = call_library(call->number, &slab1, &slab2, ccd, &args);
        const int expected = returned_invalid ? call->bad : code;
        CHECK(returned == expected, "%s, %s, state %d: %d", call->name, what, has_state, returned);
        if (expected == call->bad) {
            CHECK(same_bits(&results, &blank_results, sizeof results), "%s, %s: an output was written", call->name, what);
            CHECK(same_bits(&warm, &guess, sizeof warm), "%s, %s: the state was written", call->name, what);
        }
    }
}

static ccd_real_t invalid_value;
static int first_invalid;

static void invalid_support(const void *obj, const ccd_vec3_t *d, ccd_vec3_t *out)
{
    shape_support(obj, d, out);
    if (evaluations++ >= first_invalid) {
        out->v[evaluations % 3] = invalid_value;
        returned_invalid = 1;
    }
}

static void invalid_center(const void *obj, ccd_vec3_t *out)
{
    shape_center(obj, out);
    out->v[1] = invalid_value;
}

static void invalid_callbacks(const call_t *call, const call_args_t *args)
{
    const ccd_real_t values[] = {nan_value, inf, -inf};
    const int valid = valid_code(call), bad = call->bad;
    ccd_t ccd;
    expect(call, NULL, args, bad, "no ccd_t");
    for (int i = 0; i < 2; i++) {
        ccd = slabs;
        *(i ? &ccd.support2 : &ccd.support1) = NULL;
        expect(call, &ccd, args, bad, "no support function");
    }
    for (int i = 1; i < 4; i++) {
        ccd = slabs;
        if (i & 1)
            ccd.center1 = NULL;
        if (i & 2)
            ccd.center2 = NULL;
        expect(call, &ccd, args, call->traits & FROM_CENTERS ? bad : valid, "no center");
        ccd.first_dir = NULL;
        expect(call, &ccd, args, call->traits & (FROM_CENTERS | FROM_FIRST_DIR) ? bad : valid, "no center, no first_dir");
    }
    for (int i = 0; i < 6; i++) {
        invalid_value = values[i % 3];
        ccd = slabs;
        *(i < 3 ? &ccd.center1 : &ccd.center2) = invalid_center;
        expect(call, &ccd, args, call->traits & (FROM_FIRST_DIR | ONE_BY_ONE) ? valid : bad, "an invalid center");
        ccd = slabs;
        *(i < 3 ? &ccd.support1 : &ccd.support2) = invalid_support;
        first_invalid = 0;
        do
            expect(call, &ccd, args, valid, "invalid points");
        while (returned_invalid && ++first_invalid < 1000);
        CHECK(!returned_invalid, "%s: no end", call->name);
    }
}

static void invalid_lengths(const call_t *call, const call_args_t *valid_args)
{
    /* libccd's calls replace an invalid tolerance by their default */
    const int tolerances = reads(call) & READS_WANT ? ~0 : 0;
    const struct { const char *name; int in_ccd; size_t offset; int readers, may_be_infinite; } rows[] = {
        {"mpr_tolerance", 1, offsetof(ccd_t, mpr_tolerance), MPR_TOLERANCE & tolerances, 1},
        {"epa_tolerance", 1, offsetof(ccd_t, epa_tolerance), EPA_TOLERANCE & tolerances, 1},
        {"dist_tolerance", 1, offsetof(ccd_t, dist_tolerance), DIST_TOLERANCE & tolerances, 1},
        {"margin1", 0, offsetof(call_args_t, margin1), READS_MARGINS, 0},
        {"margin2", 0, offsetof(call_args_t, margin2), READS_MARGINS, 0},
        {"max_distance", 0, offsetof(call_args_t, max_distance), READS_MARGINS, 1},
        {"slop", 0, offsetof(call_args_t, slop), READS_SLOP, 1},
    };
    const ccd_real_t values[] = {nan_value, tiny, -inf, inf, 0};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int k = 0; k < 5; k++) {
            const int is_read = reads(call) & rows[i].readers, is_infinite = values[k] == inf;
            const int is_invalid = is_infinite ? !rows[i].may_be_infinite : !(values[k] >= 0);
            ccd_t ccd = slabs;
            call_args_t args = *valid_args;
            memcpy((rows[i].in_ccd ? (char *)&ccd : (char *)&args) + rows[i].offset, &values[k], sizeof values[k]);
            /* An infinite slop merges all contacts. */
            const int code = is_read & READS_SLOP && is_infinite ? 1 : valid_code(call);
            expect(call, &ccd, &args, is_read && is_invalid ? call->bad : code, rows[i].name);
        }
}

static void invalid_others(const call_t *call, const call_args_t *valid_args)
{
    const ccd_real_t values[] = {nan_value, inf, -inf};
    const int valid = valid_code(call), bad = call->bad, read = reads(call);
    call_args_t args = *valid_args;
    ccd_vec3_t d = {{0, 0, 0}};
    args.depth = NULL;
    args.dir = args.pos = NULL;
    args.penetration = NULL;
    args.distance = NULL;
    args.contacts = NULL;
    expect(call, &slabs, &args, read & NEEDS_OUT ? bad : valid, "no outputs");
    args = *valid_args;
    for (int i = 0; i < 32; i++) {
        args.want = 1u << i;
        expect(call, &slabs, &args, read & READS_WANT && i > 1 ? bad : valid, "a flag");
    }
    args = *valid_args;
    args.along = NULL;
    expect(call, &slabs, &args, read & READS_DIR ? bad : valid, "no direction");
    args.along = &d;
    expect(call, &slabs, &args, read & READS_DIR ? bad : valid, "direction 0");
    for (int i = 0; i < 9; i++) {
        d = *valid_args->along;
        d.v[i % 3] = values[i / 3];
        expect(call, &slabs, &args, read & READS_DIR ? bad : valid, "a direction that is not finite");
    }
    for (int i = -1; i < 2; i++) {
        args = *valid_args;
        args.max = i > 0 ? 2147483647 : i;
        expect(call, &slabs, &args, i < 1 && read & READS_SLOP ? bad : valid, "number of contacts");
    }
}

/* --- arbitrary support functions ------------------------------------------------------ */

/* Returns listed points in place of the object's own, adds them or multiplies by them, in turn whatever the
 * direction; or returns the point of the opposite direction. */
enum { REPLACE, ADD, MULTIPLY, MULTIPLY_BY_NEARLY_ONE, OPPOSITE, DISTORTIONS, LIST = 12 };
static struct { int kind; double list[LIST][3]; } distortion;

static double any_number(void)
{
    const uint64_t bits = (uint64_t)(uniform(0, 1) * 9007199254740992.0) << 11 | (uint64_t)random_below(2048);
    double x;
    memcpy(&x, &bits, sizeof x);
    switch (random_below(7)) {
    case 0: return pow(10, uniform(-30, 30));
    case 1: return x;
    case 2: return (random_below(5) - 2) / 2.;
    default: return uniform(-1, 1);
    }
}

static void distorted_support(const void *obj, const ccd_vec3_t *direction, ccd_vec3_t *out)
{
    ccd_vec3_t d = *direction;
    const int kind = distortion.kind;
    if (kind == OPPOSITE)
        ccdVec3Scale(&d, -1);
    shape_support(obj, &d, out);
    for (int i = 0; i < 3; i++) {
        const double x = distortion.list[evaluations % LIST][i], p = (double)out->v[i];
        if (kind != OPPOSITE)
            out->v[i] = (ccd_real_t)(kind == REPLACE ? x : kind == ADD ? p + x : p * x);
        returned_invalid |= !isfinite(out->v[i]);
    }
    evaluations++;
}

static void draw_distortion(void)
{
    distortion.kind = random_below(DISTORTIONS);
    for (int i = 0; i < LIST; i++)
        for (int k = 0; k < 3; k++)
            distortion.list[i][k] = distortion.kind == MULTIPLY_BY_NEARLY_ONE ? 1 + pow(10, uniform(-9, 0)) * uniform(-1, 1)
                : distortion.kind == ADD && random_below(5)                  ? 0
                                                                             : any_number();
}

/* Checks depth and direction of a hit. */
static void check_hit(const call_t *call, const outputs_t *out, const char *what)
{
    CHECK(fabs((double)ccdVec3Len2(&out->dir) - 1) <= 8 * (double)CCD_EPS, "%s, %s: dir not unit", call->name, what);
    CHECK(out->depth >= 0 && out->depth <= CCD_REAL_MAX, "%s, %s: depth %g", call->name, what, (double)out->depth);
}

/* Calls with arbitrary support functions, from any state. Results are finite; invalid points have no result. */
static void arbitrary_support_functions(const call_t *call, const call_args_t *valid_args)
{
    const int is_extension = call->bad == CCD_BAD_INPUT, number = call->number;
    for (int round = 0; round < 30 * percent; round++) {
        ccd_warm_t warm;
        outputs_t out;
        ccd_t ccd = slabs;
        call_args_t args = *valid_args;
        for (int i = 0; i < (int)sizeof warm; i++)
            ((unsigned char *)&warm)[i] = (unsigned char)(round % 3 ? 0 : random_below(256));
        draw_distortion();
        if (random_below(3))
            ccd.support1 = distorted_support;
        if (ccd.support1 != distorted_support || random_below(2))
            ccd.support2 = distorted_support;
        ccd.mpr_tolerance = random_below(4) ? (ccd_real_t)pow(10, -2 * random_below(4)) : 0;
        ccd.epa_tolerance = ccd.dist_tolerance = ccd.mpr_tolerance;
        args.warm = random_below(4) ? &warm : NULL;
        clear_results();
        const int code = call_library(number, &slab1, &slab2, &ccd, &args);
        CHECK(evaluations < 40000, "%s: %d support calls", call->name, evaluations);
        if (number == CALL_CONTACTS) {
            CHECK(code == CCD_BAD_INPUT || (code >= 1 && code <= 4), "%s: %d", call->name, code);
            for (int i = 0; i < code; i++)
                CHECK(isfinite(results.contacts[i].depth), "%s: depth of a contact", call->name);
            continue;
        }
        CHECK(is_extension ? code >= CCD_BAD_INPUT && code <= CCD_LIMIT
                           : code == call->hit || code == call->bad || (code == -2 && call->hit == 0),
                           "%s: %d", call->name, code);
        CHECK(!returned_invalid || code == call->bad, "%s: %d of invalid points", call->name, code);
        const int is_hit = code == call->hit || (is_extension && code == CCD_LIMIT);
        if (number == CALL_DISTANCE) {
            const ccd_distance_t *d = &results.distance;
            CHECK(!(is_hit || code == CCD_MISS)
                      || (isfinite(d->distance) && isfinite(d->distance_upper) && d->distance <= d->distance_upper),
                  "distance %g to %g", (double)d->distance, (double)d->distance_upper);
            CHECK(code != CCD_HIT || d->distance < 0, "a hit at %g", (double)d->distance);
        } else if (!is_hit) {
            CHECK(same_bits(&results, &blank_results, sizeof results), "%s: an output was written", call->name);
        } else if (is_extension || call->kind == KIND_DEPTH || call->kind == KIND_DEPTH_WARM) {
            out.depth = results.depth;
            out.dir = results.dir;
            store_result(call, code, &results, &out);
            check_hit(call, &out, "any support function");
            CHECK(!is_extension || (results.penetration.depth_lower >= 0 && isfinite(results.penetration.depth_lower)),
                  "%s: lower bound", call->name);
        }
    }
}

/* --- few iterations, degenerate objects, unused fields -------------------------------- */

static int may_return(const call_t *call, int code)
{
    return code == call->hit || code == call->miss
        || ((call->traits & EXTENSION) && call->hit == CCD_HIT && (code == CCD_BAD_INPUT || code == CCD_LIMIT));
}

/* Returns the support value of the Minkowski difference along d: moving b that far along d separates the two. */
static double support_value(const shape_t *a, const shape_t *b, const ccd_vec3_t *d)
{
    ccd_vec3_t opposite = *d, p, q;
    ccdVec3Scale(&opposite, -1);
    shape_support(a, d, &p);
    shape_support(b, &opposite, &q);
    ccdVec3Sub(&p, &q);
    return (double)ccdVec3Dot(&p, d);
}

/* Runs a call and checks its code, its number of support calls and its outputs, which are sound. */
static int run_checked(const call_t *call, shape_t *a, shape_t *b, const ccd_t *ccd, double size, const char *what)
{
    outputs_t out, before;
    memset(&out, 0x5a, sizeof out);
    before = out;
    a->calls = b->calls = 0;
    const int code = run(call, a, b, ccd, &out);
    CHECK(may_return(call, code), "%s, %s: returned %d", call->name, what, code);
    /* 10 ms of a primitive's callbacks. */
    CHECK(a->calls + b->calls <= 20000, "%s, %s: %lu support calls", call->name, what, a->calls + b->calls);
    if (code != call->hit) {
        CHECK(same_bits(&out, &before, sizeof out), "%s, %s: outputs written with %d", call->name, what, code);
    } else if (call->traits & STORES) {
        const int is_along = call->number == CALL_ALONG;
        const ccd_vec3_t *normal = is_along ? &out.normal : &out.dir;
        const double along_normal = (double)(is_along ? out.depth * ccdVec3Dot(&out.dir, normal) : out.depth);
        const double required = support_value(a, b, normal);
        check_hit(call, &out, what);
        for (int i = 0; i < 3; i++)
            CHECK(fabs((double)out.pos.v[i]) <= (double)CCD_REAL_MAX, "%s, %s: pos", call->name, what);
        CHECK(required <= along_normal + 64 * (double)CCD_EPS * size,
              "%s, %s: %g of %g", call->name, what, along_normal, required);
    }
    return code;
}

static void few_iterations(const call_t *call)
{
    static const unsigned long limits[] = {0, 1, 2, 3, 5, 7, 10, 14, 20, (unsigned long)-1};
    for (int round = 0; round < 10 * percent; round++) {
        const int overlapping = round % 2;
        shape_t a, b;
        ccd_t ccd;
        random_pair(call, overlapping, &a, &b, &ccd);
        ccd.max_iterations = limits[round / 2 % 10];
        int code = run_checked(call, &a, &b, &ccd, 10, "few iterations");
        CHECK(ccd.max_iterations <= 20 || code == (overlapping ? call->hit : call->miss), "%s: returned %d", call->name, code);
        /* The extension may return CCD_LIMIT, which `run` maps to a hit. */
        if (!overlapping && (!(call->traits & EXTENSION) || (call->traits & FROM_CENTERS)))
            CHECK(code != call->hit, "%s: objects far apart hit after %lu iterations", call->name, ccd.max_iterations);
        /* A deep overlap is found without a support point. */
        if (overlapping && ccd.max_iterations > 0)
            CHECK(code != call->miss, "%s: a deep overlap missed after %lu iterations", call->name, ccd.max_iterations);
    }
}

static void degenerate_objects(const call_t *call)
{
    static const ccd_real_t point[] = {0, 0, 0}, segment[] = {-1, -1, 0, 1, 1, 0},
                            square[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    const shape_t shapes[] = {shape_polytope(point, 1),   shape_polytope(segment, 2), shape_polytope(square, 4),
                              shape_sphere(0),            shape_capsule(0, 1),        shape_cylinder(1, 0),
                              shape_box(1, 0, 1),         shape_sphere(1),            shape_box(1, 1, 1),
                              shape_ellipsoid(1, 0.5, 2), shape_cylinder(1, 1),       shape_cone(1, 1)};
    enum { COUNT = sizeof shapes / sizeof shapes[0], FIRST_SOLID = 7 };
    /* The fourth power of a size must be finite in the precision, with digits left for rounding. */
    const int is_double = sizeof(ccd_real_t) == 8;
    const double sizes[] = {1, 1e-3, 1e3, 1e6, is_double ? 1e-50 : 1e-6, is_double ? 1e60 : 1e6};
    enum { SAME_PLACE, TOUCHING, APART };
    for (int i = 0; i < COUNT; i++)
        for (int k = 0; k < COUNT; k++)
            for (int place = SAME_PLACE; place <= APART; place++)
                for (int size = 0; size < 6; size += percent < 100 ? 6 : 1) {
                    static ccd_real_t scaled[2][12];
                    shape_t s[2] = {shapes[i], shapes[k]};
                    for (int n = 0; n < 2; n++) {
                        for (int c = 0; c < 3; c++)
                            s[n].p[c] *= (ccd_real_t)sizes[size];
                        for (int c = 0; c < 3 * s[n].nverts; c++)
                            scaled[n][c] = s[n].verts[c] * (ccd_real_t)sizes[size];
                        if (s[n].nverts > 0)
                            s[n].verts = scaled[n];
                    }
                    shape_move(&s[1], place == APART ? 10 * sizes[size] : 0, 0, place == TOUCHING ? 2 * sizes[size] : 0);
                    ccd_t ccd = shape_query();
                    ccd.epa_tolerance = ccd.mpr_tolerance = (ccd_real_t)(1e-4 * sizes[size]);
                    int code = run_checked(call, &s[0], &s[1], &ccd, 10 * sizes[size], "degenerate objects");
                    if (call->number == CALL_PLANAR)
                        continue;
                    if (place == APART)
                        CHECK(code == call->miss, "%s: shapes %d and %d apart, size %g: %d", call->name, i, k, sizes[size], code);
                    if (place == SAME_PLACE && (i >= FIRST_SOLID || k >= FIRST_SOLID))
                        CHECK(code == call->hit, "%s: shapes %d and %d in one place: %d", call->name, i, k, code);
                }
    for (int i = 0; i < COUNT; i++) {
        shape_t s = shapes[i];
        ccd_t ccd = shape_query();
        run_checked(call, &s, &s, &ccd, 10, "an object with itself");
    }
}

/* Checks that the fields of ccd_t that a call does not read may have any value. */
static void unused_fields(const call_t *call)
{
    /* `run` determines the overlap of contacts by another call. */
    const int traits = call->number == CALL_CONTACTS ? call_table[CALL_LOCAL].traits : call->traits;
    for (int round = 0; round < 3 * percent; round++) {
        const int overlapping = round % 2, expected = overlapping ? call->hit : call->miss;
        shape_t a, b;
        outputs_t out, other;
        ccd_t ccd, garbage;
        random_pair(call, overlapping, &a, &b, &ccd);
        memset(&garbage, round % 4 < 2 ? 0xff : 0x3c, sizeof garbage);
        garbage.support1 = ccd.support1;
        garbage.support2 = ccd.support2;
        garbage.max_iterations = ccd.max_iterations;
        if (!(traits & FROM_CENTERS))
            garbage.first_dir = ccd.first_dir;
        if (!(traits & FROM_FIRST_DIR)) {
            garbage.center1 = ccd.center1;
            garbage.center2 = ccd.center2;
        }
        if (traits & EPA_TOLERANCE)
            garbage.epa_tolerance = ccd.epa_tolerance;
        if (traits & DIST_TOLERANCE)
            garbage.dist_tolerance = ccd.dist_tolerance;
        if (traits & MPR_TOLERANCE)
            garbage.mpr_tolerance = ccd.mpr_tolerance;
        memset(&out, 0x5a, sizeof out);
        other = out;
        CHECK(run(call, &a, &b, &ccd, &out) == expected, "%s", call->name);
        CHECK(run(call, &a, &b, &garbage, &other) == expected, "%s with garbage", call->name);
        CHECK(same_bits(&out, &other, sizeof out), "%s reads a field that it does not use", call->name);
    }
}

/* --- outputs -------------------------------------------------------------------------- */

/* Checks that each output of libccd's calls may be NULL without a change of the others, and that ccdGJKSeparate's
 * output is depth times direction of ccdGJKPenetration. */
static void null_outputs(void)
{
    for (int round = 0; round < 2 * percent; round++) {
        const int expected = round % 2 - 1;
        results_t all, part;
        ccd_vec3_t sep;
        shape_t a, b;
        ccd_t ccd;
        random_pair(&call_table[CALL_GJK], round % 2, &a, &b, &ccd);
        ccd.center1 = ccd.center2 = shape_center;
        for (int i = 0; i < 16; i++) {
            const int number = i < 8 ? CALL_MPR : CALL_GJK;
            const call_args_t args = {.depth = &all.depth, .dir = &all.dir, .pos = &all.pos};
            const call_args_t some = {.depth = i & 1 ? &part.depth : NULL, .dir = i & 2 ? &part.dir : NULL,
                                      .pos = i & 4 ? &part.pos : NULL};
            memset(&all, 0x5a, sizeof all);
            memcpy(&part, &all, sizeof all);
            CHECK(call_library(number, &a, &b, &ccd, &args) == expected, "all outputs");
            CHECK(call_library(number, &a, &b, &ccd, &some) == expected, "NULL outputs");
            CHECK(!(i & 1) || same_bits(&all.depth, &part.depth, sizeof all.depth), "depth");
            CHECK(!(i & 2) || same_bits(&all.dir, &part.dir, sizeof all.dir), "dir");
            CHECK(!(i & 4) || same_bits(&all.pos, &part.pos, sizeof all.pos), "pos");
        }
        CHECK(ccdGJKSeparate(&a, &b, &ccd, NULL) == expected && ccdGJKSeparate(&a, &b, &ccd, &sep) == expected, "sep");
        ccdVec3Scale(&all.dir, all.depth);
        CHECK(expected || sqrt((double)ccdVec3Dist2(&sep, &all.dir)) <= 4 * (double)CCD_EPS * (double)all.depth, "depth * dir");
    }
}

static int penetration(const call_t *call, const ccd_vec3_t *d, ccd_warm_t *warm, unsigned want, ccd_penetration_t *out)
{
    const call_args_t args = {.warm = warm, .along = d, .want = want, .penetration = out};
    return call_library(call->number, &slab1, &slab2, &slabs, &args);
}

/* Slides face on face: results that are not requested are zero, and pos costs support points only where it is
 * requested. */
static void requested_results(const call_t *call)
{
    unsigned long cost[CCD_WANT_ALL + 1] = {0};
    const ccd_vec3_t zero = {{0, 0, 0}};
    ccd_penetration_t all, out;
    for (unsigned want = 0; want <= CCD_WANT_ALL; want++) {
        ccd_warm_t warm[2];
        memset(warm, 0, sizeof warm);
        for (int frame = 0; frame < 20; frame++) {
            shape_move(&slab2, 1.75, 0.25 + 0.002 * frame, 0.001 * frame);
            CHECK(penetration(call, NULL, &warm[0], CCD_WANT_ALL, &all) == CCD_HIT, "%s", call->name);
            CHECK(penetration(call, NULL, &warm[1], want, &out) == CCD_HIT, "%s", call->name);
            cost[want] += frame ? out.support_points : 0;
            CHECK(fabs((double)(out.depth - all.depth)) <= 1e-6, "%s: depth %g", call->name, (double)out.depth);
            for (int k = 0; k < 3; k++) {
                const ccd_vec3_t *point = k == 0 ? &out.pos : k == 1 ? &out.point1 : &out.point2;
                const int is_requested = (want & (k ? CCD_WANT_POINTS : CCD_WANT_POS)) != 0;
                CHECK(same_bits(point, &zero, sizeof zero) != is_requested, "%s: want %u, point %d", call->name, want, k);
            }
        }
    }
    CHECK(cost[0] < cost[CCD_WANT_POS], "%s: %lu support points, %lu with pos", call->name, cost[0], cost[CCD_WANT_POS]);
    set_slabs();
}

/* Checks that a distance has a result for objects apart, in which the points are zero unless requested. */
static void requested_points_of_a_distance(void)
{
    ccd_distance_t d;
    shape_move(&slab2, 5, 0.25, 0);
    for (int want = 0; want <= CCD_WANT_POINTS; want += CCD_WANT_POINTS) {
        memset(&d, 0, sizeof d);
        CHECK(ccdSignedDistance(&slab1, &slab2, &slabs, 0, 0, inf, NULL, (unsigned)want, &d) == CCD_MISS, "apart");
        CHECK(fabs((double)d.distance - 3) < 1e-5, "%g apart", (double)d.distance);
        CHECK(want ? fabs((double)d.point1.v[0] - 1) < 1e-5 : d.point1.v[0] == 0, "point1 at %g", (double)d.point1.v[0]);
    }
    set_slabs();
}

/* --- directions, NULL objects, guesses ------------------------------------------------ */

/* Checks that directions of any length are the same direction. */
static void length_of_the_direction(const call_t *call)
{
    const ccd_vec3_t *along = valid_arguments(call, &results).along;
    ccd_penetration_t unit, out;
    penetration(call, along, NULL, CCD_WANT_ALL, &unit);
    for (int i = -30; i <= 30; i += 10) {
        ccd_vec3_t d = *along;
        for (int k = 0; k < 3; k++)
            d.v[k] = (ccd_real_t)ldexp((double)d.v[k], i);
        memset(&out, 0, sizeof out);
        CHECK(penetration(call, &d, NULL, CCD_WANT_ALL, &out) == CCD_HIT, "%s: length 2^%d", call->name, i);
        /* without padding */
        CHECK(same_bits(&out, &unit, offsetof(ccd_penetration_t, point2) + sizeof out.point2)
                  && out.support_points == unit.support_points && out.iterations == unit.iterations
                  && out.status == unit.status,
                  "%s: length 2^%d", call->name, i);
    }
}

static void fixed_support(const void *obj, const ccd_vec3_t *d, ccd_vec3_t *out)
{
    (void)obj;
    shape_support(&slab1, d, out);
}

/* Checks that objects that the callbacks do not use may be NULL. */
static void null_objects(const call_t *call)
{
    const call_args_t args = valid_arguments(call, &results);
    ccd_t ccd = slabs;
    ccd.support1 = ccd.support2 = fixed_support;
    ccd.center1 = ccd.center2 = NULL;
    CHECK(call_library(call->number, NULL, NULL, &ccd, &args) >= CCD_HIT && results.penetration.depth > 1,
          "%s: NULL objects", call->name);
}

/* Checks that an invalid guess is a cold state, NULL is accepted, and a flipped guess is the opposite one. */
static void guesses(void)
{
    const ccd_vec3_t opposite = {{-1, -2, 2}}, invalid[] = {{{0, 0, 0}}, {{inf, 0, 0}}, {{0, nan_value, 1}}};
    ccd_warm_t warm, other, cold;
    memset(&cold, 0, sizeof cold);
    CHECK(sizeof cold <= 256, "a state of %lu bytes", (unsigned long)sizeof cold);
    ccdWarmGuess(NULL, &dir);
    ccdWarmFlip(NULL);
    for (int i = 0; i < 4; i++) {
        memset(&warm, 0x77, sizeof warm);
        ccdWarmGuess(&warm, i < 3 ? &invalid[i] : NULL);
        CHECK(same_bits(&warm, &cold, sizeof warm), "invalid guess %d", i);
    }
    ccdWarmFlip(&warm);
    CHECK(same_bits(&warm, &cold, sizeof warm), "a flipped cold state");
    ccdWarmGuess(&warm, &dir);
    ccdWarmGuess(&other, &opposite);
    ccdWarmFlip(&warm);
    CHECK(same_bits(&warm, &other, sizeof warm), "a flipped guess");
}

int main(int argc, char **argv)
{
    percent = argc > 1 ? atoi(argv[1]) : percent;
    set_slabs();
    for (const call_t *call = call_table; call < call_table + PAIR_CALL_COUNT; call++) {
        const call_args_t args = valid_arguments(call, &results);
        expect(call, &slabs, &args, valid_code(call), "valid arguments");
        invalid_callbacks(call, &args);
        invalid_lengths(call, &args);
        invalid_others(call, &args);
        arbitrary_support_functions(call, &args);
        few_iterations(call);
        degenerate_objects(call);
        unused_fields(call);
        if (call->kind == KIND_PENETRATION)
            requested_results(call);
        if (call->kind == KIND_PENETRATION_ALONG)
            length_of_the_direction(call);
        if (call->kind == KIND_PENETRATION || call->kind == KIND_PENETRATION_ALONG)
            null_objects(call);
    }
    requested_points_of_a_distance();
    null_outputs();
    guesses();
    return checks_end();
}
