/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* MuJoCo's issue 420: an upright cylinder is dropped on a table, a box, from 0.24 m above it, forty times at other places.
 * Prints how many moved sideways by more than 1 cm within 5 s, and how many fell off.
 *
 * usage: mujoco_table */

#include "harness/identity.h"

#include <math.h>
#include <mujoco/mujoco.h>

enum { DROPS = 40, STEPS = 2500 };

/* Half the height of the table, whose middle is the origin. */
static const double TABLE = 0.3;

static mjModel *load(const char *xml)
{
    static mjVFS vfs;
    char error[1000] = "";
    mj_defaultVFS(&vfs);
    mj_makeEmptyFileVFS(&vfs, "table.xml", (int)strlen(xml));
    memcpy(vfs.filedata[0], xml, strlen(xml));
    mjModel *model = mj_loadXML("table.xml", &vfs, error, sizeof error);
    mj_deleteVFS(&vfs);
    if (!model)
        fprintf(stderr, "%s\n", error);
    return model;
}

int main(void)
{
    int moved = 0, fell = 0;
    print_library();
    mjModel *model = load("<mujoco><worldbody><geom type=\"box\" size=\".3 .6 .3\"/><body><freejoint/>"
                          "<geom type=\"cylinder\" size=\".06 .06\"/></body></worldbody></mujoco>");
    if (!model)
        return 2;
    mjData *data = mj_makeData(model);
    for (int i = 0; i < DROPS; i++) {
        const double x = 0.3 * (i * 37 % DROPS) / DROPS - 0.15, y = 0.2 - 0.4 * (i * 23 % DROPS) / DROPS;
        mj_resetData(model, data);
        data->qpos[0] = x;
        data->qpos[1] = y;
        data->qpos[2] = TABLE + 0.06 + 0.24;
        for (int step = 0; step < STEPS; step++)
            mj_step(model, data);
        moved += hypot(data->qpos[0] - x, data->qpos[1] - y) > 0.01;
        fell += data->qpos[2] < TABLE;
    }
    printf("%d of %d slide away, %d fall off\n", moved, DROPS, fell);
    mj_deleteData(data);
    mj_deleteModel(model);
    return 0;
}
