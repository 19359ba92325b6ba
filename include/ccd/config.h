/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The precision of ccd_real_t: double unless the program defines CCD_SINGLE. It must be that of the
 * linked library. A single precision build installs this file with CCD_SINGLE in the definition. */

#ifndef __CCD_CONFIG_H__
#define __CCD_CONFIG_H__

#if !defined(CCD_SINGLE) && !defined(CCD_DOUBLE)
#define CCD_DOUBLE
#endif

#endif
