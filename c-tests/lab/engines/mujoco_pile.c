/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A pile in MuJoCo: ellipsoids, cylinders, capsules, boxes and meshes fall into a pen of planes, from a start that SEED
 * moves by up to 1e-3 m a coordinate. Exits with 1 if MuJoCo warns.
 *
 * usage: mujoco_pile SEED STEPS BODIES */

#include "harness/identity.h"
#include "harness/random.h"

#include <mujoco/mujoco.h>
#include <stdarg.h>
#include <time.h>

static char xml[1 << 16];
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

static void write_model(int bodies)
{
    static const char *const geoms[] = {
        "type=\"ellipsoid\" size=\"0.06 0.09 0.12\"",
        "type=\"cylinder\" size=\"0.08 0.1\"",
        "type=\"capsule\" size=\"0.06 0.07\"",
        "type=\"mesh\" mesh=\"hull\"",
        "type=\"box\" size=\"0.06 0.08 0.1\"",
    };
    write_xml("<mujoco><option timestep=\"0.004\"/><size nconmax=\"600\" njmax=\"2400\"/><asset>"
              "<mesh name=\"hull\" vertex=\".1 0 0 -.1 .02 0 0 .08 .01 .01 -.08 0 0 .01 .12 0 0 -.12 "
              ".06 .05 .06 -.06 -.05 -.07\"/>"
              "</asset><worldbody><geom type=\"plane\" size=\"2 2 .1\"/>");
    for (int i = 0; i < 4; i++) {
        const int sign = i % 2 ? 1 : -1, x = i < 2 ? sign : 0, y = i < 2 ? 0 : sign;
        write_xml("<geom type=\"plane\" size=\"2 2 .1\" pos=\"%g %g 0\" zaxis=\"%d %d 0\"/>", 0.55 * x, 0.55 * y, -x, -y);
    }
    for (int i = 0; i < bodies; i++) {
        double q[4];
        uniform_rotation(q);
        write_xml("<body pos=\"%.5f %.5f %.5f\" quat=\"%.6f %.6f %.6f %.6f\"><freejoint/><geom %s/></body>",
                  0.34 * (i % 3 - 1) + uniform(-.02, .02), 0.34 * (i / 3 % 3 - 1) + uniform(-.02, .02), 0.4 + 0.33 * (i / 9),
                  q[0], q[1], q[2], q[3], geoms[i % 5]);
    }
    write_xml("</worldbody></mujoco>");
}

int main(int argc, char **argv)
{
    static mjVFS vfs;
    char error[1000] = "";
    int warnings = 0;
    if (argc != 4) {
        fprintf(stderr, "usage: mujoco_pile SEED STEPS BODIES\n");
        return 2;
    }
    print_library();
    uniform_seed(5);
    write_model(atoi(argv[3]));
    mj_defaultVFS(&vfs);
    if (mj_makeEmptyFileVFS(&vfs, "pile.xml", (int)xml_length) != 0)
        return 2;
    memcpy(vfs.filedata[0], xml, xml_length);
    mjModel *m = mj_loadXML("pile.xml", &vfs, error, sizeof error);
    if (!m) {
        fprintf(stderr, "%s\n", error);
        return 2;
    }
    mjData *d = mj_makeData(m);
    uniform_seed(strtoull(argv[1], NULL, 10));
    for (int i = 0; i < m->njnt; i++)
        for (int k = 0; k < 3; k++)
            d->qpos[m->jnt_qposadr[i] + k] += uniform(-1e-3, 1e-3);
    for (long step = 0; step < atol(argv[2]); step++)
        mj_step(m, d);
    for (int i = 0; i < mjNWARNING; i++)
        warnings += d->warning[i].number;
    printf("processor seconds %.6f\n", (double)clock() / CLOCKS_PER_SEC);
    mj_deleteData(d);
    mj_deleteModel(m);
    mj_deleteVFS(&vfs);
    return warnings > 0;
}
