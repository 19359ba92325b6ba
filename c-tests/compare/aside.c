/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A kept case tells a move that separates from one of the same length that does not. Two unit
 * cubes overlap by 0.1 along x; the known points are their corners, in both forms of a case. */

#include "compare/case.h"

static const double corners[] = { 0, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 1, 0, 0, 1, 0, 1, 1, 1, 0, 1, 1, 1 };

/* Whether the case's cubes overlap after a move by `depth` along the direction of (x, y, z). */
static int overlap(int columns, double depth, double x, double y, double z)
{
    double numbers[2][8 * 6];
    case_t c;
    ccd_vec3_t dir;
    int which, i, k;
    memset(&c, 0, sizeof c);
    memset(numbers, 0, sizeof numbers);
    for (which = 0; which < 2; which++) {
        c.numbers[which] = numbers[which];
        c.rows[which] = 8;
        for (i = 0; i < 8; i++)
            for (k = 0; k < 3; k++)
                numbers[which][columns * (i + 1) - 3 + k] = corners[3 * i + k] + (which && k == 0 ? 0.9 : 0);
    }
    c.columns = columns;
    c.truth.tolerance = 1e-6;
    ccdVec3Set(&dir, (ccd_real_t)x, (ccd_real_t)y, (ccd_real_t)z);
    ccdVec3Normalize(&dir);
    return case_moved_overlap(&c, ccdMPRIntersect, depth, &dir);
}

int main(void)
{
    int columns, wrong = 0;
    for (columns = 3; columns <= 6; columns += 3) {
        wrong += overlap(columns, 0.1, 1, 0, 0) != 0;     /* right */
        wrong += overlap(columns, 0.1, -1, 0, 0) != 1;    /* the other way */
        wrong += overlap(columns, 0.1, 0, 1, 0) != 1;     /* across */
        wrong += overlap(columns, 0.1, 1, 0.1, 0) != 1;   /* a little aside: 0.5 mm are left */
        wrong += overlap(columns, 0.1, 1, 1e-4, 0) != 0;  /* 0.5 nm are */
        wrong += overlap(columns, 0.101, 1, 0.1, 0) != 0; /* farther: apart along x, by no plane across the move */
    }
    printf("%d of 12 wrong\n", wrong);
    return wrong != 0;
}
