/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Prints the library's data objects bit for bit. Linked with both libraries in every way in which an
 * executable can access data of a shared library. */

#include <ccd/ccd.h>
#include <stdio.h>

int main(void)
{
    printf("%a %a %a\n", (double)ccd_vec3_origin->v[0], (double)ccd_vec3_origin->v[1], (double)ccd_vec3_origin->v[2]);
    printf("%lu\n", (unsigned long)ccd_points_on_sphere_len);
    for (size_t i = 0; i < ccd_points_on_sphere_len; i++) {
        const ccd_real_t *v = ccd_points_on_sphere[i].v;
        printf("%a %a %a\n", (double)v[0], (double)v[1], (double)v[2]);
    }
    return 0;
}
