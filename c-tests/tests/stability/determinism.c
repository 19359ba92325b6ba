/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The same query gives the same bits. Prints a line for each pair of all categories: a digest of
 * the objects, by their centres and support points, and one of the answers of every call, cold and
 * with the state that it left; runs and builds are compared by these lines. (The C library's sine
 * differs between systems, so processors are compared where the objects' digests are equal.)
 *
 *   determinism [pairs a category] */

#include "categories.h"
#include "tests/contract/every_call.h"

static void digest_bytes(uint64_t *digest, const void *memory, size_t size)
{
    const unsigned char *byte = (const unsigned char *)memory;
    for (size_t i = 0; i < size; i++) /* FNV-1a */
        *digest = (*digest ^ byte[i]) * UINT64_C(0x100000001b3);
}

/* Digests everything that the calls write, padding excepted. Those that take a state share one. */
static void digest_answers(uint64_t *digest, const pair_t *p, ccd_warm_t *warm)
{
    shape_t a = p->a, b = p->b;
    ccd_t ccd = shape_query();
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = (ccd_real_t)1e-6;
    for (const call_t *call = call_table; call < call_table + PAIR_CALL_COUNT; call++) {
        results_t r;
        memset(&r, 0, sizeof r);
        call_args_t args = valid_arguments(call, &r);
        args.warm = warm;
        args.margin1 = CCD_REAL(0.01);
        const int code = call_library(call->number, &a, &b, &ccd, &args);
        digest_bytes(digest, &code, sizeof code);
        digest_bytes(digest, &r.depth, sizeof r.depth);
        digest_bytes(digest, &r.dir, sizeof r.dir);
        digest_bytes(digest, &r.pos, sizeof r.pos);
        for (int i = 0; i < 4; i++)
            digest_bytes(digest, &r.contacts[i], offsetof(ccd_contact_t, id) + sizeof r.contacts[i].id);
        digest_bytes(digest, &r.distance, offsetof(ccd_distance_t, point2) + sizeof r.distance.point2);
        digest_bytes(digest, &r.penetration, offsetof(ccd_penetration_t, point2) + sizeof r.penetration.point2);
        /* as many bytes on every machine */
        const uint64_t counts[] = {r.distance.support_points, r.distance.iterations, r.penetration.support_points,
                                   r.penetration.iterations, a.calls};
        digest_bytes(digest, counts, sizeof counts);
    }
}

/* Digests the centres of both objects, and their support points all around. */
static void digest_objects(uint64_t *digest, const pair_t *p)
{
    enum { DIRECTIONS = 200 };
    shape_t shape[2] = {p->a, p->b};
    ccd_vec3_t dir, point;
    for (int side = 0; side < 2; side++) {
        shape_center(&shape[side], &point);
        digest_bytes(digest, &point, sizeof point);
        for (int k = 0; k < DIRECTIONS; k++) {
            ccdVec3Set(&dir, (ccd_real_t)(k % 7 - 3), (ccd_real_t)(k % 11 - 5), (ccd_real_t)(k % 13) - (ccd_real_t)6.5);
            ccdVec3Normalize(&dir);
            shape_support(&shape[side], &dir, &point);
            digest_bytes(digest, &point, sizeof point);
        }
    }
}

int main(int argc, char **argv)
{
    const int pairs = argc > 1 ? atoi(argv[1]) : 20;
    static pair_t p;
    for (int category = 0; category < CATEGORY_COUNT; category++)
        for (int i = 0; i < pairs; i++) {
            uint64_t objects = UINT64_C(0xcbf29ce484222325), answers = objects;
            ccd_warm_t warm;
            memset(&warm, 0, sizeof warm);
            category_pair(category, (uint64_t)i, SHAPE_TIE_SIGN, &p);
            digest_objects(&objects, &p);
            digest_answers(&answers, &p, &warm);
            digest_answers(&answers, &p, &warm);
            printf("pair %d-%d-%016llx %016llx\n", category, i, (unsigned long long)objects, (unsigned long long)answers);
        }
    return 0;
}
