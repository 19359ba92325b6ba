/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The one table of what this library exports, but for the polytope functions, which no header
 * declares. this_library.h, tests/contract/every_call.h, tests/extension/bad_input.c and tests/stability/judge.h ask by it; the contract test
 * holds it against the library's symbols, the extension's interfaces and the Rust tests.
 *
 * PAIR_CALLS: name, the word that the judges have for it, what its arguments behind (obj1, obj2,
 * ccd) are, and its traits. The kinds:
 *
 *   YES         none                     1 or 0
 *   YES_WARM    warm                     1 or 0
 *   SEPARATION  sep                      0 or -1
 *   DEPTH       depth, dir, pos          0 or -1
 *   DEPTH_WARM  warm, depth, dir, pos    0 or -1
 *   FULL        warm, want, out          CCD_HIT ...
 *   FULL_ALONG  vector, warm, want, out  CCD_HIT ...
 *   MANIFOLD    ccdContacts' own         how many, or CCD_BAD_INPUT
 *   DISTANCE    ccdSignedDistance's own  CCD_HIT ... */

#ifndef TESTS_CALLS_H
#define TESTS_CALLS_H

enum { FROM_FIRST_DIR = 1, FROM_CENTERS = 2, STORES_DEPTH = 4, STORES_DIR_POS = 8, MAY_ALLOCATE = 16, EXTENSION = 32,
       ONE_BY_ONE = 64 /* asks the objects one by one */, STORES = STORES_DEPTH | STORES_DIR_POS };

#define PAIR_CALLS(X) \
    X(ccdGJKIntersect, GJK_INTERSECT, YES, FROM_FIRST_DIR) \
    X(ccdGJKSeparate, SEPARATE, SEPARATION, FROM_FIRST_DIR | MAY_ALLOCATE) \
    X(ccdGJKPenetration, GJK, DEPTH, FROM_FIRST_DIR | STORES | MAY_ALLOCATE) \
    X(ccdMPRIntersect, MPR_INTERSECT, YES, FROM_CENTERS) \
    X(ccdMPRPenetration, MPR, DEPTH, FROM_CENTERS | STORES) \
    X(ccdMPRPenetrationWarm, MPR_WARM, DEPTH_WARM, FROM_CENTERS | STORES | EXTENSION) \
    X(ccdMPRIntersectWarm, MPR_INTERSECT_WARM, YES_WARM, FROM_CENTERS | EXTENSION) \
    X(ccdIntersect, INTERSECT, YES_WARM, EXTENSION) \
    X(ccdPenetration, PENETRATION, FULL, STORES | EXTENSION) \
    X(ccdPenetrationLocal, LOCAL, FULL, STORES | EXTENSION) \
    X(ccdPenetrationIncremental, INCREMENTAL, FULL, STORES | EXTENSION) \
    X(ccdPenetrationProven, PROVEN, FULL, STORES | MAY_ALLOCATE | EXTENSION) \
    X(ccdPenetrationAlong, ALONG, FULL_ALONG, STORES | EXTENSION) \
    X(ccdContacts, CONTACTS, MANIFOLD, STORES | EXTENSION | ONE_BY_ONE) \
    X(ccdPenetrationPlanar, PLANAR, FULL_ALONG, STORES | EXTENSION) \
    X(ccdSignedDistance, DISTANCE, DISTANCE, STORES | MAY_ALLOCATE | EXTENSION)

/* Functions that query no pair of objects: name, traits. */
#define OTHER_CALLS(X) \
    X(ccdFirstDirDefault, 0) \
    X(ccdVec3PointSegmentDist2, 0) \
    X(ccdVec3PointTriDist2, 0) \
    X(ccdWarmGuess, EXTENSION) \
    X(ccdWarmFlip, EXTENSION) \
    X(ccdCheck, EXTENSION) \
    X(ccdImplementation, EXTENSION)

#endif
