/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Counts the blocks that the library allocates from this program's own malloc, which fails on request.
 *
 * A polytope's element is one block of exactly its size, which the program may free, and the library
 * frees elements of the program. MPR's and intersection queries allocate nothing; other queries free
 * all blocks, and without memory libccd's return -2 and leave their outputs unchanged. */

#include "every_call.h"

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *block, size_t size);
void *__libc_memalign(size_t alignment, size_t size);
void __libc_free(void *block);

static int counting, live; /* live: blocks that are not freed */
static unsigned long allocations, fail_at;
static struct { void *block; size_t size; } last; /* the last one allocated */

/* Counts an allocation; returns 0 where it shall fail. */
static int count_allocation(void) { return !counting || ++allocations != fail_at; }

static void *add_block(void *block, size_t size)
{
    live += block != NULL;
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

/* Starts to count; the fail-th allocation (from 1; 0: none) fails. */
static void start_counting(unsigned long fail)
{
    counting = 1;
    live = 0;
    allocations = 0;
    fail_at = fail;
}

/* Checks that an element is one block, of this size. */
static void check_block(const void *element, size_t size, int blocks)
{
    CHECK(live == blocks && last.block == element && last.size == size, "an element is a block of %d bytes", (int)size);
}

static void append(list_t *head, list_t *link)
{
    link->prev = head->prev;
    link->next = head;
    head->prev->next = link;
    head->prev = link;
}

static void check_elements(void)
{
    pt_t pt, before;
    support_t s;
    pt_vertex_t *v[4];
    pt_edge_t *e[6];
    pt_face_t *f[4];
    memset(&s, 0, sizeof s);
    start_counting(0);
    ccdPtInit(&pt);
    CHECK(allocations == 0, "ccdPtInit allocates nothing");
    for (int i = 0; i < 4; i++) {
        s.v = random_vec3(1);
        v[i] = ccdPtAddVertex(&pt, &s);
        check_block(v[i], sizeof *v[i], i + 1);
    }
    for (int i = 0; i < 6; i++) {
        static const int ends[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 1}, {3, 2}};
        e[i] = ccdPtAddEdge(&pt, v[ends[i][0]], v[ends[i][1]]);
        check_block(e[i], sizeof *e[i], i + 5);
    }
    for (int i = 0; i < 4; i++) {
        static const int sides[4][3] = {{0, 1, 2}, {3, 4, 0}, {4, 5, 1}, {5, 3, 2}};
        f[i] = ccdPtAddFace(&pt, e[sides[i][0]], e[sides[i][1]], e[sides[i][2]]);
        check_block(f[i], sizeof *f[i], i + 11);
    }

    /* This program frees blocks of the library ... */
    pt_delete_face(&pt, f[1]);
    pt_delete_face(&pt, f[2]);
    pt_delete_edge(&pt, e[4]);
    CHECK(live == 11, "freed by the program");

    /* ... and the library frees a block of this program. */
    e[4] = (pt_edge_t *)malloc(sizeof *e[4]);
    memset(e[4], 0, sizeof *e[4]);
    e[4]->el.type = PT_EDGE;
    e[4]->vertex[0] = v[3];
    e[4]->vertex[1] = v[1];
    append(&v[3]->edges, &e[4]->vertex_list[0]);
    append(&v[1]->edges, &e[4]->vertex_list[1]);
    append(&pt.edges, &e[4]->el.list);
    CHECK(live == 12, "an element of the program");
    allocations = 0;
    ccdPtRecomputeDistances(&pt);
    ccdPtNearest(&pt);
    CHECK(allocations == 0, "searching allocates nothing");
    ccdPtDestroy(&pt);
    CHECK(live == 0, "%d blocks left after ccdPtDestroy", live);

    /* A failed allocation returns NULL and changes nothing. */
    ccdPtInit(&pt);
    for (int i = 0; i < 3; i++) {
        s.v = random_vec3(1);
        v[i] = ccdPtAddVertex(&pt, &s);
    }
    for (int i = 0; i < 3; i++)
        e[i] = ccdPtAddEdge(&pt, v[i], v[(i + 1) % 3]);
    before = pt;
    start_counting(1);
    CHECK(ccdPtAddVertex(&pt, &s) == NULL && allocations == 1, "no memory for a vertex");
    start_counting(1);
    CHECK(ccdPtAddEdge(&pt, v[0], v[1]) == NULL && allocations == 1, "no memory for an edge");
    start_counting(1);
    CHECK(ccdPtAddFace(&pt, e[0], e[1], e[2]) == NULL && allocations == 1, "no memory for a face");
    CHECK(same_bits(&pt, &before, sizeof pt) && e[0]->faces[0] == NULL && list_length(&v[0]->edges) == 2,
          "a failed allocation changes nothing");
    start_counting(0);
    ccdPtDestroy(&pt);
}

static void check_queries(void)
{
    for (int i = 0; i < PAIR_CALL_COUNT; i++) {
        const call_t *entry = &call_table[i];
        for (int round = 0; round < 100; round++) {
            const int overlapping = round % 4 != 0;
            shape_t a, b;
            results_t out;
            ccd_t ccd;
            random_pair(entry, overlapping, &a, &b, &ccd);
            ccd.epa_tolerance = ccd.mpr_tolerance = (ccd_real_t)1e-5;
            start_counting(0);
            int code = run(entry, &a, &b, &ccd, &out);
            CHECK(is_right(entry, code, &out, overlapping), "%s returned %d", entry->name, code);
            CHECK(live == 0, "%s left %d blocks behind", entry->name, live);
            /* A distance allocates only for an overlap. */
            if (!(entry->traits & MAY_ALLOCATE) || (!overlapping && entry->number == CALL_DISTANCE))
                CHECK(allocations == 0, "%s allocated %lu blocks", entry->name, allocations);
            const unsigned long last_fail = allocations < 40 ? allocations : 40;
            for (unsigned long fail = 1; fail <= last_fail; fail++) {
                start_counting(fail);
                code = run(entry, &a, &b, &ccd, &out);
                CHECK(live == 0, "%s without memory left %d blocks behind", entry->name, live);
                if (!(entry->traits & EXTENSION)) {
                    CHECK(code == -2, "%s without block %lu returned %d", entry->name, fail, code);
                    CHECK(are_clear(&out), "%s without memory wrote outputs", entry->name);
                }
            }
            counting = 0;
        }
    }
}

int main(void)
{
    setvbuf(stdout, NULL, _IONBF, 0); /* no block of stdout's is counted */
    check_elements();
    counting = 0;
    check_queries();
    return checks_end();
}
