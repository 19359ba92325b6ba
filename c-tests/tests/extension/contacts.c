/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Compares ccdContacts with exact contact regions: boxes and hulls at rest and tilted, edges, corners;
 * round and flat objects by formula. Checks the number of support calls, that the region and the ids move with
 * the objects, and caches with any content.
 *
 *   contacts [N]   one scene in N, for a tool that checks memory */

#include "tests/stability/categories.h"

#include "tests/contract/check.h"
#include "manifold.h"

enum { MAX_CONTACTS = 32 };

static int share = 1; /* one scene in so many */

static const int single = sizeof(ccd_real_t) == sizeof(float);
static const double pi = 3.14159265358979323846;

static ccd_manifold_cache_t pair_cache, *cache; /* NULL: none */

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

/* Returns a lower bound of the distance of a point from a shape; negative inside. */
static double outside(const shape_t *shape, const ccd_vec3_t *p)
{
    shape_t point = shape_sphere(0);
    ccd_distance_t found = {0};
    ccd_t ccd = shape_query();
    ccd.dist_tolerance = 0;
    shape_move(&point, (double)p->v[0], (double)p->v[1], (double)p->v[2]);
    OURS(ccdSignedDistance)(shape, &point, &ccd, 0, 0, (ccd_real_t)HUGE_VAL, NULL, 0, &found);
    return (double)found.distance;
}

/* Checks the depths and that the points are within the slop of the support planes; if the normal is that of a
 * penetration also that they are in their objects, and on a line along n except for a single contact of faces without a
 * common point. */
static void check_contacts(const scene_t *s, const contacts_t *c, int is_penetration, const char *what)
{
    const double noise = 4 * rounding(s), slop = effective_slop(s), room = 1.01 * slop + 16 * noise;
    const double h1 = support_height(&s->a, s->n, 1), h2 = support_height(&s->b, s->n, -1);
    for (int i = 0; i < c->n; i++) {
        const ccd_contact_t *p = &c->c[i];
        const double one = dot(s->n, &p->point1), two = dot(s->n, &p->point2), depth = (double)p->depth;
        CHECK(fabs(one - two - depth) <= noise, "%s: points along n", what);
        CHECK(depth <= h1 - h2 + noise && depth >= h1 - h2 - 2 * room, "%s: depth %g of %g", what, depth, h1 - h2);
        CHECK(i == 0 || p->depth <= c->c[0].depth + (ccd_real_t)noise, "%s: point %d is the deepest", what, i);
        CHECK(fabs(one - h1) <= room && fabs(two - h2) <= room, "%s: %g and %g from the support planes, slop %g", what,
              one - h1, two - h2, s->slop);
        if (!is_penetration)
            continue;
        const double across = lateral_distance(s, p), out = fmax(outside(&s->a, &p->point1), outside(&s->b, &p->point2));
        CHECK(across <= noise || c->n == 1, "%s: points %g across", what, across);
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

static unsigned long seen[4]; /* disjoint faces, points, segments, regions */

/* Compares the contacts of two polytopes along `normal` with the exact region along that of the scene. */
static void compare(const scene_t *scene, const double normal[3], const char *what)
{
    const frame_t f = manifold_frame(scene->n);
    const double room = 4 * effective_slop(scene) + 64 * rounding(scene);
    scene_t s = *scene;
    polygon_t region;
    double apart;
    memcpy(s.n, normal, sizeof s.n);
    const contacts_t c = contacts_of(&s);
    check_contacts(&s, &c, 1, what);
    if (!region_of(scene, &f, &region, &apart) || (region.n == 0 && apart <= room))
        return;
    const polygon_t found = polygon_of(&c, &f);
    seen[region.n < 3 ? region.n : 3]++;
    if (region.n == 0) {
        CHECK(c.n == 1, "%s: %d contacts of faces %g apart", what, c.n, apart);
        CHECK(fabs(lateral_distance(&s, &c.c[0]) / apart - 0.8) <= 0.25, "%s: %g across, faces %g apart", what,
              lateral_distance(&s, &c.c[0]), apart);
        return;
    }
    CHECK(polygon_difference(&region, &found) <= room, "%s: %g from the region of %d corners, %d found, slop %g", what,
          polygon_difference(&region, &found), region.n, found.n, s.slop);
    if (region.n > 2) {
        const double area = polygon_area(&region), here = polygon_area(&found);
        CHECK(here >= 0 && fabs(area - here) <= 0.01 * area + room * room, "%s: area %g of %g", what, here, area);
    }
}

/* --- scenes: a is below the plane z = 0, b above it; then the scene is moved ---------------- */

static const double up[3] = {0, 0, 1};

static shape_t at(shape_t s, double x, double y, double z)
{
    shape_move(&s, x, y, z);
    return s;
}

static shape_t turned(shape_t s, double x, double y, double z, double angle)
{
    double rot[9];
    rotation_about(x, y, z, angle, rot);
    shape_turn_by(&s, rot, 0, 0, 0);
    return s;
}

/* Moves a shape so that its support plane below is at the height z. */
static shape_t above(shape_t s, double x, double y, double z)
{
    shape_move(&s, x, y, 0);
    return at(s, x, y, z - support_height(&s, up, -1));
}

static shape_t table(void) { return at(shape_box(2, 2, 0.5), 0, 0, -0.5); }

static ccd_real_t hull_verts[3][20 * 3];

/* Returns a frustum with k corners at both ends, z = -half and half; with a gap between every other two of its corners, if
 * that is positive. */
static shape_t frustum(int which, int k, double half, double gap)
{
    ccd_real_t *v = hull_verts[which];
    const double top = uniform(0.7, 1.3), turn = uniform(0, 6);
    for (int i = 0; i < k; i++) {
        const double angle = turn + 2 * pi * (i + (gap > 0 ? -(i % 2) * (1 - gap) : uniform(0, 0.8))) / k;
        for (int end = 0; end < 2; end++) {
            v[3 * (i + end * k)] = (ccd_real_t)((end ? top : 1) * cos(angle));
            v[3 * (i + end * k) + 1] = (ccd_real_t)((end ? top : 1) * sin(angle));
            v[3 * (i + end * k) + 2] = (ccd_real_t)(end ? half : -half);
        }
    }
    return shape_polytope(v, 2 * k);
}

/* Returns a hull whose lower face is small and at one end; the other end is higher by `rise`, more than the slop and so little
 * that the tilt towards it finds a corner there: half the tilt finds the face. */
static shape_t boat(int which, double rise)
{
    shape_t s = frustum(which, 3 + random_below(5), 0.4, 0);
    ccd_real_t *v = hull_verts[which] + 3 * s.nverts;
    for (int i = 0; i < s.nverts; i++) {
        hull_verts[which][3 * i] = (ccd_real_t)0.3 * hull_verts[which][3 * i] - (ccd_real_t)0.7;
        hull_verts[which][3 * i + 1] *= (ccd_real_t)0.3;
    }
    for (int i = 0; i < 2; i++, v += 3) {
        v[0] = 1;
        v[1] = (ccd_real_t)(i ? 0.3 : -0.3);
        v[2] = (ccd_real_t)(rise - 0.4);
    }
    return shape_polytope(hull_verts[which], s.nverts + 2);
}

/* Returns a box, hull or boat. */
static shape_t block(int which, double slop)
{
    const double x = uniform(0.3, 1.2), y = uniform(0.3, 1.2), z = uniform(0.2, 0.8);
    const int kind = random_below(4);
    return kind == 0 ? shape_box(x, y, z) : kind == 1 && slop > 1e4 * real_eps() ? boat(which, slop * uniform(1.3, 1.8)) : frustum(which, 3 + random_below(6), z, 0);
}

/* Returns a hull whose lower face is uneven by 0.1 to 10 slops: bevels, scanned meshes. */
static shape_t uneven(int which, double slop)
{
    const double rise = slop * pow(10, uniform(-1, 1)), width = pow(10, uniform(-1, 0));
    ccd_real_t *v = hull_verts[which];
    for (int i = 0; i < 20; i++, v += 3) {
        const double angle = uniform(0, 2 * pi), r = i < 16 ? sqrt(uniform(0, 1)) : 1;
        v[0] = (ccd_real_t)(r * cos(angle));
        v[1] = (ccd_real_t)(width * r * sin(angle));
        v[2] = (ccd_real_t)(i < 16 ? rise * (r * r + uniform(0, 0.2)) - 0.4 : 0.4);
    }
    return shape_polytope(hull_verts[which], 20);
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

static double random_slop(void) { return random_below(5) == 0 ? 0 : pow(10, uniform(single ? -5 : -9, -2.5)); }

/* Uneven hulls on a table and on each other: no point is outside its body by more than the slop. */
static void uneven_faces(void)
{
    for (int i = 0; i < 20000 / share; i++) {
        const double slop = pow(10, uniform(single ? -4 : -6, -2));
        const shape_t b = uneven(1, slop);
        scene_t s = {.slop = slop, .b = above(b, uniform(-1, 1), uniform(-1, 1), -uniform(0, 10) * slop), .a = table()};
        if (i % 2) {
            const shape_t a = turned(uneven(0, slop), 1, 0, 0, pi);
            s.a = at(a, 0, 0, -support_height(&a, up, 1));
        }
        place_randomly(&s, 1);
        const contacts_t c = contacts_of(&s);
        check_contacts(&s, &c, 1, "uneven");
    }
}

/* Blocks that rest on each other, level or tilted, within the slop or more. */
static void resting_blocks(void)
{
    for (int i = 0; i < 4000 / share; i++) {
        scene_t s = {.slop = random_slop()};
        const double depth = i % 3 ? uniform(-0.01, 0.05) : uniform(-1, 5) * pow(10, uniform(-7, -2)), angle = uniform(0, 6.28);
        const double slop = fmax(s.slop, 0.01 * depth), tilt = i % 4 == 1 ? s.slop * uniform(0, 3) : pow(10, uniform(-4, -0.3));
        const shape_t a = turned(block(0, slop), 1, 0, 0, pi), b = turned(block(1, slop), 0, 0, 1, uniform(0, 6.28));
        s.a = at(a, 0, 0, -support_height(&a, up, 1));
        s.b = above(i % 2 ? turned(b, cos(angle), sin(angle), 0, tilt) : b, uniform(-1, 1), uniform(-1, 1), -depth);
        place_randomly(&s, i % 3 ? 1 : 100);
        compare(&s, s.n, i % 2 ? "tilted" : "rest");
    }
}

/* Turns the scene's normal until the depth along it is 0.1 % more, as that of a penetration may be. */
static void turn_normal(const scene_t *s, double normal[3])
{
    const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1), aside[3] = {x, y, z}, depth = depth_along(s);
    double low = 0, high = 1;
    for (int j = 0; j < 60; j++) {
        const double t = (low + high) / 2;
        scene_t other = *s;
        double length2 = 0;
        for (int k = 0; k < 3; k++) {
            other.n[k] = s->n[k] + t * aside[k];
            length2 += other.n[k] * other.n[k];
        }
        for (int k = 0; k < 3; k++)
            other.n[k] /= sqrt(length2);
        *(depth_along(&other) < 1.001 * depth ? &low : &high) = t;
        memcpy(normal, other.n, sizeof other.n);
    }
}

/* Tips a block from a corner or an edge onto its face, and up again, with the cache of the last pose. With a slop of 0 the
 * contacts are the same along a normal that is not exact. */
static void tipping(void)
{
    static const double tilts[] = {0.3, 0.1, 0.02, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 5e-5, 0, 0, 1e-5, 1e-4, 1e-3, 5e-3, 0.1};
    for (int i = 0; i < 400 / share; i++) {
        const double angle = i % 3 ? uniform(0, 6.28) : i % 4 * pi / 2, slop = fmax(random_slop(), 64 * real_eps());
        const shape_t body = i % 3 ? frustum(1, 3 + random_below(6), 0.4, 0) : shape_box(0.5, 0.7, 0.3);
        memset(&pair_cache, 0, sizeof pair_cache);
        draw_scene_pose(1);
        for (size_t j = 0; j < sizeof tilts / sizeof *tilts; j++) {
            const shape_t tipped = turned(body, cos(angle), sin(angle), 0, tilts[j]);
            scene_t s = {.a = table(), .b = above(tipped, 0, 0, -1e-4), .slop = slop}, deeper = s;
            double normal[3];
            place(&s);
            compare(&s, s.n, "tipping");
            deeper.slop = 0;
            deeper.b = above(tipped, 0, 0, -pow(10, uniform(single ? -2 : -3, -1.5)));
            place(&deeper);
            turn_normal(&deeper, normal);
            if (tilts[j] == 0 || tilts[j] >= 0.1) /* else the face depends on the normal */
                compare(&deeper, normal, "imperfect normal");
        }
    }
}

/* Hulls of random points, or boxes, that overlap, with the normal of the least depth. */
static void random_overlaps(void)
{
    for (int i = 0; i < 3000 / share; i++) {
        ccd_penetration_t hit;
        scene_t s = {.slop = random_slop()};
        for (int k = 0; k < 36; k++) {
            hull_verts[0][k] = (ccd_real_t)uniform(-1, 1);
            hull_verts[1][k] = (ccd_real_t)uniform(-1, 1);
        }
        s.a = i % 3 ? shape_polytope(hull_verts[0], 12) : shape_box(0.5, 0.7, 0.9);
        s.b = at(i % 2 ? shape_polytope(hull_verts[1], 12) : shape_box(0.3, 0.8, 0.6), uniform(0, 1.5), 0, 0);
        place_randomly(&s, 1);
        ccd_t ccd = shape_query();
        ccd.epa_tolerance = CCD_REAL(0.0);
        if (OURS(ccdPenetrationProven)(&s.a, &s.b, &ccd, NULL, CCD_WANT_ALL, &hit) != CCD_HIT)
            continue;
        to_double(&hit.normal, s.n);
        if (i % 4) /* less deep: the normal is the same */
            shape_shift(&s.b, (double)hit.depth - pow(10, uniform(single ? -4 : -7, -2)), s.n);
        compare(&s, s.n, "random overlap");
    }
}

/* --- round, flat and thin objects, by formula ----------------------------------------------- */

/* Checks that the scene has n contacts, at these positions in its own frame, in any order; or, if n is 0, that they are on the
 * rim of a disc of radius 0.5 about the origin and enclose most of its area. */
static void expect(const char *what, shape_t a, shape_t b, int n, const double (*xy)[2])
{
    for (int round = 0; round < 40 / share; round++) {
        scene_t s = {.a = a, .b = b, .slop = pow(10, uniform(single ? -4 : -6, -3))};
        place_randomly(&s, 1);
        const frame_t f = manifold_frame(s.n);
        const double room = 4 * s.slop + 64 * rounding(&s), disc = 0.25 * pi;
        /* The normal of a penetration is not exact: turned within the slop. */
        for (int k = 0; k < 3; k++)
            s.n[k] += 0.1 * fmin(s.slop, single ? 1e-4 : 1e-6) * uniform(-1, 1);
        const double length = sqrt(truth_dot3(s.n, s.n));
        for (int k = 0; k < 3; k++)
            s.n[k] = (double)(ccd_real_t)(s.n[k] / length);
        const contacts_t c = contacts_of(&s);
        const polygon_t found = polygon_of(&c, &f);
        check_contacts(&s, &c, 1, what);
        CHECK(n ? c.n == n || (single && c.n == n + 1) : polygon_area(&found) >= 0.85 * disc, "%s: %d contacts, area %g, slop %g", what, c.n, polygon_area(&found), s.slop);
        for (int i = 0; i < (n ? n : c.n); i++) {
            double least = HUGE_VAL, from[3];
            for (int j = 0; j < c.n; j++) {
                const ccd_vec3_t *p = &c.c[n ? j : i].point1;
                for (int k = 0; k < 3; k++)
                    from[k] = (double)p->v[k] - scene_at[k] - (n ? scene_rot[3 * k] * xy[i][0] + scene_rot[3 * k + 1] * xy[i][1] : 0);
                least = fmin(least, fabs(sqrt(truth_dot3(from, from)) - (n ? 0 : 0.5)));
            }
            CHECK(least <= room, "%s: contact %d is %g aside, slop %g", what, i, least, s.slop);
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

    expect("cylinder", table(), at(shape_cylinder(0.5, 0.5), 0, 0, 0.4999), 0, NULL);
    expect("cone", table(), at(shape_cone(0.5, 0.5), 0, 0, 0.4999), 0, NULL);
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
        const contacts_t c = contacts_at_most(&s, 8);
        check_contacts(&s, &c, i % 3 == 1, category_text(category));
    }
}

/* --- motions, with and without the cache ----------------------------------------------------- */

enum { REST, DRIFT, SLIDE, SPIN, ROCK, ROLL };
static const char *const motion_name[] = {"resting", "drifting", "sliding", "spinning", "rocking", "rolling"};

/* Moves b by `step`, metres or radians, about its own center and along the plane; and the world. A rolling body has the
 * radius 0.3 and lies along x. */
static void next_frame(scene_t *s, int kind, double step, double drift, double world)
{
    const double heading = kind == ROLL ? pi / 2 : 0.46, x = cos(heading), y = sin(heading), moves = kind == SLIDE || kind == ROLL ? step : 0;
    const double to[3] = {(double)s->b.pos[0] + moves * x, (double)s->b.pos[1] + moves * y, (double)s->b.pos[2]};
    double rot[9], old[9];
    rotation_about(kind == ROLL ? -y : kind == ROCK ? x : 0, kind == ROLL ? x : kind == ROCK ? y : 0, kind == SPIN,
                   kind == ROLL ? step / 0.3 : step, rot);
    shape_move(&s->b, 0, 0, 0);
    shape_turn_by(&s->b, rot, to[0], to[1], to[2]);
    for (int k = 0; k < 3; k++)
        scene_at[k] += drift * (k + 1);
    memcpy(old, scene_rot, sizeof old);
    rotation_about(1, 2, -1, world, rot);
    rotation_times(rot, old, scene_rot);
}

/* Returns the contacts' polygon in the scene's own frame. */
static polygon_t polygon_in_scene(const contacts_t *c)
{
    polygon_t p = {.n = c->n};
    for (int i = 0; i < c->n; i++) {
        truth_real xy[2] = {0, 0};
        for (int k = 0; k < 3; k++)
            for (int m = 0; m < 2; m++)
                xy[m] += (truth_real)scene_rot[3 * k + m] * ((truth_real)c->c[i].point1.v[k] - scene_at[k]);
        p.p[i].x = xy[0];
        p.p[i].y = xy[1];
    }
    return p;
}

/* Moves a body on the ground for twenty frames in each of the first `kinds` motions, in one order of the objects and in
 * alternating orders; in steps of any size with a cold query, whose region moves by no more than the body and the world; and in
 * large steps with the cache in a scene that drifts. With that half of the support calls are enough, and every contact keeps
 * its id and moves as the body does. */
static void check_moving(const char *what, shape_t ground, shape_t body, int kinds)
{
    const int is_sharp = body.type == SHAPE_BOX || body.type == SHAPE_POLYTOPE;
    for (int run = 0; run < 4 * kinds; run++) {
        const int kind = run % kinds, swaps = run / kinds % 2, any = run / kinds / 2;
        if (kind == ROCK && !is_sharp)
            continue;
        scene_t start = {.a = ground, .b = body, .slop = any && !single ? pow(10, uniform(-7, -3)) : 1e-3};
        const double size = any ? pow(10, uniform(single ? -4 : -8, -3)) : kind == SPIN ? 0.02 : 2e-3;
        const double step = kind == ROCK ? fmin(size, 0.005 * start.slop) : kind < SLIDE ? 0 : size;
        const double drift = any || kind == REST ? 0 : 0.05, world = any ? 0.1 * step : kind == REST ? 0 : 0.01;
        unsigned long cold = 0, warm = 0;
        contacts_t last = {.n = 0};
        polygon_t before = {.n = 0}, last_at = {.n = 0};
        memset(&pair_cache, 0, sizeof pair_cache);
        draw_scene_pose(0);
        for (int frame = 0; frame < 20; frame++) {
            int same_ids = 0;
            next_frame(&start, kind, step, drift, world);
            scene_t s = start;
            place(&s);
            const double allowed = 10 * (2 * step + rounding(&start) + 16 * rounding(&s));
            if (swaps && frame % 2) {
                const shape_t a = s.a;
                s.a = s.b;
                s.b = a;
                for (int k = 0; k < 3; k++)
                    s.n[k] = -s.n[k];
            }
            cache = NULL;
            const contacts_t full = contacts_at_most(&s, MAX_CONTACTS), none = contacts_at_most(&s, 4);
            const polygon_t now = polygon_in_scene(&full);
            cold += s.a.calls + s.b.calls;
            CHECK(frame == 0 || !any || polygon_difference(&before, &now) <= allowed, "%s, %s by %g: the region moves by %g", what,
                  motion_name[kind], step, polygon_difference(&before, &now));
            before = now;
            cache = &pair_cache;
            const contacts_t c = contacts_at_most(&s, 4);
            const polygon_t here = polygon_in_scene(&c);
            warm += frame > 0 ? s.a.calls + s.b.calls : 0;
            check_contacts(&s, &c, 1, what);
            CHECK(c.n == none.n, "%s, %s: %d contacts, %d without a cache", what, motion_name[kind], c.n, none.n);
            for (int i = 0; i < c.n; i++) {
                CHECK(c.c[i].id != 0, "%s: no id", what);
                for (int k = 0; k < i; k++)
                    CHECK(c.c[i].id != c.c[k].id, "%s: id twice", what);
                for (int k = 0; k < last.n; k++)
                    if (c.c[i].id == last.c[k].id) {
                        const double moved = (double)hypotl(here.p[i].x - last_at.p[k].x, here.p[i].y - last_at.p[k].y);
                        CHECK(moved <= 1.2 * step + start.slop + 0.5 * world, "%s, %s by %g: an id moves by %g", what, motion_name[kind], step, moved);
                        same_ids++;
                    }
            }
            CHECK(frame == 0 || same_ids == c.n || (single && kind == ROCK), "%s, %s: %d of %d ids stay", what, motion_name[kind], same_ids, c.n);
            CHECK(frame == 0 || kind == ROCK || !is_sharp || c.c[0].id == last.c[0].id, "%s, %s: the first id stays", what, motion_name[kind]);
            last = c;
            last_at = here;
        }
        CHECK(2 * warm <= cold, "%s, %s: %lu support calls with a cache, %lu without", what, motion_name[kind], warm, cold);
    }
}

static void motions(void)
{
    const shape_t lying_capsule = turned(shape_capsule(0.3, 0.25), 0, 1, 0, pi / 2), lying_can = turned(shape_cylinder(0.3, 0.25), 0, 1, 0, pi / 2);
    const shape_t box = turned(shape_box(0.3, 0.2, 0.25), 0, 0, 1, 0.3), ledge = at(shape_box(0.4, 2, 0.5), -0.3, 0, -0.5);
    for (int i = 0; i < 8 / (share > 8 ? 8 : share); i++) {
        check_moving("box", table(), above(box, 0.1, 0.2, -1e-3), 5);
        check_moving("hull", table(), above(frustum(1, 6, 0.3, 0), 0.1, 0.2, -1e-3), 5);
        check_moving("hull with close corners", table(), above(frustum(1, 8, 0.3, 0.06), 0.1, 0.2, -1e-3), 5);
        check_moving("cylinder", table(), above(shape_cylinder(0.3, 0.25), 0.1, 0.2, -1e-3), 4);
        check_moving("cone", table(), above(shape_cone(0.3, 0.25), 0.1, 0.2, -1e-3), 4);
        check_moving("capsule", table(), above(lying_capsule, 0.1, 0.2, -1e-3), 6);
        check_moving("lying cylinder", table(), above(lying_can, 0.1, 0.2, -1e-3), 6);
        check_moving("ball", table(), above(shape_sphere(0.3), 0.1, 0.2, -1e-3), 6);
        check_moving("box on a ledge", ledge, above(box, 0.1, 0.2, -1e-3), 3);
        check_moving("capsule on a ledge", ledge, above(lying_capsule, 0.1, 0.2, -1e-3), 3);
    }
}

/* Checks that a cache with any content changes no contact. */
static void arbitrary_caches(void)
{
    const shape_t bodies[] = {at(shape_box(0.5, 0.6, 0.7), 0.1, 0.2, 0.69), at(shape_cylinder(0.5, 0.6), 0, 0, 0.59),
                              at(turned(shape_capsule(0.3, 0.25), 0, 1, 0, pi / 2), 0, 0, 0.29)};
    static const int counts[] = {4, 8, 2};
    ccd_manifold_cache_t good = {{0}, {0}, 0};
    for (int i = 0; i < 20000 / share; i++) {
        unsigned char *bytes = (unsigned char *)&pair_cache;
        scene_t s = {.a = table(), .b = bodies[i % 3], .slop = 1e-3};
        if (i % 64 == 0)
            draw_scene_pose(1);
        place(&s);
        pair_cache = good; /* of another pair */
        for (size_t k = 0; k < sizeof pair_cache && i % 4 == 0; k++) /* random bytes */
            bytes[k] = (unsigned char)random_below(256);
        for (int k = 0; k < 1 + i % 7 && i % 4 == 1; k++) /* random bits */
            bytes[random_below((int)sizeof pair_cache)] ^= (unsigned char)(1 + random_below(255));
        for (int k = 0; k < CCD_MANIFOLD_CACHE_REALS && i % 4 == 2; k++)
            if (random_below(4) == 0)
                pair_cache.reals[k] = k % 3 ? (float)NAN : k % 2 ? (float)INFINITY : -1e30f;
        const contacts_t c = contacts_at_most(&s, 8);
        check_contacts(&s, &c, 1, "arbitrary cache");
        CHECK(c.n == counts[i % 3], "arbitrary cache: %d contacts", c.n);
        good = pair_cache;
    }
}

/* --- fewer contacts ----------------------------------------------------------------------------- */

/* Returns the largest area of `max` corners of a polygon, with the first. */
static double largest_area(const polygon_t *all, int max)
{
    double best = 0;
    for (int set = 1; set < 1 << all->n; set += 2) {
        polygon_t part = {.n = 0};
        for (int i = 0; i < all->n; i++)
            if (set >> i & 1)
                part.p[part.n++] = all->p[i];
        best = part.n == max ? fmax(best, polygon_area(&part)) : best;
    }
    return best;
}

/* Checks that fewer contacts are the deepest one and those that enclose most of the area. */
static void fewer_contacts(void)
{
    static const ccd_contact_t none;
    for (int i = 0; i < 300 / share; i++) {
        scene_t s = {.slop = 1e-4};
        const shape_t a = block(0, 0), b = turned(block(1, 0), 0, 0, 1, uniform(0, 6.28));
        s.a = at(a, 0, 0, -support_height(&a, up, 1));
        s.b = above(b, uniform(-0.3, 0.3), uniform(-0.3, 0.3), -0.01);
        place_randomly(&s, 1);
        const frame_t f = manifold_frame(s.n);
        const contacts_t all = contacts_of(&s);
        const polygon_t region = polygon_of(&all, &f);
        for (int max = 1; max <= all.n; max++) {
            const contacts_t part = contacts_at_most(&s, max);
            const polygon_t polygon = polygon_of(&part, &f);
            CHECK(part.n == max, "%d of at most %d of %d", part.n, max, all.n);
            CHECK(same_bits(&part.c[0], &all.c[0], sizeof all.c[0]), "the first of %d", max);
            CHECK(all.n > 12 || polygon_area(&polygon) >= 0.9 * largest_area(&region, max), "area %g of %d points, %g possible",
                  polygon_area(&polygon), max, largest_area(&region, max));
            for (int k = max; k < MAX_CONTACTS; k++)
                CHECK(same_bits(&part.c[k], &none, sizeof none), "written beyond max");
        }
    }
}

int main(int argc, char **argv)
{
    share = argc > 1 ? atoi(argv[1]) : share;
    for (int round = 0; round < 3; round++) {
        /* The same scenes without a cache, with that of the last pair, with the pair's own. */
        random_state = 88172645463325252u;
        cache = round ? &pair_cache : NULL;
        runs_twice = round == 2;
        resting_blocks();
        random_overlaps();
        shapes();
        if (!round)
            fewer_contacts();
    }
    runs_twice = 0;
    tipping();
    categories();
    arbitrary_caches();
    motions();
    uneven_faces();
    for (int i = 0; i < 4; i++)
        CHECK(seen[i] > (i % 3 ? 10U : 300U) / (unsigned)share, "too few of a kind: %lu", seen[i]);
    return checks_end();
}
