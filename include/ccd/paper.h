/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Provides the method of W. Gao, Efficient Incremental Penetration Depth Estimation between Convex
 * Geometries (2023), as published, for comparisons. ccdPenetrationLocal of warm.h also computes a
 * local minimum, with fewer support points, and ccdPenetration the global one. cbindgen makes
 * include/ccd/paper.h from src/ffi/paper.rs; edit there. */

#ifndef __CCD_PAPER_H__
#define __CCD_PAPER_H__

#include <ccd/warm.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Computes a local minimum of the penetration depth by the paper's Algorithms 4 and 5 with the
 * shortcut of its Section III-C. The result is sound: depth is the least support value evaluated,
 * and an overlap is proven. Directions are evaluated as they are, not tilted: a support function
 * that is wrong along its own axis, as ODE's cylinder, gives wrong depths and misses.
 *
 * `warm`: may be NULL. `want`: CCD_WANT_ flags.
 *
 * Reads mpr_tolerance. Allocates nothing.
 *
 * Returns CCD_HIT, CCD_LIMIT, CCD_MISS or CCD_BAD_INPUT.
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
