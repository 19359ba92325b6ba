/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* longjmp out of every callback of every entry point: the program goes on, and the next
 * query answers as ever. */

#include "leave.h"
#include <setjmp.h>

static jmp_buf home;

static void leave(void)
{
    longjmp(home, 7);
}

static void test(const call_t *entry)
{
    static int left;
    static int round;
    left = 0;
    for (round = 0; round < 20; round++) {
        static shape_t a, b;
        static ccd_t ccd;
        static outputs_t expected, out;
        static int expected_code, last, code;
        leaving_pair(entry, round % 2, &a, &b, &ccd);
        calls_left = 0;
        memset(&expected, 0, sizeof expected);
        expected_code = run(entry, &a, &b, &ccd, &expected);
        for (last = 1; last <= 50; last++) {
            calls_left = last;
            if (setjmp(home) == 0) {
                run(entry, &a, &b, &ccd, &out);
                break;
            }
            left++;
            calls_left = 0;
            memset(&out, 0, sizeof out);
            code = run(entry, &a, &b, &ccd, &out);
            CHECK(code == expected_code && same_bits(&out, &expected, sizeof out), "%s after a longjmp", entry->name);
        }
        CHECK(last > 1, "%s runs callbacks", entry->name);
    }
    printf("%s: left %d times\n", entry->name, left);
}

int main(void)
{
    for_each_entry(test);
    return checks_end();
}
