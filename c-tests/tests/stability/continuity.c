/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Contacts in motion: sliding, rolling, rocking, hundreds of frames each. From frame
 * to frame the direction turns by more than a degree only where the true minimum does,
 * and the contact position of a resting face moves no faster than the bodies allow. Each
 * motion is run cold, and warm with one state carried along; both have the same depth, and
 * the same position for a resting face. Prints, per motion and method, jumps and largest steps. */

#include "categories.h"

enum { FRAMES = 300 };

/* The resting face, and how far the positions of two methods on it may differ, metres: all methods find
 * the same corners, except those a hair below the support plane; the points that represent a round face
 * vary with the normal. */
enum { NO_FACE, CORNERS, ROUND };
static const double pos_tolerance[] = {HUGE_VAL, sizeof(ccd_real_t) == 8 ? 1e-4 : 1e-3, 5e-3};

/* b moves on a, whose top is at z = 0.2. Pairs of numbers are values at the first frame and after the last. */
typedef struct {
    const char *name;
    shape_t a, b;
    double step;     /* the most that a point of either body moves in a frame */
    int face;
    double first[4]; /* b's own rotation: axis, angle */
    double axis[3], turn[2]; /* and a rotation in motion, rad */
    int swings;      /* the rotation goes there and back, twice, to either side */
    double from[2], to[2], depth[2];
} motion_t;

static const double pi = 3.14159265358979323846;

static void place_in_frame(const motion_t *m, int frame, shape_t *a, shape_t *b)
{
    const double t = (double)frame / FRAMES, angle = m->turn[0] + (m->turn[1] - m->turn[0]) * (m->swings ? sin(4 * pi * t) : t);
    const double down[3] = {0, 0, -1}, origin[3] = {0, 0, 0};
    double first[9], moving[9], all[9], lowest[3];
    *a = m->a;
    *b = m->b;
    rotation_about(m->first[0], m->first[1], m->first[2], m->first[3], first);
    rotation_about(m->axis[0], m->axis[1], m->axis[2], angle, moving);
    rotation_times(moving, first, all);
    shape_turn(b, all);
    truth_support(b, origin, down, lowest);
    shape_move(b, m->from[0] + (m->to[0] - m->from[0]) * t, m->from[1] + (m->to[1] - m->from[1]) * t,
               .2 - lowest[2] - m->depth[0] - (m->depth[1] - m->depth[0]) * t);
}

/* A resting contact's position may move so much faster than the bodies: where the contact patch loses
 * a corner at one end, its middle moves at half that speed, a witness at a corner at up to the whole. */
static const double max_pos_speed = 2;

/* Returns degrees. */
static double angle_between(const double a[3], const double b[3])
{
    double c[3];
    truth_cross3(a, b, c);
    return atan2(sqrt(truth_dot3(c, c)), truth_dot3(a, b)) * 57.29577951308232;
}

/* Returns whether the direction may turn from the last frame's: the truth turns, or the old direction ties
 * with the new one within the method's tolerance; MPR may also leave or enter a near tie. */
static int may_turn(const entry_t *e, const shape_t *a, const shape_t *b, const criteria_t *q, const truth_t *before,
                    const double last[3], const double dir[3])
{
    const int is_mpr = entry_is_mpr(e);
    const double tie = is_mpr ? tolerance(TOL_MPR) * q->truth.depth : 0;
    return angle_between(q->truth.n, before->n) > 1
        || (is_mpr && (angle_between(last, before->n) > 1 || angle_between(dir, q->truth.n) > 1))
        || truth_support_value(a, b, last) <= q->truth.depth + tie + 2 * (q->tol + q->noise) + 1e-6 * q->size;
}

/* Runs a motion by one method; returns whether it failed. cold_pos: positions by the first method of this
 * library, a cold one, which is the reference. */
static int run(const motion_t *m, const entry_t *e, int is_reference, double cold_pos[FRAMES][3])
{
    ccd_warm_t warm = {0};
    answer_t last;
    truth_t before;
    int jumps = 0, wrong = 0;
    double pos_step = 0, pos_off = 0;
    for (int f = 0; f < FRAMES; f++) {
        shape_t a, b;
        double step2 = 0;
        place_in_frame(m, f, &a, &b);
        const double tol = e->is_libccd ? 1e-6 : tolerance(TOL_TIGHT) * pair_size(&a, &b);
        const truth_t t = truth_depth(&a, &b);
        const criteria_t q = criteria_of(&a, &b, tol, &t);
        const ccd_t ccd = counting_query(tol);
        const answer_t x = call_guarded(e, &a, &b, &ccd, e->state == STATE_NONE ? NULL : &warm, NULL, 400000);
        const int faults = e->is_libccd ? 0 : judge(e, &x, &a, &b, &q);
        if (faults && wrong++ < 3) {
            printf("FAILED %s, frame %d, ", m->name, f);
            print_faulty_answer(e, &x, faults, &t);
        }
        if (is_reference)
            memcpy(cold_pos[f], x.pos, sizeof cold_pos[f]);
        for (int i = 0; i < 3; i++) {
            step2 += f > 0 ? (x.pos[i] - last.pos[i]) * (x.pos[i] - last.pos[i]) : 0;
            pos_off = fmax(pos_off, fabs(x.pos[i] - cold_pos[f][i]));
        }
        pos_step = fmax(pos_step, sqrt(step2));
        jumps += f > 0 && !(angle_between(x.dir, last.dir) <= 1) && !may_turn(e, &a, &b, &q, &before, last.dir, x.dir);
        last = x;
        before = t;
    }
    printf("%-28s %-14s jumps %3d  pos step %.3g  off %.2g\n", m->name, e->name, jumps, pos_step, pos_off);
    const int failed = !e->is_libccd
        && ((jumps > 0 && (e->call != CALL_LOCAL || m->face)) || wrong > 0
            || (m->face && (pos_step > max_pos_speed * m->step || pos_off > pos_tolerance[m->face])));
    if (failed)
        printf("FAILED the line above\n");
    return failed;
}

int main(void)
{
    static ccd_real_t hulls[2][3 * HULL_VERTICES];
    rng_t d = rng(3000, 1);
    const shape_t plate = shape_box(1, 1, .2), wide = shape_box(2, 1, .2), block = shape_box(.2, .3, .2);
    const shape_t large = random_hull(&d, hulls[0], 1), small = random_hull(&d, hulls[1], .5);
#define X {1, 0, 0}
#define Y {0, 1, 0}
#define Z {0, 0, 1}
#define SAME(x) {x, x}
    const motion_t motions[] = {
        /* T22: on a plate larger than the motion */
        {"box slides on a plate", plate, shape_box(.2, .2, .2), .005, CORNERS, {0}, Z, {0}, 0, {-.7, .1}, {.7, .1}, SAME(.02)},
        {"cylinder slides on a plate", plate, shape_cylinder(.2, .2), .005, ROUND, {0}, Z, {0}, 0, {-.7, .1}, {.7, .1},
         SAME(.02)},
        {"box spins on a plate", plate, shape_box(.3, .2, .1), .004, CORNERS, {0}, Z, {0, pi}, 0, {.2, .1}, {.2, .1}, SAME(.01)},
        /* Over the edge of a box of the same size: the contact patch shrinks to a tenth. */
        {"box slides off a box", block, block, .0012, CORNERS, {0}, Z, SAME(.3), 0, {0, .05}, {.36, .05}, SAME(.01)},
        {"cylinder rolls on a plate", wide, shape_cylinder(.2, .3), .009, NO_FACE, {1, 0, 0, pi / 2}, Y, {0, 2 * pi}, 0, {-.6, 0},
         {-.6 + .4 * pi, 0}, SAME(.01)},
        {"capsule over an edge", plate, shape_capsule(.1, .4), .004, NO_FACE, {0}, Y, SAME(1.2), 0, {.6, .05}, {1.4, .05},
         {.055, .155}},
        /* about its lower edge, 5 degrees to either side */
        {"box rocks on its edge", plate, shape_box(.3, .2, .2), .004, NO_FACE, {0}, Y, {0, .0873}, 1, {0}, {0}, SAME(.01)},
        {"ellipsoid rolls on a plate", wide, shape_ellipsoid(.3, .25, .2), .012, NO_FACE, {0}, Y, {0, 2 * pi}, 0, {-.6, 0},
         {-.6 + .5 * pi, 0}, SAME(.005)},
        {"hull turns in a hull", large, small, .012, NO_FACE, {0}, {.3, 1, .2}, {0, 2 * pi}, 0, {.1, .05}, {.1, .05}, SAME(0)},
    };
    static const entry_t methods[] = {
#ifndef OURS_ALONE
        {"libccd MPR", 1, CALL_MPR, STATE_NONE, 0},
        {"libccd GJK", 1, CALL_GJK, STATE_NONE, 0},
#endif
        {"MPR", 0, CALL_MPR, STATE_NONE, 0},
        {"MPR, warm", 0, CALL_MPR_WARM, STATE_ZERO, 0},
        {"local, warm", 0, CALL_LOCAL, STATE_ZERO, 0},
        {"GJK", 0, CALL_GJK, STATE_NONE, 0},
        {"minimum, warm", 0, CALL_PROVEN, STATE_ZERO, 0},
        {"minimum", 0, CALL_PROVEN, STATE_NONE, 0},
    };
    static double cold_pos[FRAMES][3];
    int failed = 0;
    catch_crashes();
    for (size_t m = 0; m < sizeof motions / sizeof motions[0]; m++)
        for (size_t k = 0; k < sizeof methods / sizeof methods[0]; k++)
            failed += run(&motions[m], &methods[k], k == 0 || methods[k - 1].is_libccd, cold_pos);
    printf("%d failures\n", failed);
    return failed > 0;
}
