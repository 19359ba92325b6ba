/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Supports of ccdSignedDistance beside FCL's own GJK, through the same support functions:
 * certified pairs moved apart along their normal, by a thousandth of their size to all of it.
 * FCL's solver is its own header; only where it asks for support points is ours.
 *
 *   distance_fcl pair set...   sets of independent poses cold, of motions warm as well */

#define FCL_NARROWPHASE_DETAIL_MINKOWSKIDIFF_H
#include <fcl/common/types.h>

extern "C" {
#include "contract/check.h"
#include "pairs.h"
}
#include <ccd/warm.h>

#include <algorithm>
#include <cmath>

namespace fcl {
namespace detail {

/* Stands in for the class of the header that is left out. */
template <typename S>
struct MinkowskiDiff {
    const shape_t *a = nullptr, *b = nullptr;
    unsigned long *supports = nullptr;

    Vector3<S> support(const Vector3<S> &d) const
    {
        const ccd_vec3_t n = {{d[0], d[1], d[2]}}, back = {{-d[0], -d[1], -d[2]}};
        ccd_vec3_t p, q;
        shape_support(a, &n, &p);
        shape_support(b, &back, &q);
        ++*supports;
        return Vector3<S>(p.v[0] - q.v[0], p.v[1] - q.v[1], p.v[2] - q.v[2]);
    }
    Vector3<S> support(const Vector3<S> &d, const Vector3<S> &) const { return support(d); }
};

} // namespace detail
} // namespace fcl

#include <fcl/math/detail/project.h>
#include <fcl/narrowphase/detail/convexity_based_algorithm/gjk.h>

template class fcl::detail::Project<double>;
template struct fcl::detail::GJK<double>;

static unsigned long by_fcl(const shape_t &a, const shape_t &b)
{
    fcl::detail::GJK<double> gjk(128, 1e-6);
    fcl::detail::MinkowskiDiff<double> difference;
    unsigned long supports = 0;
    difference.a = &a;
    difference.b = &b;
    difference.supports = &supports;
    gjk.evaluate(difference, fcl::Vector3<double>(1, 0, 0));
    return supports;
}

static void set_of(const char *path)
{
    pair_set_t set;
    if (pair_set_read(path, &set) != 0) {
        CHECK(false, "cannot read %s", path);
        return;
    }
    double ours = 0, warm = 0, fcl = 0, away = 0;
    ccd_warm_t state;
    for (int i = 0; i < set.n; i++) {
        shape_t a, b;
        pair_truth_t truth;
        pair_set_pose(&set, i, &a, &b, &truth);
        if (set.trajectory == 0 || i % set.trajectory == 0) {
            away = std::pow(10, random_in(-3, 0));
            memset(&state, 0, sizeof state);
        }
        const double by = truth.depth + away;
        shape_move(&b, b.pos[0] + by * truth.normal[0], b.pos[1] + by * truth.normal[1],
                   b.pos[2] + by * truth.normal[2]);
        ccd_t ccd;
        shape_query(&ccd);
        ccd.max_iterations = 500;
        ccd.dist_tolerance = 1e-6;
        ccd_distance_t d;
        int code = ccdSignedDistance(&a, &b, &ccd, 0, 0, INFINITY, nullptr, CCD_WANT_ALL, &d);
        CHECK(code == CCD_MISS && d.distance <= away + truth.gap + 1e-12 && d.distance_upper >= away - truth.gap - 1e-12 &&
                  d.distance_upper - d.distance <= 1.001e-6,
              "%s %d: %d, %.12g to %.12g, truth %.12g", path, i, code, d.distance, d.distance_upper, away);
        ours += double(d.support_calls);
        code = ccdSignedDistance(&a, &b, &ccd, 0, 0, INFINITY, &state, CCD_WANT_ALL, &d);
        CHECK(code == CCD_MISS && std::fabs(d.distance - away) <= 1e-6 + truth.gap + 1e-12, "%s %d, warm: %d, %.12g", path,
              i, code, d.distance);
        warm += double(d.support_calls);
        fcl += double(by_fcl(a, b));
    }
    printf("%-24s ours %.2f, FCL's GJK %.2f", strrchr(path, '/') + 1, ours / set.n, fcl / set.n);
    if (set.trajectory > 0)
        printf(", ours warm %.2f", warm / set.n);
    printf("\n");
    CHECK(ours <= fcl, "%s: %.2f supports, FCL %.2f", path, ours / set.n, fcl / set.n);
    CHECK(set.trajectory == 0 || warm <= ours, "%s: %.2f supports warm, %.2f cold", path, warm / set.n, ours / set.n);
    pair_set_free(&set);
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        set_of(argv[i]);
    return checks_end();
}
