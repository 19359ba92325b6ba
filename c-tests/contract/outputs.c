/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* What comes out: the return codes, outputs untouched on a miss, unit and finite on a hit,
 * NULL outputs, the same bits from the same query, and no tolerance read but the call's
 * own. */

#include "entries.h"
#include <math.h>

static void fill(void *memory, int byte, size_t size)
{
    memset(memory, byte, size);
}

static void check_hit(const call_t *entry, const outputs_t *out)
{
    int i;
    if (entry->traits & STORES_DEPTH)
        CHECK(out->depth >= 0 && out->depth <= CCD_REAL_MAX, "%s: depth %g", entry->name, (double)out->depth);
    if (entry->traits & STORES_DIR_POS) {
        CHECK(fabs((double)ccdVec3Len2(&out->dir) - 1) <= 8 * (double)CCD_EPS, "%s: dir not unit", entry->name);
        for (i = 0; i < 3; i++)
            CHECK(fabs((double)out->pos.v[i]) < 10, "%s: pos %g", entry->name, (double)out->pos.v[i]);
    }
}

int main(void)
{
    int i, round;
    for (i = 0; i < ENTRIES; i++) {
        const call_t *entry = &entries[i];
        for (round = 0; round < 300; round++) {
            const int overlapping = round % 2;
            shape_t a, b, a2, b2;
            outputs_t out, before, again;
            ccd_t ccd, garbage;
            int code;
            random_pair(entry, overlapping, &a, &b, &ccd);
            a2 = a;
            b2 = b;
            fill(&out, 0x5a, sizeof out);
            before = out;
            code = run(entry, &a, &b, &ccd, &out);
            CHECK(code == (overlapping ? entry->hit : entry->miss), "%s returned %d", entry->name, code);
            if (overlapping)
                check_hit(entry, &out);
            else
                CHECK(same_bits(&out, &before, sizeof out), "%s: outputs touched on a miss", entry->name);

            /* The same objects, the same bits. */
            again = before;
            code = run(entry, &a2, &b2, &ccd, &again);
            CHECK(code == (overlapping ? entry->hit : entry->miss), "%s returned %d", entry->name, code);
            CHECK(same_bits(&out, &again, sizeof out), "%s: other bits the second time", entry->name);
            CHECK(a.calls == a2.calls && b.calls == b2.calls, "%s: other supports the second time", entry->name);

            /* Nothing is read but what the call needs: the rest may be anything. */
            fill(&garbage, round % 4 < 2 ? 0xff : 0x3c, sizeof garbage);
            garbage.support1 = ccd.support1;
            garbage.support2 = ccd.support2;
            garbage.max_iterations = ccd.max_iterations;
            if (!(entry->traits & FROM_CENTERS))
                garbage.first_dir = ccd.first_dir;
            if (!(entry->traits & FROM_FIRST_DIR)) {
                garbage.center1 = ccd.center1;
                garbage.center2 = ccd.center2;
            }
            if (entry->traits & FROM_FIRST_DIR || entry->number == ASK_PROVEN)
                garbage.epa_tolerance = ccd.epa_tolerance;
            else if (entry->number == ASK_DISTANCE)
                garbage.dist_tolerance = ccd.dist_tolerance;
            else
                garbage.mpr_tolerance = ccd.mpr_tolerance;
            again = before;
            code = run(entry, &a2, &b2, &garbage, &again);
            CHECK(code == (overlapping ? entry->hit : entry->miss), "%s with garbage: %d", entry->name, code);
            CHECK(same_bits(&out, &again, sizeof out), "%s reads what it should not", entry->name);
        }
    }
    for (round = 0; round < 200; round++) {
        const int overlapping = round % 2;
        shape_t a, b;
        ccd_t ccd;
        int skip;
        ccd_real_t depth;
        ccd_vec3_t dir, pos;
        outputs_t out;
        /* Each output may be NULL, and the others are the same without it. */
        random_pair(&entries[2], overlapping, &a, &b, &ccd);
        ccd.center1 = ccd.center2 = shape_center;
        for (skip = 0; skip < 8; skip++) {
            int (*const call[2])(const void *, const void *, const ccd_t *, ccd_real_t *, ccd_vec3_t *,
                                 ccd_vec3_t *) = {ccdGJKPenetration, ccdMPRPenetration};
            for (i = 0; i < 2; i++) {
                const int expected = overlapping ? 0 : -1;
                int code;
                fill(&depth, 0x5a, sizeof depth);
                fill(&dir, 0x5a, sizeof dir);
                fill(&pos, 0x5a, sizeof pos);
                out.depth = depth;
                out.dir = dir;
                out.pos = pos;
                CHECK(call[i](&a, &b, &ccd, &out.depth, &out.dir, &out.pos) == expected, "all outputs");
                code = call[i](&a, &b, &ccd, skip & 1 ? NULL : &depth, skip & 2 ? NULL : &dir, skip & 4 ? NULL : &pos);
                CHECK(code == expected, "NULL outputs: %d", code);
                CHECK((skip & 1) || same_bits(&depth, &out.depth, sizeof depth), "depth");
                CHECK((skip & 2) || same_bits(&dir, &out.dir, sizeof dir), "dir");
                CHECK((skip & 4) || same_bits(&pos, &out.pos, sizeof pos), "pos");
            }
        }
        CHECK(ccdGJKSeparate(&a, &b, &ccd, NULL) == (overlapping ? 0 : -1), "NULL sep");
        /* Separate is Penetration with depth times dir. */
        fill(&dir, 0x5a, sizeof dir);
        CHECK(ccdGJKSeparate(&a, &b, &ccd, &dir) == ccdGJKPenetration(&a, &b, &ccd, &out.depth, &out.dir, &out.pos),
              "as GJKPenetration");
        if (overlapping)
            for (i = 0; i < 3; i++)
                CHECK(fabs((double)(dir.v[i] - out.depth * out.dir.v[i])) <= 4 * (double)CCD_EPS * (double)out.depth,
                      "sep = depth dir");
    }
    return checks_end();
}
