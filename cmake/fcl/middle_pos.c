/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Gives ccdMPRPenetration and ccdGJKPenetration another `pos`, the middle of the witness points, at no support point; all
 * else is as the library has it. For programs that read depth and direction alone, as planners on FCL, which ask for a
 * position all the same. A body that rests on a face slides, for the middle lies anywhere on that face.
 *
 * Preloaded, or linked before the library. */

#include <ccd/warm.h>

/* Writes the outputs of a query of the extension and returns libccd's code. */
static int answer(int code, const ccd_penetration_t *hit, ccd_real_t *depth, ccd_vec3_t *dir, ccd_vec3_t *pos)
{
    if (code < 0)
        return code == CCD_NO_MEMORY ? code : -1;
    if (depth)
        *depth = hit->depth;
    if (dir)
        *dir = hit->dir;
    if (pos)
        for (int i = 0; i < 3; i++)
            pos->v[i] = (hit->point1.v[i] + hit->point2.v[i]) / 2;
    return 0;
}

static ccd_real_t valid(ccd_real_t tolerance, ccd_real_t otherwise) { return tolerance >= 0 ? tolerance : otherwise; }

int ccdMPRPenetration(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_real_t *depth, ccd_vec3_t *dir, ccd_vec3_t *pos)
{
    ccd_penetration_t hit;
    ccd_t usual, settings;
    if (!ccd || !ccd->center1 || !ccd->center2)
        return -1;
    CCD_INIT(&usual);
    settings = *ccd;
    settings.mpr_tolerance = valid(ccd->mpr_tolerance, usual.mpr_tolerance);
    return answer(ccdPenetration(obj1, obj2, &settings, 0, CCD_WANT_POINTS, &hit), &hit, depth, dir, pos);
}

int ccdGJKPenetration(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_real_t *depth, ccd_vec3_t *dir, ccd_vec3_t *pos)
{
    ccd_penetration_t hit;
    ccd_t usual, settings;
    if (!ccd || !ccd->first_dir)
        return -1;
    CCD_INIT(&usual);
    settings = *ccd;
    settings.epa_tolerance = valid(ccd->epa_tolerance, usual.epa_tolerance);
    settings.center1 = settings.center2 = 0;
    return answer(ccdPenetrationProven(obj1, obj2, &settings, 0, CCD_WANT_POINTS, &hit), &hit, depth, dir, pos);
}
