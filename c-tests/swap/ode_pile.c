/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A simulation in ODE, from a start that is moved by up to 1e-3 m a coordinate, by
 * a stream named SEED. Prints what the second half of the run looked like and,
 * of every 20th step, what ODE made of its pairs against the truth. Scenes:
 *
 *   pile   boxes, cylinders, capsules and hulls fall into a pen and come to rest
 *   hulls  convex hulls alone
 *   stack  towers of flat boxes, ODE's own and hulls by turns
 *   roll   cylinders roll to and fro on the floor
 *   tower  one tower of flat hulls, stacked exactly; not moved
 *
 * usage: ode_pile SEED STEPS BODIES pile|hulls|stack|roll|tower */

#include "swap/ode_run.h"
#include "swap/ode_shape.h"
#include "swap/callback_errors.h"

#include "compare/hooks.h"
#include "harness/identity.h"

/* Contacts of one step against the truth; only of pairs that ODE put to libccd. */
typedef struct {
    long judged, lost, spurious;
    long off;     /* the deepest contact's depth is off by more than 1 % and twice ODE's tolerance */
    double error; /* the largest */
} judged_t;

typedef struct {
    const scene_t *scene;
    unsigned long queries; /* watched so far */
    int callback_wrong; /* in the query that is judged next */
    judged_t right, wrong; /* by that */
} judge_t;

static scene_t scene;
static judge_t found = { &scene, 0, 0, { 0, 0, 0, 0, 0 }, { 0, 0, 0, 0, 0 } };

/* A depth or gap below this is neither: ten times ODE's tolerance. */
static const double LOST = 1e-5;

static shape_t shape_of(const scene_t *scene, int i)
{
    return ode_shape(&scene->shape[scene->shape_of[i]], scene->geom[i]);
}

/* The object's centre tells which body it is. */
void compare_audit(const void *obj, ccd_center_fn center, const ccd_vec3_t *dir, ccd_vec3_t *v)
{
    ccd_vec3_t centre;
    int i;
    if (!scene.on_pair)
        return;
    center(obj, &centre);
    for (i = 0; i < scene.bodies; i++) {
        const dReal *p = dGeomGetPosition(scene.geom[i]);
        if (p[0] == centre.v[0] && p[1] == centre.v[1] && p[2] == centre.v[2]) {
            const shape_t s = shape_of(&scene, i);
            double point[3];
            found.callback_wrong |= !(right_point(&s, dir, v, point) < 1e-10 * scene.half_width);
            return;
        }
    }
}

static void judge(void *user, int a, int b, const dContact *contact, int contacts)
{
    judge_t *all = (judge_t *)user;
    judged_t *j = all->callback_wrong ? &all->wrong : &all->right;
    shape_t sa, sb;
    truth_t t;
    double deepest = 0;
    int i;
    if (compare_queries() == all->queries)
        return;
    all->queries = compare_queries();
    all->callback_wrong = 0;
    sa = shape_of(all->scene, a);
    sb = shape_of(all->scene, b);
    t = truth_depth_within(&sa, &sb, 1e-7);
    j->judged++;
    j->lost += !contacts && t.lower > LOST;
    j->spurious += contacts && t.depth < -LOST;
    for (i = 0; i < contacts; i++)
        deepest = fmax(deepest, contact[i].geom.depth);
    if (contacts && t.depth > 0) {
        const double error = fabs(deepest - t.depth);
        j->error = fmax(j->error, error);
        j->off += !(error <= 0.01 * t.depth + 2e-6);
    }
}

int main(int argc, char **argv)
{
    long step;
    if (argc != 5) {
        fprintf(stderr, "usage: ode_pile SEED STEPS BODIES pile|hulls|stack|roll|tower\n");
        return 2;
    }
    const unsigned long seed = strtoul(argv[1], NULL, 10);
    const long steps = atol(argv[2]);
    const int bodies = atoi(argv[3]);
    dInitODE2(0);
    tell_library();
    run_scene(&scene, argv[4], bodies, seed, steps);
    scene.user = &found;
    for (step = 0; step < steps; step++) {
        scene.on_pair = step % 20 ? NULL : judge;
        found.queries = compare_queries();
        run_step(&scene, step);
    }
    pile_report(&scene.pile);
    printf(" judged %ld lost %ld spurious %ld off %ld error %.9g wrong %ld wrong_lost %ld wrong_spurious %ld wrong_error %.9g\n",
           found.right.judged, found.right.lost, found.right.spurious, found.right.off, found.right.error, found.wrong.judged,
           found.wrong.lost, found.wrong.spurious, found.wrong.error);
    scene_free(&scene);
    dCloseODE();
    return 0;
}
