/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks `pos`, the center of pressure:
 *
 *   pos near [N]      It is half the depth and a tolerance from both objects at most: random pairs of slender hulls, boxes,
 *                     cylinders, cones, capsules and ellipsoids, of all depths. One hit in N of two million.
 *   pos faces [N]     Prisms of 3 to 10 corners lean on a floor, 0.1 to 1 mm deep (1 to 3 mm in single precision): it is that of
 *                     the lower face by formula, the same for the swapped pair and from a warm state, and moves by less than
 *                     2 mm more than four times the motion, where the normal stays. 300,000 / N steps. And two capsules.
 *   pos jumps N SEED  Bodies of a quarter metre at rest on others move along the contact, N steps: how often pos jumps, where the
 *                     exact one does not, and how far those of a cold query, a warm one and the swapped pair are apart.
 *   pos pressure [N]  It is that by integration: bodies of a quarter metre that tilt, slide, tip, roll and turn on a floor, 1 mm
 *                     and 0.01 mm deep, in steps so small that a discontinuity shows; random pairs at depths of 1 to 30 % of the
 *                     smaller body's radius. One sweep and depth in N. */

#include "tests/extension/pressure.h"

#include "tests/contract/check.h"
#include "harness/this_library.h"

#include <float.h>

static const int single = sizeof(ccd_real_t) == sizeof(float);
static const double HALF = 0.125; /* radius and half height of a prism, half a box, metres */
static const double pi = 3.14159265358979323846, up[3] = {0, 0, 1};

static ccd_t settings(double tolerance)
{
    ccd_t ccd = shape_query();
    ccd.max_iterations = 500;
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = (ccd_real_t)(single ? 1e-5 : tolerance);
    return ccd;
}

/* Returns whether the shapes overlap, and their penetration. */
static int overlap(const shape_t *a, const shape_t *b, ccd_warm_t *warm, double tolerance, unsigned want, ccd_penetration_t *out)
{
    const ccd_t ccd = settings(tolerance);
    return OURS(ccdPenetration)(a, b, &ccd, warm, want, out) == CCD_HIT;
}

static void copy(const ccd_vec3_t *v, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (double)v->v[i];
}

static double distance(const double p[3], const double q[3])
{
    const double d[3] = {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
    return sqrt(truth_dot3(d, d));
}

/* Projects p along the unit vector n onto the plane of q across it; returns by how far. */
static double project(const double n[3], double p[3], const double q[3])
{
    const double along = truth_dot3(n, p) - truth_dot3(n, q);
    for (int i = 0; i < 3; i++)
        p[i] -= along * n[i];
    return along;
}

static void turn_randomly(shape_t *s)
{
    double q[4], rot[9];
    uniform_rotation(q);
    rotation_quaternion(q[0], q[1], q[2], q[3], rot);
    shape_turn(s, rot);
}

/* Returns the lowest point. */
static ccd_vec3_t lowest(const shape_t *s)
{
    const ccd_vec3_t down = {{0, 0, -1}};
    ccd_vec3_t low;
    shape_support(s, &down, &low);
    return low;
}

/* Turns a body by both rotations, the inner one first, and sets it on the floor z = 0, `depth` deep. */
static void set_on_floor(shape_t *s, const double outer[9], const double inner[9], double depth, double x, double y)
{
    double rot[9];
    rotation_times(outer, inner, rot);
    shape_turn(s, rot);
    shape_move(s, 0, 0, 0);
    shape_move(s, x, y, -depth - (double)lowest(s).v[2]);
}

typedef struct { double square, worst, step; int poses; } errors_t;

/* --- jumps ------------------------------------------------------------------------------------ */

enum { PATH = 20, CORNERS = 10 };

/* Bodies: prisms by their number of corners, and others. */
enum { BODY_BOX, BODY_HULL, BODY_CYLINDER, BODY_PRISM, BODY_CAPSULE = BODY_PRISM + CORNERS - 2, BODY_CONE, BODIES };
static const char *const body_name[BODIES] = {"box", "hull", "cylinder", "3 corners", "4 corners", "5 corners", "6 corners", "7 corners",
                                              "8 corners", "9 corners", "10 corners", "capsule", "cone"};

/* Makes a body of a quarter metre: of a prism every other one regular, else with corners at random places of an ellipse. */
static shape_t make_body(int kind, int regular, ccd_real_t verts[6 * CORNERS])
{
    const double width = regular ? 1 : uniform(0.6, 1);
    switch (kind) {
    case BODY_BOX: return shape_box(HALF, HALF * width, HALF * (regular ? 1 : uniform(0.4, 1)));
    case BODY_CYLINDER: return shape_cylinder(HALF * width, HALF);
    case BODY_CAPSULE: return shape_capsule(HALF * 0.5 * width, HALF);
    case BODY_CONE: return shape_cone(HALF * width, HALF);
    }
    for (int i = 0; kind == BODY_HULL && i < 6 * CORNERS; i++)
        verts[i] = (ccd_real_t)uniform(-HALF, HALF);
    for (int i = 0; i < kind; i++) {
        const double angle = 2 * pi * (i + (regular ? 0 : uniform(-0.35, 0.35))) / kind;
        for (int top = 0; top < 2; top++) {
            ccd_real_t *v = verts + 3 * (i + top * kind);
            v[0] = (ccd_real_t)(HALF * width * cos(angle));
            v[1] = (ccd_real_t)(HALF * sin(angle));
            v[2] = (ccd_real_t)(top ? HALF : -HALF);
        }
    }
    return shape_polytope(verts, kind == BODY_HULL ? CORNERS : 2 * kind);
}

/* Turns a body onto its end; or, unless it `stands`, one in three each, onto any face or side, or any way. Then leans it. */
static void lay(shape_t *s, int stands, double lean)
{
    static const double down[3] = {0, 0, -1};
    const int way = stands ? 0 : random_below(3);
    const double side = uniform(-pi, pi);
    double n[3] = {0, 0, -1}, axis[3], rot[9];
    faces_t faces;
    if (way == 1 && s->type == SHAPE_POLYTOPE) {
        polytope_faces(s, &faces);
        memcpy(n, faces.n[random_below(faces.count)], sizeof n);
    } else if (way == 1) {
        n[0] = 1;
        n[2] = s->type == SHAPE_CONE ? (double)(s->p[0] / s->p[1]) / 2 : 0;
    }
    truth_cross3(n, down, axis);
    rotation_about(axis[0], axis[1], axis[2], atan2(sqrt(truth_dot3(axis, axis)), -n[2]), rot);
    shape_turn(s, rot);
    if (way == 2)
        turn_randomly(s);
    rotation_about(0, 0, 1, uniform(-pi, pi), rot);
    shape_turn_by(s, rot, 0, 0, 0);
    rotation_about(cos(side), sin(side), 0, lean, rot);
    shape_turn_by(s, rot, 0, 0, 0);
}

/* Bodies at rest on others. */
static const struct {
    const char *name;
    int stand, floor; /* on their ends; on a floor (1), a body (0) or either (-1) */
    double depth[2];
    double most; /* jumps in 1000 steps, without cones */
} settings_of[] = {{"stands on a floor", 1, 1, {1e-5, 1e-3}, 0.1},
                   {"stands on a body", 1, 0, {1e-5, 1e-3}, 0.2},
                   {"any way on either", 0, -1, {1e-5, 1e-3}, 0.5},
                   {"any way, deeper", 0, -1, {1e-3, 5e-2}, 3}};

/* Ways to find pos at a pose, and what was seen on one of them. */
enum { COLD, WARM, SWAPPED, WAYS };
typedef struct {
    long steps, jumps, wide, poses, apart; /* wide: by more than 10 mm; apart: 5 mm or more from that of a cold query */
    double worst, differs;
} way_t;

typedef struct {
    int hit;
    double pos[3], normal[3];
} found_t;

static found_t find(const shape_t *a, const shape_t *b, int way, ccd_warm_t *warm)
{
    ccd_penetration_t p;
    found_t f;
    f.hit = way == SWAPPED ? overlap(b, a, NULL, 1e-7, CCD_WANT_POS, &p) : overlap(a, b, way == WARM ? warm : NULL, 1e-7, CCD_WANT_POS, &p);
    copy(&p.pos, f.pos);
    copy(&p.normal, f.normal);
    for (int i = 0; i < 3 && way == SWAPPED; i++)
        f.normal[i] = -f.normal[i];
    return f;
}

/* Computes the exact center of pressure of a hit, in the plane of its pos. Returns 0 where there is none. */
static int exact_position(const shape_t *a, const shape_t *b, double exact[3], const found_t *f)
{
    ccd_penetration_t p;
    double middle[3];
    overlap(a, b, NULL, 1e-7, CCD_WANT_POINTS, &p);
    for (int i = 0; i < 3; i++)
        middle[i] = ((double)p.point1.v[i] + (double)p.point2.v[i]) / 2;
    if (!(center_of_pressure(a, b, f->normal, middle, exact) > 0))
        return 0;
    project(f->normal, exact, f->pos);
    return 1;
}

/* Moves b along its contact with a, and across it by up to a tenth of the depth. */
static void check_path(const shape_t *a, shape_t b, double depth, way_t seen[WAYS], errors_t *error)
{
    found_t last[WAYS] = {{0}};
    shape_t last_b = b;
    ccd_warm_t warm;
    double along[3], rot[9], away[3] = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    const double turn = random_below(2) ? 0 : uniform(-1, 1) * 1e-3;
    memset(&warm, 0, sizeof warm);
    for (int step = 0; step < PATH; step++) {
        const double by = uniform(2.5e-4, 5e-4), sinks = uniform(-0.1, 0.1) * depth, moved = fabs(by) + fabs(sinks) + 2 * HALF * fabs(turn);
        if (step) {
            const double *n = last[COLD].normal;
            const double x = (double)b.pos[0], y = (double)b.pos[1], z = (double)b.pos[2];
            truth_cross3(n, away, along);
            const double length = sqrt(truth_dot3(along, along));
            rotation_about(n[0], n[1], n[2], turn, rot);
            shape_move(&b, 0, 0, 0);
            shape_turn_by(&b, rot, x, y, z);
            shape_shift(&b, by / length, along);
            shape_shift(&b, sinks, n);
        }
        for (int way = 0; way < WAYS; way++) {
            way_t *w = &seen[way];
            found_t now = find(a, &b, way, &warm), cold = way ? last[COLD] : now;
            if (!now.hit)
                return;
            if (step && distance(now.normal, last[way].normal) < 1e-6) {
                double exact[2][3], beyond = distance(now.pos, last[way].pos);
                w->steps++;
                if (beyond > 2e-3 + 4 * moved && exact_position(a, &b, exact[0], &now) && exact_position(a, &last_b, exact[1], &last[way])) {
                    for (int i = 0; i < 3; i++)
                        exact[0][i] = now.pos[i] - exact[0][i] - (last[way].pos[i] - exact[1][i]);
                    beyond = sqrt(truth_dot3(exact[0], exact[0]));
                }
                if (beyond > 2e-3 + 4 * moved) {
                    w->jumps++;
                    w->wide += beyond > 1e-2;
                    w->worst = fmax(w->worst, beyond);
                }
            }
            if (distance(now.normal, cold.normal) < 1e-6) {
                w->poses++;
                w->apart += distance(now.pos, cold.pos) > 5e-3;
                w->differs = fmax(w->differs, distance(now.pos, cold.pos));
            }
            last[way] = now;
        }
        if (step == PATH / 2) {
            double exact[3];
            if (exact_position(a, &b, exact, &last[COLD])) {
                const double off = distance(exact, last[COLD].pos);
                error->square += off * off;
                error->worst = fmax(error->worst, off);
                error->poses++;
            }
        }
        last_b = b;
    }
}

static void check_jumps(int steps, int seed)
{
    const int settings_count = sizeof settings_of / sizeof *settings_of, paths = 1 + (steps - 1) / (PATH * BODIES * settings_count);
    const double least = single ? 1e-3 : 0; /* depth, far above the tolerance of a query */
    long steps_of[4] = {0}, jumps_of[4] = {0};
    uniform_seed((uint64_t)seed);
    printf("%-10s %-18s %7s %21s %21s %21s %15s %15s %15s\n", "", "", "steps", "cold: > 2, 10, worst mm", "warm", "swapped", "warm differs", "swapped differs", "rms, worst mm");
    for (int k = 0; k < BODIES; k++)
        for (int m = 0; m < settings_count; m++) {
            way_t seen[WAYS] = {{0}};
            errors_t error = {0, 0, 0, 0};
            for (int path = 0, trial = 0; path < paths && trial < 50 * paths; trial++) {
                ccd_real_t verts[2][6 * CORNERS];
                const int on_floor = settings_of[m].floor < 0 ? random_below(2) : settings_of[m].floor;
                const double depth = exp(uniform(log(fmax(settings_of[m].depth[0], least)), log(fmax(settings_of[m].depth[1], 3 * least))));
                double world[9], flip[9], n[3];
                ccd_penetration_t p;
                shape_t a = on_floor ? shape_box(1, 1, 0.5) : make_body(random_below(BODIES), random_below(2), verts[0]);
                shape_t b = make_body(k, random_below(2), verts[1]);
                lay(&a, 1, 0);
                if (!on_floor)
                    lay(&a, settings_of[m].stand, 0);
                lay(&b, settings_of[m].stand, uniform(0, 1.2) * depth / (2 * HALF));
                rotation_about(1, 0, 0, pi, flip);
                shape_turn_by(&a, flip, 0, 0, 0);
                const double x = uniform(-HALF, HALF), y = uniform(-HALF, HALF);
                const ccd_vec3_t high = {{0, 0, 1}};
                ccd_vec3_t top;
                shape_support(&a, &high, &top);
                shape_move(&b, x, y, (double)top.v[2] - (double)lowest(&b).v[2] - 2 * depth - 1e-3);
                rotation_quaternion(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), world);
                shape_turn_by(&a, world, 0, 0, 0);
                shape_turn_by(&b, world, 0, 0, 0);
                if (!overlap(&a, &b, NULL, 1e-7, 0, &p) || (double)p.depth < depth)
                    continue;
                copy(&p.dir, n);
                shape_shift(&b, (double)p.depth - depth, n);
                check_path(&a, b, depth, seen, &error);
                path++;
            }
            printf("%-10s %-18s %7ld", body_name[k], settings_of[m].name, seen[COLD].steps);
            for (int way = 0; way < WAYS; way++)
                printf(" %6ld %6ld %7.2f", seen[way].jumps, seen[way].wide, 1e3 * seen[way].worst);
            for (int way = WARM; way < WAYS; way++)
                printf(" %6.2f%% %7.2f", 100.0 * (double)seen[way].apart / (double)seen[way].poses, 1e3 * seen[way].differs);
            printf(" %7.3f %7.3f\n", 1e3 * sqrt(error.square / error.poses), 1e3 * error.worst);
            for (int way = 0; way < WAYS && k != BODY_CONE; way++) {
                steps_of[m] += seen[way].steps;
                jumps_of[m] += seen[way].jumps;
            }
        }
    for (int m = 0; m < settings_count; m++) {
        printf("%-18s %8ld steps %6ld jumps, without cones\n", settings_of[m].name, steps_of[m], jumps_of[m]);
        CHECK(jumps_of[m] <= 2 + fmax(settings_of[m].most, single ? 4 : 0) * 1e-3 * (double)steps_of[m], "%s: jumps", settings_of[m].name);
    }
}

/* --- near both objects ------------------------------------------------------------------------ */

enum { HITS = 2000000, VERTICES = 40 };

/* Returns the distance of a point from a shape; negative inside. */
static double distance_from(const shape_t *s, const ccd_vec3_t *at)
{
    ccd_distance_t found;
    shape_t point = shape_sphere(0);
    const ccd_t ccd = settings(1e-7);
    shape_move(&point, (double)at->v[0], (double)at->v[1], (double)at->v[2]);
    const int code = OURS(ccdSignedDistance)(s, &point, &ccd, 0, 0, (ccd_real_t)HUGE_VAL, NULL, 0, &found);
    CHECK(code >= 0 || code == CCD_MISS, "distance: %d", code);
    return (double)found.distance;
}

/* Makes a body of about a metre: a hull for kind SHAPE_POLYTOPE, with its vertices in `verts`. */
static shape_t slender_body(int kind, ccd_real_t verts[3 * VERTICES])
{
    const double x = uniform(0.02, 0.5), y = uniform(0.02, 0.5), z = uniform(0.1, 1), size[] = {x, y, z};
    shape_t s = shape_make(kind, x, kind == SHAPE_CONE || kind == SHAPE_CAPSULE || kind == SHAPE_CYLINDER ? z : y, z);
    if (kind == SHAPE_POLYTOPE) {
        const int n = 4 + (int)uniform(0, VERTICES - 4);
        for (int i = 0; i < n; i++) {
            double u[3];
            for (int k = 0; k < 3; k++)
                u[k] = uniform(-1, 1);
            for (int k = 0; k < 3; k++)
                verts[3 * i + k] = (ccd_real_t)(size[k] * u[k] / sqrt(truth_dot3(u, u)));
        }
        s = shape_polytope(verts, n);
    }
    turn_randomly(&s);
    return s;
}

static void check_near(int every)
{
    static const int kinds[] = {SHAPE_POLYTOPE, SHAPE_BOX, SHAPE_POLYTOPE, SHAPE_CYLINDER, SHAPE_CONE, SHAPE_CAPSULE, SHAPE_ELLIPSOID};
    /* Known: 5 of two million, slender curved pairs, whose mirror images are no support points; by up to 1 mm. */
    const long hits = HITS / every, known = hits / 400000;
    long farther = 0;
    double worst = 0;
    uniform_seed(12);
    for (long k = 0, n = 0; n < hits; k++) {
        ccd_real_t verts[2][3 * VERTICES];
        shape_t a = slender_body(SHAPE_POLYTOPE, verts[0]), b = slender_body(kinds[k % 7], verts[1]);
        const double tolerance = single ? 1e-5 : pow(10, -4 - 2 * (int)(k % 3));
        ccd_penetration_t p;
        double dir[3];
        if (!overlap(&a, &b, NULL, tolerance, 0, &p))
            continue;
        /* Most pairs are shallow: a share of the depth that is evenly distributed in its logarithm. */
        copy(&p.dir, dir);
        shape_shift(&b, (double)p.depth * (1 - exp(uniform(log(1e-4), 0))), dir);
        if (!overlap(&a, &b, NULL, tolerance, CCD_WANT_POS, &p))
            continue;
        n++;
        for (int i = 0; i < 2; i++) {
            const double away = distance_from(i ? &b : &a, &p.pos) - 0.5 * (double)p.depth;
            worst = fmax(worst, away);
            farther += !(away <= 0.01 * (double)p.depth + tolerance);
            CHECK(farther <= known && away <= 1.1e-3, "pair %ld, %g deep: pos is %g m and half the depth from obj%d", k,
                  (double)p.depth, away, i + 1);
        }
    }
    printf("%ld hits: pos at most half the depth and %.3g m from both objects, in %ld cases farther than half the depth\n", hits, worst, farther);
}

/* --- faces by formula ------------------------------------------------------------------------- */

enum { PRISM_STEPS = 300000 };

/* Computes the centroid of the local depth over the lower face of k corners: linear, and cut off where it is negative.
 * `normal`: the floor's. */
static void face_center(const shape_t *prism, int k, const double normal[3], double depth, double center[3])
{
    double corner[CORNERS][4], cut[2 * CORNERS][4], low = HUGE_VAL, volume = 0; /* [3]: the local depth */
    int n = 0;
    for (int i = 0; i < k; i++) {
        ccd_vec3_t at;
        shape_to_world(prism, prism->verts + 3 * i, at.v);
        copy(&at, corner[i]);
        low = fmin(low, truth_dot3(normal, corner[i]));
    }
    for (int i = 0; i < k; i++)
        corner[i][3] = depth - (truth_dot3(normal, corner[i]) - low);
    for (int i = 0; i < k; i++) {
        const double *p = corner[i], *q = corner[(i + 1) % k];
        if (p[3] >= 0)
            memcpy(cut[n++], p, sizeof *cut);
        if ((p[3] >= 0) != (q[3] >= 0)) {
            for (int m = 0; m < 4; m++)
                cut[n][m] = p[m] + p[3] / (p[3] - q[3]) * (q[m] - p[m]);
            n++;
        }
    }
    memset(center, 0, 3 * sizeof *center);
    for (int i = 1; i + 1 < n; i++) {
        const double *p[3] = {cut[0], cut[i], cut[i + 1]}, sum = p[0][3] + p[1][3] + p[2][3];
        double u[3], v[3], cross[3];
        for (int m = 0; m < 3; m++) {
            u[m] = p[1][m] - p[0][m];
            v[m] = p[2][m] - p[0][m];
        }
        truth_cross3(u, v, cross);
        const double area = fabs(truth_dot3(cross, normal));
        volume += area * sum / 3;
        for (int c = 0; c < 3; c++)
            for (int m = 0; m < 3; m++)
                center[m] += area * (sum + p[c][3]) / 12 * p[c][m];
    }
    for (int m = 0; m < 3; m++)
        center[m] /= volume;
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

/* Finds pos and its normal, along which obj2 moves. */
static int position(const shape_t *a, const shape_t *b, ccd_warm_t *warm, double pos[3], double normal[3])
{
    ccd_penetration_t p;
    const int is_hit = overlap(a, b, warm, 1e-7, CCD_WANT_POS, &p);
    copy(&p.pos, pos);
    copy(&p.normal, normal);
    return is_hit;
}

static void check_prisms(int k, int regular, long paths)
{
    double square = 0, worst = 0, jump = 0, differs = 0;
    long poses = 0;
    for (long path = 0; path < paths; path++) {
        ccd_real_t verts[6 * CORNERS];
        ccd_warm_t warm;
        shape_t prism = make_prism(k, regular, verts), level = shape_box(1, 1, 0.5);
        /* Far above the tolerance of a query. */
        const double depth = exp(uniform(log(single ? 1e-3 : 1e-4), log(single ? 3e-3 : 1e-3))), lean = uniform(0, 1.2) * depth / (2 * HALF);
        const double side = uniform(-3.2, 3.2), turn = uniform(-1, 1) * 3e-3, way = uniform(-3.2, 3.2);
        double yaw = uniform(-3.2, 3.2), x = uniform(-0.3, 0.3), y = uniform(-0.3, 0.3), q[4], world[9], last[3] = {0}, last_normal[3] = {0};
        uniform_rotation(q);
        rotation_quaternion(q[0], q[1], q[2], q[3], world);
        const double normal_of_floor[3] = {world[2], world[5], world[8]};
        memset(&warm, 0, sizeof warm);
        shape_move(&level, 0, 0, -0.5);
        for (int step = 0; step < PATH; step++) {
            const double slid = step ? uniform(2.5e-4, 5e-4) : 0;
            double pos[3], other[3], normal[3], other_normal[3], exact[3], turned[9], leaning[9];
            shape_t floor = level;
            x += slid * cos(way);
            y += slid * sin(way);
            yaw += turn;
            rotation_about(0, 0, 1, yaw, turned);
            rotation_about(cos(side), sin(side), 0, lean, leaning);
            set_on_floor(&prism, leaning, turned, depth, x, y);
            shape_turn_by(&floor, world, 0, 0, 0);
            shape_turn_by(&prism, world, 0, 0, 0);
            if (!position(&floor, &prism, NULL, pos, normal)) {
                CHECK(0, "%d corners, path %ld: a hit", k, path);
                continue;
            }
            face_center(&prism, k, normal_of_floor, depth, exact);
            project(normal, exact, pos);
            square += distance(pos, exact) * distance(pos, exact);
            worst = fmax(worst, distance(pos, exact));
            poses++;
            if (step && distance(normal, last_normal) < 1e-6)
                jump = fmax(jump, distance(pos, last) - 4 * (slid + HALF * fabs(turn)));
            memcpy(last, pos, sizeof last);
            memcpy(last_normal, normal, sizeof last_normal);
            if (position(&prism, &floor, NULL, other, other_normal) && fabs(fabs(other_normal[0]) - fabs(normal[0])) < 1e-6)
                differs = fmax(differs, distance(pos, other));
            if (position(&floor, &prism, &warm, other, other_normal) && distance(normal, other_normal) < 1e-6)
                differs = fmax(differs, distance(pos, other));
        }
    }
    const double rms = sqrt(square / fmax(1, (double)poses));
    printf("%2d corners%s: %ld poses, rms %.2f mm, worst %.2f mm, jump %.2f mm, warm or swapped %.2f mm\n", k, regular ? ", regular" : "",
           poses, 1e3 * rms, 1e3 * worst, 1e3 * jump, 1e3 * differs);
    /* As <ccd/warm.h> says. */
    CHECK(rms < (single ? 1e-3 : 1e-4) && worst < (single ? 2e-3 : 5e-4), "%d corners: error", k);
    CHECK(jump < 2e-3, "%d corners: a jump", k);
    CHECK(differs < 1e-3, "%d corners: warm or swapped", k);
}

/* Turns a capsule so that its core is along a unit vector. */
static void set_axis(shape_t *s, const double z[3])
{
    const double other[3] = {z[2], z[0], z[1]};
    double x[3], y[3], rot[9];
    truth_cross3(z, other, y);
    const double length = sqrt(truth_dot3(y, y));
    for (int i = 0; i < 3; i++)
        y[i] /= length;
    truth_cross3(y, z, x);
    for (int i = 0; i < 3; i++) {
        rot[3 * i] = x[i];
        rot[3 * i + 1] = y[i];
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

static void check_faces(int every)
{
    uniform_seed(59);
    for (int k = 3; k <= CORNERS; k++)
        for (int regular = 0; regular < 2; regular++)
            check_prisms(k, regular, PRISM_STEPS / every / PATH / 16);
    check_capsules();
}

/* --- sweeps by integration -------------------------------------------------------------------- */

enum { STEPS = 64, COARSE = 24 };

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

/* Places body and ground at an angle, `depth` deep. */
static void set_pose(const sweep_t *s, double angle, double depth, shape_t *body, shape_t *floor)
{
    double first[9], then[9], all[9], lean[9];
    *floor = s->ground == DISC ? shape_cylinder(0.15, 0.5) : s->ground == BOX ? shape_box(HALF, HALF, 0.5) : shape_box(1, 1, 0.5);
    shape_move(floor, s->slide != 0 ? -0.9 : 0.05, 0.03, -0.5);
    *body = s->body;
    rotation_about(s->axis[0], s->axis[1], s->axis[2], s->initial, first);
    rotation_about(s->sweep_axis[0], s->sweep_axis[1], s->sweep_axis[2], s->slide != 0 ? deg(-0.2) : angle, then);
    rotation_times(then, first, all);
    rotation_about(cos(0.35), sin(0.35), 0, s->lean * depth / (2 * HALF), lean);
    set_on_floor(body, lean, all, depth, s->slide != 0 ? angle : 0, 0);
}

static int query(int call, const shape_t *a, const shape_t *b, ccd_warm_t *warm, ccd_vec3_t *dir, ccd_vec3_t *pos)
{
    ccd_real_t depth;
    ccd_penetration_t p;
    const call_args_t x = {.warm = warm, .want = CCD_WANT_POS, .depth = &depth, .dir = dir, .pos = pos, .penetration = &p};
    const ccd_t ccd = settings(1e-7);
    const int code = call_library(call, a, b, &ccd, &x);
    if (code >= 0 && call_table[call].kind == KIND_PENETRATION) {
        *dir = p.dir;
        *pos = p.pos;
    }
    return code;
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
    for (pose_count = 0; pose_count < STEPS + COARSE; pose_count++) {
        const double angle = angle_at(s, depth, pose_count);
        pose_t *p = &poses[pose_count];
        double place[3]; /* a point in both */
        if (angle < 0 && (s->slide != 0 || s->roll > 0))
            break;
        set_pose(s, angle, depth, &p->body, &p->floor);
        const ccd_vec3_t low = lowest(&p->body);
        copy(&low, place);
        if (s->slide != 0) /* the lowest point may be beyond the edge */
            place[0] = fmin(place[0], 0.1 - 1e-9);
        if (s->ground != FLOOR) { /* or beside the ground */
            ccd_penetration_t found;
            CHECK(overlap(&p->body, &p->floor, NULL, 1e-4, CCD_WANT_POINTS, &found), "a hit");
            for (int i = 0; i < 3; i++)
                place[i] = ((double)found.point1.v[i] + (double)found.point2.v[i]) / 2;
        }
        p->overlap = center_of_pressure(&p->body, &p->floor, up, place, p->truth) > 0;
    }
}

static errors_t sweep(const sweep_t *s, double depth, int call, const double world[9])
{
    double last[3] = {0, 0, 0}, last_truth[3] = {0, 0, 0};
    errors_t e = {0, 0, 0, 0};
    ccd_warm_t warm;
    memset(&warm, 0, sizeof warm);
    for (int k = 0; k < pose_count; k++) {
        shape_t a = k % 2 ? poses[k].body : poses[k].floor, b = k % 2 ? poses[k].floor : poses[k].body;
        double p[3], t[3], n[3];
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
        for (int i = 0; i < 3; i++)
            t[i] = truth_dot3(world + 3 * i, poses[k].truth);
        copy(&pos, p);
        copy(&dir, n);
        const double along = project(n, p, t), off = distance(p, t);
        CHECK(fabs(along) <= 1.5 * depth, "%s, pose %d: %g along dir", s->name, k, along);
        e.square += off * off;
        e.worst = fmax(e.worst, off);
        e.poses++;
        if (k > 0 && k < STEPS)
            e.step = fmax(e.step, distance(p, last) - 2 * distance(t, last_truth));
        memcpy(last, p, sizeof last);
        memcpy(last_truth, t, sizeof last_truth);
    }
    return e;
}

static void check_sweep(const sweep_t *s, double depth)
{
    double world[2][9];
    rotation_about(0, 0, 1, 0, world[0]);
    rotation_quaternion(0.3, -0.5, 0.7, 0.2, world[1]);
    set_poses(s, depth);
    for (int w = 0; w < 2; w++)
        for (int c = 0; c < CALL_COUNT; c++) {
            const errors_t e = sweep(s, depth, CALLS[c], world[w]);
            const double rms = sqrt(e.square / e.poses);
            if (c == 0)
                printf("%-35s %g m deep, world %d: rms %6.3f mm, worst %7.3f, step beyond twice the exact one %7.3f\n", s->name,
                       depth, w, 1e3 * rms, 1e3 * e.worst, 1e3 * e.step);
            CHECK(rms <= s->max_rms, "%s, %g deep, call %d: rms %.3g mm", s->name, depth, CALLS[c], 1e3 * rms);
            CHECK(e.step <= s->max_step, "%s, %g deep, call %d: step %.3g mm", s->name, depth, CALLS[c], 1e3 * e.step);
        }
}

/* --- random pairs by integration -------------------------------------------------------------- */

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
    shape_t s = kind < 0 ? shape_box(x, y, 0.1 * z) : shape_make(kind, kind == SHAPE_CAPSULE ? 0.5 * x : x, y, z);
    turn_randomly(&s);
    return s;
}

/* Checks the error of pos at a depth, and that the middle of the witness points has a larger one. */
static void check_range(unsigned kind, int range)
{
    double square[2] = {0, 0}, error[2];
    int n = 0;
    uniform_seed(9);
    for (int k = 0; k < 400; k++) {
        const int kinds = KINDS[kind].last - KINDS[kind].first + 1;
        shape_t a = random_body(KINDS[kind].first + k % kinds), b = random_body(KINDS[kind].first + k / kinds % kinds);
        ccd_penetration_t p;
        double normal[3], point[2][3], at[2][3], truth[3]; /* at: pos, the middle of the witness points */
        const double x = uniform(-0.3, 0.3), y = uniform(-0.3, 0.3), z = uniform(-0.3, 0.3);
        shape_move(&b, x, y, z);
        if (!overlap(&a, &b, NULL, 1e-8, 0, &p))
            continue;
        const double reach = fmin(shape_reach(&a), shape_reach(&b)), move = (double)p.depth - RANGE[range] * reach;
        if (move < 0)
            continue;
        copy(&p.dir, normal);
        shape_shift(&b, move, normal);
        if (!overlap(&a, &b, NULL, 1e-8, CCD_WANT_ALL, &p))
            continue;
        copy(&p.normal, normal);
        copy(&p.pos, at[0]);
        copy(&p.point1, point[0]);
        copy(&p.point2, point[1]);
        for (int i = 0; i < 3; i++)
            at[1][i] = (point[0][i] + point[1][i]) / 2;
        if (!(center_of_pressure(&a, &b, normal, at[1], truth) > 0))
            continue;
        for (int i = 0; i < 2; i++) {
            project(normal, at[i], truth);
            square[i] += pow(distance(at[i], truth) / reach, 2);
        }
        n++;
    }
    for (int i = 0; i < 2; i++)
        error[i] = 100 * sqrt(square[i] / n);
    printf("%s, depth %g %% of the radius: pos %.2f %%, middle of the witness points %.2f %%\n", KINDS[kind].name,
           100 * RANGE[range], error[0], error[1]);
    CHECK(error[0] <= KINDS[kind].max_error[range] && error[0] < error[1], "%s, depth %g of the radius", KINDS[kind].name, RANGE[range]);
}

static void check_pressure(int every)
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
    for (unsigned k = 0; k < sizeof KINDS / sizeof *KINDS; k++)
        for (int i = 0; i < 4; i += every)
            check_range(k, i);
    for (size_t i = 0; i < sizeof all / sizeof *all; i += (size_t)every)
        for (int d = 0; d < (single ? 1 : 2); d++)
            check_sweep(&all[i], d ? 1e-5 : 1e-3);
}

int main(int argc, char **argv)
{
    if (argc > 3 && strcmp(argv[1], "jumps") == 0)
        check_jumps(atoi(argv[2]), atoi(argv[3]));
    static const struct { const char *name; void (*check)(int every); } parts[] = {
        {"near", check_near}, {"faces", check_faces}, {"pressure", check_pressure}};
    for (int i = 0; i < 3; i++)
        if (argc > 1 && strcmp(argv[1], parts[i].name) == 0)
            parts[i].check(argc > 2 ? atoi(argv[2]) : 1);
    return checks_end();
}
