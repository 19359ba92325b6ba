/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Checks the polytope functions of the loaded library by random sequences of additions, deletions by
 * the user's inline functions, nearest elements set by the user, searches and recomputations. Each
 * step compares the polytope with a model: the elements in the order of their addition, and the
 * nearest one by libccd's rule for the distances in the elements. (point_distance.c checks the
 * distances themselves.) */

#include "check.h"
#include "harness/identity.h"
#include "polytope.h"
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

enum { MAX_ELEMENTS = 512, NONE = -1 };

/* Expected element. Elements are numbered in the order of their addition. */
typedef struct {
    int type;     /* 0: deleted */
    int parts[3]; /* vertices of an edge, edges of a face */
    int sides[2]; /* faces of an edge */
    support_t v;
} element_t;

static element_t model[MAX_ELEMENTS];
static int count;

static int ours; /* this library, else libccd, whose distances are not checked */

static pt_t pt;
static pt_el_t *address[MAX_ELEMENTS]; /* the library's elements */
static struct { int element; ccd_real_t dist; int type; } nearest; /* expected */

/* Returns the number of an element; NONE for NULL. */
static int index_of(const void *element)
{
    for (int i = 0; i < count; i++)
        if (model[i].type != 0 && element == address[i])
            return i;
    return NONE;
}

/* Applies libccd's rule for the nearest element to one more element. */
static void update_nearest(int element)
{
    const pt_el_t *el = address[element];
    if (ccdEq(nearest.dist, el->dist) ? el->type < nearest.type : el->dist < nearest.dist) {
        nearest.element = element;
        nearest.dist = el->dist;
        nearest.type = el->type;
    }
}

static void reset_nearest(void)
{
    nearest.element = NONE;
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
        if (model[i].type == type) {
            CHECK(link == &address[i]->list, "type %d, element %d in order", type, i);
            if (link == head)
                return;
            CHECK(link->next->prev == link, "linked both ways");
            link = link->next;
        }
    }
    CHECK(link == head, "nothing more of type %d", type);
}

static void check_vertex(int i)
{
    pt_vertex_t *vertex = (pt_vertex_t *)address[i];
    const list_t *link = vertex->edges.next;
    CHECK(same_bits(&vertex->v, &model[i].v, sizeof vertex->v), "vertex %d keeps its point", i);
    CHECK(same_bits(&vertex->el.witness, &model[i].v.v, sizeof vertex->el.witness), "a vertex's witness is v");
    CHECK(vertex->el.dist == ccdVec3Len2(&model[i].v.v), "a vertex's distance is squared");
    /* Its edges, oldest first, each by the link of its end at this vertex. */
    for (int k = 0; k < count; k++) {
        for (int end = 0; end < 2; end++) {
            if (model[k].type == PT_EDGE && model[k].parts[end] == i) {
                pt_edge_t *edge = (pt_edge_t *)address[k];
                CHECK(link == &edge->vertex_list[end], "edge %d in the list of vertex %d", k, i);
                link = link->next;
            }
        }
    }
    CHECK(link == &vertex->edges, "vertex %d has no other edge", i);
}

static void check_polytope(void)
{
    check_list(&pt.vertices, PT_VERTEX);
    check_list(&pt.edges, PT_EDGE);
    check_list(&pt.faces, PT_FACE);
    for (int i = 0; i < count; i++) {
        if (model[i].type == 0)
            continue;
        CHECK(address[i]->type == model[i].type, "type");
        if (model[i].type == PT_VERTEX) {
            check_vertex(i);
        } else if (model[i].type == PT_EDGE) {
            const pt_edge_t *edge = (const pt_edge_t *)address[i];
            for (int k = 0; k < 2; k++) {
                CHECK(index_of(edge->vertex[k]) == model[i].parts[k], "edge %d's vertices", i);
                CHECK(index_of(edge->faces[k]) == model[i].sides[k], "edge %d's faces", i);
            }
        } else {
            const pt_face_t *face = (const pt_face_t *)address[i];
            for (int k = 0; k < 3; k++)
                CHECK(index_of(face->edge[k]) == model[i].parts[k], "face %d's edges", i);
        }
    }
    CHECK(index_of(pt.nearest) == nearest.element, "nearest is %d, expected %d", index_of(pt.nearest), nearest.element);
    CHECK(pt.nearest_dist == nearest.dist && pt.nearest_type == nearest.type, "nearest_dist, nearest_type");
}

/* --- steps ----------------------------------------------------------------- */

static int pick(int type)
{
    int start = count == 0 ? 0 : random_below(count), i;
    for (i = 0; i < count; i++)
        if (model[(start + i) % count].type == type)
            return (start + i) % count;
    return NONE;
}

static void added(int type)
{
    model[count].type = type;
    update_nearest(count);
    count++;
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
    model[count].v = s;
    address[count] = (pt_el_t *)ccdPtAddVertex(&pt, &s);
    added(PT_VERTEX);
}

static int add_edge(int a, int b)
{
    model[count].parts[0] = a;
    model[count].parts[1] = b;
    model[count].sides[0] = model[count].sides[1] = NONE;
    address[count] = (pt_el_t *)ccdPtAddEdge(&pt, (pt_vertex_t *)address[a], (pt_vertex_t *)address[b]);
    added(PT_EDGE);
    return count - 1;
}

/* Returns the edge between two vertices with fewer than two faces, or a new one. */
static int edge_between(int a, int b)
{
    for (int i = 0; i < count; i++)
        if (model[i].type == PT_EDGE && model[i].sides[1] == NONE
            && ((model[i].parts[0] == a && model[i].parts[1] == b) || (model[i].parts[0] == b && model[i].parts[1] == a)))
            return i;
    return random_below(2) ? add_edge(a, b) : add_edge(b, a);
}

static void add_face(void)
{
    int a = pick(PT_VERTEX), b = pick(PT_VERTEX), c = pick(PT_VERTEX), k;
    int edge[3];
    if (a == NONE || a == b || b == c || c == a || count > MAX_ELEMENTS - 8)
        return;
    edge[0] = edge_between(a, b);
    edge[1] = edge_between(b, c);
    edge[2] = edge_between(c, a);
    address[count] = (pt_el_t *)ccdPtAddFace(&pt, (pt_edge_t *)address[edge[0]], (pt_edge_t *)address[edge[1]],
                                             (pt_edge_t *)address[edge[2]]);
    for (k = 0; k < 3; k++) {
        model[count].parts[k] = edge[k];
        model[edge[k]].sides[model[edge[k]].sides[0] != NONE] = count;
    }
    added(PT_FACE);
}

static void deleted(int i)
{
    model[i].type = 0;
    if (nearest.element == i)
        nearest.element = NONE;
}

static void delete_face(int i)
{
    pt_delete_face(&pt, (pt_face_t *)address[i]);
    for (int k = 0; k < 3; k++) {
        int *sides = model[model[i].parts[k]].sides;
        if (sides[0] == i)
            sides[0] = sides[1];
        sides[1] = NONE;
    }
    deleted(i);
}

static void delete_any(void)
{
    int type = 1 + random_below(3), i = pick(type);
    if (i == NONE)
        return;
    if (type == PT_FACE) {
        delete_face(i);
    } else if (type == PT_EDGE && pt_edge_is_free((pt_edge_t *)address[i])) {
        pt_delete_edge(&pt, (pt_edge_t *)address[i]);
        deleted(i);
    } else if (type == PT_VERTEX && pt_vertex_is_free((pt_vertex_t *)address[i])) {
        pt_delete_vertex(&pt, (pt_vertex_t *)address[i]);
        deleted(i);
    }
}

/* Sets the nearest element, as FCL does. */
static void set_nearest(void)
{
    int i = pick(1 + random_below(3));
    if (i == NONE)
        return;
    pt.nearest = address[i];
    nearest.element = i;
    pt.nearest_dist = nearest.dist = (ccd_real_t)uniform(0, 1);
    pt.nearest_type = nearest.type = address[i]->type;
}

static void search(void)
{
    const pt_el_t *found = ccdPtNearest(&pt);
    if (nearest.element == NONE) {
        reset_nearest();
        for (int type = PT_VERTEX; type <= PT_FACE; type++)
            for (int i = 0; i < count; i++)
                if (model[i].type == type)
                    update_nearest(i);
    }
    CHECK(found == pt.nearest, "returns nearest");
}

/* Returns the squared distance of an edge or a triangle. */
static double distance2(const element_t *e)
{
    const element_t *one = e->type == PT_FACE ? &model[e->parts[0]] : e, *two = &model[e->parts[1]];
    const ccd_vec3_t *a = &model[one->parts[0]].v.v, *b = &model[one->parts[1]].v.v, *c;
    if (e->type == PT_EDGE)
        return (double)ccdVec3PointSegmentDist2(ccd_vec3_origin, a, b, NULL);
    c = &model[two->parts[two->parts[0] == one->parts[0] || two->parts[0] == one->parts[1]]].v.v;
    return (double)ccdVec3PointTriDist2(ccd_vec3_origin, a, b, c, NULL);
}

/* Moves a vertex and recomputes the distances. */
static void recompute(void)
{
    int i = pick(PT_VERTEX), k;
    if (i == NONE)
        return;
    model[i].v.v = random_vec3(1);
    ((pt_vertex_t *)address[i])->v = model[i].v;
    ccdPtRecomputeDistances(&pt);
    for (k = 0; k < count; k++)
        if (model[k].type > PT_VERTEX) {
            /* libccd's value depends on the order of the corners, and on the request for a witness. */
            const double dist2 = (double)address[k]->dist, off = sqrt(dist2) - sqrt(distance2(&model[k]));
            CHECK(fabs(off) < 1e-7 || !ours, "a distance off by %g", off);
            CHECK(dist2 == (double)ccdVec3Len2(&address[k]->witness) || !ours, "the witness's distance");
        }
}

static void reject_null(void)
{
    int v = pick(PT_VERTEX), e = pick(PT_EDGE);
    pt_vertex_t *vertex = v == NONE ? NULL : (pt_vertex_t *)address[v];
    pt_edge_t *edge = e == NONE ? NULL : (pt_edge_t *)address[e];
    CHECK(ccdPtAddEdge(&pt, NULL, vertex) == NULL, "NULL vertex");
    CHECK(ccdPtAddEdge(&pt, vertex, NULL) == NULL, "NULL vertex");
    CHECK(ccdPtAddFace(&pt, NULL, edge, edge) == NULL, "NULL edge");
    CHECK(ccdPtAddFace(&pt, edge, NULL, edge) == NULL, "NULL edge");
    CHECK(ccdPtAddFace(&pt, edge, edge, NULL) == NULL, "NULL edge");
}

static size_t read_file(const char *name, char *text, size_t size)
{
    FILE *file = fopen(name, "r");
    const size_t length = fread(text, 1, size, file);
    fclose(file);
    return length;
}

/* Prints the polytope's text for the driver, which compares both libraries. Checks that the text is appended to a
 * file and that vertices are numbered. */
static void dump(void)
{
    static char text[1 << 17];
    int id = 0;
    char name[512];
    const char *directory = getenv("TMPDIR");
    snprintf(name, sizeof name, "%s/polytope-XXXXXX", directory ? directory : P_tmpdir);
    const int file = mkstemp(name);
    CHECK(file >= 0, "a temporary file");
    close(file);
    ccdPtDumpSVT(&pt, name);
    size_t half = read_file(name, text, sizeof text);
    fwrite(text, 1, half, stdout);
    ccdPtDumpSVT(&pt, name);
    size_t length = read_file(name, text, sizeof text);
    CHECK(length == 2 * half && memcmp(text, text + half, half) == 0, "appends");
    FILE *stream = fopen(name, "w");
    ccdPtDumpSVT2(&pt, stream);
    fclose(stream);
    length = read_file(name, text, sizeof text);
    CHECK(length == half, "writes to a stream");
    remove(name);
    ccdPtDumpSVT(&pt, "/no such directory/polytope");
    for (int i = 0; i < count; i++)
        if (model[i].type == PT_VERTEX)
            CHECK(((pt_vertex_t *)address[i])->id == id++, "a vertex's id");
}

static void add_any_edge(void)
{
    const int a = pick(PT_VERTEX), b = pick(PT_VERTEX);
    /* libccd's distance of an edge between equal points is NaN. */
    if (a != b && !ccdVec3Eq(&model[a].v.v, &model[b].v.v))
        add_edge(a, b);
}

int main(int argc, char **argv)
{
    /* as often as listed */
    static void (*const steps[])(void) = {
        add_vertex, add_vertex, add_vertex, add_vertex, add_vertex, add_any_edge, add_any_edge, add_face, add_face, add_face,
        add_face, add_face, delete_any, delete_any, delete_any, search, search, set_nearest, recompute, reject_null};
    const int polytopes = atoi(argc > 1 ? argv[1] : "200");
    ours = running_ccd() != NULL;
    for (int round = 0; round < polytopes; round++) {
        count = 0;
        memset(&pt, 0xa5, sizeof pt);
        ccdPtInit(&pt);
        reset_nearest();
        check_polytope();
        CHECK(ccdPtNearest(&pt) == NULL, "nothing is nearest in an empty polytope");
        for (int step = 0; step < 150 && count < MAX_ELEMENTS - 8; step++) {
            steps[random_below(sizeof steps / sizeof *steps)]();
            check_polytope();
        }
        dump();
        ccdPtDestroy(&pt);
        CHECK(list_length(&pt.vertices) + list_length(&pt.edges) + list_length(&pt.faces) == 0, "empty after destroy");
        CHECK(pt.nearest == NULL, "nothing is nearest after destroy");
    }
    return checks_end();
}
