/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The one table of what this library exports, except the polytope functions, which no header
 * declares. Every test and measuring program in C calls through it, by this_library.h; the contract test
 * compares it with the library's symbols, the extension's interfaces and the Rust tests. */

#ifndef TESTS_CALLS_H
#define TESTS_CALLS_H

/* Kinds of calls: what they return for an overlap, for a miss and for bad input (ccdContacts returns a count),
 * and their arguments after (obj1, obj2, ccd). */
#define CALL_KINDS(X) \
    X(BOOLEAN, 1, 0, 0)                                         /* none */ \
    X(BOOLEAN_WARM, 1, 0, 0)                                    /* warm */ \
    X(SEPARATION, 0, -1, -1)                                    /* sep */ \
    X(DEPTH, 0, -1, -1)                                         /* depth, dir, pos */ \
    X(DEPTH_WARM, 0, -1, -1)                                    /* warm, depth, dir, pos */ \
    X(PENETRATION, CCD_HIT, CCD_MISS, CCD_BAD_INPUT)            /* warm, want, out */ \
    X(PENETRATION_ALONG, CCD_HIT, CCD_MISS, CCD_BAD_INPUT)      /* vector, warm, want, out */ \
    X(MANIFOLD, CCD_HIT, CCD_MISS, CCD_BAD_INPUT)               /* ccdContacts' own */ \
    X(DISTANCE, CCD_HIT, CCD_MISS, CCD_BAD_INPUT)               /* ccdSignedDistance's own */

/* Traits: the tolerance that a call reads, its first direction, and what else it does. */
enum { MPR_TOLERANCE = 1, EPA_TOLERANCE = 2, DIST_TOLERANCE = 4, FROM_FIRST_DIR = 8, FROM_CENTERS = 16, STORES = 32,
       MAY_ALLOCATE = 64, EXTENSION = 128, ONE_BY_ONE = 256 /* queries one object at a time */ };

/* Name, suffix of its CALL_ constant, kind, traits. */
#define LIBCCD_CALLS(X) \
    X(ccdMPRPenetration, MPR, DEPTH, FROM_CENTERS | MPR_TOLERANCE | STORES) \
    X(ccdMPRIntersect, MPR_INTERSECT, BOOLEAN, FROM_CENTERS) \
    X(ccdGJKPenetration, GJK, DEPTH, FROM_FIRST_DIR | EPA_TOLERANCE | STORES | MAY_ALLOCATE) \
    X(ccdGJKSeparate, SEPARATE, SEPARATION, FROM_FIRST_DIR | EPA_TOLERANCE | MAY_ALLOCATE) \
    X(ccdGJKIntersect, GJK_INTERSECT, BOOLEAN, FROM_FIRST_DIR)

#define EXTENSION_CALLS(X) \
    X(ccdMPRPenetrationWarm, MPR_WARM, DEPTH_WARM, FROM_CENTERS | MPR_TOLERANCE | STORES | EXTENSION) \
    X(ccdMPRIntersectWarm, MPR_INTERSECT_WARM, BOOLEAN_WARM, FROM_CENTERS | EXTENSION) \
    X(ccdIntersect, INTERSECT, BOOLEAN_WARM, EXTENSION) \
    X(ccdPenetration, PENETRATION, PENETRATION, MPR_TOLERANCE | STORES | EXTENSION) \
    X(ccdPenetrationLocal, LOCAL, PENETRATION, MPR_TOLERANCE | STORES | EXTENSION) \
    X(ccdPenetrationIncremental, INCREMENTAL, PENETRATION, MPR_TOLERANCE | STORES | EXTENSION) \
    X(ccdPenetrationProven, PROVEN, PENETRATION, EPA_TOLERANCE | STORES | MAY_ALLOCATE | EXTENSION) \
    X(ccdPenetrationAlong, ALONG, PENETRATION_ALONG, MPR_TOLERANCE | STORES | EXTENSION) \
    X(ccdContacts, CONTACTS, MANIFOLD, STORES | EXTENSION | ONE_BY_ONE) \
    X(ccdPenetrationPlanar, PLANAR, PENETRATION_ALONG, MPR_TOLERANCE | STORES | EXTENSION) \
    X(ccdSignedDistance, DISTANCE, DISTANCE, DIST_TOLERANCE | STORES | MAY_ALLOCATE | EXTENSION)

#define PAIR_CALLS(X) LIBCCD_CALLS(X) EXTENSION_CALLS(X)

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
