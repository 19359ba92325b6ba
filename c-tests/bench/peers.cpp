// SPDX-FileCopyrightText: 2026 The warmccd developers
// SPDX-License-Identifier: BSD-3-Clause

// Other libraries' penetration solvers over the benchmark's own support
// functions. Each part is compiled alone (-DPEER_...), where its Debian package is,
// or what engines.sh has downloaded. Answers: 0 and depth, dir (the way obj2 moves), or -1.
// Every engine gets a support function and no more: what it does besides for spheres,
// capsules and meshes does not take part.

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

#ifdef PEER_MUJOCO
// mjc_ccd of MuJoCo 3.12.0, which its wheel exports. Its headers are not in the wheel: these are
// the structures of src/engine/engine_collision_{convex,gjk}.h, as far as mjc_ccd reads and writes them.
#include <math.h>
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
    const void *obj;
    ccd_support_fn support;
    ccd_center_fn center;
};
static void convex_center(double res[3], const mjCCDObj *o)
{
    const Convex *c = reinterpret_cast<const Convex *>(o);
    ccd_vec3_t at;
    c->center(c->obj, &at);
    for (int i = 0; i < 3; i++)
        res[i] = at.v[i];
}
static void convex_support(double res[3], mjCCDObj *o, const double d[3])
{
    const Convex *c = reinterpret_cast<const Convex *>(o);
    const ccd_vec3_t dir = {{d[0], d[1], d[2]}};
    ccd_vec3_t out;
    c->support(c->obj, &dir, &out);
    for (int i = 0; i < 3; i++)
        res[i] = out.v[i];
}

int peer_penetration(const void *a, const void *b, const ccd_t *ccd, double *depth, ccd_vec3_t *dir, ccd_vec3_t *)
{
    enum { ITERATIONS = 50, NO_TYPE = 1001 }; /* MuJoCo's default; mjGEOM_NONE */
    static std::vector<double> buffer(mjc_ccdSize(0, 0, ITERATIONS) / sizeof(double) + 1);
    const mjCCDConfig config = {ITERATIONS, ccd->epa_tolerance, 1, 0, buffer.data(), 0, 0};
    static mjCCDStatus status;
    Convex c[2] = {{{}, a, ccd->support1, ccd->center1}, {{}, b, ccd->support2, ccd->center2}};
    for (Convex &x : c) {
        mjCCDObj &o = x.engine;
        o.geom = o.vertindex = o.meshindex = o.flex = o.elem = o.vert = -1;
        o.geom_type = NO_TYPE;
        o.rotate[0] = 1;
        o.center = convex_center;
        o.support = convex_support;
    }
    const double distance = mjc_ccd(&config, &status, &c[0].engine, &c[1].engine);
    double n[3], l = 0;
    for (int i = 0; i < 3; i++) {
        n[i] = status.x1[i] - status.x2[i];
        l += n[i] * n[i];
    }
    if (!(distance < 0) || !(l > 0))
        return -1;
    *depth = -distance;
    for (int i = 0; i < 3; i++)
        dir->v[i] = n[i] / sqrt(l);
    return 0;
}
#endif

#ifdef PEER_COAL
// Coal's GJK and EPA with its defaults, over a Minkowski difference whose support function is ours.
#include <coal/narrowphase/gjk.h>

struct Pair : coal::details::MinkowskiDiff {
    const void *obj[2];
    const ccd_t *ccd;
};
static void pair_support(const coal::details::MinkowskiDiff &of, const coal::Vec3s &d, coal::Vec3s &p, coal::Vec3s &q,
                         coal::support_func_guess_t &, coal::details::ShapeSupportData *)
{
    const Pair &pair = static_cast<const Pair &>(of);
    const coal::Vec3s n = d.normalized();
    const ccd_vec3_t dir = {{n[0], n[1], n[2]}}, back = {{-n[0], -n[1], -n[2]}};
    ccd_vec3_t out[2];
    pair.ccd->support1(pair.obj[0], &dir, &out[0]);
    pair.ccd->support2(pair.obj[1], &back, &out[1]);
    p = {out[0].v[0], out[0].v[1], out[0].v[2]};
    q = {out[1].v[0], out[1].v[1], out[1].v[2]};
}

int peer_penetration(const void *a, const void *b, const ccd_t *ccd, double *depth, ccd_vec3_t *dir, ccd_vec3_t *)
{
    using namespace coal::details;
    static GJK gjk(coal::GJK_DEFAULT_MAX_ITERATIONS, ccd->epa_tolerance);
    static EPA epa(coal::EPA_DEFAULT_MAX_ITERATIONS, ccd->epa_tolerance);
    static Pair pair;
    ccd_vec3_t at[2];
    pair.obj[0] = a;
    pair.obj[1] = b;
    pair.ccd = ccd;
    pair.getSupportFunc = pair_support;
    pair.swept_sphere_radius.setZero();
    ccd->center1(a, &at[0]);
    ccd->center2(b, &at[1]);
    const coal::Vec3s guess(at[0].v[0] - at[1].v[0], at[0].v[1] - at[1].v[1], at[0].v[2] - at[1].v[2]);
    gjk.reset(coal::GJK_DEFAULT_MAX_ITERATIONS, ccd->epa_tolerance);
    if (gjk.evaluate(pair, guess) != GJK::Collision)
        return -1;
    epa.reset(coal::EPA_DEFAULT_MAX_ITERATIONS, ccd->epa_tolerance);
    if (!(epa.evaluate(gjk, -guess) & EPA::Valid))
        return -1;
    *depth = epa.depth;
    for (int i = 0; i < 3; i++)
        dir->v[i] = epa.normal[i];
    return 0;
}
#endif

#ifdef PEER_JOLT
// Jolt's GJK and EPA, in single precision around the first object's centre, with its default
// tolerances and without a convex radius.
#include <Jolt/Jolt.h>
#include <Jolt/Geometry/EPAPenetrationDepth.h>

struct Convex {
    const void *obj;
    ccd_support_fn support;
    const double *origin;
    JPH::Vec3 GetSupport(JPH::Vec3Arg d) const
    {
        const double x = d.GetX(), y = d.GetY(), z = d.GetZ(), l = sqrt(x * x + y * y + z * z);
        const ccd_vec3_t dir = {{l > 0 ? x / l : 1, l > 0 ? y / l : 0, l > 0 ? z / l : 0}};
        ccd_vec3_t out;
        support(obj, &dir, &out);
        return JPH::Vec3(float(out.v[0] - origin[0]), float(out.v[1] - origin[1]), float(out.v[2] - origin[2]));
    }
};

int peer_penetration(const void *a, const void *b, const ccd_t *ccd, double *depth, ccd_vec3_t *dir, ccd_vec3_t *)
{
    ccd_vec3_t at[2];
    ccd->center1(a, &at[0]);
    ccd->center2(b, &at[1]);
    const Convex ca = {a, ccd->support1, at[0].v}, cb = {b, ccd->support2, at[0].v};
    JPH::Vec3 v(1, 0, 0), p, q; /* as Jolt's own collision test starts */
    JPH::EPAPenetrationDepth epa;
    if (!epa.GetPenetrationDepth(ca, ca, 0, cb, cb, 0, 1e-4f, 1e-4f, v, p, q))
        return -1;
    const double l = (p - q).Length();
    if (!(l > 0) || !(v.Length() > 0))
        return -1;
    *depth = l;
    v = v.Normalized();
    for (int i = 0; i < 3; i++)
        dir->v[i] = v[i];
    return 0;
}
#endif
