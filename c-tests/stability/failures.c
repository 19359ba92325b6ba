/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Wrong answers that were found, as promises: libccd's answer, ours and the truth.
 *
 *   failures [ID]      exit code 1 if a promise is not as the table at the end marks it */

#include "known.h"

static const double tol = 1e-6; /* metres */
static const unsigned long no_end = 400000;

static const entry_t libccd_mpr = {"libccd MPR", 1, ASK_MPR, STATE_NONE};
static const entry_t libccd_gjk = {"libccd GJK", 1, ASK_GJK, STATE_NONE};
static const entry_t mpr = {"MPR", 0, ASK_MPR, STATE_NONE};
static const entry_t mpr_again = {"MPR, again", 0, ASK_MPR_WARM, STATE_AGAIN};
static const entry_t mpr_against = {"MPR, wrong guess", 0, ASK_MPR_WARM, STATE_AGAINST};
static const entry_t minimum = {"minimum", 0, ASK_PROVEN, STATE_NONE};

static int missed(const answer_t *x) { return x->code == CCD_MISS; }

static int answered(const answer_t *x) { return x->code == CCD_HIT || x->code == CCD_LIMIT; }

/* Answers of the MPR entries that are wrong about a pair with this truth. */
typedef struct {
    int asked, wrong, libccd; /* libccd: ours more than 1 % deeper than libccd's own */
    double worst;             /* of depth / least depth */
} mpr_tally_t;

static void ask_mpr(const shape_t *a, const shape_t *b, const truth_t *t, mpr_tally_t *tally)
{
    static const entry_t *const ours[] = {&mpr, &mpr_again, &mpr_against};
    const double noise = 2 * pair_noise(a, b);
    const answer_t theirs = ask(&libccd_mpr, a, b, tol, t->n, no_end);
    int i;
    for (i = 0; i < 3; i++) {
        const answer_t x = ask(ours[i], a, b, tol, t->n, no_end);
        /* sound, which no depth below the least one is; and not too deep */
        const int wrong = x.code != CCD_HIT || !(fabs(x.depth - truth_value(a, b, x.dir)) <= noise)
            || !mpr_within(x.depth, t->depth, tol, noise, answer_supports(&x));
        tally->asked++;
        tally->wrong += wrong;
        if (wrong && answered(&x))
            tally->worst = fmax(tally->worst, x.depth / t->depth);
        tally->libccd += answered(&theirs) && x.depth > 1.01 * theirs.depth + tol;
    }
}

static int tally_print(const mpr_tally_t *t)
{
    printf("%d of %d wrong, worst %.4g of the least depth, %d deeper than libccd's", t->wrong, t->asked, t->worst, t->libccd);
    return t->wrong == 0;
}

static int one_pair(const shape_t *a, const shape_t *b, double expected, double within)
{
    mpr_tally_t tally = {0, 0, 0, 1};
    const truth_t t = truth_depth(a, b);
    const answer_t theirs = ask(&libccd_mpr, a, b, tol, t.n, no_end);
    printf("truth %.9g, libccd's MPR %.9g; ", t.depth, theirs.depth);
    ask_mpr(a, b, &t, &tally);
    if (!(fabs(t.depth - expected) <= within)) {
        printf(" the truth is not %.9g; ", expected);
        return 0;
    }
    return tally_print(&tally);
}

/* --- U01: shallow contacts of corners and rims -------------------------------------- */

static int corner_on_rim(int which)
{
    static const double cylinder[12] = {
        0.99855106295427354, 0.048532335203084642, 0.023246227922522782, -0.053812323491297345,
        0.90131270477728864, 0.42981349681869718, -9.2267862303379786e-05, -0.43044165765732256,
        0.90261839713128933, 0.40876520371579894, -0.094725323140851803, 0.78201587064166223};
    static const double box[12] = {
        -0.0778730966162966, 0.22561614781411801, -0.97109893145287063, 0.33813112391531325,
        0.92229990044137855, 0.18716366283440325, 0.93787159241719009, -0.31378375912615553,
        -0.14811019089010324, 1.9728005265422626, 0.474421426773312, -0.12951931706735448};
    shape_t a = shape_cylinder(0.67214972553380203, 0.31071183401268843);
    shape_t b = shape_box(0.39141664262605902, 0.84827187544719429, 0.73600797777455128);
    (void)which;
    shape_turn(&a, cylinder);
    shape_move(&a, cylinder[9], cylinder[10], cylinder[11]);
    shape_turn(&b, box);
    shape_move(&b, box[9], box[10], box[11]);
    return one_pair(&a, &b, 4.00694e-4, 1e-9);
}

/* Two shapes of these kinds that touch with their support points in a random direction,
 * pushed into each other by at most this part of the size: corners and rims meet. */
static void corner_pair(dice_t *d, pair_t *p, int kind_a, int kind_b, double part)
{
    double deep;
    p->a = pair_shape(d, p->verts[0], kind_a, .1, 1);
    p->b = pair_shape(d, p->verts[1], kind_b, .1, 1);
    pair_turn(d, &p->a);
    pair_turn(d, &p->b);
    do {
        double u[3], s[3];
        deep = part * pair_size(&p->a, &p->b);
        dice_unit(d, u);
        shape_move(&p->b, 0, 0, 0);
        truth_difference(&p->a, &p->b, u, s);
        shape_move(&p->b, s[0] - deep * u[0], s[1] - deep * u[1], s[2] - deep * u[2]);
        p->truth = truth_depth(&p->a, &p->b);
        part *= 1.01; /* a thin edge may be thinner than that */
    } while (!(p->truth.lower > deep / 10));
}

static int shallow_family(int which)
{
    static const int kinds[4][2] = {
        {SHAPE_BOX, SHAPE_CYLINDER}, {SHAPE_BOX, SHAPE_CONE}, {SHAPE_POLYTOPE, SHAPE_CONE}, {SHAPE_POLYTOPE, SHAPE_CYLINDER}};
    mpr_tally_t tally = {0, 0, 0, 1};
    int i;
    for (i = 0; i < 40; i++) {
        static pair_t p;
        dice_t d = dice(2000 + (uint64_t)which, (uint64_t)i);
        corner_pair(&d, &p, kinds[which / 2][0], kinds[which / 2][1], which % 2 ? 1e-5 : 1e-3);
        ask_mpr(&p.a, &p.b, &p.truth, &tally);
    }
    return tally_print(&tally);
}

/* --- U02: deep contacts of spheres, nearly concentric round objects ------------------ */

static int sphere_in_cylinder(int which)
{
    static const double turn[9] = {
        0.68610705470843958, 0.55929025432912338, -0.46524350709254908, -0.32839520560016827, -0.33254761662587562,
        -0.88406372599223482, -0.64916384558764018, 0.75934609638090222, -0.044495027732908143};
    shape_t a = shape_cylinder(0.050343935414477993, 0.030598774417823531), b = shape_sphere(0.26420555933554174);
    (void)which;
    shape_turn(&a, turn);
    shape_move(&a, 0.19921819663588103, 0.11038189574981694, -0.42768753090485601);
    shape_move(&b, 0.20260051529887335, 0.10806714408406355, -0.41443775293687929);
    return one_pair(&a, &b, 0.294687570, 1e-9);
}

/* A sphere with its centre near that of a cylinder, a hull or a box, as long as they overlap: the
 * middle of a hull's frame may lie outside of it. */
static int sphere_family(int which)
{
    static const int kinds[3] = {SHAPE_CYLINDER, SHAPE_POLYTOPE, SHAPE_BOX};
    mpr_tally_t tally = {0, 0, 0, 1};
    int i;
    for (i = 0; i < 400; i++) {
        static pair_t p;
        dice_t dd = dice(2100 + (uint64_t)which, (uint64_t)i), *d = &dd;
        double u[3], at;
        truth_t t;
        p.a = pair_shape(d, p.verts[0], kinds[which], .1, 1);
        pair_turn(d, &p.a);
        p.b = shape_sphere(dice_in(d, .1, 1));
        dice_unit(d, u);
        at = dice_log(d, 1e-3, .3) * shape_reach(&p.a);
        shape_move(&p.b, at * u[0], at * u[1], at * u[2]);
        t = truth_depth(&p.a, &p.b);
        if (t.lower > 0)
            ask_mpr(&p.a, &p.b, &t, &tally);
    }
    return tally_print(&tally);
}

/* Where 160 support points may be used up: within 1 % then, else as promised. */
static int nearly_concentric(int which)
{
    mpr_tally_t tally = {0, 0, 0, 1};
    int i;
    for (i = 0; i < 120; i++) {
        dice_t dd = dice(2200 + (uint64_t)which, (uint64_t)i), *d = &dd;
        const double r = dice_in(d, .1, 1), s = dice_in(d, .1, 1);
        double u[3], at;
        shape_t a, b = shape_sphere(s);
        truth_t t;
        a = which == 0 ? shape_sphere(r)
            : which == 1 ? shape_ellipsoid(r, r * dice_in(d, .98, 1), r * dice_in(d, .98, 1))
            : which == 2 ? shape_capsule(r, r * dice_log(d, 1e-4, .1))
                         : shape_cylinder(r, s);
        if (which == 1)
            b = shape_ellipsoid(s, s * dice_in(d, .98, 1), s * dice_in(d, .98, 1));
        if (which == 3)
            b = shape_cylinder(s, r);
        pair_turn(d, &a);
        if (which == 3)
            memcpy(b.rot, a.rot, sizeof b.rot); /* coaxial */
        at = dice_log(d, 1e-12, .1) * (r + s);
        dice_unit(d, u);
        shape_move(&b, at * u[0], at * u[1], at * u[2]);
        /* the judge's own bounds need not be finer than what is judged */
        t = truth_depth_within(&a, &b, 1e-5 * (r + s));
        ask_mpr(&a, &b, &t, &tally);
    }
    return tally_print(&tally);
}

/* --- U05: limits of iterations ---------------------------------------------------------- */

/* Two shapes with a common point well inside both: no support function is needed to
 * know that they overlap. */
static void overlapping_pair(dice_t *d, pair_t *p)
{
    double inner[2][3];
    int k, i;
    p->a = pair_shape(d, p->verts[0], dice_below(d, SHAPE_TYPES), .1, 1);
    p->b = pair_shape(d, p->verts[1], dice_below(d, SHAPE_TYPES), .1, 1);
    for (k = 0; k < 2; k++) {
        shape_t *s = k ? &p->b : &p->a;
        double w, sum = 0, o[3] = {0, 0, 0};
        pair_turn(d, s);
        memset(inner[k], 0, sizeof inner[k]);
        for (i = 0; i < 6; i++) {
            double n[3], point[3];
            int c;
            dice_unit(d, n);
            truth_point(s, o, n, point);
            w = dice_log(d, 1e-3, 1);
            sum += w;
            for (c = 0; c < 3; c++)
                inner[k][c] += w * point[c];
        }
        for (i = 0; i < 3; i++)
            inner[k][i] /= sum;
    }
    shape_move(&p->b, inner[0][0] - inner[1][0], inner[0][1] - inner[1][1], inner[0][2] - inner[1][2]);
}

static int few_iterations(int which)
{
    static const unsigned long limits[] = {1, 2, 3, 5, 7, 10, 14, 20};
    const entry_t *e = &entries[which];
    int i, k, misses = 0, unsound = 0;
    double deepest = 0;
    for (i = 0; i < 1500; i++) {
        static pair_t p;
        dice_t d = dice(2300, (uint64_t)i);
        static const double along[3] = {0.6, 0, 0.8};
        overlapping_pair(&d, &p);
        for (k = 0; k < (int)(sizeof limits / sizeof limits[0]); k++) {
            shape_t a = p.a, b = p.b;
            const double noise = 2 * pair_noise(&a, &b);
            ccd_t ccd;
            answer_t x;
            shape_query(&ccd);
            ccd.support1 = ccd.support2 = judge_support;
            ccd.mpr_tolerance = ccd.epa_tolerance = tol;
            ccd.max_iterations = limits[k];
            x = ask_objects(e, &a, &b, &ccd, along, no_end);
            if (!answered(&x)) {
                const double least = truth_depth(&p.a, &p.b).lower;
                misses += least > 1e-9 * pair_size(&p.a, &p.b);
                deepest = fmax(deepest, least);
            } else if (e->ask != ASK_MPR_INTERSECT && e->ask != ASK_GJK_INTERSECT) {
                unsound += !(fabs(x.depth - truth_value(&p.a, &p.b, x.dir)) <= noise);
            }
        }
    }
    printf("%d overlaps of %d missed, deepest %.3g m, %d depths unsound", misses, i * k, deepest, unsound);
    return misses == 0 && unsound == 0;
}

/* --- U06: exact touch ------------------------------------------------------------------- */

/* Every yes or no that there is. */
static int verdicts(const shape_t *a, const shape_t *b, char text[ENTRIES + 1])
{
    static const double along[3] = {1, 0, 0};
    int i, hits = 0, asked = 0;
    for (i = 0; i < (int)ENTRIES; i++) {
        answer_t x;
        if (entries[i].system || entries[i].ask == ASK_ALONG)
            continue;
        x = ask(&entries[i], a, b, tol, along, no_end);
        hits += answered(&x);
        text[asked++] = answered(&x) ? '1' : '0';
    }
    text[asked] = 0;
    return hits == 0 ? 0 : hits == asked ? 1 : -1;
}

static int touching_ellipsoids(int which)
{
    static const double along[3] = {1, 0, 0};
    int side, held = 1;
    (void)which;
    for (side = -1; side <= 1; side += 2) {
        const shape_t a = shape_ellipsoid(20, 40, 50);
        shape_t b = shape_ellipsoid(10, 10, 10);
        char text[ENTRIES + 1];
        answer_t m, g;
        int ours;
        shape_move(&b, 30 * side, 0, 0);
        m = ask(&libccd_mpr, &a, &b, tol, along, no_end);
        g = ask(&libccd_gjk, &a, &b, tol, along, no_end);
        ours = verdicts(&a, &b, text);
        printf("at %+d libccd %s %s, ours %s; ", 30 * side, missed(&m) ? "miss" : "hit", missed(&g) ? "miss" : "hit", text);
        held = held && ours == 0;
    }
    return held;
}

static int touches(int which)
{
    static const ccd_real_t corner[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    shape_t pair[][2] = {
        {shape_sphere(.5), shape_sphere(.5)},       {shape_box(.5, .5, .5), shape_box(.5, .25, .25)},
        {shape_capsule(.5, 1), shape_sphere(.5)},   {shape_cylinder(.5, 1), shape_box(.5, 1, 1)},
        {shape_ellipsoid(.5, 1, 2), shape_box(.5, 1, 1)}, {shape_polytope(corner, 4), shape_box(.5, .5, .5)},
        {shape_cylinder(.5, .5), shape_cylinder(.5, .25)}, {shape_cone(.5, .5), shape_sphere(.5)},
    };
    static const double at[][3] = {{1, 0, 0}, {1, 0, 0}, {1, 0, .25}, {1, 0, 0}, {1, 0, 0}, {-.5, .25, .25}, {1, 0, 0}, {0, 0, 1}};
    int i, mixed = 0, negative = 0;
    const int n = (int)(sizeof pair / sizeof pair[0]);
    (void)which;
    for (i = 0; i < n; i++) {
        char text[ENTRIES + 1];
        int k;
        shape_move(&pair[i][1], at[i][0], at[i][1], at[i][2]);
        if (verdicts(&pair[i][0], &pair[i][1], text) < 0) {
            printf("pair %d %s; ", i, text);
            mixed++;
        }
        for (k = 0; k < (int)ENTRIES; k++) {
            answer_t x;
            if (entries[k].system)
                continue;
            x = ask(&entries[k], &pair[i][0], &pair[i][1], tol, at[i], no_end);
            negative += answered(&x) && signbit(x.depth) != 0;
        }
    }
    printf("%d of %d answered by two rules, %d depths below +0", mixed, n, negative);
    return mixed == 0 && negative == 0;
}

/* --- U09: a state of the swapped pair ----------------------------------------------------- */

static int swapped_state(int which)
{
    int i, deeper = 0;
    double worst = 0;
    (void)which;
    for (i = 0; i < 500; i++) {
        dice_t dd = dice(2400, (uint64_t)i), *d = &dd;
        shape_t a = shape_box(dice_in(d, .1, .5), dice_in(d, .1, .5), dice_in(d, .1, .5));
        shape_t b = shape_box(dice_in(d, .1, .5), dice_in(d, .1, .5), dice_in(d, .1, .5));
        static const entry_t local = {"local", 0, ASK_LOCAL, STATE_NONE};
        ccd_warm_t warm;
        ccd_t ccd;
        answer_t x, cold;
        double u[3];
        pair_turn(d, &a);
        pair_turn(d, &b);
        dice_unit(d, u);
        shape_move(&b, .3 * u[0], .3 * u[1], .3 * u[2]);
        shape_query(&ccd);
        ccd.support1 = ccd.support2 = judge_support;
        ccd.mpr_tolerance = ccd.epa_tolerance = tol;
        memset(&warm, 0, sizeof warm);
        cold = ask_guarded(&local, &b, &a, &ccd, NULL, NULL, no_end);
        ask_guarded(&local, &a, &b, &ccd, &warm, NULL, no_end);
        x = ask_guarded(&local, &b, &a, &ccd, &warm, NULL, no_end);
        if (answered(&cold) != answered(&x) || (answered(&x) && x.depth > cold.depth + tol)) {
            deeper++;
            worst = fmax(worst, x.depth - cold.depth);
        }
    }
    printf("%d of %d deeper than cold, worst %.3g m", deeper, i, worst);
    return deeper == 0;
}

/* ccdMPRPenetrationWarm keeps its promise whatever the state holds: what the swapped
 * pair left, or another pair. */
static int state_of_others(int which)
{
    static const entry_t warm_mpr = {"MPR, warm", 0, ASK_MPR_WARM, STATE_NONE};
    static const int kinds[4] = {SHAPE_BOX, SHAPE_CYLINDER, SHAPE_CONE, SHAPE_POLYTOPE};
    ccd_warm_t warm;
    ccd_t ccd;
    double worst = 1;
    int i, wrong = 0;
    shape_query(&ccd);
    ccd.support1 = ccd.support2 = judge_support;
    ccd.mpr_tolerance = ccd.epa_tolerance = tol;
    memset(&warm, 0, sizeof warm);
    for (i = 0; i < 300; i++) {
        static pair_t p;
        dice_t dd = dice(2450, (uint64_t)i), *d = &dd;
        const int first = kinds[dice_below(d, 4)], second = kinds[dice_below(d, 4)];
        shape_t a, b;
        answer_t x;
        corner_pair(d, &p, first, second, dice_log(d, 1e-5, 1e-1));
        a = p.a;
        b = p.b;
        if (which == 0) {
            memset(&warm, 0, sizeof warm);
            ask_guarded(&warm_mpr, &b, &a, &ccd, &warm, NULL, no_end);
        }
        x = ask_guarded(&warm_mpr, &a, &b, &ccd, &warm, NULL, no_end);
        if (x.code != CCD_HIT || !(fabs(x.depth - truth_value(&a, &b, x.dir)) <= 2 * pair_noise(&a, &b))
            || !mpr_within(x.depth, p.truth.depth, tol, 2 * pair_noise(&a, &b), answer_supports(&x))) {
            wrong++;
            worst = fmax(worst, x.depth / p.truth.depth);
        }
    }
    printf("%d of %d wrong, worst %.4g of the least depth", wrong, i, worst);
    return wrong == 0;
}

/* --- U12: proofs between parallel discs ------------------------------------------------------ */

static int judged_minimum(const shape_t *a, const shape_t *b, int loud)
{
    const truth_t t = truth_depth(a, b);
    question_t q = question(a, b, tol, &t);
    const answer_t x = ask(&minimum, a, b, tol, t.n, no_end);
    const int faults = judge(&minimum, &x, a, b, &q) & FAULTS_NEVER & ~FAULT_LIMIT;
    if (loud) {
        const answer_t theirs = ask(&libccd_mpr, a, b, tol, t.n, no_end);
        printf("truth %.9g, libccd's MPR %s %.9g, ours %s %.9g, at least %.9g; ", t.depth, missed(&theirs) ? "miss" : "hit",
               theirs.depth, missed(&x) ? "miss" : "hit", x.depth, x.lower);
    }
    return faults == 0;
}

/* Two cones 11 micrometres apart, the base of one over the apex of the other. */
static int cones_apart(int which)
{
    static const double turn[9] = {
        0.90918648647866329, 0.37739526750882713, -0.17593392187558488, 0.079939006405530477, 0.25646224045637289,
        0.96324289484791636, 0.40864371775359543, -0.88983140610007605, 0.20300340060817076};
    shape_t a = shape_cone(0.93754327898898726, 0.75800192786697729), b = shape_cone(0.76434195005137706, 0.52757161162981558);
    (void)which;
    shape_turn(&a, turn);
    shape_turn(&b, turn);
    shape_move(&a, -0.49697751924640166, 2.0216922724918875, 0.70127657434067459);
    shape_move(&b, -0.48037416746485506, 3.1694007929941179, 1.6026589947444148);
    return judged_minimum(&a, &b, 1);
}

/* Cylinders and cones with one axis, a flat face of one on the other, nearly touching. */
static int discs_resting(int which)
{
    int i, wrong = 0;
    (void)which;
    for (i = 0; i < 300; i++) {
        dice_t dd = dice(2500, (uint64_t)i), *d = &dd;
        const int below = dice_below(d, 2), above = dice_below(d, 2);
        const double r = dice_in(d, .1, 1), h = dice_in(d, .1, 1), s = dice_in(d, .1, 1), g = dice_in(d, .1, 1);
        shape_t a = below ? shape_cylinder(r, h) : shape_cone(r, h), b = above ? shape_cylinder(s, g) : shape_cone(s, g);
        const double deep = dice_sign(d) * dice_log(d, 1e-12, 1e-2), angle = dice_in(d, 0, 6.28), at = dice_in(d, 0, r);
        double rot[9], p[3], v[3];
        int k;
        dice_rotation(d, rot);
        v[0] = at * cos(angle);
        v[1] = at * sin(angle);
        v[2] = h + g - deep;
        for (k = 0; k < 3; k++)
            p[k] = truth_dot3(rot + 3 * k, v);
        shape_turn(&a, rot);
        shape_turn(&b, rot);
        shape_move(&b, p[0], p[1], p[2]);
        wrong += !judged_minimum(&a, &b, 0);
    }
    printf("%d of %d wrong", wrong, i);
    return wrong == 0;
}

/* --- a ball and a tip ------------------------------------------------------------------------- */

/* The hull of a unit ball about the origin and of the point 3 along the axis. */
typedef struct {
    double axis[3];
} drop_t;

static void drop_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const double *axis = ((const drop_t *)obj)->axis;
    double l, along;
    int i;
    judge_count();
    l = sqrt((double)ccdVec3Len2(dir));
    along = (double)dir->v[0] * axis[0] + (double)dir->v[1] * axis[1] + (double)dir->v[2] * axis[2];
    for (i = 0; i < 3; i++)
        out->v[i] = (ccd_real_t)(3 * along > l ? 3 * axis[i] : l > 0 ? (double)dir->v[i] / l : 0);
}

static void drop_center(const void *obj, ccd_vec3_t *out)
{
    (void)obj;
    ccdVec3Set(out, 0, 0, 0);
}

/* --- a ball and a flat ------------------------------------------------------------------------ */

/* A ball about the origin, cut off across the axis: h is the height of what is missing. */
typedef struct {
    double axis[3], radius, h;
} cut_t;

static void cut_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const cut_t *c = obj;
    const double flat = c->radius - c->h, rim = sqrt(fmax(c->radius * c->radius - flat * flat, 0));
    double n[3], across[3], l = sqrt((double)ccdVec3Len2(dir)), along, aside;
    int i, twice;
    judge_count();
    for (i = 0; i < 3; i++)
        across[i] = n[i] = l > 0 ? (double)dir->v[i] / l : 0;
    along = truth_dot3(n, c->axis);
    for (twice = 0; twice < 2; twice++) { /* what is left of a short vector is rounding: taken off again */
        const double off = truth_dot3(across, c->axis);
        for (i = 0; i < 3; i++)
            across[i] -= off * c->axis[i];
        aside = sqrt(truth_dot3(across, across));
        for (i = 0; i < 3; i++)
            across[i] = aside > 0 ? across[i] / aside : 0;
    }
    for (i = 0; i < 3; i++)
        out->v[i] = (ccd_real_t)(along * c->radius <= flat ? c->radius * n[i]
                                                           : flat * c->axis[i] + rim * across[i]);
}

/* What is round wherever it was asked may be flat between: the least depth is across the flat, and
 * no query may take all for a ball and its proof for true. */
static int ball_and_flat(int which)
{
    const entry_t *e = &entries[which];
    double worst = 0;
    int i, wrong = 0;
    for (i = 0; i < 60; i++) {
        dice_t d = dice(2700, (uint64_t)i);
        cut_t a, b;
        ccd_t ccd;
        answer_t x;
        double side[3], truth;
        dice_unit(&d, a.axis);
        dice_unit(&d, side);
        a.radius = 1;
        a.h = dice_log(&d, 1e-3, .1);
        b = a;
        b.radius = dice_in(&d, .3, 1);
        b.h = 0;
        truth = a.radius + b.radius - a.h;
        CCD_INIT(&ccd);
        ccd.support1 = ccd.support2 = cut_support;
        ccd.center1 = ccd.center2 = drop_center;
        ccd.mpr_tolerance = ccd.epa_tolerance = 1e-4;
        x = ask_objects(e, &a, &b, &ccd, side, no_end);
        if (!answered(&x)) {
            wrong++;
        } else if (x.has_proof) {
            const double noise = 64 * (double)CCD_EPS;
            wrong += !(x.lower <= truth + noise) || !(x.depth >= truth - noise);
            worst = fmax(worst, x.lower - truth);
        }
    }
    printf("%d of %d wrong, proven beyond the truth %.3g", wrong, i, worst);
    return wrong == 0;
}

static void point_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    (void)dir;
    judge_count();
    *out = *(const ccd_vec3_t *)obj;
}

static void point_center(const void *obj, ccd_vec3_t *out) { *out = *(const ccd_vec3_t *)obj; }

/* Two samples on the round side agree on a ball of radius 1, and its core would prove a
 * depth of 1.1; the cone is 0.4/3 away. */
static int ball_and_tip(int which)
{
    const entry_t *e = &entries[which];
    const double truth = .4 / 3, noise = 1e-14;
    double worst = 0;
    int i, wrong = 0;
    for (i = 0; i < 20; i++) {
        dice_t d = dice(2600, (uint64_t)i);
        drop_t drop;
        ccd_vec3_t point;
        ccd_t ccd;
        answer_t x;
        double side[3], l;
        int k;
        dice_unit(&d, drop.axis);
        if (i == 0) {
            drop.axis[0] = 1;
            drop.axis[1] = drop.axis[2] = 0;
        }
        for (k = 0; k < 3; k++)
            point.v[k] = (ccd_real_t)(2.6 * drop.axis[k]);
        /* a normal of the cone that touches the ball: 1/3 along the axis, the rest aside */
        do {
            dice_unit(&d, side);
            l = truth_dot3(side, drop.axis);
            for (k = 0; k < 3; k++)
                side[k] -= l * drop.axis[k];
            l = sqrt(truth_dot3(side, side));
        } while (!(l > .1));
        for (k = 0; k < 3; k++)
            side[k] = drop.axis[k] / 3 + sqrt(8) / 3 * side[k] / l;
        CCD_INIT(&ccd);
        ccd.support1 = drop_support;
        ccd.center1 = drop_center;
        ccd.support2 = point_support;
        ccd.center2 = point_center;
        ccd.mpr_tolerance = ccd.epa_tolerance = tol;
        x = ask_objects(e, &drop, &point, &ccd, side, no_end);
        if (!answered(&x)) {
            wrong++;
        } else if (e->ask != ASK_MPR_INTERSECT && e->ask != ASK_GJK_INTERSECT && e->ask != ASK_MPR_INTERSECT_WARM) {
            const int is_mpr = entry_is_mpr(e);
            wrong += !(x.depth >= truth - noise) || (x.has_proof && !(x.lower <= truth + noise))
                || !(is_mpr ? mpr_within(x.depth, truth, tol, noise, answer_supports(&x)) : x.depth <= truth + tol + noise);
            worst = fmax(worst, x.depth);
        }
    }
    printf("%d of %d wrong, truth %.9g, deepest %.9g", wrong, i, truth, worst);
    return wrong == 0;
}

int main(int argc, char **argv)
{
    enum { HOLDS = 0, BROKEN = 1 };
    static const promise_t listed[] = {
        {"U01", "a box's corner on a cylinder's rim", corner_on_rim, 0, HOLDS},
        {"U01", "box and cylinder, 1e-3 of the size", shallow_family, 0, HOLDS},
        {"U01", "box and cylinder, 1e-5 of the size", shallow_family, 1, HOLDS},
        {"U01", "box and cone, 1e-3 of the size", shallow_family, 2, HOLDS},
        {"U01", "box and cone, 1e-5 of the size", shallow_family, 3, HOLDS},
        {"U01", "hull and cone, 1e-3 of the size", shallow_family, 4, HOLDS},
        {"U01", "hull and cone, 1e-5 of the size", shallow_family, 5, HOLDS},
        {"U01", "hull and cylinder, 1e-3 of the size", shallow_family, 6, HOLDS},
        {"U01", "hull and cylinder, 1e-5 of the size", shallow_family, 7, HOLDS},
        {"U02", "a sphere around a cylinder", sphere_in_cylinder, 0, HOLDS},
        {"U02", "sphere and cylinder, deep", sphere_family, 0, HOLDS},
        {"U02", "sphere and hull, deep", sphere_family, 1, HOLDS},
        {"U02", "sphere and box, deep", sphere_family, 2, HOLDS},
        {"U02", "nearly concentric spheres", nearly_concentric, 0, HOLDS},
        {"U02", "nearly concentric, nearly round ellipsoids", nearly_concentric, 1, HOLDS},
        {"U02", "a short capsule nearly concentric with a sphere", nearly_concentric, 2, HOLDS},
        {"U02", "nearly concentric parallel cylinders", nearly_concentric, 3, HOLDS},
        {"U06", "ellipsoids that touch", touching_ellipsoids, 0, HOLDS},
        {"U06", "touches by one rule", touches, 0, HOLDS},
        {"U09", "boxes with a state of the swapped pair", swapped_state, 0, HOLDS},
        {"U09", "MPR with a state of the swapped pair", state_of_others, 0, HOLDS},
        {"U09", "MPR with a state of another pair", state_of_others, 1, HOLDS},
        {"U12", "the minimum of two cones 11 um apart", cones_apart, 0, HOLDS},
        {"U12", "the minimum of cylinders and cones on each other", discs_resting, 0, HOLDS},
    };
    /* and three for every entry point, by its name */
    promise_t all[sizeof listed / sizeof listed[0] + 3 * ENTRIES];
    int n = (int)(sizeof listed / sizeof listed[0]), i;
    memcpy(all, listed, sizeof listed);
    for (i = 0; i < (int)ENTRIES; i++) {
        promise_t p = {"U05", entries[i].name, few_iterations, 0, HOLDS};
        if (entries[i].system || entries[i].ask == ASK_ALONG)
            continue;
        p.which = i;
        if (entries[i].state == STATE_NONE || entries[i].state == STATE_ZERO) {
            all[n++] = p;
        }
        p.id = "tip";
        p.holds = ball_and_tip;
        all[n++] = p;
        p.id = "flat";
        p.holds = ball_and_flat;
        all[n++] = p;
    }
    return promises_run(all, n, argc > 1 ? argv[1] : NULL) > 0;
}
