/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks the calls of the callbacks: support1 first, then support2 with exactly the opposite direction, except
 * for a contact position, for which the objects are evaluated separately; unit directions, even where first_dir
 * or the centers are degenerate; the caller's object pointers and thread; centers in MPR alone, first_dir in GJK
 * alone. */

#define _POSIX_C_SOURCE 200809L
#include "every_call.h"
#include <math.h>
#include <pthread.h>

static struct {
    const void *obj1, *obj2;
    pthread_t thread;
    int expect_second;
    int separately; /* the objects may be evaluated separately */
    ccd_vec3_t dir;
    unsigned long firsts, pairs, centers, first_dirs;
    ccd_vec3_t first;
} seen;

static void check_direction(const ccd_vec3_t *dir)
{
    double l2 = (double)dir->v[0] * (double)dir->v[0] + (double)dir->v[1] * (double)dir->v[1]
                + (double)dir->v[2] * (double)dir->v[2];
    CHECK(fabs(l2 - 1) <= 8 * (double)CCD_EPS, "direction %g %g %g, squared length 1 %+g", (double)dir->v[0],
          (double)dir->v[1], (double)dir->v[2], l2 - 1);
    CHECK(pthread_equal(pthread_self(), seen.thread), "the caller's thread");
}

static void support1(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    CHECK(obj == seen.obj1, "obj1 passed through");
    CHECK(seen.separately || !seen.expect_second, "support1 after support2");
    check_direction(dir);
    seen.expect_second = !seen.separately;
    seen.firsts++;
    seen.dir = *dir;
    shape_support(obj, dir, out);
}

static void support2(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    CHECK(obj == seen.obj2, "obj2 passed through");
    CHECK(seen.separately || seen.expect_second, "support2 after support1");
    check_direction(dir);
    for (int i = 0; i < 3 && !seen.separately; i++)
        CHECK(dir->v[i] == -seen.dir.v[i], "the opposite direction");
    seen.expect_second = 0;
    seen.pairs++;
    shape_support(obj, dir, out);
}

static void center1(const void *obj, ccd_vec3_t *out)
{
    CHECK(obj == seen.obj1, "obj1 passed through");
    seen.centers++;
    shape_center(obj, out);
}

static void center2(const void *obj, ccd_vec3_t *out)
{
    CHECK(obj == seen.obj2, "obj2 passed through");
    seen.centers++;
    shape_center(obj, out);
}

static void first_dir(const void *obj1, const void *obj2, ccd_vec3_t *dir)
{
    CHECK(obj1 == seen.obj1 && obj2 == seen.obj2, "objects passed through");
    seen.first_dirs++;
    *dir = seen.first;
}

/* Unit ball, for unit directions alone. */
static void unit_ball(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    (void)obj;
    *out = *dir;
}

/* Runs a call on a random pair with the callbacks above. Every fifth pair has equal centers: there is no origin ray.
 * Every seventh first direction is zero or NaN. */
static void check_callbacks(const call_t *call, int round)
{
    static const double length[] = {1, 1e-300, 1e300, 1e-30, 30};
    const unsigned want = round / 2 % 2 ? CCD_WANT_ALL : call->number == CALL_DISTANCE ? 0 : CCD_WANT_POINTS;
    const int equal_centers = round % 5 == 0, hit = equal_centers || round % 2;
    shape_t a, b;
    ccd_t ccd;
    results_t out;
    random_pair(call, round % 2, &a, &b, &ccd);
    if (equal_centers) {
        memcpy(b.pos, a.pos, sizeof b.pos);
        memset(b.centre, 0, sizeof b.centre);
        memset(a.centre, 0, sizeof a.centre);
    }
    memset(&seen, 0, sizeof seen);
    seen.obj1 = &a;
    seen.obj2 = &b;
    seen.separately = (call->traits & ONE_BY_ONE) != 0 || want == CCD_WANT_ALL;
    seen.thread = pthread_self();
    for (int k = 0; k < 3; k++)
        seen.first.v[k] = (ccd_real_t)(length[round % 5] * uniform(-1, 1));
    if (round % 7 == 0)
        ccdVec3Set(&seen.first, 0, 0, round % 14 == 0 ? 0 : (ccd_real_t)NAN);
    ccd.support1 = support1;
    ccd.support2 = support2;
    ccd.center1 = ccd.center1 ? center1 : NULL;
    ccd.center2 = ccd.center2 ? center2 : NULL;
    ccd.first_dir = ccd.first_dir ? first_dir : NULL;
    const int code = run_wanting(want, call, &a, &b, &ccd, &out);
    CHECK(is_right(call, code, &out, hit), "%s returned %d", call->name, code);
    /* Equal centers prove an overlap without a support point. */
    CHECK((seen.pairs > 0 || equal_centers) && !seen.expect_second, "%s: both support functions", call->name);
    CHECK(b.calls == seen.pairs && a.calls == seen.firsts && (seen.separately || a.calls == b.calls),
          "callbacks may write to their objects");
    CHECK(seen.first_dirs > 0 || !(call->traits & FROM_FIRST_DIR), "%s calls first_dir", call->name);
    CHECK(seen.centers > 0 || !(call->traits & FROM_CENTERS), "%s calls the centers", call->name);
}

/* Checks that __ccdSupport passes its direction on unchanged, also where the direction is in the output. */
static void check_support(void)
{
    shape_t box = shape_box(1, 2, 3);
    support_t s, aliased;
    const ccd_vec3_t dir = {{2, -4, 6}};
    ccd_t ccd = shape_query();
    ccd.support2 = unit_ball;
    __ccdSupport(&box, NULL, &dir, &ccd, &s);
    CHECK(s.v1.v[0] == 1 && s.v1.v[1] == -2 && s.v1.v[2] == 3, "v1");
    for (int i = 0; i < 3; i++) {
        CHECK(s.v2.v[i] == -dir.v[i], "the direction is unchanged");
        CHECK(s.v.v[i] == s.v1.v[i] - s.v2.v[i], "v = v1 - v2");
    }
    ccd_vec3_t *const fields[] = {&aliased.v, &aliased.v1, &aliased.v2};
    for (int i = 0; i < 3; i++) {
        *fields[i] = dir;
        __ccdSupport(&box, NULL, fields[i], &ccd, &aliased);
        CHECK(same_bits(&s, &aliased, sizeof s), "the direction in the output");
    }
}

int main(void)
{
    ccd_vec3_t dir;
    for (const call_t *call = call_table; call < call_table + PAIR_CALL_COUNT; call++)
        for (int round = 0; round < 400; round++)
            check_callbacks(call, round);
    check_support();
    ccdFirstDirDefault(NULL, NULL, &dir);
    CHECK(dir.v[0] == 1 && dir.v[1] == 0 && dir.v[2] == 0, "first direction");
    return checks_end();
}
