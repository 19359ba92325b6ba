/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Included before each source of a prebuilt recorder: binds the functions that glibc 2.34 moved into libc.so.6 to the symbols
 * that each glibc for x86-64 has, in libdl.so.2 and libpthread.so.0 before. */

__asm__(".symver dlopen,dlopen@GLIBC_2.2.5");
__asm__(".symver dlsym,dlsym@GLIBC_2.2.5");
__asm__(".symver dlerror,dlerror@GLIBC_2.2.5");
__asm__(".symver pthread_once,pthread_once@GLIBC_2.2.5");
