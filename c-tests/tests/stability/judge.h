/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Judges the answer of an entry point by the exact truth. */

#ifndef STABILITY_JUDGE_H
#define STABILITY_JUDGE_H

#include "entries.h"
#include "harness/tolerances.h"
#include "harness/verdict.h"

#include <stdio.h>

/* Faults of an answer: those of verdict.h, the same for both libraries; then breaches of what this library guarantees. */
#define FAULTS(X) \
    X(LOOP, "endless") \
    X(CRASH, "crash") \
    X(MISSED, "overlap missed") \
    X(FALSE_HIT, "false hit") \
    X(INVALID, "no direction or number") \
    X(DEEP, "too deep") \
    X(UNSOUND, "unsound") \
    X(NOT_SUPPORT, "depth is not the support value of its direction") \
    X(NOT_MINIMUM, "not the minimum within tolerance") \
    X(BOUND, "lower bound above the truth") \
    X(GAP, "gap above tolerance") \
    X(CODE, "code not as documented") \
    X(LIMIT, "stopped at the limit") \
    X(WITNESS_DEPTH, "witness points not the depth apart") \
    X(WITNESS_INSIDE, "witness points outside the shapes") \
    X(POSITION, "position not between the witness points") \
    X(SUPPORTS, "support points miscounted or too many") \
    X(WROTE_OUTPUTS, "outputs written without an answer")

enum {
#define STABILITY_FAULT_BIT(name, text) FAULT_BIT_##name,
    FAULTS(STABILITY_FAULT_BIT)
#undef STABILITY_FAULT_BIT
        FAULT_BIT_COUNT
};
enum {
#define STABILITY_FAULT(name, text) FAULT_##name = 1 << FAULT_BIT_##name,
    FAULTS(STABILITY_FAULT)
#undef STABILITY_FAULT
};
static const char *const fault_texts[] = {
#define STABILITY_FAULT_TEXT(name, text) text,
    FAULTS(STABILITY_FAULT_TEXT)
#undef STABILITY_FAULT_TEXT
};

/* Where a search may end at its limit, CCD_LIMIT. */
enum {
    LIMIT_NEVER,
    LIMIT_ON_CURVES,  /* where minima form a curve or surface, as pair_may_reach_limit estimates */
    LIMIT_ALLOWED,    /* minima form a curve or surface */
    LIMIT_ALL_AROUND, /* nearly every direction is a minimum: MPR's tolerance holds for all */
    LIMIT_ANYWHERE    /* the body or the tolerance is beyond what is guaranteed: the depth is sound, not the least */
};

/* What is checked of points. */
enum { POINTS_NOT, POINTS_BY_PLANES, POINTS_EXACT /* and the minimum of a local query */ };

/* The criteria by which an answer about a pair is judged. */
typedef struct {
    double size, noise; /* metres; noise: the rounding error of a depth */
    double tol;         /* the query's, metres */
    truth_t truth;
    int limit, points;
    int unproven;       /* a proof at this tolerance ended at the limit */
    int touching;       /* within rounding of touching: hit or miss */
} criteria_t;

static inline criteria_t criteria_of(const shape_t *a, const shape_t *b, double tol, const truth_t *truth)
{
    criteria_t q;
    memset(&q, 0, sizeof q);
    q.size = pair_size(a, b);
    q.noise = pair_noise(a, b);
    q.tol = tol;
    q.truth = *truth;
    q.points = POINTS_BY_PLANES;
    q.touching = truth->lower <= q.noise && truth->depth >= -q.noise;
    return q;
}

/* Computes h of the answer's normal, or direction. */
static inline void set_value(answer_t *x, const shape_t *a, const shape_t *b)
{
    const double *n = x->has_bounds ? x->normal : x->dir;
    x->has_value = truth_dot3(n, n) > 0;
    if (x->has_value)
        x->value = truth_support_value(a, b, n);
}

/* Returns how far a point may be off: as far as the depth may be, and where an open gap between the
 * bounds is allowed, by that. */
static inline double point_tolerance(const entry_t *e, const answer_t *x, const criteria_t *q)
{
    const double allowed = entry_is_mpr(e) ? fmax(q->tol, tolerance(TOL_MPR) * x->depth) : q->tol;
    /* The gap itself is judged (FAULT_GAP): of a hit it exceeds what is allowed only where rounding does, far from the origin. */
    const int has_gap = x->code == CCD_LIMIT || e->call == CALL_PROVEN || e->call == CALL_PENETRATION;
    const double reached = has_gap ? fmax(allowed, x->depth - x->lower) : allowed;
    return reached + q->noise + tolerance(TOL_WITNESS) * q->size;
}

/* Returns the signed distance of a point from the shape's supporting plane along the unit vector n. */
static inline double distance_from_plane(const shape_t *s, const double n[3], const double point[3])
{
    shape_t copy = *s;
    ccd_vec3_t dir, support;
    double sum = 0;
    for (int i = 0; i < 3; i++)
        dir.v[i] = (ccd_real_t)n[i];
    shape_support(&copy, &dir, &support);
    for (int i = 0; i < 3; i++)
        sum += n[i] * (point[i] - (double)support.v[i]);
    return sum;
}

/* Returns whether a point is farther than this outside of the shape, by 26 supporting planes, or exactly. */
static inline int is_outside(const shape_t *s, const double point[3], double bound, int points)
{
    int outside = 0;
    for (int i = 0; i < 27; i++) {
        double n[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}, l = sqrt(truth_dot3(n, n));
        for (int k = 0; k < 3; k++)
            n[k] /= l;
        outside |= l > 0 && !(distance_from_plane(s, n, point) <= bound);
    }
    if (points == POINTS_EXACT && !outside) {
        const truth_end_t end = {bound / 4, 100, -bound, -bound / 2};
        shape_t ball = shape_sphere(0);
        shape_move(&ball, point[0], point[1], point[2]);
        outside = truth_depth_until(s, &ball, end).depth < -bound;
    }
    return outside;
}

/* Returns h of the unit direction at n + part * step, which is written to m. */
static inline double value_near(const shape_t *a, const shape_t *b, const double n[3], const double step[3], double part,
                                double m[3])
{
    double l = 0;
    for (int k = 0; k < 3; k++) {
        m[k] = n[k] + part * step[k];
        l += m[k] * m[k];
    }
    for (int k = 0; k < 3; k++)
        m[k] /= sqrt(l);
    return truth_support_value(a, b, m);
}

/* Returns how far h falls by a descent of random steps from n, within a fiftieth of a rad. A step counts
 * where h falls all along it; steps grow after one that counts, up to a tenth of the way, and shrink after
 * each that does not. The first are short, so that the descent crosses no ridge into another minimum. */
static inline double descent(const shape_t *a, const shape_t *b, const double n[3])
{
    const double reach = .02, first = truth_support_value(a, b, n);
    double best[3], least = first, step = 1e-5 * reach;
    rng_t d = rng(9000, 0);
    memcpy(best, n, sizeof best);
    for (int i = 0; i < 200; i++) {
        double by[3], m[3], between[3], far = 0, before = least, h;
        for (int k = 0; k < 3; k++)
            by[k] = step * rng_uniform(&d, -1, 1);
        h = value_near(a, b, best, by, 1, m);
        for (int k = 0; k < 3; k++)
            far += (m[k] - n[k]) * (m[k] - n[k]);
        if (far > reach * reach)
            continue;
        for (int k = 1; k < 4 && h < before; k++) {
            const double there = value_near(a, b, best, by, k / 4., between);
            before = there < before ? there : -HUGE_VAL;
        }
        if (h < before) {
            least = h;
            memcpy(best, m, sizeof best);
            step = fmin(step * 2, reach / 10);
        } else {
            step *= .9;
        }
    }
    return first - least;
}

/* Judges pos, within half the depth of both shapes and a hair (in a shape thinner than the depth the middle of the
 * chord is outside), and the witness points: each in its shape and at its supporting plane, their difference the
 * depth along the normal and nothing across; pos their middle where no centre of pressure is guaranteed. */
static inline int judge_points(const entry_t *e, const answer_t *x, const shape_t *a, const shape_t *b, const criteria_t *q)
{
    const double bound = point_tolerance(e, x, q), from_pos = bound + (0.5 + 1.0 / 256) * x->depth;
    const double value = x->depth * truth_dot3(x->dir, x->normal), opposite[3] = {-x->normal[0], -x->normal[1], -x->normal[2]};
    const int has_centre = x->has_pos && (!x->has_bounds || (x->code == CCD_HIT && e->call != CALL_ALONG && e->call != CALL_PLANAR));
    /* The published method has at its limit the witness points of its best support plane, which are not the depth apart. */
    const int are_apart = e->call != CALL_INCREMENTAL || (x->code == CCD_HIT && q->limit != LIMIT_ANYWHERE);
    double d[3], across2 = 0, along;
    int faults = 0;
    if (has_centre && (is_outside(a, x->pos, from_pos, POINTS_BY_PLANES) || is_outside(b, x->pos, from_pos, POINTS_BY_PLANES)))
        faults |= FAULT_POSITION;
    if (!x->has_bounds)
        return faults;
    for (int i = 0; i < 3; i++) {
        d[i] = x->point1[i] - x->point2[i];
        across2 += (d[i] - x->depth * x->dir[i]) * (d[i] - x->depth * x->dir[i]);
        if (!has_centre && !(fabs(x->point1[i] - d[i] / 2 - x->pos[i]) <= q->noise))
            faults |= FAULT_POSITION;
    }
    along = truth_dot3(d, x->normal) - value;
    if (!(fabs(along) <= bound)
        || (are_apart && !(sqrt(fmax(across2 - along * along, 0)) <= sqrt(2 * (x->depth + bound) * bound) + bound)))
        faults |= FAULT_WITNESS_DEPTH;
    if (!(distance_from_plane(a, x->normal, x->point1) >= -bound) || !(distance_from_plane(b, opposite, x->point2) >= -bound)
        || is_outside(a, x->point1, bound, q->points) || is_outside(b, x->point2, bound, q->points))
        faults |= FAULT_WITNESS_INSIDE;
    if (q->points == POINTS_EXACT && e->call == CALL_LOCAL && x->code == CCD_HIT
        && descent(a, b, x->dir) > 2 * q->tol + q->noise + tolerance(TOL_WITNESS) * q->size)
        faults |= FAULT_NOT_MINIMUM;
    return faults;
}

static inline int is_unit(const double n[3]) { return fabs(sqrt(truth_dot3(n, n)) - 1) <= tolerance(TOL_UNIT_LENGTH); }

enum {
    MPR_POINTS = 160,     /* support points after which a depth of MPR is only within TOL_MPR_CAPPED */
    MOST_POINTS = 400     /* support points of any query at CCD_INIT's tolerance relative to the size */
};

/* Judges a signed distance: its sign agrees with the code, the plane is at the reported distance, the bounds
 * enclose the truth and close up to max_distance, and the points are in the objects; those of a gap are its upper
 * bound apart. If minima form a surface, the distance at the iteration limit must still be right. */
static inline int judge_distance(const entry_t *e, const answer_t *x, const shape_t *a, const shape_t *b, const criteria_t *q)
{
    const truth_t *t = &q->truth;
    const int is_limit = x->code == CCD_LIMIT, is_refined = x->distance <= x->max_distance;
    const double rounding = 2 * q->noise, floor = tolerance(TOL_PROOF_FLOOR) * largest_coordinate(a, b);
    const double within = is_limit ? fmax(q->tol, tolerance(TOL_MPR) * fabs(t->depth)) : q->tol;
    const double bound = point_tolerance(e, x, q) + x->margins;
    double apart2 = 0;
    int faults = 0;
    if (!x->has_bounds)
        return FAULT_CODE;
    if (is_limit && q->limit == LIMIT_NEVER)
        faults |= FAULT_LIMIT;
    if (!isfinite(x->depth) || !isfinite(x->lower) || !is_unit(x->normal))
        return faults | FAULT_INVALID;
    if ((!is_limit && (x->code == CCD_HIT) != (x->distance < 0)) || (x->distance == 0 && signbit(x->distance)))
        faults |= FAULT_CODE;
    if (x->depth < x->value - rounding)
        faults |= FAULT_UNSOUND;
    if (x->lower > x->depth || x->lower > t->depth + rounding)
        faults |= FAULT_BOUND;
    if (!is_limit && is_refined && x->depth - x->lower > q->tol + floor + rounding)
        faults |= FAULT_GAP;
    if (is_refined && x->depth > t->depth + within + rounding && !(is_limit && q->limit == LIMIT_ANYWHERE))
        faults |= FAULT_NOT_MINIMUM;
    if (q->points != POINTS_NOT && (is_outside(a, x->point1, bound, q->points) || is_outside(b, x->point2, bound, q->points)))
        faults |= FAULT_WITNESS_INSIDE;
    for (int i = 0; i < 3; i++)
        apart2 += (x->point1[i] - x->point2[i]) * (x->point1[i] - x->point2[i]);
    if (x->distance > 0 && !(fabs(sqrt(apart2) + x->lower + x->margins) <= rounding + tolerance(TOL_WITNESS) * q->size))
        faults |= FAULT_WITNESS_DEPTH;
    return faults;
}

/* Returns the breaches of what this library guarantees for a depth. value: h of the answer's direction. */
static inline int judge_guarantees(const entry_t *e, const answer_t *x, double value, const shape_t *a, const shape_t *b,
                                   const criteria_t *q)
{
    const truth_t *t = &q->truth;
    const double rounding = 2 * q->noise, least = fmax(t->depth, 0), floor = tolerance(TOL_PROOF_FLOOR) * largest_coordinate(a, b);
    const double mpr = fmax(q->tol, tolerance(TOL_MPR) * x->depth), gap = x->depth - x->lower;
    const unsigned long points = x->calls / 2;
    int faults = 0;
    if (x->has_bounds) {
        if (!is_unit(x->normal) || !(truth_dot3(x->dir, x->normal) > 0)
            || (e->call != CALL_ALONG && memcmp(x->dir, x->normal, sizeof x->dir) != 0))
            faults |= FAULT_INVALID;
        if (!(x->lower >= 0 && x->lower <= x->depth) || x->lower > t->depth + q->noise)
            faults |= FAULT_BOUND;
        /* pairs of calls, the last of which may lack one: a position queries one object at a time */
        if (x->supports != (x->calls + 1) / 2)
            faults |= FAULT_SUPPORTS;
    }
    if (q->points != POINTS_NOT)
        faults |= judge_points(e, x, a, b, q);
    /* h(dir) itself rounds by up to the noise, and a depth is never below 0 */
    if (!(fabs(x->depth - fmax(value, 0)) <= rounding))
        faults |= x->depth < value ? FAULT_NOT_SUPPORT | FAULT_UNSOUND : FAULT_NOT_SUPPORT;
    if (x->code == CCD_HIT
        && ((e->call == CALL_PROVEN && !(gap <= q->tol + floor + rounding)) || (e->call == CALL_PENETRATION && !(gap <= mpr + floor + rounding))))
        faults |= FAULT_GAP;
    if (entry_is_minimum(e)) {
        const int at_limit = x->code == CCD_LIMIT || (!x->has_bounds && q->unproven);
        const double within = q->limit == LIMIT_ALL_AROUND || at_limit ? fmax(q->tol, tolerance(TOL_MPR) * least) : q->tol;
        if (!(x->depth <= least + within + rounding) && !(at_limit && q->limit == LIMIT_ANYWHERE))
            faults |= FAULT_NOT_MINIMUM;
    }
    if (entry_is_mpr(e)) {
        const int at_limit = points >= MPR_POINTS;
        const double part = tolerance(at_limit ? TOL_MPR_CAPPED : TOL_MPR);
        if (!(x->depth <= least + fmax(q->tol, part * least) + rounding) && !(at_limit && q->limit == LIMIT_ANYWHERE))
            faults |= FAULT_NOT_MINIMUM;
    }
    if (e->call == CALL_ALONG && x->depth > least + q->tol + rounding && !(x->code == CCD_LIMIT && q->limit == LIMIT_ANYWHERE))
        faults |= FAULT_NOT_MINIMUM; /* the direction is the true normal */
    return faults;
}

/* Returns all faults of an answer. */
static inline int judge(const entry_t *e, const answer_t *answer, const shape_t *a, const shape_t *b, const criteria_t *q)
{
    const double tol = fmin(q->tol, tolerance(TOL_TABLE_CAP) / 2 * q->size) + q->noise;
    const verdict_truth_t truth = {q->truth.lower, q->truth.depth, tol, q->touching ? HUGE_VAL : q->noise};
    answer_t copy = *answer, *x = &copy;
    const int is_hit = x->code == CCD_HIT || x->code == CCD_LIMIT, is_zero = e->call == CALL_SEPARATE && x->depth == 0;
    const verdict_answer_t short_answer = {is_hit, !entry_is_boolean(e) && !is_zero, x->depth, truth_dot3(x->dir, x->dir)};
    const verdict_t v = verdict(&short_answer, &truth);
    double value;
    int faults = v == VERDICT_RIGHT ? 0 : FAULT_MISSED << (v - VERDICT_MISSED);
    if (x->code == ANSWER_LOOP || x->code == ANSWER_CRASH)
        return x->code == ANSWER_LOOP ? FAULT_LOOP : FAULT_CRASH;
    if (!x->has_value)
        set_value(x, a, b);
    if (!e->is_libccd && x->calls / 2 > MOST_POINTS && q->tol >= 1e-4 * q->size)
        faults |= FAULT_SUPPORTS;
    if (e->call == CALL_DISTANCE)
        return (faults & FAULT_SUPPORTS) | judge_distance(e, x, a, b, q);
    if (!is_hit && x->code != CCD_MISS)
        return FAULT_CODE;
    if (x->wrote_outputs)
        faults |= FAULT_WROTE_OUTPUTS;
    /* libccd's MPR misses overlaps thinner than its tolerance */
    if (e->is_libccd && q->truth.lower <= tolerance(TOL_DEEP) * q->size + q->noise)
        faults &= ~FAULT_MISSED;
    /* only structs can report a limit; ccdPenetration gives up after 160 support points, the local search then with a depth that
     * is the least within ccdPenetration's tolerance, the published method where it converges slowly */
    if (x->code == CCD_LIMIT && !x->has_bounds)
        faults |= FAULT_CODE;
    if (x->code == CCD_LIMIT && q->limit == LIMIT_NEVER && e->call != CALL_INCREMENTAL
        && !(e->call == CALL_PENETRATION && x->calls >= 2 * MPR_POINTS)
        && !(e->call == CALL_LOCAL && x->calls >= 2 * MPR_POINTS
             && x->depth <= q->truth.depth + fmax(q->tol, tolerance(TOL_MPR) * q->truth.depth) + 2 * q->noise))
        faults |= FAULT_LIMIT;
    if (is_zero && q->truth.depth > q->tol + q->noise)
        faults |= FAULT_UNSOUND;
    if (!short_answer.has_depth || !is_hit || faults & (FAULT_FALSE_HIT | FAULT_INVALID))
        return faults;
    if (e->call != CALL_SEPARATE && !e->is_libccd && !is_unit(x->dir))
        faults |= FAULT_INVALID;
    /* along a direction that is not the normal the plane is farther */
    value = x->has_bounds ? x->value / truth_dot3(x->dir, x->normal) : x->value;
    if (!(x->depth >= value - tol))
        faults |= FAULT_UNSOUND;
    if (e->is_libccd)
        return faults;
    /* judge_guarantees judges how deep */
    return (faults & ~FAULT_DEEP) | judge_guarantees(e, x, value, a, b, q);
}

/* Prints the faults' names. */
static inline void print_faults(int faults)
{
    int n = 0;
    for (int bit = 0; bit < FAULT_BIT_COUNT; bit++)
        if (faults >> bit & 1)
            printf("%s%s", n++ ? ", " : "", fault_texts[bit]);
}

static inline void print_answer(const answer_t *x)
{
    printf("code %d depth %.17g dir %.17g %.17g %.17g pos %.9g %.9g %.9g calls %lu", x->code, x->depth,
            x->dir[0], x->dir[1], x->dir[2], x->pos[0], x->pos[1], x->pos[2], x->calls);
    if (x->has_bounds)
        printf(" lower %.17g normal %.9g %.9g %.9g point1 %.9g %.9g %.9g point2 %.9g %.9g %.9g supports %lu",
                x->lower, x->normal[0], x->normal[1], x->normal[2], x->point1[0], x->point1[1], x->point1[2],
                x->point2[0], x->point2[1], x->point2[2], x->supports);
}

/* Prints a faulty answer on one line. */
static inline void print_faulty_answer(const entry_t *e, const answer_t *x, int faults, const truth_t *truth)
{
    printf("%s: ", e->name);
    print_faults(faults);
    printf(": ");
    print_answer(x);
    printf(", truth %.17g (lower %.17g) along %.17g %.17g %.17g\n", truth->depth, truth->lower, truth->n[0], truth->n[1],
           truth->n[2]);
}

/* Prints everything that makes the shape again. */
static inline void print_shape(const char *name, const shape_t *s)
{
    printf("%s: type %d p %.17g %.17g %.17g %.17g tie %d pos %.17g %.17g %.17g rot", name, (int)s->type, (double)s->p[0],
            (double)s->p[1], (double)s->p[2], (double)s->p[3], s->tie, (double)s->pos[0], (double)s->pos[1], (double)s->pos[2]);
    for (int i = 0; i < 9; i++)
        printf(" %.17g", (double)s->rot[i]);
    if (s->type == SHAPE_POLYTOPE) {
        printf(" verts %d", s->nverts);
        for (int i = 0; i < 3 * s->nverts && i < 300; i++)
            printf(" %.17g", (double)s->verts[i]);
    }
    printf("\n");
    for (int i = 0; s->type == SHAPE_SUM && i < 2; i++)
        print_shape("    part", s->parts + i);
}

#endif
