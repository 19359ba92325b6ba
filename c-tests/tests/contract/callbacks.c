/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Tests what callbacks see: support1 first, support2 next with exactly the opposite direction, but where a
 * position is read, for which the objects are asked on their own once depth and direction are known;
 * directions unit and finite, the object pointers as given, the thread that called; the
 * centers in MPR alone, first_dir in GJK alone. Directions are unit even when first_dir or
 * the centers are not well given. */

#define _POSIX_C_SOURCE 200809L
#include "every_call.h"
#include <math.h>
#include <pthread.h>

static struct {
    const void *obj1, *obj2;
    pthread_t thread;
    int expect_second;
    int apart; /* each object is asked on its own */
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
    CHECK(seen.apart || !seen.expect_second, "support1 after support2");
    check_direction(dir);
    seen.expect_second = !seen.apart;
    seen.firsts++;
    seen.dir = *dir;
    shape_support(obj, dir, out);
}

static void support2(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    CHECK(obj == seen.obj2, "obj2 passed through");
    CHECK(seen.apart || seen.expect_second, "support2 after support1");
    check_direction(dir);
    for (int i = 0; i < 3 && !seen.apart; i++)
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

/* A unit ball that trusts its direction to be unit. */
static void trusting_ball(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    (void)obj;
    *out = *dir;
}

int main(void)
{
    for (int i = 0; i < PAIR_CALL_COUNT; i++) {
        for (int round = 0; round < 400; round++) {
            const double length[] = {1, 1e-300, 1e300, 1e-30, 30};
            shape_t a, b;
            ccd_t ccd;
            outputs_t out;
            int code, hit = round % 2;
            /* Each way as often hit or missed, and with every length. */
            const int want = round / 2 % 2 ? CCD_WANT_ALL : call_table[i].number == CALL_DISTANCE ? 0 : CCD_WANT_POINTS;
            random_pair(&call_table[i], hit, &a, &b, &ccd);
            if (round % 5 == 0) {
                /* Centers in one place leave no first ray to start from. */
                memcpy(b.pos, a.pos, sizeof b.pos);
                memset(b.centre, 0, sizeof b.centre);
                memset(a.centre, 0, sizeof a.centre);
                hit = 1;
            }
            memset(&seen, 0, sizeof seen);
            seen.obj1 = &a;
            seen.apart = (call_table[i].traits & ONE_BY_ONE) != 0 || want == CCD_WANT_ALL;
            seen.obj2 = &b;
            seen.thread = pthread_self();
            for (int k = 0; k < 3; k++)
                seen.first.v[k] = (ccd_real_t)(length[round % 5] * uniform(-1, 1));
            if (round % 7 == 0)
                ccdVec3Set(&seen.first, 0, 0, round % 14 == 0 ? 0 : (ccd_real_t)NAN);
            ccd.support1 = support1;
            ccd.support2 = support2;
            if (ccd.center1 != NULL) {
                ccd.center1 = center1;
                ccd.center2 = center2;
            }
            if (ccd.first_dir != NULL)
                ccd.first_dir = first_dir;
            code = run_wanting(want, &call_table[i], &a, &b, &ccd, &out);
            CHECK(code == (hit ? call_table[i].hit : call_table[i].miss), "%s returned %d", call_table[i].name, code);
            /* Equal centers alone prove an overlap. */
            CHECK((seen.pairs > 0 || round % 5 == 0) && !seen.expect_second, "%s: both supports every time",
                  call_table[i].name);
            CHECK(b.calls == seen.pairs && a.calls == seen.firsts && (seen.apart || a.calls == b.calls), "callbacks may write through their objects");
            if (call_table[i].traits & FROM_FIRST_DIR)
                CHECK(seen.first_dirs > 0, "%s asks first_dir", call_table[i].name);
            if (call_table[i].traits & FROM_CENTERS)
                CHECK(seen.centers > 0, "%s asks the centers", call_table[i].name);
        }
    }
    {
        /* __ccdSupport hands its direction on as it is, which may lie in the output. */
        shape_t a = shape_box(1, 2, 3);
        support_t s, aliased;
        ccd_vec3_t dir = {{2, -4, 6}};
        ccd_t ccd = shape_query();
        ccd.support2 = trusting_ball;
        __ccdSupport(&a, NULL, &dir, &ccd, &s);
        CHECK(s.v1.v[0] == 1 && s.v1.v[1] == -2 && s.v1.v[2] == 3, "box");
        for (int i = 0; i < 3; i++) {
            CHECK(s.v2.v[i] == -dir.v[i], "the direction as given");
            CHECK(s.v.v[i] == s.v1.v[i] - s.v2.v[i], "v = v1 - v2");
        }
        for (int round = 0; round < 3; round++) {
            ccd_vec3_t *place = round == 0 ? &aliased.v : round == 1 ? &aliased.v1 : &aliased.v2;
            *place = dir;
            __ccdSupport(&a, NULL, place, &ccd, &aliased);
            CHECK(same_bits(&s, &aliased, sizeof s), "direction inside of the output");
        }
        ccdFirstDirDefault(NULL, NULL, &dir);
        CHECK(dir.v[0] == 1 && dir.v[1] == 0 && dir.v[2] == 0, "first direction");
    }
    return checks_end();
}
