/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The queries of warm.h for programs on FCL 0.7, with a state for each pair of objects: header
 * only, C++11, for FCL and this library each in double or float (results are as exact as
 * the coarser of the two).
 *
 *     ccd_fcl::PairCache cache;                      // kept between frames, one for each thread
 *     ...
 *     ccd_fcl::CollisionData<double> data(cache);    // as fcl::DefaultCollisionData
 *     data.request.enable_contact = true;
 *     data.request.num_max_contacts = 1000;
 *     manager.collide(&data, ccd_fcl::CollisionFunction<double>);
 *     cache.next_frame();                            // drops the pairs not used in this frame
 *
 * Box, Sphere, Ellipsoid, Capsule, Cone, Cylinder, Convex and TriangleP are handled by
 * this library; spheres and capsules as a point and a segment with a margin, which is exact and
 * fastest. All other geometries (meshes, octrees, planes, half spaces), cost queries, and
 * geometries that are not marked as occupied are passed to fcl::collide and fcl::distance. The
 * solver type and the cached guess of a request are ignored: the pair's state replaces them.
 *
 * Signs and order are FCL's: a contact's normal points from the first object to the second,
 * penetration_depth is positive, pos is that of ccdPenetration, with a sphere or capsule the middle
 * of the closest points; nearest_points are the first's and the second's. */

#ifndef __CCD_FCL_HPP__
#define __CCD_FCL_HPP__

#include <ccd/ccd.h>
#include <ccd/warm.h>

#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/triangle_p.h>
#include <fcl/narrowphase/collision_object.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <new>
#include <stdexcept>
#include <vector>

namespace ccd_fcl {

/** @cond the header's own */
namespace detail {

/* Hash map from a pair of objects to a value. Entries are stored in order of insertion, which is
 * about the order of the next frame's queries. */
template <typename Value>
class PairTable {
public:
    /* Returns the pair's value, made if there is none; valid until the next call of this object. */
    Value &at(const void *low, const void *high, unsigned long frame)
    {
        if (2 * (entries_.size() + 1) > index_.size())
            make_index();
        std::size_t i = place(low, high);
        while (index_[i] != 0 && !entries_[index_[i] - 1].is_of(low, high))
            i = next(i);
        if (index_[i] == 0) {
            entries_.push_back(Entry{low, high, frame, Value()});
            index_[i] = static_cast<std::uint32_t>(entries_.size());
        }
        Entry &entry = entries_[index_[i] - 1];
        entry.frame = frame;
        return entry.value;
    }

    /* Drops the pairs of an object, or with NULL those not used in the frame. */
    void drop(const void *object, unsigned long frame)
    {
        const auto is_dropped = [=](const Entry &e) {
            return object ? e.low == object || e.high == object : e.frame != frame;
        };
        const auto end = std::remove_if(entries_.begin(), entries_.end(), is_dropped);
        if (end == entries_.end())
            return;
        entries_.erase(end, entries_.end());
        make_index();
    }

    void clear() { *this = PairTable(); }

    std::size_t size() const { return entries_.size(); }

private:
    struct Entry {
        bool is_of(const void *first, const void *second) const { return low == first && high == second; }
        const void *low, *high;
        unsigned long frame; /* the last one that used it */
        Value value;
    };

    /* Returns the slot where the search for a pair starts (Fibonacci hashing). */
    std::size_t place(const void *low, const void *high) const
    {
        const std::uint64_t ratio = 0x9E3779B97F4A7C15u;
        const std::uint64_t mixed = (reinterpret_cast<std::uintptr_t>(low) * ratio ^ reinterpret_cast<std::uintptr_t>(high)) * ratio;
        return static_cast<std::size_t>(mixed >> 32) & (index_.size() - 1);
    }

    std::size_t next(std::size_t i) const { return (i + 1) & (index_.size() - 1); }

    void make_index()
    {
        std::size_t size = 64;
        while (size < 4 * (entries_.size() + 1))
            size *= 2;
        index_.assign(size, 0);
        for (std::size_t k = 0; k < entries_.size(); k++) {
            std::size_t i = place(entries_[k].low, entries_[k].high);
            while (index_[i] != 0)
                i = next(i);
            index_[i] = static_cast<std::uint32_t>(k + 1);
        }
    }

    std::vector<Entry> entries_;
    std::vector<std::uint32_t> index_; /* one more than an entry's place; 0: none. A power of two, at least twice the entries */
};

} // namespace detail
/** @endcond */

/** Warm-start states and contact caches of pairs of objects, found in either order. Not for two
 * threads at once. Objects may be moved, changed, destroyed and replaced: an outdated state costs
 * time, never a wrong answer. */
class PairCache {
public:
    /** The state of (first, second), cold at first; good until the next call of this object. */
    ccd_warm_t *state(const void *first, const void *second)
    {
        const bool ordered = std::less<const void *>()(first, second);
        State &state = ordered ? states_.at(first, second, frame_) : states_.at(second, first, frame_);
        if (state.ordered != ordered)
            ccdWarmFlip(&state.warm);
        state.ordered = ordered;
        return &state.warm;
    }

    /** The pair's cache for ccdContacts, for either order, made at the first call. */
    ccd_manifold_cache_t *contacts(const void *first, const void *second)
    {
        const bool ordered = std::less<const void *>()(first, second);
        return ordered ? &contacts_.at(first, second, frame_) : &contacts_.at(second, first, frame_);
    }

    /** Drops the pairs not used since the last call. Called once a frame, it also drops
     * the pairs of objects that no longer exist. */
    void next_frame()
    {
        states_.drop(nullptr, frame_);
        contacts_.drop(nullptr, frame_);
        frame_++;
    }

    /** Drops the pairs of an object at once. Looks at every pair. */
    void forget(const void *object)
    {
        states_.drop(object, frame_);
        contacts_.drop(object, frame_);
    }

    /** Drops everything. */
    void clear()
    {
        states_.clear();
        contacts_.clear();
    }

    /** Returns the number of pairs. */
    std::size_t size() const { return states_.size(); }

private:
    struct State {
        ccd_warm_t warm = ccd_warm_t();
        bool ordered = true; /* the state's obj1 is the pair's lower address */
    };

    detail::PairTable<State> states_;
    detail::PairTable<ccd_manifold_cache_t> contacts_;
    unsigned long frame_ = 0;
};

/** Settings of collide. */
struct Settings {
    /** Largest number of contacts of one pair, if the request has room for more than one; 1: only
     * the middle of the overlap. */
    std::size_t contacts_per_pair = 8;
    /** Metres: largest distance of a corner below its support plane at which it still belongs to the
     * contact face (ccdContacts); negative: a thousandth of the smaller aabb_radius. */
    double slop = -1;
};

/** fcl::DefaultCollisionData with a cache of states. */
template <typename S>
struct CollisionData : fcl::DefaultCollisionData<S> {
    /** The cache must outlive this. */
    explicit CollisionData(PairCache &pairs) : cache(&pairs) {}
    PairCache *cache;  /**< where the states are */
    Settings settings; /**< how many contacts */
};

/** fcl::DefaultDistanceData with a cache of states. */
template <typename S>
struct DistanceData : fcl::DefaultDistanceData<S> {
    /** The cache must outlive this. */
    explicit DistanceData(PairCache &pairs) : cache(&pairs) {}
    PairCache *cache; /**< where the states are */
};

/** @cond the header's own */
namespace detail {

/* Largest number of vertices for a linear search. Above it FCL's hill climbing is used, which
 * allocates in every call. */
const std::size_t MAX_LINEAR_SEARCH = 128;

const unsigned long CONVEX_TYPES = 1ul << fcl::GEOM_BOX | 1ul << fcl::GEOM_SPHERE | 1ul << fcl::GEOM_ELLIPSOID
                                   | 1ul << fcl::GEOM_CAPSULE | 1ul << fcl::GEOM_CONE | 1ul << fcl::GEOM_CYLINDER
                                   | 1ul << fcl::GEOM_CONVEX | 1ul << fcl::GEOM_TRIANGLE;

/* A convex geometry in its pose: a core, and the ball of radius margin around it. */
template <typename S>
struct Placed {
    using V = fcl::Vector3<S>;

    Placed(const fcl::CollisionGeometry<S> *shape, const fcl::Transform3<S> &at)
        : geometry(shape), pose(&at), type(shape->getNodeType())
    {
        is_supported = shape->isOccupied() && (CONVEX_TYPES >> type & 1) != 0;
        if (type == fcl::GEOM_SPHERE)
            margin = as<fcl::Sphere<S>>().radius;
        else if (type == fcl::GEOM_CAPSULE)
            margin = as<fcl::Capsule<S>>().radius;
        else if (type == fcl::GEOM_CONVEX && as<fcl::Convex<S>>().getVertices().empty())
            is_supported = false;
    }

    template <typename Shape>
    const Shape &as() const
    {
        return *static_cast<const Shape *>(geometry);
    }

    V corner(const V &half, const V &d) const
    {
        return V(std::copysign(half[0], d[0]), std::copysign(half[1], d[1]), std::copysign(half[2], d[2]));
    }

    /* Rim point of a disc about z, any one where d is along z. */
    V rim(S radius, S z, const V &d) const
    {
        const S across = std::sqrt(d[0] * d[0] + d[1] * d[1]);
        return across > 0 ? V(radius * (d[0] / across), radius * (d[1] / across), z) : V(radius, 0, z);
    }

    V farthest(const V *points, std::size_t n, const V &d) const
    {
        std::size_t best = 0;
        S most = points[0].dot(d);
        for (std::size_t i = 1; i < n; i++) {
            const S value = points[i].dot(d);
            if (value > most) {
                most = value;
                best = i;
            }
        }
        return points[best];
    }

    /* The core's support point in the geometry's frame. */
    V local_support(const V &d) const
    {
        switch (type) {
        case fcl::GEOM_BOX: return corner(as<fcl::Box<S>>().side * S(0.5), d);
        case fcl::GEOM_CAPSULE: return V(0, 0, std::copysign(as<fcl::Capsule<S>>().lz / 2, d[2]));
        case fcl::GEOM_ELLIPSOID: {
            const V &radii = as<fcl::Ellipsoid<S>>().radii;
            const V e = radii.cwiseProduct(d);
            const S length = e.norm();
            return length > 0 ? V(radii.cwiseProduct(e / length)) : V(radii[0], 0, 0);
        }
        case fcl::GEOM_CYLINDER: {
            const fcl::Cylinder<S> &c = as<fcl::Cylinder<S>>();
            return rim(c.radius, std::copysign(c.lz / 2, d[2]), d);
        }
        case fcl::GEOM_CONE: {
            const fcl::Cone<S> &c = as<fcl::Cone<S>>();
            const V apex(0, 0, c.lz / 2), base = rim(c.radius, -c.lz / 2, d);
            return apex.dot(d) > base.dot(d) ? apex : base;
        }
        case fcl::GEOM_CONVEX: {
            const auto &vertices = as<fcl::Convex<S>>().getVertices();
            return vertices.size() <= MAX_LINEAR_SEARCH ? farthest(vertices.data(), vertices.size(), d)
                                              : as<fcl::Convex<S>>().findExtremeVertex(d);
        }
        case fcl::GEOM_TRIANGLE: {
            const fcl::TriangleP<S> &t = as<fcl::TriangleP<S>>();
            const V points[3] = {t.a, t.b, t.c};
            return farthest(points, 3, d);
        }
        default: return V::Zero(); /* a sphere's */
        }
    }

    V local_center() const
    {
        if (type == fcl::GEOM_CONVEX)
            return as<fcl::Convex<S>>().getInteriorPoint();
        if (type == fcl::GEOM_TRIANGLE) {
            const fcl::TriangleP<S> &t = as<fcl::TriangleP<S>>();
            return (t.a + t.b + t.c) / S(3);
        }
        return V::Zero();
    }

    const fcl::CollisionGeometry<S> *geometry;
    const fcl::Transform3<S> *pose;
    fcl::NODE_TYPE type;
    bool is_supported; /* whether this library handles the geometry */
    S margin = 0;
};

template <typename S>
fcl::Vector3<S> to_fcl(const ccd_vec3_t &v)
{
    return fcl::Vector3<S>(static_cast<S>(v.v[0]), static_cast<S>(v.v[1]), static_cast<S>(v.v[2]));
}

template <typename S>
void from_fcl(const fcl::Vector3<S> &v, ccd_vec3_t *out)
{
    for (int i = 0; i < 3; i++)
        out->v[i] = static_cast<ccd_real_t>(v[i]);
}

template <typename S>
void support(const void *object, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const Placed<S> &placed = *static_cast<const Placed<S> *>(object);
    const fcl::Vector3<S> d = placed.pose->linear().transpose() * to_fcl<S>(*dir);
    from_fcl<S>(*placed.pose * placed.local_support(d), out);
}

template <typename S>
void center(const void *object, ccd_vec3_t *out)
{
    const Placed<S> &placed = *static_cast<const Placed<S> *>(object);
    from_fcl<S>(*placed.pose * placed.local_center(), out);
}

template <typename S>
ccd_t query(S tolerance)
{
    ccd_t c;
    CCD_INIT(&c);
    c.support1 = c.support2 = support<S>;
    c.center1 = c.center2 = center<S>;
    c.mpr_tolerance = c.dist_tolerance = static_cast<ccd_real_t>(tolerance);
    return c;
}

inline void throw_on_error(int code)
{
    if (code == CCD_NO_MEMORY)
        throw std::bad_alloc();
    if (code == CCD_BAD_INPUT)
        throw std::invalid_argument("ccd/fcl.hpp: a pose, a shape or a tolerance is NaN or infinite");
}

template <typename S>
int distance_of(const Placed<S> &a, const Placed<S> &b, const ccd_t &ccd, ccd_real_t farthest, ccd_warm_t *warm,
                unsigned want, ccd_distance_t *d)
{
    const int code = ccdSignedDistance(&a, &b, &ccd, static_cast<ccd_real_t>(a.margin), static_cast<ccd_real_t>(b.margin),
                                       farthest, warm, want, d);
    throw_on_error(code);
    return code;
}

/* Returns whether the objects overlap, margins included. With `contact` writes the depth, the global minimum
 * within the larger of the tolerance and a thousandth of the depth, and the position. */
template <typename S>
bool overlap(const Placed<S> &a, const Placed<S> &b, ccd_t &ccd, bool contact, ccd_warm_t *warm, ccd_penetration_t *hit)
{
    if (!(a.margin > 0 || b.margin > 0)) {
        const int code = contact ? ccdPenetration(&a, &b, &ccd, warm, CCD_WANT_POS, hit) : ccdIntersect(&a, &b, &ccd, warm);
        throw_on_error(code);
        return contact ? code >= 0 : code == 1;
    }
    /* First with a tolerance of a thousandth of the margins, which is exact enough if the cores overlap,
     * because the depth exceeds the margins. */
    const ccd_real_t tolerance = ccd.dist_tolerance;
    const unsigned want = contact ? CCD_WANT_POINTS : 0;
    ccd_distance_t d;
    ccd.dist_tolerance = std::max(tolerance, static_cast<ccd_real_t>(a.margin + b.margin) / 1000);
    int code = distance_of(a, b, ccd, 0, warm, want, &d);
    ccd.dist_tolerance = tolerance;
    if (d.distance < 0 && d.distance_upper - d.distance > std::max(tolerance, -d.distance / 1000))
        code = distance_of(a, b, ccd, 0, warm, want, &d);
    if (code == CCD_MISS || !(d.distance < 0))
        return false;
    hit->depth = -d.distance;
    hit->dir = d.normal;
    for (int i = 0; i < 3; i++)
        hit->pos.v[i] = (d.point1.v[i] + d.point2.v[i]) / 2;
    return true;
}

template <typename S>
ccd_real_t slop_of(const Placed<S> &a, const Placed<S> &b, const Settings &settings)
{
    if (settings.slop >= 0)
        return static_cast<ccd_real_t>(settings.slop);
    const S radius = std::min(a.geometry->aabb_radius, b.geometry->aabb_radius);
    return static_cast<ccd_real_t>(std::isfinite(radius) && radius > 0 ? radius / 1000 : S(0));
}

/* Adds contacts of one pair. */
template <typename S>
class Contacts {
public:
    Contacts(const Placed<S> &a, const Placed<S> &b, const ccd_t &ccd, const ccd_penetration_t &hit, fcl::CollisionResult<S> &result)
        : a_(a), b_(b), ccd_(ccd), hit_(hit), normal_(to_fcl<S>(hit.dir)), result_(result)
    {
    }

    /* Adds the contacts of the overlapping faces, the deepest first, without those at which the
     * objects are apart. The first has the depth of the objects: if no contact is as deep to a
     * thousandth, it is the middle of the overlap. */
    template <typename Cache>
    void add(std::size_t room, const Settings &settings, Cache cache)
    {
        const std::size_t MAX_CONTACTS = 16; /* two octagons, clipped */
        const std::size_t wanted = std::min(std::min(room, settings.contacts_per_pair), MAX_CONTACTS);
        ccd_contact_t found[MAX_CONTACTS];
        const int count = wanted > 1 ? ccdContacts(&a_, &b_, &ccd_, &hit_.dir, slop_of(a_, b_, settings), cache(), found,
                                                  static_cast<int>(wanted))
                                    : 0;
        throw_on_error(count);
        const S depth = static_cast<S>(hit_.depth), least = depth - std::max(static_cast<S>(ccd_.mpr_tolerance), depth / 1000);
        std::size_t added = 0;
        if (count == 0 || !(depth_of(found[0]) >= least)) {
            put(to_fcl<S>(hit_.pos), depth);
            added++;
        }
        for (int i = 0; i < count && added < wanted; i++) {
            if (!(depth_of(found[i]) >= 0))
                continue;
            const fcl::Vector3<S> middle = (to_fcl<S>(found[i].point1) + to_fcl<S>(found[i].point2)) / S(2);
            put(middle + normal_ * ((a_.margin - b_.margin) / 2), added == 0 ? depth : depth_of(found[i]));
            added++;
        }
    }

private:
    /* Corners may lie off their surfaces by the slop; nothing is deeper than the objects are. */
    S depth_of(const ccd_contact_t &c) const
    {
        return std::min(static_cast<S>(c.depth) + a_.margin + b_.margin, static_cast<S>(hit_.depth));
    }

    void put(const fcl::Vector3<S> &pos, S depth)
    {
        result_.addContact(fcl::Contact<S>(a_.geometry, b_.geometry, fcl::Contact<S>::NONE, fcl::Contact<S>::NONE, pos,
                                           normal_, depth));
    }

    const Placed<S> &a_, &b_;
    const ccd_t &ccd_;
    const ccd_penetration_t &hit_;
    const fcl::Vector3<S> normal_;
    fcl::CollisionResult<S> &result_;
};

/* Returns whether this library handles the pair and the request. */
template <typename S>
bool is_supported(const Placed<S> &a, const Placed<S> &b, const fcl::CollisionRequest<S> &request)
{
    return a.is_supported && b.is_supported && !request.enable_cost && request.num_max_contacts > 0;
}

/* Collides two supported geometries. `cache` returns their contact cache. */
template <typename S, typename Cache>
std::size_t collide(const Placed<S> &a, const Placed<S> &b, const fcl::CollisionRequest<S> &request,
                    fcl::CollisionResult<S> &result, ccd_warm_t *warm, const Settings &settings, Cache cache)
{
    const std::size_t before = result.numContacts();
    if (before >= request.num_max_contacts)
        return before;
    ccd_t ccd = query<S>(request.gjk_tolerance);
    ccd_penetration_t hit;
    if (!overlap(a, b, ccd, request.enable_contact, warm, &hit))
        return before;
    if (request.enable_contact)
        Contacts<S>(a, b, ccd, hit, result).add(request.num_max_contacts - before, settings, cache);
    else
        result.addContact(fcl::Contact<S>(a.geometry, b.geometry, fcl::Contact<S>::NONE, fcl::Contact<S>::NONE));
    return result.numContacts();
}

/* Computes the distance of two supported geometries. */
template <typename S>
S distance(const Placed<S> &a, const Placed<S> &b, const fcl::DistanceRequest<S> &request, fcl::DistanceResult<S> &result,
           ccd_warm_t *warm)
{
    if (request.isSatisfied(result))
        return result.min_distance;
    const ccd_t ccd = query<S>(request.distance_tolerance);
    const bool first = !(result.min_distance < std::numeric_limits<S>::max());
    ccd_distance_t d;
    distance_of(a, b, ccd, first ? std::numeric_limits<ccd_real_t>::infinity() : static_cast<ccd_real_t>(result.min_distance), warm,
                CCD_WANT_POINTS, &d);
    result.update(static_cast<S>(d.distance), a.geometry, b.geometry, fcl::DistanceResult<S>::NONE,
                  fcl::DistanceResult<S>::NONE, to_fcl<S>(d.point1), to_fcl<S>(d.point2));
    return result.min_distance;
}

} // namespace detail
/** @endcond */

/** Returns whether this library handles the pair, rather than FCL. */
template <typename S>
bool is_supported(const fcl::CollisionGeometry<S> *a, const fcl::CollisionGeometry<S> *b)
{
    const fcl::Transform3<S> anywhere = fcl::Transform3<S>::Identity();
    return detail::Placed<S>(a, anywhere).is_supported && detail::Placed<S>(b, anywhere).is_supported;
}

/** fcl::collide of two geometries in their poses, with a state (NULL: cold). Depths within the
 * larger of request.gjk_tolerance (metres) and a thousandth of the depth. Returns the number
 * of contacts in result. Throws std::invalid_argument where a pose is not finite. */
template <typename S>
std::size_t collide(const fcl::CollisionGeometry<S> *g1, const fcl::Transform3<S> &tf1, const fcl::CollisionGeometry<S> *g2,
                    const fcl::Transform3<S> &tf2, const fcl::CollisionRequest<S> &request,
                    fcl::CollisionResult<S> &result, ccd_warm_t *warm, const Settings &settings = Settings())
{
    const detail::Placed<S> a(g1, tf1), b(g2, tf2);
    if (!detail::is_supported(a, b, request))
        return fcl::collide(g1, tf1, g2, tf2, request, result);
    return detail::collide(a, b, request, result, warm, settings, [] { return static_cast<ccd_manifold_cache_t *>(nullptr); });
}

/** fcl::collide of two objects, with their state. */
template <typename S>
std::size_t collide(const fcl::CollisionObject<S> *o1, const fcl::CollisionObject<S> *o2,
                    const fcl::CollisionRequest<S> &request, fcl::CollisionResult<S> &result, PairCache &cache,
                    const Settings &settings = Settings())
{
    const detail::Placed<S> a(o1->collisionGeometry().get(), o1->getTransform());
    const detail::Placed<S> b(o2->collisionGeometry().get(), o2->getTransform());
    if (!detail::is_supported(a, b, request))
        return fcl::collide(a.geometry, *a.pose, b.geometry, *b.pose, request, result);
    return detail::collide(a, b, request, result, cache.state(o1, o2), settings, [&] { return cache.contacts(o1, o2); });
}

/** fcl::distance of two geometries in their poses, with a state (NULL: cold): min_distance is
 * the signed distance, overlapping or not, never above the truth and within
 * request.distance_tolerance (metres) of it. Nothing beyond the result's min_distance is
 * refined. Returns the result's min_distance. Throws std::invalid_argument where a pose is not
 * finite. */
template <typename S>
S distance(const fcl::CollisionGeometry<S> *g1, const fcl::Transform3<S> &tf1, const fcl::CollisionGeometry<S> *g2,
           const fcl::Transform3<S> &tf2, const fcl::DistanceRequest<S> &request, fcl::DistanceResult<S> &result,
           ccd_warm_t *warm)
{
    const detail::Placed<S> a(g1, tf1), b(g2, tf2);
    return a.is_supported && b.is_supported ? detail::distance(a, b, request, result, warm)
                                  : fcl::distance(g1, tf1, g2, tf2, request, result);
}

/** fcl::distance of two objects, with their state. */
template <typename S>
S distance(const fcl::CollisionObject<S> *o1, const fcl::CollisionObject<S> *o2, const fcl::DistanceRequest<S> &request,
           fcl::DistanceResult<S> &result, PairCache &cache)
{
    const detail::Placed<S> a(o1->collisionGeometry().get(), o1->getTransform());
    const detail::Placed<S> b(o2->collisionGeometry().get(), o2->getTransform());
    return a.is_supported && b.is_supported ? detail::distance(a, b, request, result, cache.state(o1, o2))
                                  : fcl::distance(a.geometry, *a.pose, b.geometry, *b.pose, request, result);
}

/** For the collide() of a broad phase manager; data is a CollisionData<S>. As
 * fcl::DefaultCollisionFunction: returns true, which ends the manager's traversal, once the request is full. */
template <typename S>
bool CollisionFunction(fcl::CollisionObject<S> *o1, fcl::CollisionObject<S> *o2, void *data)
{
    CollisionData<S> &d = *static_cast<CollisionData<S> *>(data);
    if (!d.done) {
        const std::size_t count = collide(o1, o2, d.request, d.result, *d.cache, d.settings);
        d.done = count >= d.request.num_max_contacts && d.request.isSatisfied(d.result);
    }
    return d.done;
}

/** For the distance() of a broad phase manager; data is a DistanceData<S>. As
 * fcl::DefaultDistanceFunction: the least distance so far, and true once it is not positive. */
template <typename S>
bool DistanceFunction(fcl::CollisionObject<S> *o1, fcl::CollisionObject<S> *o2, void *data, S &dist)
{
    DistanceData<S> &d = *static_cast<DistanceData<S> *>(data);
    if (!d.done)
        distance(o1, o2, d.request, d.result, *d.cache);
    dist = d.result.min_distance;
    return d.done || dist <= 0;
}

} // namespace ccd_fcl

#endif
