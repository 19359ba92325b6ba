/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks `pos`, the center of pressure:
 *
 *   pos near [N]      It is half the depth and a tolerance from both objects at most: random pairs of slender hulls, boxes,
 *                     cylinders, cones, capsules and ellipsoids, of all depths. One hit in N of two million.
 *   pos jumps N SEED  Bodies of a quarter metre at rest on others move along the contact, in N steps: how often pos jumps where
 *                     the exact one does not; how far those of a cold query, a warm one and the swapped pair are apart; the
 *                     error; the support points. And two capsules.
 *   pos faces N SEED  Regular and irregular prisms of 3 to 10 corners in N poses each, on an end on a floor: the error.
 *   pos rounded N     Boxes, prisms and frusta with edges rounded by 0 to 64 mm, flat on sharp and rounded floors, where it is
 *                     exact by symmetry, in N poses each; and turning, warm.
 *   pos coincident    It is the center of cubes in one place, in whatever order their corners are.
 *   pos pressure [N]  It is that by integration: bodies of a quarter metre that tilt, tip and roll on a floor, 1 mm and 0.01 mm
 *                     deep, in steps so small that a discontinuity shows; random pairs at depths of 1 to 30 % of the smaller
 *                     body's radius. One sweep and depth in N. */

#include "tests/extension/pressure.h"

#include "tests/contract/check.h"
#include "harness/this_library.h"

#include <float.h>

static const int single = sizeof(ccd_real_t) == sizeof(float);
static const double HALF = 0.125; /* radius and half height of a prism, half a box, metres */
static const double COARSEST = 10; /* metres */
static const double pi = 3.14159265358979323846;

typedef struct {
    double sum, square, worst;
    int count;
} errors_t;

static void add_error(errors_t *e, double error)
{
    e->sum += error;
    e->square += error * error;
    e->worst = fmax(e->worst, error);
    e->count++;
}

static double rms(const errors_t *e) { return sqrt(e->square / e->count); }

static ccd_t settings(double tolerance)
{
    ccd_t ccd = shape_query();
    ccd.max_iterations = 500;
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = (ccd_real_t)(single && tolerance != COARSEST ? 1e-5 : tolerance);
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

/* Moves b along the direction of a penetration to another depth. */
static void set_depth(shape_t *b, const ccd_penetration_t *p, double depth)
{
    double dir[3];
    copy(&p->dir, dir);
    shape_shift(b, (double)p->depth - depth, dir);
}

/* Computes the exact center of pressure of a penetration with witness points, and their middle. Returns 0 where the common
 * volume is empty. */
static int exact_position(const shape_t *a, const shape_t *b, const ccd_penetration_t *p, double exact[3], double middle[3])
{
    double normal[3], point[2][3];
    copy(&p->normal, normal);
    copy(&p->point1, point[0]);
    copy(&p->point2, point[1]);
    for (int i = 0; i < 3; i++)
        middle[i] = (point[0][i] + point[1][i]) / 2;
    if (!(center_of_pressure(a, b, normal, middle, exact) > 0))
        return 0;
    project(normal, exact, middle);
    return 1;
}

/* Moves a shape so that its lowest point is at the height z; returns that point. */
static ccd_vec3_t set_lowest(shape_t *s, double x, double y, double z)
{
    const ccd_vec3_t down = {{0, 0, -1}};
    ccd_vec3_t low;
    shape_move(s, 0, 0, 0);
    shape_support(s, &down, &low);
    shape_move(s, x, y, z - (double)low.v[2]);
    shape_support(s, &down, &low);
    return low;
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
    turn_at_random(&s);
    return s;
}

static void check_near(int every, int seed)
{
    every = every > 0 ? every : 1;
    static const int kinds[] = {SHAPE_POLYTOPE, SHAPE_BOX, SHAPE_POLYTOPE, SHAPE_CYLINDER, SHAPE_CONE, SHAPE_CAPSULE, SHAPE_ELLIPSOID};
    const long hits = HITS / every;
    long farther = 0;
    double worst = 0;
    uniform_seed((uint64_t)(seed + 11));
    for (long k = 0, n = 0; n < hits; k++) {
        ccd_real_t verts[2][3 * VERTICES];
        shape_t a = slender_body(SHAPE_POLYTOPE, verts[0]), b = slender_body(kinds[k % 7], verts[1]);
        /* The coarsest is larger than the bodies, and is taken as a part of their size. */
        const double requested = k % 4 == 3 ? COARSEST : single ? 1e-5 : pow(10, -4 - 2 * (int)(k % 4));
        ccd_penetration_t p;
        if (!overlap(&a, &b, NULL, requested, 0, &p))
            continue;
        /* Most pairs are shallow: a share of the depth that is evenly distributed in its logarithm. */
        set_depth(&b, &p, (double)p.depth * exp(uniform(log(1e-4), 0)));
        if (!overlap(&a, &b, NULL, requested, CCD_WANT_POS, &p))
            continue;
        n++;
        const double tolerance = fmin(requested, 2.5e-4 * 2 * pair_size(&a, &b));
        for (int i = 0; i < 2; i++) {
            const double away = distance_from(i ? &b : &a, &p.pos) - 0.5 * (double)p.depth;
            worst = fmax(worst, away);
            const int is_near = away <= 0.01 * (double)p.depth + tolerance;
            farther += !is_near;
            CHECK(is_near, "pair %ld, %g deep: pos is %g m and half the depth from obj%d", k,
                  (double)p.depth, away, i + 1);
        }
    }
    printf("%ld hits: pos at most half the depth and %.3g m from both objects, in %ld cases farther than half the depth\n",
           hits, worst, farther);
}

/* --- jumps ------------------------------------------------------------------------------------ */

enum { PATH = 20, CORNERS = 10 };

/* Bodies: prisms by their number of corners, and others. */
enum { BODY_BOX, BODY_HULL, BODY_CYLINDER, BODY_PRISM, BODY_CAPSULE = BODY_PRISM + CORNERS - 2, BODY_CONE, BODIES };
static const char *const body_name[BODIES] = {"box", "hull", "cylinder", "3 corners", "4 corners", "5 corners", "6 corners",
                                              "7 corners", "8 corners", "9 corners", "10 corners", "capsule", "cone"};

/* Bodies at rest on others, and bounds. */
static const struct {
    const char *name;
    int stand, floor; /* on their ends; on a floor (1), a body (0) or either (-1) */
    double depth[2];
    int exact_every; /* steps */
    double jumps;    /* in 1000 steps, without cones; more than one */
} RESTS[] = {{"stands on a floor", 1, 1, {1e-5, 1e-3}, 2, 0.5},
             {"stands on a body", 1, 0, {1e-5, 1e-3}, PATH, 0.5},
             {"any way on either", 0, -1, {1e-5, 1e-3}, PATH, 0.5},
             {"any way, deeper", 0, -1, {1e-3, 5e-2}, PATH, 3}};
enum { REST_COUNT = sizeof RESTS / sizeof *RESTS };

/* Ways to find pos at a pose, and what was seen on one of them. */
enum { COLD, WARM, SWAPPED, WAYS };
typedef struct {
    long steps, jumps, wide, poses, apart; /* wide: by more than 10 mm; apart: 5 mm or more from that of the cold query */
    double worst, differs;
} way_t;

/* Makes a body of a quarter metre; regular or with corners at random places of an ellipse, in `verts`. */
static shape_t make_body(int kind, int regular, ccd_real_t verts[6 * CORNERS])
{
    const double width = regular ? 1 : uniform(0.6, 1);
    switch (kind) {
    case BODY_BOX: return shape_box(HALF, HALF * width, HALF * uniform(0.4, 1));
    case BODY_CYLINDER: return shape_cylinder(HALF * width, HALF);
    case BODY_CAPSULE: return shape_capsule(HALF * width / 2, HALF);
    case BODY_CONE: return shape_cone(HALF * width, HALF);
    case BODY_HULL:
        for (int i = 0; i < 3 * CORNERS; i++)
            verts[i] = (ccd_real_t)uniform(-HALF, HALF);
        return shape_polytope(verts, CORNERS);
    }
    for (int i = 0; i < kind; i++) {
        const double angle = 2 * pi * (i + (regular ? 0 : uniform(-0.35, 0.35))) / kind;
        for (int top = 0; top < 2; top++) {
            ccd_real_t *v = verts + 3 * (i + top * kind);
            v[0] = (ccd_real_t)(HALF * width * cos(angle));
            v[1] = (ccd_real_t)(HALF * sin(angle));
            v[2] = (ccd_real_t)(top ? HALF : -HALF);
        }
    }
    return shape_polytope(verts, 2 * kind);
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
        turn_at_random(s);
    rotation_about(0, 0, 1, uniform(-pi, pi), rot);
    shape_turn_by(s, rot, 0, 0, 0);
    rotation_about(cos(side), sin(side), 0, lean, rot);
    shape_turn_by(s, rot, 0, 0, 0);
}

/* Lays a body of a kind on another one or a floor. Returns whether it is as deep as it should be. */
static int make_pair(int kind, int regular, int rest, double depth, shape_t *a, shape_t *b, ccd_real_t verts[2][6 * CORNERS])
{
    const int on_floor = RESTS[rest].floor < 0 ? random_below(2) : RESTS[rest].floor;
    double q[4], world[9], flip[9];
    ccd_penetration_t p;
    *a = on_floor ? shape_box(1, 1, 0.5) : make_body(random_below(BODIES), random_below(2), verts[0]);
    *b = make_body(kind, regular, verts[1]);
    lay(a, on_floor || RESTS[rest].stand, 0);
    set_lowest(a, 0, 0, 0);
    rotation_about(1, 0, 0, pi, flip);
    shape_turn_by(a, flip, 0, 0, 0);
    lay(b, RESTS[rest].stand, uniform(0, 1.2) * depth / (2 * HALF));
    const double x = uniform(-HALF, HALF), y = uniform(-HALF, HALF);
    set_lowest(b, x, y, -2 * depth - 1e-3);
    uniform_rotation(q);
    rotation_quaternion(q[0], q[1], q[2], q[3], world);
    shape_turn_by(a, world, 0, 0, 0);
    shape_turn_by(b, world, 0, 0, 0);
    if (!overlap(a, b, NULL, 1e-7, 0, &p) || (double)p.depth < depth)
        return 0;
    set_depth(b, &p, depth);
    return 1;
}

/* A pose's pair and its penetration on one way. */
typedef struct {
    shape_t b;
    ccd_penetration_t p;
    double pos[3], normal[3];
} found_t;

static int find(const shape_t *a, const shape_t *b, int way, ccd_warm_t *warm, found_t *f)
{
    const int swapped = way == SWAPPED;
    const int hit = overlap(swapped ? b : a, swapped ? a : b, way == WARM ? warm : NULL, 1e-7, CCD_WANT_ALL, &f->p);
    f->b = *b;
    for (int i = 0; i < 3 && swapped; i++)
        f->p.normal.v[i] = -f->p.normal.v[i];
    copy(&f->p.pos, f->pos);
    copy(&f->p.normal, f->normal);
    return hit;
}

/* Returns how far pos moved, and its difference from the exact one: the lesser, or 0 where it is below the limit. */
static double jump(const shape_t *a, const found_t *last, const found_t *now, double limit)
{
    const double moved = distance(now->pos, last->pos);
    double exact[2][3], middle[3], off[2][3];
    if (moved <= limit)
        return 0;
    if (exact_position(a, &last->b, &last->p, exact[0], middle) && exact_position(a, &now->b, &now->p, exact[1], middle)) {
        for (int i = 0; i < 3; i++) {
            off[0][i] = last->pos[i] - exact[0][i];
            off[1][i] = now->pos[i] - exact[1][i];
        }
        return distance(off[0], off[1]) > limit ? fmin(moved, distance(off[0], off[1])) : 0;
    }
    return moved;
}

/* Moves b along its contact with a, and across it by up to a tenth of the depth. */
static void check_path(const shape_t *a, shape_t b, double depth, int exact_every, way_t seen[WAYS], errors_t *error, errors_t *cost)
{
    found_t last[WAYS];
    ccd_warm_t warm;
    const double turn = random_below(2) ? 0 : uniform(-1, 1) * 1e-3, aside[3] = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    memset(&warm, 0, sizeof warm);
    for (int step = 0; step < PATH; step++) {
        const double by = uniform(2.5e-4, 5e-4), sinks = uniform(-0.1, 0.1) * depth;
        const double limit = 2e-3 + 4 * (by + fabs(sinks) + 2 * HALF * fabs(turn));
        if (step) {
            const double *n = last[COLD].normal, x = (double)b.pos[0], y = (double)b.pos[1], z = (double)b.pos[2];
            double along[3], rot[9];
            truth_cross3(n, aside, along);
            rotation_about(n[0], n[1], n[2], turn, rot);
            shape_move(&b, 0, 0, 0);
            shape_turn_by(&b, rot, x, y, z);
            shape_shift(&b, by / sqrt(truth_dot3(along, along)), along);
            shape_shift(&b, sinks, n);
        }
        for (int way = 0; way < WAYS; way++) {
            way_t *w = &seen[way];
            found_t now;
            if (!find(a, &b, way, &warm, &now))
                return;
            if (step && distance(now.normal, last[way].normal) < 1e-6) {
                const double beyond = jump(a, &last[way], &now, limit);
                w->steps++;
                w->jumps += beyond > 0;
                w->wide += beyond > 1e-2;
                w->worst = fmax(w->worst, beyond);
            }
            last[way] = now;
            if (distance(now.normal, last[COLD].normal) < 1e-6) {
                const double apart = distance(now.pos, last[COLD].pos);
                w->poses++;
                w->apart += apart >= 5e-3;
                w->differs = fmax(w->differs, apart);
            }
        }
        ccd_penetration_t without;
        double exact[3], middle[3];
        overlap(a, &b, NULL, 1e-7, 0, &without);
        add_error(cost, (double)last[COLD].p.support_points - (double)without.support_points);
        if (step % exact_every == exact_every / 2 && exact_position(a, &b, &last[COLD].p, exact, middle))
            add_error(error, distance(exact, last[COLD].pos));
    }
}

/* Turns a capsule so that its core is along a unit vector. */
static void set_axis(shape_t *s, const double z[3])
{
    static const double down[3] = {0, 0, 1};
    double axis[3], rot[9];
    truth_cross3(down, z, axis);
    rotation_about(axis[0], axis[1], axis[2], acos(z[2]), rot);
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
    double pos[2][3];
    for (int i = 0; i < 2; i++) {
        ccd_penetration_t p;
        shape_t a = shape_capsule(0.043285777553567384, 0.076910544426185376);
        shape_t b = shape_capsule(0.040085627162162588, 0.10972582880013919);
        set_axis(&a, axis[0]);
        set_axis(&b, axis[1]);
        shape_move(&b, at[i][0], at[i][1], at[i][2]);
        CHECK(overlap(&a, &b, NULL, 1e-7, CCD_WANT_POS, &p), "capsules overlap");
        copy(&p.pos, pos[i]);
    }
    CHECK(distance(pos[0], pos[1]) < (single ? 1e-3 : 1e-5), "capsules: pos moves by %g mm", 1e3 * distance(pos[0], pos[1]));
}

static void check_jumps(int steps, int seed)
{
    const int paths = 1 + (steps - 1) / (PATH * BODIES * REST_COUNT);
    const double least = single ? 1e-3 : 0; /* depth, far above the tolerance of a query */
    long steps_of[REST_COUNT][2] = {{0}}, jumps_of[REST_COUNT][2] = {{0}}; /* of cones apart */
    check_capsules();
    uniform_seed((uint64_t)seed);
    printf("%38s%23s%38s%38s%16s%15s\n", "steps", "cold: jumps > 2, 10 mm", "warm; >= 5 mm from cold, worst", "swapped", "error: rms, worst",
           "support points");
    for (int k = 0; k < BODIES; k++)
        for (int m = 0; m < REST_COUNT; m++) {
            way_t seen[WAYS] = {{0}};
            errors_t error = {0}, cost = {0};
            for (int path = 0, trial = 0; path < paths && trial < 50 * paths; trial++) {
                ccd_real_t verts[2][6 * CORNERS];
                shape_t a, b;
                const double *range = RESTS[m].depth;
                const double depth = exp(uniform(log(fmax(range[0], least)), log(fmax(range[1], 3 * least))));
                if (!make_pair(k, random_below(2), m, depth, &a, &b, verts))
                    continue;
                check_path(&a, b, depth, RESTS[m].exact_every, seen, &error, &cost);
                path++;
            }
            printf("%-10s %-18s %8ld", body_name[k], RESTS[m].name, seen[COLD].steps);
            for (int way = 0; way < WAYS; way++) {
                const way_t *w = &seen[way];
                printf(" %6ld %6ld %7.2f", w->jumps, w->wide, 1e3 * w->worst);
                if (way > 0)
                    printf(" %5.2f%% %7.2f", 100 * (double)w->apart / (double)w->poses, 1e3 * w->differs);
                steps_of[m][k == BODY_CONE] += w->steps;
                jumps_of[m][k == BODY_CONE] += w->jumps;
            }
            printf(" %7.3f %7.3f %5.2f %3.0f\n", 1e3 * rms(&error), 1e3 * error.worst, cost.sum / cost.count, cost.worst);
            /* Means as <ccd/warm.h> says, of many poses; in single precision the depths are larger, and so are the tilts. */
            const int is_face = k == BODY_BOX || (k >= BODY_PRISM && k < BODY_CAPSULE);
            const double mean = cost.sum / cost.count, most = (m ? 10 : 7) + single;
            CHECK((cost.count < 100 || mean <= most) && cost.worst <= 24, "%s %s: %.2f support points, at most %.0f", body_name[k],
                  RESTS[m].name, mean, cost.worst);
            if (m == 0 && is_face)
                CHECK(fmax(seen[WARM].differs, seen[SWAPPED].differs) < 1e-3, "%s: warm or swapped", body_name[k]);
        }
    for (int m = 0; m < REST_COUNT; m++) {
        for (int cone = 0; cone < 2; cone++) {
            /* In 1000 steps; those of a cone are often in one path. */
            const double of_others = fmax(RESTS[m].jumps, single ? 4 : 0), of_cones = single ? 30 : 6;
            /* And one jump, or one path of a cone: each is seen on every way. */
            const double most = (cone ? of_cones : of_others) * 1e-3 * (double)steps_of[m][cone] + WAYS * (cone ? PATH : 1);
            printf("%-18s %8ld steps %6ld jumps%s\n", RESTS[m].name, steps_of[m][cone], jumps_of[m][cone], cone ? " of cones" : "");
            CHECK((double)jumps_of[m][cone] <= most, "%s: jumps%s", RESTS[m].name, cone ? " of cones" : "");
        }
    }
}

/* Checks the error of faces on a floor, where every corner matters. */
static void check_faces(int poses, int seed)
{
    uniform_seed((uint64_t)seed);
    for (int corners = 3; corners <= CORNERS; corners++)
        for (int regular = 1; regular >= 0; regular--) {
            errors_t error = {0};
            for (int k = 0; k < poses; k++) {
                ccd_real_t verts[2][6 * CORNERS];
                shape_t a, b;
                ccd_penetration_t p;
                double pos[3], exact[3], middle[3];
                const double depth = exp(uniform(log(single ? 1e-3 : 1e-5), log(single ? 3e-3 : 1e-3)));
                if (!make_pair(BODY_PRISM + corners - 3, regular, 0, depth, &a, &b, verts) ||
                    !overlap(&a, &b, NULL, 1e-7, CCD_WANT_ALL, &p) || !exact_position(&a, &b, &p, exact, middle))
                    continue;
                copy(&p.pos, pos);
                add_error(&error, distance(exact, pos));
            }
            /* Millimetres, as <ccd/warm.h> says. */
            const double max_rms = (regular ? 0.2 : corners > 8 ? 2.5 : 1.2) + single, max_worst = (regular ? 1 : 10) + single;
            printf("%s face of %d corners: rms %.3f mm, worst %.3f\n", regular ? "regular" : "irregular", corners, 1e3 * rms(&error), 1e3 * error.worst);
            CHECK(1e3 * rms(&error) <= max_rms && 1e3 * error.worst <= max_worst, "%d corners", corners);
        }
}

/* --- sweeps by integration -------------------------------------------------------------------- */

enum { STEPS = 64, COARSE = 24 };

/* Poses of a body on a floor: turned about `axis` by `initial`, then about `sweep_axis` by the angle of the sweep. */
typedef struct {
    const char *name;
    shape_t body;
    const double *axis;
    double initial;
    const double *sweep_axis;
    double roll; /* degrees a step, of a body that rolls; 0: small angles, then larger ones */
    double max_rms, max_step; /* metres; steps beyond twice the exact one */
} sweep_t;

/* A pose and its exact center of pressure. */
typedef struct {
    shape_t body;
    double truth[3];
} pose_t;

static double deg(double x) { return x * pi / 180; }

/* Returns the k-th angle of a sweep. */
static double angle_at(const sweep_t *s, double depth, int k)
{
    const int coarse = k - STEPS;
    return s->roll > 0 ? deg(s->roll * k) : coarse < 0 ? (k - STEPS / 2 + 0.5) * depth / (16 * HALF) : deg(0.05 * coarse * coarse + 0.05);
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

/* Checks one call on the poses of a sweep, turned into the world; prints the errors of the first. */
static void sweep(const sweep_t *s, const pose_t *poses, int count, double depth, int call, const double world[9])
{
    double last[3] = {0, 0, 0}, last_truth[3] = {0, 0, 0}, step = 0;
    errors_t error = {0};
    ccd_warm_t warm;
    memset(&warm, 0, sizeof warm);
    for (int k = 0; k < count; k++) {
        shape_t pair[2] = {shape_box(1, 1, 0.5), poses[k].body};
        double p[3], truth[3], n[3];
        ccd_vec3_t dir, pos;
        shape_move(&pair[0], 0.05, 0.03, -0.5);
        for (int i = 0; i < 2; i++)
            shape_turn_by(&pair[i], world, 0, 0, 0);
        const int code = query(call, &pair[k % 2], &pair[1 - k % 2], call == CALL_MPR_WARM && k % 2 == 0 ? &warm : NULL, &dir, &pos);
        if (code != 0 && code != CCD_LIMIT) {
            CHECK(0, "%s, pose %d: code %d", s->name, k, code);
            continue;
        }
        for (int i = 0; i < 3; i++)
            truth[i] = truth_dot3(world + 3 * i, poses[k].truth);
        copy(&pos, p);
        copy(&dir, n);
        const double along = project(n, p, truth);
        CHECK(fabs(along) <= 1.5 * depth, "%s, pose %d: %g along dir", s->name, k, along);
        add_error(&error, distance(p, truth));
        if (k > 0 && k < STEPS)
            step = fmax(step, distance(p, last) - 2 * distance(truth, last_truth));
        memcpy(last, p, sizeof last);
        memcpy(last_truth, truth, sizeof last_truth);
    }
    if (call == CALL_MPR)
        printf("%-20s %g m deep: rms %6.3f mm, worst %7.3f, step beyond twice the exact one %7.3f\n", s->name, depth, 1e3 * rms(&error),
               1e3 * error.worst, 1e3 * step);
    CHECK(rms(&error) <= s->max_rms, "%s, %g deep, call %d: rms %.3g mm", s->name, depth, call, 1e3 * rms(&error));
    CHECK(step <= s->max_step, "%s, %g deep, call %d: step %.3g mm", s->name, depth, call, 1e3 * step);
}

static void check_sweep(const sweep_t *s, double depth)
{
    static const int calls[] = {CALL_MPR, CALL_MPR_WARM, CALL_GJK, CALL_PENETRATION, CALL_LOCAL, CALL_INCREMENTAL, CALL_PROVEN};
    static const double up[3] = {0, 0, 1};
    const int count = s->roll > 0 ? STEPS : STEPS + COARSE;
    pose_t poses[STEPS + COARSE];
    double world[2][9];
    rotation_about(0, 0, 1, 0, world[0]);
    rotation_quaternion(0.3, -0.5, 0.7, 0.2, world[1]);
    shape_t floor = shape_box(1, 1, 0.5);
    shape_move(&floor, 0.05, 0.03, -0.5);
    for (int k = 0; k < count; k++) {
        double first[9], then[9], all[9], place[3];
        rotation_about(s->axis[0], s->axis[1], s->axis[2], s->initial, first);
        rotation_about(s->sweep_axis[0], s->sweep_axis[1], s->sweep_axis[2], angle_at(s, depth, k), then);
        rotation_times(then, first, all);
        poses[k].body = s->body;
        shape_turn(&poses[k].body, all);
        const ccd_vec3_t low = set_lowest(&poses[k].body, 0, 0, -depth);
        copy(&low, place);
        CHECK(center_of_pressure(&poses[k].body, &floor, up, place, poses[k].truth) > 0, "%s: volume", s->name);
    }
    for (size_t i = 0; i < 2 * sizeof calls / sizeof *calls; i++)
        sweep(s, poses, count, depth, calls[i / 2], world[i % 2]);
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
    turn_at_random(&s);
    return s;
}

/* Checks the error of pos at a depth, and that the middle of the witness points has a larger one. */
static void check_range(unsigned kind, int range)
{
    errors_t error[2] = {{0}}; /* of pos, of the middle of the witness points */
    uniform_seed(9);
    for (int k = 0; k < 400; k++) {
        const int kinds = KINDS[kind].last - KINDS[kind].first + 1;
        shape_t a = random_body(KINDS[kind].first + k % kinds), b = random_body(KINDS[kind].first + k / kinds % kinds);
        ccd_penetration_t p;
        double pos[3], middle[3], truth[3];
        const double x = uniform(-0.3, 0.3), y = uniform(-0.3, 0.3), z = uniform(-0.3, 0.3);
        const double reach = fmin(shape_reach(&a), shape_reach(&b)), depth = RANGE[range] * reach;
        shape_move(&b, x, y, z);
        if (!overlap(&a, &b, NULL, 1e-8, 0, &p) || (double)p.depth < depth)
            continue;
        set_depth(&b, &p, depth);
        if (!overlap(&a, &b, NULL, 1e-8, CCD_WANT_ALL, &p) || !exact_position(&a, &b, &p, truth, middle))
            continue;
        copy(&p.pos, pos);
        add_error(&error[0], distance(pos, truth) / reach);
        add_error(&error[1], distance(middle, truth) / reach);
    }
    printf("%s, depth %g %% of the radius: pos %.2f %%, middle of the witness points %.2f %%\n", KINDS[kind].name,
           100 * RANGE[range], 100 * rms(&error[0]), 100 * rms(&error[1]));
    CHECK(100 * rms(&error[0]) <= KINDS[kind].max_error[range] && rms(&error[0]) < rms(&error[1]), "%s, depth %g of the radius",
          KINDS[kind].name, RANGE[range]);
}

static void check_pressure(int every, int seed)
{
    const double q = deg(90);
    static const double corner[3] = {1, -1, 0}, X[3] = {1, 0, 0}, Y[3] = {0, 1, 0}, Z[3] = {0, 0, 1}, XY[3] = {1, 0.6, 0};
/* max_rms, max_step */
#define FLAT 3e-3, 1e-3
#define ROUND 7.5e-3, 5e-3
/* Its radius falls along the line that it lies on, and so does the correction for it: where the
 * deepest point jumps along the line, pos follows in part. */
#define TAPERED 15e-3, 50e-3
    const shape_t box = shape_box(HALF, HALF, HALF), brick = shape_box(HALF, 0.08, 0.06), can = shape_cylinder(0.09, HALF);
    const shape_t rod = shape_capsule(0.05, HALF), hat = shape_cone(HALF, HALF), egg = shape_ellipsoid(0.1, 0.07, HALF);
    const sweep_t all[] = {
        {"box", box, Z, 0, Y, 0, FLAT},
        {"box yawed", box, Z, 0.3, Y, 0, FLAT},
        {"brick, two axes", brick, Z, 0.1, XY, 0, FLAT},
        {"brick on an edge", brick, X, deg(40), Y, 0, FLAT},
        {"box on a corner", box, corner, 0.9, Y, 1, FLAT},
        {"cylinder standing", can, Z, 0, Y, 0, ROUND},
        {"cylinder lying", can, X, q, X, 0, ROUND},
        {"cylinder rolling", can, X, q, Y, 1, ROUND},
        {"capsule lying", rod, X, q, X, 0, ROUND},
        {"cone on its base", hat, Z, 0, Y, 0, ROUND},
        {"cone on its side", hat, X, q + atan(0.5), X, 0, TAPERED},
        {"ellipsoid", egg, X, 0.7, Y, 1, ROUND},
    };
    (void)seed;
    for (unsigned k = 0; k < sizeof KINDS / sizeof *KINDS; k++)
        for (int i = 0; i < 4; i += every)
            check_range(k, i);
    for (size_t i = 0; i < sizeof all / sizeof *all; i += (size_t)every)
        for (int d = 0; d < (single ? 1 : 2); d++)
            check_sweep(&all[i], d ? 1e-5 : 1e-3);
}

/* --- rounded bodies --------------------------------------------------------------------------- */

/* A body with a ball of radius `margin` added all around, as Bullet's margins. */
typedef struct {
    shape_t core;
    double margin;
} rounded_t;

static void rounded_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const rounded_t *body = (const rounded_t *)obj;
    shape_support(&body->core, dir, out);
    for (int i = 0; i < 3; i++)
        out->v[i] += (ccd_real_t)body->margin * dir->v[i];
}

static void rounded_center(const void *obj, ccd_vec3_t *out) { shape_center(&((const rounded_t *)obj)->core, out); }

static int find_rounded(const rounded_t *a, const rounded_t *b, ccd_warm_t *warm, double pos[3])
{
    ccd_penetration_t p;
    ccd_t ccd = settings(1e-6);
    ccd.support1 = ccd.support2 = rounded_support;
    ccd.center1 = ccd.center2 = rounded_center;
    const int code = OURS(ccdPenetration)(a, b, &ccd, warm, CCD_WANT_POS, &p);
    copy(&p.pos, pos);
    return code == CCD_HIT;
}

/* Makes a box, a prism with a regular base or a frustum on the plane z = `z`: by symmetry its center of pressure is on its axis. */
static rounded_t symmetric_body(int kind, double margin, double z, ccd_real_t verts[6 * CORNERS])
{
    rounded_t body = {shape_box(uniform(0.04, 0.12), uniform(0.04, 0.12), uniform(0.04, 0.12)), margin};
    const double half = kind ? uniform(0.04, 0.12) : (double)body.core.p[2], top = uniform(0.5, 1.2);
    for (int i = 0; kind && i < 2 * kind; i++) {
        /* With the rounding of vertices read from a file. */
        const double angle = 2 * pi * (i / 2) / kind, r = 0.1 * (i % 2 ? top : 1);
        verts[3 * i] = (ccd_real_t)(r * cos(angle) + uniform(-1e-7, 1e-7));
        verts[3 * i + 1] = (ccd_real_t)(r * sin(angle) + uniform(-1e-7, 1e-7));
        verts[3 * i + 2] = (ccd_real_t)((i % 2 ? half : -half) + uniform(-1e-7, 1e-7));
    }
    if (kind)
        body.core = shape_polytope(verts, 2 * kind);
    shape_move(&body.core, 0, 0, z + half + margin);
    return body;
}

/* Checks bodies that lie flat on a floor or on a larger box, sharp and rounded, in any direction of the world. */
static void check_rounded(int poses, int seed)
{
    static const double margins[] = {0, 1e-3, 4e-3, 16e-3, 64e-3}, lower[] = {0, 20e-3};
    static const int kinds[] = {0, 3, 5, 8, CORNERS};
    uniform_seed((uint64_t)seed);
    for (int m = 0; m < 5; m++)
        for (int f = 0; f < 2; f++) {
            errors_t error = {0}, warm_error = {0};
            for (int k = 0; k < poses; k++) {
                ccd_real_t verts[6 * CORNERS];
                const double depth = exp(uniform(log(single ? 1e-3 : 1e-4), log(1e-3)));
                rounded_t floor = {shape_box(1, 1, 0.1), lower[f]}, body = symmetric_body(kinds[k % 5], margins[m], -depth, verts);
                double q[4], world[9], yaw[9], pos[3], axis[3];
                ccd_warm_t warm;
                memset(&warm, 0, sizeof warm);
                shape_move(&floor.core, uniform(-0.5, 0.5), uniform(-0.5, 0.5), -0.1 - lower[f]);
                rotation_about(0, 0, 1, uniform(-pi, pi), yaw);
                shape_turn_by(&body.core, yaw, 0, 0, 0);
                uniform_rotation(q);
                rotation_quaternion(q[0], q[1], q[2], q[3], world);
                shape_turn_by(&floor.core, world, 0, 0, 0);
                shape_turn_by(&body.core, world, 0, 0, 0);
                CHECK(find_rounded(&floor, &body, NULL, pos), "rounded bodies overlap");
                for (int i = 0; i < 3; i++)
                    axis[i] = (double)body.core.pos[i];
                const double n[3] = {world[2], world[5], world[8]};
                project(n, axis, pos);
                add_error(&error, distance(axis, pos));
                /* Turns by 1e-4 rad a step. */
                rotation_about(n[0], n[1], n[2], 1e-4, yaw);
                for (int step = 0; step < 4; step++) {
                    const double x = (double)body.core.pos[0], y = (double)body.core.pos[1], z = (double)body.core.pos[2];
                    shape_move(&body.core, 0, 0, 0);
                    shape_turn_by(&body.core, yaw, x, y, z);
                    CHECK(find_rounded(&floor, &body, &warm, pos), "rounded bodies overlap");
                    project(n, axis, pos);
                    add_error(&warm_error, distance(axis, pos));
                }
            }
            printf("margin %2.0f mm on a %s floor: rms %.3f mm, worst %.3f; warm, turning %.3f, %.3f\n", 1e3 * margins[m],
                   f ? "rounded" : "sharp", 1e3 * rms(&error), 1e3 * error.worst, 1e3 * rms(&warm_error), 1e3 * warm_error.worst);
            CHECK(fmax(rms(&error), rms(&warm_error)) < 1.5e-3 && fmax(error.worst, warm_error.worst) < 4.5e-3, "margin %g", margins[m]);
        }
}

static void check_coincident(int count, int seed)
{
    const ccd_t ccd = settings(1e-6);
    const double center[3] = {5, 0, 0};
    (void)count, (void)seed;
    for (int first = 0; first < 8; first++) {
        ccd_real_t verts[24];
        for (int i = 0; i < 24; i++)
            verts[i] = (ccd_real_t)((((i / 3 ^ first) >> i % 3) & 1) - 0.5);
        shape_t cube = shape_polytope(verts, 8);
        shape_move(&cube, center[0], center[1], center[2]);
        ccd_real_t depth;
        ccd_vec3_t dir, pos[2];
        double p[3];
        CHECK(OURS(ccdMPRPenetration)(&cube, &cube, &ccd, &depth, &dir, &pos[0]) == 0, "the cubes overlap");
        CHECK(OURS(ccdGJKPenetration)(&cube, &cube, &ccd, &depth, &dir, &pos[1]) == 0, "the cubes overlap");
        for (int i = 0; i < 2; i++) {
            copy(&pos[i], p);
            CHECK(distance(p, center) < (single ? 1e-5 : 1e-6), "corner %d first: pos of cubes in one place is %g m off their center",
                  first, distance(p, center));
        }
    }
}

int main(int argc, char **argv)
{
    static const struct { const char *name; void (*check)(int count, int seed); } parts[] = {
        {"near", check_near}, {"jumps", check_jumps}, {"faces", check_faces}, {"pressure", check_pressure},
        {"rounded", check_rounded}, {"coincident", check_coincident}};
    for (int i = 0; i < 6; i++)
        if (argc > 1 && strcmp(argv[1], parts[i].name) == 0)
            parts[i].check(argc > 2 ? atoi(argv[2]) : 1, argc > 3 ? atoi(argv[3]) : 1);
    return checks_end();
}
