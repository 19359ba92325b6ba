/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The program's own malloc, which counts blocks and fails on request: the library allocates from it too. Without
 * -DCOUNT_BLOCKS the program has the system's. */

#ifndef CONTRACT_HEAP_H
#define CONTRACT_HEAP_H

#include <stddef.h>

static int counting, live, most; /* live: blocks that are not freed; most: of them at once */
static unsigned long allocations, fail_at;
static struct { void *block; size_t size; } last; /* the last one allocated */

/* Starts to count live blocks from 0; the fail-th allocation (from 1; 0: none) fails. */
static void start_counting(unsigned long fail)
{
    counting = 1;
    live = most = 0;
    allocations = 0;
    fail_at = fail;
}

#ifdef COUNT_BLOCKS
enum { COUNTS_BLOCKS = 1 };

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *block, size_t size);
void *__libc_memalign(size_t alignment, size_t size);
void __libc_free(void *block);

/* Counts an allocation; returns 0 where it shall fail. */
static int count_allocation(void) { return !counting || ++allocations != fail_at; }

static void *add_block(void *block, size_t size)
{
    live += block != NULL;
    most = live > most ? live : most;
    last.block = block;
    last.size = size;
    return block;
}

void *malloc(size_t size) { return count_allocation() ? add_block(__libc_malloc(size), size) : NULL; }
void *calloc(size_t n, size_t size) { return count_allocation() ? add_block(__libc_calloc(n, size), n * size) : NULL; }

void *realloc(void *block, size_t size)
{
    if (!count_allocation())
        return NULL;
    live -= block != NULL;
    return add_block(__libc_realloc(block, size), size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return count_allocation() ? add_block(__libc_memalign(alignment, size), size) : NULL;
}

int posix_memalign(void **block, size_t alignment, size_t size)
{
    *block = aligned_alloc(alignment, size);
    return *block == NULL ? 12 /* ENOMEM */ : 0;
}

void free(void *block)
{
    live -= block != NULL;
    __libc_free(block);
}
#else
enum { COUNTS_BLOCKS = 0 };
#endif

#endif
