/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* MuJoCo's issue 420: an upright cylinder falls on a table by 0.24 m and is to stay there. From DROPS places, 5 s each; counts
 * those that slide by more than 1 cm, and those that leave the table:
 *
 *   slide drops N slid N fell N drift N   the mean drift, metres
 *
 * usage: mujoco_slide DROPS */

#include "harness/identity.h"

#include <math.h>
#include <mujoco/mujoco.h>
#include <stdlib.h>

static const char MODEL[] =
    "<mujoco><worldbody><geom type=\"box\" size=\"0.3 0.6 0.3\"/><body><freejoint/>"
    "<geom type=\"cylinder\" size=\"0.06 0.06\"/></body></worldbody></mujoco>";

static mjModel *load(void)
{
    static mjVFS vfs;
    char error[1000] = "";
    mj_defaultVFS(&vfs);
    if (mj_makeEmptyFileVFS(&vfs, "slide.xml", (int)sizeof MODEL - 1) != 0)
        exit(2);
    memcpy(vfs.filedata[0], MODEL, sizeof MODEL - 1);
    mjModel *model = mj_loadXML("slide.xml", &vfs, error, sizeof error);
    if (!model) {
        fprintf(stderr, "%s\n", error);
        exit(2);
    }
    mj_deleteVFS(&vfs);
    return model;
}

int main(int argc, char **argv)
{
    const int drops = argc > 1 ? atoi(argv[1]) : 40;
    int slid = 0, fell = 0;
    double drifts = 0;
    print_library();
    mjModel *model = load();
    mjData *data = mj_makeData(model);
    for (int k = 0; k < drops; k++) {
        const double x = 0.3 * (k * 37 % 40) / 40 - 0.15, y = 0.2 - 0.4 * (k * 23 % 40) / 40;
        mj_resetData(model, data);
        data->qpos[0] = x;
        data->qpos[1] = y;
        data->qpos[2] = 0.6;
        while (data->time < 5)
            mj_step(model, data);
        const double drift = hypot(data->qpos[0] - x, data->qpos[1] - y);
        drifts += drift;
        slid += drift > 0.01;
        fell += data->qpos[2] < 0.3;
    }
    printf("slide drops %d slid %d fell %d drift %.6f\n", drops, slid, fell, drifts / drops);
    mj_deleteData(data);
    mj_deleteModel(model);
    return 0;
}
