/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* ODE's dCollide over random pairs of every kind of geometry that it hands to libccd, held
 * against their truth (pose_all of poses.h): apart where ODE's own callback gave a point that is
 * not a support point.
 *
 * usage: ode_static SEED POSES asis|corrected   (POSES placed pairs of each two kinds)
 *   corrected: such points are replaced by the right ones */

#include "engines/poses.h"

#include "tools/compare/hooks.h"
#include "harness/identity.h"

#include <ode/ode.h>

/* Where ODE keeps looking while a geometry lives. */
typedef struct {
    body_t body;
    dGeomID geom;
    dTriMeshDataID mesh;
    double vertex[9];
    dTriIndex index[6];
} placed_t;

static placed_t a, b;

static int corrected, callback_wrong;

/* The first query that one dCollide makes. */
static struct {
    int answered, hit;
    double depth, length;
} first;

void compare_answered(int call, int hit, double depth, double length)
{
    (void)call;
    if (first.answered++)
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
    if (first.answered)
        return;
    center(obj, &centre);
    /* a's centre is where a is; that of a triangle is where ODE puts it */
    at = a.body.shape.pos;
    p = hypot(hypot(at[0] - centre.v[0], at[1] - centre.v[1]), at[2] - centre.v[2]) < 1e-12 ? &a : &b;
    if (right_point(&p->body.shape, dir, v, point) < 1e-10 * pair_size(&a.body.shape, &b.body.shape))
        return;
    if (corrected)
        ccdVec3Set(v, point[0], point[1], point[2]);
    else
        callback_wrong = 1;
}

static void geom_make(placed_t *p)
{
    const body_t *b = &p->body;
    const double *s = b->shape.p;
    p->mesh = NULL;
    switch (b->kind) {
    case SHAPE_SPHERE: p->geom = dCreateSphere(NULL, s[0]); break;
    case SHAPE_CAPSULE: p->geom = dCreateCapsule(NULL, s[0], 2 * s[1]); break;
    case SHAPE_BOX:
    case KIND_PLATE: p->geom = dCreateBox(NULL, 2 * s[0], 2 * s[1], 2 * s[2]); break;
    case SHAPE_CYLINDER: p->geom = dCreateCylinder(NULL, s[0], 2 * s[1]); break;
    case SHAPE_POLYTOPE:
        p->geom = dCreateConvex(NULL, b->hull.plane, (unsigned)b->hull.faces, b->hull.vertex, (unsigned)b->hull.vertices, b->hull.polygon);
        break;
    default:
        /* ODE cannot have a mesh of one triangle: the other is its back */
        memcpy(p->vertex, b->hull.vertex, 9 * sizeof(double));
        for (int i = 0; i < 6; i++)
            p->index[i] = (dTriIndex)(i < 3 ? i : 5 - i);
        p->mesh = dGeomTriMeshDataCreate();
        dGeomTriMeshDataBuildDouble(p->mesh, p->vertex, 3 * sizeof(double), 3, p->index, 6, 3 * sizeof(dTriIndex));
        dGeomTriMeshDataPreprocess2(p->mesh, 1U << dTRIDATAPREPROCESS_BUILD_FACE_ANGLES, NULL);
        p->geom = dCreateTriMesh(NULL, p->mesh, NULL, NULL, NULL);
        break;
    }
}

static void geom_place(placed_t *p)
{
    const double *r = p->body.shape.rot;
    dMatrix3 m;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            m[4 * i + j] = r[3 * i + j];
        m[4 * i + 3] = 0;
    }
    dGeomSetRotation(p->geom, m);
    dGeomSetPosition(p->geom, p->body.shape.pos[0], p->body.shape.pos[1], p->body.shape.pos[2]);
}

static void geom_free(placed_t *p)
{
    if (p->geom)
        dGeomDestroy(p->geom);
    if (p->mesh)
        dGeomTriMeshDataDestroy(p->mesh);
}

static void make(void)
{
    geom_free(&a);
    geom_free(&b);
    geom_make(&a);
    geom_make(&b);
}

static void ask(const known_t *known)
{
    dContactGeom contact;
    geom_place(&a);
    geom_place(&b);
    callback_wrong = 0;
    first.answered = 0;
    int hit = dCollide(a.geom, b.geom, 1, &contact, sizeof contact);
    if (!first.answered)
        return; /* not libccd's */
    /* A triangle that touches is turned a little and asked about again, four times: the
     * first answer is the one about this pose. */
    if (b.body.kind == KIND_TRIANGLE)
        pose_judge(&a.body, &b.body, known, callback_wrong, first.hit, first.depth, first.length);
    else
        pose_judge(&a.body, &b.body, known, callback_wrong, hit, hit ? contact.depth : 0,
                   hit ? dCalcVectorLength3(contact.normal) : 0);
}

int main(int argc, char **argv)
{
    static const int kinds[] = { SHAPE_SPHERE, SHAPE_CAPSULE, SHAPE_BOX, SHAPE_CYLINDER, SHAPE_POLYTOPE, KIND_TRIANGLE, KIND_PLATE };
    if (argc != 4) {
        fprintf(stderr, "usage: ode_static SEED POSES asis|corrected\n");
        return 2;
    }
    corrected = !strcmp(argv[3], "corrected");
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    print_library();
    uniform_seed(strtoull(argv[1], NULL, 10));
    pose_all(kinds, sizeof kinds / sizeof kinds[0], atol(argv[2]), &a.body, &b.body, make, ask);
    dCloseODE();
    return 0;
}
