/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Stands in for the config.h of a single precision libccd, which Debian has not: before
 * it on the include path, it makes libccd's other headers single. */

#ifndef __CCD_CONFIG_H__
#define __CCD_CONFIG_H__
#ifndef CCD_SINGLE
#define CCD_SINGLE
#endif
#endif
