/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Every call on bodies that are hard for one method or another, judged in 128 bits.
 *
 *   wide [pairs a row [row, -1 all [first pair [seed]]]]
 *
 * For each pair: every call cold at five tolerances, 1e-2 to 1e-9 and 0 of the size; then
 * the pair moves and every call that takes a state is asked again. Nothing false may be
 * said: the truth is an interval, and an answer counts as wrong where it contradicts all of
 * it. Prints a table, the counts by call, and the first pair of each kind of fault; exits
 * with 1 where there is one. */

#define __STDC_WANT_IEC_60559_TYPES_EXT__ 1 /* powf128 */
#include "tests/stability/judge.h"

#include "rows.h"

/* --- answers ------------------------------------------------------------------------ */

static const struct {
    entry_t entry;
    int bare; /* without centres */
} calls[] = {
    {{"MPR", 0, CALL_MPR, STATE_OWN}, 0},
    {{"MPR warm", 0, CALL_MPR_WARM, STATE_OWN}, 0},
    {{"GJK", 0, CALL_GJK, STATE_OWN}, 0},
    {{"GJK separate", 0, CALL_SEPARATE, STATE_OWN}, 0},
    {{"MPR yes or no", 0, CALL_MPR_INTERSECT, STATE_OWN}, 0},
    {{"GJK yes or no", 0, CALL_GJK_INTERSECT, STATE_OWN}, 0},
    {{"penetration", 0, CALL_PENETRATION, STATE_OWN}, 0},
    {{"penetration, no centres", 0, CALL_PENETRATION, STATE_OWN}, 1},
    {{"proven", 0, CALL_PROVEN, STATE_OWN}, 0},
    {{"proven, no centres", 0, CALL_PROVEN, STATE_OWN}, 1},
    {{"local", 0, CALL_LOCAL, STATE_OWN}, 0},
    {{"local, no centres", 0, CALL_LOCAL, STATE_OWN}, 1},
    {{"incremental", 0, CALL_INCREMENTAL, STATE_OWN}, 0},
    {{"along", 0, CALL_ALONG, STATE_OWN}, 0},
    {{"distance", 0, CALL_DISTANCE, STATE_OWN}, 0},
};
enum { CALLS = sizeof calls / sizeof calls[0] };

typedef struct {
    int entry, call; /* of calls; of this_library.h */
    answer_t a; /* normal: dir, where none is given */
    double tol;
    unsigned long supports, stack;
    int moved; /* asked with a state, after a motion */
} said_t;

static said_t say(int call, const wide_pair_t *p, double tol, const double along[3], ccd_warm_t *warm)
{
    ccd_vec3_t way;
    said_t x;
    ccd_t ccd;
    memset(&x, 0, sizeof x);
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = body_support;
    ccd.center1 = ccd.center2 = calls[call].bare ? NULL : body_centre;
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = (ccd_real_t)tol;
    ccd.max_iterations = (unsigned long)-1;
    for (int i = 0; i < 3; i++)
        way.v[i] = (ccd_real_t)along[i];
    x.entry = call;
    x.call = calls[call].entry.call;
    x.tol = tol;
    body_calls = 0;
    body_stack_lowest = (const char *)__builtin_frame_address(0);
    call_once(&calls[call].entry, &p->body[0], &p->body[1], &ccd, warm, &way, &x.a);
    x.stack = (unsigned long)((const char *)__builtin_frame_address(0) - body_stack_lowest);
    x.supports = body_calls / 2;
    if (!x.a.has_bounds)
        memcpy(x.a.normal, x.a.dir, sizeof x.a.normal);
    return x;
}

/* --- faults ------------------------------------------------------------------------- */

/* Of judge.h's: those that contradict an interval; of a local search, where h falls beside it. */
static const int columns[] = {FAULT_BIT_CODE,        FAULT_BIT_NAN,       FAULT_BIT_MISSED,   FAULT_BIT_FALSE_HIT,
                              FAULT_BIT_UNSOUND,     FAULT_BIT_OVER,      FAULT_BIT_FALSE_PROOF, FAULT_BIT_NO_PROOF,
                              FAULT_BIT_WITNESS_INSIDE, FAULT_BIT_NOT_MINIMUM, FAULT_BIT_STACK, FAULT_BIT_TAIL};
enum { COLUMNS = sizeof columns / sizeof columns[0] };

enum {
    STACK_BYTES = 44 << 10, /* in any call, down to a support function */
    TAIL_POINTS = 400      /* support points, at CCD_INIT's tolerance relative to the size */
};

static const double shares[5] = {1e-2, 1e-4, 1e-6, 1e-9, 0};
enum { TOLERANCES = 5, DEFAULT_TOLERANCE = 1 };

/* What rounding may do to a support value of such bodies, metres: some ulps of the largest
 * coordinate, in the callbacks and in the difference of two points. */
static double wide_noise(const wide_pair_t *p) { return tolerance(TOL_ULPS) * real_eps() * p->largest; }

/* Whether the point is outside the body by more than the bound, metres. */
static int is_outside_body(const body_t *s, const double at[3], double bound)
{
    body_t point;
    memset(&point, 0, sizeof point);
    memcpy(point.pos, at, sizeof point.pos);
    return wide_bounds(s, &point, bound / 4, -bound, -bound / 2, 120).upper < -bound;
}

/* h of the unit direction that far on a step from n, which is written. */
static double beside(const wide_pair_t *p, const double n[3], const double step[3], double far, double m[3])
{
    double l = 0;
    for (int k = 0; k < 3; k++) {
        m[k] = n[k] + far * step[k];
        l += m[k] * m[k];
    }
    for (int k = 0; k < 3; k++)
        m[k] /= sqrt(l);
    return wide_value(&p->body[0], &p->body[1], m);
}

/* How far h falls on a way from n, of steps down which it falls all the way, within a fiftieth of a
 * rad: each is taken at random, longer after one that went down, up to a tenth of that, and shorter
 * after each that did not. They begin short: what lies behind a ridge is another minimum, be the
 * ridge ever so narrow. */
static double fall(const wide_pair_t *p, const double n[3], rng_t *d)
{
    const double reach = .02;
    const double first = wide_value(&p->body[0], &p->body[1], n);
    double best[3], least = first, step = 1e-5 * reach;
    memcpy(best, n, sizeof best);
    for (int i = 0; i < 200; i++) {
        double by[3], m[3], between[3], far = 0, before = least, h;
        for (int k = 0; k < 3; k++)
            by[k] = step * rng_uniform(d, -1, 1);
        h = beside(p, best, by, 1, m);
        for (int k = 0; k < 3; k++)
            far += (m[k] - n[k]) * (m[k] - n[k]);
        if (far > reach * reach)
            continue;
        for (int k = 1; k < 4 && h < before; k++) {
            const double there = beside(p, best, by, k / 4., between);
            before = there < before ? there : -HUGE_VAL;
        }
        if (h < before) {
            least = h;
            memcpy(best, m, sizeof best);
            step = fmin(step * 2, reach / 10);
        } else {
            step *= .9;
        }
    }
    return first - least;
}

/* Bounds and points that the judge has of a pair in one pose. */
typedef struct {
    bounds_t truth;
    double noise, least; /* least: truth.upper, or lower where an answer knows better */
    int may_be_deep[TOLERANCES]; /* at this tolerance the minimum said CCD_LIMIT */
} case_t;

static int judge_points(const said_t *x, const wide_pair_t *p, double within, rng_t *d)
{
    const double bound = fmax(within, tolerance(TOL_WITNESS) * p->size) + tolerance(TOL_ULPS) * real_eps() * p->largest;
    for (int k = 0; k < 2; k++)
        if (is_outside_body(&p->body[k], k ? x->a.point2 : x->a.point1, bound))
            return FAULT_WITNESS_INSIDE;
    if (x->call == CALL_LOCAL && x->a.code == CCD_HIT && fall(p, x->a.dir, d) > 2 * within + bound)
        return FAULT_NOT_MINIMUM;
    return 0;
}

static int judge_said(const said_t *said, const wide_pair_t *p, const case_t *c, int t, rng_t *d)
{
    const double floor = tolerance(TOL_PROOF_FLOOR) * p->largest, within = said->tol + floor;
    const int overlap = c->truth.lower > c->noise, apart = c->least < -c->noise;
    const entry_t *e = &calls[said->entry].entry;
    const answer_t *x = &said->a;
    const double *n = x->normal;
    int faults = 0;
    if (said->stack > STACK_BYTES)
        faults |= FAULT_STACK;
    if (t == DEFAULT_TOLERANCE && said->supports > TAIL_POINTS)
        faults |= FAULT_TAIL;
    if (x->code != CCD_HIT && x->code != CCD_MISS && x->code != CCD_LIMIT)
        return faults | FAULT_CODE;
    if (x->code == CCD_MISS && overlap)
        return faults | FAULT_MISSED;
    if (x->code == CCD_HIT && apart)
        return faults | FAULT_FALSE_HIT;
    if (x->code == CCD_LIMIT && apart && said->call != CALL_DISTANCE)
        return faults | FAULT_FALSE_HIT;
    if ((x->code == CCD_MISS && said->call != CALL_DISTANCE) || entry_is_boolean(e))
        return faults;
    if (said->call == CALL_SEPARATE && x->depth == 0)
        return faults;
    for (int i = 0; i < 3; i++)
        if (!isfinite(x->dir[i]) || !isfinite(n[i]) || (x->has_bounds && !(isfinite(x->point1[i]) && isfinite(x->point2[i]))))
            return faults | FAULT_NAN;
    double along = truth_dot3(x->dir, n);
    if (!(fabs(sqrt(truth_dot3(n, n)) - 1) <= tolerance(TOL_UNIT_LENGTH) * 4) || !(along > 0) || !isfinite(x->depth) || !isfinite(x->lower))
        return faults | FAULT_NAN;
    double h = wide_value(&p->body[0], &p->body[1], n);
    if (x->depth * along < h - c->noise)
        faults |= FAULT_UNSOUND;
    /* along a direction of the caller's the least depth is greater, and so may its bound be */
    if (said->call != CALL_ALONG && x->lower > c->least + c->noise)
        faults |= FAULT_FALSE_PROOF;
    if ((said->call == CALL_PROVEN || said->call == CALL_DISTANCE) && x->code != CCD_LIMIT
        && x->depth - x->lower > within)
        faults |= FAULT_NO_PROOF;
    if ((entry_is_minimum(e) || said->call == CALL_DISTANCE) && x->code != CCD_LIMIT && !c->may_be_deep[t] && x->depth > fmax(c->least, 0) + within + c->noise
        && x->code == CCD_HIT)
        faults |= FAULT_OVER;
    if (entry_is_mpr(e) && x->code == CCD_HIT && said->supports < MPR_POINTS
        && x->depth > fmax(c->least, 0) + fmax(within, tolerance(TOL_MPR) * c->least) + c->noise)
        faults |= FAULT_OVER;
    if (x->has_bounds && rng_below(d, 8) == 0)
        faults |= judge_points(said, p, within + (x->code == CCD_LIMIT ? fmax(x->depth - x->lower, 0) : 0), d);
    return faults;
}

/* --- the table ---------------------------------------------------------------------- */

static unsigned long judged, wrong[ROWS][CALLS][FAULT_BIT_COUNT], limits[ROWS], minima[ROWS], pairs_of[ROWS];
static unsigned long most_supports[CALLS], most_stack[CALLS], limits_of[CALLS], limits_at[TOLERANCES];

static void print_body(const char *name, const body_t *s)
{
    printf("  %s: part %d (%.17g, %.17g, %.17g, %.17g) points %d child %d (%.17g, %.17g, %.17g) margin %.17g at (%.17g, %.17g, %.17g) m",
           name, (int)s->part.kind, s->part.p[0], s->part.p[1], s->part.p[2], s->part.p[3], s->part.count, (int)s->child.kind,
           s->child.p[0], s->child.p[1], s->child.p[2], s->margin, s->pos[0], s->pos[1], s->pos[2]);
    for (int i = 0; i < 9; i++)
        printf(" %.17g", s->rot[i]);
    printf("\n");
}

static void tally(int row, uint64_t index, const wide_pair_t *p, const case_t *c, const said_t *x, int t, int faults)
{
    int new = 0;
    judged++;
    limits_of[x->entry] += x->a.code == CCD_LIMIT;
    if (x->call == CALL_PROVEN && !calls[x->entry].bare) {
        minima[row] += x->a.code == CCD_HIT || x->a.code == CCD_LIMIT;
        limits[row] += x->a.code == CCD_LIMIT;
        limits_at[t] += x->a.code == CCD_LIMIT;
    }
    for (int bit = 0; bit < FAULT_BIT_COUNT; bit++)
        if (faults >> bit & 1)
            new |= wrong[row][x->entry][bit]++ == 0;
    if (new) {
        printf("first seen in row %d (%s), pair %lu%s, tolerance %g, %s:", row, rows[row].name, (unsigned long)index,
               x->moved ? ", moved" : "", x->tol, calls[x->entry].entry.name);
        printf(" ");
        print_faults(faults);
        printf("\n  ");
        print_answer(&x->a);
        printf(" supports %lu stack %lu; truth %.17g to %.17g, least known %.17g, noise %.2g\n", x->supports, x->stack, c->truth.lower,
               c->truth.upper, c->least, c->noise);
        print_body("a", &p->body[0]);
        print_body("b", &p->body[1]);
    }
}

/* The truth of a pose, and what the answers add to it: h of every direction they name. */
static case_t known(const wide_pair_t *p, const said_t *said, int count)
{
    case_t c;
    c.noise = wide_noise(p);
    c.truth = wide_bounds(&p->body[0], &p->body[1], c.noise / 4, -2 * c.noise, HUGE_VAL, 200);
    c.least = c.truth.upper;
    memset(c.may_be_deep, 0, sizeof c.may_be_deep);
    for (int i = 0; i < count; i++) {
        if (said[i].a.normal[0] != 0 || said[i].a.normal[1] != 0 || said[i].a.normal[2] != 0)
            c.least = fmin(c.least, wide_value(&p->body[0], &p->body[1], said[i].a.normal));
        if (said[i].call == CALL_PROVEN && calls[said[i].entry].bare && said[i].a.code == CCD_LIMIT)
            c.may_be_deep[i / CALLS % TOLERANCES] = 1;
    }
    return c;
}

static void judge_pair(int row, uint64_t seed, uint64_t index)
{
    static wide_pair_t p;
    static said_t said[TOLERANCES * CALLS];
    ccd_warm_t warm[CALLS], cold;
    rng_t d = rng(9000 + (uint64_t)row + 100 * seed, index);
    const int kept = (int)(index % TOLERANCES);
    double along[3];
    int open = 0;
    wide_pair(row, seed, index, &p);
    rng_unit_vector(&d, along);
    pairs_of[row]++;
    for (int t = 0; t < TOLERANCES; t++)
        for (int k = 0; k < CALLS; k++) {
            memset(&cold, 0, sizeof cold);
            said[t * CALLS + k] = say(k, &p, shares[t] * p.size, along, &cold);
            if (t == kept)
                warm[k] = cold;
            most_supports[k] = t == DEFAULT_TOLERANCE && said[t * CALLS + k].supports > most_supports[k] ? said[t * CALLS + k].supports
                                                                                                        : most_supports[k];
            most_stack[k] = said[t * CALLS + k].stack > most_stack[k] ? said[t * CALLS + k].stack : most_stack[k];
        }
    case_t c = known(&p, said, TOLERANCES * CALLS);
    for (int t = 0; t < TOLERANCES; t++)
        for (int k = 0; k < CALLS; k++)
            tally(row, index, &p, &c, &said[t * CALLS + k], t, judge_said(&said[t * CALLS + k], &p, &c, t, &d));
    for (int frame = 0; frame < 2; frame++) {
        wide_move(&d, &p, rng_log_uniform(&d, 1e-9, 1e-2));
        for (int k = 0; k < CALLS; k++) {
            said[k] = say(k, &p, shares[kept] * p.size, along, &warm[k]);
            said[k].moved = 1;
            /* GJK is asked without a state: it proves what a cold minimum proves */
            if (calls[k].entry.call == CALL_PROVEN && calls[k].bare) {
                memset(&cold, 0, sizeof cold);
                open = say(k, &p, shares[kept] * p.size, along, &cold).a.code == CCD_LIMIT;
            }
        }
        c = known(&p, said, CALLS);
        c.may_be_deep[kept] = open || c.may_be_deep[0];
        for (int k = 0; k < CALLS; k++)
            tally(row, index, &p, &c, &said[k], kept, judge_said(&said[k], &p, &c, kept, &d));
    }
}

int main(int argc, char **argv)
{
    const int pairs = argc > 1 ? atoi(argv[1]) : 20, only = argc > 2 ? atoi(argv[2]) : -1;
    const uint64_t first = argc > 3 ? strtoull(argv[3], NULL, 10) : 0, seed = argc > 4 ? strtoull(argv[4], NULL, 10) : 0;
    unsigned long sum, all = 0;
    int k;
    if (pairs < 1 || only >= (int)ROWS) {
        fprintf(stderr, "usage: wide [pairs a row [row, -1 all [first pair [seed]]]]\n");
        return 2;
    }
    for (int row = 0; row < (int)ROWS; row++)
        for (int i = 0; i < pairs && (only < 0 || row == only); i++)
            judge_pair(row, seed, first + (uint64_t)i);
    printf("\n| row | pairs |");
    for (int bit = 0; bit < COLUMNS; bit++)
        printf(" %s |", fault_text(columns[bit]));
    printf(" CCD_LIMIT of minima, %% |\n|---|---|");
    for (int bit = 0; bit <= COLUMNS; bit++)
        printf("---|");
    printf("\n");
    for (int row = 0; row < (int)ROWS; row++) {
        if (!pairs_of[row])
            continue;
        printf("| %s | %lu |", rows[row].name, pairs_of[row]);
        for (int bit = 0; bit < COLUMNS; bit++) {
            for (sum = 0, k = 0; k < CALLS; k++)
                sum += wrong[row][k][columns[bit]];
            all += sum;
            printf(" %lu |", sum);
        }
        printf(" %.2f |\n", minima[row] ? 100. * (double)limits[row] / (double)minima[row] : 0);
    }
    printf("\n| call | most supports | most stack | CCD_LIMIT |\n|---|---|---|---|\n");
    for (k = 0; k < CALLS; k++)
        printf("| %s | %lu | %lu | %lu |\n", calls[k].entry.name, most_supports[k], most_stack[k], limits_of[k]);
    printf("\nCCD_LIMIT of the minimum by tolerance:");
    for (int i = 0; i < TOLERANCES; i++)
        printf(" %lu (%g)%s", limits_at[i], shares[i], i + 1 < TOLERANCES ? "," : "\n");
    printf("\n%lu calls judged, %lu faults\n", judged, all);
    return all > 0;
}
