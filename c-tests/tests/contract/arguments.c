/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks every call with every kind of argument: invalid values and NULL; support functions that return NaN or
 * arbitrary points; few iterations; degenerate objects; arguments without an effect; the requested results. Each call
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

static results_t results; /* static: its padding is equal */
static int evaluations, returned_invalid;

static void start(void)
{
    clear_results(&results);
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
        start();
        const int returned = call_library(call->number, &slab1, &slab2, ccd, &args);
        const int expected = returned_invalid ? call->bad : code;
        CHECK(returned == expected, "%s, %s, state %d: %d", call->name, what, has_state, returned);
        if (expected == call->bad) {
            CHECK(are_clear(&results), "%s, %s: an output was written", call->name, what);
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

/* --- results -------------------------------------------------------------------------- */

static void check_depth(const call_t *call, ccd_real_t depth, const ccd_vec3_t *dir, const ccd_vec3_t *pos, const char *what)
{
    CHECK(fabs((double)ccdVec3Len2(dir) - 1) <= 8 * (double)CCD_EPS, "%s, %s: dir not unit", call->name, what);
    CHECK(depth >= 0 && depth <= CCD_REAL_MAX, "%s, %s: depth %g", call->name, what, (double)depth);
    for (int i = 0; i < 3; i++)
        CHECK(isfinite(pos->v[i]), "%s, %s: pos", call->name, what);
}

/* Checks the code of a call and its outputs: numbers, or unchanged without a result. */
static void check_results(const call_t *call, int code, const char *what)
{
    const ccd_penetration_t *p = &results.penetration;
    const ccd_distance_t *d = &results.distance;
    const int is_coded = call->bad == CCD_BAD_INPUT, is_distance = call->kind == KIND_DISTANCE;
    if (call->kind == KIND_MANIFOLD) {
        CHECK(code == call->bad || (code >= 1 && code <= 4), "%s, %s: %d", call->name, what, code);
        for (int i = 0; i < code; i++)
            CHECK(isfinite(results.contacts[i].depth), "%s, %s: depth of a contact", call->name, what);
        return;
    }
    CHECK(is_coded ? code >= CCD_BAD_INPUT && code <= CCD_LIMIT
                   : code == call->hit || code == call->miss || (code == -2 && call->hit == 0), "%s, %s: %d", call->name, what, code);
    if (call->hit == 1 || (code != call->hit && !(is_coded && code == CCD_LIMIT) && !(is_distance && code == CCD_MISS))) {
        CHECK(are_clear(&results), "%s, %s: outputs written with %d", call->name, what, code);
    } else if (is_distance) {
        CHECK(isfinite(d->distance) && isfinite(d->distance_upper) && d->distance <= d->distance_upper, "%s: distance %g to %g", what,
              (double)d->distance, (double)d->distance_upper);
        CHECK(code != CCD_HIT || d->distance < 0, "%s: a hit at %g", what, (double)d->distance);
        CHECK((code == CCD_LIMIT) == (d->status != CCD_STATUS_CONVERGED), "%s: code %d, status %d", what, code, d->status);
    } else if (is_coded) {
        check_depth(call, p->depth, &p->dir, &p->pos, what);
        CHECK(p->depth_lower >= 0 && isfinite(p->depth_lower), "%s, %s: lower bound", call->name, what);
        CHECK((code == CCD_LIMIT) == (p->status != CCD_STATUS_CONVERGED), "%s: code %d, status %d", call->name, code, p->status);
    } else if (call->kind != KIND_SEPARATION) {
        check_depth(call, results.depth, &results.dir, &results.pos, what);
    }
}

/* Checks that a result is sound: moving b along the normal as far as it says separates the objects. */
static void check_sound(const call_t *call, int code, const shape_t *a, const shape_t *b, double size, const char *what)
{
    const ccd_penetration_t *p = &results.penetration;
    const ccd_distance_t *d = &results.distance;
    const int is_distance = call->kind == KIND_DISTANCE, is_coded = call->bad == CCD_BAD_INPUT;
    const ccd_vec3_t *normal = is_distance ? &d->normal : is_coded ? &p->normal : &results.dir;
    const ccd_real_t distance = is_distance ? -d->distance : is_coded ? p->depth * ccdVec3Dot(&p->dir, normal) : results.depth;
    ccd_vec3_t opposite = *normal, point1, point2;
    if (!(call->traits & STORES) || call->kind == KIND_MANIFOLD || (code != call->hit && !(is_coded && code == CCD_LIMIT)))
        return;
    ccdVec3Scale(&opposite, -1);
    shape_support(a, normal, &point1);
    shape_support(b, &opposite, &point2);
    ccdVec3Sub(&point1, &point2);
    const double required = (double)ccdVec3Dot(&point1, normal);
    CHECK(required <= (double)distance + 64 * (double)CCD_EPS * size, "%s, %s: %g of %g", call->name, what, (double)distance, required);
}

/* Makes a call on shapes, from no state, from a cold state and from the state after that, and checks its results and its
 * number of support calls. Returns the last code. */
static int run_checked(const call_t *call, shape_t *a, shape_t *b, const ccd_t *ccd, double size, const char *what)
{
    ccd_warm_t warm;
    int code = 0;
    memset(&warm, 0, sizeof warm);
    for (int i = 0; i < 3; i++) {
        start();
        call_args_t args = valid_arguments(call, &results);
        args.warm = i ? &warm : NULL;
        a->calls = b->calls = 0;
        code = call_library(call->number, a, b, ccd, &args);
        /* 10 ms of a primitive's callbacks. */
        CHECK(a->calls + b->calls <= 20000, "%s, %s: %lu support calls", call->name, what, a->calls + b->calls);
        CHECK(code != CCD_BAD_INPUT && (call->kind != KIND_MANIFOLD || code >= 1), "%s, %s: %d", call->name, what, code);
        check_results(call, code, what);
        check_sound(call, code, a, b, size, what);
    }
    return code;
}

/* Calls with arbitrary support functions, from any state. Results are numbers; invalid points have no result. */
static void arbitrary_support_functions(const call_t *call)
{
    for (int round = 0; round < 30 * percent; round++) {
        ccd_warm_t warm;
        ccd_t ccd = slabs;
        for (int i = 0; i < (int)sizeof warm; i++)
            ((unsigned char *)&warm)[i] = (unsigned char)(round % 3 ? 0 : random_below(256));
        draw_distortion();
        if (random_below(3))
            ccd.support1 = distorted_support;
        if (ccd.support1 != distorted_support || random_below(2))
            ccd.support2 = distorted_support;
        ccd.mpr_tolerance = random_below(4) ? (ccd_real_t)pow(10, -2 * random_below(4)) : 0;
        ccd.epa_tolerance = ccd.dist_tolerance = ccd.mpr_tolerance;
        start();
        call_args_t args = valid_arguments(call, &results);
        args.warm = random_below(4) ? &warm : NULL;
        const int code = call_library(call->number, &slab1, &slab2, &ccd, &args);
        CHECK(evaluations < 40000, "%s: %d support calls", call->name, evaluations);
        CHECK(!returned_invalid || code == call->bad || call->kind == KIND_MANIFOLD, "%s: %d of invalid points", call->name, code);
        check_results(call, code, "any support function");
    }
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
        const int code = run_checked(call, &a, &b, &ccd, 10, "few iterations");
        CHECK(ccd.max_iterations <= 20 || is_right(call, code, &results, overlapping), "%s: returned %d", call->name, code);
        /* The extension may return CCD_LIMIT. */
        if (!overlapping && (!(call->traits & EXTENSION) || (call->traits & FROM_CENTERS)))
            CHECK(is_right(call, code, &results, 0), "%s: objects far apart hit after %lu iterations", call->name, ccd.max_iterations);
        /* A deep overlap is found without a support point. */
        if (overlapping && ccd.max_iterations > 0)
            CHECK(is_right(call, code, &results, 1), "%s: a deep overlap missed after %lu iterations", call->name, ccd.max_iterations);
    }
}

static void degenerate_objects(const call_t *call)
{
    enum { SAME_PLACE, TOUCHING, APART, ITSELF, PLACES, SHAPES = 12, FIRST_SOLID = 7 };
    static const ccd_real_t square[] = {-1, -1, 0, 1, 1, 0, 1, -1, 0, -1, 1, 0}, origin[] = {0, 0, 0};
    /* The fourth power of a size must be finite in the precision, with digits left for rounding. */
    const int is_double = sizeof(ccd_real_t) == 8;
    const double sizes[] = {1, 1e-3, 1e3, 1e6, is_double ? 1e-50 : 1e-6, is_double ? 1e60 : 1e6};
    for (int round = 0; round < 25 * percent; round++) {
        const double x = sizes[random_below(6)];
        const int place = random_below(PLACES), kind[2] = {random_below(SHAPES), random_below(SHAPES)};
        ccd_real_t verts[12];
        for (int i = 0; i < 12; i++)
            verts[i] = square[i] * (ccd_real_t)x;
        const shape_t shapes[SHAPES] = {shape_polytope(origin, 1),    shape_polytope(verts, 2), shape_polytope(verts, 4),
                                        shape_sphere(0),              shape_capsule(0, x),      shape_cylinder(x, 0),
                                        shape_box(x, 0, x),           shape_sphere(x),          shape_box(x, x, x),
                                        shape_cylinder(x, x),         shape_cone(x, x),         shape_ellipsoid(x, x / 2, 2 * x)};
        shape_t a = shapes[kind[0]], b = shapes[kind[1]];
        shape_move(&b, place == APART ? 10 * x : 0, 0, place == TOUCHING ? 2 * x : 0);
        ccd_t ccd = shape_query();
        ccd.epa_tolerance = ccd.mpr_tolerance = (ccd_real_t)(1e-4 * x);
        const int code = run_checked(call, &a, place == ITSELF ? &a : &b, &ccd, 10 * x, "degenerate objects");
        if (call->number == CALL_PLANAR)
            continue;
        if (place == APART)
            CHECK(is_right(call, code, &results, 0), "%s: shapes %d and %d apart, size %g: %d", call->name, kind[0], kind[1], x, code);
        if (place == SAME_PLACE && (kind[0] >= FIRST_SOLID || kind[1] >= FIRST_SOLID))
            CHECK(is_right(call, code, &results, 1), "%s: shapes %d and %d in one place: %d", call->name, kind[0], kind[1], code);
    }
}

/* --- arguments without an effect ------------------------------------------------------ */

/* Returns the settings with garbage in all fields that a call does not read. */
static ccd_t with_garbage(const call_t *call, const ccd_t *ccd, int byte)
{
    ccd_t garbage;
    memset(&garbage, byte, sizeof garbage);
    garbage.support1 = ccd->support1;
    garbage.support2 = ccd->support2;
    if (call->traits & (EPA_TOLERANCE | DIST_TOLERANCE | MPR_TOLERANCE))
        garbage.max_iterations = ccd->max_iterations;
    if (!(call->traits & FROM_CENTERS))
        garbage.first_dir = ccd->first_dir;
    if (!(call->traits & FROM_FIRST_DIR)) {
        garbage.center1 = ccd->center1;
        garbage.center2 = ccd->center2;
    }
    if (call->traits & EPA_TOLERANCE)
        garbage.epa_tolerance = ccd->epa_tolerance;
    if (call->traits & DIST_TOLERANCE)
        garbage.dist_tolerance = ccd->dist_tolerance;
    if (call->traits & MPR_TOLERANCE)
        garbage.mpr_tolerance = ccd->mpr_tolerance;
    return garbage;
}

/* Checks that fields of ccd_t that a call does not read may have any value, that a direction may have any length, and that
 * results that are not requested are zero, or unchanged where their pointer is NULL, while the others have the same bits. */
static void arguments_without_effect(const call_t *call)
{
    results_t expected, clear;
    clear_results(&clear);
    const int has_struct = (reads(call) & READS_WANT) != 0, is_distance = call->kind == KIND_DISTANCE, bytes[] = {0xff, 0x3c, 0};
    for (int round = 0; round < 3 * percent; round++) {
        const int overlapping = round % 2;
        shape_t a, b;
        ccd_t ccd;
        random_pair(call, overlapping, &a, &b, &ccd);
        start();
        call_args_t args = valid_arguments(call, &results);
        const int code = call_library(call->number, &a, &b, &ccd, &args);
        expected = results;
        CHECK(is_right(call, code, &results, overlapping), "%s: %d", call->name, code);

        const int has_depth = random_below(2), has_dir = random_below(2), has_pos = random_below(2);
        const ccd_t garbage = with_garbage(call, &ccd, bytes[round / 2 % 3]);
        ccd_vec3_t along = *args.along;
        ccdVec3Scale(&along, (ccd_real_t)ldexp(1, 10 * (round % 7) - 30));
        args.along = &along;
        args.want = (unsigned)random_below(CCD_WANT_ALL + 1);
        args.depth = has_depth ? args.depth : NULL;
        args.dir = has_dir ? args.dir : NULL;
        args.pos = has_pos ? args.pos : NULL;
        start();
        CHECK(call_library(call->number, &a, &b, &garbage, &args) == code, "%s: another code than %d", call->name, code);

        expected.depth = has_depth ? expected.depth : clear.depth;
        expected.dir = has_dir ? expected.dir : clear.dir;
        expected.pos = has_pos ? expected.pos : clear.pos;
        ccd_penetration_t *p = &expected.penetration;
        ccd_distance_t *d = &expected.distance;
        ccd_vec3_t *const optional[] = {&p->pos, is_distance ? &d->point1 : &p->point1, is_distance ? &d->point2 : &p->point2};
        for (int k = is_distance; k < 3 && has_struct && (overlapping || is_distance); k++)
            if (!(args.want & (k ? CCD_WANT_POINTS : CCD_WANT_POS)))
                memset(optional[k], 0, sizeof *optional[k]);
        if (call->kind == KIND_PENETRATION && overlapping) /* pos costs some */
            p->support_points = results.penetration.support_points;
        CHECK(same_results(&expected, &results), "%s: another result, want %u", call->name, args.want);
    }
}

/* Checks that the position of a face on a face costs support points only where it is requested. */
static void cost_of_pos(const call_t *call)
{
    unsigned long points[2];
    for (unsigned want = 0; want < 2; want++) {
        call_args_t args = valid_arguments(call, &results);
        args.want = want * CCD_WANT_POS;
        CHECK(call_library(call->number, &slab1, &slab2, &slabs, &args) == CCD_HIT, "%s", call->name);
        points[want] = results.penetration.support_points;
    }
    CHECK(points[0] < points[1], "%s: %lu support points, %lu with pos", call->name, points[0], points[1]);
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

/* --- guesses -------------------------------------------------------------------------- */

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
        arbitrary_support_functions(call);
        few_iterations(call);
        degenerate_objects(call);
        arguments_without_effect(call);
        if (call->kind == KIND_PENETRATION)
            cost_of_pos(call);
        if (call->kind == KIND_PENETRATION || call->kind == KIND_PENETRATION_ALONG)
            null_objects(call);
    }
    guesses();
    return checks_end();
}
