/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* README.md's box slides on its slab, face on face: prints the callbacks of the third frame, with
 * the position and without it. include/README.md names both. */

#include "harness/shapes.h"

#include <ccd/warm.h>
#include <stdio.h>

static unsigned long third_frame(unsigned want)
{
    shape_t slab = shape_box(1, 1, 0.5), box = shape_box(0.5, 0.5, 0.5);
    ccd_warm_t warm = {0};
    ccd_penetration_t hit;
    ccd_t ccd;
    shape_query(&ccd);
    ccd.mpr_tolerance = (ccd_real_t)1e-6;
    for (int frame = 0; frame < 3; frame++) {
        shape_move(&box, 0.3 + 0.01 * frame, 0.2, 0.99);
        slab.calls = box.calls = 0;
        if (ccdPenetration(&slab, &box, &ccd, &warm, want, &hit) != CCD_HIT)
            return 0;
    }
    return slab.calls + box.calls;
}

int main(void)
{
    printf("%lu callbacks a query with it and %lu without\n", third_frame(CCD_WANT_POS), third_frame(0));
    return 0;
}
