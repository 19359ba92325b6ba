/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Queries two unit spheres 1.5 apart by libccd's calls and one of the extension. Prints the library's name. */

#include <ccd/ccd.h>
#include <ccd/quat.h>
#include <ccd/warm.h>
#include <stdio.h>

static void support(const void *object, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    ccdVec3Copy(out, dir);
    ccdVec3Normalize(out);
    ccdVec3Add(out, (const ccd_vec3_t *)object);
}

static void center(const void *object, ccd_vec3_t *out)
{
    ccdVec3Copy(out, (const ccd_vec3_t *)object);
}

int main(void)
{
    ccd_vec3_t a = {{CCD_ZERO, CCD_ZERO, CCD_ZERO}};
    ccd_vec3_t b = {{CCD_REAL(1.5), CCD_ZERO, CCD_ZERO}};
    ccd_real_t depth;
    ccd_vec3_t dir, pos;
    ccd_warm_t warm = {0};
    ccd_t ccd;

    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = center;
    ccd.max_iterations = 100;

    if (ccdGJKIntersect(&a, &b, &ccd) != 1)
        return 1;
    if (ccdMPRPenetration(&a, &b, &ccd, &depth, &dir, &pos) != 0)
        return 2;
    if (ccdMPRPenetrationWarm(&a, &b, &ccd, &warm, &depth, &dir, &pos) != 0)
        return 3;
    if (CCD_FABS(depth - CCD_REAL(0.5)) > CCD_REAL(1e-3) || ccdVec3X(&dir) < CCD_REAL(0.999))
        return 4;
    printf("%s\n", ccdImplementation());
    return 0;
}
