/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A target of libFuzzer: any bytes are two shapes with their poses, a tolerance, a call and the state that it starts from;
 * the answer is judged by verdict.h. fuzz.sh compiles and runs it. With -DCORPUS it is the program that writes each of the
 * configurations of tests/stability as such bytes: fuzz_corpus FOLDER. */

#include "tests/stability/configurations.h"
#include "tests/stability/entries.h"
#include "harness/tolerances.h"
#include "harness/verdict.h"

#include <stdlib.h>

enum { CORNERS = 12 };

/* One input; bytes that are missing are 0. */
typedef struct {
    unsigned char entry, tolerance, type[2], corners[2], is_state_given, unused;
    double size[2][4], rot[2][9], pos[2][3], vertex[2][3 * CORNERS];
    unsigned char state[sizeof(ccd_warm_t)];
} input_t;

#ifdef CORPUS

static const char *folder;
static int written;

/* Writes a configuration, once for each of a few calls, if its shapes are those of <ccd/shapes.h>. */
static void write_configuration(const configuration_t *c)
{
    const shape_t *shapes[2] = {&c->a, &c->b};
    input_t input;
    memset(&input, 0, sizeof input);
    for (int k = 0; k < 2; k++) {
        const shape_t *s = shapes[k];
        if (s->type >= SHAPE_TYPES || s->nverts > CORNERS)
            return;
        input.type[k] = (unsigned char)s->type;
        input.corners[k] = (unsigned char)(s->nverts > 0 ? s->nverts - 1 : 0);
        for (int i = 0; i < 4; i++)
            input.size[k][i] = (double)s->p[i];
        for (int i = 0; i < 9; i++)
            input.rot[k][i] = (double)s->rot[i];
        for (int i = 0; i < 3; i++)
            input.pos[k][i] = (double)s->pos[i];
        for (int i = 0; i < 3 * s->nverts; i++)
            input.vertex[k][i] = (double)s->verts[i];
    }
    for (int k = 0; k < 3; k++) {
        char path[4096];
        input.entry = (unsigned char)((written + 11 * k) % 64);
        input.tolerance = (unsigned char)(3 + written % 5);
        snprintf(path, sizeof path, "%s/%03d", folder, written++);
        FILE *file = fopen(path, "wb");
        if (!file || fwrite(&input, sizeof input, 1, file) != 1 || fclose(file) != 0) {
            perror(path);
            exit(1);
        }
    }
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: fuzz_corpus FOLDER\n");
        return 2;
    }
    folder = argv[1];
    for_each_configuration(write_configuration);
    printf("%d inputs\n", written);
    return written == 0;
}

#else

/* Returns a number as a length between 1 mm and 1 km. */
static double length_of(double x) { return isfinite(x) ? fmin(fmax(fabs(x), 1e-3), 1e3) : 1; }

/* Returns a number as a coordinate within 1 km, and 0 below 1 nm: squares of squares of lengths must be normal numbers. */
static double coordinate_of(double x) { return isfinite(x) && fabs(x) > 1e-9 ? fmin(fmax(x, -1e3), 1e3) : 0; }

/* Makes a rotation of nine numbers: their rows made perpendicular and normalised; of rows that have no such, none. */
static void rotation_of(const double in[9], double rot[9])
{
    double row[3][3], length;
    for (int i = 0; i < 9; i++)
        row[i / 3][i % 3] = coordinate_of(in[i]);
    for (int k = 0; k < 2; k++) {
        const double along = k ? truth_dot3(row[0], row[1]) : 0;
        for (int i = 0; i < 3 && k; i++)
            row[1][i] -= along * row[0][i];
        length = sqrt(truth_dot3(row[k], row[k]));
        if (!(length > 1e-6)) {
            rotation_about(0, 0, 1, 0, rot);
            return;
        }
        for (int i = 0; i < 3; i++)
            row[k][i] /= length;
    }
    truth_cross3(row[0], row[1], row[2]);
    memcpy(rot, row, sizeof row);
}

static shape_t shape_of(const input_t *input, int k, ccd_real_t verts[3 * CORNERS])
{
    const int type = input->type[k] % SHAPE_TYPES, corners = 1 + input->corners[k] % CORNERS;
    const double *p = input->size[k];
    double rot[9];
    shape_t s;
    for (int i = 0; i < 3 * corners; i++)
        verts[i] = (ccd_real_t)coordinate_of(input->vertex[k][i]);
    s = type == SHAPE_POLYTOPE ? shape_polytope(verts, corners) : shape_make(type, length_of(p[0]), length_of(p[1]), length_of(p[2]));
    rotation_of(input->rot[k], rot);
    shape_turn(&s, rot);
    shape_move(&s, coordinate_of(input->pos[k][0]), coordinate_of(input->pos[k][1]), coordinate_of(input->pos[k][2]));
    return s;
}

/* Makes one call; one with too many support calls is an endless loop. */
static answer_t answer_of(const entry_t *e, const shape_t *a, const shape_t *b, const ccd_t *ccd, ccd_warm_t *warm, const ccd_vec3_t *along)
{
    static answer_t out; /* static: survives a siglongjmp */
    memset(&out, 0, sizeof out);
    support_call_limit = call_limit(e);
    support_calls = 0;
    const int code = sigsetjmp(before_call, 0);
    if (code == 0)
        call_once(e, a, b, ccd, warm, along, &out);
    else
        out.code = code;
    return out;
}

/* Prints what is wrong with an answer, and stops. */
static void fail(const char *what, const entry_t *e, const answer_t *x, const truth_t *truth, double tolerance)
{
    printf("%s: %s: code %d, depth %.17g, dir %.17g %.17g %.17g, %lu support calls; depth %.17g to %.17g, tolerance %g\n", e->name, what,
           x->code, x->depth, x->dir[0], x->dir[1], x->dir[2], (unsigned long)support_calls, truth->lower, truth->depth, tolerance);
    fflush(stdout);
    abort();
}

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size);
int LLVMFuzzerTestOneInput(const unsigned char *data, size_t size)
{
    input_t input;
    ccd_real_t verts[2][3 * CORNERS];
    ccd_warm_t warm;
    ccd_vec3_t along, guess;
    memset(&input, 0, sizeof input);
    memcpy(&input, data, size < sizeof input ? size : sizeof input);
    const entry_t *e = &entries[input.entry % ENTRIES];
    shape_t a = shape_of(&input, 0, verts[0]), b = shape_of(&input, 1, verts[1]);
    margin_size = pair_size(&a, &b);
    if (!(margin_size > 1e-6))
        return -1; /* points */
    const double tolerance = margin_size * pow(10, -3 - input.tolerance % 8);
    /* Wide bounds cost a wrong answer that they hide, tight ones a hundred times as many inputs. */
    const truth_end_t end = {1e-6 * margin_size, 400, -HUGE_VAL, HUGE_VAL};
    const truth_t truth = truth_depth_until(&a, &b, end);
    ccd_t ccd = counting_query(tolerance);
    if (e->without_centres)
        ccd.center1 = ccd.center2 = NULL;
    for (int i = 0; i < 3; i++) {
        along.v[i] = (ccd_real_t)truth.n[i];
        guess.v[i] = (ccd_real_t)(e->state == STATE_TILTED_GUESS ? truth.n[(i + 1) % 3] : -truth.n[i]);
    }
    memset(&warm, 0, sizeof warm);
    if (input.is_state_given % 2)
        memcpy(&warm, input.state, sizeof warm);
    else if (e->state == STATE_OPPOSITE_GUESS || e->state == STATE_TILTED_GUESS)
        OURS(ccdWarmGuess)(&warm, &guess);
    else if (e->state == STATE_OWN)
        answer_of(e, &a, &b, &ccd, &warm, &along);
    else if (e->state == STATE_SWAPPED)
        answer_of(e, &b, &a, &ccd, &warm, &along);
    const int has_state = e->state != STATE_NONE && e->state < STATE_MARGINS;
    const answer_t x = answer_of(e, &a, &b, &ccd, has_state ? &warm : NULL, &along);
    if (x.code == ANSWER_LOOP)
        fail("endless", e, &x, &truth, tolerance);
    if (x.code != CCD_HIT && x.code != CCD_LIMIT && x.code != CCD_MISS)
        fail("code", e, &x, &truth, tolerance);
    if (x.wrote_outputs)
        fail("outputs written without an answer", e, &x, &truth, tolerance);
    const double noise = pair_noise(&a, &b);
    const int is_hit = x.code != CCD_MISS, is_distance = e->call == CALL_DISTANCE, is_zero = e->call == CALL_SEPARATE && x.depth == 0;
    /* A distance stops at the limit without a sign; a separation of 0 has no direction. */
    const verdict_answer_t answer = {is_hit, !entry_is_boolean(e) && !is_distance && !is_zero, x.depth, truth_dot3(x.dir, x.dir)};
    const verdict_truth_t bounds = {truth.lower, truth.depth, fmin(tolerance, 1e-3 * margin_size) + 2 * noise, 2 * noise};
    const verdict_t v = is_distance && (x.code == CCD_LIMIT || e->state == STATE_MARGINS) ? VERDICT_RIGHT : verdict(&answer, &bounds);
    /* Local minima and depths at the limit may be deeper. */
    const int is_least = entry_is_mpr(e) || entry_is_minimum(e);
    if (v != VERDICT_RIGHT && !(v == VERDICT_DEEP && (!is_least || x.code == CCD_LIMIT || support_calls >= 2 * 160)))
        fail(VERDICT_NAME[v], e, &x, &truth, tolerance);
    return 0;
}

#endif
