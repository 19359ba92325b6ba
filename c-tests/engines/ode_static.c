/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* ODE's dCollide over random pairs of every kind of geometry that it queries libccd for, judged by
 * their certified depth (pose_all of poses.h).
 *
 * usage: ode_static SEED POSES asis|corrected   (POSES placed pairs of each two kinds)
 *   corrected: wrong support points of ODE's callbacks are replaced by right ones */

#include "engines/ode_shapes.h"
#include "tools/compare/counts.h"
#include "harness/identity.h"

/* ODE refers to all of it while the geometry lives. */
typedef struct {
    body_t body;
    dGeomID geom;
    dTriMeshDataID mesh;
    dTriIndex index[6];
} placed_t;

static placed_t a, b;

static int corrected;
static double support_off; /* the largest error of a support value of this query, metres */

/* The first query of a dCollide. */
static struct {
    int queries, hit;
    double depth, length;
} first;

void compare_queried(int call, int hit, double depth, double length)
{
    (void)call;
    if (first.queries++)
        return;
    first.hit = hit;
    first.depth = depth;
    first.length = length;
}

void compare_audit(const void *obj, ccd_center_fn center, const ccd_vec3_t *dir, ccd_vec3_t *v)
{
    ccd_vec3_t centre;
    const placed_t *p;
    const double *at;
    double point[3];
    if (first.queries)
        return;
    center(obj, &centre);
    /* a's centre is where a is; that of a triangle is where ODE puts it */
    at = a.body.shape.pos;
    p = hypot(hypot(at[0] - centre.v[0], at[1] - centre.v[1]), at[2] - centre.v[2]) < 1e-12 ? &a : &b;
    const double off = support_error(&p->body.shape, dir, v, point);
    if (corrected && off > 1e-10 * pair_size(&a.body.shape, &b.body.shape))
        ccdVec3Set(v, point[0], point[1], point[2]);
    else
        support_off = fmax(support_off, off);
}

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

static void query(const pose_truth_t *pose)
{
    dContactGeom contact;
    geom_place(&a);
    geom_place(&b);
    support_off = 0;
    first.queries = 0;
    int hit = dCollide(a.geom, b.geom, 1, &contact, sizeof contact);
    if (!first.queries)
        return; /* not libccd's */
    /* ODE turns a triangle that touches a little and queries it again, four times: the
     * first result is that of this pose. */
    if (b.body.kind == KIND_TRIANGLE)
        pose_judge(&a.body, &b.body, pose, support_off, first.hit, first.depth, first.length);
    else
        pose_judge(&a.body, &b.body, pose, support_off, hit, hit ? contact.depth : 0,
                   hit ? dCalcVectorLength3(contact.normal) : 0);
}

int main(int argc, char **argv)
{
    static const int kinds[] = { SHAPE_SPHERE, SHAPE_CAPSULE, SHAPE_BOX, SHAPE_CYLINDER, SHAPE_POLYTOPE, KIND_TRIANGLE,
                                 KIND_PLATE };
    if (argc != 4) {
        fprintf(stderr, "usage: ode_static SEED POSES asis|corrected\n");
        return 2;
    }
    corrected = !strcmp(argv[3], "corrected");
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    print_library();
    uniform_seed(strtoull(argv[1], NULL, 10));
    pose_all(kinds, sizeof kinds / sizeof kinds[0], atol(argv[2]), &a.body, &b.body, make, query);
    dCloseODE();
    return 0;
}
