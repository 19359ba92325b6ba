/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Compares `pos` with the center of pressure by integration: bodies of a quarter metre that tilt, slide,
 * tip, roll and turn on a floor, 1 mm and 0.01 mm deep, in steps so small that a discontinuity shows. And random
 * pairs at depths of 1 to 30 % of the smaller body's radius: prints the errors of `pos` and of the middle of the
 * witness points.
 *
 *   pressure [N]   one sweep and depth in N */

#include "tests/extension/pressure.h"

#include "tests/contract/check.h"
#include "harness/this_library.h"
#include "harness/truth.h"

#include <float.h>

static const int single = sizeof(ccd_real_t) == sizeof(float);
enum { STEPS = 64, COARSE = 24 };
static const double HALF = 0.125;

/* Poses of a body: turned about `axis` by `initial`, then about `sweep_axis` by the angle of the sweep. */
typedef struct {
    const char *name;
    shape_t body;
    const double *axis;
    double initial;
    const double *sweep_axis;
    double roll; /* degrees a step, of a body that rolls or turns on the spot; 0: small angles */
    double slide; /* metres along x, over the floor's edge, in place of the angle */
    double max_rms, max_step; /* metres; steps beyond twice the exact one */
    int ground;
    double lean; /* slope, in depths over the body's width */
} sweep_t;

/* The ground: a floor, or a box or disc as wide as the body, off its center. */
enum { FLOOR, BOX, DISC };

static double deg(double x) { return x * atan(1.0) / 45; }

static void rotate(const double rot[9], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = rot[3 * i] * v[0] + rot[3 * i + 1] * v[1] + rot[3 * i + 2] * v[2];
}

/* Places body and ground at an angle, `depth` deep. */
static void set_pose(const sweep_t *s, double angle, double depth, shape_t *body, shape_t *floor)
{
    const ccd_vec3_t down = {{0, 0, -1}};
    ccd_vec3_t low;
    double first[9], then[9], all[9], lean[9];
    *floor = s->ground == DISC ? shape_cylinder(0.15, 0.5) : s->ground == BOX ? shape_box(HALF, HALF, 0.5) : shape_box(1, 1, 0.5);
    shape_move(floor, s->slide != 0 ? -0.9 : 0.05, 0.03, -0.5);
    *body = s->body;
    rotation_about(s->axis[0], s->axis[1], s->axis[2], s->initial, first);
    rotation_about(s->sweep_axis[0], s->sweep_axis[1], s->sweep_axis[2], s->slide != 0 ? deg(-0.2) : angle, then);
    rotation_times(then, first, all);
    rotation_about(cos(0.35), sin(0.35), 0, s->lean * depth / (2 * HALF), lean);
    rotation_times(lean, all, then);
    shape_turn(body, then);
    shape_support(body, &down, &low);
    shape_move(body, s->slide != 0 ? angle : 0, 0, -depth - (double)low.v[2]);
}

static int query(int call, const shape_t *a, const shape_t *b, ccd_warm_t *warm, ccd_vec3_t *dir, ccd_vec3_t *pos)
{
    ccd_real_t depth;
    ccd_penetration_t p;
    const call_args_t x = {.warm = warm, .want = CCD_WANT_POS, .depth = &depth, .dir = dir, .pos = pos, .penetration = &p};
    ccd_t ccd = shape_query();
    ccd.max_iterations = 500;
    ccd.mpr_tolerance = ccd.epa_tolerance = (ccd_real_t)(single ? 1e-5 : 1e-7);
    int code = call_library(call, a, b, &ccd, &x);
    if (code >= 0 && call != CALL_MPR && call != CALL_GJK && call != CALL_MPR_WARM) {
        *dir = p.dir;
        *pos = p.pos;
    }
    return code;
}

/* Finds a point in both: the lowest corner may be beside the ground. */
static void common_point(const shape_t *body, const shape_t *floor, double place[3])
{
    ccd_penetration_t p;
    ccd_t ccd = shape_query();
    CHECK(OURS(ccdPenetration)(body, floor, &ccd, NULL, CCD_WANT_POINTS, &p) == CCD_HIT, "a hit");
    for (int i = 0; i < 3; i++)
        place[i] = ((double)p.point1.v[i] + (double)p.point2.v[i]) / 2;
}

typedef struct { double square, worst, step; int poses; } errors_t;

static double distance(const double p[3], const double q[3])
{
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]));
}

static const int CALLS[] = {CALL_MPR, CALL_MPR_WARM, CALL_GJK, CALL_PENETRATION, CALL_LOCAL, CALL_INCREMENTAL, CALL_PROVEN};
enum { CALL_COUNT = sizeof CALLS / sizeof *CALLS };

/* Returns the k-th angle, small ones first, or slide; -1 after the last of a roll or slide. */
static double angle_at(const sweep_t *s, double depth, int k)
{
    const double width = 2 * HALF, step = depth / (8 * width);
    if (s->slide != 0)
        return k < STEPS ? s->slide * k / STEPS : -1;
    if (s->roll > 0)
        return k < STEPS ? deg(s->roll * k) : -1;
    if (k < STEPS)
        return (k - STEPS / 2 + 0.5) * step;
    return deg(0.05 * (k - STEPS) * (k - STEPS) + 0.05);
}

/* Pose of a sweep and its exact center of pressure. */
typedef struct {
    shape_t body, floor;
    double truth[3];
    int overlap;
} pose_t;
static pose_t poses[STEPS + COARSE];
static int pose_count;

static void set_poses(const sweep_t *s, double depth)
{
    const double up[3] = {0, 0, 1};
    const ccd_vec3_t down = {{0, 0, -1}};
    for (pose_count = 0; pose_count < STEPS + COARSE; pose_count++) {
        const double angle = angle_at(s, depth, pose_count);
        pose_t *p = &poses[pose_count];
        double place[3];
        ccd_vec3_t low;
        if (angle < 0 && (s->slide != 0 || s->roll > 0))
            break;
        set_pose(s, angle, depth, &p->body, &p->floor);
        shape_support(&p->body, &down, &low);
        for (int i = 0; i < 3; i++)
            place[i] = (double)low.v[i];
        if (s->slide != 0) /* the lowest point may be beyond the edge */
            place[0] = fmin(place[0], 0.1 - 1e-9);
        if (s->ground != FLOOR)
            common_point(&p->body, &p->floor, place);
        p->overlap = center_of_pressure(&p->body, &p->floor, up, place, p->truth) > 0;
    }
}

static errors_t sweep(const sweep_t *s, double depth, int call, const double world[9])
{
    double last[3] = {0, 0, 0}, last_truth[3] = {0, 0, 0};
    errors_t e;
    ccd_warm_t warm;
    memset(&warm, 0, sizeof warm);
    memset(&e, 0, sizeof e);
    for (int k = 0; k < pose_count; k++) {
        shape_t a = k % 2 ? poses[k].body : poses[k].floor, b = k % 2 ? poses[k].floor : poses[k].body;
        double p[3], t[3], along = 0, off;
        ccd_vec3_t dir, pos;
        if (!poses[k].overlap)
            continue;
        shape_turn_by(&a, world, 0, 0, 0);
        shape_turn_by(&b, world, 0, 0, 0);
        int code = query(call, &a, &b, call == CALL_MPR_WARM && k % 2 == 0 ? &warm : NULL, &dir, &pos);
        if (code != 0 && code != CCD_LIMIT) {
            CHECK(0, "%s, pose %d: code %d", s->name, k, code);
            continue;
        }
        rotate(world, poses[k].truth, t);
        for (int i = 0; i < 3; i++)
            along += (double)dir.v[i] * ((double)pos.v[i] - t[i]);
        for (int i = 0; i < 3; i++)
            p[i] = (double)pos.v[i] - along * (double)dir.v[i]; /* across dir */
        CHECK(fabs(along) <= 1.5 * depth, "%s, pose %d: %g along dir", s->name, k, along);
        off = distance(p, t);
        e.square += off * off;
        e.worst = fmax(e.worst, off);
        e.poses++;
        if (k > 0 && k < STEPS) {
            e.step = fmax(e.step, distance(p, last) - 2 * distance(t, last_truth));
        }
        memcpy(last, p, sizeof last);
        memcpy(last_truth, t, sizeof last_truth);
    }
    return e;
}

/* Kinds of random pairs, and the largest error of pos, in % of the radius (root mean square). */
static const struct {
    const char *name;
    int first, last;     /* shapes, -1: flat boxes */
    double max_error[4]; /* by RANGE */
} KINDS[] = {{"boxes", SHAPE_BOX, SHAPE_BOX, {2, 3, 8, 22}},
             {"plates", -1, -1, {2, 3, 8, 25}},
             {"round", SHAPE_CAPSULE, SHAPE_ELLIPSOID, {3, 5, 8, 18}}};
static const double RANGE[] = {0.01, 0.03, 0.1, 0.3};

static shape_t random_body(int kind)
{
    const double x = uniform(0.1, 0.5), y = uniform(0.1, 0.5), z = uniform(0.1, 0.5);
    double q[4], rot[9];
    shape_t s = kind < 0 ? shape_box(x, y, 0.1 * z) : shape_make(kind, kind == SHAPE_CAPSULE ? 0.5 * x : x, y, z);
    uniform_rotation(q);
    rotation_quaternion(q[0], q[1], q[2], q[3], rot);
    shape_turn(&s, rot);
    return s;
}

/* Computes the errors of pos [0] and of the middle of the witness points [1] at a depth, root mean square. */
static void range_errors(unsigned kind, double share, double error[2])
{
    double square[2] = {0, 0};
    int n = 0;
    uniform_seed(9);
    for (int k = 0; k < 400; k++) {
        const int kinds = KINDS[kind].last - KINDS[kind].first + 1;
        shape_t a = random_body(KINDS[kind].first + k % kinds), b = random_body(KINDS[kind].first + k / kinds % kinds);
        ccd_penetration_t p;
        double normal[3], middle[3], pos[3], truth[3], reach, move;
        const double x = uniform(-0.3, 0.3), y = uniform(-0.3, 0.3), z = uniform(-0.3, 0.3);
        shape_move(&b, x, y, z);
        ccd_t ccd = shape_query();
        ccd.max_iterations = 500;
        ccd.mpr_tolerance = (ccd_real_t)(single ? 1e-5 : 1e-8);
        if (OURS(ccdPenetration)(&a, &b, &ccd, NULL, 0, &p) != CCD_HIT)
            continue;
        reach = fmin(shape_reach(&a), shape_reach(&b));
        move = (double)p.depth - share * reach;
        if (move < 0)
            continue;
        shape_move(&b, x + move * (double)p.dir.v[0], y + move * (double)p.dir.v[1], z + move * (double)p.dir.v[2]);
        if (OURS(ccdPenetration)(&a, &b, &ccd, NULL, CCD_WANT_POS | CCD_WANT_POINTS, &p) != CCD_HIT)
            continue;
        for (int i = 0; i < 3; i++) {
            normal[i] = (double)p.normal.v[i];
            middle[i] = 0.5 * ((double)p.point1.v[i] + (double)p.point2.v[i]);
            pos[i] = (double)p.pos.v[i];
        }
        if (!(center_of_pressure(&a, &b, normal, middle, truth) > 0))
            continue;
        for (int i = 0; i < 2; i++) {
            double *at = i == 0 ? pos : middle, along = 0;
            for (int j = 0; j < 3; j++)
                along += normal[j] * (at[j] - truth[j]);
            for (int j = 0; j < 3; j++)
                at[j] -= along * normal[j];
            square[i] += pow(distance(at, truth) / reach, 2);
        }
        n++;
    }
    error[0] = 100 * sqrt(square[0] / n);
    error[1] = 100 * sqrt(square[1] / n);
}

static unsigned every = 1;

static void random_pairs(void)
{
    for (unsigned k = 0; k < sizeof KINDS / sizeof *KINDS; k++)
        for (unsigned i = 0; i < sizeof RANGE / sizeof *RANGE; i += every) {
            double error[2];
            range_errors(k, RANGE[i], error);
            printf("%s, depth %g %% of the radius: pos %.2f %%, middle of the witness points %.2f %%\n", KINDS[k].name,
                   100 * RANGE[i], error[0], error[1]);
            CHECK(error[0] <= KINDS[k].max_error[i] && error[0] < error[1],
                  "%s, depth %g of the radius", KINDS[k].name, RANGE[i]);
        }
}

int main(int argc, char **argv)
{
    const double q = deg(90);
    static const double corner[3] = {1, -1, 0}, X[3] = {1, 0, 0}, Y[3] = {0, 1, 0}, Z[3] = {0, 0, 1}, XY[3] = {1, 0.6, 0};
/* max_rms, max_step */
#define FLAT 3e-3, 1e-3
#define ROUND 7e-3, 5e-3
/* Its radius falls along the line that it lies on, and so does the correction for it: where the
 * deepest point jumps along the line, pos follows in part. */
#define TAPERED 15e-3, 50e-3
    const shape_t box = shape_box(HALF, HALF, HALF), brick = shape_box(HALF, 0.08, 0.06);
    const shape_t can = shape_cylinder(0.09, HALF), rod = shape_capsule(0.05, HALF), hat = shape_cone(HALF, HALF);
    const shape_t egg = shape_ellipsoid(0.1, 0.07, HALF), ball = shape_sphere(HALF);
    const sweep_t all[] = {
        {"box", box, Z, 0, Y, 0, 0, FLAT, FLOOR, 0},
        {"box yawed", box, Z, 0.3, Y, 0, 0, FLAT, FLOOR, 0},
        {"brick, two axes", brick, Z, 0.1, XY, 0, 0, FLAT, FLOOR, 0},
        {"box over the edge", box, Z, 0, Y, 0, 0.2, FLAT, FLOOR, 0},
        {"yawed box over the edge", box, Z, 0.5, Y, 0, 0.2, FLAT, FLOOR, 0},
        {"brick on an edge", brick, X, deg(40), Y, 0, 0, FLAT, FLOOR, 0},
        {"box on a corner", box, corner, 0.9, Y, 1, 0, FLAT, FLOOR, 0},
        {"cylinder standing", can, Z, 0, Y, 0, 0, ROUND, FLOOR, 0},
        {"cylinder lying", can, X, q, X, 0, 0, ROUND, FLOOR, 0},
        {"cylinder rolling", can, X, q, Y, 1, 0, ROUND, FLOOR, 0},
        {"capsule lying", rod, X, q, X, 0, 0, ROUND, FLOOR, 0},
        {"cone on its base", hat, Z, 0, Y, 0, 0, ROUND, FLOOR, 0},
        {"cone on its side", hat, X, q + atan(0.5), X, 0, 0, TAPERED, FLOOR, 0},
        {"ellipsoid", egg, X, 0.7, Y, 1, 0, ROUND, FLOOR, 0},
        {"sphere", ball, X, 0.7, Y, 1, 0, ROUND, FLOOR, 0},
        {"box turning", box, Z, 0, Z, 1.43, 0, FLAT, FLOOR, 0.4},
        {"box turning, leaning more", box, Z, 0, Z, 1.43, 0, FLAT, FLOOR, 0.9},
        {"box turning on a box", box, Z, 0, Z, 1.43, 0, FLAT, BOX, 0.4},
        {"brick turning on a box", brick, Z, 0, Z, 1.43, 0, FLAT, BOX, 0.9},
        {"box turning on a disc", box, Z, 0, Z, 1.43, 0, ROUND, DISC, 0.4},
        {"box turning on a disc, leaning more", box, Z, 0, Z, 1.43, 0, ROUND, DISC, 0.9},
        {"can turning on a box", can, Z, 0, Z, 1.43, 0, ROUND, BOX, 0.4},
    };
    double world[2][9];
    unsigned i;
    rotation_about(0, 0, 1, 0, world[0]);
    rotation_quaternion(0.3, -0.5, 0.7, 0.2, world[1]);
    every = argc > 1 ? (unsigned)atoi(argv[1]) : every;
    random_pairs();
    for (i = 0; i < sizeof all / sizeof *all; i += every) {
        for (int d = 0; d < (single ? 1 : 2); d++) {
            const double depth = d ? 1e-5 : 1e-3;
            const char *name = all[i].name;
            set_poses(&all[i], depth);
            for (int w = 0; w < 2; w++)
                for (int c = 0; c < CALL_COUNT; c++) {
                    const errors_t e = sweep(&all[i], depth, CALLS[c], world[w]);
                    const double rms = sqrt(e.square / e.poses);
                    if (c == 0)
                        printf("%-35s %g m deep, world %d: rms %6.3f mm, worst %7.3f, step beyond twice the exact one %7.3f\n",
                               name, depth, w, 1e3 * rms, 1e3 * e.worst, 1e3 * e.step);
                    CHECK(rms <= all[i].max_rms, "%s, %g deep, call %d: rms %.3g mm", name, depth, CALLS[c], 1e3 * rms);
                    CHECK(e.step <= all[i].max_step, "%s, %g deep, call %d: step %.3g mm", name, depth, CALLS[c], 1e3 * e.step);
                }
        }
    }
    return checks_end();
}
