/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Declares libccd's polytope, which no installed header does: FCL has its own declarations too. The
 * functions that delete elements are inline and part of the user's program: they unlink and free()
 * elements that the library linked and allocated. */

#ifndef TESTS_POLYTOPE_H
#define TESTS_POLYTOPE_H

#include <ccd/ccd.h>
#include <stdio.h>

typedef struct { ccd_vec3_t v, v1, v2; } support_t;
typedef struct list { struct list *next, *prev; } list_t;

enum { PT_VERTEX = 1, PT_EDGE = 2, PT_FACE = 3 };

typedef struct { int type; ccd_real_t dist; ccd_vec3_t witness; list_t list; } pt_el_t;
typedef struct { pt_el_t el; int id; support_t v; list_t edges; } pt_vertex_t;
struct pt_face;
typedef struct { pt_el_t el; pt_vertex_t *vertex[2]; struct pt_face *faces[2]; list_t vertex_list[2]; } pt_edge_t;
typedef struct pt_face { pt_el_t el; pt_edge_t *edge[3]; } pt_face_t;
typedef struct { list_t vertices, edges, faces; pt_el_t *nearest; ccd_real_t nearest_dist; int nearest_type; } pt_t;

#ifdef __cplusplus
extern "C" {
#endif

void ccdPtInit(pt_t *pt);
void ccdPtDestroy(pt_t *pt);
pt_vertex_t *ccdPtAddVertex(pt_t *pt, const support_t *v);
pt_edge_t *ccdPtAddEdge(pt_t *pt, pt_vertex_t *v1, pt_vertex_t *v2);
pt_face_t *ccdPtAddFace(pt_t *pt, pt_edge_t *a, pt_edge_t *b, pt_edge_t *c);
void ccdPtRecomputeDistances(pt_t *pt);
pt_el_t *ccdPtNearest(pt_t *pt);
void ccdPtDumpSVT(pt_t *pt, const char *filename);
void ccdPtDumpSVT2(pt_t *pt, FILE *file);
void __ccdSupport(const void *obj1, const void *obj2, const ccd_vec3_t *dir, const ccd_t *ccd, support_t *supp);

#ifdef __cplusplus
}
#endif

static inline void list_unlink(list_t *node)
{
    node->next->prev = node->prev;
    node->prev->next = node->next;
}

static inline void pt_delete(pt_t *pt, pt_el_t *element)
{
    list_unlink(&element->list);
    if (pt->nearest == element)
        pt->nearest = NULL;
    free(element);
}

static inline void pt_delete_face(pt_t *pt, pt_face_t *face)
{
    for (int i = 0; i < 3; i++) {
        pt_edge_t *edge = face->edge[i];
        if (edge->faces[0] == face)
            edge->faces[0] = edge->faces[1];
        edge->faces[1] = NULL;
    }
    pt_delete(pt, &face->el);
}

static inline void pt_delete_edge(pt_t *pt, pt_edge_t *edge)
{
    list_unlink(&edge->vertex_list[0]);
    list_unlink(&edge->vertex_list[1]);
    pt_delete(pt, &edge->el);
}

static inline void pt_delete_vertex(pt_t *pt, pt_vertex_t *vertex)
{
    pt_delete(pt, &vertex->el);
}

static inline int pt_edge_is_free(const pt_edge_t *edge) { return edge->faces[0] == NULL; }
static inline int pt_vertex_is_free(const pt_vertex_t *vertex) { return vertex->edges.next == &vertex->edges; }

static inline int list_length(const list_t *head)
{
    int n = 0;
    for (const list_t *link = head->next; link != head; link = link->next)
        n++;
    return n;
}

#endif
