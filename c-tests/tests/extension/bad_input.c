/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Every call with every argument that no query can work with: the code is the documented one, and
 * nothing is written then. What may be NULL; what is wanted.
 * (max_iterations: tests/contract/arguments.c.) */

#include "tests/contract/check.h"
#include "harness/this_library.h"
#include "harness/shapes.h"

/* Of all calls those for a penetration. */
static const int queries[] = {CALL_PENETRATION, CALL_LOCAL, CALL_INCREMENTAL, CALL_PROVEN, CALL_ALONG, CALL_PLANAR};
enum { ALONG = 4, QUERIES = 6 };

static const ccd_vec3_t way = {{1, 2, -2}}, up = {{0, 0, 3}}, across = {{2, 0, 0}};

/* Bit by bit but for what a compiler puts between the fields. */
static int same_answer(const ccd_penetration_t *a, const ccd_penetration_t *b)
{
    size_t reals = offsetof(ccd_penetration_t, point2) + sizeof a->point2;
    return same_bits(a, b, reals) && a->support_points == b->support_points && a->iterations == b->iterations;
}

static const ccd_vec3_t *dir_of(int call) { return call == CALL_PLANAR ? &up : &way; }

/* Two square slabs that overlap by 0.25 along x; flat squares would only touch. */
static const ccd_real_t slab[24] = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                                    -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1};
static shape_t one, other;
static ccd_t good;

static void setup(void)
{
    one = other = shape_polytope(slab, 8);
    shape_move(&other, 1.75, 0.25, 0);
    good = shape_query();
    good.mpr_tolerance = good.epa_tolerance = good.dist_tolerance = CCD_REAL(1e-6);
}

/* --- the walk --------------------------------------------------------------------- */

/* Outputs that a call may write. */
typedef struct {
    ccd_penetration_t penetration;
    ccd_distance_t distance;
    ccd_contact_t contact[4];
    ccd_real_t depth;
    ccd_vec3_t dir, pos;
} outputs_t;

/* What calls of a kind take besides, and look at. */
enum { TAKES_DIR = 1, TAKES_WANT = 2, NEEDS_OUT = 4, TAKES_MARGINS = 8, TAKES_SLOP = 16 };
static const int taken[] = {[KIND_PENETRATION] = TAKES_WANT | NEEDS_OUT,
                            [KIND_PENETRATION_ALONG] = TAKES_WANT | NEEDS_OUT | TAKES_DIR,
                            [KIND_MANIFOLD] = NEEDS_OUT | TAKES_DIR | TAKES_SLOP,
                            [KIND_DISTANCE] = TAKES_WANT | NEEDS_OUT | TAKES_MARGINS};

/* What it returns of the good question. */
static int good_answer(const call_t *call) { return call->kind == KIND_MANIFOLD ? 4 : call->hit; }

/* With these outputs; NULL: with none. */
static int ask_number(int number, const ccd_t *ccd, const call_args_t *rest, ccd_warm_t *warm, outputs_t *out)
{
    call_args_t x = *rest;
    x.warm = warm;
    if (out) {
        x.depth = &out->depth;
        x.dir = &out->dir;
        x.pos = &out->pos;
        x.penetration = &out->penetration;
        x.distance = &out->distance;
        x.contacts = out->contact;
    }
    return call_library(number, &one, &other, ccd, &x);
}

static int ask(int query, const void *a, const void *b, const ccd_t *ccd, const ccd_vec3_t *dir, ccd_warm_t *warm, unsigned want,
               ccd_penetration_t *out)
{
    const call_args_t rest = {.warm = warm, .along = dir, .want = want, .penetration = out};
    return call_library(query, a, b, ccd, &rest);
}

static int no_out;

/* Asks, with a state and without: the code, and nothing written where that is the bad one. */
static void expect(const call_t *call, const ccd_t *ccd, const call_args_t *rest, int code, const char *why)
{
    static outputs_t out, before; /* static: no padding differs */
    ccd_warm_t warm, warm_before;
    int answer;
    memset(&before, 0x5a, sizeof before);
    OURS(ccdWarmGuess)(&warm_before, &way);
    for (int i = 0; i < 2; i++) {
        memcpy(&out, &before, sizeof out);
        warm = warm_before;
        answer = ask_number(call->number, ccd, rest, i ? NULL : &warm, no_out ? NULL : &out);
        CHECK(answer == code, "%s, %s%s: %d", call->name, why, i ? ", without a state" : "", answer);
        if (code == call->bad) {
            CHECK(same_bits(&out, &before, sizeof out), "%s, %s: an output was written", call->name, why);
            CHECK(same_bits(&warm, &warm_before, sizeof warm), "%s, %s: the state was written", call->name, why);
        }
    }
}

static ccd_real_t bad_value;
static int bad_call, asked;

static void bad_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    shape_support(obj, dir, out);
    if (asked++ >= bad_call)
        out->v[asked % 3] = bad_value;
}

static void bad_center(const void *obj, ccd_vec3_t *out)
{
    shape_center(obj, out);
    out->v[1] = bad_value;
}

/* Points of obj1 or of obj2 that are no number: from the first call on, from the second on, ... */
static void bad_points(const call_t *call, const call_args_t *rest, int of_obj2)
{
    static outputs_t out, before;
    ccd_warm_t warm, good_state;
    ccd_t ccd = good;
    int answer;
    *(of_obj2 ? &ccd.support2 : &ccd.support1) = bad_support;
    OURS(ccdWarmGuess)(&good_state, &way);
    memset(&before, 0x5a, sizeof before);
    for (bad_call = 0; bad_call < 1000; bad_call++) {
        memcpy(&out, &before, sizeof out);
        warm = good_state;
        asked = 0;
        answer = ask_number(call->number, &ccd, rest, &warm, &out);
        if (asked <= bad_call) {
            CHECK(answer == good_answer(call), "%s: %d of good points", call->name, answer);
            return;
        }
        CHECK(answer == call->bad, "%s: point %d is no number: %d", call->name, bad_call, answer);
        CHECK(same_bits(&out, &before, sizeof out) && same_bits(&warm, &good_state, sizeof warm),
              "%s: point %d is no number, and something was written", call->name, bad_call);
    }
    CHECK(0, "%s: no end", call->name);
}

static void bad_objects(const call_t *call, const call_args_t *rest, const ccd_real_t strange[3])
{
    const int good_code = good_answer(call), bad = call->bad;
    ccd_t ccd;
    expect(call, NULL, rest, bad, "no ccd");
    for (int i = 0; i < 2; i++) {
        ccd = good;
        *(i ? &ccd.support2 : &ccd.support1) = NULL;
        expect(call, &ccd, rest, bad, "a support function is missing");
    }
    for (int i = 1; i < 4; i++) {
        ccd = good;
        if (i & 1)
            ccd.center1 = NULL;
        if (i & 2)
            ccd.center2 = NULL;
        expect(call, &ccd, rest, call->traits & FROM_CENTERS ? bad : good_code, "no centre");
        ccd.first_dir = NULL;
        expect(call, &ccd, rest, call->traits & (FROM_CENTERS | FROM_FIRST_DIR) ? bad : good_code, "no centre, no first_dir");
    }
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++) {
            bad_value = strange[i];
            ccd = good;
            *(k ? &ccd.center2 : &ccd.center1) = bad_center;
            expect(call, &ccd, rest, call->traits & (FROM_FIRST_DIR | ONE_BY_ONE) ? good_code : bad, "a centre that is no number");
            bad_points(call, rest, k);
        }
}

static void bad_tolerances(const call_t *call, const call_args_t *rest, ccd_real_t inf)
{
    const ccd_real_t none[3] = {inf - inf, CCD_REAL(-1e-9), -inf};
    const int checks = taken[call->kind] & TAKES_WANT;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            ccd_t ccd = good;
            *(k == 0 ? &ccd.mpr_tolerance : k == 1 ? &ccd.epa_tolerance : &ccd.dist_tolerance) = none[i];
            /* libccd's calls take their default, and what a call does not read is not looked at */
            expect(call, &ccd, rest, checks && call->traits >> k & 1 ? call->bad : good_answer(call),
                   "a tolerance that is none");
        }
    for (int i = 0; i < 2; i++) {
        ccd_t ccd = good;
        ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = i ? inf : 0;
        expect(call, &ccd, rest, good_answer(call), i ? "an infinite tolerance" : "tolerance 0");
    }
}

static void bad_arguments(const call_t *call, const call_args_t *good_rest, const ccd_real_t strange[3])
{
    static const struct { size_t at; int taken_by; const char *why; } lengths[] = {
        {offsetof(call_args_t, margin1), TAKES_MARGINS, "margin1 that is none"},
        {offsetof(call_args_t, margin2), TAKES_MARGINS, "margin2 that is none"},
        {offsetof(call_args_t, max_distance), TAKES_MARGINS, "max_distance that is none"},
        {offsetof(call_args_t, slop), TAKES_SLOP, "slop that is none"},
    };
    const ccd_real_t no_length[] = {strange[0], CCD_REAL(-1e-9), strange[2]};
    const int good_code = good_answer(call), bad = call->bad, takes = taken[call->kind];
    call_args_t rest = *good_rest;
    ccd_vec3_t dir = {{0, 0, 0}};
    no_out = 1;
    expect(call, &good, &rest, takes & NEEDS_OUT ? bad : good_code, "no out");
    no_out = 0;
    for (int i = 0; i < 32; i++) {
        rest.want = 1u << i;
        expect(call, &good, &rest, takes & TAKES_WANT && i > 1 ? bad : good_code, "a flag");
    }
    rest = *good_rest;
    rest.along = NULL;
    expect(call, &good, &rest, takes & TAKES_DIR ? bad : good_code, "no direction");
    rest.along = &dir;
    expect(call, &good, &rest, takes & TAKES_DIR ? bad : good_code, "zero direction");
    for (int i = 0; i < 9; i++) {
        dir = *good_rest->along;
        dir.v[i % 3] = strange[i / 3];
        expect(call, &good, &rest, takes & TAKES_DIR ? bad : good_code, "a direction that is no number");
    }
    for (int i = 0; i < 12; i++) {
        rest = *good_rest;
        memcpy((char *)&rest + lengths[i % 4].at, &no_length[i / 4], sizeof(ccd_real_t));
        expect(call, &good, &rest, takes & lengths[i % 4].taken_by ? bad : good_code, lengths[i % 4].why);
    }
    rest = *good_rest;
    rest.margin2 = strange[1];
    expect(call, &good, &rest, takes & TAKES_MARGINS ? bad : good_code, "an infinite margin");
    for (int i = 0; i < 2; i++) {
        rest = *good_rest;
        rest.slop = i ? strange[1] : 0;
        expect(call, &good, &rest, i && takes & TAKES_SLOP ? 1 : good_code, i ? "any slop" : "no slop");
    }
    for (int i = -1; i < 2; i++) {
        rest = *good_rest;
        rest.max = i > 0 ? 2147483647 : i;
        expect(call, &good, &rest, i < 1 && takes & TAKES_SLOP ? bad : good_code, "room");
    }
}

/* Points in place of an object's own, added to them or times them, one after the other whatever the
 * direction; or the point of the opposite one. */
enum { INSTEAD, ADDED, TIMES, NEARLY_ONE, OPPOSITE, LIES, LIST = 12 };
static struct { int kind; double said[LIST][3]; } lie;
static int nonsense; /* what is no number was answered */

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

static void lying_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    ccd_vec3_t d = *dir;
    if (lie.kind == OPPOSITE)
        ccdVec3Scale(&d, -1);
    shape_support(obj, &d, out);
    for (int i = 0; i < 3 && lie.kind != OPPOSITE; i++) {
        const double x = lie.said[asked % LIST][i];
        out->v[i] = (ccd_real_t)(lie.kind == INSTEAD ? x : lie.kind == ADDED ? (double)out->v[i] + x : (double)out->v[i] * x);
    }
    for (int i = 0; i < 3; i++)
        nonsense |= !isfinite(out->v[i]);
    asked++;
}

static void draw_lie(void)
{
    lie.kind = random_below(LIES);
    for (int i = 0; i < LIST; i++)
        for (int k = 0; k < 3; k++)
            lie.said[i][k] = lie.kind == NEARLY_ONE                ? 1 + pow(10, uniform(-9, 0)) * uniform(-1, 1)
                : lie.kind == ADDED && random_below(5) ? 0 : any_number();
}

/* Objects that answer anything, from any state: each call ends, with a code of its own; what it
 * claims is finite; there is no answer from points that are none, and nothing written without one. */
static void lies(const call_t *call, const call_args_t *rest)
{
    const int libccd = call->bad != CCD_BAD_INPUT, number = call->number;
    for (int round = 0; round < 3000; round++) {
        static outputs_t out, before;
        ccd_warm_t warm;
        ccd_t ccd = good;
        memset(&out, 0x5a, sizeof out);
        before = out;
        for (int i = 0; i < (int)sizeof warm; i++)
            ((unsigned char *)&warm)[i] = (unsigned char)(round % 3 ? 0 : random_below(256));
        draw_lie();
        if (random_below(3))
            ccd.support1 = lying_support;
        if (ccd.support1 != lying_support || random_below(2))
            ccd.support2 = lying_support;
        ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = random_below(4) ? (ccd_real_t)pow(10, -2 * random_below(4)) : 0;
        asked = nonsense = 0;
        int code = ask_number(number, &ccd, rest, random_below(4) ? &warm : NULL, &out);
        CHECK(asked < 40000, "%s: %d calls", call->name, asked);
        if (number == CALL_CONTACTS) {
            CHECK(code == CCD_BAD_INPUT || (code >= 1 && code <= 4), "%s: %d", call->name, code);
            for (int i = 0; i < code; i++)
                CHECK(isfinite(out.contact[i].depth), "%s: a contact of no depth", call->name);
            continue;
        }
        CHECK(libccd ? code == call->hit || code == call->bad || (code == -2 && call->hit == 0)
                     : code >= CCD_BAD_INPUT && code <= CCD_LIMIT, "%s of lies: %d", call->name, code);
        CHECK(!nonsense || code == call->bad, "%s: %d from no numbers", call->name, code);
        int hit = code == call->hit || (!libccd && code == CCD_LIMIT);
        if (number == CALL_DISTANCE) {
            CHECK(!(hit || code == CCD_MISS)
                      || (isfinite(out.distance.distance) && isfinite(out.distance.distance_upper)
                          && out.distance.distance <= out.distance.distance_upper), "distance of lies: %g", (double)out.distance.distance);
            CHECK(code != CCD_HIT || out.distance.distance < 0, "a hit at %g", (double)out.distance.distance);
        } else if (!hit) {
            CHECK(same_bits(&out, &before, sizeof out), "%s of lies: written", call->name);
        } else if (number == CALL_MPR || number == CALL_GJK || number == CALL_MPR_WARM || !libccd) {
            const int full = !libccd;
            const ccd_real_t depth = full ? out.penetration.depth : out.depth;
            const ccd_vec3_t *dir = full ? &out.penetration.dir : &out.dir;
            CHECK(depth >= 0 && isfinite(depth), "%s of lies: depth %g", call->name, (double)depth);
            CHECK(fabs((double)ccdVec3Len2(dir) - 1) <= 8 * (double)CCD_EPS, "%s of lies: direction not unit", call->name);
            CHECK(!full || (out.penetration.depth_lower >= 0 && isfinite(out.penetration.depth_lower)), "%s of lies: bound", call->name);
        }
    }
}

static void bad_input(void)
{
    const ccd_real_t inf = CCD_REAL_MAX * 2, strange[3] = {inf - inf, inf, -inf};
    call_args_t rest = {.max_distance = inf, .slop = CCD_REAL(1e-3), .want = CCD_WANT_ALL, .max = 4};
    for (const call_t *call = call_table; call < call_table + PAIR_CALL_COUNT; call++) {
        rest.along = call->number == CALL_ALONG ? &way : call->number == CALL_PLANAR ? &up : &across;
        expect(call, &good, &rest, good_answer(call), "the good question");
        bad_objects(call, &rest, strange);
        bad_tolerances(call, &rest, inf);
        bad_arguments(call, &rest, strange);
        lies(call, &rest);
    }
}

/* --- what is wanted --------------------------------------------------------------- */

/* Face on face, sliding: where pos is wanted it is asked for; else it costs nothing. */
static void wanted(void)
{
    for (int i = 0; i < ALONG; i++) {
        const int query = queries[i];
        unsigned long cost[CCD_WANT_ALL + 1] = {0};
        ccd_penetration_t all, out;
        for (unsigned want = 0; want <= CCD_WANT_ALL; want++) {
            ccd_warm_t warm[2];
            ccd_t ccd = good;
            memset(warm, 0, sizeof warm);
            setup();
            for (int frame = 0; frame < 20; frame++) {
                const ccd_vec3_t zero = {{0, 0, 0}};
                shape_move(&other, 1.75, 0.25 + 0.002 * frame, 0.001 * frame);
                CHECK(ask(query, &one, &other, &ccd, NULL, &warm[0], CCD_WANT_ALL, &all) == CCD_HIT, "%s", call_table[query].name);
                CHECK(ask(query, &one, &other, &ccd, NULL, &warm[1], want, &out) == CCD_HIT, "%s", call_table[query].name);
                cost[want] += frame ? out.support_points : 0;
                CHECK(fabs((double)(out.depth - all.depth)) <= 1e-6, "%s: depth %g", call_table[query].name, (double)out.depth);
                for (int k = 0; k < 3; k++) {
                    const ccd_vec3_t *points[3] = {&out.pos, &out.point1, &out.point2};
                    const unsigned flag = k ? CCD_WANT_POINTS : CCD_WANT_POS;
                    CHECK((want & flag) != 0 || same_bits(points[k], &zero, sizeof zero), "%s: not wanted, and not zero",
                          call_table[query].name);
                    CHECK((want & flag) == 0 || !same_bits(points[k], &zero, sizeof zero), "%s: wanted, and zero", call_table[query].name);
                }
            }
        }
        printf("%s, face on face, 19 frames: %lu calls of each support function, %lu with pos\n", call_table[query].name, cost[0],
               cost[CCD_WANT_POS]);
        CHECK(cost[0] < cost[CCD_WANT_POS], "%s: pos for nothing: %lu, %lu", call_table[query].name, cost[0], cost[CCD_WANT_POS]);
    }
    setup();
}

/* A distance is an answer; what is not wanted of it is zero. (Other misses write nothing: tests/contract/arguments.c.) */
static void a_distance(void)
{
    const ccd_real_t inf = CCD_REAL_MAX * 2;
    ccd_distance_t d;
    shape_move(&other, 5, 0.25, 0);
    memset(&d, 0, sizeof d);
    CHECK(OURS(ccdSignedDistance)(&one, &other, &good, 0, 0, inf, NULL, 0, &d) == CCD_MISS, "apart");
    CHECK(fabs((double)d.distance - 3) < 1e-5 && d.point1.v[0] == 0, "%g apart", (double)d.distance);
    CHECK(OURS(ccdSignedDistance)(&one, &other, &good, 0, 0, inf, NULL, CCD_WANT_POINTS, &d) == CCD_MISS, "apart");
    CHECK(fabs((double)d.point1.v[0] - 1) < 1e-5, "point1 at %g", (double)d.point1.v[0]);
    setup();
}

/* Directions of any length are the same direction; obj may be NULL where the callbacks do not need it. */
static void fixed_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    (void)obj;
    shape_support(&one, dir, out);
}

static void freedoms(void)
{
    ccd_penetration_t out;
    ccd_t ccd = good;
    ccd.support1 = ccd.support2 = fixed_support;
    ccd.center1 = ccd.center2 = NULL;
    for (int q = 0; q < QUERIES; q++)
        CHECK(ask(queries[q], NULL, NULL, &ccd, dir_of(queries[q]), NULL, CCD_WANT_ALL, &out) >= CCD_HIT && out.depth > 1, "%s: NULL objects", call_table[queries[q]].name);
    for (int q = ALONG; q < QUERIES; q++) {
        const int query = queries[q];
        ccd_penetration_t unit;
        ask(query, &one, &other, &good, dir_of(query), NULL, CCD_WANT_ALL, &unit);
        for (int i = -30; i <= 30; i += 10) {
            ccd_vec3_t d = *dir_of(query);
            for (int k = 0; k < 3; k++)
                d.v[k] = (ccd_real_t)ldexp((double)d.v[k], i);
            memset(&out, 0, sizeof out);
            CHECK(ask(query, &one, &other, &good, &d, NULL, CCD_WANT_ALL, &out) == CCD_HIT, "%s: length", call_table[query].name);
            CHECK(same_answer(&out, &unit), "%s: a direction of length 2^%d", call_table[query].name, i);
        }
    }
}

/* Guesses that are none leave a cold state; NULL is no error; a guess flipped is the opposite one. */
static void guesses(void)
{
    const ccd_real_t inf = CCD_REAL_MAX * 2;
    const ccd_vec3_t back = {{-1, -2, 2}}, none[] = {{{0, 0, 0}}, {{inf, 0, 0}}, {{0, inf - inf, 1}}};
    ccd_warm_t warm, other_way, cold;
    memset(&cold, 0, sizeof cold);
    CHECK(sizeof cold <= 256, "a state of %lu bytes", (unsigned long)sizeof cold);
    OURS(ccdWarmGuess)(NULL, &way);
    OURS(ccdWarmFlip)(NULL);
    for (int i = 0; i < 4; i++) {
        memset(&warm, 0x77, sizeof warm);
        OURS(ccdWarmGuess)(&warm, i < 3 ? &none[i] : NULL);
        CHECK(same_bits(&warm, &cold, sizeof warm), "a guess that is none");
    }
    OURS(ccdWarmFlip)(&warm);
    CHECK(same_bits(&warm, &cold, sizeof warm), "a cold state flipped");
    OURS(ccdWarmGuess)(&warm, &way);
    OURS(ccdWarmGuess)(&other_way, &back);
    OURS(ccdWarmFlip)(&warm);
    CHECK(same_bits(&warm, &other_way, sizeof warm), "a guess flipped");
}

int main(void)
{
    setup();
    bad_input();
    wanted();
    a_distance();
    freedoms();
    guesses();
    return checks_end();
}
