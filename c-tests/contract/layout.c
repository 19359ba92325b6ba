/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Sizes, offsets and prototypes, asserted when compiled, against libccd's headers and ours: of
 * the headers' types as of the polytope's, double / single, with 8-byte pointers and longs. The
 * Rust side asserts the same numbers (src/ffi/types.rs). With other pointers C's rules, which
 * Rust follows, lay out the same declarations. */

#include "polytope.h"
#include <ccd/quat.h>
#include <stddef.h>

#ifdef __cplusplus
#define ASSERT(condition) static_assert(condition, #condition)
#else
#define ASSERT(condition) _Static_assert(condition, #condition)
#endif

#ifdef CCD_SINGLE
#define BYTES(of_double, of_single) of_single
#else
#define BYTES(of_double, of_single) of_double
#endif

#define SIZE(type, of_double, of_single) ASSERT(sizeof(type) == BYTES(of_double, of_single))
#define AT(type, member, of_double, of_single) ASSERT(offsetof(type, member) == BYTES(of_double, of_single))

#if __SIZEOF_POINTER__ == 8
SIZE(ccd_real_t, 8, 4);
SIZE(ccd_vec3_t, 24, 12);
SIZE(ccd_quat_t, 32, 16);

SIZE(ccd_t, 72, 64);
AT(ccd_t, first_dir, 0, 0);
AT(ccd_t, support1, 8, 8);
AT(ccd_t, support2, 16, 16);
AT(ccd_t, center1, 24, 24);
AT(ccd_t, center2, 32, 32);
AT(ccd_t, max_iterations, 40, 40);
AT(ccd_t, epa_tolerance, 48, 48);
AT(ccd_t, mpr_tolerance, 56, 52);
AT(ccd_t, dist_tolerance, 64, 56);

SIZE(support_t, 72, 36);
AT(support_t, v, 0, 0);
AT(support_t, v1, 24, 12);
AT(support_t, v2, 48, 24);

SIZE(simplex_t, 296, 148);
AT(simplex_t, last, 288, 144);

SIZE(list_t, 16, 16);

SIZE(pt_el_t, 56, 40);
AT(pt_el_t, type, 0, 0);
AT(pt_el_t, dist, 8, 4);
AT(pt_el_t, witness, 16, 8);
AT(pt_el_t, list, 40, 24);

SIZE(pt_vertex_t, 152, 96);
AT(pt_vertex_t, id, 56, 40);
AT(pt_vertex_t, v, 64, 44);
AT(pt_vertex_t, edges, 136, 80);

SIZE(pt_edge_t, 120, 104);
AT(pt_edge_t, vertex, 56, 40);
AT(pt_edge_t, faces, 72, 56);
AT(pt_edge_t, vertex_list, 88, 72);

SIZE(pt_face_t, 80, 64);
AT(pt_face_t, edge, 56, 40);

SIZE(pt_t, 72, 64);
AT(pt_t, vertices, 0, 0);
AT(pt_t, edges, 16, 16);
AT(pt_t, faces, 32, 32);
AT(pt_t, nearest, 48, 48);
AT(pt_t, nearest_dist, 56, 56);
AT(pt_t, nearest_type, 64, 60);
#endif

/* Declared once more: another type is an error. */
#ifdef __cplusplus
extern "C" {
#endif
void ccdFirstDirDefault(const void *, const void *, ccd_vec3_t *);
int ccdGJKIntersect(const void *, const void *, const ccd_t *);
int ccdMPRIntersect(const void *, const void *, const ccd_t *);
int ccdGJKSeparate(const void *, const void *, const ccd_t *, ccd_vec3_t *);
int ccdGJKPenetration(const void *, const void *, const ccd_t *, ccd_real_t *, ccd_vec3_t *, ccd_vec3_t *);
int ccdMPRPenetration(const void *, const void *, const ccd_t *, ccd_real_t *, ccd_vec3_t *, ccd_vec3_t *);
ccd_real_t ccdVec3PointSegmentDist2(const ccd_vec3_t *, const ccd_vec3_t *, const ccd_vec3_t *, ccd_vec3_t *);
ccd_real_t ccdVec3PointTriDist2(const ccd_vec3_t *, const ccd_vec3_t *, const ccd_vec3_t *, const ccd_vec3_t *, ccd_vec3_t *);
extern ccd_vec3_t *ccd_vec3_origin, *ccd_points_on_sphere;
extern size_t ccd_points_on_sphere_len;
#ifdef __cplusplus
}
#endif

int main(void)
{
    return 0;
}
