/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks <ccd/fcl.hpp>: every pair of FCL's convex kinds at certified depths, in both orders, cold and
 * warm; contacts of resting shapes; managers; the cache; pairs that FCL handles itself; invalid input.
 * In single precision FCL is single too. */

#include "engines/fcl_shapes.h"

#include "tests/contract/check.h"

#include <ccd/fcl.hpp>

#include <new>
#include <vector>

typedef ccd_real_t S;
typedef fcl::CollisionResult<S> collision;
typedef fcl::DistanceResult<S> proximity;

static const bool SINGLE = sizeof(S) == sizeof(float);
static const S TOLERANCE = S(1e-6);
/* Rounding of poses and support points, relative to the size. */
static const double ROUNDING = SINGLE ? 3e-6 : 1e-9;

static object placed(const geometry &shape, const vec &at, const vec &about = vec::Zero())
{
    fcl::Transform3<S> pose = fcl::Transform3<S>::Identity();
    if (about.norm() > 0)
        pose.linear() = Eigen::AngleAxis<S>(about.norm(), about.normalized()).toRotationMatrix();
    pose.translation() = at;
    return object(shape, pose);
}

static fcl::CollisionRequest<S> contacts(std::size_t max)
{
    return fcl::CollisionRequest<S>(max, true, 1, false, true, fcl::GST_LIBCCD, TOLERANCE);
}

/* --- against exact truth -------------------------------------------------------- */

/* Checks the one contact of a pair, the deepest. */
static void check_contact(const shape_t &a, const shape_t &b, const collision &r, const pose_truth_t &truth, const char *name)
{
    const fcl::Contact<S> &contact = r.getContact(0);
    const double n[3] = {double(contact.normal[0]), double(contact.normal[1]), double(contact.normal[2])};
    const double error = TOLERANCE + ROUNDING * truth.size, depth = double(contact.penetration_depth);
    CHECK(r.numContacts() == 1, "%s: %zu contacts", name, r.numContacts());
    CHECK(std::fabs(contact.normal.norm() - 1) < (SINGLE ? 1e-5 : 1e-12), "%s: normal", name);
    CHECK(depth >= truth.lower - error && depth <= truth.upper * 1.001 + error, "%s: depth %g", name, depth);
    CHECK(truth_support_value(&a, &b, n) <= depth + error, "%s: overlap after a move by %g along the normal", name, depth);
    /* pos is in both shapes, within the depth. */
    for (const shape_t *shape : {&a, &b})
        CHECK(!is_outside(*shape, contact.pos, depth + 10 * error, 0.01 * (depth + error)), "%s: pos outside", name);
}

static void check_distance(const shape_t &a, const shape_t &b, const proximity &r, const pose_truth_t &truth, const char *name)
{
    const double error = TOLERANCE + ROUNDING * truth.size, d = double(r.min_distance);
    CHECK(d <= -truth.lower + error && d >= -truth.upper - error, "%s: distance %g", name, d);
    const vec way = r.nearest_points[1] - r.nearest_points[0];
    if (d > 0)
        CHECK(std::fabs(way.norm() - d) <= 2 * error, "%s: points %g apart, distance %g", name, double(way.norm()), d);
    for (int i = 0; i < 2; i++)
        CHECK(!is_outside(i ? b : a, r.nearest_points[i], 3 * error, error), "%s: point %d outside", name, i);
}

/* Checks one pose cold, warm, and with the state of the other order, and that the results without contacts and
 * points are the same. */
static void check_pose(const body_t &a, const body_t &b, const object &oa, const object &ob, const pose_truth_t &truth,
                       ccd_fcl::PairCache &cache, const char *name)
{
    const double error = TOLERANCE + ROUNDING * truth.size;
    const fcl::DistanceRequest<S> with_points(true, true, 0, 0, TOLERANCE), without(false, false, 0, 0, TOLERANCE);
    for (int pass = 0; pass < 3; pass++) {
        ccd_fcl::PairCache cold;
        ccd_fcl::PairCache &pairs = pass == 0 ? cold : cache;
        for (int order = 0; order < 2; order++) {
            const object *o1 = order ? &ob : &oa, *o2 = order ? &oa : &ob;
            const shape_t &s1 = order ? b.shape : a.shape, &s2 = order ? a.shape : b.shape;
            collision r, plain;
            proximity d, short_d;
            ccd_fcl::collide(o1, o2, contacts(1), r, pairs);
            CHECK(r.isCollision() || truth.lower <= error, "%s: missed", name);
            CHECK(!r.isCollision() || truth.upper >= -error, "%s: spurious", name);
            if (r.isCollision())
                check_contact(s1, s2, r, truth, name);
            ccd_fcl::distance(o1, o2, with_points, d, pairs);
            check_distance(s1, s2, d, truth, name);
            ccd_fcl::distance(o1, o2, without, short_d, pairs);
            CHECK(std::fabs(short_d.min_distance - d.min_distance) <= 2 * error, "%s: distance without points", name);
            for (int run = 0; run < 2; run++) {
                ccd_fcl::collide(o1, o2, fcl::CollisionRequest<S>(), plain, pairs);
                CHECK(plain.numContacts() == r.numContacts() || std::fabs(truth.upper) <= error, "%s: plain", name);
            }
            CHECK(pairs.size() == 1 || pass > 0, "%s: %zu states", name, pairs.size());
        }
    }
}

static void check_certified_depths(int poses)
{
    /* the first is the depth of the drawn pose */
    static const double depths[] = {HUGE_VAL, 1e-1, 1e-2, 1e-4, 1e-6, 1e-14, 0, -1e-6, -1e-3, -1e-1};
    ccd_fcl::PairCache cache;
    uniform_seed(7);
    for (int i = 0; i < KINDS * KINDS * poses; i++) {
        const int kind1 = i / poses / KINDS, kind2 = i / poses % KINDS;
        static body_t a, b;
        pose_truth_t truth;
        if (kind1 == KIND_TRIANGLE && kind2 == KIND_TRIANGLE)
            continue; /* never overlap */
        body_random(&a, kind1);
        body_random(&b, kind2);
        pose_overlapping(&a, &b, &truth);
        const geometry ga = fcl_geometry(a.shape, TRIANGLE_SHAPE), gb = fcl_geometry(b.shape, TRIANGLE_SHAPE);
        object oa(ga, fcl_pose(a.shape)), ob(gb, fcl_pose(b.shape));
        CHECK(ccd_fcl::is_supported(ga.get(), gb.get()), "%s %s", KIND_NAME[kind1], KIND_NAME[kind2]);
        for (double depth : depths) {
            char name[80];
            if (depth < HUGE_VAL) {
                if (depth * truth.size >= truth.upper)
                    continue;
                pose_at_depth(&b, &truth, depth * truth.size);
                ob.setTransform(fcl_pose(b.shape));
            }
            std::snprintf(name, sizeof name, "%s %s %d at %g", KIND_NAME[kind1], KIND_NAME[kind2], i % poses, truth.upper);
            check_pose(a, b, oa, ob, truth, cache, name);
        }
    }
}

/* --- several contacts ----------------------------------------------------------- */

/* Checks the contacts of a shape on a table from z = -1 to 0, 1 mm deep, in both orders. */
static void check_resting(const char *what, const geometry &shape, S height, const vec &about, std::size_t expected, S spread)
{
    const geometry board = std::make_shared<fcl::Box<S>>(4, 4, 1);
    const S depth = S(1e-3), error = S(ROUNDING) * 10 + TOLERANCE;
    const object table = placed(board, vec(0, 0, S(-0.5))), body = placed(shape, vec(S(0.2), S(0.1), height - depth), about);
    for (int order = 0; order < 2; order++) {
        ccd_fcl::PairCache cache;
        collision r;
        S across = 0;
        ccd_fcl::collide(order ? &body : &table, order ? &table : &body, contacts(100), r, cache);
        CHECK(r.numContacts() == expected, "%s: %zu contacts", what, r.numContacts());
        for (std::size_t i = 0; i < r.numContacts(); i++) {
            const fcl::Contact<S> &c = r.getContact(i);
            CHECK((c.normal - vec(0, 0, order ? S(-1) : S(1))).norm() < (SINGLE ? 1e-3 : 1e-5), "%s: normal %g %g %g", what,
                  double(c.normal[0]), double(c.normal[1]), double(c.normal[2]));
            CHECK(std::fabs(c.penetration_depth - depth) <= error, "%s: depth %g", what, double(c.penetration_depth));
            CHECK(std::fabs(c.pos[2] + depth / 2) <= error, "%s: pos at %g", what, double(c.pos[2]));
            CHECK(c.o1 == (order ? shape : board).get() && c.o2 == (order ? board : shape).get(), "%s: objects", what);
            for (std::size_t k = 0; k < i; k++)
                across = std::max(across, (c.pos - r.getContact(k).pos).norm());
        }
        CHECK(std::fabs(across - spread) <= S(0.01) * spread + S(1e-5),
              "%s: %g across, not %g", what, double(across), double(spread));

        /* The largest number of contacts of a pair, and in all. */
        for (std::size_t room = 1; room <= 3; room++) {
            collision few, one;
            ccd_fcl::Settings settings;
            settings.contacts_per_pair = 1;
            ccd_fcl::collide(order ? &body : &table, order ? &table : &body, contacts(room), few, cache);
            CHECK(few.numContacts() == std::min(room, expected), "%s: %zu of %zu", what, few.numContacts(), room);
            ccd_fcl::collide(order ? &body : &table, order ? &table : &body, contacts(room), one, cache, settings);
            CHECK(one.numContacts() == 1, "%s: %zu, not one", what, one.numContacts());
            if (room == 2) { /* contacts of other pairs count */
                ccd_fcl::collide(order ? &body : &table, order ? &table : &body, contacts(room), one, cache);
                CHECK(one.numContacts() == 2, "%s: %zu, not two", what, one.numContacts());
            }
        }
    }
}

static void check_manifolds(void)
{
    const vec lying(0, S(M_PI / 2), 0), up = vec::Zero();
    check_resting("box", std::make_shared<fcl::Box<S>>(1, 2, S(0.5)), S(0.25), up, 4, std::sqrt(S(5)));
    check_resting("sphere", std::make_shared<fcl::Sphere<S>>(S(0.3)), S(0.3), up, 1, 0);
    check_resting("lying capsule", std::make_shared<fcl::Capsule<S>>(S(0.2), 1), S(0.2), lying, 2, 1);
    check_resting("standing capsule", std::make_shared<fcl::Capsule<S>>(S(0.2), 1), S(0.7), up, 1, 0);
    check_resting("lying cylinder", std::make_shared<fcl::Cylinder<S>>(S(0.2), 1), S(0.2), lying, 2, 1);
    check_resting("ellipsoid", std::make_shared<fcl::Ellipsoid<S>>(S(0.3), S(0.2), S(0.4)), S(0.4), up, 1, 0);
}

/* --- managers ---------------------------------------------------------------------- */

static std::vector<object> crowd(int n, double half_width)
{
    std::vector<object> objects;
    for (int i = 0; i < n; i++) {
        static body_t body;
        body_random(&body, i % KINDS);
        turn_at_random(&body.shape);
        for (S &x : body.shape.pos)
            x = S(uniform(-half_width, half_width));
        objects.emplace_back(fcl_geometry(body.shape, TRIANGLE_SHAPE), fcl_pose(body.shape));
    }
    return objects;
}

static void check_managers(void)
{
    uniform_seed(11);
    std::vector<object> objects = crowd(60, 0.8);
    std::vector<object> far_off = crowd(20, 0.8);
    fcl::DynamicAABBTreeCollisionManager<S> manager, others;
    ccd_fcl::PairCache cache;
    std::size_t pairs = 0;
    for (object &o : objects)
        manager.registerObject(&o);
    manager.setup();
    for (std::size_t i = 0; i < objects.size(); i++)
        for (std::size_t k = 0; k < i; k++) {
            collision r;
            ccd_fcl::PairCache cold;
            pairs += ccd_fcl::collide(&objects[i], &objects[k], contacts(1), r, cold) > 0;
        }
    for (int pass = 0; pass < 2; pass++) { /* cold and warm */
        ccd_fcl::CollisionData<S> data(cache);
        data.request = contacts(100000);
        data.settings.contacts_per_pair = 1;
        manager.collide(&data, ccd_fcl::CollisionFunction<S>);
        CHECK(data.result.numContacts() == pairs && pairs > 50, "%zu contacts of %zu pairs", data.result.numContacts(), pairs);
        ccd_fcl::CollisionData<S> first(cache);
        first.request = contacts(1);
        manager.collide(&first, ccd_fcl::CollisionFunction<S>);
        CHECK(first.done && first.result.numContacts() == 1, "%zu", first.result.numContacts());
    }

    for (object &o : far_off) {
        o.setTranslation(o.getTranslation() + vec(4, 1, 2));
        o.computeAABB();
        others.registerObject(&o);
    }
    others.setup();
    proximity least;
    for (object &o : objects)
        for (object &x : far_off) {
            ccd_fcl::PairCache cold;
            proximity r;
            ccd_fcl::distance(&o, &x, fcl::DistanceRequest<S>(true, true), r, cold);
            least.update(r);
        }
    ccd_fcl::DistanceData<S> data(cache);
    data.request = fcl::DistanceRequest<S>(true, true);
    manager.distance(&others, &data, ccd_fcl::DistanceFunction<S>);
    CHECK(std::fabs(data.result.min_distance - least.min_distance) <= 2e-6 + ROUNDING && least.min_distance > 0.1,
          "distance %g, not %g", double(data.result.min_distance), double(least.min_distance));
    const auto *o1 = data.result.o1, *o2 = data.result.o2;
    CHECK((o1 == least.o1 && o2 == least.o2) || (o1 == least.o2 && o2 == least.o1),
          "other objects");
}

/* --- the cache ---------------------------------------------------------------------- */

static void check_cache(void)
{
    const geometry box = std::make_shared<fcl::Box<S>>(1, 1, 1);
    std::vector<object> row;
    ccd_fcl::PairCache cache;
    for (int i = 0; i < 4; i++)
        row.push_back(placed(box, vec(S(0.9) * S(i), S(0.05) * S(i * i), 0), vec(S(0.05) * S(i), S(0.02), S(0.03))));
    const auto collide = [&](int i, int k) {
        collision r;
        ccd_fcl::collide(&row[std::size_t(i)], &row[std::size_t(k)], contacts(1), r, cache);
        return r.numContacts();
    };
    CHECK(collide(0, 1) && collide(1, 2) && collide(2, 3) && collide(2, 1) && cache.size() == 3, "%zu states", cache.size());
    cache.forget(&row[0]);
    CHECK(cache.size() == 2, "%zu states", cache.size());
    cache.forget(&row[2]);
    CHECK(cache.size() == 0, "%zu states", cache.size());
    collide(0, 1), collide(2, 1);
    cache.next_frame();
    CHECK(cache.size() == 2, "%zu states", cache.size());
    collide(1, 0); /* the other pair is not queried in this frame */
    cache.next_frame();
    CHECK(cache.size() == 1, "%zu states", cache.size());
    cache.next_frame();
    CHECK(cache.size() == 0, "%zu states", cache.size());
    collide(0, 1);
    cache.clear();
    CHECK(cache.size() == 0, "%zu states", cache.size());

    /* The state of the other order is the flipped one. */
    collide(0, 1);
    const ccd_warm_t before = *cache.state(&row[0], &row[1]), other = *cache.state(&row[1], &row[0]);
    ccd_warm_t flipped = before;
    ccdWarmFlip(&flipped);
    CHECK(same_bits(&flipped, &other, sizeof other), "not flipped");
    CHECK(same_bits(&before, cache.state(&row[0], &row[1]), sizeof before), "not flipped back");
    CHECK(!same_bits(&before, &other, sizeof other), "the state does not depend on the order");
}

/* --- pairs that FCL handles itself -------------------------------------------------- */

static void check_pairs_of_fcl(void)
{
    auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSS<S>>>();
    fcl::generateBVHModel(*mesh, fcl::Box<S>(1, 1, 1), fcl::Transform3<S>::Identity());
    auto uncertain = std::make_shared<fcl::Sphere<S>>(S(0.4));
    uncertain->cost_density = S(0.5); /* neither occupied nor free */
    uncertain->threshold_occupied = 1;
    const geometry kinds[] = {mesh, std::make_shared<fcl::Halfspace<S>>(vec(0, 0, 1), 0), uncertain};
    const object ball = placed(std::make_shared<fcl::Sphere<S>>(S(0.3)), vec(0, 0, S(0.7)));
    for (const geometry &kind : kinds) {
        const object other = placed(kind, vec(0, 0, S(0.05)));
        ccd_fcl::PairCache cache;
        collision r, theirs;
        CHECK(!ccd_fcl::is_supported(ball.collisionGeometry().get(), kind.get()), "supported");
        if (SINGLE && kind == mesh)
            continue;
        ccd_fcl::collide(&ball, &other, contacts(10), r, cache);
        fcl::collide(&ball, &other, contacts(10), theirs);
        CHECK(cache.size() == 0 && r.numContacts() == theirs.numContacts(),
              "%zu contacts, FCL %zu", r.numContacts(), theirs.numContacts());
        for (std::size_t i = 0; i < r.numContacts(); i++)
            CHECK(r.getContact(i).penetration_depth == theirs.getContact(i).penetration_depth, "contact %zu", i);
    }
    /* costs */
    const geometry cube = std::make_shared<fcl::Box<S>>(1, 1, 1);
    const object box = placed(cube, vec(0, 0, 0)), near = placed(cube, vec(0, 0, S(0.9)));
    ccd_fcl::PairCache cache;
    collision r;
    fcl::CollisionRequest<S> request = contacts(10);
    request.enable_cost = true;
    ccd_fcl::collide(&box, &near, request, r, cache);
    CHECK(r.numCostSources() == 1, "%zu costs", r.numCostSources());
}

/* --- hulls, invalid input ------------------------------------------------ */

/* Checks hulls with more vertices than are scanned, and with fewer. */
static void check_hulls(void)
{
    const auto fine = fcl_globe(12, 16, vec(1, 1, 1)), coarse = fcl_globe(6, 8, vec(1, 1, 1)); /* 176 and 40 vertices */
    const object table = placed(std::make_shared<fcl::Box<S>>(4, 4, 1), vec(0, 0, S(-0.5)));
    for (const auto &g : {fine, coarse}) {
        uniform_seed(3);
        for (int i = 0; i < 200; i++) {
            const vec about(S(uniform(-2, 2)), S(uniform(-2, 2)), S(uniform(-2, 2)));
            object body = placed(g, vec(0, 0, 0), about);
            S low = 0;
            for (const vec &v : g->getVertices())
                low = std::min(low, (body.getRotation() * v)[2]);
            body.setTranslation(vec(0, 0, S(-0.01) - low));
            ccd_fcl::PairCache cache;
            collision r;
            ccd_fcl::collide(&table, &body, contacts(1), r, cache);
            CHECK(r.isCollision() && std::fabs(r.getContact(0).penetration_depth - S(0.01)) < 1.2e-5 + ROUNDING * 10, "%d: %g", i,
                  r.isCollision() ? double(r.getContact(0).penetration_depth) : -1.0);
        }
    }
}

template <typename Call>
static void check_rejected(const char *what, Call call)
{
    bool thrown = false;
    try {
        call();
    } catch (const std::invalid_argument &) {
        thrown = true;
    }
    CHECK(thrown, "%s", what);
}

static void check_invalid_input(void)
{
    const geometry shapes[] = {std::make_shared<fcl::Box<S>>(1, 1, 1), std::make_shared<fcl::Sphere<S>>(1)};
    const S nan = std::numeric_limits<S>::quiet_NaN(), inf = std::numeric_limits<S>::infinity();
    for (const geometry &shape : shapes)
        for (S bad : {nan, inf}) {
            const object good = placed(shape, vec(0, 0, 0)), lost = placed(shape, vec(0, bad, 0));
            ccd_fcl::PairCache cache;
            collision r;
            proximity d;
            const fcl::DistanceRequest<S> plain, invalid(true, true, 0, 0, nan);
            check_rejected("collide", [&] { ccd_fcl::collide(&good, &lost, contacts(1), r, cache); });
            check_rejected("collide, other order", [&] { ccd_fcl::collide(&lost, &good, contacts(1), r, cache); });
            check_rejected("distance", [&] { ccd_fcl::distance(&good, &lost, plain, d, cache); });
            check_rejected("tolerance", [&] { ccd_fcl::distance(&good, &good, invalid, d, cache); });
            CHECK(!r.isCollision() && d.o1 == nullptr, "written");
        }
}

int main(int argc, char **argv)
{
    check_certified_depths(argc > 1 ? atoi(argv[1]) : 2);
    check_manifolds();
    check_managers();
    check_cache();
    check_pairs_of_fcl();
    check_hulls();
    check_invalid_input();
    return checks_end();
}
