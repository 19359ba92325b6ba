/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The queries of ccd.h and warm.h for C++17: header only, no allocation, nothing to free.
 *
 * A shape is any type with
 *
 *     V support(const ccd::Vec3 &dir) const;   a point of the shape farthest along dir (unit)
 *     V center() const;                        a point inside it, the deeper the better; or centre()
 *
 * where V is ccd::Vec3, ccd_vec3_t or anything with v[0], v[1], v[2] (std::array, the vectors
 * of the usual libraries). centre() is needed by the MPR queries; penetration_local,
 * _incremental, _minimum, _along and _planar use it where both shapes have it; the GJK queries
 * never do.
 *
 *     ccd::Warm warm;                               // one for each pair, kept between frames
 *     if (auto hit = ccd::penetration_local(box, ball, {1e-6}, &warm))
 *         push_apart(hit.depth, hit.dir);           // moving ball by depth * dir separates
 *
 * An exception thrown by a shape leaves through the query that asked it. Queries on different
 * threads do not disturb each other. */

#ifndef __CCD_CCD_HPP__
#define __CCD_CCD_HPP__

#include <ccd/ccd.h>
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

/** What came of a query. */
enum class Status : int {
    hit = CCD_HIT,             /**< overlap: every field is valid */
    miss = CCD_MISS,           /**< apart */
    no_memory = CCD_NO_MEMORY, /**< memory was needed and not to be had */
    bad_input = CCD_BAD_INPUT, /**< a tolerance, a direction or a shape's answer is no number */
    limit = CCD_LIMIT          /**< max_iterations came first: the best sound answer is valid */
};

/** How exact, and with how much work. */
struct Settings {
    Real tolerance = CCD_REAL(1e-4);                           /**< largest error of the depth, metres */
    unsigned long max_iterations = static_cast<unsigned long>(-1); /**< cap on every loop */
};

/** An overlap. Zero but for the status unless the status is hit or limit. */
struct Contact {
    Status status = Status::miss; /**< hit and limit: there is an answer */
    Real depth = 0; /**< metres, >= 0: moving the second shape by depth * dir separates them */
    Vec3 dir;       /**< unit; the way the second shape moves */
    Vec3 pos;       /**< contact position */

    /** Is there an answer? */
    explicit operator bool() const { return status == Status::hit || status == Status::limit; }
};

/** An overlap with its bounds and its witness points. */
struct Penetration : Contact {
    Real depth_lower = 0;         /**< proven lower bound on the least depth, 0 where there is none */
    Vec3 normal;                  /**< unit; of the separating plane; dir but in penetration_along */
    Vec3 point1;                  /**< witness point of the first shape */
    Vec3 point2;                  /**< witness point of the second shape; pos is their middle */
    unsigned long supports = 0;   /**< calls of each shape's support() */
    unsigned long iterations = 0; /**< of the solver */
};

/** One point of a contact manifold. */
struct ContactPoint {
    Vec3 point1;    /**< of the first shape */
    Vec3 point2;    /**< of the second shape: point1 - depth * normal */
    Real depth = 0; /**< metres; negative where the shapes are apart */
};

/** How far apart, or how deep. Zero but for the status where that is bad_input or no_memory. */
struct Distance {
    Status status = Status::bad_input; /**< hit, miss and limit: there is an answer */
    Real distance = 0;            /**< metres: the gap along normal, or minus the depth; never above the truth */
    Real distance_upper = 0;      /**< never below the truth */
    Vec3 normal;                  /**< unit; from the first shape to the second */
    Vec3 point1;                  /**< witness point of the first shape, on its surface with its margin */
    Vec3 point2;                  /**< of the second shape */
    unsigned long supports = 0;   /**< calls of each shape's support() */
    unsigned long iterations = 0; /**< of the solver */

    /** Is there an answer? */
    explicit operator bool() const { return status != Status::bad_input && status != Status::no_memory; }
};

/** Balls added all around two shapes, and how far their distance matters, metres. */
struct Margins {
    Real margin1 = 0; /**< around the first shape */
    Real margin2 = 0; /**< around the second shape */
    Real beyond = std::numeric_limits<Real>::infinity(); /**< farther is not refined */
};

/** What one query of a pair leaves for the next: a value, cold at first, copied freely. */
class Warm {
public:
    /** Cold. */
    Warm() = default;

    /** A fresh state that starts from dir, a guess of the way the second shape leaves: of any
     * length; zero or no number is cold. */
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

namespace detail {

/** center() and centre() are one to the library; a shape that has both is asked the first. */
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
ccd_t query(const Settings &settings)
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
constexpr void needs_centres()
{
    static_assert(has_centre<A>::value && has_centre<B>::value, "MPR needs the center() of both shapes");
}

inline ccd_warm_t *state(Warm *warm) { return warm ? warm->get() : nullptr; }

inline Contact contact(int code, Real depth, const ccd_vec3_t &dir, const ccd_vec3_t &pos)
{
    Contact c;
    c.status = static_cast<Status>(code);
    if (c) {
        c.depth = depth;
        c.dir = dir;
        c.pos = pos;
    }
    return c;
}

inline Penetration penetration(int code, const ccd_penetration_t &out)
{
    Penetration p;
    static_cast<Contact &>(p) = contact(code, out.depth, out.dir, out.pos);
    if (p) {
        p.depth_lower = out.depth_lower;
        p.normal = out.normal;
        p.point1 = out.point1;
        p.point2 = out.point2;
        p.supports = out.supports;
        p.iterations = out.iterations;
    }
    return p;
}

} // namespace detail

/** Do the shapes overlap? (A touch is none.) ccdMPRIntersectWarm. A pair that stays apart costs one
 * call of each support() while its last separating direction still separates. */
template <class A, class B>
bool intersect(const A &a, const B &b, const Settings &settings = {}, Warm *warm = nullptr)
{
    detail::needs_centres<A, B>();
    const ccd_t c = detail::query<A, B>(settings);
    return ccdMPRIntersectWarm(std::addressof(a), std::addressof(b), &c, detail::state(warm)) == 1;
}

/** Do the shapes overlap? ccdGJKIntersect, without centres. */
template <class A, class B>
bool intersect_gjk(const A &a, const B &b, const Settings &settings = {})
{
    const ccd_t c = detail::query<A, B>(settings);
    return ccdGJKIntersect(std::addressof(a), std::addressof(b), &c) == 1;
}

/** The depth at MPR's price: ccdMPRPenetrationWarm. */
template <class A, class B>
Contact penetration_mpr(const A &a, const B &b, const Settings &settings = {}, Warm *warm = nullptr)
{
    detail::needs_centres<A, B>();
    const ccd_t c = detail::query<A, B>(settings);
    Real depth{};
    ccd_vec3_t dir{}, pos{};
    const int code = ccdMPRPenetrationWarm(std::addressof(a), std::addressof(b), &c, detail::state(warm), &depth,
                                           &dir, &pos);
    return detail::contact(code, depth, dir, pos);
}

/** The global minimum of the depth, without centres: ccdGJKPenetration. */
template <class A, class B>
Contact penetration_gjk(const A &a, const B &b, const Settings &settings = {})
{
    const ccd_t c = detail::query<A, B>(settings);
    Real depth{};
    ccd_vec3_t dir{}, pos{};
    const int code = ccdGJKPenetration(std::addressof(a), std::addressof(b), &c, &depth, &dir, &pos);
    return detail::contact(code, depth, dir, pos);
}

/** A local minimum of the depth, from the state, else from the centres, by the fastest search
 * there is: ccdPenetrationLocal. */
template <class A, class B>
Penetration penetration_local(const A &a, const B &b, const Settings &settings = {}, Warm *warm = nullptr)
{
    const ccd_t c = detail::query<A, B>(settings);
    ccd_penetration_t out{};
    const int code = ccdPenetrationLocal(std::addressof(a), std::addressof(b), &c, detail::state(warm), &out);
    return detail::penetration(code, out);
}

/** The same by the paper's method as published: ccdPenetrationIncremental. */
template <class A, class B>
Penetration penetration_incremental(const A &a, const B &b, const Settings &settings = {}, Warm *warm = nullptr)
{
    const ccd_t c = detail::query<A, B>(settings);
    ccd_penetration_t out{};
    const int code = ccdPenetrationIncremental(std::addressof(a), std::addressof(b), &c, detail::state(warm), &out);
    return detail::penetration(code, out);
}

/** The global minimum of the depth with its proof, depth - depth_lower <= tolerance:
 * ccdPenetrationMinimum. */
template <class A, class B>
Penetration penetration_minimum(const A &a, const B &b, const Settings &settings = {}, Warm *warm = nullptr)
{
    const ccd_t c = detail::query<A, B>(settings);
    ccd_penetration_t out{};
    const int code = ccdPenetrationMinimum(std::addressof(a), std::addressof(b), &c, detail::state(warm), &out);
    return detail::penetration(code, out);
}

/** Where the shapes touch: up to N points of the region in which the faces that look along normal
 * lie over each other, the deepest first; the number of them, or Status::bad_input's:
 * ccdContacts. */
template <std::size_t N, class A, class B>
int contacts(const A &a, const B &b, const Vec3 &normal, Real slop, std::array<ContactPoint, N> &out)
{
    const ccd_t c = detail::query<A, B>({});
    const ccd_vec3_t n = normal;
    ccd_contact_t found[N > 0 ? N : 1];
    const int count =
        ccdContacts(std::addressof(a), std::addressof(b), &c, &n, slop, found, static_cast<int>(N));
    for (int i = 0; i < count; i++) {
        ContactPoint &point = out[static_cast<std::size_t>(i)];
        point.point1 = found[i].point1;
        point.point2 = found[i].point2;
        point.depth = found[i].depth;
    }
    return count;
}

/** How far b must move along dir (of any length): ccdPenetrationAlong. */
template <class A, class B>
Penetration penetration_along(const A &a, const B &b, const Vec3 &dir, const Settings &settings = {},
                              Warm *warm = nullptr)
{
    const ccd_t c = detail::query<A, B>(settings);
    const ccd_vec3_t d = dir;
    ccd_penetration_t out{};
    const int code = ccdPenetrationAlong(std::addressof(a), std::addressof(b), &c, &d, detail::state(warm), &out);
    return detail::penetration(code, out);
}

/** For shapes in a common plane with this normal (of any length), an answer in that plane:
 * ccdPenetrationPlanar. */
template <class A, class B>
Penetration penetration_planar(const A &a, const B &b, const Vec3 &plane_normal, const Settings &settings = {},
                               Warm *warm = nullptr)
{
    const ccd_t c = detail::query<A, B>(settings);
    const ccd_vec3_t n = plane_normal;
    ccd_penetration_t out{};
    const int code = ccdPenetrationPlanar(std::addressof(a), std::addressof(b), &c, &n, detail::state(warm), &out);
    return detail::penetration(code, out);
}

/** How far apart, or how deep, one continuous function through the touch: ccdSignedDistance. The
 * shapes are meant with a ball of their margin added all around. */
template <class A, class B>
Distance signed_distance(const A &a, const B &b, const Settings &settings = {}, const Margins &margins = {},
                         Warm *warm = nullptr)
{
    const ccd_t c = detail::query<A, B>(settings);
    ccd_distance_t out{};
    Distance d;
    d.status = static_cast<Status>(ccdSignedDistance(std::addressof(a), std::addressof(b), &c, margins.margin1,
                                                     margins.margin2, margins.beyond, detail::state(warm), &out));
    if (d) {
        d.distance = out.distance;
        d.distance_upper = out.distance_upper;
        d.normal = out.normal;
        d.point1 = out.point1;
        d.point2 = out.point2;
        d.supports = out.supports;
        d.iterations = out.iterations;
    }
    return d;
}

} // namespace ccd

#endif
