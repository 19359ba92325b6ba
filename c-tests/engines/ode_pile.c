/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A simulation in ODE, from a start that is moved by up to 1e-3 m a coordinate, by
 * a stream named SEED. Prints what the second half of the run looked like and,
 * of every 20th step, what ODE made of its pairs against the truth: under compare.sh, which
 * counts its queries. Without it no pair is judged. Scenes:
 *
 *   pile   boxes, cylinders, capsules and hulls fall into a pen and come to rest
 *   hulls  convex hulls alone
 *   stack  towers of flat boxes, ODE's own and hulls by turns
 *   roll   cylinders roll to and fro on the floor
 *   tower  one tower of flat hulls, stacked exactly; not moved
 *
 * usage: ode_pile SEED STEPS BODIES pile|hulls|stack|roll|tower */

#include "engines/ode_scene.h"
#include "engines/tally.h"

#include "tools/compare/hooks.h"

static scene_t scene;
static unsigned long queries;  /* watched so far */
static int astray;             /* a callback was wrong in the query that is judged next */
static tally_t tally[2];       /* the second: of those; only pairs that ODE put to libccd */

/* A depth or gap below this is neither: ten times ODE's tolerance. */
static const double LOST = 1e-5;

static shape_t shape_of(int i) { return scene_shape_of(&scene.shape[scene.shape_of[i]], scene.geom[i]); }

/* The object's centre tells which body it is. */
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
            astray |= !(right_point(&s, dir, v, point) < 1e-10 * scene.half_width);
            return;
        }
    }
}

static void judge(int a, int b, const dContact *contact, int contacts)
{
    verdict_truth_t truth = { 0, 0, 1e-6, LOST };
    double deepest = 0;
    if (compare_queries() == queries)
        return;
    queries = compare_queries();
    if (scene.pile.step % 20)
        return;
    shape_t sa = shape_of(a);
    shape_t sb = shape_of(b);
    truth_t t = truth_depth_within(&sa, &sb, 1e-7);
    truth.lower = t.lower;
    truth.upper = t.depth;
    for (int i = 0; i < contacts; i++)
        deepest = fmax(deepest, contact[i].geom.depth);
    tally_add(&tally[astray], &truth, contacts > 0, deepest, 1);
    astray = 0;
}

int main(int argc, char **argv)
{
    if (argc != 5) {
        fprintf(stderr, "usage: ode_pile SEED STEPS BODIES pile|hulls|stack|roll|tower\n");
        return 2;
    }
    dInitODE2(0);
    scene_on_pair = judge;
    run(&scene, argv);
    printf("\n");
    tally_print("right", &tally[0]);
    tally_print("astray", &tally[1]);
    dCloseODE();
    return 0;
}
