/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A program whose callbacks do what callbacks do in the field, to be watched by compare.sh.
 * Prints `key value ...` of what it saw itself: the same as when nobody watches.
 *
 * usage: callbacks WAY
 *   plain     500 queries of all calls
 *   throw     the callbacks throw at their n-th call of a query, n from 1 to 40
 *   later     they throw at a call that only the tool's own questions come to
 *   jump      as throw, by longjmp
 *   jump-later as later, by longjmp
 *   within    the callbacks jump and throw within themselves
 *   lie       one answers with points that are not the farthest
 *   seldom    one does so in few directions, on a pair that takes many
 *   drift     one object moves a little with every call
 *   threads   four threads, 500 queries each
 *   nested    the callbacks make queries themselves
 *   fork      a child makes half of the queries
 *   nothing   no query
 *   exit      exits with 7 after its queries
 *   abort     aborts after its queries
 *   _exit     leaves with 3, without any clearing up */

#include "harness/identity.h"
#include "harness/shapes.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdexcept>
#include <string>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

enum { QUERIES = 500 };

static std::string way;
static thread_local long calls_left = -1; /* until a callback leaves; negative: never */
static thread_local jmp_buf outside;
static long destroyed;

struct Watcher {
    ~Watcher() { destroyed++; }
};

static void leave()
{
    Watcher watcher;
    if (way == "jump" || way == "jump-later")
        longjmp(outside, 1);
    throw std::runtime_error("out of here");
}

static void leave_and_stay()
{
    jmp_buf here;
    if (setjmp(here) == 0)
        longjmp(here, 1);
    try {
        throw 1;
    } catch (int) {
    }
}

static void ask(const shape_t *a, const shape_t *b, int call, int *hit, double *depth);

/* One direction in some fifty, by its digits, is answered by a point 4 cm below the farthest. */
static void seldom_lie(const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    if (sin(1e5 * (double)dir->v[0]) > 0.998)
        for (int k = 0; k < 3; k++)
            out->v[k] -= (ccd_real_t)0.04 * dir->v[k];
}

static void support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    shape_t *s = (shape_t *)obj;
    if (calls_left > 0 && --calls_left == 0)
        leave();
    shape_support(s, dir, out);
    if (way == "within")
        leave_and_stay();
    if (way == "lie" && s->type == SHAPE_BOX && dir->v[0] > 0.3)
        out->v[0] -= (ccd_real_t)0.2;
    if (way == "seldom" && s->type == SHAPE_ELLIPSOID)
        seldom_lie(dir, out);
    if (way == "drift" && s->type == SHAPE_BOX)
        s->pos[0] += (ccd_real_t)1e-4;
    if (way == "nested" && s->type == SHAPE_BOX) {
        static thread_local int inside;
        shape_t a = shape_sphere(1), b = shape_sphere(1);
        int hit;
        double depth;
        if (inside++ == 0)
            ask(&a, &b, 0, &hit, &depth);
        inside--;
    }
}

static void ask(const shape_t *a, const shape_t *b, int call, int *hit, double *depth)
{
    ccd_real_t d = 0;
    ccd_vec3_t dir, pos;
    ccd_t ccd = shape_query();
    ccd.support1 = ccd.support2 = support;
    ccd.mpr_tolerance = ccd.epa_tolerance = (ccd_real_t)1e-6;
    ccd.max_iterations = 500;
    switch (call) {
    case 0: *hit = ccdMPRPenetration(a, b, &ccd, &d, &dir, &pos) == 0; break;
    case 1: *hit = ccdMPRIntersect(a, b, &ccd); break;
    case 2: *hit = ccdGJKPenetration(a, b, &ccd, &d, &dir, &pos) == 0; break;
    case 3:
        *hit = ccdGJKSeparate(a, b, &ccd, &dir) == 0;
        d = *hit ? (ccd_real_t)sqrt((double)ccdVec3Len2(&dir)) : 0;
        break;
    default: *hit = ccdGJKIntersect(a, b, &ccd); break;
    }
    *depth = (double)d;
}

/* A box, or where many directions are wanted an ellipsoid, and a capsule in pose number k, of
 * which two in three overlap. */
static void pair(int k, shape_t *a, shape_t *b)
{
    double rot[9];
    *a = way == "seldom" ? shape_ellipsoid(0.5, 0.4, 0.3) : shape_box(0.5, 0.4, 0.3);
    *b = shape_capsule(0.2, 0.3);
    rotation_about(1 + k % 3, k % 7 - 3, k % 5, 0.7 * k, rot);
    shape_turn(b, rot);
    shape_move(b, 0.9 * sin(1.1 * k), 0.7 * cos(1.7 * k), 0.5 * sin(2.3 * k));
}

typedef struct {
    long hits, left;
    double depth;
} seen_by_program;

static void query(int k, int calls, seen_by_program *out)
{
    shape_t a, b;
    int hit = 0;
    double depth = 0;
    pair(k, &a, &b);
    if (way == "throw" || way == "jump")
        calls_left = 1 + k % 40;
    /* a query of MPR's needs less than this; four of them, which the tool asks, more */
    if (way == "later" || way == "jump-later")
        calls_left = 70;
    ask(&a, &b, k % calls, &hit, &depth);
    out->hits += hit;
    out->depth += depth;
}

static void queries(seen_by_program *out, int calls)
{
    volatile int k;
    for (k = 0; k < QUERIES; k++) {
        if (setjmp(outside) == 0) {
            try {
                query(k, calls, out);
            } catch (const std::runtime_error &) {
                out->left++;
            }
        } else
            out->left++;
        calls_left = -1;
    }
}

static void *thread(void *out)
{
    queries((seen_by_program *)out, 5);
    return NULL;
}

int main(int argc, char **argv)
{
    seen_by_program of[4] = {};
    way = argc == 2 ? argv[1] : "";
    printf("library %s\n", running_ccd() ? running_ccd() : "libccd");
    if (way == "threads") {
        pthread_t id[4];
        for (int i = 0; i < 4; i++)
            pthread_create(&id[i], NULL, thread, &of[i]);
        for (int i = 0; i < 4; i++)
            pthread_join(id[i], NULL);
    } else if (way == "fork") {
        fflush(stdout);
        const pid_t child = fork();
        queries(&of[0], 5);
        if (child == 0)
            _exit(0);
        int status;
        waitpid(child, &status, 0);
        if (status != 0)
            return 1;
    } else if (way != "nothing")
        /* where callbacks leave, libccd's other calls would lose memory */
        queries(&of[0], way == "throw" || way == "jump" || way == "later" || way == "jump-later" ? 2 : 5);
    for (int i = 1; i < 4; i++) {
        of[0].hits += of[i].hits;
        of[0].depth += of[i].depth;
    }
    printf("seen hits %ld left %ld depth %.9g destroyed %ld uncaught %d\n", of[0].hits, of[0].left, of[0].depth, destroyed,
           std::uncaught_exceptions());
    fflush(stdout);
    if (way == "abort")
        abort();
    if (way == "_exit")
        _exit(3);
    return way == "exit" ? 7 : 0;
}
