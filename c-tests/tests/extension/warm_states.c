/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Judges results (tests/stability/judge.h) from every kind of state: cold, of the same pair, flipped, of
 * another pair, any bytes, changed; with and without centers; of flat bodies in a plane too. Checks that every direction
 * that a callback receives is unit, how many support calls a state saves, and that it stays on its side.
 *
 *   warm_states [pairs a call, changed states] */

#include "tests/stability/categories.h"

#include "tests/contract/check.h"

enum { PAIRS = 400 };

static int pairs = PAIRS, changed_states = 10000;

/* The calls that take a state. ccdIntersect runs one of them. */
static const int calls[] = {CALL_LOCAL, CALL_INCREMENTAL, CALL_PROVEN, CALL_PENETRATION, CALL_ALONG, CALL_PLANAR, CALL_MPR_WARM,
                            CALL_MPR_INTERSECT_WARM, CALL_DISTANCE};

typedef struct {
    entry_t call;
    pair_t pair;
    double dir[3]; /* of a depth along it, or normal of the plane */
    criteria_t criteria;
    int limited; /* a result reached the support limit */
} case_t;

static void unit_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    double d[3];
    to_double(dir, d);
    CHECK(fabs(truth_dot3(d, d) - 1) <= 16 * real_eps(), "a direction (%g, %g, %g)", d[0], d[1], d[2]);
    counting_support(obj, dir, out);
}

static answer_t run_unjudged(case_t *c, int swap, ccd_warm_t *warm)
{
    shape_t a = swap ? c->pair.b : c->pair.a, b = swap ? c->pair.a : c->pair.b;
    ccd_t ccd = counting_query(c->criteria.tol);
    ccd_vec3_t dir;
    ccd.support1 = ccd.support2 = unit_support;
    if (c->call.without_centres)
        ccd.center1 = ccd.center2 = NULL;
    for (int k = 0; k < 3; k++)
        dir.v[k] = (ccd_real_t)(swap ? -c->dir[k] : c->dir[k]);
    return call_guarded(&c->call, &a, &b, &ccd, warm, &dir, call_limit(&c->call));
}

/* Checks that the depth of a planar query is a local minimum over the directions of the plane. */
static void check_minimum_in_plane(const case_t *c, const answer_t *x, const shape_t *a, const shape_t *b)
{
    double across[3], n[3], least = HUGE_VAL;
    truth_cross3(c->dir, x->dir, across);
    for (int i = -20; i <= 20; i++)
        least = fmin(least, value_near(a, b, x->dir, across, 5e-4 * i, n));
    CHECK(fabs(truth_dot3(x->dir, c->dir)) <= 64 * real_eps(), "planar: %g out of the plane", truth_dot3(x->dir, c->dir));
    CHECK(x->depth <= least + 10 * c->criteria.tol + c->criteria.noise, "planar: depth %g, beside it %g", x->depth, least);
}

/* Runs a call and judges the result. */
static answer_t run_judged(case_t *c, int swap, ccd_warm_t *warm, const char *state)
{
    const answer_t x = run_unjudged(c, swap, warm);
    const int faults = judge(&c->call, &x, swap ? &c->pair.b : &c->pair.a, swap ? &c->pair.a : &c->pair.b, &c->criteria);
    CHECK(!faults, "%s from %s", c->call.name, state);
    if (faults)
        print_faulty_answer(&c->call, &x, faults, &c->criteria.truth);
    if (c->call.call == CALL_PLANAR && x.code == CCD_HIT)
        check_minimum_in_plane(c, &x, swap ? &c->pair.b : &c->pair.a, swap ? &c->pair.a : &c->pair.b);
    /* The planar method, too, converges slowly to minima of round objects. */
    c->limited |= x.code == CCD_LIMIT && !(c->call.call == CALL_PLANAR && c->pair.a.type == SHAPE_ELLIPSOID);
    return x;
}

static int same(const answer_t *x, const answer_t *y)
{
    return x->code == y->code && x->depth == y->depth && x->lower == y->lower && x->supports == y->supports
        && same_bits(x->dir, y->dir, sizeof x->dir) && same_bits(x->pos, y->pos, sizeof x->pos)
        && same_bits(x->point1, y->point1, sizeof x->point1) && same_bits(x->point2, y->point2, sizeof x->point2);
}

/* Returns the support calls without those for pos, which a state saves only in part. */
static unsigned long cost(case_t *c, int swap, const ccd_warm_t *warm)
{
    ccd_warm_t copy = *warm;
    wanted_outputs = CCD_WANT_POINTS;
    answer_t x = run_unjudged(c, swap, &copy);
    wanted_outputs = CCD_WANT_ALL;
    return x.calls;
}

/* --- pairs --------------------------------------------------------------------------- */

/* Makes prisms on two polygons, ellipses or discs of a random plane, which may overlap, so high that their least depth is
 * in the plane; c->dir is its normal. */
static void make_prisms(case_t *c, rng_t *d)
{
    enum { POLYGONS, ELLIPSES, DISCS, KINDS };
    const int kind = rng_below(d, KINDS);
    const double far = rng_below(d, 3) ? 0 : rng_uniform(d, -5, 5);
    double rot[9], spin[9], all[9], at[2][3] = {{far, 0, rng_uniform(d, -1, 1)}};
    rng_rotation(d, rot);
    at[1][0] = far + rng_uniform(d, -1, 1);
    at[1][1] = rng_uniform(d, -1, 1);
    at[1][2] = at[0][2];
    for (int k = 0; k < 2; k++) {
        shape_t *s = pair_side(&c->pair, k), *parts = c->pair.parts[k];
        const double x = rng_uniform(d, .3, 1), y = rng_uniform(d, .3, 1);
        parts[0] = kind == POLYGONS ? random_polygon(d, c->pair.verts[k], 1) : shape_ellipsoid(x, kind == DISCS ? x : y, 0);
        parts[1] = shape_capsule(0, 5);
        *s = shape_make(SHAPE_SUM, 0, 0, 0);
        s->parts = parts;
        memcpy(s->centre, parts[0].centre, sizeof s->centre);
        rotation_about(0, 0, 1, rng_uniform(d, 0, 6), spin);
        rotation_times(rot, spin, all);
        shape_turn(s, all);
        shape_move(s, truth_dot3(rot, at[k]), truth_dot3(rot + 3, at[k]), truth_dot3(rot + 6, at[k]));
    }
    for (int k = 0; k < 3; k++)
        c->dir[k] = rot[3 * k + 2];
    c->pair.truth = truth_depth(&c->pair.a, &c->pair.b);
}

/* Returns the base of a prism. */
static shape_t base_of(const shape_t *prism)
{
    shape_t s = prism->parts[0];
    memcpy(s.pos, prism->pos, sizeof s.pos);
    memcpy(s.rot, prism->rot, sizeof s.rot);
    return s;
}

static void make_case(case_t *c, int call, int i)
{
    enum { PRISMS = CATEGORY_COUNT };
    static const int categories[] = {CATEGORY_GENERIC, CATEGORY_SHALLOW3, CATEGORY_GENERIC, CATEGORY_APART, PRISMS};
    const int category = call == CALL_PLANAR ? PRISMS : categories[i % 5];
    rng_t d = rng(5000, (uint64_t)i);
    memset(&c->call, 0, sizeof c->call);
    c->call.name = call_table[call].name;
    c->call.call = call;
    c->call.without_centres = !(call_table[call].traits & FROM_CENTERS) && rng_below(&d, 2);
    c->limited = 0;
    rng_unit_vector(&d, c->dir);
    if (category == PRISMS)
        make_prisms(c, &d);
    else
        category_pair(category, (uint64_t)i, SHAPE_TIE_SIGN, &c->pair);
    if (call == CALL_PLANAR) {
        c->pair.a = base_of(&c->pair.a);
        c->pair.b = base_of(&c->pair.b);
    }
    const int is_double = sizeof(ccd_real_t) == 8, exponent = is_double ? 6 : 4;
    const int of_planar = is_double ? 5 + rng_below(&d, 5) : 3 + rng_below(&d, 3);
    const double tol = pow(10, -(call == CALL_PLANAR ? of_planar : exponent));
    c->criteria = criteria_of(&c->pair.a, &c->pair.b, tol, &c->pair.truth);
    c->criteria.limit = LIMIT_ALLOWED;
    if (call == CALL_ALONG && c->pair.truth.lower > 0)
        c->criteria.truth = truth_along(&c->pair.a, &c->pair.b, c->dir);
}

/* Makes a state that no query returns: random bytes; numbers of any size, or of usual size, with small integers in
 * the fields at the end. */
static void make_random_state(int kind, ccd_warm_t *warm)
{
    static const double values[] = {0, 1, -1, 1e-300, 1e300, -1e300, 0.5, 1e-9, HUGE_VAL, NAN, 0.3, -0.7};
    unsigned char *bytes = (unsigned char *)warm;
    ccd_real_t x;
    for (size_t i = 0; i < sizeof *warm; i++)
        bytes[i] = (unsigned char)random_below(256);
    for (size_t i = 0; kind > 0 && i + sizeof x <= sizeof *warm; i += sizeof x) {
        x = (ccd_real_t)(kind == 1 ? values[random_below(12)] : uniform(-1, 1));
        memcpy(bytes + i, &x, sizeof x);
    }
    for (size_t i = sizeof *warm - 16; kind > 0 && i < sizeof *warm; i += sizeof(unsigned)) {
        const unsigned word = (unsigned)random_below(5);
        memcpy(bytes + i, &word, sizeof word);
    }
}

/* Changes one to three fields of a state: to another direction, to a length from 0 to infinity, or by one bit. */
static void change_state(rng_t *d, ccd_warm_t *warm)
{
    for (int changes = 1 + rng_below(d, 3); changes > 0; changes--)
        switch (rng_below(d, 4)) {
        case 0: rng_unit_vector(d, warm->reals); break;
        case 1: warm->words[0] = (unsigned)rng_below(d, 5); break;
        case 2: ((unsigned char *)warm)[rng_below(d, sizeof *warm)] ^= (unsigned char)(1 << rng_below(d, 8)); break;
        default: warm->reals[3 + rng_below(d, 3)] = pow(10, rng_uniform(d, -330, 310));
        }
}

/* --- states -------------------------------------------------------------------------- */

typedef struct {
    unsigned long cold, warm, parted; /* support calls of the hits; parted: from the state of a pair that was apart before */
    unsigned long apart, apart_guess; /* support calls of the misses, cold and from a guess */
    unsigned long own, flipped; /* support calls of all pairs, from their own and the flipped state */
    int hits, different, limited;
} count_t;

/* Returns the support calls from the state of a pair that was apart and then overlapped. */
static unsigned long cost_parted(case_t *c)
{
    const shape_t b = c->pair.b;
    ccd_warm_t warm;
    memset(&warm, 0, sizeof warm);
    shape_shift(&c->pair.b, c->pair.truth.depth + 1e-2 * pair_size(&c->pair.a, &b), c->pair.truth.n);
    run_unjudged(c, 0, &warm);
    c->pair.b = b;
    run_unjudged(c, 0, &warm); /* finds that the old direction separates no more */
    return cost(c, 0, &warm);
}

/* Returns the support calls from a guess ten degrees off the true normal. */
static unsigned long cost_guess(case_t *c)
{
    const double *n = c->pair.truth.n, across[3] = {n[1] - n[2], n[2] - n[0], n[0] - n[1]}, l = sqrt(truth_dot3(across, across));
    ccd_vec3_t guess;
    ccd_warm_t warm;
    for (int k = 0; k < 3; k++)
        guess.v[k] = (ccd_real_t)(n[k] + (l > 0 ? tan(3.14159265358979323846 / 18) * across[k] / l : 0));
    OURS(ccdWarmGuess)(&warm, &guess);
    return cost(c, 0, &warm);
}

/* Runs one pair from every kind of state; other: the state of the pair before. */
static void run_from_every_state(case_t *c, ccd_warm_t *other, count_t *n)
{
    ccd_warm_t none, warm, copy;
    memset(&none, 0, sizeof none);
    memset(&warm, 0, sizeof warm);
    answer_t cold = run_judged(c, 0, &warm, "a cold state");
    answer_t x = run_unjudged(c, 0, NULL);
    CHECK(same(&x, &cold), "%s without a state", c->call.name);
    run_judged(c, 1, NULL, "no state, swapped");
    copy = warm;
    answer_t y = run_judged(c, 1, &copy, "a state of the other order, not flipped");
    if (cold.code == CCD_HIT && c->criteria.truth.lower > 0) {
        n->hits++;
        n->cold += cost(c, 0, &none);
        n->warm += cost(c, 0, &warm);
        n->parted += cost_parted(c);
    }
    if (cold.code == CCD_MISS && c->criteria.truth.depth < 0) {
        n->apart += cost(c, 0, &none);
        n->apart_guess += cost_guess(c);
    }
    copy = warm;
    x = run_judged(c, 0, &copy, "its own state");
    y = run_unjudged(c, 0, &warm);
    CHECK(same(&x, &y) && same_bits(&warm, &copy, sizeof warm), "%s: a copied state", c->call.name);
    unsigned long own = cost(c, 0, &warm);
    x = run_unjudged(c, 0, &copy);
    copy = warm;
    OURS(ccdWarmFlip)(&copy);
    unsigned long flipped = cost(c, 1, &copy);
    y = run_judged(c, 1, &copy, "a flipped state");
    n->own += own;
    n->flipped += flipped;
    n->different += own != flipped || fabs(x.depth - y.depth) > 64 * real_eps() * largest_coordinate(&c->pair.a, &c->pair.b);
    run_judged(c, 0, other, "a foreign state");
    *other = warm;
    for (int k = 0; k < 6; k++) {
        make_random_state(k % 3, &copy);
        run_judged(c, 0, &copy, "a random state");
        run_judged(c, 0, &copy, "the state after a random state");
    }
    n->limited += c->limited;
}

static void check_states(int call)
{
    static case_t c;
    const char *name = call_table[call].name;
    ccd_warm_t other;
    count_t n;
    memset(&other, 0, sizeof other);
    memset(&n, 0, sizeof n);
    for (int i = 0; i < pairs; i++) {
        make_case(&c, call, i);
        run_from_every_state(&c, &other, &n);
    }
    if (pairs < PAIRS)
        return; /* too few for averages */
    /* A flipped distance resolves ties differently: 5 % more. In single precision there are more ties. */
    const unsigned long most = call == CALL_DISTANCE ? 106 : sizeof(ccd_real_t) == 8 ? 102 : 103;
    CHECK(100 * n.flipped <= most * n.own, "%s: %lu support calls, %lu from flipped states", name, n.own, n.flipped);
    /* A state costs no more than none, whatever the pair did before; nor does a guess in a local search, for which it is. */
    CHECK(100 * n.warm <= 102 * n.cold && 100 * n.parted <= 102 * n.warm, "%s: %lu support calls cold, %lu warm, %lu apart before",
          name, n.cold, n.warm, n.parted);
    CHECK(100 * n.apart_guess <= (call == CALL_LOCAL ? 102 : 110) * n.apart, "%s: %lu support calls apart, %lu from a guess", name,
          n.apart, n.apart_guess);
    /* A portal's first directions are mirrored with the pair: few searches differ. */
    if (call == CALL_LOCAL || call == CALL_PLANAR)
        CHECK(n.different <= PAIRS / 20, "%s: %d of %d differ from a flipped state", name, n.different, PAIRS);
    if (call == CALL_LOCAL)
        CHECK(100 * n.warm <= 71 * n.cold, "%s: %lu support calls cold, %lu warm", name, n.cold, n.warm);
    /* The incremental method of the paper converges slowly to minima of round objects. */
    CHECK(n.limited <= (call == CALL_INCREMENTAL ? PAIRS / 16 : PAIRS / 200),
          "%s: %d pairs at the support limit", name, n.limited);
    CHECK(n.hits > PAIRS / 4, "%s: %d hits", name, n.hits);
}

/* Runs pairs from their own state, changed, and from the state after that. */
static void check_changed_states(void)
{
    enum { STATES_A_PAIR = 50 };
    static case_t c;
    for (int done = 0; done < changed_states; done += STATES_A_PAIR) {
        ccd_warm_t own, warm;
        memset(&own, 0, sizeof own);
        const int i = done / STATES_A_PAIR;
        rng_t d = rng(6000, (uint64_t)i);
        make_case(&c, calls[i % (int)(sizeof calls / sizeof *calls)], i);
        run_judged(&c, 0, &own, "a cold state");
        for (int k = 0; k < STATES_A_PAIR; k++) {
            warm = own;
            change_state(&d, &warm);
            run_judged(&c, 0, &warm, "a changed state");
            run_judged(&c, 0, &warm, "the state after a changed state");
        }
    }
}

/* Lowers a tilted plate through a slab by 1 mm a frame. The least depth changes sides half way; the local search
 * stays on the side of its state, and a depth along a direction on that side. */
static void check_sides(void)
{
    enum { LOCAL, ALONG, MINIMUM, MPR, DISTANCE, SIDES };
    static const int numbers[SIDES] = {CALL_LOCAL, CALL_ALONG, CALL_PROVEN, CALL_MPR_WARM, CALL_DISTANCE};
    static case_t c;
    ccd_warm_t warm[SIDES];
    double rot[9];
    int frames_up = 0;
    memset(warm, 0, sizeof warm);
    pair_clear(&c.pair);
    c.pair.a = shape_box(2, 2, 0.05);
    c.pair.b = shape_box(0.25, 0.25, 0.01);
    c.dir[2] = 1;
    c.criteria.tol = 1e-5;
    rotation_about(1, 2, 0.3, 0.02, rot);
    shape_turn(&c.pair.b, rot);
    for (int frame = 0; frame < 120; frame++) {
        const double depth = 0.001 * frame + 0.0061; /* the plate's lowest corner is 5.6 mm below its center */
        answer_t x[SIDES];
        shape_move(&c.pair.b, 0.013, 0.027, 0.0605 - 0.001 * frame);
        for (int k = 0; k < SIDES; k++) {
            c.call.call = numbers[k];
            x[k] = run_unjudged(&c, 0, &warm[k]);
            CHECK(x[k].code == CCD_HIT, "frame %d, %s: %d", frame, call_table[numbers[k]].name, x[k].code);
            if (k <= ALONG)
                CHECK(x[k].dir[2] > 0.99 && fabs(x[k].depth - depth) < 1e-3, "frame %d, %d: %g at %g", frame, k, x[k].depth, depth);
            else
                CHECK((x[k].dir[2] > 0) == (x[MINIMUM].dir[2] > 0), "frame %d, %d: another side", frame, k);
        }
        frames_up += x[MINIMUM].dir[2] > 0;
    }
    CHECK(frames_up == 60 || frames_up == 61, "%d frames up", frames_up);
}

int main(int argc, char **argv)
{
    pairs = argc > 1 ? atoi(argv[1]) : pairs;
    changed_states = argc > 2 ? atoi(argv[2]) : changed_states;
    catch_crashes();
    check_sides();
    check_changed_states();
    for (size_t i = 0; i < sizeof calls / sizeof *calls; i++)
        check_states(calls[i]);
    return checks_end();
}
