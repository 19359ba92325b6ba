/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A moving scene through FCL's DynamicAABBTreeCollisionManager: bodies of every convex kind
 * drift and turn in a closed room, through each other. Their poses depend on no answer.
 *
 * Compiled plain, the narrow phase is FCL's own on whichever libccd is loaded; with BY_HEADER,
 * that of <ccd/fcl.hpp>. With TIMED nothing stands between: the processor time of the
 * collisions. Else every pair is judged by the proven minimum of this library, and every
 * EXACTth by truth.h as well. Prints one of
 *
 *   timed pairs N contacts N nanoseconds N
 *   judged pairs N hits N contacts N missed N spurious N off N error M own_missed N
 *          own_spurious N own_off N own_error M exact N   (and with BY_HEADER a "watched" line, as compare.sh adds one else)
 *
 * `missed`, `spurious`, `off` (beyond the promised depth) and `error` (largest, metres) are
 * those of pairs put to libccd or this library, `own_` of pairs that FCL has closed forms for.
 *
 * usage: fcl_scene FRAMES BODIES EXACT CONTACTS [mixed|round|hulls]   (CONTACTS: of a pair, with
 * BY_HEADER; round: spheres and capsules) */

#include "engines/fcl_shapes.h"
#include "harness/identity.h"
#ifndef TIMED
#include "harness/this_library.h"
#ifndef BY_HEADER
#include "tools/compare/hooks.h"
#endif
#endif
#if defined(BY_HEADER) && !defined(TIMED)
/* The calls of the header are the extension's, which compare.sh does not know: counted here. */
static struct {
    unsigned long queries, supports;
} asked;

static ccd_support_fn asked_support1;
static void asked_count(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *v)
{
    asked.supports++;
    asked_support1(obj, dir, v);
}

template <typename Call, typename... Rest>
static int counted(Call *call, unsigned long queries, const void *a, const void *b, const ccd_t *ccd, Rest... rest)
{
    ccd_t behind = *ccd;
    asked.queries += queries;
    asked_support1 = ccd->support1;
    behind.support1 = asked_count;
    return call(a, b, &behind, rest...);
}
#define ccdPenetration(...) counted(ccdPenetration, 1, __VA_ARGS__)
#define ccdSignedDistance(...) counted(ccdSignedDistance, 1, __VA_ARGS__)
#define ccdContacts(...) counted(ccdContacts, 0, __VA_ARGS__)
#endif
#ifdef BY_HEADER
#include <ccd/fcl.hpp>
#endif

#include <string>
#include <time.h>
#include <vector>

typedef fcl::CollisionObjectd object;

static const double TOLERANCE = 1e-6; /* FCL's */

/* --- the scene -------------------------------------------------------------------- */

struct moving_t {
    body_t body;
    vec at, velocity, spin;
    Eigen::Quaterniond turn;
};

struct scene_t {
    std::vector<moving_t> bodies;
    std::vector<object> objects;
    fcl::DynamicAABBTreeCollisionManagerd manager;
    double half_width;

    scene_t(int n, const std::string &which) : bodies((size_t)n)
    {
        std::vector<int> kinds = {SHAPE_BOX, SHAPE_SPHERE, SHAPE_CAPSULE, SHAPE_CYLINDER, SHAPE_CONE, SHAPE_ELLIPSOID, SHAPE_POLYTOPE, KIND_PLATE};
        if (which == "round")
            kinds = {SHAPE_SPHERE, SHAPE_CAPSULE};
        else if (which == "hulls")
            kinds = {SHAPE_POLYTOPE};
        half_width = 0.55 * cbrt((double)n); /* a third of the bodies overlap another, whatever their number */
        uniform_seed(14);
        objects.reserve(bodies.size());
        for (moving_t &m : bodies) {
            double q[4];
            body_random(&m.body, kinds[(size_t)(&m - &bodies[0]) % kinds.size()]);
            uniform_rotation(q);
            m.turn = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
            for (int i = 0; i < 3; i++) {
                m.at[i] = uniform(-half_width, half_width);
                m.velocity[i] = uniform(-0.5, 0.5);
                m.spin[i] = uniform(-1, 1);
            }
            objects.emplace_back(fcl_geometry(m.body));
            objects.back().setUserData(&m.body);
        }
        place();
        for (object &o : objects)
            manager.registerObject(&o);
        manager.setup();
    }

    void place()
    {
        for (size_t i = 0; i < bodies.size(); i++) {
            moving_t &m = bodies[i];
            const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> turn = m.turn.toRotationMatrix();
            shape_turn(&m.body.shape, turn.data());
            shape_move(&m.body.shape, m.at[0], m.at[1], m.at[2]);
            objects[i].setTransform(fcl_pose(m.body.shape));
            objects[i].computeAABB();
        }
    }

    void step(double dt)
    {
        for (moving_t &m : bodies) {
            m.at += dt * m.velocity;
            for (int i = 0; i < 3; i++)
                if (fabs(m.at[i]) > half_width)
                    m.velocity[i] = -copysign(m.velocity[i], m.at[i]);
            m.turn = (Eigen::Quaterniond(Eigen::AngleAxisd(dt * m.spin.norm(), m.spin.normalized())) * m.turn).normalized();
        }
        place();
        manager.update();
    }
};

/* --- the two narrow phases ---------------------------------------------------------- */

static fcl::CollisionRequestd request(size_t most)
{
    return fcl::CollisionRequestd(most, true, 1, false, true, fcl::GST_LIBCCD, TOLERANCE);
}

static const size_t ALL = 1000000;
#ifdef BY_HEADER
static ccd_fcl::PairCache cache;
static ccd_fcl::Settings settings;
#endif

#ifdef TIMED

static double now()
{
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static bool count_pair(object *, object *, void *pairs)
{
    ++*(long *)pairs;
    return false;
}

static void run(scene_t &scene, long frames, long)
{
    double nanoseconds = 0;
    long pairs = 0;
    size_t contacts = 0;
    for (long frame = 0; frame < frames; frame++) {
        const double start = now();
#ifdef BY_HEADER
        ccd_fcl::CollisionData<double> data(cache);
        data.request = request(ALL);
        data.settings = settings;
        scene.manager.collide(&data, ccd_fcl::CollisionFunction<double>);
        cache.next_frame();
#else
        fcl::DefaultCollisionData<double> data;
        data.request = request(ALL);
        scene.manager.collide(&data, fcl::DefaultCollisionFunction<double>);
#endif
        nanoseconds += now() - start;
        contacts += data.result.numContacts();
        scene.manager.collide(&pairs, count_pair);
        scene.step(1.0 / 60);
    }
    printf("timed pairs %ld contacts %zu nanoseconds %.0f\n", pairs, contacts, nanoseconds);
}

#else

#ifdef BY_HEADER
static unsigned long put_so_far() { return asked.queries; }
#else
static unsigned long put_so_far() { return compare_queries(); }
#endif

/* Counts of wrong answers for a part of the pairs. */
struct part_t {
    long missed, spurious, off;
    double error;
};

static struct {
    long pairs, hits, contacts, exact, every;
    part_t put, own; /* to libccd or this library; by closed forms of FCL's */
} judged;

/* The depth of a pair, NaN for none, against bounds of the truth; a gap has a negative depth. */
static void judge(part_t *part, double depth, double lower, double upper, double size)
{
    const double nothing = 1e-9 * size;
    if (isnan(depth)) {
        part->missed += lower > nothing;
        return;
    }
    part->spurious += upper < -nothing;
    const double above = depth - fmax(upper, 0), below = lower - depth;
    part->error = fmax(part->error, fmax(above, below));
    part->off += !(above <= fmax(TOLERANCE, 1e-3 * upper) + nothing && below <= TOLERANCE + nothing);
}

static bool judge_pair(object *o1, object *o2, void *)
{
    body_t &a = *(body_t *)o1->getUserData(), &b = *(body_t *)o2->getUserData();
    const double size = pair_size(&a.shape, &b.shape);
    const unsigned long before = put_so_far();
    fcl::CollisionResultd result;
#ifdef BY_HEADER
    ccd_fcl::collide(o1, o2, request(ALL), result, cache, settings);
#else
    fcl::collide(o1, o2, request(ALL), result);
#endif
    double depth = NAN;
    for (size_t i = 0; i < result.numContacts(); i++)
        depth = fmax(depth, result.getContact(i).penetration_depth);
    judged.contacts += (long)result.numContacts();
    judged.hits += result.isCollision();
    part_t *part = put_so_far() == before ? &judged.own : &judged.put;

    ccd_penetration_t least;
    ccd_t ccd = shape_query();
    ccd.center1 = ccd.center2 = NULL; /* the proof needs none */
    ccd.epa_tolerance = 1e-10;
    ccd.max_iterations = 5000;
    const int code = OURS(ccdPenetrationProven)(&a.shape, &b.shape, &ccd, NULL, CCD_WANT_ALL, &least);
    const bool overlap = code == CCD_HIT || code == CCD_LIMIT;
    judge(part, depth, overlap ? least.depth_lower : -HUGE_VAL, overlap ? least.depth : 0, size);
    if (judged.pairs++ % judged.every == 0) {
        const truth_t t = truth_depth_within(&a.shape, &b.shape, 1e-8 * size);
        judge(part, depth, t.lower, t.depth, size);
        judged.exact++;
    }
    return false;
}

static void run(scene_t &scene, long frames, long every)
{
    judged.every = every;
    for (long frame = 0; frame < frames; frame++) {
        scene.manager.collide(NULL, judge_pair);
#ifdef BY_HEADER
        cache.next_frame();
#endif
        scene.step(1.0 / 60);
    }
    printf("judged pairs %ld hits %ld contacts %ld missed %ld spurious %ld off %ld error %.9g own_missed %ld own_spurious %ld "
           "own_off %ld own_error %.9g exact %ld\n",
           judged.pairs, judged.hits, judged.contacts, judged.put.missed, judged.put.spurious, judged.put.off, judged.put.error,
           judged.own.missed, judged.own.spurious, judged.own.off, judged.own.error, judged.exact);
#ifdef BY_HEADER
    printf("watched queries %lu supports %lu\n", asked.queries, asked.supports);
#endif
}

#endif

int main(int argc, char **argv)
{
    const std::string which = argc > 5 ? argv[5] : "mixed";
    if (argc < 5 || (which != "mixed" && which != "round" && which != "hulls")) {
        fprintf(stderr, "usage: fcl_scene FRAMES BODIES EXACT CONTACTS [mixed|round|hulls]\n");
        return 2;
    }
    print_library();
#ifdef BY_HEADER
    settings.contacts_per_pair = (size_t)atol(argv[4]);
#endif
    scene_t scene(atoi(argv[2]), which);
    run(scene, atol(argv[1]), atol(argv[3]));
    return 0;
}
