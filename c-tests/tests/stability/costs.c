/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Tests promises about the cost of a query: support points, bytes of stack. (How many
 * support points the slowest may ask for is call_limit in judge.h.) A promise that is broken and
 * not marked so fails the test; one that is marked and holds fails it too, so that the mark goes
 * when the fault does.
 *
 *   costs [ID]             exit code 1 if a promise is not as the table at the end marks it */

#define _GNU_SOURCE /* ucontext.h */
#include "categories.h"

#include <ucontext.h>

typedef struct {
    const char *id, *what;
    int (*holds)(int which); /* prints its figures on the line that the id began */
    int which;
    int known; /* known to be broken */
} promise_t;

static const double tol = 1e-6; /* metres */
static const unsigned long no_end = 400000;

/* Support points of one call; state: how else a distance is asked. */
static unsigned long supports_as(int what, int state, const shape_t *a, const shape_t *b, ccd_warm_t *warm)
{
    const entry_t e = {"", 0, what, state};
    shape_t sa = *a, sb = *b;
    const ccd_t ccd = counting_query(tol);
    answer_t x = call_guarded(&e, &sa, &sb, &ccd, warm, NULL, no_end);
    return x.calls / 2;
}

static unsigned long supports(int what, const shape_t *a, const shape_t *b, ccd_warm_t *warm)
{
    return supports_as(what, STATE_NONE, a, b, warm);
}

static ccd_warm_t fresh(void)
{
    ccd_warm_t warm;
    memset(&warm, 0, sizeof warm);
    return warm;
}

/* Two shapes of these kinds that overlap by this part of the size. */
static void overlapping(rng_t *d, pair_t *p, const int *kinds, int n, double part)
{
    do {
        pair_of(d, p, kinds, n);
        pair_scatter(d, p, 1, 1e-3);
        p->truth = truth_depth(&p->a, &p->b);
    } while (!(p->truth.lower > part * pair_size(&p->a, &p->b)));
    pair_pull_out(p, part * pair_size(&p->a, &p->b));
}

static const int flat_kind[] = {SHAPE_BOX, SHAPE_POLYTOPE};
static const int round_kind[] = {SHAPE_SPHERE, SHAPE_CAPSULE, SHAPE_ELLIPSOID};

/* --- U07: pairs that overlap pay nothing for having been apart ------------------------------ */

static int having_been_apart(int what)
{
    unsigned long apart = 0, never = 0, cold = 0;
    int i;
    for (i = 0; i < 200; i++) {
        static pair_t p;
        rng_t d = rng(4000, (uint64_t)i);
        ccd_warm_t first = fresh(), second = fresh();
        overlapping(&d, &p, any_kind, 7, 1e-2);
        shape_t away = p.b;
        shape_shift(&away, 2e-2 * pair_size(&p.a, &p.b), p.truth.n);
        supports(what, &p.a, &away, &first);
        supports(what, &p.a, &p.b, &first); /* the old direction is found to be none */
        apart += supports(what, &p.a, &p.b, &first);
        supports(what, &p.a, &p.b, &second);
        never += supports(what, &p.a, &p.b, &second);
        cold += supports(what, &p.a, &p.b, NULL);
    }
    printf("%.2f supports, never apart %.2f, cold %.2f", (double)apart / i, (double)never / i, (double)cold / i);
    return (double)apart <= 1.02 * (double)never && (double)apart <= 1.02 * (double)cold;
}

/* --- U08: nor do pairs asked once ------------------------------------------------------------- */

static int asked_once(int which)
{
    const double gap = which % 2 ? 3 : .05;
    const int what = which < 2 ? CALL_LOCAL : CALL_MPR_WARM;
    unsigned long warm = 0, cold = 0;
    int i;
    for (i = 0; i < 200; i++) {
        static pair_t p;
        rng_t d = rng(4100, (uint64_t)i);
        ccd_warm_t state = fresh();
        double axis[3], rot[9], n[3];
        overlapping(&d, &p, any_kind, 7, 1e-2);
        shape_shift(&p.b, gap * pair_size(&p.a, &p.b), p.truth.n);
        if (what == CALL_LOCAL) {
            /* a guess ten degrees off */
            ccd_vec3_t guess;
            rng_unit_vector(&d, axis);
            truth_cross3(axis, p.truth.n, n);
            rotation_about(n[0], n[1], n[2], 3.14159265358979323846 / 18, rot);
            for (int k = 0; k < 3; k++)
                guess.v[k] = (ccd_real_t)truth_dot3(rot + 3 * k, p.truth.n);
            OURS(ccdWarmGuess)(&state, &guess);
        }
        warm += supports(what, &p.a, &p.b, &state);
        cold += supports(what, &p.a, &p.b, NULL);
    }
    printf("%.2f supports with a state for once, %.2f without", (double)warm / i, (double)cold / i);
    return (double)warm <= 1.02 * (double)cold;
}

/* --- U11: contacts that do not change ------------------------------------------------------------ */

/* A box that rests on a box, turned about the vertical: faces over each other. */
static void resting_boxes(rng_t *d, pair_t *p)
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

enum { UNCHANGED_FACES, UNCHANGED_FACES_UNREAD, UNCHANGED_FLAT, UNCHANGED_ROUND, UNCHANGED_ROUND_DEEP };

static int unchanged(int which)
{
    unsigned long again = 0, cold = 0;
    int i;
    for (i = 0; i < 200; i++) {
        static pair_t p;
        rng_t d = rng(4200 + (uint64_t)which, (uint64_t)i);
        ccd_warm_t warm = fresh();
        unsigned long n = 0;
        if (which <= UNCHANGED_FACES_UNREAD)
            resting_boxes(&d, &p);
        else if (which == UNCHANGED_FLAT)
            overlapping(&d, &p, flat_kind, 2, rng_log_uniform(&d, 1e-5, 1e-2));
        else
            overlapping(&d, &p, round_kind, 3, which == UNCHANGED_ROUND ? rng_log_uniform(&d, 1e-5, 1e-2) : .1);
        for (int k = 0; k < 3; k++) {
            wanted_outputs = which == UNCHANGED_FACES_UNREAD ? 0 : CCD_WANT_ALL;
            n = supports(CALL_MPR_WARM, &p.a, &p.b, &warm);
            cold += k ? 0 : n;
        }
        again += n;
    }
    wanted_outputs = CCD_WANT_ALL;
    printf("%.2f supports asked again, cold %.2f", (double)again / i, (double)cold / i);
    return which < UNCHANGED_ROUND ? (double)again <= 4.5 * i : (double)again <= .7 * (double)cold;
}

/* --- V11: faces that slide, their position read --------------------------------------------------- */

static int sliding(int what)
{
    unsigned long all = 0;
    int frames = 0;
    for (int i = 0; i < 200; i++) {
        static pair_t p;
        rng_t d = rng(4300, (uint64_t)i);
        ccd_warm_t warm = fresh();
        resting_boxes(&d, &p);
        double way = rng_uniform(&d, 0, 6.28);
        for (int k = 0; k < 50; k++) {
            const unsigned long n = supports(what, &p.a, &p.b, &warm);
            double pos[3];
            all += k ? n : 0;
            frames += k > 0;
            for (int m = 0; m < 3; m++)
                pos[m] = (double)p.b.pos[m] + .002 * (cos(way) * (double)p.a.rot[3 * m] + sin(way) * (double)p.a.rot[3 * m + 1]);
            shape_move(&p.b, pos[0], pos[1], pos[2]);
        }
    }
    printf("%.2f callbacks a query", 2. * (double)all / frames);
    return all <= 6UL * (unsigned long)frames;
}

/* --- U14: pairs that stay apart ------------------------------------------------------------------- */

/* b wanders, a tenth of a millimetre and of a degree a frame, and is never nearer than twice the way of
 * the point that moves most: one support point a query. What the first one asks more than one without a
 * state is for the others. */
static int staying_apart(int what)
{
    const double turn = .1 * 3.14159265358979323846 / 180;
    unsigned long all = 0;
    int frames = 0;
    for (int i = 0; i < 200; i++) {
        static pair_t p;
        rng_t d = rng(4400, (uint64_t)i);
        ccd_warm_t warm = fresh();
        double way[3], about[3], at[3], gap, rot[9];
        overlapping(&d, &p, any_kind, 7, 1e-2);
        gap = 2 * (1e-4 + turn * shape_reach(&p.b));
        shape_shift(&p.b, 1e-2 * pair_size(&p.a, &p.b) + gap * rng_uniform(&d, 1, 10), p.truth.n);
        rng_unit_vector(&d, way);
        rng_unit_vector(&d, about);
        for (int k = 0; k < 50; k++, frames++) {
            const unsigned long n = supports(what, &p.a, &p.b, &warm), cold = k ? 0 : supports(what, &p.a, &p.b, NULL);
            double aside[3];
            all += n > cold ? n - cold : 0;
            rng_unit_vector(&d, aside);
            for (int m = 0; m < 3; m++) {
                way[m] += .3 * aside[m];
                about[m] += .3 * aside[(m + 1) % 3];
            }
            rotation_about(about[0], about[1], about[2], turn, rot);
            for (int m = 0; m < 3; m++)
                at[m] = (double)p.b.pos[m];
            shape_move(&p.b, 0, 0, 0);
            shape_turn_by(&p.b, rot, at[0], at[1], at[2]);
            shape_shift(&p.b, 1e-4 / sqrt(truth_dot3(way, way)), way);
            truth_t t = truth_depth_within(&p.a, &p.b, 1e-5);
            if (-t.depth < gap)
                shape_shift(&p.b, 1.01 * (gap + t.depth), t.n);
        }
    }
    printf("%.3f supports a query", (double)all / frames);
    return (double)all <= 1.05 * frames;
}

/* --- U15: distances --------------------------------------------------------------------------------- */

/* Cold, warm and no farther than a tenth of the size; and of balls and capsules, as they are and as
 * points and segments with margins. */
static int distances(int of_cores)
{
    unsigned long cold = 0, other = 0, near = 0;
    int i;
    for (i = 0; i < 300; i++) {
        static pair_t p;
        rng_t d = rng(4500, (uint64_t)i);
        ccd_warm_t warm = fresh();
        overlapping(&d, &p, of_cores ? round_kind : any_kind, of_cores ? 2 : 7, 1e-2);
        shape_shift(&p.b, rng_log_uniform(&d, 2e-2, 1) * pair_size(&p.a, &p.b), p.truth.n);
        margin_size = pair_size(&p.a, &p.b);
        supports(CALL_DISTANCE, &p.a, &p.b, &warm);
        cold += supports(CALL_DISTANCE, &p.a, &p.b, NULL);
        near += supports_as(CALL_DISTANCE, STATE_MAX_DISTANCE, &p.a, &p.b, NULL);
        if (of_cores)
            p.a.p[0] = p.b.p[0] = 0;
        other += of_cores ? supports_as(CALL_DISTANCE, STATE_MARGINS, &p.a, &p.b, NULL) : supports(CALL_DISTANCE, &p.a, &p.b, &warm);
    }
    printf("%.2f supports cold, %.2f %s, %.2f if near", (double)cold / i, (double)other / i, of_cores ? "as cores" : "again", (double)near / i);
    return 3 * near <= 2 * cold && (double)other <= (of_cores ? 2.5 : 3) * i && (double)cold <= 10 * i;
}

/* --- U03: stack --------------------------------------------------------------------------------------- */

/* A painted stack of its own for one call; how far the paint is gone tells how deep the
 * call went. What the callbacks take alone, and a call that is refused at once, is taken
 * off. */
enum { STACK_WORDS = 1 << 15 };
static const uint64_t paint = UINT64_C(0xa5a5a5a55a5a5a5a);
static uint64_t *stack_floor;
static ucontext_t stack_outer, stack_inner;
static const entry_t *stack_entry; /* NULL: the callbacks alone */
static shape_t *stack_a, *stack_b;
static ccd_t stack_query;
static ccd_warm_t *stack_warm;
static const ccd_vec3_t stack_along = {{1, 0, 0}};
static const ccd_vec3_t *stack_dir; /* NULL: refused by those that need one */

static void on_the_stack(void)
{
    static answer_t out;
    ccd_vec3_t point;
    if (stack_entry) {
        call_once(stack_entry, stack_a, stack_b, &stack_query, stack_warm, stack_dir, &out);
    } else {
        counting_support(stack_a, &stack_along, &point);
        counting_support(stack_b, &stack_along, &point);
    }
}

static size_t stack_touched(void)
{
    size_t i, touched;
    getcontext(&stack_inner);
    stack_inner.uc_stack.ss_sp = stack_floor;
    stack_inner.uc_stack.ss_size = STACK_WORDS * sizeof *stack_floor;
    stack_inner.uc_link = &stack_outer;
    makecontext(&stack_inner, on_the_stack, 0);
    swapcontext(&stack_outer, &stack_inner);
    for (i = 0; i < STACK_WORDS && stack_floor[i] == paint; i++)
        ;
    touched = (STACK_WORDS - i) * sizeof *stack_floor;
    for (; i < STACK_WORDS; i++)
        stack_floor[i] = paint;
    return touched;
}

/* All calls; those for a depth, where they ask for few support points; yes or no. */
enum { STACK_ANY, STACK_FEW, STACK_VERDICT };
static const size_t stack_limits[] = {44, 12, 8}; /* KB */
enum { FEW = 22 };

static int stack_asks(int class, const entry_t *e)
{
    switch (class) {
    case STACK_ANY: return 1;
    case STACK_FEW: return entry_is_mpr(e) || e->call == CALL_GJK || e->call == CALL_SEPARATE || e->call == CALL_PROVEN;
    default: return entry_is_boolean(e);
    }
}

/* The deepest of a class. */
static int stack_of(int class)
{
    static const entry_t refused = {"", 0, CALL_ALONG, STATE_NONE};
    static pair_t p;
    size_t empty, most[ENTRIES] = {0}, limit = stack_limits[class] * 1024, deepest = 0;
    int i;
    stack_query = counting_query(tol);
    if (!stack_floor)
        stack_floor = (uint64_t *)malloc(STACK_WORDS * sizeof *stack_floor);
    if (!stack_floor)
        return 0;
    for (i = 0; i < STACK_WORDS; i++)
        stack_floor[i] = paint;
    support_call_limit = no_end;
    for (i = 0; i < 2000; i++) {
        category_pair(i % CATEGORY_COUNT, (uint64_t)(i / CATEGORY_COUNT), SHAPE_TIE_SIGN, &p);
        stack_a = &p.a;
        stack_b = &p.b;
        stack_entry = NULL;
        empty = stack_touched();
        stack_entry = &refused;
        stack_dir = NULL;
        empty += stack_touched();
        stack_dir = &stack_along;
        for (int k = 0; k < (int)ENTRIES; k++) {
            const entry_t *e = &entries[k];
            ccd_warm_t warm = fresh();
            if (e->is_libccd || !stack_asks(class, e))
                continue;
            stack_entry = e;
            stack_warm = e->state == STATE_NONE ? NULL : &warm;
            support_calls = 0;
            size_t n = stack_touched();
            if (e->state == STATE_OWN) {
                support_calls = 0;
                n = stack_touched();
            }
            if (class == STACK_FEW && support_calls > 2 * FEW)
                continue;
            n = n > empty ? n - empty : 0;
            most[k] = n > most[k] ? n : most[k];
        }
    }
    for (int k = 0; k < (int)ENTRIES; k++) {
        if (most[k] > limit)
            printf("%s %zu; ", entries[k].name, most[k]);
        deepest = most[k] > deepest ? most[k] : deepest;
    }
    printf("at most %zu bytes in %d pairs, %zu asked for", deepest, i, limit);
    return deepest <= limit;
}

int main(int argc, char **argv)
{
    enum { HOLDS = 0, BROKEN = 1 };
    static const promise_t listed[] = {
        {"U03", "stack of any call", stack_of, STACK_ANY, HOLDS},
        {"U03", "stack of a depth by up to 22 support points", stack_of, STACK_FEW, BROKEN},
        {"U03", "stack of yes or no", stack_of, STACK_VERDICT, HOLDS},
        {"U07", "yes or no after having been apart", having_been_apart, CALL_MPR_INTERSECT_WARM, HOLDS},
        {"U07", "MPR after having been apart", having_been_apart, CALL_MPR_WARM, HOLDS},
        {"U08", "local with a guess, a little apart", asked_once, 0, HOLDS},
        {"U08", "local with a guess, far apart", asked_once, 1, HOLDS},
        {"U08", "MPR with a fresh state, a little apart", asked_once, 2, HOLDS},
        {"U08", "MPR with a fresh state, far apart", asked_once, 3, HOLDS},
        {"U11", "a face that rests on a face", unchanged, UNCHANGED_FACES, BROKEN},
        {"U11", "the same, its position not read", unchanged, UNCHANGED_FACES_UNREAD, HOLDS},
        {"V11", "faces that slide", sliding, CALL_MPR_WARM, BROKEN},
        {"V11", "faces that slide, by ccdPenetration", sliding, CALL_PENETRATION, BROKEN},
        {"U14", "yes or no, staying apart", staying_apart, CALL_MPR_INTERSECT_WARM, HOLDS},
        {"U14", "MPR, staying apart", staying_apart, CALL_MPR_WARM, HOLDS},
        {"U15", "distances", distances, 0, BROKEN},
        {"U15", "distances of cores with margins", distances, 1, HOLDS},
        {"U11", "shallow polytopes, unchanged", unchanged, UNCHANGED_FLAT, BROKEN},
        {"U11", "shallow round pairs, unchanged", unchanged, UNCHANGED_ROUND, BROKEN},
        {"U11", "deep round pairs, unchanged", unchanged, UNCHANGED_ROUND_DEEP, BROKEN},
    };
    const int n = (int)(sizeof listed / sizeof listed[0]);
    int broken = 0, surprises = 0;
    catch_crashes();
    for (int i = 0; i < n; i++) {
        const promise_t *p = &listed[i];
        if (argc > 1 && strncmp(p->id, argv[1], strlen(argv[1])) != 0)
            continue;
        printf("%-6s%s: ", p->id, p->what);
        fflush(stdout);
        int holds = p->holds(p->which);
        broken += !holds;
        surprises += holds == p->known;
        printf(" -- %s\n", holds ? p->known ? "FAILED: holds, and is marked as known to be broken" : "holds"
                                 : p->known ? "broken, as known" : "FAILED");
    }
    printf("%d promises, %d broken, %d not as marked\n", n, broken, surprises);
    return surprises > 0;
}
