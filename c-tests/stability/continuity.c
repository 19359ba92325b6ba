/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Contacts in motion: sliding, rolling, rocking, hundreds of frames each. From frame
 * to frame the direction turns by more than a degree only where the true minimum does,
 * the depth steps as the truth steps, and the contact position of a resting face moves
 * no faster than the bodies allow. Each motion is run cold, and warm with one state
 * carried along; both find the same depth, and the same place for a resting face.
 * Prints, per motion and method, jumps and largest steps. */

#include "categories.h"

enum { FRAMES = 300 };

typedef struct {
    const char *name;
    void (*pose)(int frame, shape_t *a, shape_t *b);
    double step;     /* how far a point of either body moves in a frame, at most */
    int face;        /* a resting face contact: pos must not run away, and is the same for every
                      * method, warm or cold */
} motion_t;

/* T22: over a plate that is larger than the way */
static void box_slides(int f, shape_t *a, shape_t *b)
{
    *a = shape_box(1, 1, .2);
    *b = shape_box(.2, .2, .2);
    shape_move(b, -.7 + 1.4 * f / FRAMES, .1, .38);
}

static void cylinder_slides(int f, shape_t *a, shape_t *b)
{
    *a = shape_box(1, 1, .2);
    *b = shape_cylinder(.2, .2);
    shape_move(b, -.7 + 1.4 * f / FRAMES, .1, .38);
}

static void box_spins(int f, shape_t *a, shape_t *b)
{
    double r[9];
    *a = shape_box(1, 1, .2);
    *b = shape_box(.3, .2, .1);
    rotation_about(0, 0, 1, 3.14159265358979 * f / FRAMES, r);
    shape_turn(b, r);
    shape_move(b, .2, .1, .29);
}

/* Over the edge of one of the same size: what touches shrinks to a tenth. */
static void box_overhangs(int f, shape_t *a, shape_t *b)
{
    double r[9];
    *a = shape_box(.2, .3, .2);
    *b = shape_box(.2, .3, .2);
    rotation_about(0, 0, 1, .3, r);
    shape_turn(b, r);
    shape_move(b, .36 * f / FRAMES, .05, .39);
}

static void cylinder_rolls(int f, shape_t *a, shape_t *b)
{
    static const double lying[9] = {1, 0, 0, 0, 0, -1, 0, 1, 0};
    double angle = 2 * 3.14159265358979 * f / FRAMES, r[9], rot[9];
    *a = shape_box(2, 1, .2);
    *b = shape_cylinder(.2, .3);
    rotation_about(0, 1, 0, angle, r);
    rotation_times(r, lying, rot);
    shape_turn(b, rot);
    shape_move(b, -.6 + .2 * angle, 0, .2 + .2 - .01);
}

static void capsule_over_edge(int f, shape_t *a, shape_t *b)
{
    double r[9];
    *a = shape_box(1, 1, .2);
    *b = shape_capsule(.1, .4);
    rotation_about(0, 1, 0, 1.2, r);
    shape_turn(b, r);
    shape_move(b, .6 + .8 * f / FRAMES, .05, .39 - .1 * f / FRAMES);
}

static void box_rocks(int f, shape_t *a, shape_t *b)
{
    /* about its lower edge, 5 degrees to either side, the lowest point 1 cm deep */
    double angle = .0873 * sin(4 * 3.14159265358979 * f / FRAMES), r[9];
    *a = shape_box(1, 1, .2);
    *b = shape_box(.3, .2, .2);
    rotation_about(0, 1, 0, angle, r);
    shape_turn(b, r);
    shape_move(b, 0, 0, .2 + .3 * fabs(sin(angle)) + .2 * cos(angle) - .01);
}

static void ellipsoid_rolls(int f, shape_t *a, shape_t *b)
{
    double angle = 2 * 3.14159265358979 * f / FRAMES, r[9];
    double height = sqrt(.3 * .3 * sin(angle) * sin(angle) + .2 * .2 * cos(angle) * cos(angle));
    *a = shape_box(2, 1, .2);
    *b = shape_ellipsoid(.3, .25, .2);
    rotation_about(0, 1, 0, angle, r);
    shape_turn(b, r);
    shape_move(b, -.6 + .25 * angle, 0, .2 + height - .005);
}

static ccd_real_t hulls[2][3 * PAIR_VERTICES];

static void hull_on_hull(int f, shape_t *a, shape_t *b)
{
    dice_t d = dice(3000, 1);
    double r[9];
    *a = pair_hull(&d, hulls[0], 1);
    *b = pair_hull(&d, hulls[1], .5);
    rotation_about(.3, 1, .2, 2 * 3.14159265358979 * f / FRAMES, r);
    shape_turn(b, r);
    shape_move(b, .1, .05, .55);
}

/* Corners are the same points whoever asks; the points of a round face that stand for it
 * are not, where the normals differ within the tolerance. Metres. */
enum { NO_FACE, CORNERS, ROUND };
static const double same_place[] = {HUGE_VAL, sizeof(ccd_real_t) == 8 ? 1e-9 : 1e-3, 5e-3};

static const motion_t motions[] = {
    {"box slides on a plate", box_slides, .005, CORNERS},
    {"cylinder slides on a plate", cylinder_slides, .005, ROUND},
    {"box spins on a plate", box_spins, .004, CORNERS},
    {"box slides off a box", box_overhangs, .0012, CORNERS},
    {"cylinder rolls on a plate", cylinder_rolls, .009, NO_FACE},
    {"capsule over an edge", capsule_over_edge, .004, NO_FACE},
    {"box rocks on its edge", box_rocks, .004, NO_FACE},
    {"ellipsoid rolls on a plate", ellipsoid_rolls, .012, NO_FACE},
    {"hull turns in a hull", hull_on_hull, .012, NO_FACE},
};
enum { MOTIONS = sizeof motions / sizeof motions[0] };

/* A resting contact's position may move so much faster than the bodies: where the
 * touching region loses a corner at one end, its middle moves at half that speed, and
 * a witness that is one of its corners not at all or all the way. */
static const double pos_speed = 2;

static double angle_between(const double a[3], const double b[3])
{
    double c[3];
    truth_cross3(a, b, c);
    return atan2(sqrt(truth_dot3(c, c)), truth_dot3(a, b)) * 57.29577951308232;
}

int main(void)
{
    static const entry_t methods[] = {
#ifndef OURS_ALONE
        {"libccd MPR", 1, ASK_MPR, STATE_NONE},
        {"libccd GJK", 1, ASK_GJK, STATE_NONE},
#endif
        {"MPR", 0, ASK_MPR, STATE_NONE},
        {"MPR, warm", 0, ASK_MPR_WARM, STATE_ZERO},
        {"local, warm", 0, ASK_LOCAL, STATE_ZERO},
        {"GJK", 0, ASK_GJK, STATE_NONE},
        {"minimum", 0, ASK_PROVEN, STATE_NONE},
        {"minimum, warm", 0, ASK_PROVEN, STATE_ZERO},
    };
    /* where the first method, a cold one, has the contact in each frame */
    static double place[FRAMES][3];
    int m, k, f, i, failed = 0;
    judge_begin();
    for (m = 0; m < MOTIONS; m++)
        for (k = 0; k < (int)(sizeof methods / sizeof methods[0]); k++) {
            const entry_t *e = &methods[k];
            ccd_warm_t warm;
            answer_t last;
            truth_t before;
            int jumps = 0, needed = 0, wrong = 0;
            double depth_step = 0, pos_step = 0, pos_off = 0, error = 0;
            unsigned long calls = 0;
            memset(&warm, 0, sizeof warm);
            memset(&last, 0, sizeof last);
            memset(&before, 0, sizeof before);
            for (f = 0; f < FRAMES; f++) {
                shape_t a, b;
                ccd_t ccd;
                ccd_vec3_t unused;
                answer_t x;
                truth_t t;
                question_t q;
                double tol;
                motions[m].pose(f, &a, &b);
                tol = e->system ? 1e-6 : tolerance(TOL_TIGHT) * pair_size(&a, &b);
                t = truth_depth(&a, &b);
                q = question(&a, &b, tol, &t);
                memset(&unused, 0, sizeof unused);
                ccd = judge_query(tol);
                x = ask_guarded(e, &a, &b, &ccd, &warm, &unused, 400000);
                calls += x.calls;
                if (!e->system) {
                    int faults = judge(e, &x, &a, &b, &q);
                    /* the bare local method may be in another valley, and leave it */
                    faults &= FAULTS_NEVER;
                    if (faults && wrong++ < 3) {
                        printf("FAILED %s, frame %d, ", motions[m].name, f);
                        print_wrong(e, &x, faults, &t);
                    }
                }
                error = fmax(error, fabs(x.depth - t.depth));
                if (f > 0) {
                    double step = 0, turn = angle_between(x.dir, last.dir);
                    /* the truth turns, or the old direction ties with the new one: as far as
                     * the method tells minima apart */
                    int mpr = entry_is_mpr(e);
                    double tie = mpr ? tolerance(TOL_PROMISED) * t.depth : 0;
                    /* nor can MPR keep a near tie that is none any more */
                    int true_turn = angle_between(t.n, before.n) > 1
                        || (mpr && (angle_between(last.dir, before.n) > 1 || angle_between(x.dir, t.n) > 1))
                        || truth_value(&a, &b, last.dir) <= t.depth + tie + 2 * (tol + q.noise) + 1e-6 * q.size;
                    if (!(turn <= 1)) {
                        needed += true_turn;
                        jumps += !true_turn;
                    }
                    depth_step = fmax(depth_step, fabs((x.depth - last.depth) - (t.depth - before.depth)));
                    for (i = 0; i < 3; i++)
                        step += (x.pos[i] - last.pos[i]) * (x.pos[i] - last.pos[i]);
                    pos_step = fmax(pos_step, sqrt(step));
                }
                if (k == 0 || methods[k - 1].system)
                    memcpy(place[f], x.pos, sizeof place[f]);
                for (i = 0; i < 3; i++)
                    pos_off = fmax(pos_off, fabs(x.pos[i] - place[f][i]));
                last = x;
                before = t;
            }
            printf("%-28s %-14s jumps %3d (with the truth %d)  depth off the truth's step %.2g  pos step %.3g  error %.2g  calls %.1f\n",
                   motions[m].name, e->name, jumps, needed, depth_step, pos_step, error, (double)calls / FRAMES);
            if (!e->system
                && ((jumps > 0 && (e->ask != ASK_LOCAL || motions[m].face)) || wrong > 0
                    || (motions[m].face && (pos_step > pos_speed * motions[m].step || pos_off > same_place[motions[m].face])))) {
                printf("FAILED the line above\n");
                failed++;
            }
        }
    printf("%d failures\n", failed);
    return failed > 0;
}
