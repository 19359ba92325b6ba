/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Who owns which memory. This program's own malloc counts blocks and fails on demand; the
 * library must use it, as it must use the consumer's.
 *
 * Polytope nodes: one block of exactly the node's size each, and free() and the library may
 * free each other's. Queries: no block at all in MPR and in yes-or-no queries; elsewhere
 * none is left behind, and without memory the answer is -2 with outputs untouched. */

#include "every_call.h"
#include <stddef.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *block, size_t size);
void *__libc_memalign(size_t alignment, size_t size);
void __libc_free(void *block);

enum { MOST = 4096 };
static struct { void *block; size_t size; } live[MOST];
static int watching, live_count;
static unsigned long taken, fail_at;
static size_t last_size;

static void *took(void *block, size_t size)
{
    if (watching && block != NULL && live_count < MOST) {
        live[live_count].block = block;
        live[live_count++].size = size;
        last_size = size;
    }
    return block;
}

static int may_take(void)
{
    if (!watching)
        return 1;
    taken++;
    return taken != fail_at;
}

static void gave(void *block)
{
    for (int i = 0; i < live_count && block != NULL; i++)
        if (live[i].block == block) {
            live[i] = live[--live_count];
            return;
        }
}

void *malloc(size_t size) { return may_take() ? took(__libc_malloc(size), size) : NULL; }
void *calloc(size_t n, size_t size) { return may_take() ? took(__libc_calloc(n, size), n * size) : NULL; }

void *realloc(void *block, size_t size)
{
    if (!may_take())
        return NULL;
    gave(block);
    void *moved = __libc_realloc(block, size);
    return took(moved, size);
}

int posix_memalign(void **block, size_t alignment, size_t size)
{
    *block = may_take() ? took(__libc_memalign(alignment, size), size) : NULL;
    return *block == NULL ? 12 /* ENOMEM */ : 0;
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return may_take() ? took(__libc_memalign(alignment, size), size) : NULL;
}

void free(void *block)
{
    gave(block);
    __libc_free(block);
}

/* From here on blocks are counted, and the fail-th (from 1; 0 for none) is refused. */
static void watch(unsigned long fail)
{
    watching = 1;
    live_count = 0;
    taken = 0;
    fail_at = fail;
}

static void check_nodes(void)
{
    pt_t pt, before;
    support_t s;
    pt_vertex_t *v[4];
    pt_edge_t *e[6];
    pt_face_t *f[4];
    memset(&s, 0, sizeof s);
    watch(0);
    ccdPtInit(&pt);
    CHECK(taken == 0, "ccdPtInit takes no memory");
    for (int i = 0; i < 4; i++) {
        s.v = random_vec3(1);
        v[i] = ccdPtAddVertex(&pt, &s);
        CHECK(live_count == i + 1 && live[i].block == v[i] && live[i].size == sizeof *v[i], "a vertex is a block");
    }
    for (int i = 0; i < 6; i++) {
        static const int ends[6][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 1}, {3, 2}};
        e[i] = ccdPtAddEdge(&pt, v[ends[i][0]], v[ends[i][1]]);
        CHECK(live_count == i + 5 && live[i + 4].block == e[i] && live[i + 4].size == sizeof *e[i], "an edge is a block");
    }
    for (int i = 0; i < 4; i++) {
        static const int sides[4][3] = {{0, 1, 2}, {3, 4, 0}, {4, 5, 1}, {5, 3, 2}};
        f[i] = ccdPtAddFace(&pt, e[sides[i][0]], e[sides[i][1]], e[sides[i][2]]);
        CHECK(live_count == i + 11 && live[i + 10].block == f[i] && live[i + 10].size == sizeof *f[i], "a face is a block");
    }

    /* The consumer frees what the library took ... */
    pt_delete_face(&pt, f[1]);
    pt_delete_face(&pt, f[2]);
    pt_delete_edge(&pt, e[4]);
    CHECK(live_count == 11, "freed by the consumer");

    /* ... and the library frees what the consumer took. */
    e[4] = (pt_edge_t *)malloc(sizeof *e[4]);
    memset(e[4], 0, sizeof *e[4]);
    e[4]->el.type = PT_EDGE;
    e[4]->vertex[0] = v[3];
    e[4]->vertex[1] = v[1];
    for (int i = 0; i < 2; i++) {
        list_t *link = &e[4]->vertex_list[i], *head = &e[4]->vertex[i]->edges;
        link->prev = head->prev;
        link->next = head;
        head->prev->next = link;
        head->prev = link;
    }
    e[4]->el.list.prev = pt.edges.prev;
    e[4]->el.list.next = &pt.edges;
    pt.edges.prev->next = &e[4]->el.list;
    pt.edges.prev = &e[4]->el.list;
    CHECK(live_count == 12, "a node of the consumer's");
    taken = 0;
    ccdPtRecomputeDistances(&pt);
    ccdPtNearest(&pt);
    CHECK(taken == 0, "searching takes no memory");
    ccdPtDestroy(&pt);
    CHECK(live_count == 0, "%d blocks left after ccdPtDestroy", live_count);

    /* Refused: NULL, and nothing has changed. */
    ccdPtInit(&pt);
    for (int i = 0; i < 3; i++) {
        s.v = random_vec3(1);
        v[i] = ccdPtAddVertex(&pt, &s);
    }
    for (int i = 0; i < 3; i++)
        e[i] = ccdPtAddEdge(&pt, v[i], v[(i + 1) % 3]);
    before = pt;
    watch(1);
    CHECK(ccdPtAddVertex(&pt, &s) == NULL && taken == 1, "no memory for a vertex");
    watch(1);
    CHECK(ccdPtAddEdge(&pt, v[0], v[1]) == NULL && taken == 1, "no memory for an edge");
    watch(1);
    CHECK(ccdPtAddFace(&pt, e[0], e[1], e[2]) == NULL && taken == 1, "no memory for a face");
    CHECK(same_bits(&pt, &before, sizeof pt) && e[0]->faces[0] == NULL && list_length(&v[0]->edges) == 2,
          "a refused element leaves no trace");
    watch(0);
    ccdPtDestroy(&pt);
}

static void check_queries(void)
{
    for (int i = 0; i < PAIR_CALL_COUNT; i++) {
        const call_t *entry = &call_table[i];
        for (int round = 0; round < 100; round++) {
            const int overlapping = round % 4 != 0;
            shape_t a, b;
            outputs_t out, before;
            ccd_t ccd;
            random_pair(entry, overlapping, &a, &b, &ccd);
            ccd.epa_tolerance = ccd.mpr_tolerance = (ccd_real_t)1e-5;
            watch(0);
            int code = run(entry, &a, &b, &ccd, &out);
            CHECK(code == (overlapping ? entry->hit : entry->miss), "%s returned %d", entry->name, code);
            CHECK(live_count == 0, "%s left %d blocks behind", entry->name, live_count);
            /* A distance takes none while the objects are apart. */
            if (!(entry->traits & MAY_ALLOCATE) || (!overlapping && entry->number == CALL_DISTANCE))
                CHECK(taken == 0, "%s took %lu blocks", entry->name, taken);
            for (unsigned long fail = 1; fail <= (taken < 40 ? taken : 40); fail++) {
                const unsigned long needed = taken;
                memset(&out, 0x5a, sizeof out);
                before = out;
                watch(fail);
                code = run(entry, &a, &b, &ccd, &out);
                CHECK(live_count == 0, "%s without memory left %d blocks behind", entry->name, live_count);
                if (!(entry->traits & EXTENSION)) {
                    CHECK(code == -2, "%s without block %lu returned %d", entry->name, fail, code);
                    CHECK(same_bits(&out, &before, sizeof out), "%s without memory touched outputs", entry->name);
                }
                taken = needed;
            }
            watching = 0;
        }
    }
}

int main(void)
{
    /* stdout's buffer is not the library's. */
    printf("blocks taken by one query\n");
    check_nodes();
    watching = 0;
    check_queries();
    return checks_end();
}
