/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Tests guarantees about the cost of a query: support points, bytes of stack. (call_limit in entries.h bounds
 * the slowest query.)
 *
 *   costs [ID...]          exits with 1 where a guarantee of the table at the end is broken */

#define _GNU_SOURCE /* ucontext.h */
#include "categories.h"
#include "harness/floor.h"

#include <ucontext.h>

static const double tol = 1e-6; /* metres */
static const unsigned long unlimited = 400000;

/* Sums over samples of one kind. */
typedef struct {
    unsigned long points, reference; /* support points: measured, and of what they are compared with */
    unsigned long queries;
} cost_t;

/* Adds one sample; which: a call, or what is measured. */
typedef void sample_t(int which, rng_t *d, cost_t *cost);

typedef struct {
    const char *id, *what;
    sample_t *sample;
    int which;
    uint64_t stream; /* of random numbers */
    double limit;    /* points at most, as a multiple of reference, or of queries where there is none */
} guarantee_t;

/* Returns the support points of one call; state: the arguments of a distance. */
static unsigned long points_in_state(int call, int state, const shape_t *a, const shape_t *b, ccd_warm_t *warm)
{
    const entry_t e = {"", 0, call, state, 0};
    const ccd_t ccd = counting_query(tol);
    shape_t sa = *a, sb = *b;
    return call_guarded(&e, &sa, &sb, &ccd, warm, NULL, unlimited).calls / 2;
}

static unsigned long points_of(int call, const shape_t *a, const shape_t *b, ccd_warm_t *warm)
{
    return points_in_state(call, STATE_NONE, a, b, warm);
}

/* Makes two shapes of these types that overlap by this part of the size. */
static void make_overlapping(rng_t *d, pair_t *p, const int *types, int n, double part)
{
    do {
        pair_set_both(d, p, types, n);
        pair_scatter(d, p, 1, 1e-3);
        p->truth = truth_depth(&p->a, &p->b);
    } while (!(p->truth.lower > part * pair_size(&p->a, &p->b)));
    pair_set_depth(p, part * pair_size(&p->a, &p->b));
}

static const int round_types[] = {SHAPE_SPHERE, SHAPE_CAPSULE, SHAPE_ELLIPSOID};

/* --- U11: faces that rest on each other, unchanged; their position is not read ------------------- */

/* Makes a box that rests on a box, turned about the vertical: faces over each other. */
static void make_resting_boxes(rng_t *d, pair_t *p)
{
    double rot[9], turned[9], about[9], v[3];
    p->a = random_shape_of(d, p->verts[0], SHAPE_BOX, .3, 1);
    p->b = random_shape_of(d, p->verts[1], SHAPE_BOX, .1, .3);
    rng_rotation(d, rot);
    rotation_about(0, 0, 1, rng_uniform(d, .1, 1.4), about);
    rotation_times(rot, about, turned);
    v[0] = rng_uniform(d, -.5, .5) * (double)p->a.p[0];
    v[1] = rng_uniform(d, -.5, .5) * (double)p->a.p[1];
    v[2] = (double)p->a.p[2] + (double)p->b.p[2] - rng_log_uniform(d, 1e-5, 1e-3);
    shape_turn(&p->a, rot);
    shape_turn(&p->b, turned);
    shape_move(&p->b, truth_dot3(rot, v), truth_dot3(rot + 3, v), truth_dot3(rot + 6, v));
}

static void sample_unchanged(int call, rng_t *d, cost_t *cost)
{
    static pair_t p;
    ccd_warm_t warm = {0};
    make_resting_boxes(d, &p);
    wanted_outputs = 0;
    points_of(call, &p.a, &p.b, &warm);
    points_of(call, &p.a, &p.b, &warm);
    cost->points += points_of(call, &p.a, &p.b, &warm);
    cost->queries++;
    wanted_outputs = CCD_WANT_ALL;
}

/* --- U14: pairs that stay apart ------------------------------------------------------------------- */

/* b wanders, a tenth of a millimetre and of a degree a frame, and is never closer than twice the motion of
 * the point that moves most: one support point a query. Of the first query only what it takes more than
 * a cold one counts. */
static void sample_staying_apart(int call, rng_t *d, cost_t *cost)
{
    const double turn = .1 * 3.14159265358979323846 / 180;
    static pair_t p;
    ccd_warm_t warm = {0};
    double dir[3], axis[3], pos[3], gap, rot[9];
    make_overlapping(d, &p, all_types, SHAPE_TYPES, 1e-2);
    gap = 2 * (1e-4 + turn * shape_reach(&p.b));
    shape_shift(&p.b, 1e-2 * pair_size(&p.a, &p.b) + gap * rng_uniform(d, 1, 10), p.truth.n);
    rng_unit_vector(d, dir);
    rng_unit_vector(d, axis);
    for (int frame = 0; frame < 50; frame++, cost->queries++) {
        const unsigned long points = points_of(call, &p.a, &p.b, &warm), cold = frame ? 0 : points_of(call, &p.a, &p.b, NULL);
        double drift[3];
        cost->points += points > cold ? points - cold : 0;
        rng_unit_vector(d, drift);
        for (int k = 0; k < 3; k++) {
            dir[k] += .3 * drift[k];
            axis[k] += .3 * drift[(k + 1) % 3];
            pos[k] = (double)p.b.pos[k];
        }
        rotation_about(axis[0], axis[1], axis[2], turn, rot);
        shape_move(&p.b, 0, 0, 0);
        shape_turn_by(&p.b, rot, pos[0], pos[1], pos[2]);
        shape_shift(&p.b, 1e-4 / sqrt(truth_dot3(dir, dir)), dir);
        truth_t t = truth_depth_within(&p.a, &p.b, 1e-5);
        if (-t.depth < gap)
            shape_shift(&p.b, 1.01 * (gap + t.depth), t.n);
    }
}

/* --- U15: distances --------------------------------------------------------------------------------- */

enum { DISTANCE_COLD, DISTANCE_MARGINS, DISTANCE_LIMITED, OF_BALLS };

/* Cold, and no farther than a tenth of the size; of balls and capsules also as points and segments
 * with margins. */
static void sample_distance(int which, rng_t *d, cost_t *cost)
{
    const int of_balls = which >= OF_BALLS, kind = which % OF_BALLS;
    static pair_t p;
    make_overlapping(d, &p, of_balls ? round_types : all_types, of_balls ? 2 : SHAPE_TYPES, 1e-2);
    shape_shift(&p.b, rng_log_uniform(d, 2e-2, 1) * pair_size(&p.a, &p.b), p.truth.n);
    margin_size = pair_size(&p.a, &p.b);
    cost->queries++;
    if (kind == DISTANCE_LIMITED)
        cost->reference += points_of(CALL_DISTANCE, &p.a, &p.b, NULL);
    if (kind == DISTANCE_MARGINS)
        p.a.p[0] = p.b.p[0] = 0;
    const int state = kind == DISTANCE_MARGINS ? STATE_MARGINS : kind == DISTANCE_LIMITED ? STATE_MAX_DISTANCE : STATE_NONE;
    cost->points += points_in_state(CALL_DISTANCE, state, &p.a, &p.b, NULL);
}

/* --- U16: bodies on a floor; their position is not read ----------------------------------------------- */

enum { FLOOR_DEEP, FLOOR_ABOVE, FLOOR_INTERSECT, FLOOR_WIDE };

/* A body of any kind 1 mm deep in, or 1 mm above, a plate of 1 m, or of 20 m. */
static void sample_floor(int which, rng_t *d, cost_t *cost)
{
    static ccd_real_t verts[3 * FLOOR_CORNERS];
    const int kind = which % FLOOR_WIDE;
    shape_t plate, body;
    double normal[3];
    floor_pair(d, (floor_kind_t)rng_below(d, 3), which < FLOOR_WIDE ? 1 : 20, kind == FLOOR_ABOVE ? 1e-3 : -1e-3, 0, verts,
               &plate, &body, normal);
    wanted_outputs = 0;
    cost->points += points_of(kind == FLOOR_INTERSECT ? CALL_MPR_INTERSECT : CALL_MPR, &plate, &body, NULL);
    cost->queries++;
    wanted_outputs = CCD_WANT_ALL;
}

/* --- U03: stack --------------------------------------------------------------------------------------- */

/* Each call runs on a painted stack of its own; the paint that is gone tells how deep it went. The stack
 * of the callbacks alone, and of a call that is refused at once, is subtracted. */
enum { STACK_WORDS = 1 << 15 };
static const uint64_t paint = UINT64_C(0xa5a5a5a5a5a5a5a5);
static uint64_t stack[STACK_WORDS];
static ucontext_t outer_context, stack_context;

static struct {
    entry_t entry;
    int only_callbacks;
    shape_t *a, *b;
    ccd_warm_t *warm;
    const ccd_vec3_t *along; /* NULL: refused by those that need one */
} on_stack;

static void run_on_stack(void)
{
    static answer_t out;
    static const ccd_vec3_t dir = {{1, 0, 0}};
    static ccd_t ccd;
    ccd_vec3_t point;
    ccd = counting_query(tol);
    if (on_stack.only_callbacks) {
        /* Called as the library calls it: a compiler that sees the function makes its frame part of this one. */
        void (*volatile support)(const void *, const ccd_vec3_t *, ccd_vec3_t *) = ccd.support1;
        support(on_stack.a, &dir, &point);
        support(on_stack.b, &dir, &point);
    } else {
        call_once(&on_stack.entry, on_stack.a, on_stack.b, &ccd, on_stack.warm, on_stack.along, &out);
    }
}

static size_t stack_used(void)
{
    size_t i, used;
    support_calls = 0;
    getcontext(&stack_context);
    stack_context.uc_stack.ss_sp = stack;
    stack_context.uc_stack.ss_size = sizeof stack;
    stack_context.uc_link = &outer_context;
    makecontext(&stack_context, run_on_stack, 0);
    swapcontext(&outer_context, &stack_context);
    for (i = 0; i < STACK_WORDS && stack[i] == paint; i++)
        ;
    used = (STACK_WORDS - i) * sizeof *stack;
    memset(&stack[i], 0xa5, used);
    return used;
}

/* Checks the stack of the deepest call, and of the deepest boolean. Returns the number of broken limits. */
static int check_stack(void)
{
    static const struct { const char *what; size_t limit; } rows[2] = {{"any call", 44 << 10}, {"a boolean", 8 << 10}};
    static const ccd_vec3_t along = {{1, 0, 0}};
    static const entry_t refused = {"", 0, CALL_ALONG, STATE_NONE, 0};
    static pair_t p;
    size_t deepest[2] = {0, 0};
    int deepest_call[2] = {0, 0}, broken = 0;
    memset(stack, 0xa5, sizeof stack);
    support_call_limit = unlimited;
    for (int i = 0; i < 2000; i++) {
        category_pair(i % CATEGORY_COUNT, (uint64_t)(i / CATEGORY_COUNT), SHAPE_TIE_SIGN, &p);
        on_stack.a = &p.a;
        on_stack.b = &p.b;
        on_stack.only_callbacks = 1;
        size_t empty = stack_used();
        on_stack.only_callbacks = 0;
        on_stack.entry = refused;
        on_stack.along = NULL;
        empty += stack_used();
        on_stack.along = &along;
        for (int k = 0; k < 2 * PAIR_CALL_COUNT; k++) { /* cold, then with the state that this left */
            ccd_warm_t warm;
            on_stack.entry.call = k / 2;
            on_stack.warm = k % 2 ? memset(&warm, 0, sizeof warm) : NULL;
            if (on_stack.entry.call == CALL_CONTACTS)
                continue;
            size_t used = stack_used();
            if (on_stack.warm)
                used = stack_used();
            for (int row = 0; row <= entry_is_boolean(&on_stack.entry); row++)
                if (used > empty + deepest[row]) {
                    deepest[row] = used - empty;
                    deepest_call[row] = k / 2;
                }
        }
    }
    for (int row = 0; row < 2; row++) {
        const int is_broken = deepest[row] > rows[row].limit;
        printf("U03   stack of %s: at most %zu bytes, in %s -- %s\n", rows[row].what, deepest[row], call_table[deepest_call[row]].name,
               is_broken ? "FAILED" : "met");
        broken += is_broken;
    }
    return broken;
}

/* --- the table ------------------------------------------------------------------------------------ */

static const guarantee_t guarantees[] = {
    {"U11", "a face that rests on a face, its position not read", sample_unchanged, CALL_MPR_WARM, 4201, 4.5},
    {"U14", "boolean, staying apart", sample_staying_apart, CALL_MPR_INTERSECT_WARM, 4400, 1.05},
    {"U14", "MPR, staying apart", sample_staying_apart, CALL_MPR_WARM, 4400, 1.05},
    {"U15", "distances, cold", sample_distance, DISTANCE_COLD, 4500, 10},
    {"U15", "distances, max_distance", sample_distance, DISTANCE_LIMITED, 4500, 2. / 3},
    {"U15", "distances of balls and capsules, cold", sample_distance, OF_BALLS + DISTANCE_COLD, 4500, 10},
    {"U15", "distances of points and segments with margins", sample_distance, OF_BALLS + DISTANCE_MARGINS, 4500, 2.5},
    {"U15", "distances of balls and capsules, max_distance", sample_distance, OF_BALLS + DISTANCE_LIMITED, 4500, 2. / 3},
    {"U16", "bodies in a plate of 1 m", sample_floor, FLOOR_DEEP, 4600, 5},
    {"U16", "bodies above a plate of 1 m", sample_floor, FLOOR_ABOVE, 4600, 5},
    {"U16", "boolean, bodies in a plate of 1 m", sample_floor, FLOOR_INTERSECT, 4600, 4},
    {"U16", "bodies in a plate of 20 m", sample_floor, FLOOR_WIDE + FLOOR_DEEP, 4600, 5.5},
    {"U16", "bodies above a plate of 20 m", sample_floor, FLOOR_WIDE + FLOOR_ABOVE, 4600, 5.5},
    {"U16", "boolean, bodies in a plate of 20 m", sample_floor, FLOOR_WIDE + FLOOR_INTERSECT, 4600, 4},
};
enum { GUARANTEES = sizeof guarantees / sizeof *guarantees, SAMPLES = 300 };

/* Prints the cost and returns whether it is within the limit. */
static int is_met(const guarantee_t *g)
{
    cost_t cost = {0, 0, 0};
    for (int i = 0; i < SAMPLES; i++) {
        rng_t d = rng(g->stream, (uint64_t)i);
        g->sample(g->which, &d, &cost);
    }
    const double unit = (double)(cost.reference ? cost.reference : cost.queries);
    printf("%.3f support points %s, at most %.3g", (double)cost.points / unit, cost.reference ? "for one" : "a query", g->limit);
    return (double)cost.points <= g->limit * unit;
}

/* Returns whether the arguments have this ID, or none. */
static int is_asked(int argc, char **argv, const char *id)
{
    int found = argc < 2;
    for (int i = 1; i < argc; i++)
        found |= strcmp(id, argv[i]) == 0;
    return found;
}

int main(int argc, char **argv)
{
    int checked = 0, broken = 0;
    catch_crashes();
    for (const guarantee_t *g = guarantees; g < guarantees + GUARANTEES; g++) {
        if (!is_asked(argc, argv, g->id))
            continue;
        printf("%-6s%s: ", g->id, g->what);
        fflush(stdout);
        const int met = is_met(g);
        checked++;
        broken += !met;
        printf(" -- %s\n", met ? "met" : "FAILED");
    }
    if (is_asked(argc, argv, "U03")) {
        checked++;
        broken += check_stack();
    }
    printf("%d guarantees, %d broken\n", checked, broken);
    return checked == 0 || broken > 0;
}
