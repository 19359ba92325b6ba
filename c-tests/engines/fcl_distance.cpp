/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* FCL's signed distance of every configuration of tests/stability/configurations.h, of pairs of equal
 * boxes that touch face on face, and of random pairs, judged by exact truth. Prints the wrong
 * answers, the file that GJKSignedDistance is taken from, and a line for each set:
 *
 *   SET queries N threw N endless N wrong N outside N nanoseconds N
 *
 * `threw`: an exception, a crash, or one of the assertions that Debian's FCL is built with;
 * `endless`: no answer in a second, without part in the mean time; `wrong`: off by
 * more than TOLERANCE and 0.1 % of the truth, or the sign; `outside`: a witness point that lies
 * off its object by more than that.
 *
 * usage: fcl_distance PAIRS   (kissing pairs; a third as many random ones) */

#include "engines/fcl_shapes.h" /* first: configurations.h has a macro that FCL uses as a name */
#include "tests/stability/configurations.h"
#include "harness/identity.h"

#include <dlfcn.h>
#include <setjmp.h>
#include <signal.h>
#include <time.h>
#include <unistd.h>

static const double TOLERANCE = 1e-6; /* FCL's */

/* A failed assertion, a crash and a query of more than a second come back here; what FCL held is
 * lost. */
static sigjmp_buf after_signal;
static void on_signal(int signal)
{
    siglongjmp(after_signal, signal);
}

static struct {
    long queries, threw, endless, wrong, outside;
    double nanoseconds;
} set;

static void print_set(const char *name)
{
    printf("%s queries %ld threw %ld endless %ld wrong %ld outside %ld nanoseconds %.0f\n", name, set.queries,
           set.threw, set.endless, set.wrong, set.outside, set.nanoseconds / (double)(set.queries - set.endless));
    memset(&set, 0, sizeof set);
}

static double now()
{
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static geometry fcl_shape(const shape_t &s)
{
    body_t body = body_t();
    body.kind = s.type;
    body.shape = s;
    if (s.type != SHAPE_POLYTOPE)
        return fcl_geometry(body);
    auto vertices = std::make_shared<std::vector<vec>>();
    for (int i = 0; i < s.nverts; i++)
        vertices->emplace_back(s.verts[3 * i], s.verts[3 * i + 1], s.verts[3 * i + 2]);
    /* one face of all vertices: what FCL reads of it is its edges */
    auto face = std::make_shared<std::vector<int>>(1, s.nverts);
    for (int i = 0; i < s.nverts; i++)
        face->push_back(i);
    return std::make_shared<fcl::Convex<double>>(vertices, 1, face);
}

/* How far a point lies outside an object, at most: over the axes and the way to its centre. */
static double outside(const shape_t &s, const fcl::Vector3d &p)
{
    static const double origin[3] = {0, 0, 0};
    double most = -HUGE_VAL;
    for (int i = 0; i < 7; i++) {
        double n[3] = {p[0] - s.pos[0], p[1] - s.pos[1], p[2] - s.pos[2]}, q[3];
        const double length = sqrt(truth_dot3(n, n));
        for (int k = 0; k < 3; k++)
            n[k] = i < 6 ? (k == i / 2) * (i % 2 ? 1. : -1.) : n[k] / length;
        if (i == 6 && !(length > 0))
            continue;
        truth_point(&s, origin, n, q);
        most = fmax(most, n[0] * (p[0] - q[0]) + n[1] * (p[1] - q[1]) + n[2] * (p[2] - q[2]));
    }
    return most;
}

static void query(const char *name, const shape_t &a, const shape_t &b, double lower, double upper)
{
    /* kept over the jump out of a failed assertion */
    static double value;
    static fcl::DistanceResultd result;
    static bool answered;
    fcl::DistanceRequestd request(true, true, 0, 0, TOLERANCE, fcl::GST_LIBCCD);
    fcl::CollisionObjectd first(fcl_shape(a), fcl_pose(a)), second(fcl_shape(b), fcl_pose(b));
    result.clear();
    answered = false;
    static int signal;
    const double start = now();
    alarm(1);
    signal = sigsetjmp(after_signal, 1);
    if (!signal) {
        try {
            value = fcl::distance(&first, &second, request, result);
            answered = true;
        } catch (const std::exception &) {
        }
    }
    alarm(0);
    set.queries++;
    if (signal == SIGALRM) {
        set.endless++;
        printf("endless: %s\n", name);
        return;
    }
    set.nanoseconds += now() - start;
    set.threw += !answered;
    if (!answered) {
        printf("threw: %s\n", name);
        return;
    }
    const double size = pair_size(&a, &b), allowed = TOLERANCE + 1e-3 * fabs(upper) + 1e-9 * size + pair_noise(&a, &b);
    /* a depth's bounds are upside down in a distance */
    if (!(value >= -upper - allowed && value <= -lower + allowed)) {
        set.wrong++;
        printf("wrong: %s: %.9g, truth %.9g to %.9g\n", name, value, -upper, -lower);
    }
    const bool off = !(outside(a, result.nearest_points[0]) <= allowed) || !(outside(b, result.nearest_points[1]) <= allowed);
    set.outside += off;
    if (off)
        printf("outside: %s\n", name);
}

static void query_configuration(const configuration_t *c)
{
    const truth_t t = truth_depth(&c->a, &c->b);
    query(c->id, c->a, c->b, t.lower, t.depth);
}

/* Equal boxes beside each other along one of their axes, sides aligned; a gap of 0 or a few ulps. */
static void query_kissing(long pairs)
{
    for (long i = 0; i < pairs; i++) {
        double q[4], frame[9];
        shape_t a = shape_box(uniform(.01, 1), uniform(.01, 1), uniform(.01, 1)), b;
        uniform_rotation(q);
        rotation_quaternion(q[0], q[1], q[2], q[3], frame);
        shape_turn(&a, frame);
        b = a;
        const int axis = (int)(i % 3);
        const double at = 2 * a.p[axis] + (double)(i % 5 - 2) * 1e-16;
        shape_move(&b, frame[axis] * at, frame[3 + axis] * at, frame[6 + axis] * at);
        query("kissing boxes", a, b, 2 * a.p[axis] - at, 2 * a.p[axis] - at);
    }
}

static void query_random(long pairs)
{
    static const int kinds[] = {SHAPE_BOX, SHAPE_CYLINDER, SHAPE_CONE, SHAPE_ELLIPSOID, SHAPE_CAPSULE};
    static body_t a, b;
    for (long i = 0; i < pairs; i++) {
        known_t known;
        body_random(&a, kinds[i % 5]);
        body_random(&b, kinds[i / 5 % 5]);
        pose_overlapping(&a, &b, &known);
        for (double depth : {known.upper, 1e-3, -0.1}) {
            if (depth > known.upper)
                continue;
            pose_at_depth(&b, &known, depth);
            query("random pair", a.shape, b.shape, known.lower, known.upper);
        }
    }
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: fcl_distance PAIRS\n");
        return 2;
    }
    Dl_info from;
    void *function = dlsym(RTLD_DEFAULT, "_ZN3fcl6detail17GJKSignedDistanceIdEEbPvPFvPKvPK11_ccd_vec3_tPS5_ES2_SA_jT_PSB_"
                                         "PN5Eigen6MatrixISB_Li3ELi1ELi0ELi3ELi1EEESG_");
    for (int kind : {SIGABRT, SIGSEGV, SIGALRM})
        signal(kind, on_signal);
    tell_library();
    printf("function %s\n", function && dladdr(function, &from) ? strrchr(from.dli_fname, '/') + 1 : "none");
    uniform_seed(45);
    configurations_all(query_configuration);
    print_set("configurations");
    query_kissing(atol(argv[1]));
    print_set("kissing");
    query_random(atol(argv[1]) / 3);
    print_set("random");
    return 0;
}
