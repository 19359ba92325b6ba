/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Calls every function of libccd's in one library, and prints the results bit for bit: the same whatever else is in the
 * process.
 *   two_libraries LIBRARY [OTHER]   the file that is called; one that is loaded after it, for all others to bind to */

#include "tests/contract/functions.h"
#include "tests/contract/polytope.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#define POINTER(name) __typeof__(name) *p_##name;
static struct { LIBCCD_FUNCTIONS(POINTER) } library;
#define CALL(name) (*library.p_##name)

static void *open_library(const char *file, int scope)
{
    void *const handle = dlopen(file, RTLD_LAZY | scope);
    if (!handle) {
        fprintf(stderr, "%s\n", dlerror());
        exit(1);
    }
    return handle;
}

static void find(void *handle, const char *name, void *pointer)
{
    void *const symbol = dlsym(handle, name);
    if (!symbol) {
        fprintf(stderr, "%s\n", dlerror());
        exit(1);
    }
    memcpy(pointer, &symbol, sizeof symbol);
}

typedef struct { ccd_vec3_t center, half; } box_t;

static void support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const box_t *const box = obj;
    for (int i = 0; i < 3; i++)
        out->v[i] = box->center.v[i] + (dir->v[i] < 0 ? -box->half.v[i] : box->half.v[i]);
}

static void center(const void *obj, ccd_vec3_t *out) { *out = ((const box_t *)obj)->center; }

static void print(const char *name, double value, const ccd_vec3_t *v)
{
    printf("%s %a", name, value);
    for (int i = 0; v && i < 3; i++)
        printf(" %a", (double)v->v[i]);
    printf("\n");
}

static void print_queries(void)
{
    const box_t a = { {{0, 0, 0}}, {{0.5, 0.5, 0.5}} }, b = { {{0.75, 0.1, 0.2}}, {{0.5, 0.4, 0.3}} };
    ccd_vec3_t first_dir = {{0, 0, 0}};
    CALL(ccdFirstDirDefault)(&a, &b, &first_dir);
    print("ccdFirstDirDefault", 0, &first_dir);
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.first_dir = library.p_ccdFirstDirDefault;
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = center;

    ccd_real_t depth = 0;
    ccd_vec3_t dir = {{0, 0, 0}}, pos = dir;
    int code = CALL(ccdMPRPenetration)(&a, &b, &ccd, &depth, &dir, &pos);
    print("ccdMPRPenetration", code, &pos);
    print("  depth", (double)depth, &dir);
    code = CALL(ccdGJKPenetration)(&a, &b, &ccd, &depth, &dir, &pos);
    print("ccdGJKPenetration", code, &pos);
    print("  depth", (double)depth, &dir);
    code = CALL(ccdGJKSeparate)(&a, &b, &ccd, &dir);
    print("ccdGJKSeparate", code, &dir);
    print("ccdMPRIntersect", CALL(ccdMPRIntersect)(&a, &b, &ccd), NULL);
    print("ccdGJKIntersect", CALL(ccdGJKIntersect)(&a, &b, &ccd), NULL);
    support_t s;
    CALL(__ccdSupport)(&a, &b, &first_dir, &ccd, &s);
    print("__ccdSupport", 0, &s.v);
}

static void print_polytope(void)
{
    const ccd_vec3_t origin = {{0, 0, 0}}, points[3] = { {{1, 0, 0.5}}, {{0, 1, 0.25}}, {{-1, -1, 0.125}} };
    ccd_vec3_t closest;
    double dist2 = (double)CALL(ccdVec3PointSegmentDist2)(&origin, &points[0], &points[1], &closest);
    print("ccdVec3PointSegmentDist2", dist2, &closest);
    dist2 = (double)CALL(ccdVec3PointTriDist2)(&origin, &points[0], &points[1], &points[2], &closest);
    print("ccdVec3PointTriDist2", dist2, &closest);

    pt_t pt;
    pt_vertex_t *vertex[3];
    pt_edge_t *edge[3];
    CALL(ccdPtInit)(&pt);
    for (int i = 0; i < 3; i++) {
        const support_t s = { points[i], points[i], origin };
        vertex[i] = CALL(ccdPtAddVertex)(&pt, &s);
    }
    for (int i = 0; i < 3; i++)
        edge[i] = CALL(ccdPtAddEdge)(&pt, vertex[i], vertex[(i + 1) % 3]);
    CALL(ccdPtAddFace)(&pt, edge[0], edge[1], edge[2]);
    CALL(ccdPtRecomputeDistances)(&pt);
    const pt_el_t *const nearest = CALL(ccdPtNearest)(&pt);
    print("ccdPtNearest", (double)nearest->dist, &nearest->witness);
    fflush(stdout);
    CALL(ccdPtDumpSVT)(&pt, "/dev/stdout");
    CALL(ccdPtDumpSVT2)(&pt, stdout);
    CALL(ccdPtDestroy)(&pt);
    printf("%d elements are left\n", list_length(&pt.vertices) + list_length(&pt.edges) + list_length(&pt.faces));
}

int main(int argc, char **argv)
{
    if (argc < 2)
        return 2;
    void *const handle = open_library(argv[1], RTLD_LOCAL);
    if (argc > 2)
        open_library(argv[2], RTLD_GLOBAL);
#define FIND(name) find(handle, #name, &library.p_##name);
    LIBCCD_FUNCTIONS(FIND)
    print_queries();
    print_polytope();
    return 0;
}
