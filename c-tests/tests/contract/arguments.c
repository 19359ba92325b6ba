/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Nothing is read but what a call needs; input that no query can like: few iterations, an object
 * against itself, objects without volume, sizes far from 1; outputs that are NULL. (Tolerances, points
 * that are no numbers, and callbacks that lie: tests/extension/bad_input.c; ordinary input of every size:
 * stability/campaign.c; the same bits whenever they are asked for: threads.c.) Always a return code of
 * the call's, outputs untouched unless it is a hit, a hit sound, and an end: the number of support
 * points is bounded. */

#include "every_call.h"
#include <math.h>
#include <time.h>

static int share = 100; /* percent of all questions */

static int may_return(const call_t *entry, int code)
{
    if (code == entry->hit || code == entry->miss)
        return 1;
    return (entry->traits & EXTENSION) && entry->hit == CCD_HIT && (code == CCD_BAD_INPUT || code == CCD_LIMIT);
}

/* The support value of D along dir: moving obj2 that far separates. */
static double value_along(const shape_t *a, const shape_t *b, const ccd_vec3_t *dir)
{
    ccd_vec3_t back = *dir, p, q;
    ccdVec3Scale(&back, -1);
    shape_support(a, dir, &p);
    shape_support(b, &back, &q);
    ccdVec3Sub(&p, &q);
    return (double)ccdVec3Dot(&p, dir);
}

/* Runs the query and checks what must hold whatever goes in. */
static int ask(const call_t *entry, shape_t *a, shape_t *b, const ccd_t *ccd, double size, const char *what)
{
    /* 10 ms of a primitive's callbacks. */
    const unsigned long most = 20000;
    outputs_t out, before;
    clock_t start = clock();
    memset(&out, 0x5a, sizeof out);
    before = out;
    a->calls = b->calls = 0;
    int code = run(entry, a, b, ccd, &out);
    CHECK(may_return(entry, code), "%s, %s: returned %d", entry->name, what, code);
    CHECK(a->calls + b->calls <= most, "%s, %s: %lu supports, %.3f s", entry->name, what, a->calls + b->calls,
          (double)(clock() - start) / CLOCKS_PER_SEC);
    if (code != entry->hit) {
        CHECK(same_bits(&out, &before, sizeof out), "%s, %s: outputs touched with %d", entry->name, what, code);
    } else if (entry->traits & STORES) {
        CHECK(fabs((double)ccdVec3Len2(&out.dir) - 1) <= 8 * (double)CCD_EPS, "%s, %s: dir not unit", entry->name, what);
        CHECK(out.depth >= 0 && out.depth <= CCD_REAL_MAX, "%s, %s: depth %g", entry->name, what, (double)out.depth);
        for (int i = 0; i < 3; i++)
            CHECK(fabs((double)out.pos.v[i]) <= (double)CCD_REAL_MAX, "%s, %s: pos", entry->name, what);
        if (entry->number == CALL_ALONG)
            CHECK(value_along(a, b, &out.normal) <= (double)(out.depth * ccdVec3Dot(&out.dir, &out.normal)) + 64 * (double)CCD_EPS * size,
                  "%s, %s: depth %g", entry->name, what, (double)out.depth);
        else
            CHECK(value_along(a, b, &out.dir) <= (double)out.depth + 64 * (double)CCD_EPS * size,
                  "%s, %s: depth %g, but it takes %g", entry->name, what, (double)out.depth, value_along(a, b, &out.dir));
    }
    return code;
}

static void iterations(const call_t *entry)
{
    static const unsigned long limits[] = {0, 1, 2, 3, 5, 7, 10, 14, 20, (unsigned long)-1};
    for (int round = 0; round < 1000 * share / 100; round++) {
        shape_t a, b;
        ccd_t ccd;
        random_pair(entry, round % 2, &a, &b, &ccd);
        ccd.max_iterations = limits[round / 2 % 10];
        int code = ask(entry, &a, &b, &ccd, 10, "few iterations");
        CHECK(ccd.max_iterations <= 20 || code == (round % 2 ? entry->hit : entry->miss), "%s: returned %d", entry->name, code);
        /* The extension may say CCD_LIMIT, which these call_table count as a hit. */
        if (round % 2 == 0 && (!(entry->traits & EXTENSION) || (entry->traits & FROM_CENTERS)))
            CHECK(code != entry->hit, "%s: objects far apart hit after %lu iterations", entry->name, ccd.max_iterations);
        /* No support function is needed to know that they overlap. */
        if (round % 2 && ccd.max_iterations > 0)
            CHECK(code != entry->miss, "%s: a deep overlap missed after %lu iterations", entry->name, ccd.max_iterations);
    }
}

static void degenerate(const call_t *entry)
{
    static const ccd_real_t point[] = {0, 0, 0}, segment[] = {-1, -1, 0, 1, 1, 0},
                            square[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    const shape_t plain[] = {shape_polytope(point, 1),   shape_polytope(segment, 2), shape_polytope(square, 4),
                             shape_sphere(0),            shape_capsule(0, 1),        shape_cylinder(1, 0),
                             shape_box(1, 0, 1),         shape_sphere(1),            shape_box(1, 1, 1),
                             shape_ellipsoid(1, 0.5, 2), shape_cylinder(1, 1),       shape_cone(1, 1)};
    enum { PLAIN = sizeof plain / sizeof plain[0] };
    /* The fourth power of a size must be a number of the precision, with room for rounding. */
    static const double sizes[] = {1, 1e-3, 1e3, 1e6, sizeof(ccd_real_t) == 8 ? 1e-50 : 1e-6, sizeof(ccd_real_t) == 8 ? 1e60 : 1e6};
    for (int i = 0; i < PLAIN; i++)
        for (int k = 0; k < PLAIN; k++)
            for (int at = 0; at < 3; at++)
                for (int size = 0; size < 6; size += share < 100 ? 6 : 1) {
                    static ccd_real_t scaled[2][12];
                    shape_t s[2];
                    s[0] = plain[i];
                    s[1] = plain[k];
                    for (int n = 0; n < 2; n++) {
                        for (int c = 0; c < 3; c++)
                            s[n].p[c] *= (ccd_real_t)sizes[size];
                        for (int c = 0; c < 3 * s[n].nverts; c++)
                            scaled[n][c] = s[n].verts[c] * (ccd_real_t)sizes[size];
                        if (s[n].nverts > 0)
                            s[n].verts = scaled[n];
                    }
                    /* In one place, just touching or nearly so, and well apart. */
                    shape_move(&s[1], at == 2 ? 10 * sizes[size] : 0, 0, at == 1 ? 2 * sizes[size] : 0);
                    ccd_t ccd = shape_query();
                    ccd.epa_tolerance = ccd.mpr_tolerance = (ccd_real_t)(1e-4 * sizes[size]);
                    int code = ask(entry, &s[0], &s[1], &ccd, 10 * sizes[size], "a degenerate pair");
                    if (at == 2 && entry->number != CALL_PLANAR)
                        CHECK(code == entry->miss, "%s: shapes %d and %d apart, size %g: %d", entry->name, i, k, sizes[size], code);
                    if (at == 0 && (i >= 7 || k >= 7) && entry->number != CALL_PLANAR)
                        CHECK(code == entry->hit, "%s: a solid in %d and %d in one place, size %g: %d", entry->name, i, k,
                              sizes[size], code);
                }
    for (int i = 0; i < PLAIN; i++) {
        shape_t s = plain[i];
        ccd_t ccd = shape_query();
        ask(entry, &s, &s, &ccd, 10, "an object against itself");
    }
}

/* Nothing is read of ccd_t but what the call needs: the rest may be anything. */
static void other_fields(const call_t *entry)
{
    for (int round = 0; round < 300 * share / 100; round++) {
        const int overlapping = round % 2, wanted = overlapping ? entry->hit : entry->miss;
        shape_t a, b;
        outputs_t out, other;
        ccd_t ccd, garbage;
        random_pair(entry, overlapping, &a, &b, &ccd);
        memset(&garbage, round % 4 < 2 ? 0xff : 0x3c, sizeof garbage);
        garbage.support1 = ccd.support1;
        garbage.support2 = ccd.support2;
        garbage.max_iterations = ccd.max_iterations;
        if (!(entry->traits & FROM_CENTERS))
            garbage.first_dir = ccd.first_dir;
        if (!(entry->traits & FROM_FIRST_DIR)) {
            garbage.center1 = ccd.center1;
            garbage.center2 = ccd.center2;
        }
        if (entry->traits & FROM_FIRST_DIR || entry->number == CALL_PROVEN)
            garbage.epa_tolerance = ccd.epa_tolerance;
        else if (entry->number == CALL_DISTANCE)
            garbage.dist_tolerance = ccd.dist_tolerance;
        else
            garbage.mpr_tolerance = ccd.mpr_tolerance;
        memset(&out, 0x5a, sizeof out);
        other = out;
        CHECK(run(entry, &a, &b, &ccd, &out) == wanted, "%s", entry->name);
        CHECK(run(entry, &a, &b, &garbage, &other) == wanted, "%s with garbage", entry->name);
        CHECK(same_bits(&out, &other, sizeof out), "%s reads what it should not", entry->name);
    }
}

/* Each output of libccd's calls may be NULL, and the others are the same without it; ccdGJKSeparate's
 * is depth times direction of ccdGJKPenetration. */
static void null_outputs(void)
{
    for (int round = 0; round < 2 * share; round++) {
        static const int numbers[] = {CALL_MPR, CALL_GJK};
        const int expected = round % 2 - 1;
        ccd_real_t depth[2];
        ccd_vec3_t dir[2], pos[2], sep;
        call_args_t rest = {.depth = &depth[0], .dir = &dir[0], .pos = &pos[0]};
        shape_t a, b;
        ccd_t ccd;
        random_pair(&call_table[CALL_GJK], round % 2, &a, &b, &ccd);
        ccd.center1 = ccd.center2 = shape_center;
        for (int i = 0; i < 2; i++)
            for (int skip = 0; skip < 8; skip++) {
                const call_args_t some = {.depth = skip & 1 ? NULL : &depth[1], .dir = skip & 2 ? NULL : &dir[1],
                                          .pos = skip & 4 ? NULL : &pos[1]};
                memset(depth, 0x5a, sizeof depth);
                memset(dir, 0x5a, sizeof dir);
                memset(pos, 0x5a, sizeof pos);
                CHECK(call_library(numbers[i], &a, &b, &ccd, &rest) == expected, "all outputs");
                CHECK(call_library(numbers[i], &a, &b, &ccd, &some) == expected, "NULL outputs");
                CHECK((skip & 1) || same_bits(&depth[0], &depth[1], sizeof depth[0]), "depth");
                CHECK((skip & 2) || same_bits(&dir[0], &dir[1], sizeof dir[0]), "dir");
                CHECK((skip & 4) || same_bits(&pos[0], &pos[1], sizeof pos[0]), "pos");
            }
        CHECK(ccdGJKSeparate(&a, &b, &ccd, NULL) == expected && ccdGJKSeparate(&a, &b, &ccd, &sep) == expected, "sep");
        for (int i = 0; i < 3 && expected == 0; i++)
            CHECK(fabs((double)(sep.v[i] - depth[0] * dir[0].v[i])) <= 4 * (double)CCD_EPS * (double)depth[0], "sep = depth dir");
    }
}

int main(int argc, char **argv)
{
    share = argc > 1 ? atoi(argv[1]) : share;
    for (int i = 0; i < PAIR_CALL_COUNT; i++) {
        other_fields(&call_table[i]);
        iterations(&call_table[i]);
        degenerate(&call_table[i]);
    }
    null_outputs();
    return checks_end();
}
