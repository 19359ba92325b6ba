/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Loaded before a program (LD_PRELOAD), this object stands between it and libccd: the dynamic
 * linker binds the program's queries, and those of FCL, ODE, MuJoCo and DART, to the functions
 * here. Each is passed to the library whose answers the program is to get, with the program's own
 * objects and callbacks; then a share of them is put to both libraries and judged (judge_query.c).
 *
 * While a callback runs, all state lies on the stack, so that exceptions and longjmp
 * pass through. compare.sh sets the environment:
 *
 *   CCD_COMPARE_DIR     folder of the counts
 *   CCD_COMPARE_THEIRS, CCD_COMPARE_OURS   private copies of the two libraries
 *   CCD_COMPARE_NAME    path of libccd, for the screen
 *   CCD_COMPARE_LOADED  1: a libccd that the process has loaded takes the place of CCD_COMPARE_THEIRS, if there is one
 *   CCD_COMPARE_BASE    theirs or ours: whose answers the program gets
 *   CCD_COMPARE_EVERY   one query in so many is judged; 0: none
 *   CCD_COMPARE_TIMES   0: no times are measured
 *   CCD_COMPARE_KEEP    folder of wrong answers */

#define _GNU_SOURCE
#include "tools/compare/compare.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <unistd.h>

#define EXPORT __attribute__((visibility("default")))

static compare_t compare;
static uint64_t every;
static const library_t *base;
static pthread_once_t once = PTHREAD_ONCE_INIT;

static const char *setting(const char *name, const char *otherwise)
{
    const char *value = getenv(name);
    return value && *value ? value : otherwise;
}

static void give_up(const char *what)
{
    perror(what);
    fputs("compare: cannot count\n", stderr);
    exit(125);
}

/* The file that all processes of the run share. */
static compare_counts_t *counts_map(const char *dir)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/counts", dir);
    int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (file < 0 || ftruncate(file, sizeof(compare_counts_t)) != 0)
        give_up(path);
    void *mapped = mmap(NULL, sizeof(compare_counts_t), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (mapped == MAP_FAILED)
        give_up(path);
    close(file);
    return (compare_counts_t *)mapped;
}

/* Finds a libccd in the process, under any name: a wheel carries one that no other program sees. Returns its path, or NULL. */
static const char *loaded_libccd(void)
{
    struct link_map *object = NULL;
    Dl_info own, found;
    void *const process = dlopen(NULL, RTLD_NOW), *symbol;
    if (!process || dlinfo(process, RTLD_DI_LINKMAP, &object) != 0 || !dladdr(&compare, &own))
        return NULL;
    for (; object; object = object->l_next) {
        void *const handle = *object->l_name ? dlopen(object->l_name, RTLD_LAZY | RTLD_NOLOAD) : NULL;
        if (!handle)
            continue;
        /* Of this object or of one that it depends on. */
        const int is_libccd = !find_symbol(handle, "ccdMPRPenetration", &symbol) && dladdr(symbol, &found) &&
                              found.dli_fbase != own.dli_fbase && !dlsym(handle, "ccdImplementation");
        dlclose(handle);
        if (is_libccd)
            return found.dli_fname;
    }
    return NULL;
}

/* Opens a copy of a libccd of the process as the one to compare with. Returns 0 on success. */
static int open_loaded(const char *path, const char *dir)
{
    char copy[4096];
    snprintf(copy, sizeof copy, "%s/loaded-%d.so", dir, (int)getpid());
    const int from = open(path, O_RDONLY | O_CLOEXEC), to = open(copy, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (from < 0 || to < 0)
        give_up(path);
    while (sendfile(to, from, NULL, 1 << 20) > 0)
        continue;
    close(from);
    close(to);
    const int failed = library_open(&compare.library[COMPARE_THEIRS], copy, 0);
    unlink(copy);
    return failed;
}

static uint64_t time_counted; /* of this process's */

static void forked(void) { time_counted = 0; }

static void start(void)
{
    const char *const theirs = getenv("CCD_COMPARE_THEIRS"), *const ours = getenv("CCD_COMPARE_OURS");
    const char *const dir = getenv("CCD_COMPARE_DIR");
    const char *const base_name = setting("CCD_COMPARE_BASE", "theirs");
    const char *const loaded = strcmp(setting("CCD_COMPARE_LOADED", "0"), "0") != 0 ? loaded_libccd() : NULL;
    if (!dir || !theirs || !ours) {
        fputs("compare: to be started by compare.sh\n", stderr);
        exit(125);
    }
    if (!loaded && !*theirs) {
        fputs("compare: no libccd to compare with: name one with --libccd FILE; Debian's package is libccd2\n", stderr);
        exit(125);
    }
    if (loaded ? open_loaded(loaded, dir) : library_open(&compare.library[COMPARE_THEIRS], theirs, 0))
        exit(125);
    if (library_open(&compare.library[COMPARE_OURS], ours, 1))
        exit(125);
    compare.counts = counts_map(dir);
    compare.base = strcmp(base_name, "theirs") != 0 ? COMPARE_OURS : COMPARE_THEIRS;
    compare.timed = strcmp(setting("CCD_COMPARE_TIMES", "1"), "0") != 0;
    compare.keep = setting("CCD_COMPARE_KEEP", NULL);
    base = &compare.library[compare.base];
    every = strtoull(setting("CCD_COMPARE_EVERY", "1"), NULL, 10);
    pthread_atfork(NULL, NULL, forked);
    if (__atomic_fetch_add(&compare.counts->processes, 1, __ATOMIC_RELAXED))
        return;
    compare.counts->base = (uint64_t)compare.base;
    snprintf(compare.counts->ours, sizeof compare.counts->ours, "%s", compare.library[COMPARE_OURS].implementation());
    snprintf(compare.counts->theirs, sizeof compare.counts->theirs, "%s", loaded ? loaded : setting("CCD_COMPARE_NAME", "?"));
    snprintf(compare.counts->program, sizeof compare.counts->program, "%s", program_invocation_name);
}

static void count_process_time(void)
{
    const uint64_t now = clock_now(CLOCK_PROCESS_CPUTIME_ID), before = __atomic_exchange_n(&time_counted, now, __ATOMIC_RELAXED);
    count_add(&compare.counts->process_nanoseconds, now > before ? now - before : 0);
}

__attribute__((destructor)) static void end(void)
{
    if (compare.counts)
        count_process_time();
}

/* --- queries ------------------------------------------------------------------------ */

/* Chooses by a hash of the query's number: every n-th one of a scene would always be
 * of the same pairs. */
static int is_sampled(uint64_t number)
{
    number = (number ^ (number >> 31)) * UINT64_C(0x9E3779B97F4A7C15);
    number = (number ^ (number >> 29)) * UINT64_C(0xBF58476D1CE4E5B9);
    return every == 1 || (every > 1 && (number ^ (number >> 32)) % every == 0);
}

/* Reads the program's own outputs, NaN where it passes no pointer. */
static answer_t read_outputs(const query_t *q, int code, const call_args_t *x)
{
    const ccd_real_t nan = (ccd_real_t)NAN;
    answer_t own = {code, is_hit(q->call, code), nan, {{nan, nan, nan}}, {{0, 0, 0}}};
    if (own.hit && x->depth)
        own.depth = *x->depth;
    if (own.hit && x->dir)
        own.dir = *x->dir;
    if (own.hit && x->dir && q->call == CALL_SEPARATE)
        answer_by_length(&own);
    return own;
}

/* Returns whether a hit has a direction that is not unit, or a depth that is not finite, where it passes pointers to them. */
static int is_broken(const query_t *q, const call_args_t *x)
{
    const int is_unit = !x->dir || fabs(sqrt((double)ccdVec3Len2(x->dir)) - 1) <= 1e-9;
    return q->call != CALL_SEPARATE && (!is_unit || (x->depth && !isfinite((double)*x->depth)));
}

/* Counts the program's own answer and judges a share. */
static void judge(const query_t *q, uint64_t number, int code, const call_args_t *x)
{
    compare_call_t *c = &compare.counts->call[q->call];
    const answer_t own = read_outputs(q, code, x);
    count_add(&c->returned, 1);
    count_add(&c->hits, (uint64_t)own.hit);
    count_add(&c->broken, own.hit && is_broken(q, x));
    if (!is_sampled(number))
        return;
    const uint64_t start = clock_now(CLOCK_THREAD_CPUTIME_ID);
    judge_query(&compare, q, &own);
    count_process_time();
    count_add(&compare.counts->judge_nanoseconds, clock_now(CLOCK_THREAD_CPUTIME_ID) - start);
}

static int query(int call, const void *a, const void *b, const ccd_t *ccd, call_args_t x)
{
    const query_t q = { call, { a, b }, ccd };
    pthread_once(&once, start);
    /* a nested query, of a callback that the tool called, is not the program's */
    if (guard_active())
        return library_call(base, call, a, b, ccd, &x);
    const uint64_t number = __atomic_fetch_add(&compare.counts->call[call].queries, 1, __ATOMIC_RELAXED);
    const int code = library_call(base, call, a, b, ccd, &x);
    judge(&q, number, code, &x);
    return code;
}

#define OBJECTS const void *a, const void *b, const ccd_t *ccd
#define EXPORT_DEPTH(name, call) \
    EXPORT int name(OBJECTS, ccd_real_t *depth, ccd_vec3_t *dir, ccd_vec3_t *pos) \
    { \
        return query(call, a, b, ccd, (call_args_t){.depth = depth, .dir = dir, .pos = pos}); \
    }
#define EXPORT_SEPARATION(name, call) \
    EXPORT int name(OBJECTS, ccd_vec3_t *sep) { return query(call, a, b, ccd, (call_args_t){.dir = sep}); }
#define EXPORT_BOOLEAN(name, call) \
    EXPORT int name(OBJECTS) { return query(call, a, b, ccd, (call_args_t){.depth = NULL}); }
#define EXPORT_CALL(name, word, kind, traits) EXPORT_##kind(name, CALL_##word)
LIBCCD_CALLS(EXPORT_CALL)

EXPORT void __ccdSupport(const void *obj1, const void *obj2, const ccd_vec3_t *dir, const ccd_t *ccd, ccd_support_t *supp)
{
    pthread_once(&once, start);
    base->raw_support(obj1, obj2, dir, ccd, supp);
    if (!guard_active())
        count_add(&compare.counts->raw_supports, 1);
}
