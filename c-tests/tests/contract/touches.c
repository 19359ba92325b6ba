/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Objects that touch: obj1 is below a plane, obj2 above it, and each has points on it. Every call must return a miss,
 * from a cold state and from the state after that. In a grid, features of bodies (faces, edges, corners, plates,
 * segments, points) meet in all ways; then random hulls of points of a coarse grid. Turned by quarters and moved along
 * a dyadic grid the coordinates are exact; turned at random they are rounded.
 *
 *   touches [random pairs] */

#include "check.h"
#include "harness/this_library.h"

enum { MAX_VERTICES = 8, RANDOM_PAIRS = 20000 };

/* A body whose highest points have z = 0. */
typedef struct {
    const char *name;
    int count;
    signed char vertices[MAX_VERTICES][3];
} body_t;

static const body_t bodies[] = {
    {"a point", 1, {{0, 0, 0}}},
    {"a lying segment", 2, {{-1, 0, 0}, {1, 0, 0}}},
    {"a standing segment", 2, {{0, 0, 0}, {0, 0, -2}}},
    {"a leaning segment", 2, {{0, 0, 0}, {1, 1, -1}}},
    {"a lying plate", 4, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}},
    {"a plate on its edge", 4, {{-1, 0, 0}, {1, 0, 0}, {1, 0, -2}, {-1, 0, -2}}},
    {"a plate on its corner", 4, {{0, 0, 0}, {1, 0, -1}, {0, 0, -2}, {-1, 0, -1}}},
    {"a box on its face", 8,
     {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, -2}, {1, -1, -2}, {1, 1, -2}, {-1, 1, -2}}},
    {"a box on its edge", 8,
     {{-1, 0, 0}, {1, 0, 0}, {-1, 1, -1}, {1, 1, -1}, {-1, 0, -2}, {1, 0, -2}, {-1, -1, -1}, {1, -1, -1}}},
    {"a pyramid on its tip", 5, {{0, 0, 0}, {1, 1, -2}, {-1, 1, -2}, {-1, -1, -2}, {1, -1, -2}}},
    {"a tetrahedron on its edge", 4, {{-1, 0, 0}, {1, 0, 0}, {0, 1, -1}, {0, -1, -1}}},
    {"an octahedron on its tip", 6, {{0, 0, 0}, {1, 0, -1}, {0, 1, -1}, {-1, 0, -1}, {0, -1, -1}, {0, 0, -2}}},
};
enum { BODIES = sizeof bodies / sizeof *bodies };

typedef struct {
    shape_t shapes[2];
    ccd_real_t vertices[2][3 * MAX_VERTICES];
    const char *names[2];
    const ccd_vec3_t *plane_normal; /* if both lie in a plane */
} pair_of_touch_t;

/* Adds a vertex, multiplied by the sign of the side: obj2 is turned about the x axis to be above the plane. */
static void add_vertex(pair_of_touch_t *p, int side, double x, double y, double z)
{
    ccd_real_t *v = p->vertices[side] + 3 * p->shapes[side].nverts++;
    v[0] = (ccd_real_t)x;
    v[1] = (ccd_real_t)(side ? -y : y);
    v[2] = (ccd_real_t)(side ? -z : z);
}

/* Makes shapes of the vertices, turns both about the origin and moves them. */
static void place(pair_of_touch_t *p, const double rot[9], const double at[3])
{
    for (int k = 0; k < 2; k++) {
        p->shapes[k] = shape_polytope(p->vertices[k], p->shapes[k].nverts);
        shape_turn(&p->shapes[k], rot);
        shape_move(&p->shapes[k], at[0], at[1], at[2]);
    }
}

/* Returns rotation i of the 24 of a cube: the image of x, and of y. */
static void quarter_turns(int i, double rot[9])
{
    const int x = i % 3, y = (x + 1 + i / 3 % 2) % 3, z = 3 - x - y;
    const int sx = i / 6 % 2 ? -1 : 1, sy = i / 12 % 2 ? -1 : 1, sz = sx * sy * ((y - x + 3) % 3 == 1 ? 1 : -1);
    memset(rot, 0, 9 * sizeof *rot);
    rot[3 * x] = sx;
    rot[3 * y + 1] = sy;
    rot[3 * z + 2] = sz;
}

static unsigned long hits[PAIR_CALL_COUNT];

/* Makes every call, cold and again. */
static void check_all_calls(pair_of_touch_t *p, const char *how)
{
    static const ccd_vec3_t directions[] = {{{1, 0, 0}}, {{0, 0, 1}}, {{CCD_REAL(.5), CCD_REAL(-.3), CCD_REAL(.8)}}};
    ccd_t ccd = shape_query();
    for (int i = 0; i < PAIR_CALL_COUNT; i++) {
        const call_t *call = &call_table[i];
        union {
            ccd_penetration_t penetration;
            ccd_distance_t distance;
        } out;
        ccd_real_t depth;
        ccd_vec3_t dir, pos;
        ccd_warm_t warm;
        if (i == CALL_CONTACTS || (i == CALL_PLANAR && !p->plane_normal))
            continue; /* yields no yes or no; is for bodies in a plane */
        memset(&warm, 0, sizeof warm);
        for (int again = 0; again < 2; again++) {
            const call_args_t args = {.warm = &warm, .want = CCD_WANT_ALL, .depth = &depth, .dir = &dir, .pos = &pos,
                                      .along = i == CALL_PLANAR ? p->plane_normal : &directions[random_below(3)],
                                      .max_distance = HUGE_VAL, .penetration = &out.penetration, .distance = &out.distance};
            const int code = call_library(i, &p->shapes[0], &p->shapes[1], &ccd, &args);
            hits[i] += code != call->miss;
            CHECK(code == call->miss, "%s of %s and %s, %s%s: %d", call->name, p->names[0], p->names[1], how,
                  again ? ", again" : "", code);
        }
    }
}

/* Features of two bodies that meet, in all turns. */
static void check_grid(void)
{
    static const double offsets[][2] = {{0, 0}, {1, 0}, {.5, .25}, {0, -1}, {1, 1}}, places[][3] = {{0, 0, 0}, {-.75, 16, 2.5}};
    pair_of_touch_t p;
    for (int a = 0; a < BODIES; a++)
        for (int b = 0; b < BODIES; b++)
            for (size_t o = 0; o < sizeof offsets / sizeof *offsets; o++) {
                double rot[9];
                memset(&p, 0, sizeof p);
                p.names[0] = bodies[a].name;
                p.names[1] = bodies[b].name;
                for (int k = 0; k < 2; k++)
                    for (int i = 0; i < bodies[k ? b : a].count; i++) {
                        const signed char *v = bodies[k ? b : a].vertices[i];
                        add_vertex(&p, k, v[0] + k * offsets[o][0], v[1] + k * offsets[o][1], v[2]);
                    }
                for (int i = 0; i < 48; i++) {
                    quarter_turns(i % 24, rot);
                    place(&p, rot, places[i / 24]);
                    check_all_calls(&p, "in the grid");
                }
                rotation_quaternion(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), rot);
                place(&p, rot, places[0]);
                check_all_calls(&p, "turned");
            }
}

/* Hulls of random points of a coarse grid; every third pair lies in a plane. */
static void check_random(int pairs)
{
    static const char *const names[] = {"a hull", "a plate"};
    for (int n = 0; n < pairs; n++) {
        pair_of_touch_t p;
        ccd_vec3_t normal;
        double rot[9];
        const int is_planar = n % 3 == 0;
        memset(&p, 0, sizeof p);
        for (int k = 0; k < 2; k++) {
            const int count = 1 + random_below(MAX_VERTICES);
            p.names[k] = names[is_planar];
            for (int i = 0; i < count; i++) {
                /* Flat and pointed bodies: few points are on the plane, or many. */
                const int z = i == 0 || random_below(3) == 0 ? 0 : random_below(5);
                add_vertex(&p, k, .25 * (random_below(9) - 4), is_planar ? 0 : .25 * (random_below(9) - 4), -.25 * z);
            }
        }
        quarter_turns(random_below(24), rot);
        if (n % 2)
            rotation_quaternion(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), rot);
        const double at[3] = {.25 * random_below(9), n % 4 < 2 ? 0 : 32, .125 * random_below(9)};
        place(&p, rot, at);
        for (int i = 0; i < 3; i++)
            normal.v[i] = p.shapes[0].rot[3 * i + 1];
        p.plane_normal = is_planar ? &normal : NULL;
        check_all_calls(&p, n % 2 ? "turned" : "exact");
    }
}

int main(int argc, char **argv)
{
    check_grid();
    check_random(argc > 1 ? atoi(argv[1]) : RANDOM_PAIRS);
    for (int i = 0; i < PAIR_CALL_COUNT; i++)
        if (hits[i])
            printf("%s: %lu hits\n", call_table[i].name, hits[i]);
    return checks_end();
}
