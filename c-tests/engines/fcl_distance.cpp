/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* FCL's signed distance of every configuration of tests/stability/configurations.h, of pairs of equal
 * boxes that touch face on face, of random pairs, and of spheres beside capsules, judged by exact truth. Prints the wrong
 * results, the file that GJKSignedDistance is taken from, and a line for each set:
 *
 *   SET queries N threw N endless N wrong N outside N unequal N microseconds N
 *
 * `threw`: an exception, a crash, or one of the assertions that Debian's FCL is built with;
 * `endless`: no result in a second of processor, left out of the mean time; `wrong`: off by
 * more than TOLERANCE and 0.1 % of the truth, or the sign; `outside`: a witness point that lies
 * off its object by more than that; `unequal`: witness points that are not |distance| apart, within rounding. In the set
 * `round`, spheres beside capsules, a witness point is outside if it is TOLERANCE off the only one.
 *
 * usage: fcl_distance PAIRS   (kissing pairs; a third as many random ones in three poses) */

#include "engines/fcl_shapes.h" /* first: configurations.h has a macro that FCL uses as a name */
#include "tests/stability/configurations.h"
#include "harness/identity.h"

#include <dlfcn.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const double TOLERANCE = 1e-6; /* FCL's */

typedef struct {
    long queries, threw, endless, wrong, outside, unequal;
    double seconds;
} set_t;
static const char *const SET_NAMES[] = {"configurations", "kissing", "random", "round"};

/* The queries run in a child process. A failed assertion, a crash and a query of more than a second end it,
 * and the next child continues behind that query: what such a query leaves in memory spoils no other. */
typedef struct {
    set_t sets[4];
    int current; /* set */
    long done;   /* queries, the current one included */
    char name[64];
} progress_t;
static progress_t *progress; /* shared with the child */

/* Ends the process after so many seconds of processor; 0: never. */
static void limit_time(long seconds)
{
    const itimerval limit = {{0, 0}, {seconds, 0}};
    setitimer(ITIMER_VIRTUAL, &limit, NULL);
}

/* Counts a fault of the current query, and prints it. */
static void count(long &faults, const char *what)
{
    faults++;
    printf("%s: %s\n", what, progress->name);
}

/* Judges one distance. points: the only witness points, or NULL. */
static void query(const char *name, const shape_t &a, const shape_t &b, double lower, double upper, const vec *points = NULL)
{
    static long index; /* of this query */
    if (index++ < progress->done)
        return;
    set_t &set = progress->sets[progress->current];
    progress->done = index;
    snprintf(progress->name, sizeof progress->name, "%s", name);
    set.queries++;
    double value = 0;
    bool returned = false;
    fcl::DistanceResultd result;
    fcl::DistanceRequestd request(true, true, 0, 0, TOLERANCE, fcl::GST_LIBCCD);
    object first(fcl_geometry(a, TRIANGLE_HULL), fcl_pose(a)), second(fcl_geometry(b, TRIANGLE_HULL), fcl_pose(b));
    const double start = thread_seconds();
    limit_time(1);
    try {
        value = fcl::distance(&first, &second, request, result);
        returned = true;
    } catch (const std::exception &) {
    }
    limit_time(0);
    set.seconds += thread_seconds() - start;
    if (!returned) {
        count(set.threw, "threw");
        return;
    }
    const double size = pair_size(&a, &b), allowed = TOLERANCE + 1e-3 * fabs(upper) + 1e-9 * size + pair_noise(&a, &b);
    if (!(value >= -upper - allowed && value <= -lower + allowed))
        count(set.wrong, "wrong");
    if (is_outside(a, result.nearest_points[0], allowed, allowed / 4)
        || is_outside(b, result.nearest_points[1], allowed, allowed / 4))
        count(set.outside, "outside");
    const vec *const found = result.nearest_points;
    if (points && !((found[0] - points[0]).norm() <= TOLERANCE && (found[1] - points[1]).norm() <= TOLERANCE))
        count(set.outside, "aside");
    if (!(fabs((found[0] - found[1]).norm() - fabs(value)) <= 1e-14 * (size + found[0].norm())))
        count(set.unequal, "unequal");
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
    static const int kinds[] = {SHAPE_SPHERE, SHAPE_CAPSULE, SHAPE_BOX, SHAPE_CYLINDER, SHAPE_CONE, SHAPE_ELLIPSOID,
                                SHAPE_POLYTOPE, KIND_PLATE};
    static body_t a, b;
    for (long i = 0; i < pairs; i++) {
        pose_truth_t pose;
        body_random(&a, kinds[i % 8]);
        body_random(&b, kinds[i / 8 % 8]);
        pose_overlapping(&a, &b, &pose);
        for (double depth : {pose.upper, 1e-3, -0.1}) {
            if (depth > pose.upper)
                continue;
            pose_at_depth(&b, &pose, depth);
            query("random pair", a.shape, b.shape, pose.lower, pose.upper);
        }
    }
}

/* Spheres beside upright capsules, apart. */
static void query_round(long pairs)
{
    for (long i = 0; i < pairs; i++) {
        const double r1 = uniform(.1, 1), r2 = uniform(.1, 1), half = uniform(.1, 1);
        const double distance = uniform(0, 1) * fmin(r1, r2), height = uniform(-.9, .9) * half;
        shape_t a = shape_sphere(r1), b = shape_capsule(r2, half);
        const vec u = vec(uniform(-1, 1), uniform(-1, 1), 0).normalized(), center = -(r1 + r2 + distance) * u + vec(0, 0, height);
        shape_move(&a, center[0], center[1], center[2]);
        const vec points[2] = {center + r1 * u, vec(0, 0, height) - r2 * u};
        query("a sphere beside a capsule", a, b, -distance, -distance, points);
    }
}

static void query_all(long pairs)
{
    uniform_seed(45);
    progress->current = 0;
    for_each_configuration(query_configuration);
    progress->current = 1;
    query_kissing(pairs);
    progress->current = 2;
    query_random(pairs / 3);
    progress->current = 3;
    query_round(pairs / 3);
}

/* Runs the remaining queries in a child; returns whether all are done. */
static bool run_child(long pairs)
{
    int status;
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        query_all(pairs);
        fflush(stdout);
        _exit(0);
    }
    if (child < 0 || waitpid(child, &status, 0) != child) {
        perror("fcl_distance");
        exit(2);
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return true;
    set_t &set = progress->sets[progress->current];
    const bool is_endless = WIFSIGNALED(status) && WTERMSIG(status) == SIGVTALRM;
    count(is_endless ? set.endless : set.threw, is_endless ? "endless" : "threw");
    return false;
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
    void *memory = mmap(NULL, sizeof *progress, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED)
        return 2;
    progress = (progress_t *)memory;
    setvbuf(stdout, NULL, _IOLBF, 0);
    print_library();
    printf("function %s\n", function && dladdr(function, &from) ? strrchr(from.dli_fname, '/') + 1 : "none");
    while (!run_child(atol(argv[1])))
        ;
    for (int i = 0; i < 4; i++) {
        const set_t &set = progress->sets[i];
        printf("%s queries %ld threw %ld endless %ld wrong %ld outside %ld unequal %ld microseconds %.3f\n", SET_NAMES[i], set.queries,
               set.threw, set.endless, set.wrong, set.outside, set.unequal, 1e6 * set.seconds / (double)(set.queries - set.endless));
    }
    return 0;
}
