/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The queries of warm.h, paper.h and ccd.h for C++17, under the same names in C++'s case: header
 * only, no allocation, nothing to free.
 *
 * A shape is ccd::Shape, with the support functions of shapes.h, or any type with
 *
 *     V support(const ccd::Vec3 &dir) const;   a point of the shape farthest along dir (unit)
 *     V center() const;                        a point inside it, the deeper the better; or centre()
 *
 * where V is ccd::Vec3, ccd_vec3_t or anything with v[0], v[1], v[2] (std::array, the vectors
 * of the usual libraries). center() is optional, except for mpr_penetration and mpr_intersect; if both
 * shapes have it, it saves calls of support().
 *
 *     ccd::Warm warm;                               // one for each pair, kept between frames
 *     if (auto hit = ccd::penetration(box, ball, {1e-6}, &warm))
 *         push_apart(hit.depth, hit.dir);           // moving ball by depth * dir separates
 *
 * An exception thrown by a shape passes through the query that called it. Queries on different
 * threads do not disturb each other. */

#ifndef __CCD_CCD_HPP__
#define __CCD_CCD_HPP__

#include <ccd/ccd.h>
#include <ccd/paper.h>
#include <ccd/shapes.h>
#include <ccd/warm.h>

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>

namespace ccd {

/** double, or float where the library is built so. */
using Real = ccd_real_t;

/** A point or a direction, metres. */
struct Vec3 {
    Real x = 0; /**< along the first axis */
    Real y = 0; /**< along the second axis */
    Real z = 0; /**< along the third axis */

    /** Zero. */
    constexpr Vec3() = default;
    /** From three coordinates. */
    constexpr Vec3(Real x_, Real y_, Real z_) : x(x_), y(y_), z(z_) {}
    /** From the vector of the C interface. */
    constexpr Vec3(const ccd_vec3_t &v) : x(v.v[0]), y(v.v[1]), z(v.v[2]) {}
    /** From any vector with v[0], v[1], v[2]. */
    template <class V, class = decltype(static_cast<Real>(std::declval<const V &>()[2]))>
    constexpr Vec3(const V &v)
        : x(static_cast<Real>(v[0])), y(static_cast<Real>(v[1])), z(static_cast<Real>(v[2]))
    {
    }

    /** Coordinate i, 0 to 2. */
    constexpr Real operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    /** The vector of the C interface. */
    constexpr operator ccd_vec3_t() const { return ccd_vec3_t{{x, y, z}}; }
};

/** A ready shape of shapes.h with its pose: sphere, capsule, box, cylinder, cone, ellipsoid or hull. */
struct Shape : ccd_shape_t {
    /** A shape that a function of shapes.h returned. */
    Shape(const ccd_shape_t &shape) : ccd_shape_t(shape) {}

    /** A sphere at the origin. */
    static Shape sphere(Real radius) { return ccdShapeSphere(radius); }
    /** A capsule along z; half: half the length of the segment between the centers of its ends. */
    static Shape capsule(Real radius, Real half) { return ccdShapeCapsule(radius, half); }
    /** A box with these half lengths of its edges. */
    static Shape box(const Vec3 &half) { return ccdShapeBox(half.x, half.y, half.z); }
    /** A cylinder along z; half: half its height. */
    static Shape cylinder(Real radius, Real half) { return ccdShapeCylinder(radius, half); }
    /** A cone along z with its tip at z = half, its base at z = -half. */
    static Shape cone(Real radius, Real half) { return ccdShapeCone(radius, half); }
    /** An ellipsoid with these half axes. */
    static Shape ellipsoid(const Vec3 &half) { return ccdShapeEllipsoid(half.x, half.y, half.z); }
    /** The convex hull of count points (x, y, z of each), which must outlive it. */
    static Shape hull(const Real *points, int count) { return ccdShapeHull(points, count); }
    /** The same for points that are all corners, with their neighbors: see ccdShapeHullWithNeighbors. */
    static Shape hull(const Real *points, int count, const int *first, const int *neighbors)
    {
        return ccdShapeHullWithNeighbors(points, count, first, neighbors);
    }

    /** The shape at a position. */
    Shape at(const Vec3 &position) const
    {
        Shape shape = *this;
        shape.pos = position;
        return shape;
    }
    /** The shape with a rotation, a unit quaternion (x, y, z, w). */
    Shape turned(const ccd_quat_t &rotation) const
    {
        Shape shape = *this;
        shape.quat = rotation;
        return shape;
    }

    /** The point farthest along dir. */
    Vec3 support(const Vec3 &dir) const
    {
        const ccd_vec3_t d = dir;
        ccd_vec3_t point;
        ccdShapeSupport(this, &d, &point);
        return point;
    }
    /** A point inside. */
    Vec3 center() const
    {
        ccd_vec3_t point;
        ccdShapeCenter(this, &point);
        return point;
    }
};

/** Result of a query. */
enum class Status : int {
    hit = CCD_HIT,             /**< overlap: every field is valid */
    limit = CCD_LIMIT,         /**< less exact than requested; cause says why. Overlap, undecided in signed_distance */
    miss = CCD_MISS,           /**< apart, or touching within rounding */
    no_memory = CCD_NO_MEMORY, /**< an allocation failed */
    bad_input = CCD_BAD_INPUT  /**< an argument or a point is invalid, see CCD_BAD_INPUT */
};

/** Why a search ended: the field status in C. Not converged if and only if the Status is limit; mpr_penetration and
 * gjk_penetration, whose status is never limit, do not report it. Which fields are valid: see CCD_STATUS_. */
enum class Cause : int {
    converged = CCD_STATUS_CONVERGED,             /**< within the tolerance */
    iteration_limit = CCD_STATUS_ITERATION_LIMIT, /**< Settings::max_iterations was reached */
    support_limit = CCD_STATUS_SUPPORT_LIMIT,     /**< the library's own limit of support points was reached */
    rounding = CCD_STATUS_ROUNDING,               /**< more support points would not help */
    inconsistent_support = CCD_STATUS_INCONSISTENT_SUPPORT /**< two points of a support function contradict each other, or a center is outside */
};

/** Optional outputs, combined by `|`. Depth, bounds and directions are always written. */
enum Want : unsigned {
    want_pos = CCD_WANT_POS,       /**< pos: costs support points, see CCD_WANT_POS */
    want_points = CCD_WANT_POINTS, /**< point1 and point2: cost nothing */
    want_all = CCD_WANT_ALL        /**< everything */
};

/** Tolerance, iteration limit and optional outputs of a query. */
struct Settings {
    Real tolerance = CCD_REAL(1e-4);                               /**< largest error of the depth, metres */
    unsigned long max_iterations = static_cast<unsigned long>(-1); /**< as in ccd_t */
    unsigned want = want_all;                                      /**< optional outputs; the others are zero */
};

/** Result of a penetration query. All fields except the status are zero unless that is hit or limit. */
struct Penetration {
    Status status = Status::miss; /**< hit and limit: there is an answer */
    Real depth = 0;               /**< metres, >= 0: moving the second shape by depth * dir separates them */
    Real depth_lower = 0;         /**< lower bound of the least depth, 0 if there is none */
    Vec3 dir;                     /**< unit; moving the second shape along it separates the shapes */
    Vec3 normal;                  /**< unit; of the separating plane; equal to dir except in penetration_along */
    Vec3 pos;                     /**< contact position */
    Vec3 point1;                  /**< witness point of the first shape */
    Vec3 point2;                  /**< witness point of the second shape */
    unsigned long support_points = 0; /**< half of the calls of both support functions */
    unsigned long iterations = 0;    /**< of the solver */
    Cause cause = Cause::converged;  /**< why the search ended */

    /** Returns whether the shapes overlap. */
    explicit operator bool() const { return status == Status::hit || status == Status::limit; }
};

/** One point of a contact manifold. */
struct Contact {
    Vec3 point1;    /**< of the first shape */
    Vec3 point2;    /**< of the second shape: point1 - depth * normal */
    Real depth = 0; /**< metres; negative where the shapes are apart */
    unsigned id = 0; /**< contact id: the same while the contact moves with either shape, never 0; 0 without a cache */
};

/** Result of signed_distance. All fields but the status are zero where that is bad_input or no_memory. */
struct Distance {
    Status status = Status::bad_input; /**< hit, miss and limit: there is an answer */
    Real distance = 0;            /**< metres: the gap along normal, or minus the depth; never above the truth */
    Real distance_upper = 0;      /**< never below the truth */
    Vec3 normal;                  /**< unit; from the first shape to the second */
    Vec3 point1;                  /**< witness point of the first shape, on its surface with its margin */
    Vec3 point2;                  /**< of the second shape */
    unsigned long support_points = 0; /**< half of the calls of both support functions */
    unsigned long iterations = 0;    /**< of the solver */
    Cause cause = Cause::converged;  /**< why the search ended */

    /** Returns whether the other fields are valid. */
    explicit operator bool() const { return status != Status::bad_input && status != Status::no_memory; }
};

/** Parameters of signed_distance, metres. */
struct DistanceOptions {
    Real margin1 = 0; /**< radius of a ball added all around the first shape */
    Real margin2 = 0; /**< and around the second */
    Real max_distance = std::numeric_limits<Real>::infinity(); /**< greater distances are not refined */
};

/** Result of gjk_separate. `sep` is zero unless the status is hit. */
struct Separation {
    Status status = Status::miss; /**< hit: there is an answer */
    Vec3 sep;                     /**< metres: moving the second shape by it separates them */

    /** Returns whether the shapes overlap. */
    explicit operator bool() const { return status == Status::hit; }
};

/** Warm-start state of one pair. A value: cold when constructed, may be copied. */
class Warm {
public:
    /** Cold. */
    Warm() = default;

    /** A new state that starts from dir, a guess of the direction in which the second shape separates, of
     * any length; zero or not finite: cold. */
    static Warm guess(const Vec3 &dir)
    {
        Warm warm;
        const ccd_vec3_t d = dir;
        ccdWarmGuess(&warm.state_, &d);
        return warm;
    }

    /** For the same two shapes in the other order. */
    void flip() { ccdWarmFlip(&state_); }

    /** The state, for a call of the C interface. */
    ccd_warm_t *get() { return &state_; }

private:
    ccd_warm_t state_{};
};

/** Contact cache of one pair, in either order. A value: empty when value-initialised, may be copied. */
using ManifoldCache = ccd_manifold_cache_t;

/** Result of check. Lengths are metres. */
struct Check {
    unsigned faults = 0;     /**< CCD_CHECK_ flags of warm.h; 0: nothing */
    Real size = 0;           /**< approximate greatest width of the shape */
    Real noise = 0;          /**< how far a point lies beyond another's support plane, at most */
    Real change = 0;         /**< how far a support point moved when queried again, at most */
    Real center_outside = 0; /**< how far the center lies outside; negative: how deep inside */
    Vec3 dir;                /**< unit: the direction in which the worst was found */

    /** Returns whether a fault was found. */
    explicit operator bool() const { return faults != 0; }
};

namespace detail {

/** A shape may name its center() centre() as well; where it has both, center() is called. */
template <class S, class = void>
struct has_center : std::false_type {};
template <class S>
struct has_center<S, std::void_t<decltype(Vec3(std::declval<const S &>().center()))>> : std::true_type {};
template <class S, class = void>
struct has_centre : has_center<S> {};
template <class S>
struct has_centre<S, std::void_t<decltype(Vec3(std::declval<const S &>().centre()))>> : std::true_type {};

template <class S>
void support(const void *shape, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    *out = Vec3(static_cast<const S *>(shape)->support(Vec3(*dir)));
}

template <class S>
void centre(const void *shape, ccd_vec3_t *out)
{
    if constexpr (has_center<S>::value)
        *out = Vec3(static_cast<const S *>(shape)->center());
    else
        *out = Vec3(static_cast<const S *>(shape)->centre());
}

template <class S>
constexpr ccd_center_fn centre_of()
{
    if constexpr (has_centre<S>::value)
        return centre<S>;
    else
        return nullptr;
}

template <class A, class B>
ccd_t make_ccd(const Settings &settings)
{
    ccd_t c;
    CCD_INIT(&c);
    c.support1 = support<A>;
    c.support2 = support<B>;
    c.center1 = centre_of<A>();
    c.center2 = centre_of<B>();
    c.max_iterations = settings.max_iterations;
    c.mpr_tolerance = c.epa_tolerance = c.dist_tolerance = settings.tolerance;
    return c;
}

template <class A, class B>
constexpr void require_centers()
{
    static_assert(has_centre<A>::value && has_centre<B>::value, "MPR needs the center() of both shapes");
}

inline ccd_warm_t *state(Warm *warm) { return warm ? warm->get() : nullptr; }

inline Penetration penetration(int code, const ccd_penetration_t &out)
{
    Penetration p;
    p.status = static_cast<Status>(code);
    if (p) {
        p.depth = out.depth;
        p.depth_lower = out.depth_lower;
        p.dir = out.dir;
        p.normal = out.normal;
        p.pos = out.pos;
        p.point1 = out.point1;
        p.point2 = out.point2;
        p.support_points = out.support_points;
        p.iterations = out.iterations;
        p.cause = static_cast<Cause>(out.status);
    }
    return p;
}

/* Calls a query with libccd's three outputs; pos only if it is requested. */
template <class Query>
Penetration call_libccd(const Settings &settings, Query query)
{
    ccd_penetration_t out{};
    const int code = query(&out.depth, &out.dir, settings.want & want_pos ? &out.pos : nullptr);
    out.normal = out.dir;
    return penetration(code, out);
}

} // namespace detail

/** Computes the penetration depth within the larger of the tolerance and 0.1 % (ccdPenetration). The
 * default query. */
template <class A, class B>
Penetration penetration(const A &a, const B &b, const Settings &settings = {}, Warm *warm = nullptr)
{
    const ccd_t c = detail::make_ccd<A, B>(settings);
    ccd_penetration_t out{};
    const int code =
        ccdPenetration(std::addressof(a), std::addressof(b), &c, detail::state(warm), settings.want, &out);
    return detail::penetration(code, out);
}

/** Returns whether the shapes overlap; touching shapes do not (ccdIntersect). With a state a separated pair
 * costs one call of each support() while its last separating axis still separates. */
template <class A, class B>
bool intersect(const A &a, const B &b, Warm *warm = nullptr)
{
    const ccd_t c = detail::make_ccd<A, B>({});
    return ccdIntersect(std::addressof(a), std::addressof(b), &c, detail::state(warm)) == 1;
}

/** Computes the signed distance: positive apart, negative overlapping, continuous at contact
 * (ccdSignedDistance). Each shape is inflated by its margin. */
template <class A, class B>
Distance signed_distance(const A &a, const B &b, const Settings &settings = {}, const DistanceOptions &options = {},
                         Warm *warm = nullptr)
{
    const ccd_t c = detail::make_ccd<A, B>(settings);
    ccd_distance_t out{};
    Distance d;
    d.status = static_cast<Status>(ccdSignedDistance(std::addressof(a), std::addressof(b), &c, options.margin1,
                                                     options.margin2, options.max_distance, detail::state(warm),
                                                     settings.want, &out));
    if (d) {
        d.distance = out.distance;
        d.distance_upper = out.distance_upper;
        d.normal = out.normal;
        d.point1 = out.point1;
        d.point2 = out.point2;
        d.support_points = out.support_points;
        d.iterations = out.iterations;
        d.cause = static_cast<Cause>(out.status);
    }
    return d;
}

/** Computes up to N contacts of the faces along normal, the deepest first (ccdContacts). Returns their
 * number, or the value of Status::bad_input. With a cache contacts keep their ids
 * and take half the support calls. */
template <std::size_t N, class A, class B>
int contacts(const A &a, const B &b, const Vec3 &normal, Real slop, std::array<Contact, N> &out,
             ManifoldCache *cache = nullptr)
{
    const ccd_t c = detail::make_ccd<A, B>({});
    const ccd_vec3_t n = normal;
    ccd_contact_t found[N > 0 ? N : 1];
    const int count =
        ccdContacts(std::addressof(a), std::addressof(b), &c, &n, slop, cache, found, static_cast<int>(N));
    for (int i = 0; i < count; i++) {
        Contact &point = out[static_cast<std::size_t>(i)];
        point.point1 = found[i].point1;
        point.point2 = found[i].point2;
        point.depth = found[i].depth;
        point.id = found[i].id;
    }
    return count;
}

/** Computes a local minimum of the depth, from the state, else from the centers (ccdPenetrationLocal). */
template <class A, class B>
Penetration penetration_local(const A &a, const B &b, const Settings &settings = {}, Warm *warm = nullptr)
{
    const ccd_t c = detail::make_ccd<A, B>(settings);
    ccd_penetration_t out{};
    const int code =
        ccdPenetrationLocal(std::addressof(a), std::addressof(b), &c, detail::state(warm), settings.want, &out);
    return detail::penetration(code, out);
}

/** Computes the least depth, proven: depth - depth_lower <= tolerance (ccdPenetrationProven). */
template <class A, class B>
Penetration penetration_proven(const A &a, const B &b, const Settings &settings = {}, Warm *warm = nullptr)
{
    const ccd_t c = detail::make_ccd<A, B>(settings);
    ccd_penetration_t out{};
    const int code =
        ccdPenetrationProven(std::addressof(a), std::addressof(b), &c, detail::state(warm), settings.want, &out);
    return detail::penetration(code, out);
}

/** Computes how far b must move along dir (of any length) to be separated (ccdPenetrationAlong). */
template <class A, class B>
Penetration penetration_along(const A &a, const B &b, const Vec3 &dir, const Settings &settings = {},
                              Warm *warm = nullptr)
{
    const ccd_t c = detail::make_ccd<A, B>(settings);
    const ccd_vec3_t d = dir;
    ccd_penetration_t out{};
    const int code =
        ccdPenetrationAlong(std::addressof(a), std::addressof(b), &c, &d, detail::state(warm), settings.want, &out);
    return detail::penetration(code, out);
}

/** Computes a local minimum of the depth over the directions in a plane with this normal, of any length, for
 * shapes that lie in such a plane (ccdPenetrationPlanar). */
template <class A, class B>
Penetration penetration_planar(const A &a, const B &b, const Vec3 &plane_normal, const Settings &settings = {},
                               Warm *warm = nullptr)
{
    const ccd_t c = detail::make_ccd<A, B>(settings);
    const ccd_vec3_t n = plane_normal;
    ccd_penetration_t out{};
    const int code =
        ccdPenetrationPlanar(std::addressof(a), std::addressof(b), &c, &n, detail::state(warm), settings.want, &out);
    return detail::penetration(code, out);
}

/** Computes a local minimum by the paper's method as published (ccdPenetrationIncremental). */
template <class A, class B>
Penetration penetration_incremental(const A &a, const B &b, const Settings &settings = {}, Warm *warm = nullptr)
{
    const ccd_t c = detail::make_ccd<A, B>(settings);
    ccd_penetration_t out{};
    const int code =
        ccdPenetrationIncremental(std::addressof(a), std::addressof(b), &c, detail::state(warm), settings.want, &out);
    return detail::penetration(code, out);
}

/** Computes depth, dir and pos as libccd's call ccdMPRPenetration, with a state (ccdMPRPenetrationWarm). */
template <class A, class B>
Penetration mpr_penetration(const A &a, const B &b, const Settings &settings = {}, Warm *warm = nullptr)
{
    detail::require_centers<A, B>();
    const ccd_t c = detail::make_ccd<A, B>(settings);
    return detail::call_libccd(settings, [&](Real *depth, ccd_vec3_t *dir, ccd_vec3_t *pos) {
        return ccdMPRPenetrationWarm(std::addressof(a), std::addressof(b), &c, detail::state(warm), depth, dir, pos);
    });
}

/** Returns whether the shapes overlap, as libccd's call ccdMPRIntersect, with a state (ccdMPRIntersectWarm). */
template <class A, class B>
bool mpr_intersect(const A &a, const B &b, Warm *warm = nullptr)
{
    detail::require_centers<A, B>();
    const ccd_t c = detail::make_ccd<A, B>({});
    return ccdMPRIntersectWarm(std::addressof(a), std::addressof(b), &c, detail::state(warm)) == 1;
}

/** Computes depth, dir and pos without centers (ccdGJKPenetration). */
template <class A, class B>
Penetration gjk_penetration(const A &a, const B &b, const Settings &settings = {})
{
    const ccd_t c = detail::make_ccd<A, B>(settings);
    return detail::call_libccd(settings, [&](Real *depth, ccd_vec3_t *dir, ccd_vec3_t *pos) {
        return ccdGJKPenetration(std::addressof(a), std::addressof(b), &c, depth, dir, pos);
    });
}

/** Computes the shortest translation of b that separates the shapes, without centers (ccdGJKSeparate). */
template <class A, class B>
Separation gjk_separate(const A &a, const B &b, const Settings &settings = {})
{
    const ccd_t c = detail::make_ccd<A, B>(settings);
    ccd_vec3_t sep{};
    Separation s;
    s.status = static_cast<Status>(ccdGJKSeparate(std::addressof(a), std::addressof(b), &c, &sep));
    if (s)
        s.sep = sep;
    return s;
}

/** Returns whether the shapes overlap, without centers (ccdGJKIntersect). */
template <class A, class B>
bool gjk_intersect(const A &a, const B &b)
{
    const ccd_t c = detail::make_ccd<A, B>({});
    return ccdGJKIntersect(std::addressof(a), std::addressof(b), &c) == 1;
}

/** Checks a shape's support function along 192 directions, each queried twice (ccdCheck). For tests, and
 * where an answer looks wrong. A shape without center() is no fault. */
template <class S>
Check check(const S &shape)
{
    ccd_check_t found{};
    const int faults = ccdCheck(std::addressof(shape), detail::support<S>, detail::centre_of<S>(), &found);
    Check c;
    c.faults = static_cast<unsigned>(faults) & ~static_cast<unsigned>(CCD_CHECK_CENTER_MISSING);
    c.size = found.size;
    c.noise = found.noise;
    c.change = found.change;
    c.center_outside = found.center_outside;
    c.dir = found.dir;
    return c;
}

/** Which library runs, and in which precision: ccdImplementation. */
inline const char *implementation() { return ccdImplementation(); }

} // namespace ccd

#endif
