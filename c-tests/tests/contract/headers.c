/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Prints the values of every macro and inline function of the headers, for random and special numbers, bit
 * for bit. Compiled with libccd's headers and with this library's, as C99 and C++11: the driver compares the
 * output, and checks that no name is missing. (A test in src/ffi/types.rs asserts the layouts.) */

#include <ccd/ccd.h>
#include <ccd/ccd_export.h>
#include <ccd/compiler.h>
#include <ccd/config.h>
#include <ccd/quat.h>
#include <ccd/vec3.h>
#include <stdio.h>

/* Headers that ccd.h includes: stdlib.h, math.h, float.h, stddef.h. */
static size_t included = sizeof(ptrdiff_t) + DBL_DIG + RAND_MAX;

static void print_real(const char *name, ccd_real_t value)
{
    if (value != value)
        printf("%s nan\n", name);
    else
        printf("%s %a\n", name, (double)value);
}

static void print_vec3(const char *name, const ccd_vec3_t *v)
{
    print_real(name, ccdVec3X(v));
    print_real(name, ccdVec3Y(v));
    print_real(name, ccdVec3Z(v));
}

static void print_quat(const char *name, const ccd_quat_t *q)
{
    for (int i = 0; i < 4; i++)
        print_real(name, q->q[i]);
}

static ccd_real_t random_number(void)
{
    static const ccd_real_t special[] = {0, 1, -1, 2, CCD_EPS, CCD_EPS / 2, -CCD_EPS, 2 * CCD_EPS, 1 + CCD_EPS, CCD_REAL_MAX,
                                         -CCD_REAL_MAX, CCD_REAL(1e-20), CCD_REAL(1e20), CCD_REAL(0.1),
                                         (ccd_real_t)HUGE_VAL, -(ccd_real_t)HUGE_VAL, (ccd_real_t)NAN};
    int kind = rand() % 4;
    ccd_real_t unit = (ccd_real_t)(rand() % 20001 - 10000) / 10000;
    if (kind == 0)
        return special[rand() % 17];
    return kind == 1 ? unit * (ccd_real_t)pow(10, rand() % 20 - 10) : unit;
}

static void set_random_vec3(ccd_vec3_t *v)
{
    ccd_real_t x = random_number(), y = random_number(), z = random_number();
    ccdVec3Set(v, x, y, z);
}

static void set_random_quat(ccd_quat_t *q)
{
    ccd_real_t x = random_number(), y = random_number(), z = random_number(), w = random_number();
    ccdQuatSet(q, x, y, z, w);
}

static void support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *vec)
{
    (void)obj;
    ccdVec3Copy(vec, dir);
}

static void center(const void *obj, ccd_vec3_t *c)
{
    (void)obj;
    ccdVec3Copy(c, ccd_vec3_origin);
}

/* Redeclarations: another type is an error. */
#ifdef __cplusplus
extern "C" {
#endif
void ccdFirstDirDefault(const void *, const void *, ccd_vec3_t *);
int ccdGJKIntersect(const void *, const void *, const ccd_t *);
int ccdMPRIntersect(const void *, const void *, const ccd_t *);
int ccdGJKSeparate(const void *, const void *, const ccd_t *, ccd_vec3_t *);
int ccdGJKPenetration(const void *, const void *, const ccd_t *, ccd_real_t *, ccd_vec3_t *, ccd_vec3_t *);
int ccdMPRPenetration(const void *, const void *, const ccd_t *, ccd_real_t *, ccd_vec3_t *, ccd_vec3_t *);
ccd_real_t ccdVec3PointSegmentDist2(const ccd_vec3_t *, const ccd_vec3_t *, const ccd_vec3_t *, ccd_vec3_t *);
ccd_real_t ccdVec3PointTriDist2(const ccd_vec3_t *, const ccd_vec3_t *, const ccd_vec3_t *, const ccd_vec3_t *, ccd_vec3_t *);
extern ccd_vec3_t *ccd_vec3_origin, *ccd_points_on_sphere;
extern size_t ccd_points_on_sphere_len;
#ifdef __cplusplus
}
#endif

/* The typedefs, and the tags behind them. */
static ccd_support_fn support_fn = support;
static ccd_first_dir_fn first_dir_fn = ccdFirstDirDefault;
static ccd_center_fn center_fn = center;
static struct _ccd_t tagged;
static struct _ccd_vec3_t tagged_vec3 = CCD_VEC3_STATIC(1, 2, 3);
static struct _ccd_quat_t tagged_quat;

struct outer { int first; ccd_vec3_t member; };

_ccd_inline int inlined(void) { return 5; }

CCD_EXPORT int exported(void);
CCD_EXPORT int exported(void) { return 7; }

/* Print the result of a call in c or r. */
#define VEC3(call) (call, print_vec3(#call, &c))
#define QUAT(call) (call, print_quat(#call, &r))

int main(void)
{
    int round;
    ccd_t ccd;
    struct outer outer = {1, {{0, 0, 0}}};
    CCD_INIT(&ccd);
    printf("%d %d %d %d %d\n", ccd.first_dir == first_dir_fn, ccd.support1 == NULL, ccd.support2 == NULL,
           ccd.center1 == NULL, ccd.center2 == NULL);
    ccd.first_dir(NULL, NULL, &outer.member);
    print_vec3("ccdFirstDirDefault", &outer.member);
    printf("%lu\n", ccd.max_iterations);
    print_real("epa_tolerance", ccd.epa_tolerance);
    print_real("mpr_tolerance", ccd.mpr_tolerance);
    print_real("dist_tolerance", ccd.dist_tolerance);
    tagged = ccd;
    tagged.support1 = support_fn;
    tagged.center1 = center_fn;
    if (inlined() > 4)
        CCD_INIT(&tagged);
    else
        return 1;
    printf("%d %d\n", tagged.support1 == NULL, tagged.center1 == NULL);
    print_vec3("tagged", &tagged_vec3);
    print_quat("tagged", &tagged_quat);
    printf("%lu %lu %d\n", (unsigned long)included, (unsigned long)ccd_offsetof(struct outer, member),
           (ccd_container_of(&outer.member, struct outer, member))->first);
    printf("%d %d\n", inlined(), exported());
#define BYTES(member) (int)offsetof(ccd_t, member)
    printf("%d %d %d: %d %d %d %d %d %d %d %d %d\n", (int)sizeof(ccd_vec3_t), (int)sizeof(ccd_quat_t), (int)sizeof(ccd_t),
           BYTES(first_dir), BYTES(support1), BYTES(support2), BYTES(center1), BYTES(center2), BYTES(max_iterations),
           BYTES(epa_tolerance), BYTES(mpr_tolerance), BYTES(dist_tolerance));
    _ccd_prefetch(&outer);
    _ccd_prefetchw(&outer);
    print_real("CCD_EPS", CCD_EPS);
    print_real("CCD_REAL_MAX", CCD_REAL_MAX);
    print_real("CCD_ZERO", CCD_ZERO);
    print_real("CCD_ONE", CCD_ONE);
    print_real("CCD_REAL", CCD_REAL(0.1));
    printf("%d %d %d\n", (int)sizeof(CCD_REAL(0.1)), (int)sizeof(CCD_EPS), (int)sizeof(ccd_real_t));
#ifdef CCD_SINGLE
    printf("CCD_SINGLE\n");
#endif
#ifdef CCD_DOUBLE
    printf("CCD_DOUBLE\n");
#endif

    srand(1);
    for (round = 0; round < 20000; round++) {
        ccd_real_t x = random_number(), y = rand() % 3 ? random_number() : x * (1 + (ccd_real_t)(rand() % 5 - 2) * CCD_EPS);
        ccd_vec3_t a, b, c;
        ccd_quat_t p, q, r;
        CCD_VEC3(made, x, y, 3);
        CCD_QUAT(turned, x, y, 3, 4);
        print_vec3("CCD_VEC3", &made);
        print_quat("CCD_QUAT", &turned);
        print_real("CCD_SQRT", CCD_SQRT(x));
        print_real("CCD_FABS", CCD_FABS(x));
        print_real("CCD_FMAX", CCD_FMAX(x, y));
        print_real("CCD_FMIN", CCD_FMIN(x, y));
        printf("%d %d %d\n", ccdSign(x), ccdIsZero(x), ccdEq(x, y));

        set_random_vec3(&a);
        set_random_vec3(&b);
        if (rand() % 2)
            ccdVec3Copy(&b, &a);
        if (rand() % 2)
            b.v[rand() % 3] *= 1 + (ccd_real_t)(rand() % 5 - 2) * CCD_EPS;
        printf("%d\n", ccdVec3Eq(&a, &b));
        print_real("ccdVec3Len2", ccdVec3Len2(&a));
        print_real("ccdVec3Dist2", ccdVec3Dist2(&a, &b));
        print_real("ccdVec3Dot", ccdVec3Dot(&a, &b));
        ccdVec3Copy(&c, &a);
        VEC3(ccdVec3Sub(&c, &b));
        VEC3(ccdVec3Add(&c, &b));
        VEC3(ccdVec3Sub2(&c, &b, &a));
        VEC3(ccdVec3Scale(&c, x));
        ccdVec3Copy(&c, &b);
        VEC3(ccdVec3Normalize(&c));
        VEC3(ccdVec3Cross(&c, &a, &b));

        set_random_quat(&p);
        set_random_quat(&q);
        print_real("ccdQuatLen2", ccdQuatLen2(&p));
        print_real("ccdQuatLen", ccdQuatLen(&p));
        ccdQuatCopy(&r, &p);
        QUAT(printf("%d\n", ccdQuatNormalize(&r)));
        QUAT(ccdQuatSetAngleAxis(&r, x, &a));
        QUAT(ccdQuatScale(&r, y));
        QUAT(ccdQuatMul2(&r, &p, &q));
        ccdQuatCopy(&r, &p);
        QUAT(ccdQuatMul(&r, &q));
        QUAT(printf("%d\n", ccdQuatInvert(&r)));
        QUAT(printf("%d\n", ccdQuatInvert2(&r, &q)));
        ccdVec3Copy(&c, &b);
        VEC3(ccdQuatRotVec(&c, &p));
    }
    return 0;
}
