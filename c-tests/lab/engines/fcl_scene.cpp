/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Collides pairs of bodies by FCL, in poses that depend on no result:
 *
 *   yes-no     in a new random pose each frame, without contacts
 *   touching   overlapping by a thousandth of their size, rocking a little each frame
 *   through    drifting and turning in a closed room, through each other; pairs by FCL's broad phase
 *   random     in a new random pose each frame, with contacts
 *   mesh       each body in a new random pose each frame, against a mesh of TRIANGLES
 *
 * `primitives` are those pairs of box, sphere, capsule, cylinder, cone and ellipsoid for which FCL has no closed
 * form, `hulls` ellipsoids of 162 corners.
 *
 * Compiled plain, the narrow phase is FCL's own on the loaded libccd; with BY_HEADER, that of <ccd/fcl.hpp>, whose
 * states are kept but for random poses. With TIMED the narrow phase is timed: processor time. Else every pair is judged
 * by the proven minimum of this library, and every EXACTth by truth.h as well.
 *
 * usage: fcl_scene CONTACTS USE BODIES FRAMES COUNT EXACT   (CONTACTS: at most so many of a pair, with BY_HEADER) */

#include "engines/fcl_shapes.h"
#include "harness/identity.h"
#include "harness/this_library.h"
#include "harness/verdict.h"
#ifdef BY_HEADER
#include <ccd/fcl.hpp>
#endif

#include <string>
#include <utility>
#include <vector>

typedef fcl::CollisionObjectd object;

static const double TOLERANCE = 1e-6; /* FCL's */

/* --- the scene -------------------------------------------------------------------- */

struct moving_t {
    body_t body;
    std::vector<ccd_real_t> corners; /* of a hull */
    vec at, velocity, spin;
    Eigen::Quaterniond turn;
};

/* Makes an ellipsoid of ten rings of sixteen corners and two poles, whose faces hull_t has no room for. */
static geometry make_hull(moving_t &m)
{
    enum { RINGS = 10, SIDES = 16, POLE = RINGS * SIDES };
    const double pi = 3.14159265358979323846, r[3] = {uniform(0.05, 0.5), uniform(0.05, 0.5), uniform(0.05, 0.5)};
    auto faces = std::make_shared<std::vector<int>>();
    for (int i = 0; i < POLE; i++) {
        const double down = pi * (i / SIDES + 1) / (RINGS + 1), around = 2 * pi * (i % SIDES) / SIDES;
        const int next = i / SIDES * SIDES + (i + 1) % SIDES;
        for (double v : {r[0] * sin(down) * cos(around), r[1] * sin(down) * sin(around), r[2] * cos(down)})
            m.corners.push_back(v);
        if (i < SIDES)
            faces->insert(faces->end(), {3, POLE, i, next});
        if (i < POLE - SIDES)
            faces->insert(faces->end(), {4, i, i + SIDES, next + SIDES, next});
        else
            faces->insert(faces->end(), {3, POLE + 1, next, i});
    }
    m.corners.insert(m.corners.end(), {0, 0, r[2], 0, 0, -r[2]});
    m.body.kind = SHAPE_POLYTOPE;
    m.body.shape = shape_polytope(m.corners.data(), POLE + 2);
    return std::make_shared<fcl::Convexd>(fcl_vertices(m.body.shape), RINGS * SIDES + SIDES, faces, true);
}

/* Returns whether FCL collides these kinds without libccd. */
static bool has_closed_form(int a, int b)
{
    const auto is_one_of = [](int kind, std::initializer_list<int> kinds) {
        return std::count(kinds.begin(), kinds.end(), kind) > 0;
    };
    const std::initializer_list<int> of_sphere = {SHAPE_SPHERE, SHAPE_BOX, SHAPE_CAPSULE, SHAPE_CYLINDER};
    return (a == SHAPE_BOX && b == SHAPE_BOX) || (a == SHAPE_SPHERE && is_one_of(b, of_sphere))
           || (b == SHAPE_SPHERE && is_one_of(a, of_sphere));
}

/* A square of random heights, 0.25 m a cell. */
struct terrain_t {
    enum { CELLS = 8, TRIANGLES = 2 * CELLS * CELLS };
    double half_width = 0.125 * CELLS;
    ccd_real_t corners[TRIANGLES][9];
    std::shared_ptr<fcl::BVHModel<fcl::OBBRSSd>> mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();

    terrain_t()
    {
        vec points[CELLS + 1][CELLS + 1];
        for (int i = 0; i <= CELLS; i++)
            for (int j = 0; j <= CELLS; j++)
                points[i][j] = vec(0.25 * i - half_width, 0.25 * j - half_width, uniform(-0.05, 0.05));
        mesh->beginModel();
        for (int t = 0; t < TRIANGLES; t++) {
            const int i = t / 2 / CELLS, j = t / 2 % CELLS, upper = t % 2;
            const vec p[3] = {points[i][j], points[i + 1][j + upper], points[i + upper][j + 1]};
            for (int k = 0; k < 9; k++)
                corners[t][k] = p[k / 3][k % 3];
            mesh->addTriangle(p[0], p[1], p[2]);
        }
        mesh->endModel();
    }
};

struct scene_t {
    const std::string use;
    const bool is_random; /* a new pose each frame */
    std::vector<moving_t> bodies;
    std::vector<object> objects;
    std::vector<std::pair<object *, object *>> pairs; /* of this frame */
    fcl::DynamicAABBTreeCollisionManagerd manager;    /* of `through` */
    std::unique_ptr<terrain_t> terrain;               /* of `mesh` */
    std::unique_ptr<object> ground;
    double half_width;

    /* `count` bodies that drift or fall on the mesh, or pairs */
    scene_t(const std::string &use, bool hulls, size_t count)
        : use(use), is_random(use != "through" && use != "touching"),
          bodies(use == "through" || use == "mesh" ? count : 2 * count),
          half_width(0.55 * cbrt((double)count)) /* a third of the bodies overlap another, for any number */
    {
        static const int kinds[] = {SHAPE_BOX, SHAPE_SPHERE, SHAPE_CAPSULE, SHAPE_CYLINDER, SHAPE_CONE, SHAPE_ELLIPSOID};
        int next = 0; /* pair of kinds */
        uniform_seed(14);
        objects.reserve(bodies.size());
        for (moving_t &m : bodies) {
            const size_t i = (size_t)(&m - &bodies[0]);
            if (is_in_pairs() && i % 2 == 0)
                do
                    next = (next + 1) % 36;
                while (has_closed_form(kinds[next / 6], kinds[next % 6]));
            /* FCL has a closed form for spheres and triangles. */
            const int any = kinds[i % 6] == SHAPE_SPHERE && use == "mesh" ? SHAPE_BOX : kinds[i % 6];
            if (!hulls)
                body_random(&m.body, is_in_pairs() ? kinds[i % 2 ? next / 6 : next % 6] : any);
            objects.emplace_back(hulls ? make_hull(m) : fcl_geometry(m.body));
            objects.back().setUserData(&m.body);
        }
        if (use == "mesh") {
            terrain.reset(new terrain_t);
            ground.reset(new object(terrain->mesh));
        }
        for (size_t i = 0; i < bodies.size(); i++)
            start(i);
        if (use == "through") {
            for (object &o : objects)
                manager.registerObject(&o);
            manager.setup();
        }
        move(0);
    }

    bool is_in_pairs() const { return use != "through" && use != "mesh"; }

    /* Places a body that keeps its pose. */
    void start(size_t i)
    {
        moving_t &m = bodies[i];
        m.at = vec(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)) * half_width;
        m.velocity = vec(uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(-0.5, 0.5));
        m.spin = vec(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
        m.turn = random_turn();
        if (use == "touching" && i % 2 == 1) {
            pose_truth_t pose;
            pose_overlapping(&bodies[i - 1].body, &m.body, &pose);
            pose_at_depth(&m.body, &pose, fmin(1e-3 * pose.size, pose.upper));
            for (moving_t *body : {&bodies[i - 1], &m}) {
                const fcl::Transform3d placed = fcl_pose(body->body.shape);
                body->at = placed.translation();
                body->turn = Eigen::Quaterniond(placed.linear());
            }
        }
    }

    static Eigen::Quaterniond random_turn()
    {
        double q[4];
        uniform_rotation(q);
        return Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    }

    void place(size_t i, const vec &at, const Eigen::Quaterniond &turn)
    {
        const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> matrix = turn.toRotationMatrix();
        shape_t &shape = bodies[i].body.shape;
        shape_turn(&shape, matrix.data());
        shape_move(&shape, at[0], at[1], at[2]);
        objects[i].setTransform(fcl_pose(shape));
        objects[i].computeAABB();
    }

    void drift(size_t i, double dt)
    {
        moving_t &m = bodies[i];
        m.at += dt * m.velocity;
        for (int k = 0; k < 3; k++)
            if (fabs(m.at[k]) > half_width)
                m.velocity[k] = -copysign(m.velocity[k], m.at[k]);
        m.turn = (Eigen::Quaterniond(Eigen::AngleAxisd(dt * m.spin.norm(), m.spin.normalized())) * m.turn).normalized();
        place(i, m.at, m.turn);
    }

    /* Tilts a body about its center by up to a milliradian, and shifts it by up to a tenth of the depth. */
    void rock(size_t i)
    {
        const double depth = 1e-3 * pair_size(&bodies[i].body.shape, &bodies[i - 1].body.shape);
        const vec shift(uniform(-0.1, 0.1), uniform(-0.1, 0.1), uniform(-0.1, 0.1)), axis(uniform(-1, 1), uniform(-1, 1), 1);
        const Eigen::Quaterniond tilt(Eigen::AngleAxisd(uniform(-1e-3, 1e-3), axis.normalized()));
        place(i, bodies[i].at + depth * shift, tilt * bodies[i].turn);
    }

    void move(double dt)
    {
        pairs.clear();
        for (size_t i = 0; i < bodies.size(); i++) {
            const double reach = shape_reach(&bodies[i].body.shape) + shape_reach(&bodies[i - i % 2].body.shape);
            const vec anywhere = vec(uniform(-0.7, 0.7), uniform(-0.7, 0.7), uniform(-0.7, 0.7));
            if (use == "through")
                drift(i, dt);
            else if (use == "mesh")
                place(i, anywhere.cwiseProduct(vec(1, 1, 0.3)) * terrain->half_width, random_turn());
            else if (i % 2 == 0)
                place(i, is_random ? vec(0, 0, 0) : bodies[i].at, is_random ? random_turn() : bodies[i].turn);
            else if (is_random)
                place(i, anywhere * reach, random_turn());
            else
                rock(i);
            if (use == "mesh")
                pairs.emplace_back(ground.get(), &objects[i]);
            else if (i % 2 == 1 && use != "through")
                pairs.emplace_back(&objects[i - 1], &objects[i]);
        }
        if (use == "through") {
            manager.update();
            manager.collide(this, add_pair);
        }
    }

    static bool add_pair(object *a, object *b, void *scene)
    {
        if (!has_closed_form(((body_t *)a->getUserData())->kind, ((body_t *)b->getUserData())->kind))
            ((scene_t *)scene)->pairs.emplace_back(a, b);
        return false;
    }
};

/* --- the two narrow phases ---------------------------------------------------------- */

#ifdef BY_HEADER
static ccd_fcl::PairCache cache;
static ccd_fcl::Settings settings;
#endif

/* Not inlined: callgrind counts its instructions. */
__attribute__((noinline)) static void collide(const scene_t &scene, size_t pair, fcl::CollisionResultd &result)
{
    const bool contacts = scene.use != "yes-no";
    const fcl::CollisionRequestd request(contacts ? 1000 : 1, contacts, 1, false, true, fcl::GST_LIBCCD, TOLERANCE);
#ifdef BY_HEADER
    ccd_fcl::collide(scene.pairs[pair].first, scene.pairs[pair].second, request, result, cache, settings);
#else
    fcl::collide(scene.pairs[pair].first, scene.pairs[pair].second, request, result);
#endif
}

static void end_frame(const scene_t &scene)
{
#ifdef BY_HEADER
    if (scene.is_random)
        cache.clear();
    else
        cache.next_frame();
#endif
    (void)scene;
}

#ifdef TIMED

static void run(scene_t &scene, long frames, long)
{
    double seconds = 0;
    size_t pairs = 0, contacts = 0;
    for (long frame = 0; frame < frames; frame++) {
        const double start = thread_seconds();
        for (size_t i = 0; i < scene.pairs.size(); i++) {
            fcl::CollisionResultd result;
            collide(scene, i, result);
            contacts += result.numContacts();
        }
        end_frame(scene);
        seconds += thread_seconds() - start;
        pairs += scene.pairs.size();
        scene.move(1.0 / 60);
    }
    printf("timed pairs %zu contacts %zu seconds %.6f\n", pairs, contacts, seconds);
    printf("processor seconds %.6f\n", (double)clock() / CLOCKS_PER_SEC);
}

#else

static struct {
    long pairs, exact, contacts, hits, wrong[VERDICTS];
    long off; /* hits beyond what ccdMPRPenetration guarantees: 0.1 % and a tolerance */
} judged;

/* Judges a depth; NaN: a miss. */
static void judge(const shape_t &a, const shape_t &b, double depth, bool has_depth, long every)
{
    const double size = pair_size(&a, &b);
    ccd_penetration_t least;
    ccd_t ccd = shape_query();
    ccd.center1 = ccd.center2 = NULL; /* the proof needs none */
    ccd.epa_tolerance = 1e-10;
    ccd.max_iterations = 5000;
    const int code = OURS(ccdPenetrationProven)(&a, &b, &ccd, NULL, CCD_WANT_ALL, &least);
    verdict_truth_t truth = {-HUGE_VAL, 0, TOLERANCE, 1e-9 * size};
    if (code == CCD_HIT || code == CCD_LIMIT) {
        truth.lower = least.depth_lower;
        truth.upper = least.depth;
    }
    if (judged.pairs++ % every == 0) {
        const truth_t t = truth_depth_within(&a, &b, 1e-8 * size);
        truth.lower = t.lower;
        truth.upper = t.depth;
        judged.exact++;
    }
    const verdict_answer_t answer = {!std::isnan(depth), has_depth, depth, 1};
    const verdict_t v = verdict(&answer, &truth);
    judged.wrong[v]++;
    judged.hits += answer.hit;
    judged.off += verdict_has_error(&answer, v)
                  && verdict_error(&answer, &truth) > fmax(TOLERANCE, 1e-3 * truth.upper) + truth.contact_eps;
}

static void judge_pair(const scene_t &scene, size_t pair, long every)
{
    const shape_t &b = ((body_t *)scene.pairs[pair].second->getUserData())->shape;
    fcl::CollisionResultd result;
    collide(scene, pair, result);
    judged.contacts += (long)result.numContacts();
    if (scene.use != "mesh") {
        double depth = NAN;
        for (size_t i = 0; i < result.numContacts(); i++)
            depth = fmax(depth, result.getContact(i).penetration_depth);
        judge(((body_t *)scene.pairs[pair].first->getUserData())->shape, b, depth, scene.use != "yes-no", every);
        return;
    }
    std::vector<double> depths(terrain_t::TRIANGLES, NAN);
    for (size_t i = 0; i < result.numContacts(); i++)
        depths[(size_t)result.getContact(i).b1] = result.getContact(i).penetration_depth;
    for (int i = 0; i < terrain_t::TRIANGLES; i++)
        judge(shape_polytope(scene.terrain->corners[i], 3), b, depths[(size_t)i], true, every);
}

static void run(scene_t &scene, long frames, long every)
{
    for (long frame = 0; frame < frames; frame++) {
        for (size_t i = 0; i < scene.pairs.size(); i++)
            judge_pair(scene, i, every);
        end_frame(scene);
        scene.move(1.0 / 60);
    }
    printf("judged pairs %ld exact %ld contacts %ld\n", judged.pairs, judged.exact, judged.contacts);
    const long *wrong = judged.wrong;
    printf("put hits %ld missed %ld spurious %ld broken %ld deep %ld unsound %ld off %ld\n", judged.hits, wrong[VERDICT_MISSED],
           wrong[VERDICT_SPURIOUS], wrong[VERDICT_INVALID], wrong[VERDICT_DEEP], wrong[VERDICT_UNSOUND], judged.off);
}

#endif

int main(int argc, char **argv)
{
    if (argc != 7) {
        fprintf(stderr, "usage: fcl_scene CONTACTS USE BODIES FRAMES COUNT EXACT\n");
        return 2;
    }
    print_library();
#ifdef BY_HEADER
    settings.contacts_per_pair = (size_t)atol(argv[1]);
#endif
    scene_t scene(argv[2], std::string(argv[3]) == "hulls", (size_t)atol(argv[5]));
    run(scene, atol(argv[4]), atol(argv[6]));
    return 0;
}
