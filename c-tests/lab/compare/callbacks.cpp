/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A program for compare.sh whose callbacks do what callbacks may do.
 * Prints its own results as `results key value ...`: they are the same without the tool.
 *
 * usage: callbacks MODE
 *   plain        500 queries of all calls
 *   throw        the callbacks throw at their n-th call of a query, n from 1 to 40
 *   later        they throw at a call that only the tool's own queries reach
 *   jump         as throw, by longjmp
 *   jump-later   as later, by longjmp
 *   within       the callbacks jump and throw within themselves
 *   wrong        one returns points that are not the farthest
 *   rarely-wrong one does so in few directions, on a pair that takes many
 *   memory       one object moves a little with every call
 *   threads      four threads, 500 queries each
 *   nested       the callbacks make queries themselves
 *   fork         a child makes the same queries again
 *   nothing      no query
 *   exit         exits with 7 after its queries
 *   abort        aborts after its queries
 *   _exit        exits with 3, without any clearing up
 *   hang         a child that it waits for does not end on libccd
 *   crash        aborts after its queries on libccd */

#include "harness/identity.h"
#include "harness/shapes.h"
#include "harness/this_library.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdexcept>
#include <string>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

enum { QUERIES = 500 };

static std::string mode;
static thread_local long calls_left = -1; /* until a callback leaves; negative: never */
static thread_local jmp_buf outside;
static void leave()
{
    if (mode == "jump" || mode == "jump-later")
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

static void query_pair(const shape_t *a, const shape_t *b, int call, int *hit, double *depth);

/* Moves the point 4 cm back for one direction in some fifty, by its digits. */
static void wrong_rarely(const ccd_vec3_t *dir, ccd_vec3_t *out)
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
    if (mode == "within")
        leave_and_stay();
    if (mode == "wrong" && s->type == SHAPE_BOX && dir->v[0] > 0.3)
        out->v[0] -= (ccd_real_t)0.2;
    if (mode == "rarely-wrong" && s->type == SHAPE_ELLIPSOID)
        wrong_rarely(dir, out);
    if (mode == "memory" && s->type == SHAPE_BOX)
        s->pos[0] += (ccd_real_t)1e-4;
    if (mode == "nested" && s->type == SHAPE_BOX) {
        static thread_local int inside;
        shape_t a = shape_sphere(1), b = shape_sphere(1);
        int hit;
        double depth;
        if (inside++ == 0)
            query_pair(&a, &b, 0, &hit, &depth);
        inside--;
    }
}

static void query_pair(const shape_t *a, const shape_t *b, int call, int *hit, double *depth)
{
    ccd_real_t d = 0;
    ccd_vec3_t dir, pos;
    ccd_t settings = shape_query(), *ccd = &settings;
    call_args_t rest = call_args_t(), *x = &rest;
    int code = 0;
    settings.support1 = settings.support2 = support;
    settings.mpr_tolerance = settings.epa_tolerance = (ccd_real_t)1e-6;
    settings.max_iterations = 500;
    rest.depth = &d;
    rest.dir = &dir;
    rest.pos = &pos;
    switch (call) {
#define CALL_CASE(name, word, kind, traits) \
    case CALL_##word: code = PASS_##kind(name); break;
        LIBCCD_CALLS(CALL_CASE)
    }
    *hit = code == call_table[call].hit;
    *depth = (double)(*hit && call == CALL_SEPARATE ? (ccd_real_t)sqrt((double)ccdVec3Len2(&dir)) : d);
}

/* A box, or an ellipsoid, which takes more directions, and a capsule in pose k; two
 * in three overlap. */
static void pair(int k, shape_t *a, shape_t *b)
{
    double rot[9];
    *a = mode == "rarely-wrong" ? shape_ellipsoid(0.5, 0.4, 0.3) : shape_box(0.5, 0.4, 0.3);
    *b = shape_capsule(0.2, 0.3);
    rotation_about(1 + k % 3, k % 7 - 3, k % 5, 0.7 * k, rot);
    shape_turn(b, rot);
    shape_move(b, 0.9 * sin(1.1 * k), 0.7 * cos(1.7 * k), 0.5 * sin(2.3 * k));
}

typedef struct {
    long hits, left;
    double depth;
} results_t;

static void query(int k, int calls, results_t *out)
{
    shape_t a, b;
    int hit = 0;
    double depth = 0;
    pair(k, &a, &b);
    if (mode == "throw" || mode == "jump")
        calls_left = 1 + k % 40;
    /* one query of MPR needs less than this; the four queries of the tool more */
    if (mode == "later" || mode == "jump-later")
        calls_left = 70;
    query_pair(&a, &b, k % calls, &hit, &depth);
    out->hits += hit;
    out->depth += depth;
}

static void queries(results_t *out, int calls)
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
    queries((results_t *)out, 5);
    return NULL;
}

int main(int argc, char **argv)
{
    results_t of[4] = {};
    mode = argc == 2 ? argv[1] : "";
    print_library();
    if (mode == "threads") {
        pthread_t id[4];
        for (int i = 0; i < 4; i++)
            pthread_create(&id[i], NULL, thread, &of[i]);
        for (int i = 0; i < 4; i++)
            pthread_join(id[i], NULL);
    } else if (mode == "fork") {
        fflush(stdout);
        const pid_t child = fork();
        queries(&of[0], 5);
        if (child == 0)
            _exit(0);
        int status;
        waitpid(child, &status, 0);
        if (status != 0)
            return 1;
    } else if (mode != "nothing")
        /* libccd's other calls leak memory where callbacks do not return */
        queries(&of[0], mode == "throw" || mode == "jump" || mode == "later" || mode == "jump-later" ? 2 : 5);
    for (int i = 1; i < 4; i++) {
        of[0].hits += of[i].hits;
        of[0].depth += of[i].depth;
    }
    printf("results hits %ld left %ld depth %.9g uncaught %d\n", of[0].hits, of[0].left, of[0].depth, std::uncaught_exceptions());
    fflush(stdout);
    if (mode == "hang" && !running_ccd() && (fork() == 0 || wait(NULL)))
        for (;;)
            pause();
    if (mode == "abort" || (mode == "crash" && !running_ccd()))
        abort();
    if (mode == "_exit")
        _exit(3);
    return mode == "exit" ? 7 : 0;
}
