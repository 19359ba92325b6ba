/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* ODE's cylinder callback is wrong within about 1e-15 rad of the cylinder's axis: it divides what rounding leaves of the
 * direction across the axis by its length, and adds a radius of that, which has a part along the axis. The normal of a
 * cap is such a direction. Cylinders with this callback stand on parallel faces, a known depth deep or apart; every call
 * must find that depth, also on slabs of 1 m to 10 km, at tolerances of 1e-3 to 1e-9 m, and from a state that any call has
 * written. Then a pair at rest is queried with a state again and again: its direction must not turn.
 *
 *   ode_cylinder [poses, equal queries] */

#include "categories.h"

#include "tests/contract/check.h"

static const double TOLERANCE = 1e-6;

static void cylinder_support(const shape_t *s, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const ccd_real_t axis[3] = {s->rot[2], s->rot[5], s->rot[8]};
    const ccd_real_t along = dir->v[0] * axis[0] + dir->v[1] * axis[1] + dir->v[2] * axis[2];
    ccd_real_t across[3], length2 = 0;
    for (int i = 0; i < 3; i++) {
        across[i] = dir->v[i] - along * axis[i];
        length2 += across[i] * across[i];
        out->v[i] = s->pos[i] + (along > 0 ? s->p[1] : -s->p[1]) * axis[i];
    }
    const ccd_real_t length = (ccd_real_t)sqrt((double)length2);
    if (length > (ccd_real_t)real_eps())
        for (int i = 0; i < 3; i++)
            out->v[i] += across[i] * (s->p[0] / length);
}

static void support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const shape_t *s = (const shape_t *)obj;
    if (s->type == SHAPE_CYLINDER)
        cylinder_support(s, dir, out);
    else
        shape_support(obj, dir, out);
}

static ccd_t settings(double tolerance)
{
    ccd_t ccd = counting_query(tolerance);
    ccd.support1 = ccd.support2 = support;
    ccd.max_iterations = 500;
    return ccd;
}

/* Makes a rotation whose third column is one of the vectors that the tilt rotates about, or a world axis. */
static void special_frame(rng_t *r, double frame[9])
{
    static const double axes[][3] = {{.36, .48, .8}, {.6, .8, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double *n = axes[rng_below(r, 5)], sign = rng_sign(r);
    double q[3] = {rng_uniform(r, -1, 1), rng_uniform(r, -1, 1), rng_uniform(r, -1, 1)}, across = 0, length = 0;
    for (int i = 0; i < 3; i++)
        across += q[i] * n[i];
    for (int i = 0; i < 3; i++) {
        q[i] -= across * n[i];
        length += q[i] * q[i];
    }
    for (int i = 0; i < 3; i++) {
        frame[3 * i] = q[i] / sqrt(length);
        frame[3 * i + 2] = sign * n[i];
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        frame[3 * i + 1] = frame[3 * j + 2] * frame[3 * k] - frame[3 * k + 2] * frame[3 * j];
    }
}

/* Places b on the cap of cylinder a, `depth` into it along the axis, which is by far the least depth: turned about the
 * axis, and shifted along the cap by at most `shift`. */
static void place(rng_t *r, shape_t *a, shape_t *b, double depth, double shift)
{
    double q[4], frame[9], turn[9], rot[9], x = 0, y = 0, z;
    for (int i = 0; i < 4; i++)
        q[i] = rng_uniform(r, -1, 1);
    if (rng_below(r, 10))
        rotation_quaternion(q[0], q[1], q[2], q[3], frame);
    else
        special_frame(r, frame);
    rotation_about(0, 0, 1, rng_uniform(r, 0, 6), turn);
    rotation_times(frame, turn, rot);
    shape_turn(a, frame);
    shape_turn(b, rng_below(r, 2) ? rot : frame);
    if (rng_below(r, 2)) {
        x = rng_uniform(r, -shift, shift);
        y = rng_uniform(r, -shift, shift);
    }
    z = (double)a->p[1] + (double)(b->type == SHAPE_BOX ? b->p[2] : b->p[1]) - depth;
    for (int i = 0; i < 3; i++)
        q[i] = rng_uniform(r, -1, 1);
    shape_move(a, q[0], q[1], q[2]);
    shape_move(b, q[0] + frame[0] * x + frame[1] * y + frame[2] * z, q[1] + frame[3] * x + frame[4] * y + frame[5] * z,
               q[2] + frame[6] * x + frame[7] * y + frame[8] * z);
}

/* Returns the direction in which b leaves the cap of the cylinder. */
static ccd_vec3_t leaving(const shape_t *a, const shape_t *b)
{
    const shape_t *cylinder = a->type == SHAPE_CYLINDER ? a : b;
    double apart = 0;
    ccd_vec3_t dir;
    for (int i = 0; i < 3; i++)
        apart += (double)cylinder->rot[3 * i + 2] * ((double)b->pos[i] - (double)a->pos[i]);
    for (int i = 0; i < 3; i++)
        dir.v[i] = apart > 0 ? cylinder->rot[3 * i + 2] : -cylinder->rot[3 * i + 2];
    return dir;
}

/* Returns whether a call finds the signed depth within `error`, metres; checks that it is a hit for a positive one, and
 * otherwise a miss. */
static int is_right(const entry_t *e, const shape_t *a, const shape_t *b, double tolerance, ccd_warm_t *warm, double depth,
                    double error)
{
    const ccd_t ccd = settings(tolerance);
    const ccd_vec3_t along = leaving(a, b);
    answer_t x = {0};
    call_once(e, a, b, &ccd, warm, &along, &x);
    const int is_distance = e->call == CALL_DISTANCE, is_hit = is_distance ? x.code != CCD_MISS : x.code >= CCD_HIT;
    CHECK(is_hit == (depth > 0), "%s: %s, signed depth %g, tolerance %g, half side %g", e->name, is_hit ? "hit" : "miss", depth,
          tolerance, (double)b->p[0]);
    if (entry_is_boolean(e) || !(is_hit || is_distance))
        return 1;
    if (is_hit && e->call == CALL_ALONG)
        for (int i = 0; i < 3; i++)
            CHECK(fabs(x.dir[i] - (double)along.v[i]) <= 8 * real_eps(), "%s: another direction than the caller's", e->name);
    return fabs(x.depth - depth) <= error + (is_distance ? 0 : 1e-3 * depth) && (!x.has_bounds || x.lower <= depth + error);
}

/* Returns whether the method evaluates its directions as they are: the published one. */
static int is_exempt(const entry_t *e)
{
    return e->is_libccd || e->without_centres || e->call == CALL_INCREMENTAL;
}

/* Checks every call on one pair. `depth`: the signed depth, metres, not within a tolerance of 0. */
static void check_calls(const shape_t *a, const shape_t *b, double depth)
{
    for (const entry_t *e = entries; e < entries + ENTRIES; e++) {
        ccd_warm_t warm = {0};
        if (!is_exempt(e) && e->state <= STATE_ZERO)
            CHECK(is_right(e, a, b, TOLERANCE, &warm, depth, 2 * TOLERANCE), "%s: wrong depth, not %g", e->name, depth);
    }
}

/* Checks slabs of every size at every tolerance. Where a quarter of the tolerance over the size is below 1e-10, the
 * directions of a search are exact, and a vertex beyond a cap may spoil its bounds: a few answers may be wrong, where
 * those of libccd's MPR are wrong in 30 %. */
static void check_scales(int poses)
{
    for (double side = 1; side < 2e4; side *= 10)
        for (double tolerance = 1e-3; tolerance > 5e-10; tolerance *= .1) {
            int asked = 0, wrong = 0;
            for (int k = 0; k < poses; k++) {
                rng_t r = rng(4200, (uint64_t)k);
                shape_t a = shape_cylinder(.3, .4), b = shape_box(side / 2, side / 2, .5);
                const double depth = 1e-3;
                place(&r, &a, &b, depth, side / 4);
                for (const entry_t *e = entries; e < entries + ENTRIES; e++) {
                    ccd_warm_t warm = {0};
                    if (is_exempt(e) || e->state > STATE_ZERO)
                        continue;
                    asked++;
                    wrong += !is_right(e, &a, &b, tolerance, &warm, depth, 2 * tolerance + 1e-2 * depth);
                }
            }
            const int is_tilted = .25 * tolerance / (.8 * side + 1) >= 1e-10;
            CHECK(wrong <= (is_tilted ? 0 : asked / 100), "slab of %g m, tolerance %g m: %d of %d depths are wrong", side,
                  tolerance, wrong, asked);
        }
}

/* Checks every call from a state that another call, another tolerance or another pose has written. */
static void check_states(int poses)
{
    static const struct {
        const char *name;
        int call;
        double tolerance, depth, side;
    } writers[] = {
        {"along", CALL_ALONG, 1e-6, 1e-3, 2},
        {"incremental", CALL_INCREMENTAL, 1e-6, 1e-3, 2},
        {"a tolerance of 1e-9", CALL_PENETRATION, 1e-9, 1e-3, 2},
        {"a tolerance of 1e-12", CALL_PROVEN, 1e-12, 1e-3, 2},
        {"a gap of 1e-10 m", CALL_PENETRATION, 1e-6, -1e-10, 2},
        {"a gap of 1e-6 m", CALL_PENETRATION, 1e-6, -1e-6, 2},
        {"a distance of 1e-10 m", CALL_DISTANCE, 1e-12, -1e-10, 2},
        {"a slab of 1 km", CALL_PENETRATION, 1e-6, 1e-3, 1000},
    };
    for (size_t w = 0; w < sizeof writers / sizeof writers[0]; w++)
        for (int k = 0; k < poses; k++)
            for (const entry_t *e = entries; e < entries + ENTRIES; e++) {
                if (is_exempt(e) || e->state != STATE_OWN)
                    continue;
                rng_t r = rng(4300, (uint64_t)k), same = r;
                shape_t a = shape_cylinder(.3, .4), b = shape_box(writers[w].side / 2, writers[w].side / 2, .5);
                const entry_t writer = {writers[w].name, 0, writers[w].call, STATE_OWN, 0};
                const ccd_t ccd = settings(writers[w].tolerance);
                ccd_warm_t warm = {0};
                answer_t x;
                place(&r, &a, &b, writers[w].depth, .5);
                const ccd_vec3_t along = leaving(&a, &b);
                call_once(&writer, &a, &b, &ccd, &warm, &along, &x);
                b = shape_box(1, 1, .5);
                place(&same, &a, &b, 1e-3, .5);
                CHECK(is_right(e, &a, &b, TOLERANCE, &warm, 1e-3, 1e-2 * 1e-3), "%s with the state of %s: wrong depth", e->name,
                      writer.name);
            }
}

/* Queries a pair at rest with a state, in turns with TOLERANCE and with `other`, metres. */
static void check_rest(const shape_t *a, const shape_t *b, double other, int queries)
{
    ccd_warm_t warm[3];
    double first[2][3][3] = {{{0}}}, turned = 0;
    memset(warm, 0, sizeof warm);
    for (int k = 0; k < queries; k++) {
        ccd_penetration_t hit[3];
        const ccd_t ccd = settings(k % 2 ? other : TOLERANCE);
        const int is_hit = OURS(ccdPenetration)(a, b, &ccd, &warm[0], 0, &hit[0]) >= 0
            && OURS(ccdPenetrationProven)(a, b, &ccd, &warm[1], 0, &hit[1]) >= 0
            && OURS(ccdPenetrationLocal)(a, b, &ccd, &warm[2], 0, &hit[2]) >= 0;
        CHECK(is_hit, "query %d of a pair at rest is a miss", k);
        for (int i = 0; i < 3 && is_hit; i++)
            for (int j = 0; j < 3; j++) {
                if (k < 10) /* after which no direction is lower */
                    first[k % 2][i][j] = (double)hit[i].dir.v[j];
                else
                    turned = fmax(turned, fabs((double)hit[i].dir.v[j] - first[k % 2][i][j]));
            }
    }
    CHECK(turned <= 16 * real_eps(), "the direction of a pair at rest turns by %g rad, other tolerance %g", turned, other);
}

int main(int argc, char **argv)
{
    const int poses = argc > 1 ? atoi(argv[1]) : 2000, queries = argc > 2 ? atoi(argv[2]) : 10000;
    for (int k = 0; k < poses; k++) {
        rng_t r = rng(4100, (uint64_t)k);
        shape_t a = shape_cylinder(.35, .4), b = k % 3 == 0 ? shape_box(.5, .4, .2) : shape_cylinder(k % 3 == 1 ? .35 : .2, .3);
        const double depth = rng_sign(&r) * rng_log_uniform(&r, 1e-5, 2e-2);
        place(&r, &a, &b, depth, .1);
        check_calls(&a, &b, depth);
        check_calls(&b, &a, depth);
        if (k % (poses / 4 + 1) == 0 && depth > 0)
            for (int i = 0; i < 3; i++)
                check_rest(&a, &b, (double[]){TOLERANCE, 1e-9, 1e-12}[i], queries);
    }
    check_scales(poses / 50);
    check_states(poses / 10);
    return checks_end();
}
