/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A pile in MuJoCo: ellipsoids, cylinders, capsules, boxes and meshes fall into
 * a pen of planes and come to rest, from a start that the random stream SEED moves by
 * up to 1e-3 m a coordinate.
 *
 * usage: mujoco_pile SEED STEPS BODIES pile|multi|field
 *   multi: MuJoCo's multi-point convex collision; field: on a height field */

#include "engines/pile.h"

#include <mujoco/mujoco.h>
#include <stdarg.h>

enum { MESHES = 6, MESH_VERTICES = 12, FIELD = 24 };
static const double HALF_WIDTH = 0.55;

static char xml[1 << 17];
static size_t xml_length;

static void write_xml(const char *format, ...)
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

static void write_sizes(const char *type, double x, double y, double z)
{
    write_xml("<geom type=\"%s\" size=\"%.4f %.4f %.4f\"/>", type, x, y, z);
}

static void write_model(int bodies, int multi, int field)
{
    double q[4], at[3];
    write_xml("<mujoco><compiler angle=\"radian\"/><option timestep=\"0.004\"><flag energy=\"enable\"%s/></option>"
              "<size nconmax=\"600\" njmax=\"2400\"/><asset>", multi ? " multiccd=\"enable\"" : "");
    for (int i = 0; i < MESHES; i++) {
        write_xml("<mesh name=\"m%d\" vertex=\"", i);
        for (int j = 0; j < MESH_VERTICES; j++) {
            uniform_rotation(q);
            const double l = sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]) + 1e-3;
            write_xml("%.5f %.5f %.5f ", 0.1 * q[1] / l, 0.08 * q[2] / l, 0.12 * q[3] / l);
        }
        write_xml("\"/>");
    }
    if (field)
        write_xml("<hfield name=\"f\" nrow=\"%d\" ncol=\"%d\" size=\"%g %g 0.15 0.3\"/>", FIELD, FIELD, HALF_WIDTH + 0.1,
                  HALF_WIDTH + 0.1);
    write_xml("</asset><worldbody>");
    if (field)
        write_xml("<geom type=\"hfield\" hfield=\"f\"/>");
    else
        write_xml("<geom type=\"plane\" size=\"2 2 0.1\"/>");
    for (int i = 0; i < 4; i++) {
        const int sign = i % 2 ? 1 : -1, x = i < 2 ? sign : 0, y = i < 2 ? 0 : sign;
        write_xml("<geom type=\"plane\" size=\"2 2 .1\" pos=\"%g %g 0\" zaxis=\"%d %d 0\"/>", x * HALF_WIDTH, y * HALF_WIDTH, -x,
                  -y);
    }
    for (int i = 0; i < bodies; i++) {
        uniform_rotation(q);
        pile_place(i, 0.4, at);
        write_xml("<body pos=\"%.5f %.5f %.5f\" quat=\"%.6f %.6f %.6f %.6f\"><freejoint/>", at[0], at[1], at[2], q[0], q[1], q[2],
                  q[3]);
        switch (i % 5) {
        case 0: write_sizes("ellipsoid", uniform(.05, .13), uniform(.05, .13), uniform(.05, .13)); break;
        case 1: write_sizes("cylinder", uniform(.05, .12), uniform(.05, .12), 0); break;
        case 2: write_sizes("capsule", uniform(.04, .09), uniform(.04, .1), 0); break;
        case 3: write_xml("<geom type=\"mesh\" mesh=\"m%d\"/>", i / 5 % MESHES); break;
        default: write_sizes("box", uniform(.05, .12), uniform(.05, .12), uniform(.05, .12)); break;
        }
        write_xml("</body>");
    }
    write_xml("</worldbody></mujoco>");
}

int main(int argc, char **argv)
{
    static mjVFS vfs;
    char error[1000] = "";
    pile_t pile = pile_start(argc, argv, "pile|multi|field");
    uniform_seed(5);
    write_model(pile.bodies, !strcmp(pile.scene, "multi"), !strcmp(pile.scene, "field"));
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
    uniform_seed(pile.seed);
    for (int i = 0; i < m->njnt; i++)
        for (int k = 0; k < 3; k++)
            d->qpos[m->jnt_qposadr[i] + k] += uniform(-1e-3, 1e-3);
    for (; pile.step < pile.steps; pile.step++) {
        mj_step(m, d);
        for (int i = 0; i < m->njnt; i++) /* the origin of a mesh may lie on its surface */
            pile_body(&pile, d->qpos + m->jnt_qposadr[i], HALF_WIDTH + 0.1, -0.1);
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
    mj_deleteData(d);
    mj_deleteModel(m);
    mj_deleteVFS(&vfs);
    return 0;
}
