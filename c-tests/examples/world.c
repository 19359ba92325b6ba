/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A small world: a box, a capsule and a hull fall on a table. One warm state for each pair. */

#include <ccd/warm.h>
#include <math.h>
#include <stdio.h>
enum { BODIES = 4, FRAMES = 60 };

typedef struct { /* points, swept along x, y, z by half: the core; with a ball around it */
    ccd_vec3_t pos, point[5];
    ccd_real_t half[3], radius, speed;
    int points;
} body_t;

static void support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const body_t *b = obj;
    int best = 0;
    for (int i = 1; i < b->points; i++)
        if (ccdVec3Dot(&b->point[i], dir) > ccdVec3Dot(&b->point[best], dir))
            best = i;
    for (int i = 0; i < 3; i++)
        out->v[i] = b->pos.v[i] + b->point[best].v[i] + (dir->v[i] < 0 ? -b->half[i] : b->half[i]);
}

int main(void)
{
    static body_t body[BODIES] = {{ .pos = {{0, 0, -1}}, .half = {3, 3, 1} }, /* the table */
        { .pos = {{-1, 0, 2}}, .half = {CCD_REAL(0.5), CCD_REAL(0.5), CCD_REAL(0.25)} },
        { .pos = {{1, 0, 2}}, .half = {0, CCD_REAL(0.5), 0}, .radius = CCD_REAL(0.25) },
        { .pos = {{1, 2, 3}}, .points = 5, .point = {{{1, 0, 0}}, {{0, 1, 0}}, {{-1, 0, 0}}, {{0, -1, 0}}, {{0, 0, 1}}} }};
    static ccd_warm_t warm[BODIES][BODIES]; /* all zeros: cold */
    static ccd_manifold_cache_t cache[BODIES][BODIES]; /* of the contacts */
    ccd_contact_t contact[4];
    ccd_distance_t d;
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    for (int frame = 0; frame < FRAMES; frame++) {
        int contacts = 0;
        double closest = INFINITY;
        for (int i = 1; i < BODIES; i++) /* gravity */
            body[i].pos.v[2] += (body[i].speed -= CCD_REAL(9.81) / 60) / 60;
        for (int i = 0; i < BODIES; i++)
            for (int j = i + 1; j < BODIES; j++) {
                body_t *a = &body[i], *b = &body[j];
                if (ccdSignedDistance(a, b, &ccd, a->radius, b->radius, INFINITY, &warm[i][j], CCD_WANT_ALL, &d) != CCD_HIT) {
                    closest = fmin(closest, (double)d.distance); /* between d.point1 and d.point2 */
                    continue;
                }
                contacts += ccdContacts(a, b, &ccd, &d.normal, CCD_REAL(1e-3), &cache[i][j], contact, 4); /* of the cores */
                for (int k = 0; k < 3; k++) /* in place of a contact solver */
                    b->pos.v[k] -= d.distance * d.normal.v[k];
                b->speed = 0;
            }
        if (frame % 10 == 9)
            printf("frame %d: %d contacts, other pairs are %.2f m apart\n", frame, contacts, closest);
    }
}
