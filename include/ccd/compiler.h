/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Macros that depend on the compiler. */

#ifndef __CCD_COMPILER_H__
#define __CCD_COMPILER_H__

#include <stddef.h>

#define ccd_offsetof(type, member) offsetof(type, member)

/** Converts a pointer to a member to a pointer to its object of the given type. */
#define ccd_container_of(ptr, type, member) ((type *)((char *)(ptr) - ccd_offsetof(type, member)))

/* _ccd_inline: marks a function that is inlined and may be unused.
 * _ccd_prefetch, _ccd_prefetchw: hint that an address will be read, or written. */
#ifdef __GNUC__
#define _ccd_inline static __inline__ __attribute__((always_inline))
#define _ccd_prefetch(x) __builtin_prefetch(x)
#define _ccd_prefetchw(x) __builtin_prefetch(x, 1)
#else
#define _ccd_inline static __inline
#define _ccd_prefetch(x) ((void)0)
#define _ccd_prefetchw(x) ((void)0)
#endif

#ifdef __ICC
/** Disables warnings of unused parameters and of operands in unspecified order. */
#pragma warning(disable : 869)
#pragma warning(disable : 981)
#endif

#ifdef _MSC_VER
#define _CRT_SECURE_NO_WARNINGS
#endif

#endif
