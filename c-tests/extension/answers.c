/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* What every answer of the extension must satisfy: hit or miss, depth, bounds, directions
 * and witness points as the comments of ccd_penetration_t say, against exact truth. Then
 * the same with objects swapped, with the state of the answer, with states that have
 * nothing to do with the pair, and with a bounded number of callbacks. */

#include "contract/check.h"
#include "ours.h"
#include "truth.h"

#include <float.h>

enum { LOCAL, INCREMENTAL, PROVEN, PENETRATION, ALONG, PLANAR, MPR, OVERLAP, QUERIES };
enum { PAIRS = 400, MOST_CALLS = 2500 };

static const char *const name[QUERIES] = {"local", "incremental", "proven", "penetration", "along", "planar", "mpr", "overlap"};
static const ccd_real_t epsilon = sizeof(ccd_real_t) == 8 ? (ccd_real_t)DBL_EPSILON : (ccd_real_t)FLT_EPSILON;

typedef struct {
    int query;
    shape_t a, b;
    ccd_vec3_t dir; /* along, or normal of the plane */
    ccd_t ccd;
    double tol, size;
    double depth; /* the truth: signed, along dir where that is asked for */
    double gap;   /* of the truth's bounds */
} case_t;

static unsigned long first_supports[QUERIES], repeated[QUERIES];
/* Pairs on which a search ended at the cap, from whichever state: where curvature and depth are
 * nearly equal, two balls about one centre for one, there are minima all around. */
static unsigned long limited[QUERIES];
static int is_limited;
static unsigned long most[QUERIES], asked[QUERIES], worse[QUERIES], hits[QUERIES], swapped_apart[QUERIES];
static unsigned long flipped_apart[QUERIES], flipped_calls[QUERIES], unflipped_calls[QUERIES];

/* What is asked for. Of a local search that is asked again pos costs as much as at first. */
static unsigned want = CCD_WANT_ALL;

static int ask(case_t *c, int swap, ccd_warm_t *warm, ccd_penetration_t *out)
{
    shape_t *a = swap ? &c->b : &c->a, *b = swap ? &c->a : &c->b;
    ccd_vec3_t dir = c->dir;
    int code, k, reads;
    a->calls = b->calls = 0;
    memset(out, 0, sizeof *out);
    for (k = 0; k < 3 && swap; k++)
        dir.v[k] = -dir.v[k];
    switch (c->query) {
    case LOCAL: code = OURS(ccdPenetrationLocal)(a, b, &c->ccd, warm, want, out); break;
    case INCREMENTAL: code = OURS(ccdPenetrationIncremental)(a, b, &c->ccd, warm, want, out); break;
    case PENETRATION: code = OURS(ccdPenetration)(a, b, &c->ccd, warm, want, out); break;
    case PROVEN: code = OURS(ccdPenetrationProven)(a, b, &c->ccd, warm, want, out); break;
    case ALONG: code = OURS(ccdPenetrationAlong)(a, b, &c->ccd, &dir, warm, want, out); break;
    case PLANAR: code = OURS(ccdPenetrationPlanar)(a, b, &c->ccd, &dir, warm, want, out); break;
    case MPR:
        code = OURS(ccdMPRPenetrationWarm)(a, b, &c->ccd, warm, &out->depth, &out->dir,
                                           want & CCD_WANT_POS ? &out->pos : NULL);
        out->normal = out->dir;
        break;
    default: code = OURS(ccdMPRIntersectWarm)(a, b, &c->ccd, warm) == 1 ? CCD_HIT : CCD_MISS; break;
    }
    /* For a position the objects are asked one by one. */
    reads = c->query == MPR || ((want & CCD_WANT_POS) != 0 && c->query != ALONG && c->query != PLANAR && c->query < MPR);
    CHECK((reads && code != CCD_MISS) || a->calls == b->calls, "%s: %lu and %lu calls", name[c->query], a->calls, b->calls);
    CHECK(code != CCD_HIT || c->query >= MPR || out->support_calls == (a->calls + b->calls + 1) / 2, "%s: %lu counted, %lu and %lu calls",
          name[c->query], out->support_calls, a->calls, b->calls);
    if (a->calls > most[c->query])
        most[c->query] = a->calls;
    asked[c->query]++;
    return code;
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void read3(const ccd_vec3_t *v, double out[3])
{
    int k;
    for (k = 0; k < 3; k++)
        out[k] = (double)v->v[k];
}

/* The conditions on one answer. */
static void judge(case_t *c, int swap, int code, const ccd_penetration_t *p, const char *state)
{
    const char *q = name[c->query];
    const double ulps = 64 * (double)epsilon * c->size;
    /* ccdPenetration may be 0.1 % too deep, and at the cap as much as its bounds are apart. */
    const double off = c->query != PENETRATION ? 0 : code == CCD_LIMIT ? (double)(p->depth - p->depth_lower) : 1e-3 * (double)p->depth;
    const double tol = fmax(c->tol, off) + ulps;
    const shape_t *a = swap ? &c->b : &c->a, *b = swap ? &c->a : &c->b;
    double n[3], d[3], p1[3], p2[3], pos[3], back[3], s1[3], s2[3], w[3], h, h1, h2, along, apart, across, sink, lost = 0;
    int k;
    if (fabs(c->depth) > 64 * (double)epsilon * c->size + c->gap)
        CHECK((code != CCD_MISS) == (c->depth > 0), "%s from %s: code %d at depth %g", q, state, code, c->depth);
    if (code == CCD_MISS || c->query == OVERLAP)
        return;
    CHECK(code == CCD_HIT || (code == CCD_LIMIT && c->query <= PENETRATION), "%s from %s: code %d", q,
          state, code);
    is_limited |= code == CCD_LIMIT;
    if (code != CCD_HIT && code != CCD_LIMIT)
        return;
    read3(&p->normal, n);
    read3(&p->dir, d);
    read3(&p->point1, p1);
    read3(&p->point2, p2);
    read3(&p->pos, pos);
    CHECK(fabs(dot(n, n) - 1) <= 16 * (double)epsilon, "%s: |normal|", q);
    CHECK(fabs(dot(d, d) - 1) <= 16 * (double)epsilon, "%s: |dir|", q);
    {
        double m[3];
        read3(&c->dir, m);
        CHECK(c->query != PLANAR || fabs(dot(d, m)) <= 64 * (double)epsilon * sqrt(dot(m, m)), "planar: %g out of the plane", dot(d, m));
    }
    CHECK(c->query == ALONG || memcmp(&p->dir, &p->normal, sizeof p->dir) == 0, "%s: dir is not normal", q);
    for (k = 0; k < 3; k++)
        back[k] = -n[k];
    {
        const double origin[3] = {0, 0, 0};
        truth_point(a, origin, n, s1);
        truth_point(b, origin, back, s2);
    }
    h1 = dot(s1, n);
    h2 = dot(s2, back);
    h = h1 + h2;
    along = dot(d, n);

    /* sound, and no deeper than the plane says */
    CHECK((double)p->depth >= 0 && fabs((double)p->depth * along - h) <= ulps, "%s from %s: depth %g, plane %g", q,
          state, (double)p->depth * along, h);
    /* the bounds */
    CHECK((double)p->depth_lower >= 0 && p->depth_lower <= p->depth, "%s: lower bound %g of %g", q,
          (double)p->depth_lower, (double)p->depth);
    CHECK((double)p->depth_lower <= c->depth + c->gap + ulps / along, "%s from %s: lower bound %g, truth %g", q, state,
          (double)p->depth_lower, c->depth);
    CHECK((double)p->depth >= c->depth - c->gap - ulps / along, "%s from %s: depth %g, truth %g", q, state,
          (double)p->depth, c->depth);
    if (c->query == PROVEN && code == CCD_HIT)
        CHECK((double)(p->depth - p->depth_lower) <= tol, "%s from %s: %g to %g", q, state, (double)p->depth_lower,
              (double)p->depth);
    if (c->query == PENETRATION && code == CCD_HIT) {
        CHECK((double)(p->depth - p->depth_lower) <= tol, "%s from %s: %g to %g", q, state, (double)p->depth_lower,
              (double)p->depth);
        CHECK((double)p->depth <= c->depth + c->gap + tol, "%s from %s: depth %g, truth %g", q, state,
              (double)p->depth, c->depth);
    }
    if (c->query == MPR) {
        const double part = (a->calls < 160 ? 1e-3 : 1e-2) * fmax(c->depth, 0);
        CHECK((double)p->depth <= c->depth + c->gap + fmax(c->tol, part) + ulps, "%s from %s: depth %g, truth %g", q, state,
              (double)p->depth, c->depth);
    }
    if (c->query == ALONG)
        CHECK((double)p->depth <= c->depth + c->gap + c->tol + ulps / along, "%s from %s: depth %g, truth %g", q, state,
              (double)p->depth, c->depth);

    /* the witness points */
    if (c->query == MPR)
        return;
    for (k = 0, sink = 0; k < 3; k++) {
        w[k] = p1[k] - p2[k];
        sink = fmax(sink, fabs(pos[k] - 0.5 * (p1[k] + p2[k])));
    }
    CHECK(sink <= ulps || (code == CCD_HIT && c->query != ALONG && c->query != PLANAR), "%s: pos is not the middle", q);
    CHECK(fabs(h1 - dot(p1, n)) <= tol, "%s from %s: point1 %g from its plane", q, state, h1 - dot(p1, n));
    CHECK(fabs(h2 - dot(p2, back)) <= tol, "%s from %s: point2 %g from its plane", q, state, h2 - dot(p2, back));
    apart = dot(w, n) - (double)p->depth * along;
    CHECK(fabs(apart) <= tol, "%s from %s: points %g too far apart", q, state, apart);
    for (k = 0, across = 0; k < 3; k++) {
        const double x = (w[k] - (double)p->depth * d[k]) - n[k] * apart;
        across += x * x;
    }
    CHECK(code == CCD_LIMIT || sqrt(across) <= sqrt(2 * (double)p->depth * tol) + tol, "%s from %s: points %g across, at depth %g", q, state,
          sqrt(across), (double)p->depth);
    /* A point lies in its shape when no plane has it outside: some planes. */
    for (k = 0, sink = 0; k < 30; k++) {
        const double origin[3] = {0, 0, 0};
        double m[3], l;
        int i;
        for (i = 0; i < 3; i++)
            m[i] = random_in(-1, 1);
        l = sqrt(dot(m, m));
        for (i = 0; i < 3; i++)
            m[i] /= l;
        truth_point(k % 2 ? a : b, origin, m, s1);
        sink = fmax(sink, dot(k % 2 ? p1 : p2, m) - dot(s1, m));
        lost = fmax(lost, dot(pos, m) - dot(s1, m));
    }
    CHECK(sink <= tol, "%s from %s: a witness %g outside", q, state, sink);
    CHECK(lost <= tol + 0.51 * (double)p->depth, "%s from %s: pos %g outside", q, state, lost);
}

/* A state that no query of this pair left. */
static void strange_state(int kind, ccd_warm_t *warm)
{
    static const double values[] = {0, 1, -1, 1e-300, 1e300, -1e300, 0.5, 1e-9};
    unsigned char *bytes = (unsigned char *)warm;
    ccd_real_t x;
    size_t i;
    for (i = 0; i < sizeof *warm; i++)
        bytes[i] = (unsigned char)random_below(256);
    if (kind == 0)
        return;
    /* numbers of every size, and the small integers that mean something at the end */
    for (i = 0; i + sizeof x <= sizeof *warm; i += sizeof x) {
        const int what = random_below(12);
        x = what < 8 ? (ccd_real_t)values[what] : what == 8 ? (ccd_real_t)HUGE_VAL : what == 9 ? (ccd_real_t)NAN
                                                                                  : (ccd_real_t)random_in(-1, 1);
        if (kind == 2)
            x = (ccd_real_t)random_in(-1, 1);
        memcpy(bytes + i, &x, sizeof x);
    }
    for (i = sizeof *warm - 16; i < sizeof *warm; i += sizeof(unsigned)) {
        const unsigned word = (unsigned)random_below(5);
        memcpy(bytes + i, &word, sizeof word);
    }
}

static shape_t random_shape(void)
{
    static ccd_real_t points[10 * 36];
    static int next;
    double p = random_in(0.3, 1), q = random_in(0.3, 1), r = random_in(0.3, 1), rot[9];
    int i, type = random_below(SHAPE_TYPES);
    shape_t s = shape_make(type, p, q, r);
    if (type == SHAPE_POLYTOPE) {
        next = (next + 1) % 10;
        for (i = 0; i < 36; i++)
            points[36 * next + i] = (ccd_real_t)random_in(-1, 1);
        s = shape_polytope(points + 36 * next, 12);
    }
    rotation_quaternion(random_in(-1, 1), random_in(-1, 1), random_in(-1, 1), random_in(-1, 1), rot);
    shape_turn(&s, rot);
    return s;
}

/* The depth of two polygons in the plane of their first two axes: over edge normals. */
static double planar_truth(const shape_t *a, const shape_t *b, const double m[3])
{
    const shape_t *both[2];
    double least = HUGE_VAL;
    int s, i, k;
    both[0] = a;
    both[1] = b;
    for (s = 0; s < 2; s++)
        for (i = 0; i < both[s]->nverts; i++) {
            ccd_real_t p[3], q[3];
            double e[3], n[3];
            int side;
            shape_to_world(both[s], both[s]->verts + 3 * i, p);
            shape_to_world(both[s], both[s]->verts + 3 * ((i + 1) % both[s]->nverts), q);
            for (k = 0; k < 3; k++)
                e[k] = (double)q[k] - (double)p[k];
            n[0] = e[1] * m[2] - e[2] * m[1];
            n[1] = e[2] * m[0] - e[0] * m[2];
            n[2] = e[0] * m[1] - e[1] * m[0];
            for (side = 0; side < 2; side++) {
                least = fmin(least, truth_value(a, b, n));
                for (k = 0; k < 3; k++)
                    n[k] = -n[k];
            }
        }
    return least;
}

static shape_t random_polygon(const double rot[9])
{
    static ccd_real_t corners[10 * 15];
    static int next;
    shape_t s;
    double spin[9], all[9];
    int i;
    next = (next + 1) % 10;
    for (i = 0; i < 5; i++) {
        const double angle = 2 * 3.14159265358979 * (i + random_in(0, 0.8)) / 5;
        corners[15 * next + 3 * i] = (ccd_real_t)cos(angle);
        corners[15 * next + 3 * i + 1] = (ccd_real_t)(0.7 * sin(angle));
        corners[15 * next + 3 * i + 2] = 0;
    }
    s = shape_polytope(corners + 15 * next, 5);
    rotation_about(0, 0, 1, random_in(0, 6), spin);
    rotation_times(rot, spin, all);
    shape_turn(&s, all);
    return s;
}

static void make(case_t *c, int query)
{
    double rot[9], u[3], l, far_off = random_in(0, 1.4);
    truth_t t;
    int k;
    c->query = query;
    for (k = 0; k < 3; k++) {
        u[k] = random_in(-1, 1);
        c->dir.v[k] = (ccd_real_t)random_in(-1, 1);
    }
    l = sqrt(dot(u, u));
    c->tol = sizeof(ccd_real_t) == 8 ? 1e-6 : 1e-4;
    if (query == PLANAR) {
        const double x = u[0], y = u[1];
        double m[3], o[3];
        rotation_quaternion(random_in(-1, 1), random_in(-1, 1), random_in(-1, 1), random_in(-1, 1), rot);
        c->a = random_polygon(rot);
        c->b = random_polygon(rot);
        for (k = 0; k < 3; k++) {
            m[k] = rot[3 * k + 2];
            o[k] = m[k] * random_in(-5, 5);
            u[k] = rot[3 * k] * x + rot[3 * k + 1] * y;
        }
        l = sqrt(dot(u, u));
        shape_move(&c->a, o[0], o[1], o[2]);
        shape_move(&c->b, o[0] + far_off * u[0] / l, o[1] + far_off * u[1] / l, o[2] + far_off * u[2] / l);
        for (k = 0; k < 3; k++)
            c->dir.v[k] = (ccd_real_t)(3 * m[k]);
        c->depth = planar_truth(&c->a, &c->b, m);
        c->gap = 64 * (double)epsilon;
        if (c->depth < 0) /* the largest of the separations along edges: a gap for certain */
            c->depth = fmin(c->depth, 0);
    } else {
        c->a = random_shape();
        c->b = random_shape();
        shape_move(&c->b, far_off * u[0] / l, far_off * u[1] / l, far_off * u[2] / l);
        t = truth_depth_within(&c->a, &c->b, 1e-6);
        c->depth = t.depth;
        c->gap = t.depth - t.lower;
        if (query == ALONG && t.lower > 0) {
            double d[3];
            read3(&c->dir, d);
            l = sqrt(dot(d, d));
            for (k = 0; k < 3; k++)
                d[k] /= l;
            t = truth_along(&c->a, &c->b, d);
            c->depth = t.depth;
            c->gap = t.depth - t.lower;
        }
    }
    c->size = pair_largest(&c->a, &c->b);
    shape_query(&c->ccd);
    c->ccd.epa_tolerance = c->ccd.mpr_tolerance = (ccd_real_t)c->tol;
}

/* Along a direction, by formula: two balls, two boxes whose axes are the world's. */
static void along_by_formula(void)
{
    int i, k;
    for (i = 0; i < 500; i++) {
        static case_t c;
        const double r = random_in(0.3, 1), s = random_in(0.3, 1);
        double d[3], at[3], h1[3], h2[3], exact = HUGE_VAL, l = 0, dc = 0, cc = 0;
        ccd_penetration_t out;
        int code;
        c.query = ALONG;
        for (k = 0; k < 3; k++) {
            d[k] = random_in(-1, 1);
            at[k] = random_in(-0.15, 0.15);
            h1[k] = random_in(0.2, 1);
            h2[k] = random_in(0.2, 1);
            l += d[k] * d[k];
        }
        for (k = 0, l = sqrt(l); k < 3; k++) {
            c.dir.v[k] = (ccd_real_t)(2 * d[k]);
            d[k] /= l;
            dc -= d[k] * at[k];
            cc += at[k] * at[k];
        }
        if (i % 2) {
            c.a = shape_sphere(r);
            c.b = shape_sphere(s);
            exact = dc + sqrt(dc * dc - cc + (r + s) * (r + s));
        } else {
            c.a = shape_box(h1[0], h1[1], h1[2]);
            c.b = shape_box(h2[0], h2[1], h2[2]);
            for (k = 0; k < 3; k++)
                exact = fmin(exact, (h1[k] + h2[k] - (d[k] < 0 ? -at[k] : at[k])) / fabs(d[k]));
        }
        shape_move(&c.b, at[0], at[1], at[2]);
        shape_query(&c.ccd);
        c.ccd.mpr_tolerance = sizeof(ccd_real_t) == 8 ? CCD_REAL(1e-9) : CCD_REAL(1e-4);
        code = ask(&c, 0, NULL, &out);
        CHECK(code == CCD_HIT, "along: %d", code);
        CHECK(fabs((double)out.depth - exact) <= 2 * (double)c.ccd.mpr_tolerance, "along: %.12g, formula %.12g",
              (double)out.depth, exact);
        CHECK((double)out.depth_lower <= exact + 100 * (double)epsilon * (1 + exact), "along: at least %.12g, formula %.12g",
              (double)out.depth_lower, exact);
        CHECK((double)(out.depth - out.depth_lower) <= 2 * (double)c.ccd.mpr_tolerance, "along: %.12g to %.12g",
              (double)out.depth_lower, (double)out.depth);
    }
}

/* A tilted plate sinks through a slab, a millimetre a frame. The least depth changes sides half
 * through; the local search keeps the side of its state, and a depth along a way that way,
 * until the two are apart. */
static void sides(void)
{
    shape_t slab = shape_box(2, 2, 0.05), plate = shape_box(0.25, 0.25, 0.01);
    const ccd_vec3_t up = {{0, 0, 1}};
    double rot[9];
    int kept = 0, least = 0, frame;
    ccd_warm_t warm[5];
    ccd_t ccd;
    memset(warm, 0, sizeof warm);
    shape_query(&ccd);
    ccd.mpr_tolerance = ccd.epa_tolerance = ccd.dist_tolerance = CCD_REAL(1e-5);
    rotation_about(1, 2, 0.3, 0.02, rot);
    shape_turn(&plate, rot);
    for (frame = 0; frame < 120; frame++) {
        const double depth = 0.001 * frame + 0.0061; /* the plate's corners are 5.6 mm lower than its middle */
        ccd_penetration_t local, along, minimum;
        ccd_distance_t distance;
        ccd_real_t mpr;
        ccd_vec3_t dir, pos;
        shape_move(&plate, 0.013, 0.027, 0.0605 - 0.001 * frame);
        CHECK(OURS(ccdPenetrationLocal)(&slab, &plate, &ccd, &warm[0], CCD_WANT_ALL, &local) == CCD_HIT, "frame %d", frame);
        CHECK(OURS(ccdPenetrationAlong)(&slab, &plate, &ccd, &up, &warm[1], CCD_WANT_ALL, &along) == CCD_HIT, "frame %d", frame);
        CHECK(OURS(ccdPenetrationProven)(&slab, &plate, &ccd, &warm[2], CCD_WANT_ALL, &minimum) == CCD_HIT, "frame %d", frame);
        CHECK(OURS(ccdMPRPenetrationWarm)(&slab, &plate, &ccd, &warm[3], &mpr, &dir, &pos) == 0, "frame %d", frame);
        CHECK(OURS(ccdSignedDistance)(&slab, &plate, &ccd, 0, 0, 0, &warm[4], CCD_WANT_ALL, &distance) == CCD_HIT, "frame %d", frame);
        CHECK(local.dir.v[2] > CCD_REAL(0.99) && fabs((double)local.depth - depth) < 1e-3, "local: %g at %g", (double)local.depth, depth);
        CHECK(along.dir.v[2] > CCD_REAL(0.99) && fabs((double)along.depth - depth) < 1e-3, "along: %g at %g", (double)along.depth, depth);
        CHECK((dir.v[2] > 0) == (minimum.dir.v[2] > 0) && (distance.normal.v[2] > 0) == (minimum.dir.v[2] > 0), "frame %d: sides", frame);
        kept += minimum.dir.v[2] > 0;
        least += minimum.dir.v[2] < 0;
    }
    CHECK(kept == 60 || kept == 61, "%d frames up, %d down", kept, least);
}

/* Calls of a query that wants no pos. */
static unsigned long without_pos(case_t *c, int swap, const ccd_warm_t *warm)
{
    ccd_penetration_t out;
    ccd_warm_t copy;
    if (warm)
        memcpy(&copy, warm, sizeof copy);
    want = CCD_WANT_POINTS;
    ask(c, swap, warm ? &copy : NULL, &out);
    want = CCD_WANT_ALL;
    return c->a.calls;
}

int main(void)
{
    static case_t c;
    int query, i;
    along_by_formula();
    sides();
    for (query = 0; query < QUERIES; query++) {
        ccd_warm_t foreign;
        memset(&foreign, 0, sizeof foreign);
        for (i = 0; i < PAIRS; i++) {
            ccd_penetration_t cold, out;
            ccd_warm_t warm, copy;
            double flip[9], old[9], rot[9];
            unsigned long calls;
            int code, again, k;
            make(&c, query);
            memset(&warm, 0, sizeof warm);
            code = ask(&c, 0, &warm, &cold);
            judge(&c, 0, code, &cold, "cold");
            if (code == CCD_HIT && c.depth > 0) {
                hits[query]++;
                first_supports[query] += without_pos(&c, 0, NULL);
                worse[query] += (double)cold.depth > 1.01 * c.depth + 2 * c.tol;
            }

            /* without a state: the same answer */
            again = ask(&c, 0, NULL, &out);
            CHECK(again == code && (code == CCD_MISS || memcmp(&out, &cold, sizeof out) == 0), "%s without a state",
                  name[query]);

            /* swapped */
            again = ask(&c, 1, NULL, &out);
            judge(&c, 1, again, &out, "swapped");
            if (code == CCD_HIT && again == CCD_HIT) {
                if (query == ALONG || query == PROVEN)
                    CHECK(fabs((double)(out.depth - cold.depth)) <= 2 * c.tol + c.gap + 1e3 * (double)epsilon,
                          "%s swapped: %g, %g", name[query], (double)cold.depth, (double)out.depth);
                swapped_apart[query] += fabs((double)(out.depth - cold.depth)) > 2 * c.tol + 1e3 * (double)epsilon;
            }

            /* a state that was not flipped leads no deeper than none */
            memcpy(&copy, &warm, sizeof copy);
            if (query == LOCAL && again == CCD_HIT) {
                ccd_penetration_t led;
                again = ask(&c, 1, &copy, &led);
                CHECK(again == CCD_HIT && (double)(led.depth - out.depth) <= c.tol, "unflipped: %g, cold %g", (double)led.depth,
                      (double)out.depth);
            }

            /* the state of the answer, moved by memcpy: sound, and the same whichever copy */
            if (code == CCD_HIT && c.depth > 0)
                repeated[query] += without_pos(&c, 0, &warm);
            memcpy(&copy, &warm, sizeof copy);
            again = ask(&c, 0, &copy, &out);
            judge(&c, 0, again, &out, "its own state");
            again = ask(&c, 0, &warm, &cold);
            CHECK(memcmp(&out, &cold, sizeof out) == 0 && memcmp(&warm, &copy, sizeof warm) == 0, "%s: a copied state",
                  name[query]);

            /* a state flipped serves the swapped pair */
            memcpy(&copy, &warm, sizeof copy);
            again = ask(&c, 0, &copy, &cold);
            k = (int)without_pos(&c, 0, &warm);
            memcpy(&copy, &warm, sizeof copy);
            OURS(ccdWarmFlip)(&copy);
            calls = without_pos(&c, 1, &copy);
            CHECK(ask(&c, 1, &copy, &out) == again || fabs(c.depth) <= c.gap + 64 * (double)epsilon * c.size,
                  "%s from a flipped state", name[query]);
            judge(&c, 1, again, &out, "a flipped state");
            unflipped_calls[query] += (unsigned long)k;
            flipped_calls[query] += calls;
            flipped_apart[query] += calls != (unsigned long)k || fabs((double)(out.depth - cold.depth)) > 64 * (double)epsilon * c.size;

            /* the state of another pair */
            again = ask(&c, 0, &foreign, &out);
            judge(&c, 0, again, &out, "a foreign state");
            memcpy(&foreign, &warm, sizeof foreign);

            /* bytes */
            for (k = 0; k < 6; k++) {
                strange_state(k % 3, &copy);
                again = ask(&c, 0, &copy, &out);
                judge(&c, 0, again, &out, "a strange state");
                again = ask(&c, 0, &copy, &out);
                judge(&c, 0, again, &out, "the state after a strange state");
            }

            /* b has turned by 180 degrees about the axis of a query that knew it otherwise */
            if (query != PLANAR) {
                double dummy[3] = {random_in(-1, 1), random_in(-1, 1), random_in(-1, 1)};
                truth_t t;
                rotation_about(dummy[0], dummy[1], dummy[2], 3.14159265358979, flip);
                for (k = 0; k < 9; k++)
                    old[k] = (double)c.b.rot[k];
                rotation_times(flip, old, rot);
                shape_turn(&c.b, rot);
                for (k = 0; k < 3; k++)
                    c.b.pos[k] = -c.b.pos[k];
                t = truth_depth_within(&c.a, &c.b, 1e-6);
                if (query == ALONG && t.lower > 0) {
                    double d[3], l;
                    read3(&c.dir, d);
                    l = sqrt(dot(d, d));
                    for (k = 0; k < 3; k++)
                        d[k] /= l;
                    t = truth_along(&c.a, &c.b, d);
                }
                c.depth = t.depth;
                c.gap = t.depth - t.lower;
                again = ask(&c, 0, &warm, &out);
                judge(&c, 0, again, &out, "a state from before a half turn");
            }
            limited[query] += (unsigned long)is_limited;
            is_limited = 0;
        }
        printf("%s: %lu queries, at most %lu supports; cold: %lu hits, %lu of them 1 %% above the minimum, "
               "%lu differ when swapped, %lu pairs at the cap\n",
               name[query], asked[query], most[query], hits[query], worse[query], swapped_apart[query], limited[query]);
        printf("    %.1f supports a hit, %.1f when asked again\n", (double)first_supports[query] / (double)hits[query],
               (double)repeated[query] / (double)hits[query]);
        printf("    from a flipped state %.2f for %.2f supports, %lu of %d answers differ\n",
               (double)flipped_calls[query] / PAIRS, (double)unflipped_calls[query] / PAIRS, flipped_apart[query], PAIRS);
        CHECK(50 * flipped_calls[query] <= 51 * unflipped_calls[query], "%s: a flipped state is worth less", name[query]);
        if (query == LOCAL || query == ALONG || query == PLANAR)
            CHECK(flipped_apart[query] <= PAIRS / 50, "%s: %lu differ", name[query], flipped_apart[query]);
        if (query == LOCAL || query == ALONG)
            CHECK(3 * repeated[query] <= 2 * first_supports[query], "%s: asked again", name[query]);
        /* The paper's method halves its way to round minima: it says so where others are long done. */
        CHECK(limited[query] <= (query == INCREMENTAL ? PAIRS / 16 : PAIRS / 200), "%s: %lu pairs at the cap", name[query],
              limited[query]);
        CHECK(most[query] <= MOST_CALLS, "%s: %lu supports", name[query], most[query]);
        CHECK(hits[query] > PAIRS / 4, "%s: %lu hits", name[query], hits[query]);
    }
    return checks_end();
}
