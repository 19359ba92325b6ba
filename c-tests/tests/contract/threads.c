/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The same queries from many threads at once give the bits that one thread gives. */

#define _POSIX_C_SOURCE 200809L
#include "every_call.h"
#include <pthread.h>

enum { PAIRS = 60, THREADS = 8, ROUNDS = 5 };

static struct { shape_t a, b; ccd_t ccd; int code; outputs_t out; } queries[PAIR_CALL_COUNT][PAIRS];
static unsigned long different[THREADS];

static void *ask_all(void *arg)
{
    const int me = (int)((unsigned long *)arg - different);
    int i;
    for (int round = 0; round < ROUNDS; round++)
        for (int k = 0; k < PAIR_CALL_COUNT * PAIRS; k++) {
            /* Each thread in an order of its own. */
            const int place = (k * 7 + me * 131) % (PAIR_CALL_COUNT * PAIRS);
            outputs_t out;
            i = place / PAIRS;
            shape_t a = queries[i][place % PAIRS].a;
            shape_t b = queries[i][place % PAIRS].b;
            memset(&out, 0x5a, sizeof out);
            int code = run(&call_table[i], &a, &b, &queries[i][place % PAIRS].ccd, &out);
            different[me] += code != queries[i][place % PAIRS].code
                             || !same_bits(&out, &queries[i][place % PAIRS].out, sizeof out);
        }
    return NULL;
}

int main(void)
{
    pthread_t thread[THREADS];
    for (int i = 0; i < PAIR_CALL_COUNT; i++)
        for (int k = 0; k < PAIRS; k++) {
            random_pair(&call_table[i], k % 2, &queries[i][k].a, &queries[i][k].b, &queries[i][k].ccd);
            shape_t a = queries[i][k].a;
            shape_t b = queries[i][k].b;
            memset(&queries[i][k].out, 0x5a, sizeof queries[i][k].out);
            queries[i][k].code = run(&call_table[i], &a, &b, &queries[i][k].ccd, &queries[i][k].out);
        }
    for (int i = 0; i < THREADS; i++)
        CHECK(pthread_create(&thread[i], NULL, ask_all, &different[i]) == 0, "thread %d", i);
    for (int i = 0; i < THREADS; i++) {
        pthread_join(thread[i], NULL);
        CHECK(different[i] == 0, "thread %d: %lu answers differ", i, different[i]);
    }
    return checks_end();
}
