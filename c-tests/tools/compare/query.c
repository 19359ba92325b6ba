/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Both libraries are opened apart from the rest of the process: libccd calls its own functions
 * by name, and without RTLD_DEEPBIND would get those of whichever library is first. */

#define _GNU_SOURCE
#include "tools/compare/query.h"
#include "tools/compare/catch.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

audit_fn ask_audit;

/* --- libraries -------------------------------------------------------------------- */

static int symbol_of(void *handle, const char *name, void *function)
{
    void *symbol = dlsym(handle, name);
    memcpy(function, &symbol, sizeof symbol); /* ISO C has no cast from an object pointer */
    return symbol ? 0 : -1;
}

int library_open(library_t *library, const char *path, int ours)
{
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
    memset(library, 0, sizeof *library);
    if (!handle) {
        fprintf(stderr, "compare: %s\n", dlerror());
        return -1;
    }
    int missing = symbol_of(handle, "__ccdSupport", &library->raw_support);
    for (int call = 0; call < LIBCCD_CALL_COUNT; call++)
        missing |= symbol_of(handle, call_table[call].name, &library->call[call]);
    if (missing) {
        fprintf(stderr, "compare: %s is no libccd\n", path);
        return -1;
    }
    symbol_of(handle, "ccdPenetrationProven", &library->minimum);
    if ((library->minimum != NULL) != ours) {
        fprintf(stderr, "compare: %s is %s\n", path, ours ? "not this library" : "this library, not libccd");
        return -1;
    }
    return 0;
}

double query_tolerance(const query_t *q)
{
    const double t = (double)(call_table[q->call].traits & FROM_CENTERS ? q->ccd->mpr_tolerance : q->ccd->epa_tolerance);
    return t >= 0 && t < HUGE_VAL ? t : 1e-4;
}

int ask_call(const library_t *library, int call, const void *a, const void *b, const ccd_t *ccd, const call_args_t *x)
{
    switch (call) {
#define CALL_CASE(name, word, kind, traits) \
    case CALL_##word: return PASS_##kind(((__typeof__(&name))library->call[CALL_##word]));
        LIBCCD_CALLS(CALL_CASE)
#undef CALL_CASE
    default: return CCD_BAD_INPUT;
    }
}

static void ask(const library_t *library, int call, const void *obj1, const void *obj2, const ccd_t *ccd, answer_t *out)
{
    const call_args_t rest = {.depth = &out->depth, .dir = &out->dir, .pos = &out->pos};
    memset(out, 0, sizeof *out);
    out->code = ask_call(library, call, obj1, obj2, ccd, &rest);
    out->hit = is_hit(call, out->code);
    if (call == CALL_SEPARATE)
        answer_by_length(out);
}

void answer_by_length(answer_t *out)
{
    out->depth = (ccd_real_t)sqrt((double)ccdVec3Len2(&out->dir));
    if (out->depth > 0)
        ccdVec3Scale(&out->dir, 1 / out->depth);
}

void ask_plainly(const library_t *library, const query_t *q, answer_t *out) { ask(library, q->call, q->obj[0], q->obj[1], q->ccd, out); }

/* --- through callbacks that write down ---------------------------------------------- */

/* The object behind a pointer. */
typedef struct {
    const query_t *q;
    asked_t *asked;
    int which; /* 0: obj1 */
} watched_t;

static ccd_center_fn center_of(const watched_t *w) { return w->which ? w->q->ccd->center2 : w->q->ccd->center1; }

static void write_down(const watched_t *w, const ccd_vec3_t *dir, const ccd_vec3_t *point)
{
    asked_t *a = w->asked;
    seen_t *s = a->seen;
    const double length = sqrt((double)ccdVec3Len2(dir));
    int k;
    if (!s)
        return;
    if (s->count[w->which] < SEEN) {
        seen_point_t *p = &s->point[w->which][s->count[w->which]++];
        p->dir = *dir;
        p->point = *point;
    }
    if (!w->which) {
        a->pending_dir = *dir;
        a->pending_point = *point;
        a->pending = &a->pending_dir;
        return;
    }
    if (a->pending && length > 0) {
        double h = 0;
        for (k = 0; k < 3 && dir->v[k] == -a->pending->v[k]; k++)
            h -= (double)dir->v[k] * (double)(a->pending_point.v[k] - point->v[k]) / length;
        if (k == 3 && h < s->least) {
            s->least = h;
            for (k = 0; k < 3; k++)
                s->least_dir.v[k] = -dir->v[k] / (ccd_real_t)length;
            s->least_point[0].dir = *a->pending;
            s->least_point[0].point = a->pending_point;
            s->least_point[1].dir = *dir;
            s->least_point[1].point = *point;
        }
    }
    a->pending = NULL;
}

static void watched_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *point)
{
    const watched_t *w = (const watched_t *)obj;
    const ccd_vec3_t asked_dir = *dir; /* the callback may be handed one place for both */
    if (w->asked->most && w->asked->calls >= w->asked->most)
        guard_end();
    w->asked->calls++;
    (w->which ? w->q->ccd->support2 : w->q->ccd->support1)(w->q->obj[w->which], dir, point);
    if (ask_audit && !guard_active())
        ask_audit(w->q->obj[w->which], center_of(w), &asked_dir, point);
    if (w->which && w->asked->shift)
        ccdVec3Add(point, w->asked->shift);
    write_down(w, &asked_dir, point);
}

static void watched_center(const void *obj, ccd_vec3_t *center)
{
    const watched_t *w = (const watched_t *)obj;
    center_of(w)(w->q->obj[w->which], center);
    if (w->asked->seen) {
        w->asked->seen->centre[w->which] = *center;
        w->asked->seen->centred[w->which] = 1;
    }
}

static void watched_first_dir(const void *obj1, const void *obj2, ccd_vec3_t *dir)
{
    const watched_t *a = (const watched_t *)obj1, *b = (const watched_t *)obj2;
    a->q->ccd->first_dir(a->q->obj[a->which], b->q->obj[b->which], dir);
    if (a->asked->seen) {
        a->asked->seen->first_dir = *dir;
        a->asked->seen->has_first_dir = 1;
    }
}

static void along_x(const void *obj1, const void *obj2, ccd_vec3_t *dir)
{
    (void)obj1;
    (void)obj2;
    ccdVec3Set(dir, 1, 0, 0);
}

/* The program's settings with callbacks that know watched_t; w has room for both objects. */
static ccd_t watched_settings(const query_t *q, asked_t *asked, watched_t w[2])
{
    ccd_t ccd = *q->ccd;
    for (int k = 0; k < 2; k++) {
        w[k].q = q;
        w[k].asked = asked;
        w[k].which = k;
    }
    ccd.support1 = ccd.support2 = watched_support;
    ccd.center1 = ccd.center1 ? watched_center : NULL;
    ccd.center2 = ccd.center2 ? watched_center : NULL;
    ccd.first_dir = ccd.first_dir ? watched_first_dir : NULL;
    return ccd;
}

void ask_watched(const library_t *library, const query_t *q, asked_t *asked, answer_t *out)
{
    watched_t w[2];
    const ccd_t ccd = watched_settings(q, asked, w);
    ask(library, q->call, &w[0], &w[1], &ccd, out);
}

int ask_minimum(const library_t *ours, const query_t *q, double tolerance, asked_t *asked, ccd_penetration_t *out)
{
    watched_t w[2];
    ccd_t ccd = watched_settings(q, asked, w);
    ccd.center1 = ccd.center2 = NULL;
    if (!ccd.first_dir)
        ccd.first_dir = along_x;
    ccd.epa_tolerance = (ccd_real_t)tolerance;
    ccd.max_iterations = 2000;
    return ours->minimum(&w[0], &w[1], &ccd, NULL, 0, out);
}

double ask_value(const query_t *q, asked_t *asked, const ccd_vec3_t *dir)
{
    watched_t w[2];
    ccd_vec3_t point[2], back = *dir;
    watched_settings(q, asked, w);
    ccdVec3Scale(&back, -1);
    watched_support(&w[0], dir, &point[0]);
    watched_support(&w[1], &back, &point[1]);
    ccdVec3Sub(&point[0], &point[1]);
    return (double)ccdVec3Dot(&point[0], dir);
}
