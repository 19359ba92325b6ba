/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Replaces the distance functions of FCL 0.7's default solver, without a new build of FCL.
 *
 * libfcl.so exports fcl::detail::GJKSignedDistance and GJKDistance as weak symbols and calls them
 * through its PLT. A library that is preloaded, or linked before libfcl, and defines both takes
 * their place. FCL's shapes, closed forms, broad phase and collide stay FCL's own.
 *
 * Meaning of the results, as in FCL's gjk_libccd-inl.h:
 *   GJKSignedDistance  apart or touching: the distance, witness points, true; overlapping: minus
 *                      the penetration depth, witness points, false. The points lie in the
 *                      objects, |distance| apart: of an overlap, those of the polytope inside,
 *                      whose depth is less than the least one by at most the tolerance
 *   GJKDistance        apart or touching: the same, but the points are never so close that their difference has no
 *                      direction (separate below); overlapping: -1, points at the origin, false
 * FCL throws FailedAtThisConfiguration where its EPA fails, which its solver turns into a
 * std::logic_error. Here support points that are not finite alone raise std::invalid_argument,
 * which is a std::logic_error. */

#include <ccd/warm.h>

#include <Eigen/Core>
#include <fcl/config.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>

#if FCL_MAJOR_VERSION != 0 || FCL_MINOR_VERSION != 7
#error "written for FCL 0.7, whose function signatures it repeats"
#endif

namespace {

template <typename S>
using Vector3 = Eigen::Matrix<S, 3, 1>;

template <typename S>
void store(const ccd_vec3_t &point, Vector3<S> *out)
{
    if (out)
        *out << static_cast<S>(point.v[0]), static_cast<S>(point.v[1]), static_cast<S>(point.v[2]);
}

/* Moves the witness points of objects that are apart to the ends of the shortest line, at the cost of another search: a
 * distance that is e too long leaves a point of a ball of radius r aside by sqrt(2 r e), which is more than e. */
void refine(const void *obj1, const void *obj2, ccd_t ccd, ccd_warm_t *warm, ccd_distance_t *out)
{
    ccd_distance_t refined;
    ccd.dist_tolerance = 0;
    ccd.max_iterations = std::min(ccd.max_iterations, 30UL);
    const int code = ccdSignedDistance(obj1, obj2, &ccd, 0, 0, INFINITY, warm, CCD_WANT_POINTS, &refined);
    if ((code == CCD_MISS || code == CCD_LIMIT) && refined.distance >= 0 && refined.distance_upper <= out->distance_upper)
        *out = refined;
}

/* Moves the witness points of objects that nearly touch apart along the normal, to 4,096 ulps of their coordinates as S:
 * 1e-12 of them in double. FCL's conservative advancement takes their difference for the normal, and with it the time until
 * the next contact; it often comes to a gap of an ulp, where that difference is rounding, and no impact is found. 4,096 ulps
 * limit its error to 2.4e-4 radians. Insensitive: 2^10 to 2^20 (fcl_continuous.cpp). */
template <typename S>
void separate(ccd_distance_t *out)
{
    const ccd_real_t extent = CCD_SQRT(std::max(ccdVec3Len2(&out->point1), ccdVec3Len2(&out->point2)));
    const ccd_real_t least = 4096 * static_cast<ccd_real_t>(std::numeric_limits<S>::epsilon()) * extent;
    if (!(ccdVec3Dist2(&out->point1, &out->point2) < least * least))
        return;
    for (int i = 0; i < 3; i++) {
        const ccd_real_t middle = (out->point1.v[i] + out->point2.v[i]) / 2, half = least / 2 * out->normal.v[i];
        out->point1.v[i] = middle - half;
        out->point2.v[i] = middle + half;
    }
}

/* Writes the signed distance and the witness points; returns whether the objects are apart. */
template <typename S>
bool distance(void *obj1, ccd_support_fn support1, void *obj2, ccd_support_fn support2, unsigned int max_iterations,
              S tolerance, bool with_depth, S *dist, Vector3<S> *p1, Vector3<S> *p2)
{
    ccd_t ccd;
    ccd_distance_t out;
    ccd_warm_t warm = ccd_warm_t();
    CCD_INIT(&ccd);
    ccd.support1 = support1;
    ccd.support2 = support2;
    ccd.max_iterations = max_iterations;
    ccd.dist_tolerance = static_cast<ccd_real_t>(tolerance);
    const int code = ccdSignedDistance(obj1, obj2, &ccd, 0, 0, INFINITY, &warm, CCD_WANT_POINTS, &out);
    if (code == CCD_NO_MEMORY)
        throw std::bad_alloc();
    if (code == CCD_BAD_INPUT)
        throw std::invalid_argument("warmccd: a shape, a pose or a tolerance is not finite");

    /* At CCD_LIMIT the sign alone tells whether the objects overlap. */
    const bool is_apart = code == CCD_MISS || (code == CCD_LIMIT && out.distance >= 0);
    if (is_apart && (p1 || p2))
        refine(obj1, obj2, ccd, &warm, &out);
    if (is_apart && !with_depth)
        separate<S>(&out);
    ccd_real_t signed_distance = CCD_SQRT(ccdVec3Dist2(&out.point1, &out.point2));
    if (!is_apart && with_depth) {
        /* At CCD_LIMIT the points can be closer than the depth by more than the tolerance. */
        signed_distance = code == CCD_LIMIT ? out.distance : -signed_distance;
    } else if (!is_apart) {
        signed_distance = -1;
        out.point1 = out.point2 = ccd_vec3_t();
    }
    if (dist)
        *dist = static_cast<S>(signed_distance);
    store(out.point1, p1);
    store(out.point2, p2);
    return is_apart;
}

} // namespace

namespace fcl {
namespace detail {

template <typename S>
bool GJKSignedDistance(void *, ccd_support_fn, void *, ccd_support_fn, unsigned int, S, S *, Vector3<S> *, Vector3<S> *);
template <typename S>
bool GJKDistance(void *, ccd_support_fn, void *, ccd_support_fn, unsigned int, S, S *, Vector3<S> *, Vector3<S> *);

#define REPLACE(S)                                                                                                     \
    template <>                                                                                                        \
    __attribute__((visibility("default"))) bool GJKSignedDistance<S>(                                                  \
        void *obj1, ccd_support_fn supp1, void *obj2, ccd_support_fn supp2, unsigned int max_iterations, S tolerance,  \
        S *res, Vector3<S> *p1, Vector3<S> *p2)                                                                        \
    {                                                                                                                  \
        return distance(obj1, supp1, obj2, supp2, max_iterations, tolerance, true, res, p1, p2);                       \
    }                                                                                                                  \
    template <>                                                                                                        \
    __attribute__((visibility("default"))) bool GJKDistance<S>(                                                        \
        void *obj1, ccd_support_fn supp1, void *obj2, ccd_support_fn supp2, unsigned int max_iterations, S tolerance,  \
        S *res, Vector3<S> *p1, Vector3<S> *p2)                                                                        \
    {                                                                                                                  \
        return distance(obj1, supp1, obj2, supp2, max_iterations, tolerance, false, res, p1, p2);                      \
    }

REPLACE(double)
REPLACE(float)

} // namespace detail
} // namespace fcl
