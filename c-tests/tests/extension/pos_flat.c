/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks `pos` of bodies of a quarter metre that are flatter than their size, or lean by a fraction of a degree, on a floor:
 *
 *   pos_flat lying [N SEED]    Bars with a flat elliptic underside, smooth and as prisms, in N poses: pos is on the middle of
 *                              their axis by symmetry. And turning about the vertical by 0.01 degrees a step, from N / 10.
 *   pos_flat leaning [N SEED]  Discs, cones and half balls on their rims, where the direction of the lean turns by 0.01 degrees a
 *                              step, for N steps: seen from the body pos must not move, and be the center of pressure of its
 *                              round face, a sum over strips.
 *   pos_flat axes [N SEED]     N pairs turned by 2e-7 rad across the plane at which the axes of a contact change: seen from the
 *                              floor pos must not move. */

#include "harness/this_library.h"
#include "harness/truth.h"
#include "tests/contract/check.h"

static const int single = sizeof(ccd_real_t) == sizeof(float);
static const double pi = 3.14159265358979323846, SIZE = 0.1; /* metres */
static const double STEP = 1.7453292519943295e-4;            /* radians */

enum { BAR, PRISM, DISC, CONE, HALF_BALL, FLOOR, ROUNDED_BOX, MAX_SIDES = 64 };

/* Bars and prisms are along y, the others along z. */
typedef struct {
    int kind, sides;
    double x, y, z, margin; /* half lengths, radii */
    double corner[MAX_SIDES][2];
    double rot[9], pos[3];
} body_t;

/* Finds the point of a body farthest along d, in its frame. */
static void farthest(const body_t *b, const double d[3], double out[3])
{
    const double across = hypot(d[0], d[1]), wide = hypot(b->x * d[0], b->z * d[2]), length = sqrt(across * across + d[2] * d[2]);
    const double rim[2] = {across > 0 ? d[0] / across : 1, across > 0 ? d[1] / across : 0};
    const double end[3] = {copysign(b->x, d[0]), copysign(b->y, d[1]), copysign(b->z, d[2])};
    memcpy(out, end, sizeof end);
    if (b->kind == BAR) {
        out[0] = wide > 0 ? b->x * b->x * d[0] / wide : 0;
        out[2] = wide > 0 ? b->z * b->z * d[2] / wide : b->z;
    } else if (b->kind == PRISM) {
        int best = 0;
        for (int i = 1; i < b->sides; i++)
            if (b->corner[i][0] * d[0] + b->corner[i][1] * d[2] > b->corner[best][0] * d[0] + b->corner[best][1] * d[2])
                best = i;
        out[0] = b->corner[best][0];
        out[2] = b->corner[best][1];
    } else if (b->kind == DISC || b->kind == CONE) {
        const int tip = b->kind == CONE && 2 * b->z * d[2] > b->x * across;
        out[0] = tip ? 0 : b->x * rim[0];
        out[1] = tip ? 0 : b->x * rim[1];
        out[2] = tip || (b->kind == DISC && d[2] > 0) ? b->z : -b->z;
    } else if (b->kind == HALF_BALL) {
        const int round = d[2] > 0;
        out[0] = b->x * (round ? d[0] / length : rim[0]);
        out[1] = b->x * (round ? d[1] / length : rim[1]);
        out[2] = round ? b->x * d[2] / length : 0;
    }
    for (int i = 0; i < 3; i++)
        out[i] += b->margin * d[i] / length;
}

static void apply(const double rot[9], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = rot[3 * i] * v[0] + rot[3 * i + 1] * v[1] + rot[3 * i + 2] * v[2];
}

static void apply_inverse(const double rot[9], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = rot[i] * v[0] + rot[3 + i] * v[1] + rot[6 + i] * v[2];
}

static void body_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const body_t *b = (const body_t *)obj;
    const double d[3] = {(double)dir->v[0], (double)dir->v[1], (double)dir->v[2]};
    double local[3], v[3];
    apply_inverse(b->rot, d, local);
    farthest(b, local, v);
    apply(b->rot, v, local);
    for (int i = 0; i < 3; i++)
        out->v[i] = (ccd_real_t)(local[i] + b->pos[i]);
}

static void body_center(const void *obj, ccd_vec3_t *out)
{
    const body_t *b = (const body_t *)obj;
    const double inside[3] = {0, 0, b->kind == HALF_BALL ? b->x / 4 : 0};
    double v[3];
    apply(b->rot, inside, v);
    for (int i = 0; i < 3; i++)
        out->v[i] = (ccd_real_t)(v[i] + b->pos[i]);
}

/* Makes the mesh of an elliptic bar: `on_edge`, or with a face below. */
static body_t prism(int sides, double flatness, int on_edge)
{
    body_t b = {.kind = PRISM, .sides = sides, .y = SIZE};
    const double first = on_edge ? 0 : pi / sides, lowest = -flatness * SIZE * cos(first);
    for (int i = 0; i < sides; i++) {
        const double angle = 2 * pi * i / sides + first - pi / 2;
        b.corner[i][0] = SIZE * cos(angle);
        b.corner[i][1] = fmax(flatness * SIZE * sin(angle), lowest);
    }
    return b;
}

/* Places a turned body on a floor whose top is the plane z = 0, `depth` deep at (x, y); then turns both by `world`. Returns in
 * `pos` the contact position relative to (x, y), seen from the floor. */
static int position(body_t b, const double rot[9], double depth, const double at[2], const double world[9], ccd_warm_t *warm, double pos[3])
{
    static const double down[3] = {0, 0, -1}, below[3] = {0, 0, -0.5};
    body_t floor = {.kind = FLOOR, .x = 1.5, .y = 1.5, .z = 0.5};
    double local[3], low[3], v[3];
    ccd_penetration_t p;
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = body_support;
    ccd.center1 = ccd.center2 = body_center;
    ccd.mpr_tolerance = (ccd_real_t)(single ? 1e-5 : 1e-7);
    apply_inverse(rot, down, local);
    farthest(&b, local, v);
    apply(rot, v, low);
    const double place[3] = {at[0], at[1], -depth - low[2]};
    apply(world, place, b.pos);
    rotation_times(world, rot, b.rot);
    apply(world, below, floor.pos);
    memcpy(floor.rot, world, sizeof floor.rot);
    if (OURS(ccdPenetration)(&floor, &b, &ccd, warm, CCD_WANT_POS, &p) != CCD_HIT)
        return 0;
    for (int i = 0; i < 3; i++)
        v[i] = (double)p.pos.v[i];
    apply_inverse(world, v, pos);
    pos[0] -= at[0];
    pos[1] -= at[1];
    return 1;
}

typedef struct { double square, worst, jump; long count; } seen_t;

static void random_world(double rot[9])
{
    double q[4];
    uniform_rotation(q);
    rotation_quaternion(q[0], q[1], q[2], q[3], rot);
}

/* Returns the distance of the center of pressure of a leaning body from its center, on the floor: that of the part of its round
 * face that is below the floor. 0 for a lying one, by symmetry. */
static double pressure_center(const body_t *b, double lean, double depth)
{
    const int strips = 2000;
    double volume = 0, moment = 0;
    if (lean == 0)
        return 0;
    for (int i = 0; i < strips; i++) {
        const double x = b->x * (2 * (i + 0.5) / strips - 1), below = fmax(depth - (b->x - x) * sin(lean), 0);
        volume += below * sqrt(b->x * b->x - x * x);
        moment += below * sqrt(b->x * b->x - x * x) * x;
    }
    return (volume > 0 ? moment / volume : b->x) * cos(lean) - (b->kind == HALF_BALL ? 0 : b->z) * sin(lean);
}

/* Turns the direction of a lean, or a lying body, about the vertical by 0.01 degrees a step. Sees how far pos is from the center
 * of pressure, and the largest move in a step, both in the frame that turns. */
static void turn(const body_t *b, double lean, double depth, int steps, int is_warm, seen_t *seen)
{
    const double first = uniform(-pi, pi), at[2] = {uniform(-0.5, 0.5), uniform(-0.5, 0.5)}, center = pressure_center(b, lean, depth);
    double world[9], tip[9], last[2] = {0, 0};
    ccd_warm_t warm;
    memset(&warm, 0, sizeof warm);
    random_world(world);
    rotation_about(0, 1, 0, lean, tip);
    for (int k = 0; k < steps; k++) {
        double yaw[9], rot[9], pos[3], own[3];
        rotation_about(0, 0, 1, first + k * STEP, yaw);
        rotation_times(yaw, tip, rot);
        CHECK(position(*b, rot, depth, at, world, is_warm ? &warm : NULL, pos), "body %d, lean %g, depth %g: no hit", b->kind, lean, depth);
        apply_inverse(yaw, pos, own);
        if (k > 0)
            seen->jump = fmax(seen->jump, hypot(own[0] - last[0], own[1] - last[1]));
        const double off = hypot(own[0] - center, own[1]);
        seen->square += off * off;
        seen->worst = fmax(seen->worst, off);
        seen->count++;
        memcpy(last, own, sizeof last);
    }
}

static double rms(const seen_t *s) { return sqrt(s->square / (double)s->count); }

/* --- lying bars --------------------------------------------------------------------------------- */

static void check_bar(const char *name, const body_t *b, double flatness, double depth, int poses, double max_rms, double max_jump)
{
    seen_t seen = {0}, turning = {0};
    if (single && depth < 1e-3)
        return;
    for (int k = 0; k < poses; k++) {
        turn(b, 0, depth, 1, 0, &seen);
        if (k % 10 == 0)
            turn(b, 0, depth, 100, 0, &turning);
    }
    printf("%-18s half axes 1 : %-5g %g m deep: rms %6.2f mm, worst %6.2f, largest step %6.2f\n", name, flatness, depth, 1e3 * rms(&seen),
           1e3 * fmax(seen.worst, turning.worst), 1e3 * turning.jump);
    CHECK(1e3 * rms(&seen) <= max_rms && 1e3 * turning.jump <= max_jump, "%s, 1 : %g, %g deep", name, flatness, depth);
}

static void check_lying(int poses)
{
    static const double flatness[] = {0.02, 0.05, 0.1, 0.2, 0.5, 1};
    /* The mesh of a bar has as much of it below as fits between two of its edges. */
    static const struct { int sides, on_edge; double flatness, depth, max_rms, max_jump; } prisms[] = {
        {32, 1, 0.2, 1e-4, 1, 10}, {16, 1, 0.4, 1e-3, 2, 20}, {8, 1, 0.2, 1e-3, 2, 15}, {32, 0, 0.2, 1e-4, 8, 25}};
    for (size_t i = 0; i < sizeof flatness / sizeof *flatness; i++)
        for (double depth = 1e-5; depth < 2e-3; depth *= 10) {
            const body_t bar = {.kind = BAR, .x = SIZE, .y = SIZE, .z = flatness[i] * SIZE};
            check_bar("bar", &bar, flatness[i], depth, poses, 11, 30);
        }
    for (size_t i = 0; i < sizeof prisms / sizeof *prisms; i++) {
        const body_t mesh = prism(prisms[i].sides, prisms[i].flatness, prisms[i].on_edge);
        char name[40];
        snprintf(name, sizeof name, "%d sides, on %s", prisms[i].sides, prisms[i].on_edge ? "an edge" : "a face");
        check_bar(name, &mesh, prisms[i].flatness, prisms[i].depth, poses, prisms[i].max_rms, prisms[i].max_jump);
    }
}

/* --- leaning bodies ------------------------------------------------------------------------------ */

static void check_leaning(int steps)
{
    static const struct { const char *name; body_t body; } bodies[] = {
        {"disc", {.kind = DISC, .x = 0.125, .z = 0.1}},
        {"flat disc", {.kind = DISC, .x = 0.125, .z = 0.01}},
        {"cone", {.kind = CONE, .x = 0.125, .z = 0.1}},
        {"half ball", {.kind = HALF_BALL, .x = 0.125}}};
    static const double leans[] = {1e-4, 3e-4, 6e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1};
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++)
        for (int is_warm = 0; is_warm < 2; is_warm++) {
            seen_t all = {0};
            double lean_of = 0, depth_of = 0;
            for (size_t m = 0; m < sizeof leans / sizeof *leans; m++)
                for (double depth = single ? 1e-3 : 1e-5; depth < 2e-2; depth *= 10) {
                    const double before = all.jump;
                    for (int k = 0; k < 4; k++)
                        turn(&bodies[i].body, leans[m], depth, steps / 4, is_warm, &all);
                    if (all.jump > before) {
                        lean_of = leans[m];
                        depth_of = depth;
                    }
                }
            printf("%-10s %s: rms %5.2f mm, worst %5.2f, largest step %6.2f, leaning by %g rad, %g m deep\n", bodies[i].name,
                   is_warm ? "warm" : "cold", 1e3 * rms(&all), 1e3 * all.worst, 1e3 * all.jump, lean_of, depth_of);
            CHECK(1e3 * fmax(all.jump, all.worst) <= 6, "%s", bodies[i].name);
        }
}

/* --- where the axes of a contact change ---------------------------------------------------------- */

static void check_axes(int pairs)
{
    /* The axes of a contact are a fixed pair turned from this direction, or its opposite, to the normal. */
    static const double pole[3] = {0.36, 0.48, 0.8};
    static const struct { const char *name; body_t body; double tip, lean; } bodies[] = {
        {"cylinder standing", {.kind = DISC, .x = 0.125, .z = 0.1}, 0, 0},
        {"cylinder leaning", {.kind = DISC, .x = 0.125, .z = 0.1}, 0, 1e-3},
        {"cylinder lying", {.kind = DISC, .x = 0.125, .z = 0.1}, 90, 0},
        {"cone standing", {.kind = CONE, .x = 0.125, .z = 0.1}, 0, 0},
        {"cone on its side", {.kind = CONE, .x = 0.125, .z = 0.1}, 122.005383208084, 0},
        {"rounded box", {.kind = ROUNDED_BOX, .x = 0.125, .y = 0.125, .z = 0.1, .margin = 0.02}, 0, 0},
        {"bar lying", {.kind = BAR, .x = SIZE, .y = SIZE, .z = 0.02}, 0, 0}};
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
        seen_t seen = {0};
        for (int k = 0; k < pairs; k++) {
            const double depth = pow(10, single ? -3 : uniform(-5, -3)), azimuth = uniform(-pi, pi), at[2] = {uniform(-0.5, 0.5), uniform(-0.5, 0.5)};
            double n[3], axis[3], across[3], tip[9], lean[9], yaw[9], upright[9], rot[9], pos[2][3];
            static const double up[3] = {0, 0, 1};
            rotation_about(0, 1, 0, bodies[i].tip * pi / 180, tip);
            rotation_about(cos(azimuth), sin(azimuth), 0, bodies[i].lean, lean);
            rotation_about(0, 0, 1, uniform(-pi, pi), yaw);
            rotation_times(yaw, tip, rot);
            rotation_times(lean, rot, rot);
            /* A normal across the pole. */
            const double any[3] = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
            truth_cross3(pole, any, n);
            const double length = sqrt(truth_dot3(n, n));
            for (int j = 0; j < 3; j++)
                n[j] /= length;
            truth_cross3(up, n, axis);
            rotation_about(axis[0], axis[1], axis[2], acos(n[2]), upright);
            truth_cross3(n, pole, across);
            int hits = 0;
            for (int side = 0; side < 2; side++) {
                double by[9], world[9];
                rotation_about(across[0], across[1], across[2], side ? (single ? 1e-5 : 1e-7) : (single ? -1e-5 : -1e-7), by);
                rotation_times(by, upright, world);
                hits += position(bodies[i].body, rot, depth, at, world, NULL, pos[side]);
            }
            CHECK(hits == 2, "%s: no hit", bodies[i].name);
            const double moved = hypot(pos[0][0] - pos[1][0], pos[0][1] - pos[1][1]);
            seen.square += moved * moved;
            seen.jump = fmax(seen.jump, moved);
            seen.count++;
        }
        printf("%-18s moves by rms %6.3f mm, at most %6.2f\n", bodies[i].name, 1e3 * rms(&seen), 1e3 * seen.jump);
        CHECK(1e3 * seen.jump <= 14, "%s", bodies[i].name);
    }
}

int main(int argc, char **argv)
{
    static const struct { const char *name; void (*check)(int count); } parts[] = {
        {"lying", check_lying}, {"leaning", check_leaning}, {"axes", check_axes}};
    uniform_seed((uint64_t)(argc > 3 ? atoi(argv[3]) : 1));
    for (int i = 0; i < 3; i++)
        if (argc > 1 && strcmp(argv[1], parts[i].name) == 0)
            parts[i].check(argc > 2 ? atoi(argv[2]) : 100);
    return checks_end();
}
