/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The polytope functions, of whichever library is loaded: random sequences of additions,
 * deletions by the user's inline functions, nearest elements set by the user, searches and
 * recomputations. After every step the polytope is held against a model: what
 * was added, in which order, and which element libccd's rule makes nearest given the
 * distances that stand in the elements. The distances are point_distance.c's matter. */

#include "check.h"
#include "harness/identity.h"
#include "polytope.h"
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

enum { MOST = 512, END = -1 };

/* Expected contents of the polytopes. Elements are numbered as they were added; a deleted one
 * has type 0. parts: vertices of an edge, edges of a face. sides: faces of an edge. */
typedef struct {
    int type;
    int parts[3];
    int sides[2];
    support_t v;
} element_t;

static element_t model[MOST];
static int count;

static int ours; /* else libccd, of which less is asked */

/* The library's: its polytope, its elements, the nearest by the rule. */
static pt_t pt;
static pt_el_t *address[MOST];
static struct { int element; ccd_real_t dist; int type; } nearest;

static int number(const void *element)
{
    for (int i = 0; i < count; i++)
        if (model[i].type != 0 && element == address[i])
            return i;
    return END;
}

static void rule(int element)
{
    const pt_el_t *el = address[element];
    if (ccdEq(nearest.dist, el->dist) ? el->type < nearest.type : el->dist < nearest.dist) {
        nearest.element = element;
        nearest.dist = el->dist;
        nearest.type = el->type;
    }
}

static void forget(void)
{
    nearest.element = END;
    nearest.dist = CCD_REAL_MAX;
    nearest.type = PT_FACE;
}

/* --- the check ------------------------------------------------------------- */

/* A polytope's list holds the living elements of a type, oldest first. */
static void check_list(const list_t *head, int type)
{
    const list_t *link = head->next;
    CHECK(link->prev == head && head->prev->next == head, "circular");
    for (int i = 0; i < count; i++) {
        if (model[i].type == type) {
            CHECK(link == &address[i]->list, "type %d, element %d in its place", type, i);
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
    /* Its edges, oldest first; each by the link of the end that stands here. */
    for (int k = 0; k < count; k++) {
        for (int end = 0; end < 2; end++) {
            if (model[k].type == PT_EDGE && model[k].parts[end] == i) {
                pt_edge_t *edge = (pt_edge_t *)address[k];
                CHECK(link == &edge->vertex_list[end], "edge %d hangs on vertex %d", k, i);
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
                CHECK(number(edge->vertex[k]) == model[i].parts[k], "edge %d's vertices", i);
                CHECK((edge->faces[k] == NULL ? END : number(edge->faces[k])) == model[i].sides[k],
                      "edge %d's faces", i);
            }
        } else {
            const pt_face_t *face = (const pt_face_t *)address[i];
            for (int k = 0; k < 3; k++)
                CHECK(number(face->edge[k]) == model[i].parts[k], "face %d's edges", i);
        }
    }
    CHECK((pt.nearest == NULL ? END : number(pt.nearest)) == nearest.element,
          "nearest is %d, by the rule %d", number(pt.nearest), nearest.element);
    CHECK(pt.nearest_dist == nearest.dist && pt.nearest_type == nearest.type,
          "nearest_dist, nearest_type");
}

/* --- the steps ------------------------------------------------------------- */

static int pick(int type)
{
    int start = count == 0 ? 0 : random_below(count), i;
    for (i = 0; i < count; i++)
        if (model[(start + i) % count].type == type)
            return (start + i) % count;
    return END;
}

static void added(int type)
{
    model[count].type = type;
    rule(count);
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
    model[count].sides[0] = model[count].sides[1] = END;
    address[count] = (pt_el_t *)ccdPtAddEdge(&pt, (pt_vertex_t *)address[a], (pt_vertex_t *)address[b]);
    added(PT_EDGE);
    return count - 1;
}

/* The edge between two vertices that has a side free; a new one if there is none. */
static int edge_between(int a, int b)
{
    for (int i = 0; i < count; i++)
        if (model[i].type == PT_EDGE && model[i].sides[1] == END
            && ((model[i].parts[0] == a && model[i].parts[1] == b) || (model[i].parts[0] == b && model[i].parts[1] == a)))
            return i;
    return random_below(2) ? add_edge(a, b) : add_edge(b, a);
}

static void add_face(void)
{
    int a = pick(PT_VERTEX), b = pick(PT_VERTEX), c = pick(PT_VERTEX), k;
    int edge[3];
    if (a == END || a == b || b == c || c == a || count > MOST - 8)
        return;
    edge[0] = edge_between(a, b);
    edge[1] = edge_between(b, c);
    edge[2] = edge_between(c, a);
    address[count] = (pt_el_t *)ccdPtAddFace(&pt, (pt_edge_t *)address[edge[0]], (pt_edge_t *)address[edge[1]],
                                             (pt_edge_t *)address[edge[2]]);
    for (k = 0; k < 3; k++) {
        model[count].parts[k] = edge[k];
        model[edge[k]].sides[model[edge[k]].sides[0] != END] = count;
    }
    added(PT_FACE);
}

static void deleted(int i)
{
    model[i].type = 0;
    if (nearest.element == i)
        nearest.element = END;
}

static void delete_face(int i)
{
    pt_delete_face(&pt, (pt_face_t *)address[i]);
    for (int k = 0; k < 3; k++) {
        int *sides = model[model[i].parts[k]].sides;
        if (sides[0] == i)
            sides[0] = sides[1];
        sides[1] = END;
    }
    deleted(i);
}

static void delete_any(void)
{
    int type = 1 + random_below(3), i = pick(type);
    if (i == END)
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

/* As FCL does when it has found the element itself. */
static void set_nearest(void)
{
    int i = pick(1 + random_below(3));
    if (i == END)
        return;
    pt.nearest = address[i];
    nearest.element = i;
    pt.nearest_dist = nearest.dist = (ccd_real_t)uniform(0, 1);
    pt.nearest_type = nearest.type = address[i]->type;
}

static void search(void)
{
    const pt_el_t *found = ccdPtNearest(&pt);
    if (nearest.element == END) {
        forget();
        for (int type = PT_VERTEX; type <= PT_FACE; type++)
            for (int i = 0; i < count; i++)
                if (model[i].type == type)
                    rule(i);
    }
    CHECK(found == pt.nearest, "returns nearest");
}

/* The squared distance of an edge or a face of three corners. */
static double distance2(const element_t *e)
{
    const element_t *one = e->type == PT_FACE ? &model[e->parts[0]] : e, *two = &model[e->parts[1]];
    const ccd_vec3_t *a = &model[one->parts[0]].v.v, *b = &model[one->parts[1]].v.v, *c;
    if (e->type == PT_EDGE)
        return (double)ccdVec3PointSegmentDist2(ccd_vec3_origin, a, b, NULL);
    c = &model[two->parts[two->parts[0] == one->parts[0] || two->parts[0] == one->parts[1]]].v.v;
    return (double)ccdVec3PointTriDist2(ccd_vec3_origin, a, b, c, NULL);
}

/* Moves a vertex behind the library's back and has the distances made anew. */
static void recompute(void)
{
    int i = pick(PT_VERTEX), k;
    if (i == END)
        return;
    model[i].v.v = random_vec3(1);
    ((pt_vertex_t *)address[i])->v = model[i].v;
    ccdPtRecomputeDistances(&pt);
    for (k = 0; k < count; k++)
        if (model[k].type > PT_VERTEX) {
            /* libccd's value depends on the order of the corners, and on whether a witness is asked for. */
            const double dist2 = (double)address[k]->dist, off = sqrt(dist2) - sqrt(distance2(&model[k]));
            CHECK(fabs(off) < 1e-7 || !ours, "a distance off by %g", off);
            CHECK(dist2 == (double)ccdVec3Len2(&address[k]->witness) || !ours, "the witness's distance");
        }
}

static void refuse(void)
{
    int v = pick(PT_VERTEX), e = pick(PT_EDGE);
    pt_vertex_t *vertex = v == END ? NULL : (pt_vertex_t *)address[v];
    pt_edge_t *edge = e == END ? NULL : (pt_edge_t *)address[e];
    CHECK(ccdPtAddEdge(&pt, NULL, vertex) == NULL, "NULL vertex");
    CHECK(ccdPtAddEdge(&pt, vertex, NULL) == NULL, "NULL vertex");
    CHECK(ccdPtAddFace(&pt, NULL, edge, edge) == NULL, "NULL edge");
    CHECK(ccdPtAddFace(&pt, edge, NULL, edge) == NULL, "NULL edge");
    CHECK(ccdPtAddFace(&pt, edge, edge, NULL) == NULL, "NULL edge");
}

static size_t read_file(const char *name, char *text, size_t most)
{
    FILE *file = fopen(name, "r");
    size_t n = file == NULL ? 0 : fread(text, 1, most, file);
    if (file != NULL)
        fclose(file);
    return n;
}

/* The text, twice in the file after two calls; vertices numbered. The driver compares what both libraries say. */
static void dump(void)
{
    static char text[1 << 17];
    int id = 0, file;
    char name[512];
    const char *directory = getenv("TMPDIR");
    snprintf(name, sizeof name, "%s/polytope-XXXXXX", directory ? directory : P_tmpdir);
    file = mkstemp(name);
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
        if (model[i].type == PT_VERTEX) {
            CHECK(((pt_vertex_t *)address[i])->id == id, "vertex number %d", id);
            id++;
        }
}

int main(int argc, char **argv)
{
    const int polytopes = atoi(argc > 1 ? argv[1] : "200");
    ours = running_ccd() != NULL;
    for (int round = 0; round < polytopes; round++) {
        count = 0;
        memset(&pt, 0xa5, sizeof pt);
        ccdPtInit(&pt);
        forget();
        check_polytope();
        CHECK(ccdPtNearest(&pt) == NULL, "nothing is nearest in an empty polytope");
        for (int step = 0; step < 150 && count < MOST - 8; step++) {
            int what = random_below(20), a, b;
            if (what < 5) {
                add_vertex();
            } else if (what < 7) {
                a = pick(PT_VERTEX);
                b = pick(PT_VERTEX);
                /* libccd's distance of an edge between equal points is NaN. */
                if (a != b && !ccdVec3Eq(&model[a].v.v, &model[b].v.v))
                    add_edge(a, b);
            } else if (what < 12) {
                add_face();
            } else if (what < 15) {
                delete_any();
            } else if (what < 17) {
                search();
            } else if (what < 18) {
                set_nearest();
            } else if (what < 19) {
                recompute();
            } else {
                refuse();
            }
            check_polytope();
        }
        dump();
        ccdPtDestroy(&pt);
        CHECK(list_length(&pt.vertices) + list_length(&pt.edges) + list_length(&pt.faces) == 0, "empty after destroy");
        CHECK(pt.nearest == NULL, "nothing is nearest after destroy");
    }
    return checks_end();
}
