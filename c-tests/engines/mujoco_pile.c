/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A pile in MuJoCo: ellipsoids, cylinders, capsules, boxes and meshes fall into
 * a pen of planes and come to rest, from a start that is moved by up to 1e-3 m
 * a coordinate, by a stream named SEED. Prints what the second half of the run
 * looked like.
 *
 * usage: mujoco_pile SEED STEPS BODIES pile|multi|field
 *   multi: MuJoCo's multi-point convex collision; field: on a height field */

#include "engines/pile.h"
#include "harness/random.h"
#include "harness/identity.h"

#include <mujoco/mujoco.h>
#include <stdarg.h>

enum { MESHES = 6, MESH_VERTICES = 12, FIELD = 24 };
static const double HALF_WIDTH = 0.55;

static char xml[1 << 17];
static size_t xml_length;

static void put(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    xml_length += (size_t)vsnprintf(xml + xml_length, sizeof xml - xml_length, format, args);
    va_end(args);
    if (xml_length >= sizeof xml) {
        fprintf(stderr, "model too large\n");
        exit(2);
    }
}

static void put_model(int bodies, int multi, int field)
{
    double q[4];
    put("<mujoco><compiler angle=\"radian\"/><option timestep=\"0.004\"><flag energy=\"enable\"%s/></option>"
        "<size nconmax=\"600\" njmax=\"2400\"/><asset>", multi ? " multiccd=\"enable\"" : "");
    for (int i = 0; i < MESHES; i++) {
        put("<mesh name=\"m%d\" vertex=\"", i);
        for (int j = 0; j < MESH_VERTICES; j++) {
            uniform_rotation(q);
            {
                const double l = sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]) + 1e-3;
                put("%.5f %.5f %.5f ", 0.1 * q[1] / l, 0.08 * q[2] / l, 0.12 * q[3] / l);
            }
        }
        put("\"/>");
    }
    if (field)
        put("<hfield name=\"f\" nrow=\"%d\" ncol=\"%d\" size=\"%g %g 0.15 0.3\"/>", FIELD, FIELD, HALF_WIDTH + 0.1, HALF_WIDTH + 0.1);
    put("</asset><worldbody>");
    if (field)
        put("<geom type=\"hfield\" hfield=\"f\"/>");
    else
        put("<geom type=\"plane\" size=\"2 2 0.1\"/>");
    put("<geom type=\"plane\" size=\"2 2 .1\" pos=\"-%g 0 0\" zaxis=\"1 0 0\"/><geom type=\"plane\" size=\"2 2 .1\" pos=\"%g 0 0\" zaxis=\"-1 0 0\"/>"
        "<geom type=\"plane\" size=\"2 2 .1\" pos=\"0 -%g 0\" zaxis=\"0 1 0\"/><geom type=\"plane\" size=\"2 2 .1\" pos=\"0 %g 0\" zaxis=\"0 -1 0\"/>",
        HALF_WIDTH, HALF_WIDTH, HALF_WIDTH, HALF_WIDTH);
    for (int i = 0; i < bodies; i++) {
        uniform_rotation(q);
        put("<body pos=\"%.5f %.5f %.5f\" quat=\"%.6f %.6f %.6f %.6f\"><freejoint/>", 0.34 * (i % 3 - 1) + uniform(-.02, .02),
            0.34 * (i / 3 % 3 - 1) + uniform(-.02, .02), 0.4 + 0.33 * (i / 9), q[0], q[1], q[2], q[3]);
        switch (i % 5) {
        case 0: put("<geom type=\"ellipsoid\" size=\"%.4f %.4f %.4f\"/>", uniform(.05, .13), uniform(.05, .13), uniform(.05, .13)); break;
        case 1: put("<geom type=\"cylinder\" size=\"%.4f %.4f\"/>", uniform(.05, .12), uniform(.05, .12)); break;
        case 2: put("<geom type=\"capsule\" size=\"%.4f %.4f\"/>", uniform(.04, .09), uniform(.04, .1)); break;
        case 3: put("<geom type=\"mesh\" mesh=\"m%d\"/>", i / 5 % MESHES); break;
        default: put("<geom type=\"box\" size=\"%.4f %.4f %.4f\"/>", uniform(.05, .12), uniform(.05, .12), uniform(.05, .12)); break;
        }
        put("</body>");
    }
    put("</worldbody></mujoco>");
}

/* Positions that left the pen or are not numbers. */
static int escaped(const mjModel *m, const mjData *d)
{
    int out = 0;
    for (int i = 0; i < m->njnt; i++) {
        const mjtNum *p = d->qpos + m->jnt_qposadr[i];
        /* the origin of a mesh may lie on its surface */
        out += !(fabs(p[0]) < HALF_WIDTH + 0.1 && fabs(p[1]) < HALF_WIDTH + 0.1 && p[2] > -0.1 && p[2] < 20);
    }
    return out;
}

int main(int argc, char **argv)
{
    static mjVFS vfs;
    char error[1000] = "";
    if (argc != 5) {
        fprintf(stderr, "usage: mujoco_pile SEED STEPS BODIES pile|multi|field\n");
        return 2;
    }
    long steps = atol(argv[2]);
    pile_t pile = pile_of(steps);
    int multi = !strcmp(argv[4], "multi");
    int field = !strcmp(argv[4], "field");
    print_library();
    uniform_seed(5);
    put_model(atoi(argv[3]), multi, field);
    mj_defaultVFS(&vfs);
    if (mj_makeEmptyFileVFS(&vfs, "pile.xml", (int)xml_length) != 0)
        return 2;
    memcpy(vfs.filedata[0], xml, xml_length);
    mjModel *m = mj_loadXML("pile.xml", &vfs, error, sizeof error);
    if (!m) {
        fprintf(stderr, "%s\n", error);
        return 2;
    }
    for (int i = 0; i < m->nhfielddata; i++)
        m->hfield_data[i] = (float)(0.5 + 0.5 * sin(0.9 * (i % FIELD)) * cos(0.7 * (i / FIELD)));
    mjData *d = mj_makeData(m);
    uniform_seed(strtoull(argv[1], NULL, 10));
    for (int i = 0; i < m->njnt; i++) {
        mjtNum *p = d->qpos + m->jnt_qposadr[i];
        p[0] += uniform(-1e-3, 1e-3);
        p[1] += uniform(-1e-3, 1e-3);
        p[2] += uniform(-1e-3, 1e-3);
    }
    for (long step = 0; step < steps; step++) {
        pile.step = step;
        mj_step(m, d);
        pile.escaped |= escaped(m, d);
        /* not while bodies fall: what an impact stores in its contact counts as lost, and comes back */
        if (pile_is_late(&pile))
            pile_energy(&pile, d->energy[1], d->energy[0]);
        for (int i = 0; i < d->ncon; i++) {
            const mjContact *c = &d->contact[i];
            const mjtNum *n = c->frame;
            /* planes never reach libccd, nor do gaps */
            const int counts = m->geom_type[c->geom1] != mjGEOM_PLANE && m->geom_type[c->geom2] != mjGEOM_PLANE && c->dist < 0;
            const double length2 = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
            if (counts || !(fabs(length2 - 1) < 1e-6) || !(fabs(c->dist) < 1e3))
                pile_contact(&pile, length2, -c->dist);
        }
    }
    for (int i = 0; i < mjNWARNING; i++)
        pile.bad += d->warning[i].number;
    pile_report(&pile);
    printf("\n");
    mj_deleteData(d);
    mj_deleteModel(m);
    mj_deleteVFS(&vfs);
    return 0;
}
