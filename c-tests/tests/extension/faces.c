/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Compares `pos` of prisms of 3 to 10 corners that lean on a floor with the exact center of pressure of their lower
 * face, at depths of 0.1 to 1 mm (1 to 3 mm in single precision). Checks that it is the same for the swapped pair and
 * from a warm state, and that it moves by less than 2 mm more than four times the motion, where the normal stays. And two
 * capsules that cross at a small angle, at places 1 nm apart.
 *
 *   faces [N]   300,000 / N steps */

#include "tests/contract/check.h"
#include "harness/shapes.h"
#include "harness/this_library.h"

#include <float.h>

enum { CORNERS = 10, STEPS = 300000, PATH = 20 };
static const int single = sizeof(ccd_real_t) == sizeof(float);
static const double HALF = 0.125; /* radius and half height of a prism, metres */

typedef struct { shape_t floor, prism; } scene_t;

static double distance(const double p[3], const double q[3])
{
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]));
}

static void to_world(const shape_t *s, const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = (double)s->pos[i];
        for (int j = 0; j < 3; j++)
            out[i] += (double)s->rot[3 * i + j] * v[j];
    }
}

/* Finds pos, and its plane: obj2 moves along the normal. Returns whether they overlap. */
static int position(const shape_t *a, const shape_t *b, ccd_warm_t *warm, double pos[3], double normal[3])
{
    ccd_penetration_t p;
    ccd_t ccd = shape_query();
    ccd.max_iterations = 500;
    ccd.mpr_tolerance = (ccd_real_t)(single ? 1e-5 : 1e-7);
    const int code = OURS(ccdPenetration)(a, b, &ccd, warm, CCD_WANT_POS, &p);
    for (int i = 0; i < 3; i++) {
        pos[i] = (double)p.pos.v[i];
        normal[i] = (double)p.normal.v[i];
    }
    return code == CCD_HIT;
}

/* Computes the centroid of the local depth over the lower face of k corners: linear, and cut off where it is negative.
 * `up`: the floor's normal. */
static int exact_center(const scene_t *s, int k, const double up[3], double depth, double center[3])
{
    double corner[CORNERS][3], local[CORNERS], cut[2 * CORNERS][4], lowest = HUGE_VAL, volume = 0;
    int n = 0;
    for (int i = 0; i < k; i++) {
        const ccd_real_t *v = s->prism.verts + 3 * i;
        const double at[3] = {(double)v[0], (double)v[1], (double)v[2]};
        to_world(&s->prism, at, corner[i]);
        local[i] = up[0] * corner[i][0] + up[1] * corner[i][1] + up[2] * corner[i][2];
        lowest = fmin(lowest, local[i]);
    }
    for (int i = 0; i < k; i++)
        local[i] = depth - (local[i] - lowest);
    for (int i = 0; i < k; i++) {
        const int j = (i + 1) % k;
        const double t = local[i] / (local[i] - local[j]);
        if (local[i] >= 0) {
            memcpy(cut[n], corner[i], sizeof corner[i]);
            cut[n++][3] = local[i];
        }
        if ((local[i] >= 0) != (local[j] >= 0)) {
            for (int m = 0; m < 3; m++)
                cut[n][m] = corner[i][m] + t * (corner[j][m] - corner[i][m]);
            cut[n++][3] = 0;
        }
    }
    center[0] = center[1] = center[2] = 0;
    for (int i = 1; i + 1 < n; i++) {
        const double *p[3] = {cut[0], cut[i], cut[i + 1]};
        double u[3], v[3], cross[3], sum = p[0][3] + p[1][3] + p[2][3], area;
        for (int m = 0; m < 3; m++) {
            u[m] = p[1][m] - p[0][m];
            v[m] = p[2][m] - p[0][m];
        }
        for (int m = 0; m < 3; m++)
            cross[m] = u[(m + 1) % 3] * v[(m + 2) % 3] - u[(m + 2) % 3] * v[(m + 1) % 3];
        area = fabs(cross[0] * up[0] + cross[1] * up[1] + cross[2] * up[2]);
        volume += area * sum / 3;
        for (int c = 0; c < 3; c++)
            for (int m = 0; m < 3; m++)
                center[m] += area * (sum + p[c][3]) / 12 * p[c][m];
    }
    for (int m = 0; m < 3; m++)
        center[m] /= volume;
    return volume > 0;
}

/* Makes a prism of k corners, the lower ones first; regular or with corners at random places of an ellipse. */
static shape_t make_prism(int k, int regular, ccd_real_t verts[6 * CORNERS])
{
    const double width = regular ? 1 : uniform(0.6, 1);
    for (int i = 0; i < k; i++) {
        const double angle = 8 * atan(1.0) * (i + (regular ? 0 : uniform(-0.35, 0.35))) / k;
        for (int top = 0; top < 2; top++) {
            ccd_real_t *v = verts + 3 * (i + top * k);
            v[0] = (ccd_real_t)(HALF * width * cos(angle));
            v[1] = (ccd_real_t)(HALF * sin(angle));
            v[2] = (ccd_real_t)(top ? HALF : -HALF);
        }
    }
    return shape_polytope(verts, 2 * k);
}

/* Turns a prism about z by `yaw`, leans it by `lean` towards `side`, and sets it on the floor, `depth` deep. */
static void place(scene_t *s, double yaw, double lean, double side, double depth, double x, double y)
{
    const ccd_vec3_t down = {{0, 0, -1}};
    ccd_vec3_t low;
    double turned[9], leaning[9], rot[9];
    rotation_about(0, 0, 1, yaw, turned);
    rotation_about(cos(side), sin(side), 0, lean, leaning);
    rotation_times(leaning, turned, rot);
    shape_turn(&s->prism, rot);
    shape_move(&s->prism, 0, 0, 0);
    shape_support(&s->prism, &down, &low);
    shape_move(&s->prism, x, y, -depth - (double)low.v[2]);
}

static void check_prisms(int k, int regular, long paths)
{
    double square = 0, worst = 0, jump = 0, differs = 0;
    long poses = 0;
    for (long path = 0; path < paths; path++) {
        ccd_real_t verts[6 * CORNERS];
        ccd_warm_t warm;
        scene_t s = {shape_box(1, 1, 0.5), make_prism(k, regular, verts)};
        /* Far above the tolerance of a query. */
        const double depth = exp(uniform(log(single ? 1e-3 : 1e-4), log(single ? 3e-3 : 1e-3))), lean = uniform(0, 1.2) * depth / (2 * HALF);
        const double side = uniform(-3.2, 3.2), turn = uniform(-1, 1) * 3e-3, way = uniform(-3.2, 3.2);
        double yaw = uniform(-3.2, 3.2), x = uniform(-0.3, 0.3), y = uniform(-0.3, 0.3), q[4], world[9], last[3] = {0, 0, 0}, last_normal[3] = {0, 0, 0};
        uniform_rotation(q);
        rotation_quaternion(q[0], q[1], q[2], q[3], world);
        const double up[3] = {world[2], world[5], world[8]};
        memset(&warm, 0, sizeof warm);
        shape_move(&s.floor, 0, 0, -0.5);
        const shape_t level = s.floor;
        for (int step = 0; step < PATH; step++) {
            const double slid = step ? uniform(2.5e-4, 5e-4) : 0;
            double pos[3], other[3], normal[3], other_normal[3], exact[3], off = 0;
            x += slid * cos(way);
            y += slid * sin(way);
            yaw += turn;
            s.floor = level;
            place(&s, yaw, lean, side, depth, x, y);
            shape_turn_by(&s.floor, world, 0, 0, 0);
            shape_turn_by(&s.prism, world, 0, 0, 0);
            if (!position(&s.floor, &s.prism, NULL, pos, normal) || !exact_center(&s, k, up, depth, exact)) {
                CHECK(0, "%d corners, path %ld: a hit", k, path);
                continue;
            }
            for (int i = 0; i < 3; i++)
                off += normal[i] * (exact[i] - pos[i]);
            for (int i = 0; i < 3; i++)
                exact[i] -= off * normal[i];
            square += distance(pos, exact) * distance(pos, exact);
            worst = fmax(worst, distance(pos, exact));
            poses++;
            if (step && distance(normal, last_normal) < 1e-6)
                jump = fmax(jump, distance(pos, last) - 4 * (slid + HALF * fabs(turn)));
            memcpy(last, pos, sizeof last);
            memcpy(last_normal, normal, sizeof last_normal);
            if (position(&s.prism, &s.floor, NULL, other, other_normal) && fabs(fabs(other_normal[0]) - fabs(normal[0])) < 1e-6)
                differs = fmax(differs, distance(pos, other));
            if (position(&s.floor, &s.prism, &warm, other, other_normal) && distance(normal, other_normal) < 1e-6)
                differs = fmax(differs, distance(pos, other));
        }
    }
    const double rms = sqrt(square / fmax(1, (double)poses));
    printf("%2d corners%s: %ld poses, rms %.2f mm, worst %.2f mm, jump %.2f mm, warm or swapped %.2f mm\n", k, regular ? ", regular" : "",
           poses, 1e3 * rms, 1e3 * worst, 1e3 * jump, 1e3 * differs);
    CHECK(rms < 1e-3 && worst < 2e-3, "%d corners: error", k);
    CHECK(jump < 2e-3, "%d corners: a jump", k);
    CHECK(differs < 1e-3, "%d corners: warm or swapped", k);
}

/* Turns a capsule so that its core is along a unit vector. */
static void set_axis(shape_t *s, const double z[3])
{
    double x[3] = {z[2], z[0], z[1]}, along = 0, length = 0, rot[9];
    for (int i = 0; i < 3; i++)
        along += x[i] * z[i];
    for (int i = 0; i < 3; i++) {
        x[i] -= along * z[i];
        length += x[i] * x[i];
    }
    for (int i = 0; i < 3; i++)
        x[i] /= sqrt(length);
    for (int i = 0; i < 3; i++) {
        rot[3 * i] = x[i];
        rot[3 * i + 1] = z[(i + 1) % 3] * x[(i + 2) % 3] - z[(i + 2) % 3] * x[(i + 1) % 3];
        rot[3 * i + 2] = z[i];
    }
    shape_turn(s, rot);
}

/* Two capsules that cross at a small angle, at two places 1 nm apart. One of them is symmetric about the deepest point;
 * the other ends beside it. */
static void check_capsules(void)
{
    static const double axis[2][3] = {{0.20414649713731986, -0.75448827148492326, -0.62375608686268924},
                                      {0.20596342714323812, -0.75291937287050992, -0.62505318544559862}};
    static const double at[2][3] = {{0.062278774125970875, 0.082898747941969594, 0.043269773118474256},
                                    {0.062278773428443575, 0.082898747639876383, 0.043269772468708639}};
    double pos[2][3], normal[3];
    for (int i = 0; i < 2; i++) {
        shape_t a = shape_capsule(0.043285777553567384, 0.076910544426185376);
        shape_t b = shape_capsule(0.040085627162162588, 0.10972582880013919);
        set_axis(&a, axis[0]);
        set_axis(&b, axis[1]);
        shape_move(&b, at[i][0], at[i][1], at[i][2]);
        CHECK(position(&a, &b, NULL, pos[i], normal), "capsules overlap");
    }
    printf("capsules: pos moves by %.3g mm\n", 1e3 * distance(pos[0], pos[1]));
    CHECK(distance(pos[0], pos[1]) < (single ? 1e-3 : 1e-5), "capsules jump");
}

int main(int argc, char **argv)
{
    const long paths = STEPS / (argc > 1 ? atol(argv[1]) : 1) / PATH / 16;
    uniform_seed(59);
    for (int k = 3; k <= CORNERS; k++)
        for (int regular = 0; regular < 2; regular++)
            check_prisms(k, regular, paths);
    check_capsules();
    return checks_end();
}
