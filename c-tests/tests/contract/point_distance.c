/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Compares ccdVec3PointTriDist2 and ccdVec3PointSegmentDist2 with the exact closest point, over
 * triangles of every shape and size. Arithmetic in 113 bits is exact enough: its own error
 * is below 1e-16 ulps of a double for the worst sliver. Errors are in ulps of the largest
 * coordinate. */

#include "check.h"
#include <ccd/ccd.h>
#include <float.h>
#include <math.h>

#ifdef __clang__
typedef __float128 exact_t; /* clang has no other name for it */
#else
__extension__ typedef _Float128 exact_t;
#endif
typedef struct { exact_t v[3]; } exact_vec_t;

static exact_vec_t exact(const ccd_vec3_t *a)
{
    exact_vec_t e;
    for (int i = 0; i < 3; i++)
        e.v[i] = a->v[i];
    return e;
}

/* Returns a + s (b - a) + t (c - a). */
static exact_vec_t combine(const exact_vec_t *a, exact_t s, const exact_vec_t *b, exact_t t, const exact_vec_t *c)
{
    exact_vec_t e;
    for (int i = 0; i < 3; i++)
        e.v[i] = a->v[i] + s * (b->v[i] - a->v[i]) + t * (c->v[i] - a->v[i]);
    return e;
}

/* Returns (b - a) . (d - c). */
static exact_t dot(const exact_vec_t *a, const exact_vec_t *b, const exact_vec_t *c, const exact_vec_t *d)
{
    return (b->v[0] - a->v[0]) * (d->v[0] - c->v[0]) + (b->v[1] - a->v[1]) * (d->v[1] - c->v[1])
           + (b->v[2] - a->v[2]) * (d->v[2] - c->v[2]);
}

static exact_t exact_segment(const exact_vec_t *p, const exact_vec_t *a, const exact_vec_t *b)
{
    exact_t t = 0, length2 = dot(a, b, a, b);
    if (length2 > 0)
        t = dot(a, p, a, b) / length2;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    exact_vec_t w = combine(a, t, b, 0, a);
    return dot(&w, p, &w, p);
}

static exact_t exact_triangle(const exact_vec_t *p, const exact_vec_t *a, const exact_vec_t *b, const exact_vec_t *c)
{
    exact_t bb = dot(a, b, a, b), cc = dot(a, c, a, c), bc = dot(a, b, a, c), det = bb * cc - bc * bc;
    exact_t least = exact_segment(p, a, b), d = exact_segment(p, b, c);
    least = d < least ? d : least;
    d = exact_segment(p, c, a);
    least = d < least ? d : least;
    if (det > 0) {
        exact_t s = 0, t = 0;
        exact_vec_t w = *a;
        /* Cramer's rule loses digits by the square of the triangle's condition: solve for the residual. */
        for (int i = 0; i < 4; i++) {
            exact_t pb = dot(&w, p, a, b), pc = dot(&w, p, a, c);
            s += (cc * pb - bc * pc) / det;
            t += (bb * pc - bc * pb) / det;
            w = combine(a, s, b, t, c);
        }
        if (s >= 0 && t >= 0 && s + t <= 1) {
            d = dot(&w, p, &w, p);
            least = d < least ? d : least;
        }
    }
    return least;
}

/* Returns 1 / sin of the triangle's angle at v[1]; 1 where the sine is below 0.001 (single: 0.1). */
static double error_factor(const ccd_vec3_t v[4])
{
    const exact_vec_t a = exact(&v[1]), b = exact(&v[2]), c = exact(&v[3]);
    exact_t bc = dot(&a, &b, &a, &c), lengths2 = dot(&a, &b, &a, &b) * dot(&a, &c, &a, &c);
    double sine2 = lengths2 > 0 ? (double)((lengths2 - bc * bc) / lengths2) : 0;
    return sine2 > (sizeof(ccd_real_t) == 8 ? 0.99e-6 : 0.99e-2) ? 1 / sqrt(sine2) : 1;
}

/* Returns a random point: new, or on the line of two points or at one of them, exactly or nearly. */
static ccd_vec3_t random_point(const ccd_vec3_t *a, const ccd_vec3_t *b, double size)
{
    static const double at[] = {0, 1, .5, -1, 2};
    ccd_vec3_t v = random_vec3(size);
    const double s = random_below(2) ? at[random_below(5)] : uniform(-1, 2);
    const double off = random_below(2) ? 0 : pow(10, uniform(-18, 0));
    if (random_below(2))
        for (int i = 0; i < 3; i++)
            v.v[i] = (ccd_real_t)((double)a->v[i] + s * (double)(b->v[i] - a->v[i]) + off * uniform(-size, size));
    return v;
}

/* Makes the triangle v[1], v[2], v[3], of any size: also a needle, a segment or a point; and a point v[0] on, near or away
 * from it. One in four has small integers, one in four lies in the plane z = 0. */
static void draw(ccd_vec3_t v[4])
{
    /* The fourth power of the size must not overflow, nor the square of an ulp underflow. */
    const double digits = sizeof(ccd_real_t) == 8 ? 70 : 8;
    const int is_integer = random_below(4) == 0, is_flat = random_below(4) == 0;
    const double size = is_integer ? 4 : pow(10, uniform(-digits, digits));
    const int order[3][3] = {{1, 2, 3}, {2, 3, 1}, {3, 1, 2}}, *corner = order[random_below(3)];
    ccd_vec3_t *a = &v[corner[0]], *b = &v[corner[1]], *c = &v[corner[2]], inside;
    *a = random_vec3(size);
    *b = random_point(a, a, size);
    *c = random_point(a, b, size);
    inside = random_point(a, b, size);
    v[0] = random_point(c, &inside, size);
    for (int i = 0; i < 4; i++) {
        v[i].v[2] *= (ccd_real_t)!is_flat;
        for (int k = 0; k < 3 && is_integer; k++)
            v[i].v[k] = (ccd_real_t)floor((double)v[i].v[k]);
    }
}

static ccd_real_t dist2_of(int is_segment, const ccd_vec3_t v[4], ccd_vec3_t *witness)
{
    return is_segment ? ccdVec3PointSegmentDist2(&v[0], &v[1], &v[2], witness)
                      : ccdVec3PointTriDist2(&v[0], &v[1], &v[2], &v[3], witness);
}

static exact_t exact_dist2(int is_segment, const exact_vec_t *p, const ccd_vec3_t v[4])
{
    const exact_vec_t a = exact(&v[1]), b = exact(&v[2]), c = exact(&v[3]);
    return is_segment ? exact_segment(p, &a, &b) : exact_triangle(p, &a, &b, &c);
}

/* Checks the distance from v[0] to the triangle of the other points, or to the segment of the first two. */
static void check(int is_segment, const ccd_vec3_t v[4])
{
    /* Twice the largest error observed (3.9). A triangle's may be larger by 1 / sin of its first
     * angle where that is not too small: there the operations are in libccd's order. */
    const double max_ulps = 8 * (is_segment ? 1 : error_factor(v));
    const char *name = is_segment ? "segment" : "triangle";
    const exact_vec_t p = exact(&v[0]);
    const int corner = is_segment ? 1 : 3;
    ccd_vec3_t witness, aliased[4];
    const ccd_real_t dist2 = dist2_of(is_segment, v, &witness);
    const exact_vec_t exact_witness = exact(&witness);
    /* The difference of the squares would lose its digits; sqrt of a double is within half an ulp. */
    const double dist_error = fabs(sqrt((double)dist2) - sqrt((double)exact_dist2(is_segment, &p, v)));
    const double witness_error = sqrt((double)exact_dist2(is_segment, &exact_witness, v));
    double size = 0;
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++)
            size = fmax(size, fabs((double)v[i].v[k]));
    const double ulp = CCD_EPS * (size > 0 ? size : 1);
    CHECK(dist_error <= max_ulps * ulp, "%s: distance off by %g ulps", name, dist_error / ulp);
    CHECK(witness_error <= max_ulps * ulp, "%s: witness point off by %g ulps", name, witness_error / ulp);
    CHECK(dist2 == ccdVec3Dist2(&v[0], &witness), "%s: the distance is that of the witness point", name);
    CHECK(dist2 == dist2_of(is_segment, v, NULL), "%s: with and without witness point", name);
    memcpy(aliased, v, sizeof aliased);
    CHECK(dist2 == dist2_of(is_segment, aliased, &aliased[corner]), "%s: witness point in place of a corner", name);
    CHECK(same_bits(&aliased[corner], &witness, sizeof witness), "%s: witness point in place of a corner", name);
}

int main(int argc, char **argv)
{
    const unsigned long rounds = strtoul(argc > 1 ? argv[1] : "200000", NULL, 10);
    const ccd_vec3_t from_nan[4] = {{{0, (ccd_real_t)NAN, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
    for (unsigned long round = 0; round < rounds; round++) {
        ccd_vec3_t v[4];
        draw(v);
        check(0, v);
        check(1, v);
    }
    CHECK(isnan(dist2_of(0, from_nan, NULL)) && isnan(dist2_of(1, from_nan, NULL)), "the distance of a NaN point");
    return checks_end();
}
