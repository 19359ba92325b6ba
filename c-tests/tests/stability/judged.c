/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Makes every call on every pair of a list and judges the answers by the exact truth.
 *
 *   judged configurations             known failures and other projects' cases, one by one
 *   judged ledger                     a Markdown table of those where libccd is wrong
 *   judged categories [pairs a category [category, -1 all]]
 *                                     random pairs by category, by both tie rules, at tolerances of 1e-4 m and TOL_TIGHT
 *                                     of the size; the extension's calls on the first third of them
 *   judged hard [pairs a row [row, -1 all [first pair [seed]]]]
 *                                     bodies that are hard for one method or another, at five tolerances; they move
 *                                     twice and are queried again from the states of one tolerance
 *
 * Prints rates of both libraries at the first tolerance, every kind of fault with the first pair that shows it, and exits
 * with 1 where a guarantee of this library is broken. */

#include "bodies.h"
#include "configurations.h"

enum { TOLERANCES = 5, ROWS = 32 };

/* A pair, and how it is judged. */
typedef struct {
    const char *row_name;
    int row;
    unsigned long index;
    const pair_t *pair;
    double tol[TOLERANCES];
    int tolerances; /* how many */
    int limit, points, is_touching;
    int is_missed;  /* a miss alone is right */
    int calls;      /* CALLS_ */
} task_t;

enum { CALLS_ALL, CALLS_COMPATIBLE, CALLS_COLD };

typedef struct {
    unsigned long answers, limits, faults[FAULT_BIT_COUNT];      /* of all tolerances */
    unsigned long first, first_faults[FAULT_BIT_COUNT], calls;   /* of the first one */
} tally_t;

static tally_t tallies[ROWS][ENTRIES];
static const char *row_names[ROWS];
static unsigned long judged, most_supports[ENTRIES];

static const double libccd_tolerance = 1e-4; /* metres: libccd's default, which its users have */

/* --- judging a pair ------------------------------------------------------------------- */

static void tally(const task_t *task, int k, int t, const answer_t *x, int faults, const criteria_t *q)
{
    tally_t *n = &tallies[task->row][k];
    int is_new = 0;
    judged++;
    n->answers++;
    n->limits += x->code == CCD_LIMIT;
    if (t == 0) {
        n->first++;
        n->calls += x->calls;
    }
    if (x->calls / 2 > most_supports[k])
        most_supports[k] = x->calls / 2;
    for (int bit = 0; bit < FAULT_BIT_COUNT; bit++)
        if (faults >> bit & 1) {
            is_new |= n->faults[bit]++ == 0;
            n->first_faults[bit] += t == 0;
        }
    if (!is_new || entries[k].is_libccd)
        return;
    printf("first seen: %s, pair %lu, tie rule %d, tolerance %g, limit %d, ", task->row_name, task->index,
           task->pair->a.tie, q->tol, q->limit);
    print_faulty_answer(&entries[k], x, faults, &q->truth);
    print_shape("  a", &task->pair->a);
    print_shape("  b", &task->pair->b);
}

static int is_called(const task_t *task, int k)
{
    const entry_t *e = &entries[k];
    switch (task->calls) {
    case CALLS_COMPATIBLE: return e->is_libccd || entry_is_compatible(e);
    case CALLS_COLD: return !e->is_libccd && e->state <= STATE_ZERO;
    default: return 1;
    }
}

/* Returns whether an entry tells that a proof reaches the limit, which compatible calls cannot report. */
static int is_proof(int k) { return entries[k].call == CALL_PROVEN && entries[k].state == STATE_NONE; }

/* Judges the answers of all entry points, [tolerance][entry]. A lower value of h that the normal of one of them has is a
 * better upper bound of the truth. */
static void judge_answers(const task_t *task, answer_t answers[][ENTRIES])
{
    const shape_t *a = &task->pair->a, *b = &task->pair->b;
    truth_t truth = task->pair->truth;
    for (int t = 0; t < task->tolerances; t++)
        for (int k = 0; k < (int)ENTRIES; k++) {
            answer_t *x = &answers[t][k];
            if (!is_called(task, k) || x->code == ANSWER_NONE)
                continue;
            set_value(x, a, b);
            if (x->has_value && x->value < truth.depth)
                truth.depth = x->value;
        }
    truth.lower = fmin(truth.lower, truth.depth);
    for (int t = 0; t < task->tolerances; t++) {
        criteria_t q = criteria_of(a, b, task->tol[t], &truth);
        q.limit = task->limit != LIMIT_ON_CURVES ? task->limit : pair_may_reach_limit(task->pair, q.tol) ? LIMIT_ALLOWED : LIMIT_NEVER;
        q.touching |= task->is_touching;
        for (int k = 0; k < (int)ENTRIES; k++)
            q.unproven |= is_proof(k) && answers[t][k].code == CCD_LIMIT;
        for (int k = 0; k < (int)ENTRIES; k++) {
            const entry_t *e = &entries[k];
            if (!is_called(task, k) || answers[t][k].code == ANSWER_NONE)
                continue;
            q.tol = e->is_libccd ? libccd_tolerance : task->tol[t];
            q.points = task->points == POINTS_EXACT && e->state != STATE_NONE ? POINTS_BY_PLANES : task->points;
            q.truth = e->call == CALL_ALONG ? task->pair->truth : truth; /* along its normal */
            int faults = judge(e, &answers[t][k], a, b, &q);
            if (task->is_missed && answers[t][k].code != CCD_MISS && e->state != STATE_MARGINS)
                faults |= FAULT_FALSE_HIT;
            tally(task, k, t, &answers[t][k], faults, &q);
        }
    }
}

static answer_t answers[TOLERANCES][ENTRIES];

/* Makes all calls on a pair, and judges them. warm: the states that the calls at tolerance number `kept` leave, or NULL. */
static void judge_pair(const task_t *task, ccd_warm_t *warm, int kept)
{
    const pair_t *p = task->pair;
    for (int t = 0; t < task->tolerances; t++)
        for (int k = 0; k < (int)ENTRIES; k++) {
            const entry_t *e = &entries[k];
            ccd_warm_t state;
            answers[t][k].code = ANSWER_NONE;
            if (!(is_called(task, k) || is_proof(k)) || (e->is_libccd && t > 0))
                continue;
            answers[t][k] = call_entry(e, &p->a, &p->b, e->is_libccd ? libccd_tolerance : task->tol[t], p->truth.n, &state);
            if (warm && t == kept)
                warm[k] = state;
        }
    judge_answers(task, answers);
}

/* --- the lists ------------------------------------------------------------------------ */

static int is_ledger, configurations_failed;

static void describe(const answer_t *x, char text[32])
{
    const double length2 = truth_dot3(x->dir, x->dir);
    if (x->code == ANSWER_LOOP || x->code == ANSWER_CRASH || x->code == CCD_MISS)
        snprintf(text, 32, "%s", x->code == ANSWER_LOOP ? "endless" : x->code == ANSWER_CRASH ? "crash" : "miss");
    else if (length2 == 0 || !isfinite(length2))
        snprintf(text, 32, "%.6g, dir %s", x->depth, length2 == 0 ? "0" : "NaN");
    else
        snprintf(text, 32, "%.8g%s", x->depth, x->code == CCD_LIMIT ? " (limit)" : "");
}

/* Checks a configuration. In the ledger, prints it if libccd is wrong; the first entries are libccd's calls and these. */
static void judge_configuration(const configuration_t *c)
{
    static pair_t p;
    pair_clear(&p);
    p.a = c->a;
    p.b = c->b;
    p.truth = truth_depth(&p.a, &p.b);
    const task_t task = {c->id, 0, 0, &p, {tolerance(TOL_TIGHT) * pair_size(&p.a, &p.b)}, 1,
                         c->flags & SURFACE ? LIMIT_ALLOWED : LIMIT_NEVER, POINTS_EXACT, (c->flags & TOUCHING) != 0,
                         (c->flags & MISSED) != 0, is_ledger ? CALLS_COMPATIBLE : CALLS_ALL};
    unsigned long wrong = 0;
    if (c->flags & NOT_IN_SINGLE && in_single())
        return;
    if (isfinite(c->expected) && !(fabs(p.truth.depth - c->expected) <= c->within)) {
        printf("FAILED %s: truth %.17g, expected %.17g\n", c->id, p.truth.depth, c->expected);
        configurations_failed++;
    }
    memset(tallies, 0, sizeof tallies);
    judge_pair(&task, NULL, 0);
    for (int k = 0; k < (int)ENTRIES; k++)
        for (int bit = 0; bit < FAULT_BIT_COUNT; bit++)
            wrong += entries[k].is_libccd == is_ledger ? tallies[0][k].faults[bit] : 0;
    configurations_failed += wrong > 0 && !is_ledger;
    if (is_ledger && wrong) {
        printf("| %s: %s | %.8g |", c->id, c->what, p.truth.depth);
        for (int k = 0; k < 4; k++) {
            char text[32];
            describe(&answers[0][k], text);
            printf(" %s |", text);
        }
        printf("\n");
    }
}

static void judge_category(int category, int pairs)
{
    static pair_t p;
    row_names[category] = category_text(category);
    for (int i = 0; i < pairs; i++) {
        /* both tie rules have the same truth, which takes longer than the calls */
        category_pair(category, (uint64_t)i, SHAPE_TIE_SIGN, &p);
        for (int tie = SHAPE_TIE_SIGN; tie <= SHAPE_TIE_CENTRE; tie++) {
            const task_t task = {row_names[category], category, (unsigned long)i, &p,
                                 {libccd_tolerance, tolerance(TOL_TIGHT) * pair_size(&p.a, &p.b)}, 2,
                                 category == CATEGORY_CONCENTRIC ? LIMIT_ALL_AROUND : LIMIT_ON_CURVES, POINTS_BY_PLANES, 0, 0, 3 * i < pairs ? CALLS_ALL : CALLS_COMPATIBLE};
            p.a.tie = p.b.tie = tie;
            judge_pair(&task, NULL, 0);
        }
    }
}

static void judge_hard(int row, uint64_t seed, uint64_t index)
{
    static pair_t p;
    ccd_warm_t warm[ENTRIES];
    rng_t d = rng(9000 + (uint64_t)row + 100 * seed, index);
    const int kept = (int)(index % TOLERANCES);
    hard_pair(row, seed, index, &p);
    const double size = pair_size(&p.a, &p.b);
    const int is_large = p.a.nverts > 200 || p.b.nverts > 200;
    task_t task = {hard_rows[row].name, row, (unsigned long)index, &p, {1e-4 * size, 1e-2 * size, 1e-6 * size, 1e-9 * size, 0},
                   TOLERANCES, LIMIT_ANYWHERE, rng_below(&d, 8) == 0 ? POINTS_EXACT : is_large ? POINTS_NOT : POINTS_BY_PLANES, 0, 0, CALLS_COLD};
    row_names[row] = hard_rows[row].name;
    judge_pair(&task, warm, kept);
    task.tol[0] = task.tol[kept];
    task.tolerances = 1;
    for (int frame = 0; frame < 2; frame++) {
        hard_move(&d, &p, rng_log_uniform(&d, 1e-9, 1e-2));
        for (int k = 0; k < (int)ENTRIES; k++) {
            entry_t e = entries[k];
            e.state = STATE_KEPT;
            if (is_called(&task, k))
                answers[0][k] = call_entry(&e, &p.a, &p.b, task.tol[0], p.truth.n, &warm[k]);
        }
        judge_answers(&task, answers);
    }
}

/* --- the result ----------------------------------------------------------------------- */

/* The answers of one pair by one entry point: two tie rules, two tolerances. One pair is no rate. */
enum { ANSWERS_OF_PAIR = 4 };

/* Returns whether so many of the answers in a row are known to have the fault. */
static int is_known(const char *row, const char *entry, int fault, unsigned long count, unsigned long answers_of_row)
{
    static const struct {
        const char *row, *entry; /* entry: all whose name begins so */
        int fault;
        double part;
    } known[] = {
        {"coincident centres", "minimum", FAULT_BIT_LIMIT, .005},
        {"coincident centres", "distance", FAULT_BIT_LIMIT, .005},
        {"corners and rims that meet", "local", FAULT_BIT_WITNESS_INSIDE, .01},
        /* a gap of a few ulps of the position, which it says: depth and lower bound differ by it */
        {"far from the origin 1e8", "along", FAULT_BIT_WITNESS_DEPTH, .01},
        {"far from the origin 1e8", "along", FAULT_BIT_WITNESS_INSIDE, .01},
        {"1e5 m from the origin", "along", FAULT_BIT_WITNESS_DEPTH, .004},
        {"1e5 m from the origin", "along", FAULT_BIT_WITNESS_INSIDE, .004},
        /* hard bodies at tolerance 0, and slender curved ones */
        {"frusta, nearly parallel", "distance", FAULT_BIT_GAP, .004},
        {"frusta, nearly parallel", "distance", FAULT_BIT_NOT_MINIMUM, .004},
        {"plates, nearly parallel", "incremental", FAULT_BIT_POSITION, .004},
        {"size 1e-6 on size 1", "incremental", FAULT_BIT_POSITION, .004},
        {"superellipsoids", "minimum", FAULT_BIT_POSITION, .004},
        {"exactly touching", "local", FAULT_BIT_POSITION, .004},
#ifdef CCD_SINGLE
        {"far from the origin 1e6", "penetration", FAULT_BIT_LIMIT, .02},
        {"far from the origin 1e6", "minimum", FAULT_BIT_LIMIT, .07},
        {"far from the origin 1e6", "distance", FAULT_BIT_LIMIT, .13},
#endif
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(row, known[i].row) == 0 && strncmp(entry, known[i].entry, strlen(known[i].entry)) == 0 && fault == known[i].fault)
            return (double)count <= fmax(known[i].part * (double)answers_of_row, ANSWERS_OF_PAIR);
    /* Less than one pair in a thousand, in the longer runs before a release alone: of a small sample none is allowed. */
    static const struct {
        const char *row, *entry;
        int fault;
    } rare[] = {
        {"touching +-1e-12", "distance", FAULT_BIT_LIMIT},
        {"centre offset along a shared axis", "minimum", FAULT_BIT_LIMIT},
        {"centre offset along a shared axis", "distance", FAULT_BIT_LIMIT},
        {"segment or point and solid", "minimum", FAULT_BIT_LIMIT},
        {"segment or point and solid", "distance", FAULT_BIT_LIMIT},
        /* by less than two tolerances, at the limit of support points */
        {"near-coincident centres 1e-8 to 1e-18", "GJK", FAULT_BIT_NOT_MINIMUM},
        {"near-coincident centres 1e-8 to 1e-18", "separate", FAULT_BIT_NOT_MINIMUM},
        {"scale 1e-6 to 1e6, any depth", "GJK", FAULT_BIT_NOT_MINIMUM},
        {"scale 1e-6 to 1e6, any depth", "separate", FAULT_BIT_NOT_MINIMUM},
        {"capsules, aspect 1e2 to 1e5", "minimum", FAULT_BIT_WITNESS_DEPTH},
        {"far from the origin 1e8", "local", FAULT_BIT_WITNESS_DEPTH},
        {"far from the origin 1e8", "local", FAULT_BIT_WITNESS_INSIDE},
        {"frusta as plates, parallel", "penetration", FAULT_BIT_WITNESS_DEPTH},
        {"frusta as plates, parallel", "penetration", FAULT_BIT_WITNESS_INSIDE},
        {"frusta as plates, parallel", "minimum", FAULT_BIT_WITNESS_DEPTH},
        {"frusta as plates, parallel", "minimum", FAULT_BIT_WITNESS_INSIDE},
        /* at tolerance 0 */
        {"needle and plate", "distance", FAULT_BIT_NOT_MINIMUM},
        {"plates, nearly parallel", "distance", FAULT_BIT_NOT_MINIMUM},
        {"plates, nearly parallel", "distance", FAULT_BIT_GAP},
        {"frusta as plates, parallel", "distance", FAULT_BIT_NOT_MINIMUM},
        {"frusta as plates, parallel", "distance", FAULT_BIT_GAP},
        {"Minkowski sums", "incremental", FAULT_BIT_POSITION},
        {"exactly touching", "incremental", FAULT_BIT_POSITION},
        {"ordinary, near", "incremental", FAULT_BIT_POSITION},
    };
    for (size_t i = 0; i < sizeof rare / sizeof *rare; i++)
        if (strcmp(row, rare[i].row) == 0 && strncmp(entry, rare[i].entry, strlen(rare[i].entry)) == 0 && fault == rare[i].fault)
            return 1000 * count < answers_of_row;
    return 0;
}

/* Prints the rates of verdict.h's faults, calls of both support functions, and CCD_LIMIT, in %. */
static void print_rates(void)
{
    printf("\n| row | call |");
    for (int bit = 0; bit <= FAULT_BIT_UNSOUND; bit++)
        printf(" %s |", fault_texts[bit]);
    printf(" limit, all tolerances | support calls |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int row = 0; row < ROWS; row++)
        for (int k = 0; k < (int)ENTRIES; k++) {
            const tally_t *n = &tallies[row][k];
            const entry_t *e = &entries[k];
            if (!n->first || e->state != STATE_NONE || e->without_centres
                || (e->call != CALL_MPR && e->call != CALL_GJK && e->call != CALL_PROVEN))
                continue;
            printf("| %s | %s |", row_names[row], e->name);
            for (int bit = 0; bit <= FAULT_BIT_UNSOUND; bit++)
                printf(" %.1f |", 100. * (double)n->first_faults[bit] / (double)n->first);
            printf(" %.2f | %.0f |\n", 100. * (double)n->limits / (double)n->answers, (double)n->calls / (double)n->first);
        }
    printf("\nMost support points:");
    for (int k = 0; k < (int)ENTRIES; k++)
        printf(" %s %lu%s", entries[k].name, most_supports[k], k + 1 < (int)ENTRIES ? "," : "\n");
}

/* Prints the broken guarantees; returns how many of these are not known. */
static unsigned long print_broken(void)
{
    unsigned long broken = 0;
    for (int row = 0; row < ROWS; row++)
        for (int k = 0; k < (int)ENTRIES; k++)
            for (int bit = 0; bit < FAULT_BIT_COUNT && !entries[k].is_libccd; bit++) {
                const tally_t *n = &tallies[row][k];
                if (!n->faults[bit])
                    continue;
                const int known = is_known(row_names[row], entries[k].name, bit, n->faults[bit], n->answers);
                printf("%s %s, %s: %s: %lu of %lu\n", known ? "broken, as known:" : "BROKEN", row_names[row],
                       entries[k].name, fault_texts[bit], n->faults[bit], n->answers);
                broken += known ? 0 : n->faults[bit];
            }
    printf("%lu answers judged, %lu broken guarantees\n", judged, broken);
    return broken;
}

int main(int argc, char **argv)
{
    const char *list = argc > 1 ? argv[1] : "";
    const int pairs = argc > 2 ? atoi(argv[2]) : 20, only = argc > 3 ? atoi(argv[3]) : -1;
    const uint64_t first = argc > 4 ? strtoull(argv[4], NULL, 10) : 0, seed = argc > 5 ? strtoull(argv[5], NULL, 10) : 0;
    const int is_hard = strcmp(list, "hard") == 0, rows = is_hard ? (int)HARD_ROWS : (int)CATEGORY_COUNT;
    is_ledger = strcmp(list, "ledger") == 0;
    catch_crashes();
    if (is_ledger || strcmp(list, "configurations") == 0) {
        if (is_ledger)
            printf("| configuration | true depth | libccd MPR | libccd GJK | our MPR | our GJK |\n|---|---|---|---|---|---|\n");
        for_each_configuration(judge_configuration);
        if (!is_ledger)
            printf("%lu answers judged, %d configurations failed\n", judged, configurations_failed);
        return configurations_failed > 0;
    }
    if ((!is_hard && strcmp(list, "categories") != 0) || pairs < 1 || only >= rows) {
        fprintf(stderr, "usage: judged configurations|ledger|categories|hard [pairs a row [row, -1 all [first pair [seed]]]]\n");
        return 2;
    }
    for (int row = 0; row < rows; row++) {
        if (only >= 0 && row != only)
            continue;
        if (!is_hard)
            judge_category(row, pairs);
        for (int i = 0; is_hard && i < pairs; i++)
            judge_hard(row, seed, first + (uint64_t)i);
    }
    print_rates();
    return print_broken() > 0;
}
