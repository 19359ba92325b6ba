/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The method of a paper as published, for comparisons: W. Gao, Efficient Incremental
 * Penetration Depth Estimation between Convex Geometries. warm.h's ccdPenetrationLocal answers
 * the same in fewer support points, and ccdPenetration answers the least depth of all. Made by
 * cbindgen from src/ffi/paper.rs; edit there. */

#ifndef __CCD_PAPER_H__
#define __CCD_PAPER_H__

#include <ccd/warm.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * A local minimum of the penetration depth by the paper's Algorithms 4 and 5, the shortcut on,
 * with a sound answer: the depth is that of the least support plane met, and an overlap is
 * proven. From the state's direction, else from the centres, else from first_dir.
 *
 * Reads mpr_tolerance. center1 and center2 may be NULL. `warm` may be NULL. `want`: CCD_WANT_
 * flags. Allocates nothing.
 *
 * Returns warm.h's codes: CCD_HIT, CCD_LIMIT, CCD_MISS or CCD_BAD_INPUT.
 */
CCD_EXPORT
int ccdPenetrationIncremental(const void *obj1,
                              const void *obj2,
                              const ccd_t *ccd,
                              ccd_warm_t *warm,
                              unsigned int want,
                              ccd_penetration_t *out);

#ifdef __cplusplus
}
#endif

#endif /* __CCD_PAPER_H__ */
