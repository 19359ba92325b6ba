/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks that queries of many threads at once give the bits of one thread. */

#define _POSIX_C_SOURCE 200809L
#include "every_call.h"
#include <pthread.h>

enum { PAIRS = 60, THREADS = 8, ROUNDS = 5 };

enum { QUERIES = PAIR_CALL_COUNT * PAIRS };
typedef struct { shape_t a, b; ccd_t ccd; int code; results_t out; } query_t;
static query_t queries[QUERIES];
static unsigned long different[THREADS];

static int run_query(int i, results_t *out)
{
    shape_t a = queries[i].a, b = queries[i].b;
    return run(&call_table[i / PAIRS], &a, &b, &queries[i].ccd, out);
}

static void *run_all(void *arg)
{
    const int thread = (int)((unsigned long *)arg - different);
    for (int k = 0; k < ROUNDS * QUERIES; k++) {
        /* Each thread in its own order. */
        const int i = (k * 7 + thread * 131) % QUERIES;
        results_t out;
        const int code = run_query(i, &out);
        different[thread] += code != queries[i].code || !same_results(&out, &queries[i].out);
    }
    return NULL;
}

int main(void)
{
    pthread_t thread[THREADS];
    for (int i = 0; i < QUERIES; i++) {
        query_t *q = &queries[i];
        random_pair(&call_table[i / PAIRS], i % 2, &q->a, &q->b, &q->ccd);
        q->code = run_query(i, &q->out);
    }
    for (int i = 0; i < THREADS; i++)
        CHECK(pthread_create(&thread[i], NULL, run_all, &different[i]) == 0, "thread %d", i);
    for (int i = 0; i < THREADS; i++) {
        pthread_join(thread[i], NULL);
        CHECK(different[i] == 0, "thread %d: %lu results differ", i, different[i]);
    }
    return checks_end();
}
