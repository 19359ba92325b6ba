/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The polytope functions, of both libraries in lockstep where there are both: random sequences of additions,
 * deletions by the user's inline functions, nearest elements set by the user, searches and
 * recomputations. After every step each library's polytope is held against a model: what
 * was added, in which order, and which element libccd's rule makes nearest given the
 * distances that stand in the elements. The distances are nearest.c's matter. */

#include "check.h"
#include "ours.h"
#include "polytope.h"
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

POLYTOPE_FUNCTIONS(OURS);

typedef struct {
    const char *name;
    void (*init)(pt_t *);
    void (*destroy)(pt_t *);
    pt_vertex_t *(*add_vertex)(pt_t *, const support_t *);
    pt_edge_t *(*add_edge)(pt_t *, pt_vertex_t *, pt_vertex_t *);
    pt_face_t *(*add_face)(pt_t *, pt_edge_t *, pt_edge_t *, pt_edge_t *);
    void (*recompute)(pt_t *);
    pt_el_t *(*nearest)(pt_t *);
    void (*dump)(pt_t *, const char *);
    void (*dump2)(pt_t *, FILE *);
} library_t;

#define LIBRARY(name, NAME)                                                                          \
    {name, NAME(ccdPtInit), NAME(ccdPtDestroy), NAME(ccdPtAddVertex), NAME(ccdPtAddEdge),            \
     NAME(ccdPtAddFace), NAME(ccdPtRecomputeDistances), NAME(ccdPtNearest), NAME(ccdPtDumpSVT),      \
     NAME(ccdPtDumpSVT2)}

#ifdef OURS_ALONE
enum { LIBRARIES = 1 };
static const library_t libraries[] = {LIBRARY("this library", OURS)};
#else
enum { LIBRARIES = 2 };
static const library_t libraries[] = {LIBRARY("this library", OURS), LIBRARY("libccd", LIBCCD)};
#endif

enum { MOST = 512, END = -1 };

/* What the polytopes must hold. Elements are numbered as they were added; a deleted one
 * has type 0. parts: vertices of an edge, edges of a face. sides: faces of an edge. */
typedef struct {
    int type;
    int parts[3];
    int sides[2];
    support_t v;
} element_t;

static element_t model[MOST];
static int count;

/* The same for each library: its polytope, its elements, the nearest by the rule. */
static pt_t pt[LIBRARIES];
static pt_el_t *address[LIBRARIES][MOST];
static struct { int element; ccd_real_t dist; int type; } nearest[LIBRARIES];

static int number(int lib, const void *element)
{
    int i;
    for (i = 0; i < count; i++)
        if (model[i].type != 0 && element == address[lib][i])
            return i;
    return END;
}

static void rule(int lib, int element)
{
    const pt_el_t *el = address[lib][element];
    if (ccdEq(nearest[lib].dist, el->dist) ? el->type < nearest[lib].type : el->dist < nearest[lib].dist) {
        nearest[lib].element = element;
        nearest[lib].dist = el->dist;
        nearest[lib].type = el->type;
    }
}

static void forget(int lib)
{
    nearest[lib].element = END;
    nearest[lib].dist = CCD_REAL_MAX;
    nearest[lib].type = PT_FACE;
}

/* --- the check ------------------------------------------------------------- */

/* A polytope's list holds the living elements of a type, oldest first. */
static void check_list(int lib, const list_t *head, int type)
{
    const list_t *link = head->next;
    int i;
    CHECK(link->prev == head && head->prev->next == head, "%s: circular", libraries[lib].name);
    for (i = 0; i < count; i++) {
        if (model[i].type == type) {
            CHECK(link == &address[lib][i]->list, "%s: type %d, element %d in its place", libraries[lib].name, type, i);
            if (link == head)
                return;
            CHECK(link->next->prev == link, "%s: linked both ways", libraries[lib].name);
            link = link->next;
        }
    }
    CHECK(link == head, "%s: nothing more of type %d", libraries[lib].name, type);
}

static void check_vertex(int lib, int i)
{
    pt_vertex_t *vertex = (pt_vertex_t *)address[lib][i];
    const list_t *link = vertex->edges.next;
    int k;
    CHECK(same_bits(&vertex->v, &model[i].v, sizeof vertex->v), "%s: vertex %d keeps its point", libraries[lib].name, i);
    CHECK(same_bits(&vertex->el.witness, &model[i].v.v, sizeof vertex->el.witness), "a vertex's witness is v");
    CHECK(vertex->el.dist == ccdVec3Len2(&model[i].v.v), "a vertex's distance is squared");
    /* Its edges, oldest first; each by the link of the end that stands here. */
    for (k = 0; k < count; k++) {
        int end;
        for (end = 0; end < 2; end++) {
            if (model[k].type == PT_EDGE && model[k].parts[end] == i) {
                pt_edge_t *edge = (pt_edge_t *)address[lib][k];
                CHECK(link == &edge->vertex_list[end], "%s: edge %d hangs on vertex %d", libraries[lib].name, k, i);
                link = link->next;
            }
        }
    }
    CHECK(link == &vertex->edges, "%s: vertex %d has no other edge", libraries[lib].name, i);
}

static void check_polytope(int lib)
{
    int i, k;
    check_list(lib, &pt[lib].vertices, PT_VERTEX);
    check_list(lib, &pt[lib].edges, PT_EDGE);
    check_list(lib, &pt[lib].faces, PT_FACE);
    for (i = 0; i < count; i++) {
        if (model[i].type == 0)
            continue;
        CHECK(address[lib][i]->type == model[i].type, "%s: type", libraries[lib].name);
        if (model[i].type == PT_VERTEX) {
            check_vertex(lib, i);
        } else if (model[i].type == PT_EDGE) {
            const pt_edge_t *edge = (const pt_edge_t *)address[lib][i];
            for (k = 0; k < 2; k++) {
                CHECK(number(lib, edge->vertex[k]) == model[i].parts[k], "%s: edge %d's vertices", libraries[lib].name, i);
                CHECK((edge->faces[k] == NULL ? END : number(lib, edge->faces[k])) == model[i].sides[k],
                      "%s: edge %d's faces", libraries[lib].name, i);
            }
        } else {
            const pt_face_t *face = (const pt_face_t *)address[lib][i];
            for (k = 0; k < 3; k++)
                CHECK(number(lib, face->edge[k]) == model[i].parts[k], "%s: face %d's edges", libraries[lib].name, i);
        }
    }
    CHECK((pt[lib].nearest == NULL ? END : number(lib, pt[lib].nearest)) == nearest[lib].element,
          "%s: nearest is %d, by the rule %d", libraries[lib].name, number(lib, pt[lib].nearest), nearest[lib].element);
    CHECK(pt[lib].nearest_dist == nearest[lib].dist && pt[lib].nearest_type == nearest[lib].type,
          "%s: nearest_dist, nearest_type", libraries[lib].name);
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
    int lib;
    model[count].type = type;
    for (lib = 0; lib < LIBRARIES; lib++)
        rule(lib, count);
    count++;
}

static void add_vertex(void)
{
    support_t s;
    int lib;
    s.v1 = random_vec3(2);
    s.v2 = random_vec3(2);
    s.v = random_vec3(random_below(2) ? 1 : 1e-9);
    if (random_below(4) == 0)
        for (lib = 0; lib < 3; lib++)
            s.v.v[lib] = (ccd_real_t)(random_below(3) - 1);
    model[count].v = s;
    for (lib = 0; lib < LIBRARIES; lib++)
        address[lib][count] = (pt_el_t *)libraries[lib].add_vertex(&pt[lib], &s);
    added(PT_VERTEX);
}

static int add_edge(int a, int b)
{
    int lib;
    model[count].parts[0] = a;
    model[count].parts[1] = b;
    model[count].sides[0] = model[count].sides[1] = END;
    for (lib = 0; lib < LIBRARIES; lib++)
        address[lib][count] = (pt_el_t *)libraries[lib].add_edge(&pt[lib], (pt_vertex_t *)address[lib][a],
                                                                 (pt_vertex_t *)address[lib][b]);
    added(PT_EDGE);
    return count - 1;
}

/* The edge between two vertices that has a side free; a new one if there is none. */
static int edge_between(int a, int b)
{
    int i;
    for (i = 0; i < count; i++)
        if (model[i].type == PT_EDGE && model[i].sides[1] == END
            && ((model[i].parts[0] == a && model[i].parts[1] == b) || (model[i].parts[0] == b && model[i].parts[1] == a)))
            return i;
    return random_below(2) ? add_edge(a, b) : add_edge(b, a);
}

static void add_face(void)
{
    int a = pick(PT_VERTEX), b = pick(PT_VERTEX), c = pick(PT_VERTEX), lib, k;
    int edge[3];
    if (a == END || a == b || b == c || c == a || count > MOST - 8)
        return;
    edge[0] = edge_between(a, b);
    edge[1] = edge_between(b, c);
    edge[2] = edge_between(c, a);
    for (lib = 0; lib < LIBRARIES; lib++)
        address[lib][count] =
            (pt_el_t *)libraries[lib].add_face(&pt[lib], (pt_edge_t *)address[lib][edge[0]],
                                               (pt_edge_t *)address[lib][edge[1]], (pt_edge_t *)address[lib][edge[2]]);
    for (k = 0; k < 3; k++) {
        model[count].parts[k] = edge[k];
        model[edge[k]].sides[model[edge[k]].sides[0] != END] = count;
    }
    added(PT_FACE);
}

static void deleted(int i)
{
    int lib;
    model[i].type = 0;
    for (lib = 0; lib < LIBRARIES; lib++)
        if (nearest[lib].element == i)
            nearest[lib].element = END;
}

static void delete_face(int i)
{
    int lib, k;
    for (lib = 0; lib < LIBRARIES; lib++)
        pt_delete_face(&pt[lib], (pt_face_t *)address[lib][i]);
    for (k = 0; k < 3; k++) {
        int *sides = model[model[i].parts[k]].sides;
        if (sides[0] == i)
            sides[0] = sides[1];
        sides[1] = END;
    }
    deleted(i);
}

static void delete_any(void)
{
    int type = 1 + random_below(3), i = pick(type), lib;
    if (i == END)
        return;
    if (type == PT_FACE) {
        delete_face(i);
        return;
    }
    for (lib = 0; lib < LIBRARIES; lib++) {
        if (type == PT_EDGE) {
            if (!pt_edge_is_free((pt_edge_t *)address[lib][i]))
                return;
            pt_delete_edge(&pt[lib], (pt_edge_t *)address[lib][i]);
        } else {
            if (!pt_vertex_is_free((pt_vertex_t *)address[lib][i]))
                return;
            pt_delete_vertex(&pt[lib], (pt_vertex_t *)address[lib][i]);
        }
    }
    deleted(i);
}

/* As FCL does when it has found the element itself. */
static void set_nearest(void)
{
    int i = pick(1 + random_below(3)), lib;
    if (i == END)
        return;
    for (lib = 0; lib < LIBRARIES; lib++) {
        pt[lib].nearest = address[lib][i];
        nearest[lib].element = i;
        pt[lib].nearest_dist = nearest[lib].dist = (ccd_real_t)random_unit();
        pt[lib].nearest_type = nearest[lib].type = address[lib][i]->type;
    }
}

static void search(void)
{
    int lib, type, i;
    for (lib = 0; lib < LIBRARIES; lib++) {
        pt_el_t *found = libraries[lib].nearest(&pt[lib]);
        if (nearest[lib].element == END) {
            forget(lib);
            for (type = PT_VERTEX; type <= PT_FACE; type++)
                for (i = 0; i < count; i++)
                    if (model[i].type == type)
                        rule(lib, i);
        }
        CHECK(found == pt[lib].nearest, "%s: returns nearest", libraries[lib].name);
    }
}

/* Moves a vertex behind the library's back and has the distances made anew. */
static void recompute(void)
{
    int i = pick(PT_VERTEX), lib, k;
    if (i == END)
        return;
    model[i].v.v = random_vec3(1);
    for (lib = 0; lib < LIBRARIES; lib++) {
        pt_vertex_t *vertex = (pt_vertex_t *)address[lib][i];
        vertex->v = model[i].v;
        libraries[lib].recompute(&pt[lib]);
    }
    for (k = 0; k < count; k++) {
        /* Far from the ties that only rounding decides, the libraries agree. */
        if (model[k].type != 0) {
            double ours = sqrt((double)address[0][k]->dist), theirs = sqrt((double)address[LIBRARIES - 1][k]->dist);
            CHECK(fabs(ours - theirs) < 1e-7 || theirs != theirs, "distance %g, libccd's %g", ours, theirs);
            CHECK(fabs((double)(address[0][k]->dist - ccdVec3Len2(&address[0][k]->witness))) <= 0, "the witness's distance");
        }
    }
}

static void refuse(void)
{
    int v = pick(PT_VERTEX), e = pick(PT_EDGE), lib;
    for (lib = 0; lib < LIBRARIES; lib++) {
        pt_vertex_t *vertex = v == END ? NULL : (pt_vertex_t *)address[lib][v];
        pt_edge_t *edge = e == END ? NULL : (pt_edge_t *)address[lib][e];
        CHECK(libraries[lib].add_edge(&pt[lib], NULL, vertex) == NULL, "NULL vertex");
        CHECK(libraries[lib].add_edge(&pt[lib], vertex, NULL) == NULL, "NULL vertex");
        CHECK(libraries[lib].add_face(&pt[lib], NULL, edge, edge) == NULL, "NULL edge");
        CHECK(libraries[lib].add_face(&pt[lib], edge, NULL, edge) == NULL, "NULL edge");
        CHECK(libraries[lib].add_face(&pt[lib], edge, edge, NULL) == NULL, "NULL edge");
    }
}

static size_t read_file(const char *name, char *text, size_t most)
{
    FILE *file = fopen(name, "r");
    size_t n = file == NULL ? 0 : fread(text, 1, most, file);
    if (file != NULL)
        fclose(file);
    return n;
}

/* The same text from both, twice in the file after two calls; vertices numbered. */
static void dump(void)
{
    static char text[LIBRARIES][1 << 17];
    size_t length[LIBRARIES], half;
    int lib, i, id = 0;
    for (lib = 0; lib < LIBRARIES; lib++) {
        char name[512];
        const char *directory = getenv("TMPDIR");
        FILE *stream;
        int file;
        snprintf(name, sizeof name, "%s/polytope-XXXXXX", directory ? directory : P_tmpdir);
        file = mkstemp(name);
        CHECK(file >= 0, "a temporary file");
        close(file);
        libraries[lib].dump(&pt[lib], name);
        half = read_file(name, text[lib], sizeof text[lib]);
        libraries[lib].dump(&pt[lib], name);
        length[lib] = read_file(name, text[lib], sizeof text[lib]);
        CHECK(length[lib] == 2 * half && memcmp(text[lib], text[lib] + half, half) == 0, "appends");
        stream = fopen(name, "w");
        libraries[lib].dump2(&pt[lib], stream);
        fclose(stream);
        length[lib] = read_file(name, text[lib], sizeof text[lib]);
        CHECK(length[lib] == half, "writes to a stream");
        remove(name);
        libraries[lib].dump(&pt[lib], "/no such directory/polytope");
    }
    CHECK(length[0] == length[LIBRARIES - 1] && memcmp(text[0], text[LIBRARIES - 1], length[0]) == 0, "the same text");
    for (i = 0; i < count; i++)
        if (model[i].type == PT_VERTEX) {
            CHECK(((pt_vertex_t *)address[0][i])->id == id, "vertex number %d", id);
            id++;
        }
}

int main(int argc, char **argv)
{
    const int polytopes = atoi(argc > 1 ? argv[1] : "200");
    int round, step, lib;
    for (round = 0; round < polytopes; round++) {
        count = 0;
        for (lib = 0; lib < LIBRARIES; lib++) {
            memset(&pt[lib], 0xa5, sizeof pt[lib]);
            libraries[lib].init(&pt[lib]);
            forget(lib);
            check_polytope(lib);
        }
        CHECK(libraries[0].nearest(&pt[0]) == NULL, "nothing is nearest in an empty polytope");
        for (step = 0; step < 150 && count < MOST - 8; step++) {
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
            for (lib = 0; lib < LIBRARIES; lib++)
                check_polytope(lib);
        }
        dump();
        for (lib = 0; lib < LIBRARIES; lib++) {
            libraries[lib].destroy(&pt[lib]);
            CHECK(list_length(&pt[lib].vertices) + list_length(&pt[lib].edges) + list_length(&pt[lib].faces) == 0,
                  "%s: empty after destroy", libraries[lib].name);
            CHECK(pt[lib].nearest == NULL, "%s: nothing is nearest after destroy", libraries[lib].name);
        }
    }
    return checks_end();
}
