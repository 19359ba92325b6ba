/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Replays the recorded contact sequence through penetration queries, judges every result by the certified truth and
 * prints one line of text a method. Settings are those of the simulators: tolerance 1e-6 m, at most 500 iterations.
 *
 * The program is built against libccd's interface alone: one binary runs on whichever libccd.so.2 the dynamic linker
 * finds. With -DOURS_ALONE it also has this library's extension, without and with a warm state for each pair of bodies.
 *
 * With -DONE_TOLERANCE libccd's GJK runs at that of the simulators alone, by which compare.sh judges too.
 *
 *   replay RECORDING [PASSES]     the fastest pass of each frame counts (default: 1 pass) */

#define _POSIX_C_SOURCE 199309L
#include "tools/record/recording.h"
#include "harness/verdict.h"
#ifdef OURS_ALONE
#include "harness/this_library.h"
#endif

#include <time.h>

static const double TOLERANCE = 1e-6;   /* metres */
static const double CONTACT_EPS = 1e-9; /* depths within this are neither hit nor miss: the bodies measure decimetres */

typedef struct {
    const shape_t *obj1, *obj2;
    const ccd_t *ccd;
    unsigned pair; /* number of these two bodies, the same in every frame, below bodies * bodies */
} query_t;

typedef struct {
    int code;
    ccd_real_t depth;
    ccd_vec3_t dir, pos;
} result_t;

typedef struct method {
    const char *name;
    int (*evaluate)(const struct method *, const query_t *, result_t *);
    int (*libccd)(const void *, const void *, const ccd_t *, ccd_real_t *, ccd_vec3_t *, ccd_vec3_t *);
    int call, is_warm, has_pos; /* of the extension */
    unsigned long queries, overlaps, supports, judged, verdicts[VERDICTS];
    unsigned long directions; /* wrong, of right depths */
    double error_sum, error_max; /* metres, of those judged: hits that are hits */
    double *frame[2];            /* nanoseconds of each frame in its fastest pass: pairs apart, pairs that overlap */
} method_t;

static int evaluate_libccd(const method_t *m, const query_t *q, result_t *out)
{
    return m->libccd(q->obj1, q->obj2, q->ccd, &out->depth, &out->dir, &out->pos);
}

#ifndef ONE_TOLERANCE
/* The same with an epa_tolerance of 1e-12: libccd compares it with square metres. */
static int evaluate_squared(const method_t *m, const query_t *q, result_t *out)
{
    ccd_t ccd = *q->ccd;
    ccd.epa_tolerance = (ccd_real_t)(TOLERANCE * TOLERANCE);
    return m->libccd(q->obj1, q->obj2, &ccd, &out->depth, &out->dir, &out->pos);
}
#endif

enum { SUPPORT_POINTS = 8 };

/* Evaluates both support functions in one direction after another, to measure the price of a support point. */
static int evaluate_supports(const method_t *m, const query_t *q, result_t *out)
{
    for (int i = 0; i < SUPPORT_POINTS; i++) {
        ccd_vec3_t dir, back, point;
        ccdVec3Set(&dir, (ccd_real_t)(i & 1 ? .6 : -.6), (ccd_real_t)(i & 2 ? .48 : -.48), (ccd_real_t)(i & 4 ? .64 : -.64));
        ccdVec3Set(&back, -dir.v[0], -dir.v[1], -dir.v[2]);
        q->ccd->support1(q->obj1, &dir, &point);
        q->ccd->support2(q->obj2, &back, &point);
    }
    (void)m;
    (void)out;
    return -1;
}

#ifdef OURS_ALONE
static ccd_warm_t *state; /* of each pair of bodies */

static int evaluate_extension(const method_t *m, const query_t *q, result_t *out)
{
    ccd_penetration_t full;
    call_args_t rest = {.want = CCD_WANT_ALL, .depth = &out->depth, .dir = &out->dir, .penetration = &full};
    rest.warm = m->is_warm ? &state[q->pair] : NULL;
    rest.pos = m->has_pos ? &out->pos : NULL;
    int code = call_library(m->call, q->obj1, q->obj2, q->ccd, &rest);
    if (m->call == CALL_MPR || m->call == CALL_MPR_WARM || (code != CCD_HIT && code != CCD_LIMIT))
        return code;
    out->depth = full.depth;
    out->dir = full.dir;
    out->pos = full.pos;
    return 0;
}
#endif

/* Support points are first; the table leaves them out. */
static method_t method[] = {
    {.name = "support points", .evaluate = evaluate_supports},
    {.name = "MPR", .evaluate = evaluate_libccd, .libccd = ccdMPRPenetration},
    {.name = "GJK + EPA", .evaluate = evaluate_libccd, .libccd = ccdGJKPenetration},
#ifndef ONE_TOLERANCE
    {.name = "GJK + EPA, 1e-12", .evaluate = evaluate_squared, .libccd = ccdGJKPenetration},
#endif
#ifdef OURS_ALONE
    {.name = "MPR, no pos", .evaluate = evaluate_extension, .call = CALL_MPR},
    {.name = "MPR, warm", .evaluate = evaluate_extension, .call = CALL_MPR_WARM, .is_warm = 1, .has_pos = 1},
    {.name = "MPR, warm, no pos", .evaluate = evaluate_extension, .call = CALL_MPR_WARM, .is_warm = 1},
    {.name = "local", .evaluate = evaluate_extension, .call = CALL_LOCAL},
    {.name = "local, warm", .evaluate = evaluate_extension, .call = CALL_LOCAL, .is_warm = 1},
    {.name = "proven", .evaluate = evaluate_extension, .call = CALL_PROVEN},
    {.name = "proven, warm", .evaluate = evaluate_extension, .call = CALL_PROVEN, .is_warm = 1},
#endif
};
enum { METHODS = sizeof method / sizeof method[0] };

/* Returns the depth along a direction: the support value of the difference. */
static double depth_along(const shape_t *obj1, const shape_t *obj2, const ccd_t *ccd, const ccd_vec3_t *dir)
{
    ccd_vec3_t back = *dir, first, second;
    ccdVec3Scale(&back, -1);
    ccd->support1(obj1, dir, &first);
    ccd->support2(obj2, &back, &second);
    ccdVec3Sub(&first, &second);
    return (double)ccdVec3Dot(&first, dir);
}

/* Judges one result by the bounds on the signed depth: the depth, and where that is right the direction. */
static void judge(method_t *m, const result_t *result, const recording_pair_t *pair, const shape_t *body, const ccd_t *ccd)
{
    const verdict_truth_t truth = {pair->lower, pair->upper, TOLERANCE, CONTACT_EPS};
    const verdict_answer_t answer = {result->code == 0, 1, (double)result->depth, (double)ccdVec3Len2(&result->dir)};
    const verdict_t v = verdict(&answer, &truth);
    m->queries++;
    m->overlaps += pair->lower > 0;
    m->verdicts[v]++;
    m->directions += v == VERDICT_RIGHT && answer.hit
                     && !(depth_along(&body[pair->a], &body[pair->b], ccd, &result->dir) <= 1.01 * pair->upper + 2 * TOLERANCE);
    if (verdict_has_error(&answer, v)) {
        const double error = verdict_error(&answer, &truth);
        m->error_sum += error;
        m->error_max = fmax(m->error_max, error);
        m->judged++;
    }
}

/* Returns the processor time of this process, in nanoseconds. */
static double process_time(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e9 * (double)now.tv_sec + (double)now.tv_nsec;
}

/* Queries the pairs of frame f that overlap, or those that do not, and stores their time if it is the least so far. */
static void time_frame(const recording_t *r, method_t *m, uint32_t f, const recording_pair_t *pair, int overlap,
                       const shape_t *body, const ccd_t *ccd, result_t *result)
{
    double time = process_time();
    for (uint32_t i = 0; i < r->frame_pairs[f]; i++, pair++) {
        if ((pair->lower > 0) != overlap)
            continue;
        const query_t q = {&body[pair->a], &body[pair->b], ccd, pair->a * r->bodies + pair->b};
        result[i].code = m->evaluate(m, &q, &result[i]);
    }
    time = process_time() - time;
    if (m->frame[overlap][f] <= 0 || time < m->frame[overlap][f])
        m->frame[overlap][f] = time;
}

/* Queries every pair; the first pass is judged. */
static void replay_pass(const recording_t *r, method_t *m, int is_first, shape_t *body, result_t *result)
{
    const recording_pair_t *pair = r->pair;
    ccd_t ccd = shape_query();
    ccd.mpr_tolerance = ccd.epa_tolerance = (ccd_real_t)TOLERANCE;
    ccd.max_iterations = 500;
    for (uint32_t f = 0; f < r->frames; pair += r->frame_pairs[f++]) {
        recording_place(r, f, body);
        time_frame(r, m, f, pair, 1, body, &ccd, result);
        time_frame(r, m, f, pair, 0, body, &ccd, result);
        for (uint32_t i = 0; is_first && i < r->bodies; i++)
            m->supports += body[i].calls;
        for (uint32_t i = 0; is_first && i < r->frame_pairs[f]; i++)
            judge(m, &result[i], &pair[i], body, &ccd);
    }
}

/* Returns the nanoseconds of all frames, of the pairs apart (0) or of those that overlap (1). */
static double total_time(const method_t *m, uint32_t frames, int overlap)
{
    double sum = 0;
    for (uint32_t f = 0; f < frames; f++)
        sum += m->frame[overlap][f];
    return sum;
}

static void print_table(const recording_t *r)
{
    printf("%u bodies, %u frames, %u pairs, %lu of them overlap\n\n", (unsigned)r->bodies, (unsigned)r->frames, (unsigned)r->pairs,
           method[0].overlaps);
    printf("%-17s %6s %5s %6s %5s %7s %5s %7s %6s %8s %5s %5s\n", "method", "missed", "false", "broken", "deep", "unsound", "dir", "mean um",
           "max um", "supports", "hit", "ns");
    for (const method_t *m = method + 1; m < method + METHODS; m++) {
        const double overlaps = fmax(1, (double)m->overlaps), queries = fmax(1, (double)m->queries);
        const double hits = total_time(m, r->frames, 1), misses = total_time(m, r->frames, 0);
        /* a support point of the difference takes a call of each shape */
        printf("%-17s %6lu %5lu %6lu %5lu %7lu %5lu %7.3g %6.0f %8.2f %5.0f %5.0f\n", m->name, m->verdicts[VERDICT_MISSED],
               m->verdicts[VERDICT_SPURIOUS], m->verdicts[VERDICT_INVALID], m->verdicts[VERDICT_DEEP],
               m->verdicts[VERDICT_UNSOUND], m->directions, 1e6 * m->error_sum / fmax(1, (double)m->judged), 1e6 * m->error_max,
               (double)m->supports / 2 / queries, hits / overlaps, (hits + misses) / queries);
    }
    printf("\na support point alone: %.1f ns\n", (total_time(&method[0], r->frames, 0) + total_time(&method[0], r->frames, 1)) /
                                                      fmax(1, (double)method[0].queries) / SUPPORT_POINTS);
}

/* Runs every method in turn, so that all of them meet the same moments of the machine. Returns an exit code: 0, or 1
 * without memory. */
static int replay(const recording_t *r, int passes, shape_t *body)
{
    result_t *result = (result_t *)calloc((size_t)r->pairs + 1, sizeof *result);
    int failed = !result;
    for (int k = 0; k < 2 * METHODS; k++)
        failed |= !(method[k / 2].frame[k % 2] = (double *)calloc((size_t)r->frames + 1, sizeof(double)));
#ifdef OURS_ALONE
    const size_t states = (size_t)r->bodies * r->bodies * sizeof *state;
    failed |= !(state = (ccd_warm_t *)malloc(states));
#endif
    for (int k = 0; !failed && k < passes * METHODS; k++) {
#ifdef OURS_ALONE
        memset(state, 0, states); /* cold */
#endif
        replay_pass(r, &method[k % METHODS], k < METHODS, body, result);
    }
    if (!failed)
        print_table(r);
    free(result);
    return failed;
}

int main(int argc, char **argv)
{
    recording_t r;
    const int passes = argc > 2 ? atoi(argv[2]) : 1;
    if ((argc != 2 && argc != 3) || passes < 1 || recording_read(argv[1], &r) != 0) {
        fprintf(stderr, "usage: %s RECORDING [PASSES] (a whole recording, with its truth)\n", argv[0]);
        return 2;
    }
    shape_t *body = (shape_t *)malloc(r.bodies * sizeof *body);
    return !body || replay(&r, passes, body);
}
