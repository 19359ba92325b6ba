/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* How a test names this library's functions.
 *
 * A program that holds system libccd beside this library links this one's archive
 * with every symbol renamed to rs_...: OURS(ccdMPRPenetration) is then
 * rs_ccdMPRPenetration, and the plain name is libccd's. A program that holds this
 * library alone (also every single-precision one: Debian's libccd is double) is
 * compiled with -DOURS_ALONE, and OURS(name) is the plain name. */

#ifndef TESTS_OURS_H
#define TESTS_OURS_H

#include <ccd/paper.h>
#include <ccd/warm.h>

#ifdef OURS_ALONE
#define OURS(name) name
#else
#define OURS(name) rs_##name
#endif

#ifdef __cplusplus
extern "C" {
#endif

int OURS(ccdGJKIntersect)(const void *obj1, const void *obj2, const ccd_t *ccd);
int OURS(ccdGJKSeparate)(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_vec3_t *sep);
int OURS(ccdGJKPenetration)(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_real_t *depth,
                            ccd_vec3_t *dir, ccd_vec3_t *pos);
int OURS(ccdMPRIntersect)(const void *obj1, const void *obj2, const ccd_t *ccd);
int OURS(ccdMPRPenetration)(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_real_t *depth,
                            ccd_vec3_t *dir, ccd_vec3_t *pos);
void OURS(ccdFirstDirDefault)(const void *obj1, const void *obj2, ccd_vec3_t *dir);
ccd_real_t OURS(ccdVec3PointSegmentDist2)(const ccd_vec3_t *p, const ccd_vec3_t *x0, const ccd_vec3_t *b,
                                          ccd_vec3_t *witness);
ccd_real_t OURS(ccdVec3PointTriDist2)(const ccd_vec3_t *p, const ccd_vec3_t *x0, const ccd_vec3_t *b,
                                      const ccd_vec3_t *c, ccd_vec3_t *witness);

int OURS(ccdMPRPenetrationWarm)(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_warm_t *warm,
                                ccd_real_t *depth, ccd_vec3_t *dir, ccd_vec3_t *pos);
int OURS(ccdMPRIntersectWarm)(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_warm_t *warm);
void OURS(ccdWarmGuess)(ccd_warm_t *warm, const ccd_vec3_t *dir);
void OURS(ccdWarmFlip)(ccd_warm_t *warm);
int OURS(ccdPenetration)(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_warm_t *warm, unsigned want,
                         ccd_penetration_t *out);
int OURS(ccdIntersect)(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_warm_t *warm);
int OURS(ccdPenetrationLocal)(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_warm_t *warm, unsigned want,
                              ccd_penetration_t *out);
int OURS(ccdPenetrationIncremental)(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_warm_t *warm, unsigned want,
                                    ccd_penetration_t *out);
int OURS(ccdPenetrationProven)(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_warm_t *warm, unsigned want,
                                ccd_penetration_t *out);
int OURS(ccdPenetrationAlong)(const void *obj1, const void *obj2, const ccd_t *ccd, const ccd_vec3_t *dir,
                              ccd_warm_t *warm, unsigned want, ccd_penetration_t *out);
int OURS(ccdPenetrationPlanar)(const void *obj1, const void *obj2, const ccd_t *ccd,
                               const ccd_vec3_t *plane_normal, ccd_warm_t *warm, unsigned want, ccd_penetration_t *out);
int OURS(ccdSignedDistance)(const void *obj1, const void *obj2, const ccd_t *ccd, ccd_real_t margin1,
                            ccd_real_t margin2, ccd_real_t max_distance, ccd_warm_t *warm, unsigned want, ccd_distance_t *out);
int OURS(ccdContacts)(const void *obj1, const void *obj2, const ccd_t *ccd, const ccd_vec3_t *normal, ccd_real_t slop,
                      ccd_contact_t *contacts, int max);
int OURS(ccdCheck)(const void *obj, ccd_support_fn support, ccd_center_fn center, ccd_check_t *out);
const char *OURS(ccdImplementation)(void);

#ifdef __cplusplus
}
#endif

#endif
