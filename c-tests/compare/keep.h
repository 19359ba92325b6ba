/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Wrong answers as C files. */

#ifndef COMPARE_KEEP_H
#define COMPARE_KEEP_H

#include "compare/sample.h"

/* Keeps the answer of one library where it is among its worst, and its file shows it again. */
void keep_case(const compare_t *compare, const sample_t *s, int side);

#endif
