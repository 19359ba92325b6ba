/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Whatever a state holds, every answer is judged (stability/judge.h): cold, swapped, from its own
 * state, from that flipped, from another pair's, from bytes. Then what a state is worth, and that it
 * keeps its side. */

#include "stability/categories.h"

#include "contract/check.h"

enum { PAIRS = 400 };

static const entry_t calls[] = {
    {"local", 0, ASK_LOCAL, STATE_NONE},
    {"incremental", 0, ASK_INCREMENTAL, STATE_NONE},
    {"proven", 0, ASK_PROVEN, STATE_NONE},
    {"penetration", 0, ASK_PENETRATION, STATE_NONE},
    {"along", 0, ASK_ALONG, STATE_NONE},
    {"planar", 0, ASK_PLANAR, STATE_NONE},
    {"MPR", 0, ASK_MPR_WARM, STATE_NONE},
    {"MPR intersect", 0, ASK_MPR_INTERSECT_WARM, STATE_NONE},
    {"distance", 0, ASK_DISTANCE, STATE_NONE},
};
enum { CALLS = sizeof calls / sizeof calls[0] };

typedef struct {
    const entry_t *call;
    pair_t pair;
    double dir[3]; /* along, or normal of the plane */
    question_t question;
    int limited; /* stopped at the cap from some state */
} case_t;

/* One question, whatever comes of it. */
static answer_t ask_pair(case_t *c, int swap, ccd_warm_t *warm)
{
    shape_t a = swap ? c->pair.b : c->pair.a, b = swap ? c->pair.a : c->pair.b;
    ccd_vec3_t dir;
    ccd_t ccd;
    int k;
    for (k = 0; k < 3; k++)
        dir.v[k] = (ccd_real_t)(swap ? -c->dir[k] : c->dir[k]);
    shape_query(&ccd);
    ccd.support1 = ccd.support2 = judge_support;
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = (ccd_real_t)c->question.tol;
    return ask_guarded(c->call, &a, &b, &ccd, warm, &dir, most_calls(c->call));
}

/* The same, judged. */
static answer_t answer(case_t *c, int swap, ccd_warm_t *warm, const char *state)
{
    const answer_t x = ask_pair(c, swap, warm);
    const int faults = judge(c->call, &x, swap ? &c->pair.b : &c->pair.a, swap ? &c->pair.a : &c->pair.b, &c->question)
        & FAULTS_NEVER & ~FAULT_LIMIT;
    double across = truth_dot3(x.dir, c->dir);
    CHECK(!faults, "%s from %s", c->call->name, state);
    if (faults) {
        print_faults(stdout, faults);
        printf(": ");
        print_answer(stdout, &x);
        printf(", truth %.17g\n", c->question.truth.depth);
    }
    CHECK(c->call->ask != ASK_PLANAR || x.code == CCD_MISS || fabs(across) <= 64 * real_ulp(), "planar: %g out of the plane", across);
    c->limited |= x.code == CCD_LIMIT;
    return x;
}

static int same(const answer_t *x, const answer_t *y)
{
    return x->code == y->code && x->depth == y->depth && x->lower == y->lower && x->supports == y->supports
        && same_bits(x->dir, y->dir, sizeof x->dir) && same_bits(x->pos, y->pos, sizeof x->pos)
        && same_bits(x->point1, y->point1, sizeof x->point1) && same_bits(x->point2, y->point2, sizeof x->point2);
}

/* Calls of a query that wants no pos: of a local search that is asked again pos costs as much as at first. */
static unsigned long cost(case_t *c, int swap, const ccd_warm_t *warm)
{
    ccd_warm_t copy = *warm;
    answer_t x;
    judge_want = CCD_WANT_POINTS;
    x = ask_pair(c, swap, &copy);
    judge_want = CCD_WANT_ALL;
    return x.calls;
}

/* --- pairs --------------------------------------------------------------------------- */

/* The depth of two polygons in their plane: no edge's normal is left out, nor does another hurt. */
static double planar_truth(const case_t *c)
{
    const shape_t *both[2] = {&c->pair.a, &c->pair.b};
    double least = HUGE_VAL;
    int s, i, j, k;
    for (s = 0; s < 2; s++)
        for (i = 0; i < both[s]->nverts; i++)
            for (j = 0; j < both[s]->nverts; j++) {
                ccd_real_t p[3], q[3];
                double e[3], n[3];
                shape_to_world(both[s], both[s]->verts + 3 * i, p);
                shape_to_world(both[s], both[s]->verts + 3 * j, q);
                for (k = 0; k < 3; k++)
                    e[k] = (double)q[k] - (double)p[k];
                for (k = 0; k < 3; k++)
                    n[k] = e[(k + 1) % 3] * c->dir[(k + 2) % 3] - e[(k + 2) % 3] * c->dir[(k + 1) % 3];
                if (i != j)
                    least = fmin(least, truth_value(&c->pair.a, &c->pair.b, n));
            }
    return least;
}

/* Two polygons in any plane, which may overlap. */
static void make_planar(case_t *c, dice_t *d)
{
    double rot[9], spin[9], all[9], at = dice_in(d, -5, 5), x = dice_in(d, -1, 1), y = dice_in(d, -1, 1);
    int k;
    dice_rotation(d, rot);
    for (k = 0; k < 2; k++) {
        shape_t *s = k ? &c->pair.b : &c->pair.a;
        *s = pair_polygon(d, c->pair.verts[k], 1);
        rotation_about(0, 0, 1, dice_in(d, 0, 6), spin);
        rotation_times(rot, spin, all);
        shape_turn(s, all);
        shape_move(s, rot[2] * at + k * (rot[0] * x + rot[1] * y), rot[5] * at + k * (rot[3] * x + rot[4] * y),
                   rot[8] * at + k * (rot[6] * x + rot[7] * y));
    }
    for (k = 0; k < 3; k++)
        c->dir[k] = rot[3 * k + 2];
    c->pair.truth.depth = planar_truth(c);
    c->pair.truth.lower = c->pair.truth.depth - 64 * real_ulp();
}

static void make(case_t *c, int call, int i)
{
    static const int categories[] = {CATEGORY_GENERIC, CATEGORY_SHALLOW3, CATEGORY_GENERIC, CATEGORY_APART};
    dice_t d = dice(5000, (uint64_t)i);
    c->call = &calls[call];
    c->limited = 0;
    dice_unit(&d, c->dir);
    if (c->call->ask == ASK_PLANAR)
        make_planar(c, &d);
    else
        category_pair(categories[i % 4], (uint64_t)i, SHAPE_TIE_SIGN, &c->pair);
    c->question = question(&c->pair.a, &c->pair.b, sizeof(ccd_real_t) == 8 ? 1e-6 : 1e-4, &c->pair.truth);
    if (c->call->ask == ASK_ALONG && c->pair.truth.lower > 0)
        c->question.truth = truth_along(&c->pair.a, &c->pair.b, c->dir);
}

/* A state that no query of this pair left: bytes; numbers of every size, or of ordinary size, and
 * the small integers that mean something at the end. */
static void strange_state(int kind, ccd_warm_t *warm)
{
    static const double values[] = {0, 1, -1, 1e-300, 1e300, -1e300, 0.5, 1e-9, HUGE_VAL, NAN, 0.3, -0.7};
    unsigned char *bytes = (unsigned char *)warm;
    ccd_real_t x;
    size_t i;
    for (i = 0; i < sizeof *warm; i++)
        bytes[i] = (unsigned char)random_below(256);
    for (i = 0; kind > 0 && i + sizeof x <= sizeof *warm; i += sizeof x) {
        x = (ccd_real_t)(kind == 1 ? values[random_below(12)] : random_in(-1, 1));
        memcpy(bytes + i, &x, sizeof x);
    }
    for (i = sizeof *warm - 16; kind > 0 && i < sizeof *warm; i += sizeof(unsigned)) {
        const unsigned word = (unsigned)random_below(5);
        memcpy(bytes + i, &word, sizeof word);
    }
}

/* --- what is asked ------------------------------------------------------------------- */

typedef struct {
    unsigned long first, again, own, flipped; /* calls: of hits cold and asked again; of all */
    int hits, apart, limited;
} count_t;

/* One pair from every kind of state; other: that of the pair before. */
static void every_state(case_t *c, ccd_warm_t *other, count_t *n)
{
    ccd_warm_t none, warm, copy;
    answer_t cold, x, y;
    unsigned long own, flipped;
    int k;
    memset(&none, 0, sizeof none);
    memset(&warm, 0, sizeof warm);
    cold = answer(c, 0, &warm, "a cold state");
    x = ask_pair(c, 0, NULL);
    CHECK(same(&x, &cold), "%s without a state", c->call->name);
    x = answer(c, 1, NULL, "no state, swapped");
    copy = warm;
    y = ask_pair(c, 1, &copy);
    if (c->call->ask == ASK_LOCAL && x.code == CCD_HIT)
        CHECK(y.code == CCD_HIT && y.depth - x.depth <= c->question.tol, "unflipped: %g, cold %g", y.depth, x.depth);
    if (cold.code == CCD_HIT && c->question.truth.lower > 0) {
        n->hits++;
        n->first += cost(c, 0, &none);
        n->again += cost(c, 0, &warm);
    }
    copy = warm;
    x = answer(c, 0, &copy, "its own state");
    y = ask_pair(c, 0, &warm);
    CHECK(same(&x, &y) && same_bits(&warm, &copy, sizeof warm), "%s: a copied state", c->call->name);
    own = cost(c, 0, &warm);
    x = ask_pair(c, 0, &copy);
    copy = warm;
    OURS(ccdWarmFlip)(&copy);
    flipped = cost(c, 1, &copy);
    y = answer(c, 1, &copy, "a flipped state");
    n->own += own;
    n->flipped += flipped;
    n->apart += own != flipped || fabs(x.depth - y.depth) > 64 * real_ulp() * pair_largest(&c->pair.a, &c->pair.b);
    answer(c, 0, other, "a foreign state");
    *other = warm;
    for (k = 0; k < 6; k++) {
        strange_state(k % 3, &copy);
        answer(c, 0, &copy, "a strange state");
        answer(c, 0, &copy, "the state after a strange state");
    }
    n->limited += c->limited;
}

static void from_states(int call)
{
    static case_t c;
    const int ask = calls[call].ask;
    ccd_warm_t other;
    count_t n;
    int i;
    memset(&other, 0, sizeof other);
    memset(&n, 0, sizeof n);
    for (i = 0; i < PAIRS; i++) {
        make(&c, call, i);
        every_state(&c, &other, &n);
    }
    printf("%s: %d hits, %.1f supports, %.1f when asked again; from a flipped state %.2f for %.2f, %d differ; %d pairs at the cap\n",
           calls[call].name, n.hits, n.first / 2. / n.hits, n.again / 2. / n.hits, n.flipped / 2. / PAIRS, n.own / 2. / PAIRS, n.apart,
           n.limited);
    /* Of a distance another of two ties is asked first: 5 % more. In single precision more are ties. */
    CHECK(100 * n.flipped <= (ask == ASK_DISTANCE ? 106 : sizeof(ccd_real_t) == 8 ? 102 : 103) * n.own, "%s: a flipped state is worth less", calls[call].name);
    if (ask == ASK_LOCAL || ask == ASK_ALONG || ask == ASK_PLANAR)
        CHECK(n.apart <= PAIRS / 50, "%s: %d differ", calls[call].name, n.apart);
    if (ask == ASK_LOCAL || ask == ASK_ALONG)
        CHECK(3 * n.again <= 2 * n.first, "%s: asked again", calls[call].name);
    /* The paper's method halves its way to round minima: it says so where others are long done. */
    CHECK(n.limited <= (ask == ASK_INCREMENTAL ? PAIRS / 16 : PAIRS / 200), "%s: %d pairs at the cap", calls[call].name, n.limited);
    CHECK(n.hits > PAIRS / 4, "%s: %d hits", calls[call].name, n.hits);
}

/* A tilted plate sinks through a slab, a millimetre a frame. The least depth changes sides half
 * through; the local search keeps the side of its state, and a depth along a way that way,
 * until the two are apart. */
static void sides(void)
{
    shape_t slab = shape_box(2, 2, 0.05), plate = shape_box(0.25, 0.25, 0.01);
    const ccd_vec3_t up = {{0, 0, 1}};
    double rot[9];
    int kept = 0, frame;
    ccd_warm_t warm[5];
    ccd_t ccd;
    memset(warm, 0, sizeof warm);
    shape_query(&ccd);
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = CCD_REAL(1e-5);
    rotation_about(1, 2, 0.3, 0.02, rot);
    shape_turn(&plate, rot);
    for (frame = 0; frame < 120; frame++) {
        const double depth = 0.001 * frame + 0.0061; /* the plate's corners are 5.6 mm lower than its middle */
        ccd_penetration_t local, along, minimum;
        ccd_distance_t distance;
        ccd_real_t mpr;
        ccd_vec3_t dir, pos;
        shape_move(&plate, 0.013, 0.027, 0.0605 - 0.001 * frame);
        CHECK(OURS(ccdPenetrationLocal)(&slab, &plate, &ccd, &warm[0], CCD_WANT_ALL, &local) == CCD_HIT, "frame %d", frame);
        CHECK(OURS(ccdPenetrationAlong)(&slab, &plate, &ccd, &up, &warm[1], CCD_WANT_ALL, &along) == CCD_HIT, "frame %d", frame);
        CHECK(OURS(ccdPenetrationProven)(&slab, &plate, &ccd, &warm[2], CCD_WANT_ALL, &minimum) == CCD_HIT, "frame %d", frame);
        CHECK(OURS(ccdMPRPenetrationWarm)(&slab, &plate, &ccd, &warm[3], &mpr, &dir, &pos) == 0, "frame %d", frame);
        CHECK(OURS(ccdSignedDistance)(&slab, &plate, &ccd, 0, 0, 0, &warm[4], CCD_WANT_ALL, &distance) == CCD_HIT, "frame %d", frame);
        CHECK(local.dir.v[2] > CCD_REAL(0.99) && fabs((double)local.depth - depth) < 1e-3, "local: %g at %g", (double)local.depth, depth);
        CHECK(along.dir.v[2] > CCD_REAL(0.99) && fabs((double)along.depth - depth) < 1e-3, "along: %g at %g", (double)along.depth, depth);
        CHECK((dir.v[2] > 0) == (minimum.dir.v[2] > 0) && (distance.normal.v[2] > 0) == (minimum.dir.v[2] > 0), "frame %d: sides", frame);
        kept += minimum.dir.v[2] > 0;
    }
    CHECK(kept == 60 || kept == 61, "%d frames up", kept);
}

/* Contacts along any direction, whether or not it is an answer's: between the support planes and no
 * more than the slop below them, the deepest first, of few calls. */
static void contacts_lie_between_the_support_planes(void)
{
    static const int categories[] = {CATEGORY_GENERIC, CATEGORY_GRID, CATEGORY_FLAT, CATEGORY_SEGMENT, CATEGORY_APART};
    static const double slops[] = {0, 1e-6, 1e-4, 1e-2}, origin[3] = {0, 0, 0};
    enum { MOST = 6 };
    static pair_t p;
    int i, k, j;
    for (i = 0; i < 5000; i++) {
        dice_t d = dice(6000, (uint64_t)i);
        const double slop = slops[dice_below(&d, 4)];
        double n[3], back[3], high, low, noise;
        ccd_contact_t contact[MOST];
        ccd_vec3_t dir;
        ccd_t ccd;
        int count;
        category_pair(categories[i % 5], (uint64_t)i / 5, SHAPE_TIE_SIGN, &p);
        noise = 256 * real_ulp() * pair_largest(&p.a, &p.b);
        dice_unit(&d, n);
        for (k = 0; k < 3; k++) {
            n[k] = i % 3 ? n[k] : k == i % 7 % 3;
            back[k] = -n[k];
            dir.v[k] = (ccd_real_t)(2 * n[k]);
        }
        high = judge_reach(&p.a, origin, n);
        low = -judge_reach(&p.b, origin, back);
        shape_query(&ccd);
        count = OURS(ccdContacts)(&p.a, &p.b, &ccd, &dir, (ccd_real_t)slop, NULL, contact, MOST);
        CHECK(count >= 1 && count <= MOST, "%d contacts", count);
        CHECK(p.a.calls <= 24 && p.b.calls <= 24, "%lu and %lu calls", p.a.calls, p.b.calls);
        for (j = 0; j < count; j++) {
            double one[3], two[3], h1, h2;
            judge_vec(&contact[j].point1, one);
            judge_vec(&contact[j].point2, two);
            h1 = truth_dot3(n, one);
            h2 = truth_dot3(n, two);
            CHECK(fabs(h1 - h2 - (double)contact[j].depth) <= noise, "a contact %g deep, its points %g", (double)contact[j].depth, h1 - h2);
            CHECK(fabs(h1 - high) <= slop + noise && fabs(h2 - low) <= slop + noise, "%g and %g off the planes", h1 - high, h2 - low);
            CHECK((double)contact[j].depth <= (double)contact[0].depth + noise, "the deepest is not first");
        }
    }
}

int main(void)
{
    int call;
    judge_begin();
    sides();
    contacts_lie_between_the_support_planes();
    for (call = 0; call < (int)CALLS; call++)
        from_states(call);
    return checks_end();
}
