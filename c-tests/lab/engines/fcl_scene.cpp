/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A moving scene through FCL's DynamicAABBTreeCollisionManager: bodies of every convex kind
 * drift and turn in a closed room, through each other. Their poses depend on no result.
 *
 * Compiled plain, the narrow phase is FCL's own on the loaded libccd; with BY_HEADER,
 * that of <ccd/fcl.hpp>. With TIMED the collisions are timed: processor time. Else every pair is judged
 * by the proven minimum of this library, and every EXACTth by truth.h as well: those that libccd or this
 * library was queried for in the line `put`, those with a closed form of FCL's in `closed_form`.
 *
 * usage: fcl_scene CONTACTS FRAMES BODIES EXACT [mixed|round|hulls]   (CONTACTS: at most so many of a pair,
 * with BY_HEADER; round: spheres and capsules) */

#include "engines/fcl_shapes.h"
#include "harness/identity.h"
#include "harness/this_library.h"
#include "tools/compare/counts.h"
#if defined(BY_HEADER) && !defined(TIMED)
/* compare.sh does not count the header's calls, which are the extension's. */
static unsigned long query_count, support_count;
static ccd_support_fn counted_support1;

static void count_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *v)
{
    support_count++;
    counted_support1(obj, dir, v);
}

template <typename Call, typename... Rest>
static int counted(Call *call, unsigned long queries, const void *a, const void *b, const ccd_t *ccd, Rest... rest)
{
    ccd_t settings = *ccd;
    query_count += queries;
    counted_support1 = ccd->support1;
    settings.support1 = count_support;
    return call(a, b, &settings, rest...);
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
        std::vector<int> kinds = {SHAPE_BOX, SHAPE_SPHERE, SHAPE_CAPSULE, SHAPE_CYLINDER, SHAPE_CONE, SHAPE_ELLIPSOID,
                                  SHAPE_POLYTOPE, KIND_PLATE};
        if (which == "round")
            kinds = {SHAPE_SPHERE, SHAPE_CAPSULE};
        else if (which == "hulls")
            kinds = {SHAPE_POLYTOPE};
        half_width = 0.55 * cbrt((double)n); /* a third of the bodies overlap another, for any number */
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

static fcl::CollisionRequestd request()
{
    return fcl::CollisionRequestd(1000000, true, 1, false, true, fcl::GST_LIBCCD, TOLERANCE);
}

#ifdef BY_HEADER
static ccd_fcl::PairCache cache;
static ccd_fcl::Settings settings;
#endif

#ifdef TIMED

/* Collides all pairs; returns the number of contacts. */
static size_t collide_all(scene_t &scene)
{
#ifdef BY_HEADER
    ccd_fcl::CollisionData<double> data(cache);
    data.settings = settings;
    const auto callback = ccd_fcl::CollisionFunction<double>;
#else
    fcl::DefaultCollisionData<double> data;
    const auto callback = fcl::DefaultCollisionFunction<double>;
#endif
    data.request = request();
    scene.manager.collide(&data, callback);
#ifdef BY_HEADER
    cache.next_frame();
#endif
    return data.result.numContacts();
}

static bool count_pair(object *, object *, void *pairs)
{
    ++*(long *)pairs;
    return false;
}

static void run(scene_t &scene, long frames, long)
{
    double seconds = 0;
    long pairs = 0;
    size_t contacts = 0;
    for (long frame = 0; frame < frames; frame++) {
        const double start = thread_seconds();
        contacts += collide_all(scene);
        seconds += thread_seconds() - start;
        scene.manager.collide(&pairs, count_pair);
        scene.step(1.0 / 60);
    }
    printf("timed pairs %ld contacts %zu seconds %.6f\n", pairs, contacts, seconds);
    printf("processor seconds %.6f\n", (double)clock() / CLOCKS_PER_SEC);
}

#else

/* Collides a pair; returns whether libccd or this library was queried. */
static bool collide(object *o1, object *o2, fcl::CollisionResultd &result)
{
#ifdef BY_HEADER
    const unsigned long before = query_count;
    ccd_fcl::collide(o1, o2, request(), result, cache, settings);
    return query_count != before;
#else
    const unsigned long before = compare_queries();
    fcl::collide(o1, o2, request(), result);
    return compare_queries() != before;
#endif
}

static struct {
    long pairs, hits, contacts, exact, every;
    tally_t put, closed_form;
} judged;

static bool judge_pair(object *o1, object *o2, void *)
{
    body_t &a = *(body_t *)o1->getUserData(), &b = *(body_t *)o2->getUserData();
    const double size = pair_size(&a.shape, &b.shape);
    fcl::CollisionResultd result;
    tally_t *counts = collide(o1, o2, result) ? &judged.put : &judged.closed_form;
    double depth = NAN;
    for (size_t i = 0; i < result.numContacts(); i++)
        depth = fmax(depth, result.getContact(i).penetration_depth);
    judged.contacts += (long)result.numContacts();
    judged.hits += result.isCollision();

    ccd_penetration_t least;
    ccd_t ccd = shape_query();
    ccd.center1 = ccd.center2 = NULL; /* the proof needs none */
    ccd.epa_tolerance = 1e-10;
    ccd.max_iterations = 5000;
    const int code = OURS(ccdPenetrationProven)(&a.shape, &b.shape, &ccd, NULL, CCD_WANT_ALL, &least);
    verdict_truth_t truth = {-HUGE_VAL, 0, TOLERANCE, 1e-9 * size};
    if (code == CCD_HIT || code == CCD_LIMIT) {
        truth.lower = least.depth_lower;
        truth.upper = least.depth;
    }
    tally_add(counts, &truth, !std::isnan(depth), depth, 1);
    if (judged.pairs++ % judged.every == 0) {
        const truth_t t = truth_depth_within(&a.shape, &b.shape, 1e-8 * size);
        truth.lower = t.lower;
        truth.upper = t.depth;
        tally_add(counts, &truth, !std::isnan(depth), depth, 1);
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
    printf("judged pairs %ld hits %ld contacts %ld exact %ld\n", judged.pairs, judged.hits, judged.contacts, judged.exact);
    tally_print("put", &judged.put);
    tally_print("closed_form", &judged.closed_form);
#ifdef BY_HEADER
    printf("own queries %lu supports %lu\n", query_count, support_count);
#endif
}

#endif

int main(int argc, char **argv)
{
    const std::string which = argc > 5 ? argv[5] : "mixed";
    if (argc < 5 || (which != "mixed" && which != "round" && which != "hulls")) {
        fprintf(stderr, "usage: fcl_scene CONTACTS FRAMES BODIES EXACT [mixed|round|hulls]\n");
        return 2;
    }
    print_library();
#ifdef BY_HEADER
    settings.contacts_per_pair = (size_t)atol(argv[1]);
#endif
    scene_t scene(atoi(argv[3]), which);
    run(scene, atol(argv[2]), atol(argv[4]));
    return 0;
}
