/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Calls every function on bodies that are hard for one method or another, and judges in 128 bits.
 *
 *   wide [pairs a row [row, -1 all [first pair [seed]]]]
 *
 * Each pair is queried cold at five tolerances, 1e-2 to 1e-9 and 0 of the size, and then moves twice and is
 * queried again from the state of one of them. The truth is an interval: an answer is wrong where it
 * contradicts all of it. Prints a table, the counts by call, and the first pair of each kind of fault;
 * exits with 1 where there is one. */

#define __STDC_WANT_IEC_60559_TYPES_EXT__ 1 /* powf128 */
#include "judge.h"

#include "wide/rows.h"

/* --- answers ------------------------------------------------------------------------ */

static const struct {
    entry_t entry;
    int without_centres;
} calls[] = {
    {{"MPR", 0, CALL_MPR, STATE_OWN}, 0},
    {{"MPR warm", 0, CALL_MPR_WARM, STATE_OWN}, 0},
    {{"GJK", 0, CALL_GJK, STATE_OWN}, 0},
    {{"GJK separate", 0, CALL_SEPARATE, STATE_OWN}, 0},
    {{"MPR intersect", 0, CALL_MPR_INTERSECT, STATE_OWN}, 0},
    {{"GJK intersect", 0, CALL_GJK_INTERSECT, STATE_OWN}, 0},
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
enum { CALLS = sizeof calls / sizeof calls[0], TOLERANCES = 5, DEFAULT_TOLERANCE = 1 };
static const double relative_tolerances[TOLERANCES] = {1e-2, 1e-4, 1e-6, 1e-9, 0};

typedef struct {
    answer_t answer; /* normal: dir, where none is returned */
    int k, t;        /* of calls, of relative_tolerances */
    double tol;      /* metres */
    int is_moved;    /* from a state, after a motion */
} wide_answer_t;

static wide_answer_t call_on_bodies(int k, const wide_pair_t *p, int t, const double along[3], ccd_warm_t *warm)
{
    ccd_vec3_t dir;
    wide_answer_t x;
    ccd_t ccd;
    memset(&x, 0, sizeof x);
    x.k = k;
    x.t = t;
    x.tol = relative_tolerances[t] * p->size;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = body_support;
    ccd.center1 = ccd.center2 = calls[k].without_centres ? NULL : body_centre;
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = (ccd_real_t)x.tol;
    ccd.max_iterations = (unsigned long)-1;
    for (int i = 0; i < 3; i++)
        dir.v[i] = (ccd_real_t)along[i];
    body_calls = 0;
    call_once(&calls[k].entry, &p->body[0], &p->body[1], &ccd, warm, &dir, &x.answer);
    x.answer.calls = body_calls;
    if (!x.answer.has_bounds)
        memcpy(x.answer.normal, x.answer.dir, sizeof x.answer.normal);
    return x;
}

/* --- faults ------------------------------------------------------------------------- */

/* Those of judge.h that contradict an interval; of a local query, a value of h nearby that is less. */
static const int columns[] = {FAULT_BIT_CODE,           FAULT_BIT_NAN,         FAULT_BIT_MISSED,      FAULT_BIT_FALSE_HIT,
                              FAULT_BIT_UNSOUND,        FAULT_BIT_OVER,        FAULT_BIT_FALSE_PROOF, FAULT_BIT_NO_PROOF,
                              FAULT_BIT_WITNESS_INSIDE, FAULT_BIT_NOT_MINIMUM, FAULT_BIT_TAIL};
enum { COLUMNS = sizeof columns / sizeof columns[0] };

enum { TAIL_POINTS = 400 }; /* support points, at CCD_INIT's tolerance relative to the size */

/* The truth of a pair in one pose. */
typedef struct {
    bounds_t truth;
    double noise; /* rounding error of a support value, metres */
    double least; /* truth.upper, or lower where the normal of an answer has a lower value */
    int may_be_deep[TOLERANCES]; /* the minimum at this tolerance returned CCD_LIMIT */
} case_t;

/* Returns whether the point is outside the body by more than the bound, metres. */
static int is_outside_body(const body_t *s, const double pos[3], double bound)
{
    body_t point;
    memset(&point, 0, sizeof point);
    memcpy(point.pos, pos, sizeof point.pos);
    return wide_bounds(s, &point, bound / 4, -bound, -bound / 2, 120).upper < -bound;
}

/* Returns h of the unit direction at n + part * step, which is written to m. */
static double value_near(const wide_pair_t *p, const double n[3], const double step[3], double part, double m[3])
{
    double l = 0;
    for (int k = 0; k < 3; k++) {
        m[k] = n[k] + part * step[k];
        l += m[k] * m[k];
    }
    for (int k = 0; k < 3; k++)
        m[k] /= sqrt(l);
    return wide_value(&p->body[0], &p->body[1], m);
}

/* Returns how far h falls by a descent of random steps from n, within a fiftieth of a rad. A step counts
 * where h falls all along it; steps grow after one that counts, up to a tenth of the way, and shrink after
 * each that does not. The first are short, so that the descent crosses no ridge into another minimum. */
static double descent(const wide_pair_t *p, const double n[3], rng_t *d)
{
    const double reach = .02;
    const double first = wide_value(&p->body[0], &p->body[1], n);
    double best[3], least = first, step = 1e-5 * reach;
    memcpy(best, n, sizeof best);
    for (int i = 0; i < 200; i++) {
        double by[3], m[3], between[3], far = 0, before = least, h;
        for (int k = 0; k < 3; k++)
            by[k] = step * rng_uniform(d, -1, 1);
        h = value_near(p, best, by, 1, m);
        for (int k = 0; k < 3; k++)
            far += (m[k] - n[k]) * (m[k] - n[k]);
        if (far > reach * reach)
            continue;
        for (int k = 1; k < 4 && h < before; k++) {
            const double there = value_near(p, best, by, k / 4., between);
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

/* Judges the witness points, and the minimum of a local query. within: of its depth, metres. */
static int judge_points(int call, const answer_t *x, const wide_pair_t *p, double within, rng_t *d)
{
    const double bound = fmax(within, tolerance(TOL_WITNESS) * p->size) + tolerance(TOL_ULPS) * real_eps() * p->largest;
    if (is_outside_body(&p->body[0], x->point1, bound) || is_outside_body(&p->body[1], x->point2, bound))
        return FAULT_WITNESS_INSIDE;
    return call == CALL_LOCAL && x->code == CCD_HIT && descent(p, x->dir, d) > 2 * within + bound ? FAULT_NOT_MINIMUM : 0;
}

static int judge_wide(const wide_answer_t *answer, const wide_pair_t *p, const case_t *c, rng_t *d)
{
    const entry_t *e = &calls[answer->k].entry;
    const answer_t *x = &answer->answer;
    const int is_distance = e->call == CALL_DISTANCE, is_limit = x->code == CCD_LIMIT;
    const double within = answer->tol + tolerance(TOL_PROOF_FLOOR) * p->largest, *n = x->normal;
    const double least = fmax(c->least, 0), gap = x->depth - x->lower, along = truth_dot3(x->dir, n);
    int faults = answer->t == DEFAULT_TOLERANCE && x->calls / 2 > TAIL_POINTS ? FAULT_TAIL : 0;
    if (x->code != CCD_HIT && x->code != CCD_MISS && !is_limit)
        return faults | FAULT_CODE;
    if (x->code == CCD_MISS && c->truth.lower > c->noise)
        return faults | FAULT_MISSED;
    if ((x->code == CCD_HIT || (is_limit && !is_distance)) && c->least < -c->noise)
        return faults | FAULT_FALSE_HIT;
    if ((x->code == CCD_MISS && !is_distance) || entry_is_boolean(e) || (e->call == CALL_SEPARATE && x->depth == 0))
        return faults;
    for (int i = 0; i < 3; i++)
        if (!isfinite(x->dir[i]) || !isfinite(n[i]) || (x->has_bounds && !(isfinite(x->point1[i]) && isfinite(x->point2[i]))))
            return faults | FAULT_NAN;
    if (!(fabs(sqrt(truth_dot3(n, n)) - 1) <= tolerance(TOL_UNIT_LENGTH) * 4) || !(along > 0) || !isfinite(x->depth)
        || !isfinite(x->lower))
        return faults | FAULT_NAN;
    if (x->depth * along < wide_value(&p->body[0], &p->body[1], n) - c->noise)
        faults |= FAULT_UNSOUND;
    /* along a direction of the caller's the least depth is greater, and so may its bound be */
    if (e->call != CALL_ALONG && x->lower > c->least + c->noise)
        faults |= FAULT_FALSE_PROOF;
    if ((e->call == CALL_PROVEN || is_distance) && !is_limit && gap > within)
        faults |= FAULT_NO_PROOF;
    if (x->code == CCD_HIT && (entry_is_minimum(e) || is_distance) && !c->may_be_deep[answer->t]
        && x->depth > least + within + c->noise)
        faults |= FAULT_OVER;
    if (x->code == CCD_HIT && entry_is_mpr(e) && x->calls / 2 < MPR_POINTS
        && x->depth > least + fmax(within, tolerance(TOL_MPR) * c->least) + c->noise)
        faults |= FAULT_OVER;
    if (x->has_bounds && rng_below(d, 8) == 0)
        faults |= judge_points(e->call, x, p, within + (is_limit ? fmax(gap, 0) : 0), d);
    return faults;
}

/* --- the table ---------------------------------------------------------------------- */

static unsigned long judged, wrong[ROWS][CALLS][FAULT_BIT_COUNT], limits[ROWS], minima[ROWS], pairs_of[ROWS];
static unsigned long most_supports[CALLS], limits_of[CALLS], limits_at[TOLERANCES];

static void print_body(const char *name, const body_t *s)
{
    printf("  %s: part %d (%.17g, %.17g, %.17g, %.17g) points %d child %d (%.17g, %.17g, %.17g) margin %.17g "
           "pos (%.17g, %.17g, %.17g) rot",
           name, (int)s->part.kind, s->part.p[0], s->part.p[1], s->part.p[2], s->part.p[3], s->part.count, (int)s->child.kind,
           s->child.p[0], s->child.p[1], s->child.p[2], s->margin, s->pos[0], s->pos[1], s->pos[2]);
    for (int i = 0; i < 9; i++)
        printf(" %.17g", s->rot[i]);
    printf("\n");
}

static void tally(int row, uint64_t index, const wide_pair_t *p, const case_t *c, const wide_answer_t *answer, int faults)
{
    const int k = answer->k, is_limit = answer->answer.code == CCD_LIMIT;
    int new = 0;
    judged++;
    limits_of[k] += is_limit;
    if (calls[k].entry.call == CALL_PROVEN && !calls[k].without_centres) {
        minima[row] += is_limit || answer->answer.code == CCD_HIT;
        limits[row] += is_limit;
        limits_at[answer->t] += is_limit;
    }
    if (answer->t == DEFAULT_TOLERANCE && !answer->is_moved && answer->answer.calls / 2 > most_supports[k])
        most_supports[k] = answer->answer.calls / 2;
    for (int bit = 0; bit < FAULT_BIT_COUNT; bit++)
        if (faults >> bit & 1)
            new |= wrong[row][k][bit]++ == 0;
    if (!new)
        return;
    printf("first seen in row %d (%s), pair %lu%s, tolerance %g, %s: ", row, rows[row].name, (unsigned long)index,
           answer->is_moved ? ", moved" : "", answer->tol, calls[k].entry.name);
    print_faults(faults);
    printf("\n  ");
    print_answer(&answer->answer);
    printf("; truth %.17g to %.17g, least known %.17g, noise %.2g\n", c->truth.lower, c->truth.upper, c->least, c->noise);
    print_body("a", &p->body[0]);
    print_body("b", &p->body[1]);
}

/* Returns the truth of a pose, and the lower values of h that normals of answers have. */
static case_t case_of(const wide_pair_t *p, const wide_answer_t *answers, int count)
{
    case_t c;
    memset(&c, 0, sizeof c);
    c.noise = tolerance(TOL_ULPS) * real_eps() * p->largest;
    c.truth = wide_bounds(&p->body[0], &p->body[1], c.noise / 4, -2 * c.noise, HUGE_VAL, 200);
    c.least = c.truth.upper;
    for (int i = 0; i < count; i++) {
        const double *n = answers[i].answer.normal;
        if (n[0] != 0 || n[1] != 0 || n[2] != 0)
            c.least = fmin(c.least, wide_value(&p->body[0], &p->body[1], n));
        if (calls[answers[i].k].entry.call == CALL_PROVEN && calls[answers[i].k].without_centres)
            c.may_be_deep[answers[i].t] |= answers[i].answer.code == CCD_LIMIT;
    }
    return c;
}

static void judge_all(int row, uint64_t index, const wide_pair_t *p, const case_t *c, const wide_answer_t *answers, int count,
                      rng_t *d)
{
    for (int i = 0; i < count; i++)
        tally(row, index, p, c, &answers[i], judge_wide(&answers[i], p, c, d));
}

static void judge_pair(int row, uint64_t seed, uint64_t index)
{
    static wide_pair_t p;
    static wide_answer_t answers[TOLERANCES * CALLS];
    ccd_warm_t warm[CALLS], cold;
    rng_t d = rng(9000 + (uint64_t)row + 100 * seed, index);
    const int warm_tolerance = (int)(index % TOLERANCES);
    double along[3];
    wide_pair(row, seed, index, &p);
    rng_unit_vector(&d, along);
    pairs_of[row]++;
    for (int t = 0; t < TOLERANCES; t++)
        for (int k = 0; k < CALLS; k++) {
            memset(&cold, 0, sizeof cold);
            answers[t * CALLS + k] = call_on_bodies(k, &p, t, along, &cold);
            if (t == warm_tolerance)
                warm[k] = cold;
        }
    case_t c = case_of(&p, answers, TOLERANCES * CALLS);
    judge_all(row, index, &p, &c, answers, TOLERANCES * CALLS, &d);
    for (int frame = 0; frame < 2; frame++) {
        int may_be_deep = 0;
        wide_move(&d, &p, rng_log_uniform(&d, 1e-9, 1e-2));
        for (int k = 0; k < CALLS; k++) {
            answers[k] = call_on_bodies(k, &p, warm_tolerance, along, &warm[k]);
            answers[k].is_moved = 1;
            /* GJK has no state: it proves what a cold minimum proves */
            if (calls[k].entry.call == CALL_PROVEN && calls[k].without_centres) {
                memset(&cold, 0, sizeof cold);
                may_be_deep = call_on_bodies(k, &p, warm_tolerance, along, &cold).answer.code == CCD_LIMIT;
            }
        }
        c = case_of(&p, answers, CALLS);
        c.may_be_deep[warm_tolerance] |= may_be_deep;
        judge_all(row, index, &p, &c, answers, CALLS, &d);
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
    printf("\n| call | most supports | CCD_LIMIT |\n|---|---|---|\n");
    for (k = 0; k < CALLS; k++)
        printf("| %s | %lu | %lu |\n", calls[k].entry.name, most_supports[k], limits_of[k]);
    printf("\nCCD_LIMIT of the minimum by tolerance:");
    for (int i = 0; i < TOLERANCES; i++)
        printf(" %lu (%g)%s", limits_at[i], relative_tolerances[i], i + 1 < TOLERANCES ? "," : "\n");
    printf("\n%lu calls judged, %lu faults\n", judged, all);
    return all > 0;
}
