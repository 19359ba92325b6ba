/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks the polytope functions of the loaded library by random sequences of additions, deletions by
 * the user's inline functions, nearest elements set by the user, searches and recomputations. After each
 * step the polytope is compared with the elements in the order of their addition, and the nearest one by libccd's rule for
 * the distances in the elements. (point_distance.c checks the distances themselves.)
 *
 * With -DCOUNT_BLOCKS: an element is one block of exactly its size of this program's malloc, which either side may free.
 * Nothing else is allocated, and a failed allocation returns NULL and changes nothing. */

#include "check.h"
#include "heap.h"
#include "harness/identity.h"
#include "polytope.h"
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

enum { MAX_ELEMENTS = 512 };

typedef union { pt_el_t el; pt_vertex_t vertex; pt_edge_t edge; pt_face_t face; } any_t;

/* The elements in the order of their addition, and what does not change in them. */
static struct {
    any_t *at;
    const void *parts[3]; /* vertices of an edge, edges of a face */
    support_t v;          /* of a vertex */
} elements[MAX_ELEMENTS];
static int count;

static int ours; /* this library, else libccd, whose distances are not checked */

static pt_t pt;
static struct { const void *element; ccd_real_t dist; int type; } nearest; /* expected */

/* Applies libccd's rule for the nearest element to one more element. */
static void update_nearest(const any_t *element)
{
    const pt_el_t *el = &element->el;
    if (ccdEq(nearest.dist, el->dist) ? el->type < nearest.type : el->dist < nearest.dist) {
        nearest.element = element;
        nearest.dist = el->dist;
        nearest.type = el->type;
    }
}

static void reset_nearest(void)
{
    nearest.element = NULL;
    nearest.dist = CCD_REAL_MAX;
    nearest.type = PT_FACE;
}

/* --- checks ---------------------------------------------------------------- */

/* Checks that a list contains the elements of a type, oldest first. */
static void check_list(const list_t *head, int type)
{
    const list_t *link = head->next;
    CHECK(link->prev == head && head->prev->next == head, "circular");
    for (int i = 0; i < count; i++) {
        if (elements[i].at->el.type == type) {
            CHECK(link == &elements[i].at->el.list, "type %d, element %d in order", type, i);
            if (link == head)
                return;
            CHECK(link->next->prev == link, "linked both ways");
            link = link->next;
        }
    }
    CHECK(link == head, "nothing more of type %d", type);
}

/* Checks a vertex, and that its edges are linked, oldest first, each by the link of its end at this vertex. */
static void check_vertex(int i)
{
    const pt_vertex_t *vertex = &elements[i].at->vertex;
    const ccd_vec3_t *point = &elements[i].v.v;
    const list_t *link = vertex->edges.next;
    CHECK(same_bits(&vertex->v, &elements[i].v, sizeof vertex->v), "vertex %d keeps its point", i);
    CHECK(same_bits(&vertex->el.witness, point, sizeof *point), "a vertex's witness is v");
    CHECK(vertex->el.dist == ccdVec3Len2(point), "a vertex's distance is squared");
    for (int k = 0; k < count; k++)
        for (int end = 0; end < 2; end++)
            if (elements[k].at->el.type == PT_EDGE && elements[k].parts[end] == vertex) {
                CHECK(link == &elements[k].at->edge.vertex_list[end], "edge %d in the list of vertex %d", k, i);
                link = link->next;
            }
    CHECK(link == &vertex->edges, "vertex %d has no other edge", i);
}

/* Checks the ends of an edge, and its faces, oldest first. */
static void check_edge(int i)
{
    const pt_edge_t *edge = &elements[i].at->edge;
    const void *faces[2] = {NULL, NULL};
    int sides = 0;
    for (int k = 0; k < count; k++)
        for (int side = 0; side < 3; side++)
            if (sides < 2 && elements[k].at->el.type == PT_FACE && elements[k].parts[side] == edge)
                faces[sides++] = elements[k].at;
    for (int k = 0; k < 2; k++)
        CHECK(edge->vertex[k] == elements[i].parts[k] && edge->faces[k] == faces[k], "edge %d's vertices and faces", i);
}

static void check_polytope(void)
{
    check_list(&pt.vertices, PT_VERTEX);
    check_list(&pt.edges, PT_EDGE);
    check_list(&pt.faces, PT_FACE);
    for (int i = 0; i < count; i++)
        switch (elements[i].at->el.type) {
        case PT_VERTEX: check_vertex(i); break;
        case PT_EDGE: check_edge(i); break;
        default:
            for (int k = 0; k < 3; k++)
                CHECK(elements[i].at->face.edge[k] == elements[i].parts[k], "face %d's edges", i);
        }
    CHECK((const void *)pt.nearest == nearest.element, "nearest");
    CHECK(pt.nearest_dist == nearest.dist && pt.nearest_type == nearest.type, "nearest_dist, nearest_type");
}

/* --- steps ----------------------------------------------------------------- */

/* Returns the number of a random element of the type; -1 if there is none. */
static int pick(int type)
{
    const int start = count == 0 ? 0 : random_below(count);
    for (int i = 0; i < count; i++)
        if (elements[(start + i) % count].at->el.type == type)
            return (start + i) % count;
    return -1;
}

/* Returns a random element of the type, or NULL. */
static any_t *pick_element(int type)
{
    const int i = pick(type);
    return i < 0 ? NULL : elements[i].at;
}

/* Stores an element that was added, with its parts. */
static any_t *added(void *element, int type, const void *a, const void *b, const void *c)
{
    const void *parts[3] = {a, b, c};
    elements[count].at = (any_t *)element;
    memcpy(elements[count].parts, parts, sizeof parts);
    CHECK(elements[count].at->el.type == type, "type");
    static const size_t sizes[] = {[PT_VERTEX] = sizeof(pt_vertex_t), [PT_EDGE] = sizeof(pt_edge_t), [PT_FACE] = sizeof(pt_face_t)};
    CHECK(!COUNTS_BLOCKS || (live == count + 1 && last.block == element && last.size == sizes[type]), "an element is a block of its size");
    update_nearest(elements[count].at);
    return elements[count++].at;
}

static void add_vertex(void)
{
    support_t s;
    s.v1 = random_vec3(2);
    s.v2 = random_vec3(2);
    s.v = random_vec3(random_below(2) ? 1 : 1e-9);
    if (random_below(4) == 0)
        for (int k = 0; k < 3; k++)
            s.v.v[k] = (ccd_real_t)(random_below(3) - 1);
    elements[count].v = s;
    added(ccdPtAddVertex(&pt, &s), PT_VERTEX, NULL, NULL, NULL);
}

static any_t *add_edge(any_t *a, any_t *b)
{
    return added(ccdPtAddEdge(&pt, &a->vertex, &b->vertex), PT_EDGE, a, b, NULL);
}

/* Returns the edge between two vertices with fewer than two faces, or a new one. */
static any_t *edge_between(any_t *a, any_t *b)
{
    for (int i = 0; i < count; i++) {
        const void *const *ends = elements[i].parts;
        if (elements[i].at->el.type == PT_EDGE && elements[i].at->edge.faces[1] == NULL
            && ((ends[0] == a && ends[1] == b) || (ends[0] == b && ends[1] == a)))
            return elements[i].at;
    }
    return random_below(2) ? add_edge(a, b) : add_edge(b, a);
}

static void add_face(void)
{
    any_t *a = pick_element(PT_VERTEX), *b = pick_element(PT_VERTEX), *c = pick_element(PT_VERTEX), *ab, *bc, *ca;
    if (a == NULL || a == b || b == c || c == a)
        return;
    ab = edge_between(a, b);
    bc = edge_between(b, c);
    ca = edge_between(c, a);
    added(ccdPtAddFace(&pt, &ab->edge, &bc->edge, &ca->edge), PT_FACE, ab, bc, ca);
}

static void delete_any(void)
{
    const int type = 1 + random_below(3), i = pick(type);
    any_t *element = i < 0 ? NULL : elements[i].at;
    if (element == NULL || (type == PT_EDGE && !pt_edge_is_free(&element->edge))
        || (type == PT_VERTEX && !pt_vertex_is_free(&element->vertex)))
        return;
    if (nearest.element == element)
        nearest.element = NULL;
    if (type == PT_FACE)
        pt_delete_face(&pt, &element->face);
    else if (type == PT_EDGE)
        pt_delete_edge(&pt, &element->edge);
    else
        pt_delete_vertex(&pt, &element->vertex);
    memmove(&elements[i], &elements[i + 1], (size_t)(--count - i) * sizeof *elements);
}

/* Sets the nearest element, as FCL does. */
static void set_nearest(void)
{
    any_t *element = pick_element(1 + random_below(3));
    if (element == NULL)
        return;
    nearest.element = pt.nearest = &element->el;
    pt.nearest_dist = nearest.dist = (ccd_real_t)uniform(0, 1);
    pt.nearest_type = nearest.type = element->el.type;
}

static void search(void)
{
    const pt_el_t *found = ccdPtNearest(&pt);
    if (nearest.element == NULL) {
        reset_nearest();
        for (int type = PT_VERTEX; type <= PT_FACE; type++)
            for (int i = 0; i < count; i++)
                if (elements[i].at->el.type == type)
                    update_nearest(elements[i].at);
    }
    CHECK(found == pt.nearest, "returns nearest");
}

/* Returns the squared distance of an edge or a triangle. */
static double distance2(const any_t *element)
{
    const pt_edge_t *one = element->el.type == PT_FACE ? element->face.edge[0] : &element->edge, *two = element->face.edge[1];
    const ccd_vec3_t *a = &one->vertex[0]->v.v, *b = &one->vertex[1]->v.v;
    if (element->el.type == PT_EDGE)
        return (double)ccdVec3PointSegmentDist2(ccd_vec3_origin, a, b, NULL);
    const int is_shared = two->vertex[0] == one->vertex[0] || two->vertex[0] == one->vertex[1];
    return (double)ccdVec3PointTriDist2(ccd_vec3_origin, a, b, &two->vertex[is_shared]->v.v, NULL);
}

/* Moves a vertex and recomputes the distances. */
static void recompute(void)
{
    const int i = pick(PT_VERTEX);
    if (i < 0)
        return;
    elements[i].v.v = random_vec3(1);
    elements[i].at->vertex.v = elements[i].v;
    ccdPtRecomputeDistances(&pt);
    for (int k = 0; k < count; k++) {
        /* libccd's value depends on the order of the corners, and on the request for a witness. */
        const pt_el_t *el = &elements[k].at->el;
        const double off = el->type == PT_VERTEX ? 0 : sqrt((double)el->dist) - sqrt(distance2(elements[k].at));
        CHECK(fabs(off) < 1e-7 || !ours, "a distance off by %g", off);
        CHECK(el->dist == ccdVec3Len2(&el->witness) || !ours, "the witness's distance");
    }
}

static void reject_null(void)
{
    any_t *v = pick_element(PT_VERTEX), *e = pick_element(PT_EDGE);
    pt_vertex_t *vertex = v ? &v->vertex : NULL;
    pt_edge_t *edge = e ? &e->edge : NULL;
    CHECK(ccdPtAddEdge(&pt, NULL, vertex) == NULL, "NULL vertex");
    CHECK(ccdPtAddEdge(&pt, vertex, NULL) == NULL, "NULL vertex");
    CHECK(ccdPtAddFace(&pt, NULL, edge, edge) == NULL, "NULL edge");
    CHECK(ccdPtAddFace(&pt, edge, NULL, edge) == NULL, "NULL edge");
    CHECK(ccdPtAddFace(&pt, edge, edge, NULL) == NULL, "NULL edge");
}

/* Adds elements without memory. */
static void fail_to_add(void)
{
    any_t *v = pick_element(PT_VERTEX), *e = pick_element(PT_EDGE);
    support_t s;
    memset(&s, 0, sizeof s);
    if (!COUNTS_BLOCKS)
        return;
    fail_at = allocations + 1;
    CHECK(ccdPtAddVertex(&pt, &s) == NULL && allocations == fail_at, "no memory for a vertex");
    fail_at = allocations + 1;
    CHECK(v == NULL || (ccdPtAddEdge(&pt, &v->vertex, &v->vertex) == NULL && allocations == fail_at), "no memory for an edge");
    fail_at = allocations + 1;
    CHECK(e == NULL || (ccdPtAddFace(&pt, &e->edge, &e->edge, &e->edge) == NULL && allocations == fail_at), "no memory for a face");
    fail_at = 0;
}

/* Prints the polytope's text for the driver, which compares both libraries. Checks that it is appended to a file, written
 * to a stream, and that vertices are numbered. */
static void dump(void)
{
    static char text[1 << 17];
    int id = 0;
    char name[512];
    const char *directory = getenv("TMPDIR");
    snprintf(name, sizeof name, "%s/polytope-XXXXXX", directory ? directory : P_tmpdir);
    FILE *file = fdopen(mkstemp(name), "r+");
    CHECK(file != NULL, "a temporary file");
    ccdPtDumpSVT(&pt, name);
    ccdPtDumpSVT(&pt, name);
    fseek(file, 0, SEEK_END);
    ccdPtDumpSVT2(&pt, file);
    rewind(file);
    const size_t length = fread(text, 1, sizeof text, file), part = length / 3;
    fclose(file);
    remove(name);
    CHECK(part > 0 && length == 3 * part && memcmp(text, text + part, 2 * part) == 0, "three times the same text");
    fwrite(text, 1, part, stdout);
    ccdPtDumpSVT(&pt, "/no such directory/polytope");
    for (int i = 0; i < count; i++)
        if (elements[i].at->el.type == PT_VERTEX)
            CHECK(elements[i].at->vertex.id == id++, "a vertex's id");
}

static void add_any_edge(void)
{
    any_t *a = pick_element(PT_VERTEX), *b = pick_element(PT_VERTEX);
    /* libccd's distance of an edge between equal points is NaN. */
    if (a != b && !ccdVec3Eq(&a->vertex.v.v, &b->vertex.v.v))
        add_edge(a, b);
}

int main(int argc, char **argv)
{
    /* as often as listed */
    static void (*const steps[])(void) = {
        add_vertex, add_vertex, add_vertex, add_vertex, add_vertex, add_any_edge, add_any_edge, add_face, add_face, add_face,
        add_face, add_face, delete_any, delete_any, delete_any, search, search, set_nearest, recompute, reject_null,
        fail_to_add};
    const int polytopes = atoi(argc > 1 ? argv[1] : "200");
    setvbuf(stdout, NULL, _IONBF, 0); /* no block of stdout's is counted */
    ours = running_ccd() != NULL;
    for (int round = 0; round < polytopes; round++) {
        count = 0;
        start_counting(0);
        memset(&pt, 0xa5, sizeof pt);
        ccdPtInit(&pt);
        reset_nearest();
        check_polytope();
        CHECK(ccdPtNearest(&pt) == NULL, "nothing is nearest in an empty polytope");
        for (int step = 0; step < 150 && count < MAX_ELEMENTS - 8; step++) {
            steps[random_below(sizeof steps / sizeof *steps)]();
            check_polytope();
            CHECK(!COUNTS_BLOCKS || live == count, "%d blocks of %d elements", live, count);
        }
        dump();
        ccdPtDestroy(&pt);
        CHECK(list_length(&pt.vertices) + list_length(&pt.edges) + list_length(&pt.faces) == 0, "empty after destroy");
        CHECK(pt.nearest == NULL, "nothing is nearest after destroy");
        CHECK(!COUNTS_BLOCKS || live == 0, "%d blocks left", live);
    }
    return checks_end();
}
