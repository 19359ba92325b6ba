/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Directions are an accuracy too. Pairs of primitives, of which one is curved, lie 0.2 mm to 0.3 m deep in each other and
 * move slowly. The direction of ccdMPRPenetration, cold and with a state, is compared with that of a proof to 1e-11 m, and
 * with its own of the frame before. Then two spheres, whose direction is known.
 *
 *   directions [motions of a pair]        prints the table, exits with 1 beyond a bound */

#include "harness/this_library.h"
#include "tests/contract/check.h"

enum { COLD, WARM, STARTS, FRAMES = 80 };

static const double DEGREE = 3.14159265358979323846 / 180;

/* Degrees: rms and largest error, rms of what the direction turns in a frame. */
typedef struct {
    double depth, rms, largest, turn;
} bound_t;

/* At 2 mm the pairs themselves turn by 0.06 degrees a frame, deeper by 0.05. One path at 0.3 m is in a flat valley, where the
 * depth changes by 1e-5 m in a degree. */
static const bound_t BOUNDS[] = {{2e-4, .04, .3, .03}, {2e-3, .06, .6, .08}, {.05, .08, .6, .09}, {.3, .1, 2.5, .13}};

static ccd_t settings(double tolerance)
{
    ccd_t ccd = shape_query();
    ccd.mpr_tolerance = ccd.epa_tolerance = (ccd_real_t)tolerance;
    ccd.max_iterations = 500;
    return ccd;
}

typedef struct {
    double error2, largest, turn2;
    unsigned long hits, steps, points;
} sums_t;

/* Degrees; the chord is exact where the cosine is rounded. */
static double angle(const ccd_vec3_t *a, const ccd_vec3_t *b)
{
    double chord2 = 0;
    for (int i = 0; i < 3; i++) {
        const double d = (double)a->v[i] - (double)b->v[i];
        chord2 += d * d;
    }
    return 2 * asin(fmin(1, sqrt(chord2) / 2)) / DEGREE;
}

static int find_direction(const shape_t *a, const shape_t *b, const ccd_t *ccd, ccd_warm_t *warm, ccd_vec3_t *dir)
{
    ccd_real_t depth;
    return warm ? OURS(ccdMPRPenetrationWarm)(a, b, ccd, warm, &depth, dir, NULL)
                : OURS(ccdMPRPenetration)(a, b, ccd, &depth, dir, NULL);
}

/* Moves b along a random line to where the proven depth is `depth`. */
static void place(rng_t *r, const shape_t *a, shape_t *b, const ccd_t *ccd, double depth)
{
    double way[3], near = 0, far = 2;
    rng_unit_vector(r, way);
    for (int k = 0; k < 40; k++) {
        const double middle = (near + far) / 2;
        ccd_penetration_t hit;
        shape_move(b, middle * way[0], middle * way[1], middle * way[2]);
        if (OURS(ccdPenetrationProven)(a, b, ccd, NULL, 0, &hit) >= 0 && (double)hit.depth > depth)
            near = middle;
        else
            far = middle;
    }
}

static void follow(rng_t *r, const shape_t *first, const shape_t *second, double depth, sums_t sums[STARTS])
{
    shape_t a = *first, b = *second;
    const ccd_t ccd = settings(1e-6), exact = settings(1e-11);
    double rot[9], axis[3], turn[9], step[3];
    ccd_warm_t warm;
    ccd_vec3_t last[STARTS], last_truth = {{0, 0, 0}};
    int is_known[STARTS] = {0}, is_truth_known = 0;
    memset(&warm, 0, sizeof warm);
    rng_rotation(r, rot);
    shape_turn(&a, rot);
    rng_rotation(r, rot);
    shape_turn(&b, rot);
    place(r, &a, &b, &ccd, depth);
    const double speed = fmin(1, depth / .002);
    rng_unit_vector(r, axis);
    rotation_about(axis[0], axis[1], axis[2], 1.5e-3 * speed, turn);
    rng_unit_vector(r, step);
    for (int k = 0; k < FRAMES; k++) {
        ccd_penetration_t truth;
        double next[9], old[9];
        for (int i = 0; i < 9; i++)
            old[i] = (double)b.rot[i];
        rotation_times(turn, old, next);
        shape_turn(&b, next);
        shape_shift(&b, 2e-4 * speed, step);
        const int is_proven = OURS(ccdPenetrationProven)(&a, &b, &exact, NULL, 0, &truth) == 0;
        /* Not where the global minimum jumps. */
        const int is_step = is_truth_known && is_proven && angle(&truth.dir, &last_truth) < 1;
        is_truth_known = is_proven;
        last_truth = truth.dir;
        for (int start = 0; start < STARTS; start++) {
            sums_t *sum = &sums[start];
            ccd_vec3_t dir;
            a.calls = b.calls = 0;
            const int is_hit = find_direction(&a, &b, &ccd, start == WARM ? &warm : NULL, &dir) == 0;
            /* Another minimum of nearly the same depth is no error. */
            const double error = is_hit && is_proven ? angle(&dir, &truth.dir) : 180;
            if (error < 10) {
                sum->hits++;
                sum->points += (a.calls + b.calls) / 2;
                sum->error2 += error * error;
                sum->largest = fmax(sum->largest, error);
                if (is_known[start] && is_step) {
                    const double turned = angle(&dir, &last[start]);
                    sum->turn2 += turned * turned;
                    sum->steps++;
                }
            }
            is_known[start] = error < 10;
            last[start] = dir;
        }
    }
}

static void check_primitives(int motions)
{
    const shape_t shapes[] = {shape_sphere(.5),       shape_capsule(.25, .25), shape_box(.5, .35, .25),
                              shape_cylinder(.35, .4), shape_make(SHAPE_CONE, .4, .4, 0),      shape_ellipsoid(.5, .35, .25)};
    enum { SHAPES = sizeof shapes / sizeof *shapes };
    printf("depth m, start: error rms, largest, turn a frame rms, degrees; support points\n");
    for (size_t d = 0; d < sizeof BOUNDS / sizeof *BOUNDS; d++) {
        const bound_t *bound = &BOUNDS[d];
        sums_t sums[STARTS];
        memset(sums, 0, sizeof sums);
        for (int i = 0; i < SHAPES; i++)
            for (int j = i; j < SHAPES; j++)
                for (int k = 0; k < motions; k++) {
                    rng_t r = rng(7200 + d, (uint64_t)((i * SHAPES + j) * motions + k));
                    if (shapes[i].type != SHAPE_BOX || shapes[j].type != SHAPE_BOX)
                        follow(&r, &shapes[i], &shapes[j], bound->depth, sums);
                }
        for (int start = 0; start < STARTS; start++) {
            const sums_t *sum = &sums[start];
            const char *name = start == WARM ? "warm" : "cold";
            const double rms = sqrt(sum->error2 / (double)sum->hits), turn = sqrt(sum->turn2 / (double)sum->steps);
            printf("%g %s: %.3f %.2f %.3f; %.2f\n", bound->depth, name, rms, sum->largest, turn,
                   (double)sum->points / (double)sum->hits);
            CHECK(sum->hits > (unsigned long)(12 * motions * FRAMES), "%lu hits, %s", sum->hits, name);
            CHECK(rms <= bound->rms, "%g, %g m deep, %s", rms, bound->depth, name);
            CHECK(sum->largest <= bound->largest, "%g, %g m deep, %s", sum->largest, bound->depth, name);
            CHECK(turn <= bound->turn, "%g, %g m deep, %s", turn, bound->depth, name);
        }
    }
}

/* Two unit spheres 1.6 m deep; one moves 1 mm a frame, by which the direction turns by 0.11 degrees. An error of the depth
 * of the tolerance is one of the direction of sqrt(2 tolerance / (2 - depth)), 0.13 degrees. */
static void check_spheres(void)
{
    const ccd_t ccd = settings(1e-6);
    shape_t a = shape_sphere(1), b = shape_sphere(1);
    ccd_warm_t warm;
    ccd_vec3_t last = {{0, 0, 0}};
    double largest = 0, jump = 0;
    memset(&warm, 0, sizeof warm);
    for (int k = 0; k < 200; k++) {
        shape_move(&b, .3 + .001 * k, .2, .1);
        const double l = sqrt(pow((double)b.pos[0], 2) + pow((double)b.pos[1], 2) + pow((double)b.pos[2], 2));
        ccd_vec3_t truth, dir;
        for (int i = 0; i < 3; i++)
            truth.v[i] = b.pos[i] / (ccd_real_t)l;
        CHECK(find_direction(&a, &b, &ccd, &warm, &dir) == 0, "a miss in frame %d", k);
        largest = fmax(largest, angle(&dir, &truth));
        if (k > 0)
            jump = fmax(jump, angle(&dir, &last));
        last = dir;
    }
    printf("spheres: error up to %.3f, turn a frame up to %.3f degrees\n", largest, jump);
    CHECK(largest <= .14, "%g degrees", largest);
    CHECK(jump <= .25, "%g degrees", jump);
}

int main(int argc, char **argv)
{
    check_primitives(argc > 1 ? atoi(argv[1]) : 6);
    check_spheres();
    return checks_end();
}
