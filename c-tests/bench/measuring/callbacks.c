/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The support functions and pairs of the C tests, as a shared object for the benchmark: every method measured calls
 * these same callbacks. Shapes are opaque to the benchmark. */

#include "harness/floor.h"
#include "harness/pairs.h"
#include "harness/random.h"
#include "harness/truth.h"
#include "tools/record/recording.h"

void bench_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out) { shape_support(obj, dir, out); }

void bench_center(const void *obj, ccd_vec3_t *out) { shape_center(obj, out); }

unsigned long bench_calls(const shape_t *s) { return s->calls; }

/* Calls f. callgrind counts what runs inside, and begins new counts after bench_end. */
__attribute__((noinline)) void bench_counted(void (*f)(void *), void *data)
{
    f(data);
    __asm__ volatile(""); /* f returns here: no jump in place of the call */
}

__attribute__((noinline)) void bench_end(void) { __asm__ volatile(""); }

typedef struct {
    shape_t *a, *b;
    pair_truth_t truth;
    size_t motion, frame; /* poses of one motion with consecutive frames follow each other */
} bench_pose_t;

/* Returns room for n poses with their shapes, or NULL. */
static bench_pose_t *new_poses(size_t n)
{
    bench_pose_t *pose = (bench_pose_t *)calloc(n, sizeof *pose);
    shape_t *shape = (shape_t *)calloc(2 * n, sizeof *shape);
    for (size_t k = 0; pose && shape && k < n; k++) {
        pose[k].a = &shape[2 * k];
        pose[k].b = &shape[2 * k + 1];
    }
    return shape ? pose : NULL;
}

static size_t read_pair_set(const pair_set_t *set, bench_pose_t *pose)
{
    for (int i = 0; pose && i < set->n; i++, pose++) {
        pair_set_pose(set, i, pose->a, pose->b, &pose->truth);
        pose->motion = (size_t)(set->trajectory > 0 ? i / set->trajectory : i);
        pose->frame = (size_t)i;
    }
    return pose ? (size_t)set->n : 0;
}

/* Writes the line of the centers. */
static void centers_apart(bench_pose_t *pose)
{
    ccd_vec3_t center[2], d;
    shape_center(pose->a, &center[0]);
    shape_center(pose->b, &center[1]);
    ccdVec3Sub2(&d, &center[1], &center[0]);
    if (ccdVec3Len2(&d) > 0)
        ccdVec3Normalize(&d);
    else
        ccdVec3Set(&d, 1, 0, 0);
    memcpy(pose->truth.cold, d.v, sizeof d.v);
}

/* Writes a direction so many degrees from a normal, towards a vector that is not parallel to it. */
static void guess(const double normal[3], const double towards[3], double degrees, double out[3])
{
    const double angle = degrees * 1.57079632679489661923 / 90, along = truth_dot3(normal, towards);
    double side[3], length = 0;
    for (int k = 0; k < 3; k++) {
        side[k] = towards[k] - along * normal[k];
        length += side[k] * side[k];
    }
    for (int k = 0; k < 3; k++)
        out[k] = cos(angle) * normal[k] + sin(angle) / sqrt(length) * side[k];
}

static size_t read_recording(const recording_t *r, bench_pose_t *pose)
{
    size_t k = 0;
    shape_t *body = (shape_t *)malloc(r->bodies * sizeof *body);
    for (uint32_t f = 0; pose && body && f < r->frames; f++) {
        recording_place(r, f, body);
        for (uint32_t i = 0; i < r->frame_pairs[f]; i++, k++, pose++) {
            const recording_pair_t *pair = &r->pair[k];
            *pose->a = body[pair->a];
            *pose->b = body[pair->b];
            centers_apart(pose);
            pose->truth.depth = (pair->lower + pair->upper) / 2;
            pose->truth.gap = pair->upper - pair->lower;
            pose->motion = (size_t)pair->a * r->bodies + pair->b;
            pose->frame = f;
        }
    }
    free(body);
    return k;
}

/* --- random pairs by kind and depth ----------------------------------------- */

enum { BOXES, HULLS, CAPSULES, CYLINDERS_AND_CONES, ELLIPSOIDS, HULLS_42, HULLS_642, HULLS_AND_CAPSULES };
enum { SHALLOW, MEDIUM, DEEP, NEAR, FAR };

/* Makes a shape of 5 to 50 cm with aspect ratios up to 3, turned at random. */
static shape_t random_shape(rng_t *r, int kind)
{
    double rot[9], p[3], size = rng_log_uniform(r, .05, .5);
    shape_t s;
    for (int k = 0; k < 3; k++)
        p[k] = size * rng_uniform(r, .33, 1);
    const int corners[] = {0, 100, 0, 0, 0, 42, 642, 162};
    const int n = corners[kind];
    if (n > 0) {
        ccd_real_t *verts = (ccd_real_t *)malloc(sizeof *verts * 3 * (size_t)n);
        rng_on_ellipsoid(r, verts, n, p);
        s = shape_polytope(verts, n);
    } else {
        const int round = rng_below(r, 2) ? SHAPE_CYLINDER : SHAPE_CONE;
        const int type[] = {SHAPE_BOX, SHAPE_POLYTOPE, SHAPE_CAPSULE, round, SHAPE_ELLIPSOID};
        s = shape_make(type[kind], p[0], p[1], p[2]);
    }
    rng_rotation(r, rot);
    shape_turn(&s, rot);
    return s;
}

/* Moves b, from where it touches a along u, inwards until they overlap by the given depth or more. Returns the depth that
 * they have, to a hundredth of the given one. */
static truth_t push_together(const shape_t *a, shape_t *b, const double u[3], double depth)
{
    double at = truth_support_value(a, b, u);
    shape_t apart = *b;
    truth_t t;
    do {
        *b = apart;
        shape_shift(b, at, u);
        t = truth_depth_within(a, b, .01 * depth);
        at -= depth;
    } while (t.depth < depth && at > 0);
    return t;
}

/* Makes n pairs of a kind. Pair i has the same two shapes at every depth: deep with center near center; else they meet from
 * the same random direction, and are then moved along their true normal. */
size_t bench_random(int kind, int depth, size_t n, bench_pose_t **poses)
{
    /* depth or gap over the smaller reach */
    static const double part[][2] = {{1e-3, .02}, {.05, .15}, {0, 0}, {1e-3, .05}, {.3, 2}};
    bench_pose_t *pose = *poses = new_poses(n);
    for (size_t i = 0; pose && i < n; i++, pose++) {
        rng_t r = rng((uint64_t)kind, i);
        double u[3], least;
        *pose->a = random_shape(&r, kind);
        *pose->b = random_shape(&r, kind == HULLS_AND_CAPSULES ? CAPSULES : kind);
        least = fmin(shape_reach(pose->a), shape_reach(pose->b));
        rng_unit_vector(&r, u);
        pose->motion = i;
        if (depth == DEEP) {
            shape_shift(pose->b, least * rng_uniform(&r, 0, .3), u);
            pose->truth.depth = truth_depth_within(pose->a, pose->b, 1e-3 * least).depth;
        } else {
            const truth_t t = push_together(pose->a, pose->b, u, part[MEDIUM][1] * least);
            const double to = least * rng_log_uniform(&r, part[depth][0], part[depth][1]);
            pose->truth.depth = depth < DEEP ? to : -to;
            shape_shift(pose->b, t.depth - pose->truth.depth, t.n);
        }
    }
    return pose ? n : 0;
}

/* --- pairs placed by the caller ------------------------------------------------ */

/* A shape, and of a polytope with adjacency the neighbours of vertex i: neighbours[first[i]] ... neighbours[first[i + 1] - 1]. */
typedef struct {
    shape_t shape;
    const int *first, *neighbours;
    int last; /* the vertex found last */
} bench_mesh_t;

/* Returns a placed shape that is never freed; for a polytope its n vertices and their neighbours, which must outlive it. NULL
 * without memory. */
bench_mesh_t *bench_place(int type, const double p[3], const double pos[3], const double rot[9], const double *verts, int n,
                          const int *first, const int *neighbours)
{
    bench_mesh_t *m = (bench_mesh_t *)calloc(1, sizeof *m);
    if (!m)
        return NULL;
    m->shape = n > 0 ? shape_polytope(verts, n) : shape_make(type, p[0], p[1], p[2]);
    m->first = first;
    m->neighbours = neighbours;
    shape_move(&m->shape, pos[0], pos[1], pos[2]);
    shape_turn(&m->shape, rot);
    return m;
}

/* The support function of a placed shape. Polytopes climb over their edges from the vertex found last. */
void bench_support_placed(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    bench_mesh_t *m = (bench_mesh_t *)obj;
    const ccd_real_t *r = m->shape.rot, *w = dir->v;
    ccd_real_t d[3], value;
    int best, from;
    if (!m->first) {
        shape_support(obj, dir, out);
        return;
    }
    m->shape.calls++;
    for (int i = 0; i < 3; i++)
        d[i] = r[i] * w[0] + r[3 + i] * w[1] + r[6 + i] * w[2];
    best = m->last;
    value = ccdShapeHullValue(m->shape.verts, best, d);
    do {
        from = best;
        for (int k = m->first[from]; k < m->first[from + 1]; k++) {
            const ccd_real_t x = ccdShapeHullValue(m->shape.verts, m->neighbours[k], d);
            if (x > value) {
                value = x;
                best = m->neighbours[k];
            }
        }
    } while (best != from);
    m->last = best;
    shape_to_world(&m->shape, m->shape.verts + 3 * best, out->v);
}

/* Writes the direction of the least depth; returns that depth, and in `gap` the width of its bounds. */
double bench_truth(const shape_t *a, const shape_t *b, double width, double n[3], double *gap)
{
    const truth_t t = truth_depth_within(a, b, width);
    memcpy(n, t.n, sizeof t.n);
    *gap = t.depth - t.lower;
    return t.depth;
}

/* Makes n motions of two frames: a box that lies 1 mm deep on a larger one slides by 1 cm. */
size_t bench_sliding(size_t n, bench_pose_t **poses)
{
    enum { FRAMES = 2 };
    bench_pose_t *pose = *poses = new_poses(FRAMES * n);
    for (size_t i = 0; pose && i < n; i++) {
        rng_t r = rng(100, i);
        const double height = rng_uniform(&r, .1, .3), x = rng_uniform(&r, -.3, .3), y = rng_uniform(&r, -.3, .3);
        shape_t floor = shape_box(1, 1, .2), box = shape_box(rng_uniform(&r, .1, .3), rng_uniform(&r, .1, .3), height);
        double frame[9], yaw[9];
        rng_rotation(&r, frame);
        rotation_about(0, 0, 1, rng_uniform(&r, 0, 6), yaw);
        shape_turn(&box, yaw);
        for (size_t f = 0; f < FRAMES; f++, pose++) {
            *pose->a = floor;
            *pose->b = box;
            shape_move(pose->b, x + .01 * (double)f, y, .2 + height - 1e-3);
            shape_turn_by(pose->a, frame, 0, 0, 0);
            shape_turn_by(pose->b, frame, 0, 0, 0);
            pose->truth.depth = 1e-3;
            pose->motion = i;
            pose->frame = f;
        }
    }
    return pose ? FRAMES * n : 0;
}

/* Makes n motions of two frames: a body of the kind slides by 1 cm on a plate of this half width, 1 mm deep, or above it. */
size_t bench_floor(int kind, double half, int is_above, size_t n, bench_pose_t **poses)
{
    enum { FRAMES = 2 };
    const double height = is_above ? 1e-3 : -1e-3;
    bench_pose_t *pose = *poses = new_poses(FRAMES * n);
    ccd_real_t *verts = (ccd_real_t *)calloc(n, 3 * FLOOR_CORNERS * sizeof *verts);
    for (size_t k = 0; pose && verts && k < FRAMES * n; k++, pose++) {
        const size_t i = k / FRAMES, f = k % FRAMES;
        rng_t r = rng(101 + (uint64_t)kind, i);
        double towards[3];
        floor_pair(&r, (floor_kind_t)kind, half, height, .01 * (double)f, verts + 3 * FLOOR_CORNERS * i, pose->a, pose->b,
                   pose->truth.normal);
        pose->truth.depth = -height;
        rng_unit_vector(&r, towards);
        guess(pose->truth.normal, towards, 5, pose->truth.init5);
        guess(pose->truth.normal, towards, 25, pose->truth.init25);
        guess(pose->truth.normal, towards, 45, pose->truth.init45);
        centers_apart(pose);
        pose->motion = i;
        pose->frame = f;
    }
    return pose && verts ? FRAMES * n : 0;
}

/* --- files -------------------------------------------------------------------- */

/* Reads the poses of a pair set or of a recording. Returns their number, 0 on failure. Nothing is ever freed. */
size_t bench_scene(const char *path, bench_pose_t **poses)
{
    pair_set_t set;
    recording_t r;
    if (pair_set_read(path, &set) == 0)
        return read_pair_set(&set, *poses = new_poses((size_t)set.n));
    return recording_read(path, &r) == 0 ? read_recording(&r, *poses = new_poses(r.pairs)) : 0;
}
