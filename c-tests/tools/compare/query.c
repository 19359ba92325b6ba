/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Both libraries are opened apart from the rest of the process: libccd calls its own functions
 * by name, and without RTLD_DEEPBIND would get those of the library that was loaded first. */

#define _GNU_SOURCE
#include "tools/compare/compare.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

/* --- libraries -------------------------------------------------------------------- */

int find_symbol(void *handle, const char *name, void *function)
{
    void *symbol = dlsym(handle, name);
    memcpy(function, &symbol, sizeof symbol); /* ISO C has no cast from an object pointer */
    return symbol ? 0 : -1;
}

int library_open(library_t *library, const char *path, int is_ours)
{
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
    if (!handle) {
        fprintf(stderr, "compare: %s\n", dlerror());
        return -1;
    }
    int missing = find_symbol(handle, "__ccdSupport", &library->raw_support);
    for (int call = 0; call < LIBCCD_CALL_COUNT; call++)
        missing |= find_symbol(handle, call_table[call].name, &library->call[call]);
    find_symbol(handle, "ccdPenetrationProven", &library->proven);
    find_symbol(handle, "ccdImplementation", &library->implementation);
    if (missing || (library->proven != NULL) != is_ours) {
        const char *what = missing ? "no libccd" : is_ours ? "not this library" : "this library, not libccd";
        fprintf(stderr, "compare: %s is %s\n", path, what);
        return -1;
    }
    return 0;
}

double query_tolerance(const query_t *q)
{
    const double t = (double)(call_table[q->call].traits & FROM_CENTERS ? q->ccd->mpr_tolerance : q->ccd->epa_tolerance);
    return t >= 0 && t < HUGE_VAL ? t : 1e-4;
}

int library_call(const library_t *library, int call, const void *a, const void *b, const ccd_t *ccd, const call_args_t *x)
{
    switch (call) {
#define CALL_CASE(name, word, kind, traits) \
    case CALL_##word: return PASS_##kind(((__typeof__(&name))library->call[CALL_##word]));
        LIBCCD_CALLS(CALL_CASE)
#undef CALL_CASE
    default: return CCD_BAD_INPUT;
    }
}

void query_library(const library_t *library, const query_t *q, answer_t *out)
{
    const call_args_t rest = {.depth = &out->depth, .dir = &out->dir, .pos = &out->pos};
    memset(out, 0, sizeof *out);
    out->code = library_call(library, q->call, q->obj[0], q->obj[1], q->ccd, &rest);
    out->hit = is_hit(q->call, out->code);
    if (q->call == CALL_SEPARATE)
        answer_by_length(out);
}

void answer_by_length(answer_t *out)
{
    out->depth = (ccd_real_t)sqrt((double)ccdVec3Len2(&out->dir));
    if (out->depth > 0)
        ccdVec3Scale(&out->dir, 1 / out->depth);
}

verdict_t answer_verdict(const query_t *q, const answer_t *answer, const verdict_truth_t *truth)
{
    verdict_answer_t a = { answer->hit, !is_intersect(q->call), (double)answer->depth, (double)ccdVec3Len2(&answer->dir) };
    if (q->call == CALL_SEPARATE && answer->depth == 0)
        a.length2 = 1; /* a vector of no length has no direction */
    return verdict(&a, truth);
}

/* --- recording callbacks ---------------------------------------------------------- */

/* The object behind a pointer. */
typedef struct {
    request_t *request;
    int which; /* 0: obj1 */
} object_t;

static ccd_center_fn center_of(const object_t *o) { return o->which ? o->request->q->ccd->center2 : o->request->q->ccd->center1; }

/* Adds a sample; with one of obj1 in the opposite direction before it, that of obj2 gives a support value. */
static void record(const object_t *o, const support_sample_t *sample)
{
    request_t *r = o->request;
    samples_t *s = r->samples;
    const support_sample_t *first = &r->pending;
    const double length = sqrt((double)ccdVec3Len2(&sample->dir));
    int k;
    if (!s)
        return;
    if (s->count[o->which] < MAX_SAMPLES)
        s->sample[o->which][s->count[o->which]++] = *sample;
    if (!o->which) {
        r->pending = *sample;
        r->has_pending = 1;
        return;
    }
    if (r->has_pending && length > 0) {
        double h = 0;
        for (k = 0; k < 3 && sample->dir.v[k] == -first->dir.v[k]; k++)
            h -= (double)sample->dir.v[k] * (double)(first->point.v[k] - sample->point.v[k]) / length;
        if (k == 3 && h < s->least) {
            s->least = h;
            for (k = 0; k < 3; k++)
                s->least_dir.v[k] = -sample->dir.v[k] / (ccd_real_t)length;
            s->least_sample[0] = *first;
            s->least_sample[1] = *sample;
        }
    }
    r->has_pending = 0;
}

/* Tilts a direction about an axis that is none of a usual scene's, nor the library's own. */
static ccd_vec3_t tilted(const ccd_vec3_t *dir, double tilt)
{
    const ccd_vec3_t axis = {{(ccd_real_t)-0.64, (ccd_real_t)0.6, (ccd_real_t)0.48}};
    ccd_vec3_t across, out = *dir;
    ccdVec3Cross(&across, &axis, dir);
    ccdVec3Scale(&across, (ccd_real_t)tilt);
    ccdVec3Add(&out, &across);
    return out;
}

static void recording_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *point)
{
    const object_t *o = (const object_t *)obj;
    request_t *r = o->request;
    support_sample_t sample = { r->tilt > 0 ? tilted(dir, r->tilt) : *dir, {{0}} };
    if (r->calls >= MAX_CALLS)
        guard_end();
    r->calls++;
    (o->which ? r->q->ccd->support2 : r->q->ccd->support1)(r->q->obj[o->which], &sample.dir, point);
    if (o->which && r->shift)
        ccdVec3Add(point, r->shift);
    sample.point = *point;
    record(o, &sample);
}

static void recording_center(const void *obj, ccd_vec3_t *center)
{
    const object_t *o = (const object_t *)obj;
    samples_t *s = o->request->samples;
    center_of(o)(o->request->q->obj[o->which], center);
    if (s) {
        s->centre[o->which] = *center;
        s->has_centre[o->which] = 1;
    }
}

static void recording_first_dir(const void *obj1, const void *obj2, ccd_vec3_t *dir)
{
    const request_t *r = ((const object_t *)obj1)->request;
    const int a = ((const object_t *)obj1)->which, b = ((const object_t *)obj2)->which;
    r->q->ccd->first_dir(r->q->obj[a], r->q->obj[b], dir);
    if (r->samples)
        r->samples->first_dir = *dir;
}

static void along_x(const void *obj1, const void *obj2, ccd_vec3_t *dir)
{
    (void)obj1;
    (void)obj2;
    ccdVec3Set(dir, 1, 0, 0);
}

request_t request_of(request_kind_t kind, const library_t *library, const query_t *q, samples_t *samples)
{
    request_t r;
    memset(&r, 0, sizeof r);
    r.kind = kind;
    r.library = library;
    r.q = q;
    r.samples = samples;
    return r;
}

void request_run(void *request)
{
    request_t *r = (request_t *)request;
    object_t object[2] = { { r, 0 }, { r, 1 } };
    ccd_t ccd = *r->q->ccd;
    const query_t q = { r->q->call, { &object[0], &object[1] }, &ccd };
    ccd.support1 = ccd.support2 = recording_support;
    ccd.center1 = ccd.center1 ? recording_center : NULL;
    ccd.center2 = ccd.center2 ? recording_center : NULL;
    ccd.first_dir = ccd.first_dir ? recording_first_dir : NULL;
    switch (r->kind) {
    case REQUEST_ANSWER: query_library(r->library, &q, &r->answer); break;
    case REQUEST_MINIMUM:
        ccd.center1 = ccd.center2 = NULL;
        if (!ccd.first_dir)
            ccd.first_dir = along_x;
        ccd.epa_tolerance = (ccd_real_t)r->tolerance;
        ccd.max_iterations = 2000;
        r->code = r->library->proven(&object[0], &object[1], &ccd, NULL, 0, &r->least);
        break;
    case REQUEST_VALUE: {
        ccd_vec3_t point[2], back = *r->dir;
        ccdVec3Scale(&back, -1);
        recording_support(&object[0], r->dir, &point[0]);
        recording_support(&object[1], &back, &point[1]);
        ccdVec3Sub(&point[0], &point[1]);
        r->value = (double)ccdVec3Dot(&point[0], r->dir);
    }
    }
}
