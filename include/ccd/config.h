/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The precision of ccd_real_t, which must be that of the library linked: double unless
 * the program defines CCD_SINGLE. The package of a single precision build installs this
 * file with the word in its only definition changed. */

#ifndef __CCD_CONFIG_H__
#define __CCD_CONFIG_H__

#if !defined(CCD_SINGLE) && !defined(CCD_DOUBLE)
#define CCD_DOUBLE
#endif

#endif
