// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

// Other libraries' penetration solvers over the benchmark's own support functions. Each part is compiled alone
// (-DPEER_...), with its Debian package or with what engines.sh has downloaded. Every engine gets a support function and
// no more: what it does besides for spheres, capsules and meshes does not take part.

#include <ccd/ccd.h>

#include <math.h>

extern "C" {
// Returns 0 with depth and dir, the direction in which b moves, or -1.
int peer_penetration(const void *a, const void *b, const ccd_t *ccd, double *depth, ccd_vec3_t *dir, ccd_vec3_t *pos);
}

// An object with its callbacks.
struct Object {
    const void *obj;
    ccd_support_fn support;
    ccd_center_fn center;

    ccd_vec3_t support_point(const ccd_vec3_t &dir) const
    {
        ccd_vec3_t out;
        support(obj, &dir, &out);
        return out;
    }
    ccd_vec3_t center_point() const
    {
        ccd_vec3_t out;
        center(obj, &out);
        return out;
    }
};

// Returns the unit vector that the callbacks require and that some engines' directions are not.
static inline ccd_vec3_t unit(double x, double y, double z)
{
    const double l = sqrt(x * x + y * y + z * z);
    return {{l > 0 ? x / l : 1, l > 0 ? y / l : 0, l > 0 ? z / l : 0}};
}

// Writes a hit of this depth along x, y, z, a vector of any length.
static int hit(double d, double x, double y, double z, double *depth, ccd_vec3_t *dir)
{
    const double l = sqrt(x * x + y * y + z * z);
    if (!(l > 0))
        return -1;
    *depth = d;
    *dir = {{x / l, y / l, z / l}};
    return 0;
}

#ifdef PEER_BULLET
// btGjkEpa3 is a header with the solver as a template over any type with a local
// support function. Its accuracy, 1e-4, is built in. Shapes in world coordinates.
#define BT_USE_DOUBLE_PRECISION
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa3.h>

struct Convex : Object {
    btVector3 getLocalSupportWithMargin(const btVector3 &d) const
    {
        const ccd_vec3_t p = support_point(unit(d[0], d[1], d[2]));
        return btVector3(p.v[0], p.v[1], p.v[2]);
    }
    btVector3 getLocalSupportWithoutMargin(const btVector3 &d) const { return getLocalSupportWithMargin(d); }
    btTransform getWorldTransform() const { return btTransform::getIdentity(); }
};

int peer_penetration(const void *a, const void *b, const ccd_t *ccd, double *depth, ccd_vec3_t *dir, ccd_vec3_t *)
{
    const Convex ca = {{a, ccd->support1, ccd->center1}}, cb = {{b, ccd->support2, ccd->center2}};
    const ccd_vec3_t p = ca.center_point(), q = cb.center_point();
    btVector3 guess(p.v[0] - q.v[0], p.v[1] - q.v[1], p.v[2] - q.v[2]);
    if (guess.fuzzyZero())
        guess = btVector3(1, 0, 0);
    btGjkEpaSolver3::sResults r;
    if (!btGjkEpaSolver3_Penetration(ca, cb, guess, r))
        return -1;
    return hit(-r.distance, -r.normal[0], -r.normal[1], -r.normal[2], depth, dir);
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
        // It returns that nothing overlaps; the distance of an overlap is negative.
        fcl::detail::GJKSignedDistance<double>(const_cast<void *>(a), ccd->support1, const_cast<void *>(b),
                                               ccd->support2, 500, ccd->epa_tolerance, &distance, &p, &q);
    } catch (const std::exception &) {
        return -1;
    }
    if (!(distance < 0))
        return -1;
    const fcl::Vector3d n = p - q;
    return hit(-distance, n[0], n[1], n[2], depth, dir);
}
#endif

#ifdef PEER_MUJOCO
// mjc_ccd of MuJoCo 3.12.0, which its wheel exports. Its headers are not in the wheel: these are
// the structures of src/engine/engine_collision_{convex,gjk}.h, as far as mjc_ccd reads and writes them.
#include <stddef.h>
#include <vector>

struct mjCCDObj {
    int geom, geom_type;
    double size[4], pos[3], mat[9];
    int vertindex, meshindex, flex, elem, vert;
    double margin, rotate[4];
    void *data[20]; /* as large as its union */
    void (*center)(double res[3], const mjCCDObj *obj);
    void (*support)(double res[3], mjCCDObj *obj, const double dir[3]);
};
static_assert(offsetof(mjCCDObj, center) == 360, "the layout of MuJoCo's object");

struct mjCCDConfig {
    int max_iterations;
    double tolerance;
    int max_contacts;
    double dist_cutoff;
    void *buffer;
    int npolygonmax, nmeshdegmax;
};
struct mjCCDStatus {
    int separated;
    double dist[50], x1[150], x2[150];
    int nx;
    double rest[512]; /* larger than what it counts besides */
};
extern "C" size_t mjc_ccdSize(int npolygonmax, int nmeshdegmax, int iterations);
extern "C" double mjc_ccd(const mjCCDConfig *, mjCCDStatus *, mjCCDObj *, mjCCDObj *);

struct Convex {
    mjCCDObj engine; /* first: the callbacks cast back */
    Object object;
};
static void convex_center(double res[3], const mjCCDObj *o)
{
    *reinterpret_cast<ccd_vec3_t *>(res) = reinterpret_cast<const Convex *>(o)->object.center_point();
}
static void convex_support(double res[3], mjCCDObj *o, const double d[3])
{
    const Object &object = reinterpret_cast<const Convex *>(o)->object;
    *reinterpret_cast<ccd_vec3_t *>(res) = object.support_point({{d[0], d[1], d[2]}});
}

int peer_penetration(const void *a, const void *b, const ccd_t *ccd, double *depth, ccd_vec3_t *dir, ccd_vec3_t *)
{
    enum { ITERATIONS = 50, NO_TYPE = 1001 }; /* MuJoCo's default; mjGEOM_NONE */
    static std::vector<double> buffer(mjc_ccdSize(0, 0, ITERATIONS) / sizeof(double) + 1);
    const mjCCDConfig config = {ITERATIONS, ccd->epa_tolerance, 1, 0, buffer.data(), 0, 0};
    static mjCCDStatus status;
    Convex c[2] = {{{}, {a, ccd->support1, ccd->center1}}, {{}, {b, ccd->support2, ccd->center2}}};
    for (Convex &x : c) {
        mjCCDObj &o = x.engine;
        o.geom = o.vertindex = o.meshindex = o.flex = o.elem = o.vert = -1;
        o.geom_type = NO_TYPE;
        o.rotate[0] = 1;
        o.center = convex_center;
        o.support = convex_support;
    }
    const double distance = mjc_ccd(&config, &status, &c[0].engine, &c[1].engine);
    if (!(distance < 0))
        return -1;
    const double *p = status.x1, *q = status.x2;
    return hit(-distance, p[0] - q[0], p[1] - q[1], p[2] - q[2], depth, dir);
}
#endif

#ifdef PEER_COAL
// Coal's GJK and EPA with its defaults, over a Minkowski difference of these support functions.
#include <coal/narrowphase/gjk.h>

struct Pair : coal::details::MinkowskiDiff {
    Object object[2];
};
static void pair_support(const coal::details::MinkowskiDiff &of, const coal::Vec3s &d, coal::Vec3s &p, coal::Vec3s &q,
                         coal::support_func_guess_t &, coal::details::ShapeSupportData *)
{
    const Pair &pair = static_cast<const Pair &>(of);
    const ccd_vec3_t n = unit(d[0], d[1], d[2]);
    const ccd_vec3_t a = pair.object[0].support_point(n);
    const ccd_vec3_t b = pair.object[1].support_point({{-n.v[0], -n.v[1], -n.v[2]}});
    p = {a.v[0], a.v[1], a.v[2]};
    q = {b.v[0], b.v[1], b.v[2]};
}

int peer_penetration(const void *a, const void *b, const ccd_t *ccd, double *depth, ccd_vec3_t *dir, ccd_vec3_t *)
{
    using namespace coal::details;
    static GJK gjk(coal::GJK_DEFAULT_MAX_ITERATIONS, ccd->epa_tolerance);
    static EPA epa(coal::EPA_DEFAULT_MAX_ITERATIONS, ccd->epa_tolerance);
    static Pair pair;
    pair.object[0] = {a, ccd->support1, ccd->center1};
    pair.object[1] = {b, ccd->support2, ccd->center2};
    pair.getSupportFunc = pair_support;
    pair.swept_sphere_radius.setZero();
    const ccd_vec3_t p = pair.object[0].center_point(), q = pair.object[1].center_point();
    const coal::Vec3s guess(p.v[0] - q.v[0], p.v[1] - q.v[1], p.v[2] - q.v[2]);
    gjk.reset(coal::GJK_DEFAULT_MAX_ITERATIONS, ccd->epa_tolerance);
    if (gjk.evaluate(pair, guess) != GJK::Collision)
        return -1;
    epa.reset(coal::EPA_DEFAULT_MAX_ITERATIONS, ccd->epa_tolerance);
    if (!(epa.evaluate(gjk, -guess) & EPA::Valid))
        return -1;
    return hit(epa.depth, epa.normal[0], epa.normal[1], epa.normal[2], depth, dir);
}
#endif

#ifdef PEER_JOLT
// Jolt's GJK and EPA, in single precision around the first object's centre, with its default
// tolerances and without a convex radius.
#include <Jolt/Jolt.h>
#include <Jolt/Geometry/EPAPenetrationDepth.h>

struct Convex : Object {
    ccd_vec3_t origin;
    JPH::Vec3 GetSupport(JPH::Vec3Arg d) const
    {
        const ccd_vec3_t p = support_point(unit(d.GetX(), d.GetY(), d.GetZ()));
        return JPH::Vec3(float(p.v[0] - origin.v[0]), float(p.v[1] - origin.v[1]), float(p.v[2] - origin.v[2]));
    }
};

int peer_penetration(const void *a, const void *b, const ccd_t *ccd, double *depth, ccd_vec3_t *dir, ccd_vec3_t *)
{
    Convex ca = {{a, ccd->support1, ccd->center1}, {}}, cb = {{b, ccd->support2, ccd->center2}, {}};
    ca.origin = cb.origin = ca.center_point();
    JPH::Vec3 v(1, 0, 0), p, q; /* as Jolt's own collision test starts */
    JPH::EPAPenetrationDepth epa;
    if (!epa.GetPenetrationDepth(ca, ca, 0, cb, cb, 0, 1e-4f, 1e-4f, v, p, q))
        return -1;
    if (!((p - q).Length() > 0))
        return -1;
    return hit((p - q).Length(), v.GetX(), v.GetY(), v.GetZ(), depth, dir);
}
#endif
