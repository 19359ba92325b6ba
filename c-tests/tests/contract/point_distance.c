/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* ccdVec3PointTriDist2 and ccdVec3PointSegmentDist2 against the exact nearest point, over
 * triangles of every shape and size. Arithmetic in 113 bits is exact enough: its own error
 * is below 1e-16 ulps of a double for the worst sliver.
 *
 * The error of a distance is counted in ulps of the largest coordinate. With the system's
 * libccd beside it, libccd's worst error is printed, not judged. */

#include "check.h"
#include "harness/this_library.h"
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

/* a + s (b - a) + t (c - a) */
static exact_vec_t combine(const exact_vec_t *a, exact_t s, const exact_vec_t *b, exact_t t, const exact_vec_t *c)
{
    exact_vec_t e;
    for (int i = 0; i < 3; i++)
        e.v[i] = a->v[i] + s * (b->v[i] - a->v[i]) + t * (c->v[i] - a->v[i]);
    return e;
}

/* (b - a) . (d - c) */
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
        /* Cramer's rule loses the square of the triangle's condition: solve for what is left, again. */
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

/* 1 / sin of the angle at a, 1 where that is below 0.001 (single: 0.1). */
static double amplified(const exact_vec_t *a, const exact_vec_t *b, const exact_vec_t *c)
{
    exact_t bc = dot(a, b, a, c), lengths2 = dot(a, b, a, b) * dot(a, c, a, c);
    double sine2 = lengths2 > 0 ? (double)((lengths2 - bc * bc) / lengths2) : 0;
    return sine2 > (sizeof(ccd_real_t) == 8 ? 0.99e-6 : 0.99e-2) ? 1 / sqrt(sine2) : 1;
}

/* The larger of the errors of distance and witness, in ulps of size. */
static double error(exact_t dist2, ccd_real_t answer, exact_t witness_off, double size)
{
    double wrong = fabs(sqrt((double)answer) - sqrt((double)dist2)), off = sqrt((double)witness_off);
    /* Subtracting squares first would lose what is asked for; sqrt of a double is within half an ulp. */
    return (wrong > off || wrong != wrong ? wrong : off) / (CCD_EPS * size);
}

enum { SHAPES = 9 };
static const char *const shape_names[SHAPES] = {
    "any", "needle", "cap", "collinear", "two corners equal", "one point", "small integers", "far from the origin", "flat, p in plane"};

/* A triangle of the kind, and a point on, near or away from it. */
static void draw(int shape, ccd_vec3_t v[4])
{
    /* The fourth power must be a number of the precision, and the square of an ulp. */
    const double digits = sizeof(ccd_real_t) == 8 ? 70 : 8;
    double size = pow(10, uniform(-digits, digits)), thin = pow(10, uniform(-18, 0)), s = uniform(0, 1), t = uniform(0, 1);
    ccd_vec3_t *p = &v[0], *a = &v[1], *b = &v[2], *c = &v[3];
    for (int i = 0; i < 4; i++)
        v[i] = random_vec3(size);
    for (int i = 0; i < 3; i++) {
        ccd_real_t *pi = &p->v[i], *ai = &a->v[i], *bi = &b->v[i], *ci = &c->v[i];
        ccd_real_t noise = (ccd_real_t)(thin * uniform(-size, size));
        switch (shape) {
        case 1: *ci = *ai + noise; break;
        case 2: *ci = (ccd_real_t)(*ai + s * (*bi - *ai)) + noise; break;
        case 3: *ci = (ccd_real_t)(*ai + (4 * s - 2) * (*bi - *ai)); break;
        case 4: *ci = *ai; break;
        case 5: *bi = *ci = *ai; break;
        case 6:
            *pi = (ccd_real_t)(random_below(7) - 3);
            *ai = (ccd_real_t)(random_below(7) - 3);
            *bi = (ccd_real_t)(random_below(7) - 3);
            *ci = (ccd_real_t)(random_below(7) - 3);
            break;
        case 7: *bi = *ai + noise; *ci = *ai + (ccd_real_t)(thin * uniform(-size, size)); break;
        case 8: if (i == 2) *pi = *ai = *bi = *ci = 0; break;
        }
    }
    if (shape != 6 && random_below(2)) {
        /* On the triangle or its plane, or off it by little. */
        double off = random_below(2) ? 0 : pow(10, uniform(-16, -1));
        s = random_below(3) == 0 ? (double)random_below(2) : 2 * s - 0.5;
        t = random_below(3) == 0 ? 0 : t;
        for (int i = 0; i < 3; i++)
            p->v[i] = (ccd_real_t)(a->v[i] + s * (b->v[i] - a->v[i]) + t * (c->v[i] - a->v[i]) + off * uniform(-size, size));
    }
    if (random_below(8) == 0)
        *p = v[1 + random_below(3)];
    /* Every order of the corners. */
    for (int i = 3; i > 1; i--) {
        int k = 1 + random_below(i);
        ccd_vec3_t swap = v[i];
        v[i] = v[k];
        v[k] = swap;
    }
}

int main(int argc, char **argv)
{
    const unsigned long rounds = strtoul(argc > 1 ? argv[1] : "20000", NULL, 10);
    /* Twice what was ever seen (3.9). A triangle's may be more by 1 / sin of its first
     * angle where that is not too small: there the order of libccd's operations is kept. */
    const double allowed = 8;
    int shape;
    printf("worst error in ulps of the largest coordinate, triangle / segment\n");
    for (shape = 0; shape < SHAPES; shape++) {
        double worst[2] = {0, 0};
#ifndef OURS_ALONE
        double libccd[2] = {0, 0};
        unsigned long not_finite = 0;
#endif
        unsigned long round;
        for (round = 0; round < rounds; round++) {
            ccd_vec3_t v[4], w, aliased;
            exact_vec_t e[4], ew;
            exact_t truth[2];
            double size = 0, err;
            ccd_real_t dist2;
            int i, k;
            draw(shape, v);
            for (i = 0; i < 4; i++) {
                e[i] = exact(&v[i]);
                for (k = 0; k < 3; k++)
                    size = fmax(size, fabs((double)v[i].v[k]));
            }
            if (!(size > 0))
                size = 1;
            truth[0] = exact_triangle(&e[0], &e[1], &e[2], &e[3]);
            truth[1] = exact_segment(&e[0], &e[1], &e[2]);

            dist2 = OURS(ccdVec3PointTriDist2)(&v[0], &v[1], &v[2], &v[3], &w);
            ew = exact(&w);
            err = error(truth[0], dist2, exact_triangle(&ew, &e[1], &e[2], &e[3]), size);
            CHECK(err <= allowed * amplified(&e[1], &e[2], &e[3]), "triangle %s, round %lu: %g ulps", shape_names[shape],
                  round, err);
            worst[0] = fmax(worst[0], err);
            CHECK(dist2 == ccdVec3Dist2(&v[0], &w), "the distance is that of the witness");
            CHECK(dist2 == OURS(ccdVec3PointTriDist2)(&v[0], &v[1], &v[2], &v[3], NULL), "with and without witness");
            aliased = v[3];
            CHECK(dist2 == OURS(ccdVec3PointTriDist2)(&v[0], &v[1], &v[2], &aliased, &aliased)
                      && same_bits(&aliased, &w, sizeof w), "witness in place of a corner");

            dist2 = OURS(ccdVec3PointSegmentDist2)(&v[0], &v[1], &v[2], &w);
            ew = exact(&w);
            err = error(truth[1], dist2, exact_segment(&ew, &e[1], &e[2]), size);
            CHECK(err <= allowed, "segment %s, round %lu: %g ulps", shape_names[shape], round, err);
            worst[1] = fmax(worst[1], err);
            CHECK(dist2 == ccdVec3Dist2(&v[0], &w), "the distance is that of the witness");
            CHECK(dist2 == OURS(ccdVec3PointSegmentDist2)(&v[0], &v[1], &v[2], NULL), "with and without witness");
            aliased = v[1];
            CHECK(dist2 == OURS(ccdVec3PointSegmentDist2)(&v[0], &aliased, &v[2], &aliased)
                      && same_bits(&aliased, &w, sizeof w), "witness in place of an end");

#ifndef OURS_ALONE
            dist2 = ccdVec3PointTriDist2(&v[0], &v[1], &v[2], &v[3], NULL);
            not_finite += !(dist2 < CCD_REAL_MAX);
            libccd[0] = fmax(libccd[0], error(truth[0], dist2, 0, size));
            dist2 = ccdVec3PointSegmentDist2(&v[0], &v[1], &v[2], NULL);
            not_finite += !(dist2 < CCD_REAL_MAX);
            libccd[1] = fmax(libccd[1], error(truth[1], dist2, 0, size));
#endif
        }
        printf("%-20s %6.2f / %5.2f", shape_names[shape], worst[0], worst[1]);
#ifndef OURS_ALONE
        printf("    libccd %8.2g / %8.2g, not finite %lu", libccd[0], libccd[1], not_finite);
#endif
        printf("\n");
    }
    {
        /* A point that is no number has no distance. */
        const ccd_vec3_t nan = {{0, (ccd_real_t)NAN, 0}}, a = {{1, 0, 0}}, b = {{0, 1, 0}}, c = {{0, 0, 1}};
        const ccd_real_t triangle = OURS(ccdVec3PointTriDist2)(&nan, &a, &b, &c, NULL);
        const ccd_real_t segment = OURS(ccdVec3PointSegmentDist2)(&nan, &a, &b, NULL);
        CHECK(triangle != triangle && segment != segment, "a NaN point has no distance");
    }
    return checks_end();
}
