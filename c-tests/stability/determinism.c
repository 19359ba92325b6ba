/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The same question gives the same bits. Prints one digest of every answer of every
 * entry point over all categories of pairs, states carried along included, after it
 * has computed it several times: at once in threads, and once more alone. Who runs it
 * compares what runs and builds print.
 *
 *   determinism [pairs a category]
 *   determinism PAIRS list   a line for each pair: a digest of the question, which is what
 *                            the two objects tell the library, and one of the answers. The
 *                            C library's sine is not the same everywhere, so other
 *                            processors are compared where the question is the same. */

#define _POSIX_C_SOURCE 200809L

#include "categories.h"

#include <pthread.h>

enum { THREADS = 4 };

static int pairs;

#define FNV_START UINT64_C(0xcbf29ce484222325)

static void digest_bytes(uint64_t *digest, const void *memory, size_t size)
{
    const unsigned char *byte = (const unsigned char *)memory;
    size_t i;
    for (i = 0; i < size; i++) /* FNV-1a */
        *digest = (*digest ^ byte[i]) * UINT64_C(0x100000001b3);
}

/* As many bytes on every machine. */
static void digest_count(uint64_t *digest, uint64_t count)
{
    digest_bytes(digest, &count, sizeof count);
}

/* Everything that a call writes, padding excepted. */
static void digest_answers(uint64_t *digest, const pair_t *p, ccd_warm_t *warm)
{
    shape_t a = p->a, b = p->b;
    ccd_t ccd;
    ccd_vec3_t dir, pos;
    ccd_real_t depth;
    ccd_penetration_t out;
    ccd_distance_t distance;
    ccd_contact_t contact[4];
    int code, k;
    shape_query(&ccd);
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = (ccd_real_t)1e-6;
    for (k = 0; k < 13; k++) {
        ccd_vec3_t along;
        memset(&distance, 0, sizeof distance);
        memset(contact, 0, sizeof contact);
        memset(&out, 0, sizeof out);
        memset(&dir, 0, sizeof dir);
        memset(&pos, 0, sizeof pos);
        depth = 0;
        along.v[0] = (ccd_real_t).6;
        along.v[1] = 0;
        along.v[2] = (ccd_real_t).8;
        switch (k) {
        case 0: code = OURS(ccdMPRPenetration)(&a, &b, &ccd, &depth, &dir, &pos); break;
        case 1: code = OURS(ccdMPRPenetrationWarm)(&a, &b, &ccd, warm, &depth, &dir, &pos); break;
        case 2: code = OURS(ccdPenetrationLocal)(&a, &b, &ccd, warm, CCD_WANT_ALL, &out); break;
        case 3: code = OURS(ccdPenetrationAlong)(&a, &b, &ccd, &along, warm, CCD_WANT_ALL, &out); break;
        case 4: code = OURS(ccdMPRIntersectWarm)(&a, &b, &ccd, warm) + 10 * OURS(ccdGJKIntersect)(&a, &b, &ccd); break;
        case 5: code = OURS(ccdGJKPenetration)(&a, &b, &ccd, &depth, &dir, &pos); break;
        case 6: code = OURS(ccdPenetrationProven)(&a, &b, &ccd, warm, CCD_WANT_ALL, &out); break;
        case 7: code = OURS(ccdPenetrationIncremental)(&a, &b, &ccd, warm, CCD_WANT_ALL, &out); break;
        case 8: code = OURS(ccdSignedDistance)(&a, &b, &ccd, (ccd_real_t).01, 0, (ccd_real_t)INFINITY, warm, CCD_WANT_ALL, &distance); break;
        case 9: code = OURS(ccdContacts)(&a, &b, &ccd, &along, (ccd_real_t)1e-3, NULL, contact, 4); break;
        case 10: code = OURS(ccdPenetration)(&a, &b, &ccd, warm, CCD_WANT_ALL, &out); break;
        case 11: code = OURS(ccdIntersect)(&a, &b, &ccd, warm); break;
        default: code = OURS(ccdMPRIntersect)(&a, &b, &ccd); break;
        }
        digest_bytes(digest, &code, sizeof code);
        digest_bytes(digest, &depth, sizeof depth);
        digest_bytes(digest, &dir, sizeof dir);
        digest_bytes(digest, &pos, sizeof pos);
        digest_bytes(digest, &out.depth, sizeof out.depth);
        digest_bytes(digest, &out.depth_lower, sizeof out.depth_lower);
        digest_bytes(digest, &out.dir, sizeof out.dir);
        digest_bytes(digest, &out.normal, sizeof out.normal);
        digest_bytes(digest, &out.pos, sizeof out.pos);
        digest_bytes(digest, &out.point1, sizeof out.point1);
        digest_bytes(digest, &out.point2, sizeof out.point2);
        digest_bytes(digest, &distance.distance, sizeof distance.distance);
        digest_bytes(digest, &distance.distance_upper, sizeof distance.distance_upper);
        digest_bytes(digest, &distance.normal, sizeof distance.normal);
        digest_bytes(digest, &distance.point1, sizeof distance.point1);
        digest_bytes(digest, &distance.point2, sizeof distance.point2);
        digest_bytes(digest, contact, sizeof contact); /* no padding: all of it is ccd_real_t */
        digest_count(digest, distance.support_calls);
        digest_count(digest, distance.iterations);
        digest_count(digest, out.support_calls);
        digest_count(digest, out.iterations);
    }
    digest_count(digest, (uint64_t)a.calls);
}

/* The centres of both objects, and their support points all around. */
static void digest_question(uint64_t *digest, const pair_t *p)
{
    enum { DIRECTIONS = 200 };
    shape_t shape[2] = {p->a, p->b};
    ccd_t ccd;
    ccd_vec3_t dir, answer;
    int side, k;
    shape_query(&ccd);
    for (side = 0; side < 2; side++) {
        ccd.center1(&shape[side], &answer);
        digest_bytes(digest, &answer, sizeof answer);
        for (k = 0; k < DIRECTIONS; k++) {
            dir.v[0] = (ccd_real_t)(k % 7 - 3);
            dir.v[1] = (ccd_real_t)(k % 11 - 5);
            dir.v[2] = (ccd_real_t)(k % 13) - (ccd_real_t)6.5;
            ccdVec3Normalize(&dir);
            ccd.support1(&shape[side], &dir, &answer);
            digest_bytes(digest, &answer, sizeof answer);
        }
    }
}

static void list_all(void)
{
    pair_t *p = (pair_t *)malloc(sizeof *p);
    int category, i;
    for (category = 0; p && category < CATEGORY_COUNT; category++) {
        for (i = 0; i < pairs; i++) {
            uint64_t question = FNV_START, answers = FNV_START;
            ccd_warm_t warm;
            memset(&warm, 0, sizeof warm);
            category_pair(category, (uint64_t)i, SHAPE_TIE_SIGN, p);
            digest_question(&question, p);
            digest_answers(&answers, p, &warm);
            printf("pair %d-%d-%016llx %016llx\n", category, i, (unsigned long long)question,
                   (unsigned long long)answers);
        }
    }
    free(p);
}

static void *digest_all(void *result)
{
    uint64_t digest = FNV_START;
    pair_t *p = (pair_t *)malloc(sizeof *p);
    int category, i;
    for (category = 0; p && category < CATEGORY_COUNT; category++) {
        ccd_warm_t warm;
        memset(&warm, 0, sizeof warm);
        for (i = 0; i < pairs; i++) {
            category_pair(category, (uint64_t)i, SHAPE_TIE_SIGN, p);
            digest_answers(&digest, p, &warm);
        }
    }
    free(p);
    *(uint64_t *)result = digest;
    return NULL;
}

int main(int argc, char **argv)
{
    pthread_t threads[THREADS];
    uint64_t digests[THREADS + 1];
    int i, differ = 0;
    pairs = argc > 1 ? atoi(argv[1]) : 20;
    if (argc > 2) {
        list_all();
        return 0;
    }
    for (i = 0; i < THREADS; i++)
        if (pthread_create(&threads[i], NULL, digest_all, &digests[i]) != 0)
            return 2;
    for (i = 0; i < THREADS; i++)
        pthread_join(threads[i], NULL);
    digest_all(&digests[THREADS]);
    for (i = 0; i < THREADS; i++)
        differ += digests[i] != digests[THREADS];
    printf("%s: %016llx\n", OURS(ccdImplementation)(), (unsigned long long)digests[THREADS]);
    if (differ)
        printf("FAILED %d threads differ\n", differ);
    return differ > 0;
}
