/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* An ODE world whose geometries this library collides: a class of dCreateGeomClass, with a
 * state for each pair, and one contact a pair or those of ccdContacts.
 *
 * usage: ode_world one|many SEED STEPS BODIES SCENE   (scene_run of ode_scene.h) */

#include "engines/ode_scene.h"

#include <ccd/warm.h>

static scene_t scene;
static int convex;                 /* the class */
static ccd_warm_t warm[SCENE_BODIES][SCENE_BODIES];
static ccd_manifold_cache_t memory[SCENE_BODIES][SCENE_BODIES];
static int most = 1;               /* contacts of a pair */
static unsigned long queries, supports, limits;

/* Distance of a corner from its face that still is a contact: the layer that ODE lets contacts
 * sink into. */
static const double SLOP = 1e-3;

static shape_t shape_of(dGeomID geom) { return ode_shape(*(const body_t **)dGeomGetClassData(geom), geom); }

static void aabb(dGeomID geom, dReal box[6])
{
    const shape_t s = shape_of(geom);
    for (int k = 0; k < 3; k++)
        for (int side = 0; side < 2; side++) {
            ccd_vec3_t dir = {{0, 0, 0}}, v;
            dir.v[k] = side ? 1 : -1;
            shape_support(&s, &dir, &v);
            box[2 * k + side] = v.v[k];
        }
}

/* The first body leaves along ODE's normal. */
static int collide(dGeomID o1, dGeomID o2, int flags, dContactGeom *out, int skip)
{
    const int i = (int)(intptr_t)dGeomGetData(o1), j = (int)(intptr_t)dGeomGetData(o2);
    const int room = flags & 0xffff, max = room < most ? room : most;
    shape_t a = shape_of(o1), b = shape_of(o2);
    ccd_contact_t contact[8];
    ccd_penetration_t hit;
    int n, written = 0, code;
    ccd_t ccd = shape_query();
    ccd.mpr_tolerance = 1e-6; /* as ODE's */
    /* One state for both orders of the pair. */
    if (i > j)
        ccdWarmFlip(&warm[j][i]);
    code = ccdPenetrationLocal(&a, &b, &ccd, i < j ? &warm[i][j] : &warm[j][i],
                               max > 1 ? 0 : CCD_WANT_POS, &hit);
    if (i > j)
        ccdWarmFlip(&warm[j][i]);
    queries++;
    limits += code == CCD_LIMIT;
    if (code != CCD_HIT && code != CCD_LIMIT)
        return 0;
    contact[0].point1 = contact[0].point2 = hit.pos;
    contact[0].depth = hit.depth;
    n = max > 1 ? ccdContacts(&a, &b, &ccd, &hit.normal, SLOP, i < j ? &memory[i][j] : &memory[j][i], contact, max) : 1;
    supports += a.calls;
    for (int k = 0; k < n; k++) {
        dContactGeom *g = (dContactGeom *)((char *)out + written * skip);
        if (!(contact[k].depth >= 0))
            continue;
        for (int m = 0; m < 3; m++) {
            g->pos[m] = 0.5 * (contact[k].point1.v[m] + contact[k].point2.v[m]);
            g->normal[m] = -hit.normal.v[m];
        }
        g->depth = contact[k].depth;
        g->g1 = o1;
        g->g2 = o2;
        g->side1 = g->side2 = -1;
        written++;
    }
    return written;
}

static dColliderFn *collider(int other) { return other == convex ? collide : NULL; }

static dGeomID make(const body_t *s)
{
    const dGeomID geom = dCreateGeom(convex);
    *(const body_t **)dGeomGetClassData(geom) = s;
    return geom;
}

int main(int argc, char **argv)
{
    dGeomClass class = { sizeof(const body_t *), collider, aabb, NULL, NULL };
    if (argc != 6) {
        fprintf(stderr, "usage: ode_world one|many SEED STEPS BODIES SCENE\n");
        return 2;
    }
    most = strcmp(argv[1], "many") ? 1 : 8;
    dInitODE2(0);
    convex = dCreateGeomClass(&class);
    scene_make_geom = make;
    scene_run(&scene, argc - 1, argv + 1);
    printf("own queries %lu supports %lu limits %lu\n", queries, supports, limits);
    dCloseODE();
    return 0;
}
