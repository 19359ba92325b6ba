/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* What the extension answers to input that no query can work with, and that it writes
 * nothing then; what may be NULL; max_iterations; queries asked from inside of a query. */

#include "contract/check.h"
#include "ours.h"
#include "shapes.h"

enum { LOCAL, INCREMENTAL, MINIMUM, ALONG, PLANAR, QUERIES };

static const char *const name[QUERIES] = {"local", "incremental", "minimum", "along", "planar"};
static const ccd_vec3_t way = {{1, 2, -2}}, up = {{0, 0, 3}};

static int ask(int query, const void *a, const void *b, const ccd_t *ccd, const ccd_vec3_t *dir, ccd_warm_t *warm,
               ccd_penetration_t *out)
{
    switch (query) {
    case LOCAL: return OURS(ccdPenetrationLocal)(a, b, ccd, warm, CCD_WANT_ALL, out);
    case INCREMENTAL: return OURS(ccdPenetrationIncremental)(a, b, ccd, warm, CCD_WANT_ALL, out);
    case MINIMUM: return OURS(ccdPenetrationProven)(a, b, ccd, warm, CCD_WANT_ALL, out);
    case ALONG: return OURS(ccdPenetrationAlong)(a, b, ccd, dir, warm, CCD_WANT_ALL, out);
    default: return OURS(ccdPenetrationPlanar)(a, b, ccd, dir, warm, CCD_WANT_ALL, out);
    }
}

/* Bit by bit but for what a compiler puts between the fields. */
static int same_answer(const ccd_penetration_t *a, const ccd_penetration_t *b)
{
    size_t reals = offsetof(ccd_penetration_t, point2) + sizeof a->point2;
    return same_bits(a, b, reals) && a->support_calls == b->support_calls && a->iterations == b->iterations;
}

static const ccd_vec3_t *dir_of(int query) { return query == PLANAR ? &up : &way; }

/* Two square slabs that overlap by 0.25 along x; flat squares would only touch. */
static const ccd_real_t slab[24] = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                                    -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1};
static shape_t one, other;
static ccd_t good;

static void setup(void)
{
    one = other = shape_polytope(slab, 8);
    shape_move(&other, 1.75, 0.25, 0);
    shape_query(&good);
    good.mpr_tolerance = good.epa_tolerance = CCD_REAL(1e-6);
}

/* Expects a code, nothing written to out, and the state as it was. */
static void refused(int query, const ccd_t *ccd, const ccd_vec3_t *dir, int code, const char *why)
{
    ccd_penetration_t out, before;
    ccd_warm_t warm, warm_before;
    int answer;
    memset(&before, 0x5a, sizeof before);
    out = before;
    OURS(ccdWarmGuess)(&warm, &way);
    warm_before = warm;
    answer = ask(query, &one, &other, ccd, dir, &warm, &out);
    CHECK(answer == code, "%s, %s: %d", name[query], why, answer);
    CHECK(same_bits(&out, &before, sizeof out), "%s, %s: out was written", name[query], why);
    CHECK(code == CCD_MISS || same_bits(&warm, &warm_before, sizeof warm), "%s, %s: the state was written",
          name[query], why);
    answer = ask(query, &one, &other, ccd, dir, NULL, &out);
    CHECK(answer == code, "%s, %s, without a state: %d", name[query], why, answer);
}

static ccd_real_t bad_value;
static int bad_call, calls;

static void bad_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    shape_support(obj, dir, out);
    if (calls++ >= bad_call)
        out->v[calls % 3] = bad_value;
}

static void bad_center(const void *obj, ccd_vec3_t *out)
{
    shape_center(obj, out);
    out->v[1] = bad_value;
}

static void bad_input(void)
{
    const ccd_real_t inf = CCD_REAL_MAX * 2, nan = inf - inf, negative = CCD_REAL(-1e-9);
    const ccd_real_t strange[3] = {nan, inf, -inf};
    int query, i;
    for (query = 0; query < QUERIES; query++) {
        const ccd_vec3_t *dir = dir_of(query);
        ccd_penetration_t out, before;
        ccd_warm_t warm, good_state;
        ccd_t ccd;
        OURS(ccdWarmGuess)(&good_state, &way);
        CHECK(ask(query, &one, &other, &good, dir, NULL, &out) == CCD_HIT, "%s: the good query", name[query]);

        for (i = 0; i < 2; i++) {
            ccd = good;
            *(query == MINIMUM ? &ccd.epa_tolerance : &ccd.mpr_tolerance) = i ? nan : negative;
            refused(query, &ccd, dir, CCD_BAD_INPUT, i ? "NaN tolerance" : "negative tolerance");
            /* the other tolerance is not looked at */
            ccd = good;
            *(query == MINIMUM ? &ccd.mpr_tolerance : &ccd.epa_tolerance) = i ? nan : negative;
            ccd.dist_tolerance = nan;
            CHECK(ask(query, &one, &other, &ccd, dir, NULL, &out) == CCD_HIT, "%s: other tolerances", name[query]);
        }
        /* zero asks for the best there is */
        ccd = good;
        ccd.epa_tolerance = ccd.mpr_tolerance = 0;
        CHECK(ask(query, &one, &other, &ccd, dir, NULL, &out) == CCD_HIT, "%s: tolerance 0", name[query]);

        CHECK(ask(query, &one, &other, &good, dir, NULL, NULL) == CCD_BAD_INPUT, "%s: no out", name[query]);
        refused(query, NULL, dir, CCD_BAD_INPUT, "no ccd");
        ccd = good;
        ccd.support1 = NULL;
        refused(query, &ccd, dir, CCD_BAD_INPUT, "no support1");
        ccd = good;
        ccd.support2 = NULL;
        refused(query, &ccd, dir, CCD_BAD_INPUT, "no support2");

        for (i = 0; i < 3; i++) {
            ccd = good;
            bad_value = strange[i];
            ccd.center2 = bad_center;
            refused(query, &ccd, dir, CCD_BAD_INPUT, "a centre that is no number");
            ccd = good;
            ccd.support1 = bad_support;
            /* from the first call on, from the second on, ... */
            for (bad_call = 0;; bad_call++) {
                calls = 0;
                if (ask(query, &one, &other, &ccd, dir, NULL, &out) == CCD_HIT && calls <= bad_call)
                    break;
                CHECK(bad_call < 1000, "%s: no end", name[query]);
                if (bad_call >= 1000)
                    break;
                calls = 0;
                memset(&out, 0x5a, sizeof out);
                before = out;
                warm = good_state;
                CHECK(ask(query, &one, &other, &ccd, dir, &warm, &out) == CCD_BAD_INPUT || calls <= bad_call,
                      "%s: call %d is no number", name[query], bad_call);
                CHECK(calls <= bad_call || (same_bits(&out, &before, sizeof out) &&
                                            same_bits(&warm, &good_state, sizeof warm)),
                      "%s: call %d is no number, and something was written", name[query], bad_call);
            }
        }

        if (query == ALONG || query == PLANAR) {
            const ccd_vec3_t zero = {{0, 0, 0}};
            refused(query, &good, NULL, CCD_BAD_INPUT, "no direction");
            refused(query, &good, &zero, CCD_BAD_INPUT, "zero direction");
            for (i = 0; i < 9; i++) {
                ccd_vec3_t d = *dir;
                d.v[i % 3] = strange[i / 3];
                refused(query, &good, &d, CCD_BAD_INPUT, "a direction that is no number");
            }
        }
    }
}

/* A miss writes nothing but the state. */
static void misses(void)
{
    int query;
    shape_move(&other, 5, 0.25, 0);
    for (query = 0; query < QUERIES; query++)
        refused(query, &good, dir_of(query), CCD_MISS, "apart");
    setup();
}

/* Directions of any length are the same direction; centres may be missing; obj may be
 * NULL where the callbacks do not need it. */
static void fixed_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    (void)obj;
    shape_support(&one, dir, out);
}

static void fixed_support2(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    (void)obj;
    shape_support(&other, dir, out);
}

static void freedoms(void)
{
    int query, i;
    for (query = 0; query < QUERIES; query++) {
        ccd_penetration_t unit, out;
        ccd_t ccd = good;
        ask(query, &one, &other, &good, dir_of(query), NULL, &unit);
        for (i = -30; i <= 30; i += 10) {
            ccd_vec3_t d = *dir_of(query);
            int k;
            for (k = 0; k < 3; k++)
                d.v[k] = (ccd_real_t)ldexp((double)d.v[k], i);
            memset(&out, 0, sizeof out);
            CHECK(ask(query, &one, &other, &good, &d, NULL, &out) == CCD_HIT, "%s: length", name[query]);
            CHECK(same_answer(&out, &unit), "%s: a direction of length 2^%d", name[query], i);
        }
        for (i = 1; i < 4; i++) {
            ccd = good;
            if (i & 1)
                ccd.center1 = NULL;
            if (i & 2)
                ccd.center2 = NULL;
            CHECK(ask(query, &one, &other, &ccd, dir_of(query), NULL, &out) == CCD_HIT, "%s: no centre", name[query]);
            ccd.first_dir = NULL;
            CHECK(ask(query, &one, &other, &ccd, dir_of(query), NULL, &out) == CCD_HIT, "%s: no first_dir",
                  name[query]);
        }
        ccd = good;
        ccd.center1 = ccd.center2 = NULL;
        ccd.support1 = fixed_support;
        ccd.support2 = fixed_support2;
        CHECK(ask(query, NULL, NULL, &ccd, dir_of(query), NULL, &out) == CCD_HIT, "%s: NULL objects", name[query]);
        CHECK(query == ALONG || fabs((double)out.depth - 0.25) < 1e-5, "%s: depth %g", name[query],
              (double)out.depth);
    }
}

/* Whatever max_iterations is, the answer is sound, and the cap is told. */
static void iterations(void)
{
    const unsigned long caps[] = {0, 1, 2, 3, 5, 10, 100, (unsigned long)-1};
    shape_t a = shape_box(0.5, 0.4, 0.3), b = shape_cylinder(0.5, 0.5);
    int query, far_off;
    size_t i;
    for (far_off = 0; far_off < 2; far_off++) {
        shape_move(&b, 0.3 + 2 * far_off, 0.2, 0.1);
        for (query = 0; query < PLANAR; query++)
            for (i = 0; i < sizeof caps / sizeof caps[0]; i++) {
                ccd_penetration_t out;
                ccd_t ccd = good;
                int code, k;
                double h = 0;
                ccd_vec3_t s1, s2, back;
                ccd.max_iterations = caps[i];
                a.calls = 0;
                code = ask(query, &a, &b, &ccd, &way, NULL, &out);
                CHECK(a.calls < 1000, "%s: %lu calls", name[query], a.calls);
                if (caps[i] > 100)
                    CHECK(code == (far_off ? CCD_MISS : CCD_HIT), "%s: %d", name[query], code);
                if (code == CCD_MISS) {
                    CHECK(far_off, "%s: a miss of an overlap at cap %lu", name[query], caps[i]);
                    continue;
                }
                CHECK(code == CCD_LIMIT || (code == CCD_HIT && !far_off), "%s: %d at cap %lu", name[query], code,
                      caps[i]);
                for (k = 0; k < 3; k++)
                    back.v[k] = -out.normal.v[k];
                shape_support(&a, &out.normal, &s1);
                shape_support(&b, &back, &s2);
                for (k = 0; k < 3; k++)
                    h += (double)out.normal.v[k] * ((double)s1.v[k] - (double)s2.v[k]);
                CHECK((double)(out.depth * ccdVec3Dot(&out.dir, &out.normal)) >= h - 1e-6, "%s: not sound at cap %lu",
                      name[query], caps[i]);
            }
    }
}

/* A callback that asks a query of its own, with another state, on the same objects. */
static int nested;

static void asking_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    if (!nested) {
        static int turn;
        shape_t a = shape_sphere(1), b = shape_box(0.5, 0.5, 0.5);
        ccd_penetration_t inner;
        ccd_warm_t warm;
        ccd_t ccd;
        nested = 1;
        shape_query(&ccd);
        memset(&warm, 0, sizeof warm);
        shape_move(&b, 1.2, 0, 0);
        CHECK(ask(turn++ % PLANAR, &a, &b, &ccd, &way, &warm, &inner) == CCD_HIT, "the inner query");
        nested = 0;
    }
    shape_support(obj, dir, out);
}

static void reentrant(void)
{
    int query;
    for (query = 0; query < QUERIES; query++) {
        ccd_penetration_t plain, out;
        ccd_warm_t w1, w2;
        ccd_t ccd = good;
        int frame;
        ccd.support1 = ccd.support2 = asking_support;
        memset(&w1, 0, sizeof w1);
        memset(&w2, 0, sizeof w2);
        memset(&plain, 0, sizeof plain);
        memset(&out, 0, sizeof out);
        for (frame = 0; frame < 2; frame++) {
            ask(query, &one, &other, &good, dir_of(query), &w1, &plain);
            ask(query, &one, &other, &ccd, dir_of(query), &w2, &out);
            CHECK(same_answer(&plain, &out), "%s: a query inside of a query", name[query]);
            CHECK(same_bits(&w1, &w2, sizeof w1), "%s: the state", name[query]);
        }
    }
}

static void flip(void)
{
    const ccd_vec3_t back = {{-1, -2, 2}};
    ccd_warm_t warm, other_way, cold;
    memset(&cold, 0, sizeof cold);
    warm = cold;
    OURS(ccdWarmFlip)(NULL);
    OURS(ccdWarmFlip)(&warm);
    CHECK(same_bits(&warm, &cold, sizeof warm), "a cold state flipped");
    OURS(ccdWarmGuess)(&warm, &way);
    OURS(ccdWarmGuess)(&other_way, &back);
    OURS(ccdWarmFlip)(&warm);
    CHECK(same_bits(&warm, &other_way, sizeof warm), "a guess flipped");
}

static void guess(void)
{
    const ccd_real_t inf = CCD_REAL_MAX * 2;
    const ccd_vec3_t none[] = {{{0, 0, 0}}, {{inf, 0, 0}}, {{0, inf - inf, 1}}};
    ccd_warm_t warm, cold;
    size_t i;
    memset(&cold, 0, sizeof cold);
    CHECK(sizeof cold <= 256, "a state of %lu bytes", (unsigned long)sizeof cold);
    for (i = 0; i < 3; i++) {
        memset(&warm, 0x77, sizeof warm);
        OURS(ccdWarmGuess)(&warm, &none[i]);
        CHECK(same_bits(&warm, &cold, sizeof warm), "a guess that is none");
    }
    memset(&warm, 0x77, sizeof warm);
    OURS(ccdWarmGuess)(&warm, NULL);
    CHECK(same_bits(&warm, &cold, sizeof warm), "a guess of NULL");
    OURS(ccdWarmGuess)(NULL, &way);
}

int main(void)
{
    setup();
    bad_input();
    misses();
    freedoms();
    iterations();
    reentrant();
    guess();
    flip();
    return checks_end();
}
