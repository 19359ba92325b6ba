/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks ccd.hpp: the same bits as the C calls that it wraps, shapes of any vector type with and
 * without a center, exceptions thrown by a shape, states copied as values. */

#include <ccd/ccd.hpp>

#include "tests/contract/every_call.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

/* Shape of the C tests with the interface of the wrapper. */
struct Wrapped {
    shape_t shape;

    ccd_vec3_t support(const ccd::Vec3 &dir) const
    {
        const ccd_vec3_t d = dir;
        ccd_vec3_t out;
        shape_support(&shape, &d, &out);
        return out;
    }
    ccd_vec3_t centre() const
    {
        ccd_vec3_t out;
        shape_center(&shape, &out);
        return out;
    }
};

/* The same without a center, with another vector type. */
struct WithoutCenter {
    Wrapped of;

    std::array<ccd_real_t, 3> support(const ccd::Vec3 &dir) const
    {
        const ccd::Vec3 v = of.support(dir);
        return {v.x, v.y, v.z};
    }
};

/* The same with the other spelling of center. */
struct AmericanSpelling {
    Wrapped of;

    ccd_vec3_t support(const ccd::Vec3 &dir) const { return of.support(dir); }
    ccd_vec3_t center() const { return of.centre(); }
};

struct LimitReached : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/* Ball that throws after `left` calls. */
struct ThrowingBall {
    ccd_real_t x;
    mutable int left;

    ccd::Vec3 support(const ccd::Vec3 &d) const
    {
        if (left-- == 0)
            throw LimitReached("support");
        return {x + d.x, d.y, d.z};
    }
    ccd::Vec3 centre() const
    {
        if (left-- == 0)
            throw LimitReached("centre");
        return {x, 0, 0};
    }
};

static bool same(const ccd::Vec3 &a, const ccd_vec3_t &b) { return a.x == b.v[0] && a.y == b.v[1] && a.z == b.v[2]; }

static void check_same(const char *name, const ccd::Penetration &p, int code, const ccd_penetration_t &out)
{
    CHECK(int(p.status) == code, "%s", name);
    if (!p)
        return;
    CHECK(p.depth == out.depth && p.depth_lower == out.depth_lower && same(p.dir, out.dir) &&
              same(p.normal, out.normal) && same(p.pos, out.pos) && same(p.point1, out.point1) &&
              same(p.point2, out.point2) && p.support_points == out.support_points && p.iterations == out.iterations &&
              int(p.cause) == out.status,
          "%s", name);
}

static Wrapped random_wrapped()
{
    Wrapped w{random_shape()};
    shape_move(&w.shape, uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    return w;
}

/* Compares every query, with and without a state, with the C call with the same callbacks. */
static void results_are_those_of_c()
{
    const unsigned all = CCD_WANT_ALL;
    int hits = 0, misses = 0;
    for (int i = 0; i < 500; i++) {
        const Wrapped a = random_wrapped(), b = random_wrapped();
        const shape_t *o1 = &a.shape, *o2 = &b.shape;
        const ccd::Settings settings{CCD_REAL(1e-5)};
        const ccd::Vec3 dir{1, 2, -2};
        const ccd_vec3_t c_dir = dir;
        ccd_t c = shape_query();
        c.mpr_tolerance = c.epa_tolerance = c.dist_tolerance = settings.tolerance;

        ccd::Warm warm;
        ccd_warm_t c_warm;
        memset(&c_warm, 0, sizeof c_warm);
        for (int frame = 0; frame < 2; frame++) {
            ccd_penetration_t out;
            ccd_real_t depth;
            ccd_vec3_t d, pos;
            check_same("global", ccd::penetration(a, b, settings, &warm), ccdPenetration(o1, o2, &c, &c_warm, all, &out), out);
            check_same("local", ccd::penetration_local(a, b, settings, &warm),
                       ccdPenetrationLocal(o1, o2, &c, &c_warm, all, &out), out);
            check_same("incremental", ccd::penetration_incremental(a, b, settings, &warm),
                       ccdPenetrationIncremental(o1, o2, &c, &c_warm, all, &out), out);
            check_same("proven", ccd::penetration_proven(a, b, settings, &warm),
                       ccdPenetrationProven(o1, o2, &c, &c_warm, all, &out), out);
            check_same("along", ccd::penetration_along(a, b, dir, settings, &warm),
                       ccdPenetrationAlong(o1, o2, &c, &c_dir, &c_warm, all, &out), out);
            check_same("planar", ccd::penetration_planar(a, b, dir, settings, &warm),
                       ccdPenetrationPlanar(o1, o2, &c, &c_dir, &c_warm, all, &out), out);

            ccd_distance_t away;
            const ccd::Real m1 = CCD_REAL(0.1), m2 = CCD_REAL(0.05), max = CCD_REAL(0.5);
            int code = ccdSignedDistance(o1, o2, &c, m1, m2, max, &c_warm, all, &away);
            const ccd::Distance distance = ccd::signed_distance(a, b, settings, {m1, m2, max}, &warm);
            CHECK(int(distance.status) == code && distance, "distance");
            CHECK(distance.distance == away.distance && distance.distance_upper == away.distance_upper &&
                      same(distance.normal, away.normal) && same(distance.point1, away.point1) &&
                      same(distance.point2, away.point2) && distance.support_points == away.support_points &&
                      distance.iterations == away.iterations && int(distance.cause) == away.status,
                  "distance");

            code = ccdMPRPenetrationWarm(o1, o2, &c, &c_warm, &depth, &d, &pos);
            const ccd::Penetration mpr = ccd::mpr_penetration(a, b, settings, &warm);
            CHECK(int(mpr.status) == code, "mpr");
            CHECK(!mpr || (mpr.depth == depth && same(mpr.dir, d) && same(mpr.pos, pos)), "mpr");
            (mpr ? hits : misses)++;
            CHECK(ccd::intersect(a, b, &warm) == (ccdIntersect(o1, o2, &c, &c_warm) == 1), "intersect");
            CHECK(ccd::mpr_intersect(a, b, &warm) == (ccdMPRIntersectWarm(o1, o2, &c, &c_warm) == 1), "mpr_intersect");
            CHECK(same_bits(warm.get(), &c_warm, sizeof c_warm), "the state after all queries");
        }

        ccd_contact_t c_contacts[4];
        std::array<ccd::Contact, 4> contacts;
        ccd::ManifoldCache cache{};
        ccd_manifold_cache_t c_cache{};
        const int count = ccd::contacts(a, b, dir, CCD_REAL(0.01), contacts, &cache);
        CHECK(count == ccdContacts(o1, o2, &c, &c_dir, CCD_REAL(0.01), &c_cache, c_contacts, 4) && count >= 1, "contacts");
        for (int k = 0; k < count; k++) {
            const ccd::Contact &p = contacts[static_cast<std::size_t>(k)];
            CHECK(same(p.point1, c_contacts[k].point1) && same(p.point2, c_contacts[k].point2) &&
                      p.depth == c_contacts[k].depth && p.id == c_contacts[k].id && p.id != 0,
                  "contact %d", k);
        }

        ccd_real_t depth;
        ccd_vec3_t d, pos;
        int code = ccdGJKPenetration(o1, o2, &c, &depth, &d, &pos);
        const ccd::Penetration gjk = ccd::gjk_penetration(a, b, settings);
        CHECK(int(gjk.status) == code, "gjk");
        CHECK(!gjk || (gjk.depth == depth && same(gjk.dir, d) && same(gjk.pos, pos)), "gjk");
        code = ccdGJKSeparate(o1, o2, &c, &d);
        const ccd::Separation separation = ccd::gjk_separate(a, b, settings);
        CHECK(int(separation.status) == code && (!separation || same(separation.sep, d)), "gjk_separate");
        CHECK(ccd::gjk_intersect(a, b) == (ccdGJKIntersect(o1, o2, &c) == 1), "gjk_intersect");

        c.center1 = c.center2 = nullptr;
        ccd_penetration_t out;
        const int without = ccdPenetrationLocal(o1, o2, &c, nullptr, all, &out);
        check_same("without centers", ccd::penetration_local(WithoutCenter{a}, WithoutCenter{b}, settings), without, out);
        c.center1 = c.center2 = shape_center;
        const int spelt = ccdPenetrationLocal(o1, o2, &c, nullptr, all, &out);
        check_same("center", ccd::penetration_local(AmericanSpelling{a}, AmericanSpelling{b}, settings), spelt, out);
        check_same("center and centre", ccd::penetration_local(a, AmericanSpelling{b}, settings), spelt, out);
        CHECK(ccd::mpr_intersect(AmericanSpelling{a}, b) == ccd::mpr_intersect(a, b), "center");
        c.center1 = c.center2 = nullptr;
        ccdPenetrationLocal(o1, o2, &c, nullptr, all, &out);
        check_same("one center", ccd::penetration_local(WithoutCenter{a}, b, settings), without, out);
        CHECK(ccd::gjk_intersect(WithoutCenter{a}, WithoutCenter{b}) == ccd::gjk_intersect(a, b), "a foreign vector");
        CHECK(ccd::intersect(WithoutCenter{a}, b) == (ccdIntersect(o1, o2, &c, nullptr) == 1), "intersect without a center");
    }
    CHECK(hits > 100 && misses > 100, "%d hits, %d misses", hits, misses);
}

/* Checks that an exception of a shape, from each of its calls in turn, arrives as it was thrown. */
template <class Query>
static void throws_through(const char *name, Query query)
{
    int caught = 0;
    for (int left = 0;; left++) {
        const ThrowingBall a{0, left}, b{CCD_REAL(1.5), -1};
        try {
            query(a, b);
            break;
        } catch (const LimitReached &e) {
            CHECK(e.what() == std::string("support") || e.what() == std::string("centre"), "%s", name);
            caught++;
        }
    }
    CHECK(caught > 0, "%s calls the shape", name);
}

static void exceptions()
{
#define THROWS(...) throws_through(#__VA_ARGS__, [](auto &a, auto &b) { ccd::__VA_ARGS__; })
    THROWS(intersect(a, b));
    THROWS(mpr_intersect(a, b));
    THROWS(gjk_intersect(a, b));
    THROWS(mpr_penetration(a, b));
    THROWS(gjk_penetration(a, b));
    THROWS(gjk_separate(a, b));
    THROWS(penetration(a, b));
    THROWS(penetration_local(a, b));
    THROWS(penetration_incremental(a, b));
    THROWS(penetration_proven(a, b));
    THROWS(penetration_along(a, b, {0, 1, 0}));
    THROWS(penetration_planar(a, b, {0, 0, 1}));
    THROWS(signed_distance(a, b));
    throws_through("contacts", [](auto &a, auto &b) {
        std::array<ccd::Contact, 2> out;
        ccd::contacts(a, b, {0, 0, 1}, 0, out);
    });

    /* An exception leaves the state unchanged. */
    const ThrowingBall ball{0, -1};
    ccd::Warm warm = ccd::Warm::guess({1, 0, 0});
    ccd::Warm before = warm;
    try {
        ccd::penetration_local(ball, ThrowingBall{CCD_REAL(1.5), 2}, {}, &warm);
        CHECK(false, "nothing thrown");
    } catch (const LimitReached &) {
    }
    CHECK(same_bits(warm.get(), before.get(), sizeof(ccd_warm_t)), "the state after an exception");
}

static void statuses_and_settings()
{
    const ThrowingBall a{0, -1}, b{CCD_REAL(1.5), -1}, far_off{9, -1};
    const ccd_real_t nan = CCD_REAL(0.0) / CCD_REAL(0.0);
    CHECK(!ccd::penetration_local(a, far_off), "apart");
    CHECK(ccd::penetration_local(a, far_off).status == ccd::Status::miss, "apart");
    CHECK(ccd::penetration_local(a, b, {nan}).status == ccd::Status::bad_input, "a NaN tolerance");
    CHECK(ccd::penetration_along(a, b, {0, 0, 0}).status == ccd::Status::bad_input, "no direction");
    std::array<ccd::Contact, 2> room;
    std::array<ccd::Contact, 0> none;
    CHECK(ccd::contacts(a, b, {1, 0, 0}, nan, room) == int(ccd::Status::bad_input), "NaN slop");
    CHECK(ccd::contacts(a, b, {1, 0, 0}, 0, none) == int(ccd::Status::bad_input), "no room");
    CHECK(ccd::mpr_penetration(a, b, {nan}) && ccd::gjk_penetration(a, b, {nan}), "libccd's calls take a default");
    CHECK(ccd::penetration(a, b, {CCD_REAL(1e-4), 1000, 4}).status == ccd::Status::bad_input, "an unknown flag");
    const auto limited = ccd::penetration_local(a, b, {CCD_REAL(1e-5), 0});
    CHECK(limited.status == ccd::Status::limit && limited.cause == ccd::Cause::iteration_limit, "no iterations");
    CHECK(ccd::penetration_proven(a, a).cause == ccd::Cause::support_limit, "concentric");
    CHECK(ccd::signed_distance(a, a).cause == ccd::Cause::support_limit, "concentric");
    CHECK(ccd::penetration(a, b).cause == ccd::Cause::converged, "overlapping");

    /* Results that are not requested are zero. */
    const auto all = ccd::penetration(a, b), nothing = ccd::penetration(a, b, {CCD_REAL(1e-4), 1000, 0});
    const auto pos = ccd::penetration(a, b, {CCD_REAL(1e-4), 1000, ccd::want_pos});
    const ccd_vec3_t zero3{{0, 0, 0}};
    CHECK(nothing && nothing.depth == all.depth && same(nothing.pos, zero3) && same(nothing.point1, zero3), "nothing requested");
    CHECK(same(pos.pos, all.pos) && same(pos.point2, zero3) && !same(all.point2, zero3), "pos alone");
    CHECK(std::string(ccd::implementation()).rfind("warmccd ", 0) == 0, "%s", ccd::implementation());

    /* Of two equal shapes in one place every direction separates equally: the guess decides. */
    ccd::Warm warm = ccd::Warm::guess({0, -5, 0});
    const auto hit = ccd::penetration_local(a, a, {CCD_REAL(1e-5)}, &warm);
    CHECK(hit && hit.dir.y < CCD_REAL(-0.9), "dir %g %g %g", double(hit.dir.x), double(hit.dir.y), double(hit.dir.z));
    warm.flip();
    const auto flipped = ccd::penetration_local(a, a, {CCD_REAL(1e-5)}, &warm);
    CHECK(flipped && flipped.dir.y > CCD_REAL(0.9), "dir %g after a flip", double(flipped.dir.y));
    ccd::Warm zero = ccd::Warm::guess({0, 0, 0}), cold;
    CHECK(same_bits(zero.get(), cold.get(), sizeof(ccd_warm_t)), "a guess of zero is cold");
}

struct WrongSign {
    ccd::Vec3 support(const ccd::Vec3 &d) const { return {-d.x, -d.y, -d.z}; }
};
struct CenterOutside {
    ccd::Vec3 support(const ccd::Vec3 &d) const { return {d.x + 5, d.y, d.z}; }
    ccd::Vec3 center() const { return {}; }
};
struct NotFinite {
    ccd::Vec3 support(const ccd::Vec3 &d) const { return {d.x, d.y, d.z > CCD_REAL(0.9) ? ccd_real_t(NAN) : d.z}; }
};
/* A box: the direction is turned to its frame, the point is not turned back. */
struct NotTurnedBack {
    ccd::Vec3 support(const ccd::Vec3 &d) const
    {
        return {std::copysign(ccd_real_t(1), d.y), std::copysign(ccd_real_t(2), d.z), std::copysign(ccd_real_t(0.5), d.x)};
    }
};
struct Changing {
    mutable int calls;
    ccd::Vec3 support(const ccd::Vec3 &d) const { return ++calls > 200 ? ccd::Vec3{} : d; }
};

/* Checks each fault that ccdCheck reports, by its flag. (Finer faults and their sizes: src/minkowski/validate.rs.) */
static void support_checks()
{
    const auto sign = ccd::check(WrongSign{}), center = ccd::check(CenterOutside{}), valid = ccd::check(ThrowingBall{3, -1});
    CHECK(sign.faults == CCD_CHECK_OPPOSITE, "%u", sign.faults);
    CHECK(center && center.faults == CCD_CHECK_CENTER_OUTSIDE && center.center_outside > 3.9, "%u %g", center.faults,
          double(center.center_outside));
    CHECK(!valid && valid.size > 1.9 && valid.center_outside < 0, "%u %g", valid.faults, double(valid.size));
    CHECK(ccd::check(NotFinite{}).faults == CCD_CHECK_NOT_FINITE, "not finite");
    CHECK(ccd::check(NotTurnedBack{}).faults == CCD_CHECK_CONTRADICTS, "not turned back");
    CHECK(ccd::check(Changing{0}).faults & CCD_CHECK_CHANGES, "changes between calls");

    const shape_t box = shape_box(1, 2, 3);
    ccd_check_t found, before;
    memset(&found, 7, sizeof found);
    before = found;
    CHECK(ccdCheck(&box, nullptr, shape_center, &found) == CCD_BAD_INPUT, "no support function");
    CHECK(same_bits(&found, &before, sizeof found), "written");
    CHECK(ccdCheck(&box, shape_support, nullptr, nullptr) == CCD_CHECK_CENTER_MISSING, "no center, no output");

    /* No shape of the tests has a fault, in any size. */
    for (int type = 0; type < SHAPE_POLYTOPE; type++)
        for (int scale = -6; scale <= 6; scale += 3) {
            const double x = pow(10, scale);
            Wrapped w{shape_make(type, x, .3 * x, 1e-3 * x)};
            turn_at_random(&w.shape);
            shape_move(&w.shape, 4 * x, -70 * x, x);
            CHECK(!ccd::check(w), "type %d, size %g: %u", type, x, ccd::check(w).faults);
        }
}

int main()
{
    results_are_those_of_c();
    exceptions();
    statuses_and_settings();
    support_checks();
    return checks_end();
}
