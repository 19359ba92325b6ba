/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* CCD_EXPORT marks the exported symbols. A program may define it beforehand; a program that links
 * the static library on Windows must define CCD_STATIC_DEFINE. */

#ifndef CCD_EXPORT_H
#define CCD_EXPORT_H

#if defined(CCD_STATIC_DEFINE)
#undef CCD_EXPORT
#define CCD_EXPORT
#elif defined(_WIN32) && defined(ccd_EXPORTS)
#define CCD_EXPORT __declspec(dllexport)
#elif defined(_WIN32)
#define CCD_EXPORT __declspec(dllimport)
#elif !defined(CCD_EXPORT)
#define CCD_EXPORT __attribute__((visibility("default")))
#endif

#endif
