/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Compiled for double and run on the float build: the call of that number ends the process. */

#include <ccd/ccd.h>
#include <stdio.h>
#include <stdlib.h>

static void support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    for (int i = 0; i < 3; i++)
        out->v[i] = (i == 0 ? *(const ccd_real_t *)obj : 0) + (dir->v[i] < 0 ? CCD_REAL(-0.5) : CCD_REAL(0.5));
}

static void center(const void *obj, ccd_vec3_t *out) { ccdVec3Set(out, *(const ccd_real_t *)obj, 0, 0); }

int main(int argc, char **argv)
{
    const ccd_real_t a = 0, b = CCD_REAL(0.75);
    ccd_real_t depth;
    ccd_vec3_t dir, pos;
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = center;
    switch (argc > 1 ? atoi(argv[1]) : 0) {
    case 0: ccdMPRIntersect(&a, &b, &ccd); break;
    case 1: ccdGJKIntersect(&a, &b, &ccd); break;
    case 2: ccdMPRPenetration(&a, &b, &ccd, &depth, &dir, &pos); break;
    case 3: ccdGJKPenetration(&a, &b, &ccd, &depth, &dir, &pos); break;
    case 4: ccdGJKSeparate(&a, &b, &ccd, &dir); break;
    }
    printf("returned\n");
    return 0;
}
