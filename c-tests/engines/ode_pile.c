/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A simulation in ODE. Under compare.sh, which counts its queries, ODE's contacts of every 20th step are
 * judged by exact truth; without it no pair is.
 *
 * usage: ode_pile SEED STEPS BODIES SCENE   (scene_run of ode_scene.h) */

#include "engines/ode_scene.h"
#include "tools/compare/hooks.h"

static scene_t scene;
static unsigned long queries;  /* counted so far */
static int invalid_support;    /* a callback was wrong in the query that is judged next */

/* A depth or gap below this is neither hit nor miss: ten times ODE's tolerance. */
static const double CONTACT_EPS = 1e-5;

static shape_t shape_of(int i) { return ode_shape(&scene.shape[i], scene.geom[i]); }

/* Finds the body by the object's centre. */
void compare_audit(const void *obj, ccd_center_fn center, const ccd_vec3_t *dir, ccd_vec3_t *v)
{
    ccd_vec3_t centre;
    if (scene.pile.step % 20)
        return;
    center(obj, &centre);
    for (int i = 0; i < scene.bodies; i++) {
        const dReal *p = dGeomGetPosition(scene.geom[i]);
        if (p[0] == centre.v[0] && p[1] == centre.v[1] && p[2] == centre.v[2]) {
            const shape_t s = shape_of(i);
            double point[3];
            invalid_support |= !(support_error(&s, dir, v, point) < 1e-10 * scene.half_width);
            return;
        }
    }
}

/* Judges pairs that ODE queried libccd for. */
static void judge(int a, int b, const dContact *contact, int contacts)
{
    double deepest = 0;
    if (compare_queries() == queries)
        return;
    queries = compare_queries();
    if (scene.pile.step % 20)
        return;
    const shape_t sa = shape_of(a), sb = shape_of(b);
    const truth_t t = truth_depth_within(&sa, &sb, 1e-7);
    const verdict_truth_t truth = { t.lower, t.depth, 1e-6, CONTACT_EPS };
    for (int i = 0; i < contacts; i++)
        deepest = fmax(deepest, contact[i].geom.depth);
    tally_add(&tally[invalid_support], &truth, contacts > 0, deepest, 1);
    invalid_support = 0;
}

int main(int argc, char **argv)
{
    dInitODE2(0);
    scene_on_pair = judge;
    scene_run(&scene, argc, argv);
    tally_report();
    dCloseODE();
    return 0;
}
