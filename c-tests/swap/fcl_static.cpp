/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* FCL's collide and signed distance over random pairs of every convex kind.
 * Writes a line for every query; the driver compares those of two libraries.
 *
 *   collide A B number size lower upper hit depth |normal|
 *   distance A B number size lower upper outcome value
 *
 * and at the end
 *
 *   timed queries COUNT nanoseconds SUM     processor time of the distances
 *
 * hit 0 or 1; outcome 0. Both 2 when FCL threw, 3 when one of the assertions that
 * Debian's FCL is built with failed.
 *
 * usage: fcl_static SEED POSES   (POSES placed pairs of each two kinds) */

#include "swap/fcl_shapes.h"
#include "compare/hooks.h"
#include "harness/identity.h"

#include <setjmp.h>
#include <signal.h>
#include <time.h>

/* A failed assertion comes back here; what FCL held is lost. */
static sigjmp_buf after_abort;
static void on_abort(int)
{
    siglongjmp(after_abort, 1);
}

enum { ANSWERED, THREW = 2, ASSERTED = 3 };

/* Runs one query of FCL's. */
template <typename Query> static int outcome_of(Query query)
{
    if (sigsetjmp(after_abort, 1))
        return ASSERTED;
    try {
        query();
    } catch (const std::exception &) {
        return THREW;
    }
    return ANSWERED;
}

static void put_known(const char *what, const body_t &a, const body_t &b, long number, const known_t &known)
{
    printf("%s %s %s %ld %.17g %.17g %.17g", what, KIND_NAME[a.kind], KIND_NAME[b.kind], number, known.size, known.lower, known.upper);
}

static void collide(const body_t &a, const body_t &b, const fcl::CollisionObjectd &oa, const fcl::CollisionObjectd &ob, long number,
                    const known_t &known)
{
    fcl::CollisionRequestd request(1, true);
    fcl::CollisionResultd result;
    const unsigned long before = compare_queries();
    request.gjk_solver_type = fcl::GST_LIBCCD;
    const int outcome = outcome_of([&] { fcl::collide(&oa, &ob, request, result); });
    if (compare_queries() == before)
        return; /* FCL has a closed form for these two, or its boxes excluded them */
    put_known("collide", a, b, number, known);
    if (outcome != ANSWERED)
        printf(" %d 0 0\n", outcome);
    else if (result.numContacts() == 0)
        printf(" 0 0 0\n");
    else
        printf(" 1 %.17g %.17g\n", result.getContact(0).penetration_depth, result.getContact(0).normal.norm());
}

/* The distances that FCL's own EPA computed on libccd's polytope functions. */
static struct {
    long queries;
    double nanoseconds;
} timed;

static double now()
{
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static void distance(const body_t &a, const body_t &b, const fcl::CollisionObjectd &oa, const fcl::CollisionObjectd &ob, long number,
                     const known_t &known)
{
    fcl::DistanceRequestd request(true, true);
    fcl::DistanceResultd result;
    const uint64_t before = compare_counts()->raw_supports;
    static double value;
    value = 0;
    request.gjk_solver_type = fcl::GST_LIBCCD;
    const double start = now();
    const int outcome = outcome_of([&] { value = fcl::distance(&oa, &ob, request, result); });
    const double end = now();
    if (compare_counts()->raw_supports == before)
        return;
    if (outcome == ANSWERED && value < 0) {
        timed.queries++;
        timed.nanoseconds += end - start;
    }
    put_known("distance", a, b, number, known);
    printf(" %d %.17g\n", outcome, value);
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: fcl_static SEED POSES\n");
        return 2;
    }
    const long poses = atol(argv[2]);
    long number = 0;
    signal(SIGABRT, on_abort);
    tell_library();
    uniform_seed(strtoull(argv[1], NULL, 10));
    for (int i = 0; i < KINDS; i++)
        for (int j = i; j < KINDS; j++)
            for (long k = 0; k < poses; k++) {
                if (i == KIND_TRIANGLE && j == KIND_TRIANGLE)
                    continue;
                static body_t a, b;
                known_t known;
                body_random(&a, i);
                body_random(&b, j);
                pose_overlapping(&a, &b, &known);
                fcl::CollisionObjectd oa(fcl_geometry(a), fcl_pose(a.shape)), ob(fcl_geometry(b), fcl_pose(b.shape));
                for (int d = -1; d < DEPTH_COUNT; d++) {
                    if (d >= 0) {
                        if (DEPTHS[d] * known.size >= known.upper)
                            continue;
                        pose_at_depth(&b, &known, DEPTHS[d] * known.size);
                        ob.setTransform(fcl_pose(b.shape));
                        ob.computeAABB();
                    }
                    collide(a, b, oa, ob, number, known);
                    if (i != KIND_TRIANGLE && j != KIND_TRIANGLE)
                        distance(a, b, oa, ob, number, known);
                    number++;
                }
            }
    printf("timed queries %ld nanoseconds %.0f\n", timed.queries, timed.nanoseconds);
    return 0;
}
