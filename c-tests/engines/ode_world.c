/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* An ODE world whose geoms this library collides: a class of ODE's dCreateGeomClass, with a
 * state for each pair, and one contact a pair or those of ccdContacts. Scenes and starts are
 * those of ode_pile.c; prints the same about energy and depth.
 *
 * usage: ode_world SEED STEPS BODIES pile|hulls|stack|roll one|many */

#include "engines/ode_scene.h"

#include <ccd/warm.h>

static scene_t scene;
static int convex;                 /* the class */
static ccd_warm_t warm[SCENE_BODIES][SCENE_BODIES];
static ccd_manifold_cache_t memory[SCENE_BODIES][SCENE_BODIES];
static int most = 1;               /* contacts of a pair */
static unsigned long queries, supports, limits;

/* How far below its face a corner may be and still carry: the layer that ODE lets contacts
 * sink into. */
static const double SLOP = 1e-3;

static void aabb(dGeomID geom, dReal box[6])
{
    const shape_t s = scene_shape_of(*(const scene_shape_t **)dGeomGetClassData(geom), geom);
    for (int k = 0; k < 3; k++)
        for (int side = 0; side < 2; side++) {
            ccd_vec3_t dir = {{0, 0, 0}}, v;
            dir.v[k] = side ? 1 : -1;
            shape_support(&s, &dir, &v);
            box[2 * k + side] = v.v[k];
        }
}

/* ODE's normal is the way the first body leaves. */
static int collide(dGeomID o1, dGeomID o2, int flags, dContactGeom *out, int skip)
{
    const int i = (int)(intptr_t)dGeomGetData(o1), j = (int)(intptr_t)dGeomGetData(o2);
    const int room = flags & 0xffff, max = room < most ? room : most;
    shape_t a = scene_shape_of(*(const scene_shape_t **)dGeomGetClassData(o1), o1);
    shape_t b = scene_shape_of(*(const scene_shape_t **)dGeomGetClassData(o2), o2);
    ccd_contact_t contact[8];
    ccd_penetration_t hit;
    int n, written = 0, code;
    ccd_t ccd = shape_query();
    ccd.mpr_tolerance = 1e-6; /* as ODE's */
    /* The pair's state, whichever order the broad phase hands the two over in. */
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

static dGeomID make(const scene_shape_t *s)
{
    const dGeomID geom = dCreateGeom(convex);
    *(const scene_shape_t **)dGeomGetClassData(geom) = s;
    return geom;
}

int main(int argc, char **argv)
{
    dGeomClass class = { sizeof(const scene_shape_t *), collider, aabb, NULL, NULL };
    if (argc != 6) {
        fprintf(stderr, "usage: ode_world SEED STEPS BODIES pile|hulls|stack|roll one|many\n");
        return 2;
    }
    most = strcmp(argv[5], "many") ? 1 : 8;
    dInitODE2(0);
    convex = dCreateGeomClass(&class);
    scene_make_geom = make;
    run(&scene, argv);
    printf(" limits %lu\n", limits);
    printf("watched queries %lu supports %lu\n", queries, supports);
    dCloseODE();
    return 0;
}
