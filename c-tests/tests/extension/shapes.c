/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks <ccd/shapes.h>: support points against those of the truth, exact along axes, inside of the shape; depths against
 * the truth, and ccdCheck. Without OURS_ALONE yes and no, on any libccd. `print N` prints N queries of each shape with
 * their points, bit for bit, for the comparison with Rust. */

#include "harness/tolerances.h"
#include "tests/contract/check.h"

#include <ccd/shapes.h>
#ifdef OURS_ALONE
#include <ccd/warm.h>
#endif

enum { RINGS = 9, AROUND = 16, GLOBE = RINGS * AROUND + 2 };

/* An ellipsoid of rings of points between two poles, with its edges. */
static ccd_real_t globe[3 * GLOBE];
static int globe_first[GLOBE + 1], globe_neighbors[4 * GLOBE + 2 * AROUND];

static int globe_index(int ring, int k)
{
    return ring < 0 ? GLOBE - 2 : ring == RINGS ? GLOBE - 1 : ring * AROUND + (k + AROUND) % AROUND;
}

static void make_globe(void)
{
    int n = 0;
    for (int ring = 0; ring < RINGS; ring++)
        for (int k = 0; k < AROUND; k++) {
            const int i = globe_index(ring, k);
            const double t = 3.14159265358979 * (ring + 1) / (RINGS + 1), p = 3.14159265358979 * 2 * k / AROUND;
            globe[3 * i] = (ccd_real_t)(0.7 * sin(t) * cos(p));
            globe[3 * i + 1] = (ccd_real_t)(0.4 * sin(t) * sin(p));
            globe[3 * i + 2] = (ccd_real_t)(0.5 * cos(t));
            globe_first[i] = n;
            globe_neighbors[n++] = globe_index(ring, k - 1);
            globe_neighbors[n++] = globe_index(ring, k + 1);
            globe_neighbors[n++] = globe_index(ring - 1, k);
            globe_neighbors[n++] = globe_index(ring + 1, k);
        }
    for (int pole = 0; pole < 2; pole++) {
        globe[3 * (GLOBE - 2 + pole) + 2] = (ccd_real_t)(pole ? -0.5 : 0.5);
        globe_first[GLOBE - 2 + pole] = n;
        for (int k = 0; k < AROUND; k++)
            globe_neighbors[n++] = globe_index(pole ? RINGS - 1 : 0, k);
    }
    globe_first[GLOBE] = n;
}

/* Corners of a box, a tetrahedron, a polygon and a point: hulls that are scanned. */
static const ccd_real_t corners[] = {1, 1, 1, 1, 1, -1, 1, -1, 1, 1, -1, -1, -1, 1, 1, -1, 1, -1, -1, -1, 1, -1, -1, -1};
static const ccd_real_t simplex[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
static const ccd_real_t square[] = {1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0};

enum { SHAPES = 7 * 4 };

/* Makes the shape of this number at the origin: four of each kind, of usual, unequal, flat and zero sizes. */
static ccd_shape_t make_shape(int number)
{
    static const double sizes[4][3] = {{0.5, 0.3, 0.4}, {1e-3, 2, 0.1}, {0.7, 0, 0.2}, {0, 0, 0}};
    const ccd_shape_kind_t kind = (ccd_shape_kind_t)(number / 4);
    const double *p = sizes[number % 4];
    if (kind == CCD_SHAPE_HULL)
        switch (number % 4) {
        case 0: return ccdShapeHullWithNeighbors(globe, GLOBE, globe_first, globe_neighbors);
        case 1: return ccdShapeHull(corners, 8);
        case 2: return ccdShapeHull(simplex, 4);
        default: return ccdShapeHull(square, 4);
        }
    return ccdShape(kind, (ccd_real_t)p[0], (ccd_real_t)p[1], (ccd_real_t)p[2]);
}

static void place_at_random(ccd_shape_t *shape, double size)
{
    double q[4];
    uniform_rotation(q);
    shape->pos = random_vec3(size);
    ccdQuatSet(&shape->quat, (ccd_real_t)q[1], (ccd_real_t)q[2], (ccd_real_t)q[3], (ccd_real_t)q[0]);
}

/* Returns the same shape of the tests, in its own frame. */
static shape_t in_tests(const ccd_shape_t *shape)
{
    if (shape->kind == CCD_SHAPE_HULL)
        return shape_polytope(shape->hull.points, shape->hull.count);
    return shape_make((int)shape->kind, (double)shape->size[0], (double)shape->size[1], (double)shape->size[2]);
}

/* Writes the rotation matrix of the shape: v + 2 u x (u x v + w v). */
static void matrix(const ccd_shape_t *shape, truth_real m[3][3])
{
    const truth_real u[3] = {shape->quat.q[0], shape->quat.q[1], shape->quat.q[2]}, w = shape->quat.q[3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            m[i][j] = 2 * u[i] * u[j] + (i == j ? 1 - 2 * truth_dot(u, u) : 0);
    for (int i = 0; i < 3; i++) {
        m[i][(i + 1) % 3] -= 2 * w * u[(i + 2) % 3];
        m[(i + 1) % 3][i] += 2 * w * u[(i + 2) % 3];
    }
}

/* Returns the largest value along n of a point of the shape, by the truth's own support point. */
static truth_real support_value(const ccd_shape_t *shape, const ccd_vec3_t *n)
{
    const shape_t local = in_tests(shape);
    truth_real m[3][3], d[3] = {0, 0, 0}, v[3] = {0, 0, 0}, value = 0;
    matrix(shape, m);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            d[i] += m[j][i] * n->v[j];
    truth_local_support(&local, d, v);
    for (int i = 0; i < 3; i++)
        value += d[i] * v[i] + (truth_real)n->v[i] * shape->pos.v[i];
    return value;
}

static truth_real value_of(const ccd_vec3_t *p, const ccd_vec3_t *n)
{
    return (truth_real)p->v[0] * n->v[0] + (truth_real)p->v[1] * n->v[1] + (truth_real)p->v[2] * n->v[2];
}

/* Returns a random direction: a unit one, one of another length, one nearly or exactly along axes, or of zeros of both signs. */
static ccd_vec3_t random_direction(void)
{
    const double nearly = pow(10, uniform(-30, 0)), length = pow(10, uniform(-8, 8));
    const int kind = random_below(4);
    ccd_vec3_t d = random_vec3(1);
    for (int i = 0; i < 3; i++) {
        if (kind == 2)
            d.v[i] *= (ccd_real_t)(random_below(2) ? nearly : 1);
        if (kind == 3)
            d.v[i] = (ccd_real_t)copysign(random_below(2), (double)d.v[i]);
    }
    if (!(ccdVec3Len2(&d) > 0))
        ccdVec3Set(&d, 0, 0, 1);
    ccdVec3Scale(&d, kind == 1 ? (ccd_real_t)length : 1 / CCD_SQRT(ccdVec3Len2(&d)));
    return d;
}

static void check_points(int number)
{
    ccd_shape_t shape = make_shape(number);
    const shape_t local = in_tests(&shape);
    const double reach = shape_reach(&local);
    ccd_vec3_t center;
    for (int round = 0; round < 400; round++) {
        const ccd_vec3_t d = random_direction();
        const int is_axis = (d.v[0] == 0) + (d.v[1] == 0) + (d.v[2] == 0) == 2;
        ccd_vec3_t p;
        if (round >= 200)
            place_at_random(&shape, 1);
        const double noise = tolerance(TOL_ULPS) * real_eps() * (reach + sqrt((double)ccdVec3Len2(&shape.pos)));
        ccdShapeSupport(&shape, &d, &p);
        const truth_real truth = support_value(&shape, &d), error = truth - value_of(&p, &d);
        CHECK(fabsl(error) <= noise * sqrt((double)ccdVec3Len2(&d)), "shape %d: %Lg along %g %g %g", number, error,
              (double)d.v[0], (double)d.v[1], (double)d.v[2]);
        CHECK(round >= 200 || !is_axis || value_of(&p, &d) == (ccd_real_t)truth, "shape %d: %Lg along an axis", number, error);
        ccdShapeCenter(&shape, &center);
        for (int k = 0; k < 20; k++) {
            const ccd_vec3_t n = random_direction();
            const truth_real bound = support_value(&shape, &n) + noise * sqrt((double)ccdVec3Len2(&n));
            CHECK(value_of(&p, &n) <= bound, "shape %d: a point outside by %Lg", number, value_of(&p, &n) - bound);
            CHECK(value_of(&center, &n) <= bound, "shape %d: the center outside", number);
        }
    }
#ifdef OURS_ALONE
    ccd_check_t found;
    const int faults = ccdCheck(&shape, ccdShapeSupport, ccdShapeCenter, &found);
    CHECK(faults == 0, "shape %d: faults %d, noise %g", number, faults, (double)found.noise);
#endif
}

/* Places the tests' shape like a ready one. */
static shape_t placed(const ccd_shape_t *shape)
{
    shape_t s = in_tests(shape);
    truth_real m[3][3];
    double rot[9];
    matrix(shape, m);
    for (int i = 0; i < 9; i++)
        rot[i] = (double)m[i / 3][i % 3];
    shape_turn(&s, rot);
    shape_move(&s, (double)shape->pos.v[0], (double)shape->pos.v[1], (double)shape->pos.v[2]);
    return s;
}

/* Checks the answers of a pair of random shapes of usual sizes. */
static void check_pair(void)
{
    ccd_shape_t a = make_shape(4 * random_below(7)), b = make_shape(4 * random_below(7));
    place_at_random(&a, 0.4);
    place_at_random(&b, 0.4);
    const shape_t x = placed(&a), y = placed(&b);
    const double size = pair_size(&x, &y), noise = pair_noise(&x, &y);
    const truth_t truth = truth_depth_within(&x, &y, 1e-6 * size);
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = ccdShapeSupport;
    ccd.center1 = ccd.center2 = ccdShapeCenter;
    if (fabs(truth.depth) > 1e-3 * size) {
        CHECK(ccdMPRIntersect(&a, &b, &ccd) == (truth.depth > 0), "kinds %d %d: MPR", a.kind, b.kind);
        CHECK(ccdGJKIntersect(&a, &b, &ccd) == (truth.depth > 0), "kinds %d %d: GJK", a.kind, b.kind);
    }
#ifdef OURS_ALONE
    ccd_penetration_t hit;
    ccd.mpr_tolerance = (ccd_real_t)(1e-5 * size);
    const int code = ccdPenetration(&a, &b, &ccd, NULL, CCD_WANT_ALL, &hit);
    const double most = fmax((double)ccd.mpr_tolerance, tolerance(TOL_MPR) * truth.depth) + noise;
    CHECK(code >= 0 ? (double)hit.depth >= truth.lower - noise && (double)hit.depth <= truth.depth + most
                    : truth.lower <= noise,
          "kinds %d %d: code %d, depth %g of %g", a.kind, b.kind, code, (double)hit.depth, truth.depth);
#else
    (void)noise;
#endif
}

static void print_bits(const ccd_real_t *x, int n)
{
    for (int i = 0; i < n; i++) {
        uint64_t bits = 0;
        uint32_t single;
        if (sizeof *x == sizeof single) {
            memcpy(&single, &x[i], sizeof single);
            bits = single;
        } else
            memcpy(&bits, &x[i], sizeof *x);
        printf("%llx ", (unsigned long long)bits);
    }
}

/* Prints kind, size and count of points of each shape, its points and neighbors; then pose, direction, point and center of
 * each query. */
static void print_shape(int number, int queries)
{
    ccd_shape_t shape = make_shape(number);
    printf("shape %d %d %d ", (int)shape.kind, shape.hull.count, shape.hull.first ? shape.hull.first[shape.hull.count] : 0);
    print_bits(shape.size, 3);
    print_bits(shape.hull.points, 3 * shape.hull.count);
    for (int i = 0; shape.hull.first && i <= shape.hull.count; i++)
        printf("%x ", (unsigned)shape.hull.first[i]);
    for (int i = 0; shape.hull.first && i < shape.hull.first[shape.hull.count]; i++)
        printf("%x ", (unsigned)shape.hull.neighbors[i]);
    printf("\n");
    for (int i = 0; i < queries; i++) {
        const ccd_vec3_t d = random_direction();
        ccd_vec3_t p, center;
        if (i >= queries / 2)
            place_at_random(&shape, 1);
        ccdShapeSupport(&shape, &d, &p);
        ccdShapeCenter(&shape, &center);
        print_bits(shape.pos.v, 3);
        print_bits(shape.quat.q, 4);
        print_bits(d.v, 3);
        print_bits(p.v, 3);
        print_bits(center.v, 3);
        printf("\n");
    }
}

int main(int argc, char **argv)
{
    make_globe();
    for (int number = 0; number < SHAPES; number++)
        if (argc > 2)
            print_shape(number, atoi(argv[2]));
        else
            check_points(number);
    if (argc > 2)
        return 0;
    for (int round = 0; round < 300; round++)
        check_pair();
    return checks_end();
}
