/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Counts the blocks that queries allocate. MPR's and intersection queries allocate nothing; other queries free
 * all blocks, and without memory libccd's return -2 and leave their outputs unchanged. (Those of polytopes: polytope.c.) */

#include "every_call.h"
#include "heap.h"

static void check_queries(void)
{
    for (int i = 0; i < PAIR_CALL_COUNT; i++) {
        const call_t *entry = &call_table[i];
        int allocating = 0; /* queries */
        for (int round = 0; round < 100; round++) {
            const int overlapping = round % 4 != 0;
            shape_t a, b;
            results_t out;
            ccd_t ccd;
            random_pair(entry, overlapping, &a, &b, &ccd);
            ccd.epa_tolerance = ccd.mpr_tolerance = (ccd_real_t)1e-5;
            start_counting(0);
            int code = run(entry, &a, &b, &ccd, &out);
            CHECK(is_right(entry, code, &out, overlapping), "%s returned %d", entry->name, code);
            CHECK(live == 0, "%s left %d blocks behind", entry->name, live);
            /* A distance allocates only for an overlap. */
            if (!(entry->traits & MAY_ALLOCATE) || (!overlapping && entry->number == CALL_DISTANCE))
                CHECK(allocations == 0, "%s allocated %lu blocks", entry->name, allocations);
            /* The size that warm.h states, of what an exception leaks. */
            if (allocations > 0)
                CHECK(most == 1 && last.size / 1000 == 98, "%s allocated %d blocks at once, the last of %zu bytes", entry->name, most, last.size);
            allocating += allocations > 0;
            const unsigned long last_fail = allocations < 40 ? allocations : 40;
            for (unsigned long fail = 1; fail <= last_fail; fail++) {
                start_counting(fail);
                code = run(entry, &a, &b, &ccd, &out);
                CHECK(live == 0, "%s without memory left %d blocks behind", entry->name, live);
                if (!(entry->traits & EXTENSION)) {
                    CHECK(code == -2, "%s without block %lu returned %d", entry->name, fail, code);
                    CHECK(are_clear(&out), "%s without memory wrote outputs", entry->name);
                }
            }
            counting = 0;
        }
        /* Else nothing was checked without memory. */
        CHECK(!(entry->traits & MAY_ALLOCATE) || allocating > 0, "no query of %s allocated", entry->name);
    }
}

int main(void)
{
    setvbuf(stdout, NULL, _IONBF, 0); /* no block of stdout's is counted */
    check_queries();
    return checks_end();
}
