/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* ODE's dCollide over random pairs of every kind of geometry that it queries libccd for (pose_all of poses.h); compare.sh
 * judges the queries.
 *
 * usage: ode_static SEED POSES   (POSES placed pairs of each two kinds) */

#include "engines/ode_shapes.h"
#include "harness/identity.h"

/* ODE refers to all of it while the geometry lives. */
typedef struct {
    body_t body;
    dGeomID geom;
    dTriMeshDataID mesh;
    dTriIndex index[6];
} placed_t;

static placed_t a, b;

static void geom_make(placed_t *p)
{
    if (p->geom)
        dGeomDestroy(p->geom);
    if (p->mesh)
        dGeomTriMeshDataDestroy(p->mesh);
    p->mesh = NULL;
    if (p->body.kind != KIND_TRIANGLE) {
        p->geom = ode_geometry(NULL, &p->body);
        return;
    }
    /* ODE cannot have a mesh of one triangle: the other is its back */
    for (int i = 0; i < 6; i++)
        p->index[i] = (dTriIndex)(i < 3 ? i : 5 - i);
    p->mesh = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble(p->mesh, p->body.hull.vertex, 3 * sizeof(double), 3, p->index, 6, 3 * sizeof(dTriIndex));
    dGeomTriMeshDataPreprocess2(p->mesh, 1U << dTRIDATAPREPROCESS_BUILD_FACE_ANGLES, NULL);
    p->geom = dCreateTriMesh(NULL, p->mesh, NULL, NULL, NULL);
}

static void geom_place(placed_t *p)
{
    const double *r = p->body.shape.rot, *at = p->body.shape.pos;
    const dMatrix3 rotation = { r[0], r[1], r[2], 0, r[3], r[4], r[5], 0, r[6], r[7], r[8], 0 };
    dGeomSetRotation(p->geom, rotation);
    dGeomSetPosition(p->geom, at[0], at[1], at[2]);
}

static void make(void)
{
    geom_make(&a);
    geom_make(&b);
}

static void query(void)
{
    dContactGeom contact;
    geom_place(&a);
    geom_place(&b);
    dCollide(a.geom, b.geom, 1, &contact, sizeof contact);
}

int main(int argc, char **argv)
{
    static const int kinds[] = { SHAPE_SPHERE, SHAPE_CAPSULE, SHAPE_BOX, SHAPE_CYLINDER, SHAPE_POLYTOPE, KIND_TRIANGLE,
                                 KIND_PLATE };
    if (argc != 3) {
        fprintf(stderr, "usage: ode_static SEED POSES\n");
        return 2;
    }
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    print_library();
    uniform_seed(strtoull(argv[1], NULL, 10));
    printf("poses queried %ld\n", pose_all(kinds, sizeof kinds / sizeof kinds[0], atol(argv[2]), &a.body, &b.body, make, query));
    dCloseODE();
    return 0;
}
