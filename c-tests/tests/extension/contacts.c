/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Compares ccdContacts with exact contact regions: boxes and hulls at rest and tilted, edges, corners;
 * round and flat objects by formula. Checks the number of support calls, and that the region moves with
 * the objects.
 *
 *   contacts [N]   one scene in N, for a tool that checks memory */

#include "tests/stability/categories.h"

#include "tests/contract/check.h"
#include "manifold.h"

enum { MAX_CONTACTS = 32 };

static int share = 1; /* one scene in so many */

static const int single = sizeof(ccd_real_t) == sizeof(float);
static const double pi = 3.14159265358979323846;

static ccd_manifold_cache_t *cache; /* NULL: none */

typedef struct {
    shape_t a, b;
    double n[3], slop;
} scene_t;

typedef struct {
    int n;
    ccd_contact_t c[MAX_CONTACTS];
} contacts_t;

static double dot(const double a[3], const ccd_vec3_t *b)
{
    return a[0] * (double)b->v[0] + a[1] * (double)b->v[1] + a[2] * (double)b->v[2];
}

/* Returns the rounding of a coordinate. */
static double rounding(const scene_t *s) { return 4 * real_eps() * largest_coordinate(&s->a, &s->b); }

/* Returns the height along n of a shape's support plane in the direction sign * n. */
static double support_height(const shape_t *shape, const double n[3], int sign)
{
    ccd_vec3_t d, p;
    for (int k = 0; k < 3; k++)
        d.v[k] = (ccd_real_t)(sign * n[k]);
    shape_support(shape, &d, &p);
    return dot(n, &p);
}

/* Returns the depth along n. */
static double depth_along(const scene_t *s) { return support_height(&s->a, s->n, 1) - support_height(&s->b, s->n, -1); }

/* Returns the scene's slop, or the library's least one. */
static double effective_slop(const scene_t *s) { return fmax(s->slop, fmax(0.01 * depth_along(s), 8 * rounding(s))); }

static contacts_t contacts_at_most(scene_t *s, int max)
{
    contacts_t out;
    ccd_vec3_t normal;
    ccd_t ccd = shape_query();
    ccd.center1 = ccd.center2 = NULL;
    ccd.first_dir = NULL;
    for (int k = 0; k < 3; k++)
        normal.v[k] = (ccd_real_t)(3 * s->n[k]);
    s->a.calls = s->b.calls = 0;
    memset(&out, 0, sizeof out);
    out.n = OURS(ccdContacts)(&s->a, &s->b, &ccd, &normal, (ccd_real_t)s->slop, cache, out.c, max);
    CHECK(out.n >= 1 && out.n <= max, "%d contacts", out.n);
    for (int k = 0; k < 2; k++) {
        const shape_t *shape = k ? &s->b : &s->a;
        CHECK(shape->calls <= (shape->type == SHAPE_BOX ? 12UL : 24UL) + (cache ? 10 : 0),
              "%lu calls of type %d", shape->calls, shape->type);
    }
    return out;
}

static int runs_twice; /* with a cache: the second result counts */

static contacts_t contacts_of(scene_t *s)
{
    const contacts_t c = contacts_at_most(s, MAX_CONTACTS);
    return runs_twice ? contacts_at_most(s, MAX_CONTACTS) : c;
}

static point2_t project(const frame_t *f, const ccd_real_t p[3])
{
    const truth_real q[3] = {p[0], p[1], p[2]};
    return manifold_project(f, q);
}

static polygon_t polygon_of(const contacts_t *c, const frame_t *f)
{
    polygon_t polygon = {.n = c->n};
    for (int i = 0; i < c->n; i++)
        polygon.p[i] = project(f, c->c[i].point1.v);
    return polygon;
}

/* Returns the distance of the two points across n. */
static double lateral_distance(const scene_t *s, const ccd_contact_t *p)
{
    double most = 0;
    for (int k = 0; k < 3; k++)
        most = fmax(most, fabs((double)p->point1.v[k] - (double)p->depth * s->n[k] - (double)p->point2.v[k]));
    return most;
}

/* Returns the distance of a point outside of a shape: the largest of many directions, the last near the best. */
static double distance_outside(const shape_t *shape, const ccd_vec3_t *p, int trials)
{
    double best = -HUGE_VAL, best_dir[3] = {0, 0, 0}, step = 1;
    rng_t random = rng(1, 0);
    for (int trial = 0; trial < trials; trial++) {
        const int is_global = 4 * trial < trials;
        double v[3], out;
        rng_unit_vector(&random, v);
        for (int k = 0; k < 3 && !is_global; k++)
            v[k] = best_dir[k] + step * v[k];
        const double length = sqrt(truth_dot3(v, v));
        for (int k = 0; k < 3; k++)
            v[k] /= length;
        out = dot(v, p) - support_height(shape, v, 1);
        if (out > best) {
            best = out;
            memcpy(best_dir, v, sizeof best_dir);
        } else if (!is_global) {
            step = step < 1e-6 ? 0.1 : 0.97 * step;
        }
    }
    return best;
}

/* Checks, for any normal, the depths, and that the points are within the slop of the support planes. */
static void check_heights(const scene_t *s, const contacts_t *c, const char *what)
{
    const double noise = 4 * rounding(s), room = effective_slop(s) + 8 * noise;
    const double h1 = support_height(&s->a, s->n, 1), h2 = support_height(&s->b, s->n, -1);
    for (int i = 0; i < c->n; i++) {
        const ccd_contact_t *p = &c->c[i];
        const double one = dot(s->n, &p->point1), two = dot(s->n, &p->point2), depth = (double)p->depth;
        CHECK(fabs(one - two - depth) <= noise, "%s: points along n", what);
        CHECK(depth <= h1 - h2 + noise && depth >= h1 - h2 - 2 * room, "%s: depth %g of %g", what, depth, h1 - h2);
        CHECK(i == 0 || p->depth <= c->c[0].depth + (ccd_real_t)noise, "%s: point %d is the deepest", what, i);
        CHECK(fabs(one - h1) <= room && fabs(two - h2) <= room, "%s: %g and %g from the support planes, slop %g", what,
              one - h1, two - h2, s->slop);
    }
}

/* Checks, for the normal of a penetration, that the two points are in their objects, and on a line along n
 * except for a single contact of faces without a common point. */
static void check_contacts(scene_t *s, const contacts_t *c, const char *what)
{
    const double noise = 4 * rounding(s), slop = effective_slop(s), room = slop + 8 * noise;
    check_heights(s, c, what);
    for (int i = 0; i < c->n; i++) {
        const ccd_contact_t *p = &c->c[i];
        double out = lateral_distance(s, p);
        CHECK(out <= noise || (c->n == 1 && out > slop / 2), "%s: points %g across", what, out);
        out = fmax(distance_outside(&s->a, &p->point1, 20), distance_outside(&s->b, &p->point2, 20));
        CHECK(out <= room, "%s: a point %g outside, slop %g", what, out, s->slop);
    }
}

/* Computes the region of two polytopes, and the distance of the faces for an empty one. Returns 0 where it is
 * ambiguous. */
static int region_of(const scene_t *s, const frame_t *f, polygon_t *region, double *apart)
{
    polygon_t one, two, few;
    int clear = manifold_face(&s->a, f, 1, effective_slop(s), rounding(s), &one) &
                manifold_face(&s->b, f, -1, effective_slop(s), rounding(s), &two);
    /* The library's least slop is that of the vertices which it has evaluated. */
    const double least = fmax(s->slop, 0.01 * depth_along(s));
    clear &= manifold_face(&s->a, f, 1, least, rounding(s), &few) && few.n == one.n;
    clear &= manifold_face(&s->b, f, -1, least, rounding(s), &few) && few.n == two.n;
    region->n = 0;
    if (one.n < 3 && two.n < 3)
        return 0;
    *region = two.n < 3 ? polygon_clip(&two, &one) : polygon_clip(&one, &two);
    *apart = HUGE_VAL;
    for (int i = 0; i < one.n; i++)
        *apart = fmin(*apart, polygon_distance(&two, one.p[i]));
    for (int i = 0; i < two.n; i++)
        *apart = fmin(*apart, polygon_distance(&one, two.p[i]));
    return clear;
}

static unsigned long regions, segments, points, disjoint;

/* Compares the contacts of two polytopes with the exact region. */
static void compare(scene_t *s, const char *what)
{
    const frame_t f = manifold_frame(s->n);
    polygon_t region, found;
    double apart, room = 4 * effective_slop(s) + 64 * rounding(s);
    contacts_t c = contacts_of(s);
    check_contacts(s, &c, what);
    if (!region_of(s, &f, &region, &apart))
        return;
    found = polygon_of(&c, &f);
    if (region.n == 0) {
        if (apart > room) {
            disjoint++;
            CHECK(c.n == 1, "%s: %d contacts of faces %g apart", what, c.n, apart);
            CHECK(fabs(lateral_distance(s, &c.c[0]) / apart - 0.8) <= 0.25, "%s: %g across, faces %g apart", what,
                  lateral_distance(s, &c.c[0]), apart);
        }
        return;
    }
    if (region.n > 2)
        regions++;
    else if (region.n == 2)
        segments++;
    else
        points++;
    CHECK(polygon_difference(&region, &found) <= room, "%s: %g from the region of %d corners, %d found, slop %g", what,
          polygon_difference(&region, &found), region.n, found.n, s->slop);
    if (region.n > 2) {
        const double area = polygon_area(&region), here = polygon_area(&found);
        CHECK(here >= 0 && fabs(area - here) <= 0.01 * area + room * room, "%s: area %g of %g", what, here, area);
    }
}

/* --- scenes: a is below the plane z = 0, b above it; then the scene is moved ---------------- */

static ccd_real_t prism_verts[4][16 * 3];

/* Returns a frustum with k corners at both ends, z = -half and half. */
static shape_t prism(int which, int k, double half)
{
    ccd_real_t *v = prism_verts[which];
    const double top = uniform(0.7, 1.3), turn = uniform(0, 6);
    for (int i = 0; i < k; i++) {
        const double angle = turn + 2 * 3.14159265358979 * (i + uniform(0, 0.8)) / k;
        v[3 * i] = (ccd_real_t)cos(angle);
        v[3 * i + 1] = (ccd_real_t)sin(angle);
        v[3 * i + 2] = (ccd_real_t)-half;
        v[3 * (k + i)] = (ccd_real_t)(top * cos(angle));
        v[3 * (k + i) + 1] = (ccd_real_t)(top * sin(angle));
        v[3 * (k + i) + 2] = (ccd_real_t)half;
    }
    return shape_polytope(v, 2 * k);
}

static shape_t block(int which, double *half)
{
    *half = uniform(0.2, 0.8);
    if (random_below(3) == 0)
        return shape_box(uniform(0.3, 1.2), uniform(0.3, 1.2), *half);
    return prism(which, 3 + random_below(6), *half);
}

/* Makes a block under the plane and one at the origin; returns half of the height of that. */
static double make_blocks(scene_t *s)
{
    double half;
    s->a = block(0, &half);
    shape_move(&s->a, 0, 0, -half);
    s->b = block(1, &half);
    return half;
}

/* Pose of the scene in the world. */
static double scene_rot[9], scene_at[3];

/* Moves the scene into the world and sets its normal. */
static void place(scene_t *s)
{
    shape_turn_by(&s->a, scene_rot, scene_at[0], scene_at[1], scene_at[2]);
    shape_turn_by(&s->b, scene_rot, scene_at[0], scene_at[1], scene_at[2]);
    for (int k = 0; k < 3; k++)
        s->n[k] = (double)(ccd_real_t)scene_rot[3 * k + 2];
}

static void draw_scene_pose(double distance)
{
    for (int k = 0; k < 3; k++)
        scene_at[k] = uniform(-distance, distance);
    rotation_quaternion(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), scene_rot);
}

static void place_randomly(scene_t *s, double distance)
{
    draw_scene_pose(distance);
    place(s);
}

static void yaw(shape_t *s)
{
    double rot[9];
    rotation_about(0, 0, 1, uniform(0, 6.28), rot);
    shape_turn_by(s, rot, 0, 0, 0);
}

static double random_slop(void)
{
    return random_below(8) == 0 ? 0 : pow(10, uniform(single ? -5 : -9, -2.5));
}

static void resting_blocks(void)
{
    static const double up[3] = {0, 0, 1};
    for (int i = 0; i < 4000 / share; i++) {
        const double depth = i % 3 ? uniform(-0.01, 0.05) : uniform(-1, 5) * pow(10, uniform(-7, -2)), angle = uniform(0, 6.28);
        double rot[9];
        scene_t s;
        s.slop = random_slop();
        make_blocks(&s);
        yaw(&s.a);
        yaw(&s.b);
        if (i % 2) { /* tilted, within the slop or more */
            rotation_about(cos(angle), sin(angle), 0, i % 4 == 1 ? s.slop * uniform(0, 3) : pow(10, uniform(-4, -0.3)), rot);
            shape_turn_by(&s.b, rot, 0, 0, 0);
        }
        shape_move(&s.b, uniform(-1, 1), uniform(-1, 1), -depth - support_height(&s.b, up, -1));
        place_randomly(&s, i % 3 ? 1 : 30);
        compare(&s, i % 2 ? "tilted" : "rest");
    }
}

/* Hulls of random points, or boxes, that overlap, with the normal of the least depth. */
static void random_overlaps(void)
{
    for (int i = 0; i < 3000 / share; i++) {
        static ccd_real_t points_of[2][36];
        ccd_penetration_t hit;
        scene_t s;
        s.slop = random_slop();
        for (int k = 0; k < 36; k++) {
            points_of[0][k] = (ccd_real_t)uniform(-1, 1);
            points_of[1][k] = (ccd_real_t)uniform(-1, 1);
        }
        s.a = i % 3 ? shape_polytope(points_of[0], 12) : shape_box(0.5, 0.7, 0.9);
        s.b = i % 2 ? shape_polytope(points_of[1], 12) : shape_box(0.3, 0.8, 0.6);
        shape_move(&s.b, uniform(0, 1.5), 0, 0);
        place_randomly(&s, 1);
        ccd_t ccd = shape_query();
        ccd.epa_tolerance = CCD_REAL(0.0);
        if (OURS(ccdPenetrationProven)(&s.a, &s.b, &ccd, NULL, CCD_WANT_ALL, &hit) != CCD_HIT)
            continue;
        for (int k = 0; k < 3; k++)
            s.n[k] = (double)hit.normal.v[k];
        const double less = (double)hit.depth - pow(10, uniform(single ? -4 : -7, -2));
        if (i % 4) /* less deep: the normal is the same */
            for (int k = 0; k < 3; k++)
                s.b.pos[k] += (ccd_real_t)(less * s.n[k]);
        compare(&s, "random overlap");
    }
}

/* --- round, flat and thin objects, by formula ----------------------------------------------- */

static shape_t at(shape_t s, double x, double y, double z)
{
    shape_move(&s, x, y, z);
    return s;
}

static shape_t table(void) { return at(shape_box(2, 2, 0.5), 0, 0, -0.5); }

static shape_t turned(shape_t s, double x, double y, double z, double angle)
{
    double rot[9];
    rotation_about(x, y, z, angle, rot);
    shape_turn(&s, rot);
    return s;
}

/* Checks that the scene has n contacts, at these positions in its own frame, in any order. */
static void expect(const char *what, shape_t a, shape_t b, int n, const double (*xy)[2])
{
    for (int round = 0; round < 40 / share; round++) {
        scene_t s = {.a = a, .b = b, .slop = pow(10, uniform(single ? -4 : -6, -3))};
        place_randomly(&s, 1);
        /* The normal of a penetration is not exact: turned within the slop. */
        double length2 = 0;
        for (int k = 0; k < 3; k++) {
            s.n[k] += 0.1 * fmin(s.slop, single ? 1e-4 : 1e-6) * uniform(-1, 1);
            length2 += s.n[k] * s.n[k];
        }
        for (int k = 0; k < 3; k++)
            s.n[k] = (double)(ccd_real_t)(s.n[k] / sqrt(length2));
        const double room = 4 * s.slop + 64 * rounding(&s);
        contacts_t c = contacts_of(&s);
        CHECK(c.n == n, "%s: %d contacts, slop %g", what, c.n, s.slop);
        for (int i = 0; i < n; i++) {
            double least = HUGE_VAL;
            ccd_vec3_t expected;
            for (int k = 0; k < 3; k++)
                expected.v[k] = (ccd_real_t)(scene_rot[3 * k] * xy[i][0] + scene_rot[3 * k + 1] * xy[i][1] + scene_at[k]);
            for (int j = 0; j < c.n; j++)
                least = fmin(least, sqrt((double)ccdVec3Dist2(&c.c[j].point1, &expected)));
            CHECK(least <= room, "%s: no contact at %g %g, closest %g, slop %g", what, xy[i][0], xy[i][1], least, s.slop);
        }
        check_contacts(&s, &c, what);
    }
}

/* Pairs of every category with random normals, or with that of a penetration: then every point is within the slop
 * of its object. */
static void categories(void)
{
    for (int i = 0; i < 6000 / share; i++) {
        static pair_t p;
        const int category = i % CATEGORY_COUNT;
        ccd_penetration_t hit;
        scene_t s;
        if (category == CATEGORY_FAR_8 || (single && category == CATEGORY_FAR_6))
            continue;
        category_pair(category, (uint64_t)(i / CATEGORY_COUNT), SHAPE_TIE_SIGN, &p);
        s.a = p.a;
        s.b = p.b;
        s.slop = pow(10, uniform(-4, -2)) * pair_size(&p.a, &p.b);
        if (i % 4 == 0)
            s.slop = 0;
        ccd_t ccd = shape_query();
        ccd.mpr_tolerance = (ccd_real_t)(1e-6 * pair_size(&p.a, &p.b));
        ccd_vec3_t n = random_vec3(1);
        ccdVec3Normalize(&n);
        if (i % 3 == 0)
            ccdVec3Set(&n, i / 3 % 3 == 0, i / 3 % 3 == 1, i / 3 % 3 == 2);
        if (i % 3 == 1 && OURS(ccdPenetration)(&s.a, &s.b, &ccd, NULL, 0, &hit) == CCD_HIT)
            n = hit.normal;
        to_double(&n, s.n);
        contacts_t c = contacts_at_most(&s, 8);
        check_heights(&s, &c, category_text(category));
        for (int k = 0; k < c.n && i % 3 == 1; k++) {
            const double out = fmax(distance_outside(&s.a, &c.c[k].point1, 200), distance_outside(&s.b, &c.c[k].point2, 200));
            CHECK(out <= 1.01 * effective_slop(&s) + 64 * rounding(&s),
                  "%s: %g outside, slop %g, %d contacts", category_text(category), out, s.slop, c.n);
        }
    }
}

static void shapes(void)
{
    static const ccd_real_t square[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, rod[] = {-1, 0, 0, 1, 0, 0}, dot[] = {0, 0, 0};
    const double middle[][2] = {{0, 0}}, ends[][2] = {{-0.5, 0}, {0.5, 0}}, over[][2] = {{1, 0}, {0.2, 0}};
    const double plate[][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, rods[][2] = {{-1, 0}, {1, 0}}, off[][2] = {{0.3, -0.2}};
    const double slant[][2] = {{0, 0}, {-sqrt(1.25), 0}}, shared[][2] = {{-0.2, 0}, {0.5, 0}};
    const shape_t block = at(shape_box(1, 2, 0.5), 0, 0, -0.5);
    const shape_t lying_capsule = turned(shape_capsule(0.3, 0.5), 0, 1, 0, pi / 2);
    const shape_t lying_cylinder = turned(shape_cylinder(0.3, 0.5), 0, 1, 0, pi / 2);

    expect("ball on table", table(), at(shape_sphere(0.5), 0, 0, 0.4999), 1, middle);
    expect("ball on ball", at(shape_sphere(0.5), 0, 0, -0.5), at(shape_sphere(0.3), 0, 0, 0.2999), 1, middle);
    expect("table on ball", at(shape_sphere(0.5), 0, 0, -0.5), at(shape_box(1, 1, 0.5), 0, 0, 0.5), 1, middle);
    expect("ellipsoid", table(), at(shape_ellipsoid(1, 0.6, 0.3), 0.3, -0.2, 0.2999), 1, off);
    expect("flat ellipsoid", table(), at(shape_ellipsoid(1, 1, 0.05), 0.3, -0.2, 0.05), 1, off);
    expect("lying capsule", table(), at(lying_capsule, 0, 0, 0.2999), 2, ends);
    expect("lying capsule over the edge", block, at(lying_capsule, 0.7, 0, 0.3), 2, over);
    expect("capsule on its end", table(), at(shape_capsule(0.3, 0.5), 0.3, -0.2, 0.8), 1, off);
    expect("lying cylinder", table(), at(lying_cylinder, 0, 0, 0.2999), 2, ends);
    expect("cone on its tip", table(), at(turned(shape_cone(0.3, 0.5), 1, 0, 0, pi), 0.3, -0.2, 0.5), 1, off);
    /* half height 0.5, radius 0.5: the slant is sqrt(1.25) long, the apex over the origin */
    expect("lying cone", table(), at(turned(shape_cone(0.5, 0.5), 0, 1, 0, pi / 2 + atan(0.5)),
                                   -0.5 * sin(pi / 2 + atan(0.5)), 0, -0.5 * cos(pi / 2 + atan(0.5))),
           2, slant);
    expect("crossed capsules", at(lying_capsule, 0, 0, -0.3),
           at(turned(shape_capsule(0.2, 0.5), 1, 0, 0, pi / 2), 0, 0, 0.1999), 1, middle);
    expect("parallel capsules", at(lying_capsule, 0, 0, -0.3), at(lying_capsule, 0.3, 0, 0.2999), 2, shared);
    expect("plate on table", table(), shape_polytope(square, 4), 4, plate);
    expect("rod on table", table(), shape_polytope(rod, 2), 2, rods);
    expect("point on table", table(), at(shape_polytope(dot, 1), 0.3, -0.2, 0), 1, off);
    expect("crossed rods", shape_polytope(rod, 2), turned(shape_polytope(rod, 2), 0, 0, 1, 1), 1, middle);
    expect("point on rod", shape_polytope(rod, 2), shape_polytope(dot, 1), 1, middle);
    expect("point on point", shape_polytope(dot, 1), shape_polytope(dot, 1), 1, middle);
    expect("standing plate", table(), at(turned(shape_polytope(square, 4), 1, 0, 0, pi / 2), 0, 0, 1), 2, rods);
    expect("box on its edge", table(), at(turned(shape_box(1, 0.5, 0.5), 1, 0, 0, pi / 4), 0, 0, sqrt(0.5) - 1e-4), 2, rods);
    expect("box on its corner", table(),
           at(turned(shape_box(0.5, 0.5, 0.5), 1, -1, 0, atan(sqrt(2))), 0, 0, sqrt(0.75)), 1, middle);
    expect("edge across edge", at(turned(shape_box(1, 0.5, 0.5), 1, 0, 0, pi / 4), 0, 0, -sqrt(0.5)),
           at(turned(shape_box(0.5, 1, 0.5), 0, 1, 0, pi / 4), 0, 0, sqrt(0.5) - 1e-4), 1, middle);
}

/* Checks that a disc's contacts are on its rim, and enclose most of its area. */
static void discs(void)
{
    for (int i = 0; i < 200 / share; i++) {
        const double radius = uniform(0.3, 1), tilt = i % 2 ? 0 : uniform(0, 0.1), angle = uniform(0, 6.28);
        scene_t s;
        s.slop = pow(10, uniform(single ? -4 : -6, -3));
        s.a = table();
        s.b = i % 3 ? shape_cylinder(radius, 0.5) : shape_cone(radius, 0.5);
        s.b = at(turned(s.b, cos(angle), sin(angle), 0, tilt * s.slop), 0, 0, 0.5);
        place_randomly(&s, 1);
        frame_t f = manifold_frame(s.n);
        contacts_t c = contacts_of(&s);
        check_contacts(&s, &c, "disc");
        polygon_t found = polygon_of(&c, &f);
        const point2_t o = project(&f, s.b.pos);
        for (int j = 0; j < found.n; j++) {
            const double from = (double)hypotl(found.p[j].x - o.x, found.p[j].y - o.y);
            CHECK(fabs(from - radius) <= 4 * s.slop + 64 * rounding(&s), "disc: %g from the axis, radius %g", from, radius);
        }
        CHECK(polygon_area(&found) >= 0.85 * 3.14159 * radius * radius, "disc: area %g of %g, %d points",
              polygon_area(&found), 3.14159 * radius * radius, c.n);
    }
}

/* A round body lies along the edge of a block and turns away from it: its closer end is beyond the edge, where its
 * surface is still within the slop. */
static void along_edges(void)
{
    for (int i = 0; i < 1000 / share; i++) {
        const double x = uniform(0.3, 1.2), y = uniform(0.3, 1.2), radius = uniform(0.1, 0.5), half = uniform(0.1, 0.8);
        const double angle = uniform(0, 0.17), end = uniform(-1, 1) * y;
        double beyond, rot[9];
        scene_t s;
        s.slop = pow(10, uniform(single || i % 2 ? -4 : -7, -3));
        beyond = sqrt(2 * radius * s.slop) * uniform(0, 1);
        s.a = at(shape_box(x, y, 0.5), 0, 0, -0.5);
        s.b = turned(i % 4 < 2 ? shape_cylinder(radius, half) : shape_capsule(radius, half), 1, 0, 0, pi / 2);
        rotation_about(0, 0, 1, -angle, rot);
        shape_turn_by(&s.b, rot, x + beyond + half * sin(angle), end + half * cos(angle), radius - 1e-5);
        place_randomly(&s, 1);
        contacts_t c = contacts_of(&s);
        check_contacts(&s, &c, "along an edge");
    }
}

/* --- the normal's own error ------------------------------------------------------------------ */

/* Slop 0, and a normal turned until the depth along it is 0.1 % more than the least, as that of a penetration may be:
 * an ellipsoid on a face still touches in a point, a box in its edge or face. */
static void imperfect_normals(void)
{
    static const double up[3] = {0, 0, 1};
    for (int i = 0; i < 3000 / share; i++) {
        const double depth = pow(10, uniform(single ? -2 : -3, -1.5)), angle = uniform(0, 6.28);
        const double dir[3] = {cos(angle), sin(angle), 0};
        double rot[9], low = 0, high = 1;
        polygon_t face, floor, found;
        scene_t s;
        s.slop = 0;
        s.a = at(shape_box(uniform(0.8, 1.2), uniform(0.8, 1.2), 0.5), 0, 0, -0.5);
        s.b = i % 3 ? shape_box(uniform(0.2, 0.4), uniform(0.2, 0.4), uniform(0.2, 0.4))
                    : shape_ellipsoid(uniform(0.2, 0.4), uniform(0.2, 0.4), uniform(0.2, 0.4));
        rotation_quaternion(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), rot);
        if (i % 3 == 1) /* on its edge */
            rotation_about(1, 0, 0, uniform(0.4, 1.1), rot);
        if (i % 3 != 2)
            shape_turn(&s.b, rot);
        yaw(&s.b);
        shape_move(&s.b, uniform(-0.3, 0.3), uniform(-0.3, 0.3), 0);
        shape_move(&s.b, (double)s.b.pos[0], (double)s.b.pos[1], -depth - support_height(&s.b, up, -1));
        /* the exact region: b's lowest face, or an ellipsoid's lowest point */
        frame_t f = manifold_frame(up);
        if (i % 3)
            manifold_face(&s.b, &f, -1, 0.1 * depth, rounding(&s), &face);
        else {
            const ccd_vec3_t down = {{0, 0, -1}};
            ccd_vec3_t v;
            shape_support(&s.b, &down, &v);
            face.n = 1;
            face.p[0] = project(&f, v.v);
        }
        manifold_face(&s.a, &f, 1, 0.1 * depth, rounding(&s), &floor);
        face = polygon_clip(&face, &floor);
        for (int j = 0; j < 60; j++) {
            const double t = (low + high) / 2, length = sqrt(1 + t * t);
            for (int k = 0; k < 3; k++)
                s.n[k] = (up[k] + t * dir[k]) / length;
            *(depth_along(&s) < 1.001 * depth ? &low : &high) = t;
        }
        contacts_t c = contacts_of(&s);
        found = polygon_of(&c, &f);
        CHECK(polygon_difference(&face, &found) <= 2e-3, "imperfect: %d contacts, %g from the truth of %d, depth %g", c.n,
              polygon_difference(&face, &found), face.n, depth);
        CHECK(c.n == face.n, "imperfect: %d contacts for %d", c.n, face.n);
        for (int k = 0; k < c.n; k++)
            CHECK(lateral_distance(&s, &c.c[k]) <= 4 * rounding(&s),
                  "imperfect: points %g across", lateral_distance(&s, &c.c[k]));
    }
}

/* --- continuity ------------------------------------------------------------------------------ */

/* Returns whether a segment is within 10 degrees of a side of the face. */
static int is_along_a_side(const polygon_t *f, const polygon_t *face)
{
    int grazing = 0;
    for (int i = 0; i < face->n && f->n == 2; i++) {
        const point2_t p = face->p[i], q = face->p[(i + 1) % face->n], r = f->p[0], t = f->p[1];
        const double across = (double)((q.x - p.x) * (t.y - r.y) - (q.y - p.y) * (t.x - r.x));
        grazing |= fabs(across) < 0.1745 * (double)(hypotl(q.x - p.x, q.y - p.y) * hypotl(t.x - r.x, t.y - r.y));
    }
    return grazing;
}

enum { REST, DRIFT, SLIDE, SPIN, ROLL, ROCK };
static const char *const motion_name[] = {"resting", "drifting", "sliding", "spinning", "rolling", "rocking"};

/* Motion of each frame: b turns about its own center and moves, and so does the world. */
typedef struct {
    double turn[9], by[3], world[9], drift;
} motion_t;

/* Returns the motion of b by `step`, metres or radians, in the plane's direction `heading`. A rolling body has the
 * radius 0.3. */
static motion_t motion_of(int kind, double heading, double step)
{
    const double x = cos(heading), y = sin(heading), moves = kind == SLIDE || kind == ROLL ? step : 0;
    motion_t m = {.by = {moves * x, moves * y, 0}};
    if (kind == ROLL)
        rotation_about(-y, x, 0, step / 0.3, m.turn);
    else if (kind == ROCK)
        rotation_about(x, y, 0, step, m.turn);
    else
        rotation_about(0, 0, 1, kind == SPIN ? step : 0, m.turn);
    return m;
}

static void next_frame(scene_t *s, const motion_t *m)
{
    double old[9], to[3];
    for (int k = 0; k < 3; k++) {
        to[k] = (double)s->b.pos[k] + m->by[k];
        scene_at[k] += m->drift * (k + 1);
    }
    shape_move(&s->b, 0, 0, 0);
    shape_turn_by(&s->b, m->turn, to[0], to[1], to[2]);
    memcpy(old, scene_rot, sizeof old);
    rotation_times(m->world, old, scene_rot);
}

/* Checks that the region moves by no more than the objects and the world. */
static void check_continuity(int kind, scene_t start, double step)
{
    const double axis[3] = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}, heading = kind == ROLL ? 0 : uniform(0, 6.28);
    motion_t m = motion_of(kind, heading, kind == ROCK ? fmin(step, 0.005 * start.slop) : step);
    polygon_t before;
    frame_t f;
    before.n = 0;
    rotation_about(axis[0], axis[1], axis[2], 0.1 * step, m.world);
    for (int frame = 0; frame < 20; frame++) {
        scene_t s = start;
        place(&s);
        /* one coordinate frame for all: the normal hardly turns */
        if (frame == 0)
            f = manifold_frame(s.n);
        contacts_t c = contacts_of(&s);
        check_contacts(&s, &c, motion_name[kind]);
        polygon_t found = polygon_of(&c, &f);
        if (frame > 0) {
            const double allowed = 10 * (2 * step + rounding(&start) + 16 * rounding(&s));
            const double change = fabs(polygon_area(&found) - polygon_area(&before)), far = polygon_difference(&before, &found);
            CHECK(change <= allowed * (polygon_perimeter(&before) + polygon_perimeter(&found)) / 2,
                  "%s by %g: the area changes by %g, %d and %d points, slop %g", motion_name[kind], step, change, before.n,
                  found.n, s.slop);
            const frame_t now = manifold_frame(s.n); /* the exact normal */
            polygon_t face;
            manifold_face(&s.a, &now, 1, effective_slop(&s), rounding(&s), &face);
            CHECK(far <= allowed || is_along_a_side(&before, &face) || is_along_a_side(&found, &face),
                  "%s by %g: the region moves by %g, %d and %d points, slop %g", motion_name[kind], step, far,
                  before.n, found.n, s.slop);
        }
        before = found;
        next_frame(&start, &m);
    }
}

static void motions(void)
{
    for (int i = 0; i < 600 / share; i++) {
        const int kind = SLIDE + i % 4;
        scene_t s;
        double half = make_blocks(&s);
        s.slop = pow(10, uniform(single ? -4 : -7, -3));
        yaw(&s.a);
        if (kind == SPIN && i % 8 == 1) {
            half = 0.4;
            s.b = shape_cylinder(uniform(0.3, 0.8), half);
        }
        if (kind == ROLL) {
            half = 0.3;
            s.b = turned(i % 8 < 4 ? shape_capsule(half, 0.5) : shape_cylinder(half, 0.5), 1, 0, 0, pi / 2);
        }
        shape_move(&s.b, uniform(-0.5, 0.5), uniform(-0.5, 0.5), half - 1e-5);
        if (kind == SLIDE)
            yaw(&s.b);
        draw_scene_pose(0);
        check_continuity(kind, s, pow(10, uniform(single ? -4 : -8, -3)));
    }
}

/* --- the cache ------------------------------------------------------------------------------------ */

/* Moves a body on a table for twenty frames in each of the first `kinds` motions, in one order of the objects and in
 * alternating orders. In all but the first the scene drifts. With the cache half of the support calls are enough, and
 * every contact keeps its id. */
static void check_cache(const char *what, shape_t body, int kinds)
{
    for (int run = 0; run < 2 * kinds; run++) {
        const int kind = run % kinds, swaps = run >= kinds;
        static ccd_manifold_cache_t pair_cache;
        motion_t m = motion_of(kind, kind == ROLL ? pi / 2 : 0.46, kind == SPIN ? 0.02 : 2e-3);
        scene_t start = {.a = table(), .b = body, .slop = 1e-3};
        unsigned long cold = 0, warm = 0;
        contacts_t last;
        memset(&pair_cache, 0, sizeof pair_cache);
        last.n = 0;
        draw_scene_pose(0);
        m.drift = kind == REST ? 0 : 0.05;
        rotation_about(1, 2, -1, kind == REST ? 0 : 0.01, m.world);
        for (int frame = 0; frame < 20; frame++) {
            int same_ids = 0;
            next_frame(&start, &m);
            scene_t s = start;
            place(&s);
            if (swaps && frame % 2) {
                const shape_t a = s.a;
                s.a = s.b;
                s.b = a;
                for (int k = 0; k < 3; k++)
                    s.n[k] = -s.n[k];
            }
            cache = NULL;
            contacts_t none = contacts_at_most(&s, 4);
            cold += s.a.calls + s.b.calls;
            cache = &pair_cache;
            contacts_t c = contacts_at_most(&s, 4);
            if (frame > 0)
                warm += s.a.calls + s.b.calls;
            check_contacts(&s, &c, what);
            CHECK(c.n == none.n, "%s, %s: %d contacts, %d without a cache", what, motion_name[kind], c.n, none.n);
            for (int i = 0; i < c.n; i++) {
                CHECK(c.c[i].id != 0, "%s: no id", what);
                for (int k = 0; k < i; k++)
                    CHECK(c.c[i].id != c.c[k].id, "%s: id twice", what);
                for (int k = 0; k < last.n; k++)
                    same_ids += c.c[i].id == last.c[k].id;
            }
            CHECK(frame == 0 || same_ids == c.n, "%s, %s: %d of %d ids stay", what, motion_name[kind], same_ids, c.n);
            last = c;
        }
        CHECK(2 * warm <= cold, "%s, %s: %lu support calls with a cache, %lu without", what, motion_name[kind], warm, cold);
    }
}

static void caches(void)
{
    check_cache("box", at(turned(shape_box(0.3, 0.2, 0.25), 0, 0, 1, 0.3), 0.1, 0.2, 0.249), 4);
    check_cache("hull", at(prism(1, 6, 0.3), 0.1, 0.2, 0.299), 4);
    check_cache("cylinder", at(shape_cylinder(0.3, 0.25), 0.1, 0.2, 0.249), 4);
    check_cache("cone", at(shape_cone(0.3, 0.25), 0.1, 0.2, 0.249), 4);
    check_cache("capsule", at(turned(shape_capsule(0.3, 0.25), 0, 1, 0, pi / 2), 0.1, 0.2, 0.299), 5);
    check_cache("lying cylinder", at(turned(shape_cylinder(0.3, 0.25), 0, 1, 0, pi / 2), 0.1, 0.2, 0.299), 5);
    check_cache("ball", at(shape_sphere(0.3), 0.1, 0.2, 0.299), 5);
}

/* Tips a block from a corner or an edge onto its face, and up again, with the cache of the last pose. */
static void tipping(void)
{
    static const double tilts[] = {0.3, 0.1, 0.02, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 5e-5, 0, 0, 1e-5, 1e-4, 1e-3, 5e-3, 0.1};
    static const double up[3] = {0, 0, 1};
    for (int i = 0; i < 400 / share; i++) {
        static ccd_manifold_cache_t pair_cache;
        const double angle = i % 3 ? uniform(0, 6.28) : i % 4 * 1.5708, slop = fmax(random_slop(), 64 * real_eps());
        const shape_t block = i % 3 ? prism(1, 3 + random_below(6), 0.4) : shape_box(0.5, 0.7, 0.3);
        memset(&pair_cache, 0, sizeof pair_cache);
        cache = &pair_cache;
        draw_scene_pose(1);
        for (int j = 0; j < (int)(sizeof tilts / sizeof *tilts); j++) {
            scene_t s = {.a = table(), .b = turned(block, cos(angle), sin(angle), 0, tilts[j]), .slop = slop};
            shape_move(&s.b, 0, 0, -1e-4 - support_height(&s.b, up, -1));
            place(&s);
            compare(&s, "tipping");
        }
    }
}

/* Checks that a cache with any content changes no contact. */
static void arbitrary_caches(void)
{
    for (int i = 0; i < 20000 / share; i++) {
        static ccd_manifold_cache_t pair_cache, good;
        unsigned char *bytes = (unsigned char *)&pair_cache;
        scene_t s;
        pair_cache = good;
        s.slop = 1e-3;
        s.a = table();
        s.b = i % 3 == 0   ? at(shape_box(0.5, 0.6, 0.7), 0.1, 0.2, 0.69)
              : i % 3 == 1 ? at(shape_cylinder(0.5, 0.6), 0, 0, 0.59)
                           : at(turned(shape_capsule(0.3, 0.25), 0, 1, 0, 1.5707963267949), 0, 0, 0.29);
        if (i % 64 == 0)
            place_randomly(&s, 1);
        else
            place(&s);
        cache = &pair_cache;
        switch (i % 4) {
        case 0: /* random bytes */
            for (size_t k = 0; k < sizeof pair_cache; k++)
                bytes[k] = (unsigned char)random_below(256);
            break;
        case 1: /* a valid cache with random bits */
            for (int j = 0; j < 1 + i % 7; j++)
                bytes[random_below((int)sizeof pair_cache)] ^= (unsigned char)(1 + random_below(255));
            break;
        case 2: /* NaN and infinity */
            for (int j = 0; j < CCD_MANIFOLD_CACHE_REALS; j++)
                if (random_below(4) == 0)
                    pair_cache.reals[j] = j % 3 ? (float)NAN : j % 2 ? (float)INFINITY : -1e30f;
            break;
        default: break; /* of another pair */
        }
        contacts_t c = contacts_at_most(&s, 8);
        check_contacts(&s, &c, "arbitrary cache");
        CHECK(c.n == (i % 3 == 0 ? 4 : i % 3 == 1 ? 8 : 2), "arbitrary cache: %d contacts", c.n);
        good = pair_cache;
    }
}

/* --- fewer contacts ----------------------------------------------------------------------------- */

/* Checks that fewer contacts are the deepest one and those that enclose most of the area. */
static void fewer_contacts(void)
{
    static const ccd_contact_t none;
    for (int i = 0; i < 300 / share; i++) {
        double last = 0;
        scene_t s;
        const double half = make_blocks(&s);
        s.slop = 1e-4;
        shape_move(&s.b, uniform(-0.3, 0.3), uniform(-0.3, 0.3), half - 0.01);
        yaw(&s.b);
        place_randomly(&s, 1);
        frame_t f = manifold_frame(s.n);
        contacts_t all = contacts_of(&s);
        for (int max = 1; max <= all.n; max++) {
            const contacts_t part = contacts_at_most(&s, max);
            const polygon_t polygon = polygon_of(&part, &f);
            const double area = polygon_area(&polygon);
            CHECK(part.n == max, "%d of at most %d of %d", part.n, max, all.n);
            CHECK(same_bits(&part.c[0], &all.c[0], sizeof all.c[0]), "the first of %d", max);
            CHECK(area >= last - 1e-6, "area %g of %d points, %g before", area, max, last);
            for (int k = max; k < MAX_CONTACTS; k++)
                CHECK(same_bits(&part.c[k], &none, sizeof none), "written beyond max");
            last = area;
        }
    }
}

int main(int argc, char **argv)
{
    static ccd_manifold_cache_t pair_cache;
    share = argc > 1 ? atoi(argv[1]) : share;
    for (int round = 0; round < 3; round++) {
        /* The same scenes without a cache, with that of the last pair, with the pair's own. */
        random_state = 88172645463325252u;
        cache = round ? &pair_cache : NULL;
        runs_twice = round == 2;
        resting_blocks();
        random_overlaps();
        shapes();
        discs();
        if (!round)
            fewer_contacts();
        runs_twice = 0;
        motions();
    }
    categories();
    caches();
    random_state = 88172645463325252u;
    tipping();
    arbitrary_caches();
    cache = NULL;
    along_edges();
    imperfect_normals();
    CHECK(regions > 1000U / share && segments > 10U / share && points > 10U / share && disjoint > 300U / share,
          "too few of a kind");
    return checks_end();
}
