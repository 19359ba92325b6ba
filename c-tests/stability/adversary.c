/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Support functions that no convex shape has: every query comes back all the same,
 * within a bounded number of calls and with a code that says so. Where it claims an
 * answer, that answer is finite and its direction unit; where not, outputs are as they
 * were.
 *
 *   adversary [rounds [seed]] */

#include "categories.h"

enum {
    RANDOM_POINTS,   /* anything inside a ball */
    MOVING,          /* the shape has moved at every call */
    NOT_CONVEX,      /* boundary point of a star */
    WRONG_SIGN,      /* the support point of the opposite direction */
    CONSTANT,        /* a point shape */
    CONSTANT_ZERO,
    SUBNORMAL,       /* a shape of 1e-310 (1e-40) metres */
    LARGE,           /* of 1e150 (1e18): squares still fit */
    LARGER,          /* of 1e300 (1e37): nothing fits */
    GROWING,         /* larger at every call */
    SHRINKING,
    COARSE,          /* a shape rounded to a grid */
    NOISY,           /* a shape with relative noise of 1e-9 */
    LAZY,            /* stops short of the boundary by up to 10 % */
    SOMETIMES_NAN,
    SOMETIMES_INFINITE,
    SOMETIMES_WRONG, /* a good shape, wrong at one call in eight */
    ADVERSARIES
};

static const char *const adversary_text[] = {
    "random points", "moving", "not convex", "wrong sign", "constant", "constant zero", "subnormal", "large", "larger",
    "growing", "shrinking", "coarse", "noisy", "lazy", "sometimes NaN", "sometimes infinite", "sometimes wrong"};

typedef struct {
    int kind;
    dice_t dice;
    double size;
    shape_t shape;
    ccd_real_t verts[3 * PAIR_VERTICES];
    unsigned long calls;
    int spoke_nonsense; /* has returned a point that is not finite */
} adversary_t;

static void adversary_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    adversary_t *a = (adversary_t *)obj;
    dice_t *d = &a->dice;
    double u[3], s;
    ccd_vec3_t turned;
    int i;
    judge_count();
    a->calls++;
    shape_support(&a->shape, dir, out);
    switch (a->kind) {
    case RANDOM_POINTS:
        dice_unit(d, u);
        s = a->size * dice_in(d, 0, 1);
        for (i = 0; i < 3; i++)
            out->v[i] = (ccd_real_t)(s * u[i]);
        break;
    case MOVING:
        for (i = 0; i < 3; i++)
            out->v[i] += (ccd_real_t)(a->size * dice_in(d, -.2, .2));
        break;
    case NOT_CONVEX:
        s = a->size * (1 + .7 * sin(9 * (double)dir->v[0]) * cos(7 * (double)dir->v[1]));
        for (i = 0; i < 3; i++)
            out->v[i] = (ccd_real_t)(s * (double)dir->v[i]);
        break;
    case WRONG_SIGN:
        for (i = 0; i < 3; i++)
            turned.v[i] = -dir->v[i];
        shape_support(&a->shape, &turned, out);
        break;
    case CONSTANT:
    case CONSTANT_ZERO:
        for (i = 0; i < 3; i++)
            out->v[i] = a->kind == CONSTANT ? a->shape.pos[i] : 0;
        break;
    case SUBNORMAL:
        for (i = 0; i < 3; i++)
            out->v[i] *= (ccd_real_t)(sizeof(ccd_real_t) == 8 ? 1e-310 : 1e-40);
        break;
    case LARGE:
        for (i = 0; i < 3; i++)
            out->v[i] *= (ccd_real_t)(sizeof(ccd_real_t) == 8 ? 1e150 : 1e18);
        break;
    case LARGER:
        for (i = 0; i < 3; i++)
            out->v[i] *= (ccd_real_t)(sizeof(ccd_real_t) == 8 ? 1e300 : 1e37);
        break;
    case GROWING:
    case SHRINKING:
        s = pow(a->kind == GROWING ? 1.01 : .99, (double)a->calls);
        for (i = 0; i < 3; i++)
            out->v[i] *= (ccd_real_t)s;
        break;
    case COARSE:
        for (i = 0; i < 3; i++)
            out->v[i] = (ccd_real_t)(floor((double)out->v[i] * 8 / a->size + .5) / 8 * a->size);
        break;
    case NOISY:
        for (i = 0; i < 3; i++)
            out->v[i] *= (ccd_real_t)(1 + dice_in(d, -1e-9, 1e-9));
        break;
    case LAZY:
        for (i = 0; i < 3; i++)
            out->v[i] *= (ccd_real_t)dice_in(d, .9, 1);
        break;
    case SOMETIMES_NAN:
        if (dice_below(d, 8) == 0)
            out->v[dice_below(d, 3)] = (ccd_real_t)NAN;
        break;
    case SOMETIMES_INFINITE:
        if (dice_below(d, 8) == 0)
            out->v[dice_below(d, 3)] = (ccd_real_t)(dice_sign(d) * HUGE_VAL);
        break;
    default:
        if (dice_below(d, 8) == 0)
            for (i = 0; i < 3; i++)
                out->v[i] = (ccd_real_t)(a->size * dice_in(d, -1, 1));
        break;
    }
    for (i = 0; i < 3; i++)
        a->spoke_nonsense |= !isfinite(out->v[i]);
}

static void adversary_center(const void *obj, ccd_vec3_t *out)
{
    adversary_t *a = (adversary_t *)obj;
    shape_center(&a->shape, out);
}

/* Support calls that a query may take on both objects: what the caps in the library
 * come to (a few thousand support points), with room. */
static const unsigned long most_calls = 40000;

int main(int argc, char **argv)
{
    int rounds = argc > 1 ? atoi(argv[1]) : 20, kinds[2], k, r, i, failed = 0;
    uint64_t seed = argc > 2 ? (uint64_t)atoi(argv[2]) : 1;
    static unsigned long worst[ENTRIES];
    static int codes[ENTRIES][8];
    static adversary_t objects[2], kept[2];
    unsigned long asked = 0;
    judge_begin();
    for (r = 0; r < rounds; r++)
        for (kinds[0] = 0; kinds[0] < ADVERSARIES; kinds[0]++)
            for (kinds[1] = -1; kinds[1] < ADVERSARIES; kinds[1]++) {
                static const double tols[] = {1e-4, 1e-9, 0, 1e-2};
                dice_t d = dice(4000 + seed, (uint64_t)((r * ADVERSARIES + kinds[0]) * (ADVERSARIES + 1) + kinds[1] + 1));
                double u[3], along[3];
                for (i = 0; i < 2; i++) {
                    adversary_t *o = &objects[i];
                    memset(o, 0, sizeof *o);
                    o->kind = kinds[i] < 0 ? ADVERSARIES : kinds[i]; /* -1: an honest shape */
                    o->size = 1;
                    o->shape = pair_shape(&d, o->verts, dice_below(&d, SHAPE_TYPES), .1, 1);
                    pair_turn(&d, &o->shape);
                    dice_unit(&d, u);
                    shape_move(&o->shape, .5 * u[0], .5 * u[1], .5 * u[2]);
                    o->dice = d;
                }
                dice_unit(&d, along);
                memcpy(kept, objects, sizeof kept);
                for (k = 0; k < (int)ENTRIES; k++) {
                    const entry_t *e = &entries[k];
                    ccd_t ccd;
                    answer_t x;
                    const char *wrong = NULL;
                    int nonsense;
                    if (e->system)
                        continue;
                    memcpy(objects, kept, sizeof kept);
                    for (i = 0; i < 2; i++)
                        if (objects[i].shape.nverts)
                            objects[i].shape.verts = objects[i].verts;
                    CCD_INIT(&ccd);
                    ccd.support1 = adversary_support;
                    ccd.support2 = kinds[1] < 0 ? judge_support : adversary_support;
                    ccd.center1 = adversary_center;
                    ccd.center2 = kinds[1] < 0 ? shape_center : adversary_center;
                    ccd.mpr_tolerance = ccd.epa_tolerance = (ccd_real_t)tols[r % 4];
                    x = ask_objects(e, &objects[0], kinds[1] < 0 ? (const void *)&objects[1].shape : (const void *)&objects[1],
                                    &ccd, along, most_calls);
                    asked++;
                    nonsense = objects[0].spoke_nonsense || objects[1].spoke_nonsense;
                    if (x.code == ANSWER_LOOP)
                        wrong = "too many calls, or endless";
                    else if (x.code == ANSWER_CRASH)
                        wrong = "crash";
                    else if (x.code > CCD_LIMIT || x.code < CCD_BAD_INPUT)
                        wrong = "undocumented code";
                    else if (x.touched)
                        wrong = "outputs written without an answer";
                    else if (!x.has_proof && e->ask < ASK_PENETRATION
                             && x.code != CCD_HIT && x.code != CCD_MISS && x.code != CCD_NO_MEMORY)
                        wrong = "a code of the extension from a compatible call";
                    else if (nonsense && e->state != STATE_AGAIN && x.code == CCD_HIT && e->ask != ASK_MPR_INTERSECT
                             && e->ask != ASK_GJK_INTERSECT)
                        wrong = "an answer from points that are not finite";
                    else if ((x.code == CCD_HIT || x.code == CCD_LIMIT) && e->ask != ASK_MPR_INTERSECT
                             && e->ask != ASK_GJK_INTERSECT && e->ask != ASK_MPR_INTERSECT_WARM
                             && !(e->ask == ASK_SEPARATE && x.depth == 0)) {
                        double l = sqrt(truth_dot3(x.dir, x.dir));
                        if (!(x.depth >= 0) || !isfinite(x.depth))
                            wrong = "depth not finite or below 0";
                        else if (!(fabs(l - 1) <= tolerance(TOL_UNIT)) && e->ask != ASK_SEPARATE)
                            wrong = "direction not unit";
                        else if (x.has_pos && !(isfinite(x.pos[0]) && isfinite(x.pos[1]) && isfinite(x.pos[2])))
                            wrong = "position not finite";
                        else if (x.has_proof && !(x.lower >= 0 && isfinite(x.lower)))
                            wrong = "lower bound below 0";
                    }
                    if (x.calls > worst[k])
                        worst[k] = x.calls;
                    if (x.code <= CCD_LIMIT && x.code >= CCD_BAD_INPUT)
                        codes[k][CCD_LIMIT - x.code]++;
                    if (wrong && failed++ < 20) {
                        printf("FAILED %s, %s against %s, round %d, tolerance %g: %s: ", e->name, adversary_text[kinds[0]],
                               kinds[1] < 0 ? "a shape" : adversary_text[kinds[1]], r, tols[r % 4], wrong);
                        print_answer(stdout, &x);
                        printf("\n");
                    }
                }
            }
    for (k = 0; k < (int)ENTRIES; k++)
        if (!entries[k].system)
            printf("%-22s most calls %6lu  limit %d hit %d miss %d memory %d bad input %d\n", entries[k].name, worst[k],
                   codes[k][0], codes[k][1], codes[k][2], codes[k][3], codes[k][4]);
    printf("%lu questions, %d failures\n", asked, failed);
    return failed > 0;
}
