/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Names libccd's functions, all that its libccd.so.2 exports. */

#ifndef TESTS_FUNCTIONS_H
#define TESTS_FUNCTIONS_H

#define LIBCCD_FUNCTIONS(X) \
    X(ccdMPRPenetration) X(ccdMPRIntersect) X(ccdGJKPenetration) X(ccdGJKSeparate) X(ccdGJKIntersect) \
    X(ccdFirstDirDefault) X(ccdVec3PointSegmentDist2) X(ccdVec3PointTriDist2) X(__ccdSupport) \
    X(ccdPtInit) X(ccdPtDestroy) X(ccdPtAddVertex) X(ccdPtAddEdge) X(ccdPtAddFace) \
    X(ccdPtRecomputeDistances) X(ccdPtNearest) X(ccdPtDumpSVT) X(ccdPtDumpSVT2)

#endif
