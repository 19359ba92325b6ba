/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* EPA as FCL runs it on libccd's polytope functions: a tetrahedron about the origin,
 * expanded at the nearest element with a real horizon, for many ellipsoids. The same
 * program on either library; its instructions are counted. Prints the sum of distances,
 * so that the two runs can be seen to have done the same work. */

#include "check.h"
#include "polytope.h"
#include <math.h>

static ccd_vec3_t half_axes, centre;

static void ellipsoid(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    ccd_vec3_t scaled;
    ccd_real_t length;
    int i;
    (void)obj;
    for (i = 0; i < 3; i++)
        scaled.v[i] = half_axes.v[i] * dir->v[i];
    length = CCD_SQRT(ccdVec3Len2(&scaled));
    for (i = 0; i < 3; i++)
        out->v[i] = centre.v[i] + half_axes.v[i] * scaled.v[i] / length;
}

static void point(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    (void)obj;
    (void)dir;
    ccdVec3Set(out, 0, 0, 0);
}

/* Whether p is on the outer side of the face; the origin is on the inner one. */
static int sees(const ccd_vec3_t *p, const pt_face_t *face)
{
    pt_vertex_t *corner[3];
    ccd_vec3_t ab, ac, ap, normal;
    pt_face_corners(face, corner);
    ccdVec3Sub2(&ab, &corner[1]->v.v, &corner[0]->v.v);
    ccdVec3Sub2(&ac, &corner[2]->v.v, &corner[0]->v.v);
    ccdVec3Sub2(&ap, p, &corner[0]->v.v);
    ccdVec3Cross(&normal, &ab, &ac);
    return ccdVec3Dot(&normal, &ap) * ccdVec3Dot(&normal, &corner[0]->v.v) > 0;
}

static void expand(pt_t *pt, const support_t *s)
{
    enum { MOST = 300 };
    pt_edge_t *horizon[MOST], *spoke[2];
    list_t *link, *next;
    pt_vertex_t *apex;
    int n = 0, i, k;
    for (link = pt->faces.next; link != &pt->faces; link = next) {
        pt_face_t *face = PT_ELEMENT(pt_face_t, link);
        next = link->next;
        if (sees(&s->v, face))
            pt_delete_face(pt, face);
    }
    for (link = pt->edges.next; link != &pt->edges; link = next) {
        pt_edge_t *edge = PT_ELEMENT(pt_edge_t, link);
        next = link->next;
        if (pt_edge_is_free(edge))
            pt_delete_edge(pt, edge);
        else if (edge->faces[1] == NULL && n < MOST)
            horizon[n++] = edge;
    }
    for (link = pt->vertices.next; link != &pt->vertices; link = next) {
        pt_vertex_t *vertex = PT_ELEMENT(pt_vertex_t, link);
        next = link->next;
        if (pt_vertex_is_free(vertex))
            pt_delete_vertex(pt, vertex);
    }
    apex = ccdPtAddVertex(pt, s);
    for (i = 0; i < n; i++) {
        for (k = 0; k < 2; k++) {
            pt_vertex_t *foot = horizon[i]->vertex[k];
            /* A spoke is the edge added last at its foot. */
            pt_edge_t *last = ccd_container_of(foot->edges.prev, pt_edge_t, vertex_list[1]);
            spoke[k] = last->vertex[1] == foot && last->vertex[0] == apex ? last : ccdPtAddEdge(pt, apex, foot);
        }
        ccdPtAddFace(pt, horizon[i], spoke[0], spoke[1]);
    }
}

static void start(pt_t *pt, const ccd_t *ccd)
{
    static const double corner[4][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    pt_vertex_t *v[4];
    pt_edge_t *e[6];
    int i;
    ccdPtInit(pt);
    for (i = 0; i < 4; i++) {
        support_t s;
        ccd_vec3_t dir;
        ccdVec3Set(&dir, (ccd_real_t)corner[i][0], (ccd_real_t)corner[i][1], (ccd_real_t)corner[i][2]);
        ccdVec3Normalize(&dir);
        __ccdSupport(NULL, NULL, &dir, ccd, &s);
        v[i] = ccdPtAddVertex(pt, &s);
    }
    e[0] = ccdPtAddEdge(pt, v[0], v[1]);
    e[1] = ccdPtAddEdge(pt, v[1], v[2]);
    e[2] = ccdPtAddEdge(pt, v[2], v[0]);
    e[3] = ccdPtAddEdge(pt, v[3], v[0]);
    e[4] = ccdPtAddEdge(pt, v[3], v[1]);
    e[5] = ccdPtAddEdge(pt, v[3], v[2]);
    ccdPtAddFace(pt, e[0], e[1], e[2]);
    ccdPtAddFace(pt, e[3], e[4], e[0]);
    ccdPtAddFace(pt, e[4], e[5], e[1]);
    ccdPtAddFace(pt, e[5], e[3], e[2]);
}

int main(void)
{
    double sum = 0;
    int pair, i;
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ellipsoid;
    ccd.support2 = point;
    for (pair = 0; pair < 40; pair++) {
        pt_t pt;
        for (i = 0; i < 3; i++) {
            half_axes.v[i] = (ccd_real_t)random_in(0.5, 2);
            centre.v[i] = (ccd_real_t)random_in(-0.1, 0.1);
        }
        start(&pt, &ccd);
        for (i = 0; i < 60; i++) {
            support_t s;
            pt_el_t *nearest = ccdPtNearest(&pt);
            ccd_vec3_t dir = nearest->witness;
            ccdVec3Normalize(&dir);
            __ccdSupport(NULL, NULL, &dir, &ccd, &s);
            expand(&pt, &s);
        }
        sum += (double)CCD_SQRT(ccdPtNearest(&pt)->dist);
        ccdPtDestroy(&pt);
    }
    printf("%.6f\n", sum);
    return !(sum > 0);
}
