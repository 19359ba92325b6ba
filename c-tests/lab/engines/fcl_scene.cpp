/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Collides pairs of bodies by FCL, in poses that depend on no result:
 *
 *   yes-no     in a new random pose each frame, without contacts
 *   touching   overlapping by a thousandth of their size, rocking a little each frame
 *   through    drifting to and fro through each other, and turning
 *   random     in a new random pose each frame, with contacts
 *
 * `primitives` are boxes, capsules, cylinders, cones and ellipsoids, but for pairs of boxes, for which FCL has a closed
 * form; `hulls` ellipsoids of 160 corners. `mesh` is a piece of terrain, 1 m wide, of 1,152 triangles and a primitive, `octree`
 * the same terrain as occupied cubes of 3 cm and a primitive, `octree-mesh` that and a piece of terrain.
 *
 * Compiled plain, the narrow phase is FCL's own on the loaded libccd; with BY_HEADER, that of <ccd/fcl.hpp>, whose
 * states are kept but for random poses. Prints its processor time.
 *
 * usage: fcl_scene CONTACTS USE BODIES FRAMES PAIRS MOST   (CONTACTS: at most so many of a convex pair, with BY_HEADER;
 * MOST: of a query) */

#include "engines/fcl_shapes.h"
#include "harness/identity.h"
#ifdef BY_HEADER
#include <ccd/fcl.hpp>
#endif

#include <string>
#include <vector>

typedef fcl::AngleAxis<double> angle_axis;

/* --- the scene -------------------------------------------------------------------- */

struct scene_pair {
    body_t body[2];
    std::unique_ptr<object> moved[2];
    fcl::Transform3d home; /* of the second body, of `touching` and `through` */
    vec along, spin;       /* of `through`: its way on either side, and radians a frame */
    double phase;
};

static vec random_vector(double size) { return vec(uniform(-size, size), uniform(-size, size), uniform(-size, size)); }

/* --- terrain ---------------------------------------------------------------------- */

enum { CELLS = 24 }; /* along each side of a square meter */

/* Writes random heights of the corners of the cells. */
static std::vector<vec> terrain()
{
    std::vector<vec> corners;
    const double a = uniform(3, 9), b = uniform(3, 9);
    for (int i = 0; i <= CELLS; i++)
        for (int k = 0; k <= CELLS; k++) {
            const double x = (double)i / CELLS - 0.5, y = (double)k / CELLS - 0.5;
            corners.push_back(vec(x, y, 0.1 * sin(a * x) * cos(b * y) + uniform(-0.01, 0.01)));
        }
    return corners;
}

static geometry terrain_mesh()
{
    const std::vector<vec> at = terrain();
    auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSS<double>>>();
    mesh->beginModel();
    for (int i = 0; i < CELLS; i++)
        for (int k = 0; k < CELLS; k++) {
            const size_t c = (size_t)(i * (CELLS + 1) + k), right = c + CELLS + 1;
            mesh->addTriangle(at[c], at[right], at[right + 1]);
            mesh->addTriangle(at[c], at[right + 1], at[c + 1]);
        }
    mesh->endModel();
    return mesh;
}

static geometry terrain_octree()
{
    auto tree = std::make_shared<octomap::OcTree>(0.03);
    for (const vec &v : terrain())
        tree->updateNode(octomap::point3d((float)v[0], (float)v[1], (float)v[2]), true);
    return std::make_shared<fcl::OcTree<double>>(std::shared_ptr<const octomap::OcTree>(tree));
}

/* Returns the terrain of a pair, if its body has one; the shape is a box around it. */
static geometry make_terrain(shape_t *shape, const std::string &bodies, int i)
{
    if (bodies == "primitives" || bodies == "hulls" || (i == 1 && bodies != "octree-mesh"))
        return nullptr;
    *shape = shape_box(0.5, 0.5, 0.15);
    return bodies == "mesh" || i == 1 ? terrain_mesh() : terrain_octree();
}

static void make_pair(scene_pair &p, const std::string &use, const std::string &bodies, size_t index)
{
    static const int kinds[] = {SHAPE_BOX, SHAPE_CAPSULE, SHAPE_CYLINDER, SHAPE_CONE, SHAPE_ELLIPSOID};
    const size_t both = 1 + index % 24; /* 0: two boxes */
    for (int i = 0; i < 2; i++) {
        geometry made = make_terrain(&p.body[i].shape, bodies, i);
        if (!made && bodies == "hulls") {
            const auto globe = fcl_globe(11, 16, vec(uniform(0.05, 0.5), uniform(0.05, 0.5), uniform(0.05, 0.5)));
            p.body[i].shape = shape_polytope(globe->getVertices()[0].data(), 160);
            made = globe;
        } else if (!made) {
            body_random(&p.body[i], kinds[i ? both / 5 : both % 5]);
            made = fcl_geometry(p.body[i].shape, TRIANGLE_HULL);
        }
        p.moved[i].reset(new object(made));
    }
    shape_t *const a = &p.body[0].shape, *const b = &p.body[1].shape;
    const double reach = shape_reach(a) + shape_reach(b);
    if (use == "touching") {
        pose_truth_t truth;
        pose_overlapping(&p.body[0], &p.body[1], &truth);
        pose_at_depth(&p.body[1], &truth, fmin(1e-3 * truth.size, truth.upper));
    } else {
        const vec at = random_vector(0.7) * reach;
        turn_at_random(a);
        turn_at_random(b);
        shape_move(b, at[0], at[1], at[2]);
    }
    p.moved[0]->setTransform(fcl_pose(*a));
    p.home = fcl_pose(*b);
    p.along = random_vector(1).normalized() * (2.5 * reach); /* nine of ten pairs are apart */
    p.spin = random_vector(1.0 / 60);
    p.phase = uniform(-3, 3);
}

/* Places a pair for a frame. */
static void place(scene_pair &p, const std::string &use, long frame)
{
    fcl::Transform3d pose = p.home;
    if (use == "touching") {
        /* about its center by up to a milliradian, and by up to a tenth of the depth */
        const vec axis = random_vector(1).normalized();
        pose.linear() = angle_axis(uniform(-1e-3, 1e-3), axis).toRotationMatrix() * p.home.linear();
        pose.translation() += random_vector(1e-4) * pair_size(&p.body[0].shape, &p.body[1].shape);
    } else if (use == "through") {
        pose.linear() = angle_axis((double)frame * p.spin.norm(), p.spin.normalized()).toRotationMatrix() * p.home.linear();
        pose.translation() += sin(p.phase + 0.004 * (double)frame) * p.along;
    } else {
        for (body_t &body : p.body)
            turn_at_random(&body.shape);
        p.moved[0]->setTransform(fcl_pose(p.body[0].shape));
        pose = fcl_pose(p.body[1].shape);
        pose.translation() = random_vector(0.7) * (shape_reach(&p.body[0].shape) + shape_reach(&p.body[1].shape));
    }
    p.moved[1]->setTransform(pose);
    for (auto &body : p.moved)
        body->computeAABB();
}

/* --- the narrow phase --------------------------------------------------------------- */

#ifdef BY_HEADER
static ccd_fcl::PairCache cache;
static ccd_fcl::Settings settings;
#endif

/* Not inlined: callgrind counts its instructions. */
__attribute__((noinline)) static size_t collide(const scene_pair &p, bool contacts, size_t most)
{
    const fcl::CollisionRequestd request(contacts ? most : 1, contacts, 1, false, true, fcl::GST_LIBCCD, 1e-6);
    fcl::CollisionResultd result;
#ifdef BY_HEADER
    ccd_fcl::collide(p.moved[0].get(), p.moved[1].get(), request, result, cache, settings);
#else
    fcl::collide(p.moved[0].get(), p.moved[1].get(), request, result);
#endif
    return result.numContacts();
}

static void end_frame(bool is_random)
{
#ifdef BY_HEADER
    if (is_random)
        cache.clear();
    else
        cache.next_frame();
#endif
    (void)is_random;
}

int main(int argc, char **argv)
{
    if (argc != 7) {
        fprintf(stderr, "usage: fcl_scene CONTACTS USE BODIES FRAMES PAIRS MOST\n");
        return 2;
    }
    const std::string use = argv[2];
    const size_t most = (size_t)atol(argv[6]);
    const bool is_random = use == "random" || use == "yes-no";
    std::vector<scene_pair> pairs((size_t)atol(argv[5]));
    double seconds = 0;
    size_t contacts = 0;
    print_library();
#ifdef BY_HEADER
    settings.contacts_per_pair = (size_t)atol(argv[1]);
#endif
    uniform_seed(14);
    for (size_t i = 0; i < pairs.size(); i++)
        make_pair(pairs[i], use, argv[3], i);
    for (long frame = 0; frame < atol(argv[4]); frame++) {
        for (scene_pair &p : pairs)
            place(p, use, frame);
        const double start = thread_seconds();
        for (const scene_pair &p : pairs)
            contacts += collide(p, use != "yes-no", most);
        end_frame(is_random);
        seconds += thread_seconds() - start;
    }
    printf("timed contacts %zu seconds %.6f\n", contacts, seconds);
    printf("processor seconds %.6f\n", (double)clock() / CLOCKS_PER_SEC);
    return 0;
}
