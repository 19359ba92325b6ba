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

/* --- the calls by number ---------------------------------------------------------------- */

/* Stores the outputs that libccd's calls have. */
static int store_depth(const ccd::Penetration &p, const call_args_t &args)
{
    if (p) {
        *args.depth = p.depth;
        *args.dir = p.dir;
    }
    if (p && args.pos)
        *args.pos = p.pos;
    return int(p.status);
}

/* Makes the C++ form of a call and stores its result as the C call does. Returns the code of the C call. */
template <class A, class B>
static int call_in_cpp(int number, const A &a, const B &b, const ccd::Settings &settings, ccd::Warm *warm, const call_args_t &args)
{
    const ccd::Vec3 along = *args.along;
    ccd::Penetration p;
    switch (number) {
    case CALL_INTERSECT: return ccd::intersect(a, b, warm);
    case CALL_GJK_INTERSECT: return ccd::gjk_intersect(a, b);
    case CALL_GJK: return store_depth(ccd::gjk_penetration(a, b, settings), args);
    case CALL_SEPARATE: {
        const ccd::Separation s = ccd::gjk_separate(a, b, settings);
        if (s)
            *args.dir = s.sep;
        return int(s.status);
    }
    case CALL_PENETRATION: p = ccd::penetration(a, b, settings, warm); break;
    case CALL_LOCAL: p = ccd::penetration_local(a, b, settings, warm); break;
    case CALL_INCREMENTAL: p = ccd::penetration_incremental(a, b, settings, warm); break;
    case CALL_PROVEN: p = ccd::penetration_proven(a, b, settings, warm); break;
    case CALL_ALONG: p = ccd::penetration_along(a, b, along, settings, warm); break;
    case CALL_PLANAR: p = ccd::penetration_planar(a, b, along, settings, warm); break;
    case CALL_DISTANCE: {
        const ccd::DistanceOptions options{args.margin1, args.margin2, args.max_distance};
        const ccd::Distance d = ccd::signed_distance(a, b, settings, options, warm);
        if (d)
            *args.distance = {d.distance, d.distance_upper, d.normal, d.point1, d.point2, d.support_points, d.iterations,
                              int(d.cause)};
        return int(d.status);
    }
    case CALL_CONTACTS: {
        std::array<ccd::Contact, 4> found;
        const int count = ccd::contacts(a, b, along, args.slop, found, args.cache);
        for (int i = 0; i < count; i++) {
            const ccd::Contact &c = found[static_cast<std::size_t>(i)];
            args.contacts[i] = {c.point1, c.point2, c.depth, c.id};
        }
        return count;
    }
    default: /* the C++ forms of MPR's calls are the warm ones */
        if constexpr (ccd::detail::has_centre<A>::value && ccd::detail::has_centre<B>::value)
            return number == CALL_MPR || number == CALL_MPR_WARM
                ? store_depth(ccd::mpr_penetration(a, b, settings, number == CALL_MPR ? nullptr : warm), args)
                : ccd::mpr_intersect(a, b, number == CALL_MPR_INTERSECT ? nullptr : warm);
    }
    if (p)
        *args.penetration = {p.depth, p.depth_lower, p.dir, p.normal, p.pos, p.point1, p.point2, p.support_points, p.iterations,
                             int(p.cause)};
    return int(p.status);
}

/* --- the same bits as in C ---------------------------------------------------------------- */

static int hits, misses;

/* Makes every call on two bodies, which are these shapes of the C tests, in both languages. */
template <class A, class B>
static void compare(const A &a, const B &b, const shape_t &shape1, const shape_t &shape2, const ccd::Settings &settings)
{
    const ccd_vec3_t directions[] = {{{1, 2, -2}}, {{0, 0, 0}}};
    ccd_t c = shape_query();
    c.mpr_tolerance = c.epa_tolerance = c.dist_tolerance = settings.tolerance;
    c.max_iterations = settings.max_iterations;
    const bool has_center1 = ccd::detail::has_centre<A>::value, has_center2 = ccd::detail::has_centre<B>::value;
    c.center1 = has_center1 ? shape_center : nullptr;
    c.center2 = has_center2 ? shape_center : nullptr;
    ccd::Warm warm = ccd::Warm::guess(directions[0]);
    ccd_warm_t c_warm;
    ccd_manifold_cache_t cache{}, c_cache{};
    ccdWarmGuess(&c_warm, &directions[0]);
    for (int frame = 0; frame < 2; frame++)
        for (const call_t &call : call_table) {
            if (call.traits & FROM_CENTERS && !(has_center1 && has_center2))
                continue;
            static results_t in_c, in_cpp;
            const ccd_vec3_t *const along = &directions[random_below(8) == 0];
            const auto arguments = [&](results_t *results, ccd_manifold_cache_t *its_cache) {
                memset(results, 0, sizeof *results);
                call_args_t args = valid_arguments(&call, results);
                args.warm = &c_warm;
                args.cache = its_cache;
                args.margin1 = CCD_REAL(0.1);
                args.margin2 = CCD_REAL(0.05);
                args.max_distance = CCD_REAL(0.5);
                args.want = settings.want;
                args.along = along;
                args.pos = settings.want & CCD_WANT_POS ? args.pos : nullptr;
                return args;
            };
            const call_args_t c_args = arguments(&in_c, &c_cache), args = arguments(&in_cpp, &cache);
            const int code = call_library(call.number, &shape1, &shape2, &c, &c_args);
            (code == call.miss ? misses : hits)++;
            CHECK(call_in_cpp(call.number, a, b, settings, &warm, args) == code, "%s: not %d", call.name, code);
            CHECK(same_results(&in_c, &in_cpp), "%s: another result", call.name);
            CHECK(same_bits(warm.get(), &c_warm, sizeof c_warm), "%s: another state", call.name);
            CHECK(same_bits(&cache, &c_cache, sizeof cache), "%s: another cache", call.name);
        }
    warm.flip();
    ccdWarmFlip(&c_warm);
    CHECK(same_bits(warm.get(), &c_warm, sizeof c_warm), "another flipped state");
}

static void results_are_those_of_c()
{
    const ccd_real_t nan = CCD_REAL(0.0) / CCD_REAL(0.0), tolerance = CCD_REAL(1e-5);
    const ccd::Settings all_settings[] = {{},           {tolerance},       {nan}, {tolerance, 0}, {tolerance, 1000, 0},
                                          {tolerance, 1000, ccd::want_pos}, {tolerance, 1000, 4}};
    for (int i = 0; i < 300; i++)
        for (const ccd::Settings &settings : all_settings) {
            Wrapped a{random_shape()}, b{random_shape()};
            shape_move(&b.shape, uniform(-2, 2), uniform(-1, 1), uniform(-1, 1));
            compare(a, b, a.shape, b.shape, settings);
            compare(a, AmericanSpelling{b}, a.shape, b.shape, settings);
            compare(AmericanSpelling{a}, WithoutCenter{b}, a.shape, b.shape, settings);
            compare(WithoutCenter{a}, WithoutCenter{b}, a.shape, b.shape, settings);
        }
    CHECK(hits > 10000 && misses > 10000, "%d hits, %d misses", hits, misses);
}

/* --- exceptions --------------------------------------------------------------------------- */

/* Checks that an exception of a shape, from each of its calls in turn, arrives as it was thrown, and that the state is
 * unchanged. */
static void exceptions(const call_t &call)
{
    int caught = 0;
    for (int left = 0;; left++) {
        results_t results;
        const ThrowingBall a{0, left}, b{CCD_REAL(1.5), -1};
        ccd::Warm warm = ccd::Warm::guess({1, 0, 0}), before = warm;
        try {
            call_in_cpp(call.number, a, b, {}, &warm, valid_arguments(&call, &results));
            break;
        } catch (const LimitReached &e) {
            CHECK(e.what() == std::string("support") || e.what() == std::string("centre"), "%s", call.name);
            CHECK(same_bits(warm.get(), before.get(), sizeof(ccd_warm_t)), "%s: the state after an exception", call.name);
            caught++;
        }
    }
    CHECK(caught > 0, "%s calls the shape", call.name);
}

/* Checks what a result is as a condition. */
static void conditions()
{
    const ThrowingBall a{0, -1}, b{CCD_REAL(1.5), -1}, far_off{9, -1};
    std::array<ccd::Contact, 0> none;
    CHECK(!ccd::penetration_local(a, far_off) && ccd::signed_distance(a, far_off), "apart");
    CHECK(ccd::penetration_local(a, far_off).status == ccd::Status::miss, "apart");
    CHECK(!ccd::penetration_along(a, b, {0, 0, 0}) && !ccd::signed_distance(a, b, {}, {-1}), "invalid");
    CHECK(ccd::penetration_local(a, b, {CCD_REAL(1e-5), 0}).cause == ccd::Cause::iteration_limit, "no iterations");
    const auto limited = ccd::penetration_proven(a, a);
    CHECK(limited && limited.status == ccd::Status::limit && limited.cause == ccd::Cause::support_limit, "concentric");
    CHECK(ccd::contacts(a, b, {1, 0, 0}, 0, none) == int(ccd::Status::bad_input), "no room");
    CHECK(std::string(ccd::implementation()).rfind("warmccd ", 0) == 0, "%s", ccd::implementation());
}

/* A ball with one fault of ccdCheck. */
struct Faulty {
    unsigned fault;
    mutable int calls;

    ccd::Vec3 support(const ccd::Vec3 &d) const
    {
        switch (fault) {
        case CCD_CHECK_OPPOSITE: return {-d.x, -d.y, -d.z};
        case CCD_CHECK_NOT_FINITE: return {d.x, d.y, d.z > CCD_REAL(0.9) ? ccd_real_t(NAN) : d.z};
        case CCD_CHECK_CONTRADICTS: /* a box: the direction is turned to its frame, the point is not turned back */
            return {std::copysign(ccd_real_t(1), d.y), std::copysign(ccd_real_t(2), d.z), std::copysign(ccd_real_t(0.5), d.x)};
        case CCD_CHECK_CHANGES: return ++calls > 200 ? ccd::Vec3{} : d;
        default: return d;
        }
    }
    ccd::Vec3 center() const { return {fault == CCD_CHECK_CENTER_OUTSIDE ? ccd_real_t(5) : 0, 0, 0}; }
};

/* Checks each fault that ccdCheck reports, by its flag. (Finer faults and their sizes: src/minkowski/validate.rs.) */
static void support_checks()
{
    for (const unsigned fault : {CCD_CHECK_OPPOSITE, CCD_CHECK_NOT_FINITE, CCD_CHECK_CONTRADICTS, CCD_CHECK_CHANGES,
                                 CCD_CHECK_CENTER_OUTSIDE}) {
        const auto found = ccd::check(Faulty{fault, 0});
        CHECK(found && (fault == CCD_CHECK_CHANGES ? found.faults & fault : found.faults == fault), "fault %u: %u", fault,
              found.faults);
        CHECK(fault != CCD_CHECK_CENTER_OUTSIDE || found.center_outside > 3.9, "%g outside", double(found.center_outside));
    }
    const auto valid = ccd::check(ThrowingBall{3, -1});
    CHECK(!valid && valid.size > 1.9 && valid.center_outside < 0, "%u %g", valid.faults, double(valid.size));

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

/* Every ready shape is the one of shapes.h, and a query takes it. */
static void ready_shapes()
{
    static const ccd::Real points[] = {1, 0, 0, -1, 1, 0, -1, -1, 0, 0, 0, 1};
    static const int first[] = {0, 3, 6, 9, 12}, neighbors[] = {1, 2, 3, 0, 2, 3, 0, 1, 3, 0, 1, 2};
    const std::pair<ccd::Shape, ccd_shape_t> pairs[] = {
        {ccd::Shape::sphere(2), ccdShapeSphere(2)},
        {ccd::Shape::capsule(1, 2), ccdShapeCapsule(1, 2)},
        {ccd::Shape::box({1, 2, 3}), ccdShapeBox(1, 2, 3)},
        {ccd::Shape::cylinder(1, 2), ccdShapeCylinder(1, 2)},
        {ccd::Shape::cone(1, 2), ccdShapeCone(1, 2)},
        {ccd::Shape::ellipsoid({1, 2, 3}), ccdShapeEllipsoid(1, 2, 3)},
        {ccd::Shape::hull(points, 4), ccdShapeHull(points, 4)},
        {ccd::Shape::hull(points, 4, first, neighbors), ccdShapeHullWithNeighbors(points, 4, first, neighbors)},
    };
    for (const auto &pair : pairs) {
        const ccd_quat_t quat = {{CCD_REAL(0.5), CCD_REAL(0.5), CCD_REAL(0.5), CCD_REAL(0.5)}};
        const ccd::Shape shape = pair.first.at({1, 2, 3}).turned(quat);
        ccd_shape_t in_c = pair.second;
        ccdVec3Set(&in_c.pos, 1, 2, 3);
        in_c.quat = quat;
        for (int i = 0; i < 50; i++) {
            const ccd_vec3_t d = random_vec3(1), p = shape.support(d), c = shape.center();
            ccd_vec3_t q, center;
            ccdShapeSupport(&in_c, &d, &q);
            ccdShapeCenter(&in_c, &center);
            CHECK(same_bits(&p, &q, sizeof p) && same_bits(&c, &center, sizeof c), "kind %d", in_c.kind);
        }
        CHECK(!ccd::check(shape), "kind %d", in_c.kind);
        CHECK(ccd::penetration(shape, ccd::Shape::sphere(1).at({1, 2, 3})), "kind %d", in_c.kind);
    }
}

int main()
{
    results_are_those_of_c();
    for (const call_t &call : call_table)
        exceptions(call);
    conditions();
    support_checks();
    ready_shapes();
    return checks_end();
}
