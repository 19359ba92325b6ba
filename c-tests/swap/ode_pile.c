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
 *
 * usage: ode_pile SEED STEPS BODIES pile|hulls|stack|roll */

#include "swap/ode_shape.h"
#include "swap/callback_errors.h"

static void audit(const void *obj, const ccd_vec3_t *dir, const ccd_vec3_t *v);
#define WATCH_ANSWER(obj, dir, v) audit(obj, dir, v)
#include "swap/interpose.h"

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
static void audit(const void *obj, const ccd_vec3_t *dir, const ccd_vec3_t *v)
{
    ccd_vec3_t centre;
    int i;
    if (!scene.on_pair)
        return;
    watch_centre(obj, &centre);
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
    if (watched.queries == all->queries)
        return;
    all->queries = watched.queries;
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
    double kinetic = 0, depth = 0, deepest = 0, least = HUGE_VAL, gained = 0;
    long step, contacts = 0;
    int escaped = 0;
    if (argc != 5) {
        fprintf(stderr, "usage: ode_pile SEED STEPS BODIES pile|hulls|stack|roll\n");
        return 2;
    }
    const unsigned long seed = strtoul(argv[1], NULL, 10);
    const long steps = atol(argv[2]);
    const int bodies = atoi(argv[3]);
    const char *name = argv[4];
    dInitODE2(0);
    watch_library();
    scene_world(&scene, 11);
    if (!strcmp(name, "stack")) {
        scene_stack(&scene, (bodies + 4) / 5, 0.8);
    } else if (!strcmp(name, "roll")) {
        scene_roll(&scene, bodies, 1.5);
    } else {
        int i;
        for (i = 0; i < 4 && !strcmp(name, "hulls"); i++)
            scene.kinds[i] = SCENE_HULL;
        scene_pile(&scene, bodies, 0.55, 0.33);
    }
    scene_nudge(&scene, seed, !strcmp(name, "pile") || !strcmp(name, "hulls") ? 1e-3 : 1e-5);
    scene.user = &found;
    for (step = 0; step < steps; step++) {
        double height, energy, moving;
        scene.on_pair = step % 20 ? NULL : judge;
        found.queries = watched.queries;
        scene_step(&scene, 0.005);
        escaped |= scene_escaped(&scene);
        deepest = fmax(deepest, scene.depth_max);
        moving = scene_energy(&scene, &height);
        energy = moving + height;
        least = fmin(least, energy);
        gained = fmax(gained, energy - least);
        if (2 * step >= steps) {
            kinetic += moving / (double)(steps - steps / 2);
            depth += scene.depth_sum;
            contacts += scene.contact_count;
        }
    }
    printf("pile kinetic %.9g depth %.9g deepest %.9g contacts %ld escaped %d bad %ld gained %.9g judged %ld lost %ld spurious %ld off %ld error %.9g "
           "wrong %ld wrong_lost %ld wrong_spurious %ld wrong_error %.9g\n",
           kinetic, contacts ? depth / (double)contacts : 0, deepest, contacts, escaped, scene.bad_contacts, gained, found.right.judged,
           found.right.lost, found.right.spurious, found.right.off, found.right.error, found.wrong.judged, found.wrong.lost, found.wrong.spurious,
           found.wrong.error);
    watch_report();
    scene_free(&scene);
    dCloseODE();
    return 0;
}
