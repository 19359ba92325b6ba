/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* CCD_EXPORT marks what the library exports. A program may define it beforehand; one that
 * links the static library on Windows defines CCD_STATIC_DEFINE. */

#ifndef CCD_EXPORT_H
#define CCD_EXPORT_H

#if defined(CCD_STATIC_DEFINE)
#undef CCD_EXPORT
#define CCD_EXPORT
#elif defined(_MSC_VER) && defined(ccd_EXPORTS)
#define CCD_EXPORT __declspec(dllexport)
#elif defined(_MSC_VER)
#define CCD_EXPORT __declspec(dllimport)
#elif !defined(CCD_EXPORT)
#define CCD_EXPORT __attribute__((visibility("default")))
#endif

#endif
