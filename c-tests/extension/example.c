/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A box settles into a ball: one warm state for the pair, kept from frame to frame. */

#include <ccd/warm.h>
#include <stdio.h>

typedef struct { ccd_vec3_t pos; ccd_real_t half, radius; } body_t; /* a cube plus a ball */

static void support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const body_t *b = obj;
    for (int i = 0; i < 3; i++)
        out->v[i] = b->pos.v[i] + (dir->v[i] < 0 ? -b->half : b->half) + b->radius * dir->v[i];
}

static void center(const void *obj, ccd_vec3_t *out) { *out = ((const body_t *)obj)->pos; }

int main(void)
{
    body_t ball = { {{0, 0, 0}}, 0, 1 }, box = { {{CCD_REAL(0.1), CCD_REAL(0.2), CCD_REAL(1.515)}}, CCD_REAL(0.5), 0 };
    ccd_warm_t warm = { .words = {0} }; /* all zeros: cold; one for each pair of bodies */
    ccd_penetration_t hit;
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = center;
    ccd.mpr_tolerance = CCD_REAL(1e-5);

    for (int frame = 0; frame < 10; frame++) {
        int code = ccdPenetrationLocal(&ball, &box, &ccd, &warm, CCD_WANT_ALL, &hit);
        if (code == CCD_HIT)
            printf("frame %d: depth %.4f along (%.3f %.3f %.3f), %lu supports\n", frame, (double)hit.depth,
                   (double)hit.dir.v[0], (double)hit.dir.v[1], (double)hit.dir.v[2], hit.support_calls);
        else
            printf("frame %d: %s\n", frame, code == CCD_MISS ? "apart" : "no answer");
        box.pos.v[2] -= CCD_REAL(0.01); /* the box sinks */
    }
    return 0;
}
