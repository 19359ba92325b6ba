// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

// Other libraries' penetration solvers over the benchmark's own support
// functions. Each part is compiled alone (-DPEER_...), where its Debian package is.
// Answers: 0 and depth, dir (the way obj2 moves), or -1.

#include <ccd/ccd.h>

extern "C" {
int peer_penetration(const void *a, const void *b, const ccd_t *ccd, double *depth, ccd_vec3_t *dir, ccd_vec3_t *pos);
}

#ifdef PEER_BULLET
// btGjkEpa3 is a header with the solver as a template over any type with a local
// support function. Its accuracy, 1e-4, is built in. Shapes in world coordinates.
#define BT_USE_DOUBLE_PRECISION
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa3.h>

struct Convex {
    const void *obj;
    ccd_support_fn support;
    ccd_vec3_t center;

    btVector3 getLocalSupportWithMargin(const btVector3 &d) const
    {
        ccd_vec3_t dir, out;
        // Bullet's directions are not always unit; the callbacks are promised so.
        btScalar l = d.length();
        btVector3 u = l > 0 ? d / l : btVector3(1, 0, 0);
        for (int i = 0; i < 3; i++)
            dir.v[i] = u[i];
        support(obj, &dir, &out);
        return btVector3(out.v[0], out.v[1], out.v[2]);
    }
    btVector3 getLocalSupportWithoutMargin(const btVector3 &d) const { return getLocalSupportWithMargin(d); }
    btTransform getWorldTransform() const { return btTransform::getIdentity(); }
};

int peer_penetration(const void *a, const void *b, const ccd_t *ccd, double *depth, ccd_vec3_t *dir, ccd_vec3_t *)
{
    Convex ca = {a, ccd->support1, {}}, cb = {b, ccd->support2, {}};
    ccd->center1(a, &ca.center);
    ccd->center2(b, &cb.center);
    btVector3 guess(ca.center.v[0] - cb.center.v[0], ca.center.v[1] - cb.center.v[1], ca.center.v[2] - cb.center.v[2]);
    if (guess.fuzzyZero())
        guess = btVector3(1, 0, 0);
    btGjkEpaSolver3::sResults r;
    if (!btGjkEpaSolver3_Penetration(ca, cb, guess, r))
        return -1;
    *depth = -r.distance;
    for (int i = 0; i < 3; i++)
        dir->v[i] = -r.normal[i];
    return 0;
}
#endif

#ifdef PEER_FCL
// FCL's own EPA (behind its signed distance), which takes libccd's callbacks.
// It calls libccd's polytope functions: system libccd's here, the only one it can see.
#include <fcl/narrowphase/detail/convexity_based_algorithm/gjk_libccd.h>

int peer_penetration(const void *a, const void *b, const ccd_t *ccd, double *depth, ccd_vec3_t *dir, ccd_vec3_t *)
{
    double distance;
    fcl::Vector3d p, q;
    try {
        // Its answer says "no overlap"; the distance is negative where there is one.
        fcl::detail::GJKSignedDistance<double>(const_cast<void *>(a), ccd->support1, const_cast<void *>(b),
                                               ccd->support2, 500, ccd->epa_tolerance, &distance, &p, &q);
    } catch (const std::exception &) {
        return -1;
    }
    fcl::Vector3d n = p - q;
    double l = n.norm();
    if (!(distance < 0) || !(l > 0))
        return -1;
    *depth = -distance;
    for (int i = 0; i < 3; i++)
        dir->v[i] = n[i] / l;
    return 0;
}
#endif
