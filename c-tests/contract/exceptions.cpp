/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A C++ exception thrown in any callback of any entry point reaches the caller's catch as
 * it was thrown, runs the destructors on its way, and the next query answers as ever. */

#include "leave.h"
#include <stdexcept>
#include <string>

static int destroyed;

struct Watcher {
    ~Watcher() { destroyed++; }
};

static void leave()
{
    Watcher watcher;
    throw std::runtime_error("out of here");
}

static void test(const call_t *entry)
{
    int caught = 0;
    for (int round = 0; round < 20; round++) {
        shape_t a, b;
        ccd_t ccd;
        outputs_t expected, out;
        leaving_pair(entry, round % 2, &a, &b, &ccd);
        calls_left = 0;
        memset(&expected, 0, sizeof expected);
        const int expected_code = run(entry, &a, &b, &ccd, &expected);
        int last = 1;
        for (; last <= 50; last++) {
            destroyed = 0;
            calls_left = last;
            try {
                Watcher watcher;
                run(entry, &a, &b, &ccd, &out);
                break;
            } catch (const std::runtime_error &e) {
                CHECK(e.what() == std::string("out of here"), "%s: the exception thrown", entry->name);
                CHECK(destroyed == 2, "%s: destructors run", entry->name);
                caught++;
            }
            calls_left = 0;
            memset(&out, 0, sizeof out);
            const int code = run(entry, &a, &b, &ccd, &out);
            CHECK(code == expected_code && same_bits(&out, &expected, sizeof out), "%s after an exception", entry->name);
        }
        CHECK(last > 1, "%s runs callbacks", entry->name);
    }
    printf("%s: caught %d times\n", entry->name, caught);
}

int main()
{
    for_each_entry(test);
    return checks_end();
}
