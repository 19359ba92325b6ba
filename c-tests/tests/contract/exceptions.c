/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Leaves every query from a callback: by longjmp; compiled as C++, by an exception, which reaches the
 * caller unchanged and runs the destructors. Checks that the next query has the same result as before. */

#include "every_call.h"

static int calls_left, destroyed;

#ifdef __cplusplus
#include <stdexcept>
#include <string>

struct Destroyed {
    ~Destroyed() { destroyed++; }
};

static void leave(void)
{
    Destroyed in_callback;
    throw std::runtime_error("out of here");
}

/* Runs a query and returns whether a callback left it. */
static int leaves(const call_t *entry, const shape_t *a, const shape_t *b, const ccd_t *ccd, results_t *out)
{
    destroyed = 0;
    try {
        Destroyed in_caller;
        run(entry, a, b, ccd, out);
        return 0;
    } catch (const std::runtime_error &e) {
        CHECK(e.what() == std::string("out of here"), "%s: the exception thrown", entry->name);
        CHECK(destroyed == 2, "%s: destructors run", entry->name);
        return 1;
    }
}
#else
#include <setjmp.h>

static jmp_buf caller;

static void leave(void)
{
    destroyed = 0;
    longjmp(caller, 7);
}

static int leaves(const call_t *entry, const shape_t *a, const shape_t *b, const ccd_t *ccd, results_t *out)
{
    if (setjmp(caller) != 0)
        return 1;
    run(entry, a, b, ccd, out);
    return 0;
}
#endif

/* Leaves the query at the last of `calls_left` callbacks. */
static void count_down(void)
{
    if (--calls_left == 0)
        leave();
}

static void leaving_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    count_down();
    shape_support(obj, dir, out);
}

static void leaving_center(const void *obj, ccd_vec3_t *out)
{
    count_down();
    shape_center(obj, out);
}

static void leaving_first_dir(const void *obj1, const void *obj2, ccd_vec3_t *dir)
{
    count_down();
    ccdFirstDirDefault(obj1, obj2, dir);
}

static void test(const call_t *entry, int rounds)
{
    for (int round = 0; round < rounds; round++) {
        shape_t a, b;
        ccd_t ccd;
        results_t expected, out;
        int expected_code, last;
        random_pair(entry, round % 2, &a, &b, &ccd);
        ccd.support1 = ccd.support2 = leaving_support;
        if (ccd.center1 != NULL)
            ccd.center1 = ccd.center2 = leaving_center;
        if (ccd.first_dir != NULL)
            ccd.first_dir = leaving_first_dir;
        calls_left = 0;
        expected_code = run(entry, &a, &b, &ccd, &expected);
        for (last = 1; last <= 50; last++) {
            calls_left = last;
            if (!leaves(entry, &a, &b, &ccd, &out))
                break;
            calls_left = 0;
            int code = run(entry, &a, &b, &ccd, &out);
            CHECK(code == expected_code && same_results(&out, &expected), "%s after a query was left", entry->name);
        }
        CHECK(last > 1, "%s runs callbacks", entry->name);
    }
}

int main(int argc, char **argv)
{
    const int rounds = argc > 1 ? atoi(argv[1]) : 20;
    for (int i = 0; i < PAIR_CALL_COUNT; i++)
        test(&call_table[i], rounds);
    test(&support_entry, rounds);
    return checks_end();
}
