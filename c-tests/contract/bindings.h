/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* What libccd_bindings.rs is bindgen's view of. */

#include <ccd/ccd.h>
#include <ccd/quat.h>
