/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Queries two unit boxes that touch face on face 1,000 times: libccd returns a hit with a direction of zero. */

#include <ccd/ccd.h>

static void support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    for (int i = 0; i < 3; i++)
        out->v[i] = ((const ccd_vec3_t *)obj)->v[i] + (dir->v[i] < 0 ? CCD_REAL(-0.5) : CCD_REAL(0.5));
}

static void center(const void *obj, ccd_vec3_t *out) { *out = *(const ccd_vec3_t *)obj; }

int main(void)
{
    const ccd_vec3_t a = {{0, 0, 0}}, b = {{0, 0.25, 1}};
    ccd_real_t depth;
    ccd_vec3_t dir, pos;
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = center;
    for (int i = 0; i < 1000; i++)
        ccdMPRPenetration(&a, &b, &ccd, &depth, &dir, &pos);
    return 0;
}
