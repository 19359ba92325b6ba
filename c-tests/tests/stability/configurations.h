/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* Configurations where penetration methods are known to fail: the shapes, and the depth that the
 * truth must have. T and U numbers are this project's own; the others are cases of other projects'
 * tests and reports, configurations and numbers alone. A new one is a row of configuration_rows. */

#ifndef STABILITY_CONFIGURATIONS_H
#define STABILITY_CONFIGURATIONS_H

#include "harness/tolerances.h"
#include "harness/truth.h"

#include <stdio.h>

enum {
    EVERYWHERE = 1, /* once more far from the origin: rounding must not become failure */
    SURFACE = 2,    /* minima form a curve or surface */
    TOUCHING = 4,   /* hit and miss are both right */
    TOUCHING_IN_SINGLE = 8,
    MISSED = 16,       /* an exact touch: every call returns a miss */
    NOT_IN_SINGLE = 32 /* the difference is below float's resolution */
};

typedef struct {
    char id[48];
    const char *what;
    shape_t a, b;
    double expected; /* signed depth, or NAN: unknown */
    double within;   /* absolute bound of that comparison */
    int flags;
} configuration_t;

typedef void configuration_visit_t(const configuration_t *c);

/* --- points of hulls ------------------------------------------------------------ */

static const ccd_real_t huge_triangle[][3] = {{0, 0, 0}, {100, 320, 0}, {0, 320, 0}};
static const ccd_real_t origin_point[][3] = {{0, 0, 0}};
static const ccd_real_t flat_rod[][3] = {{-1, 0, 0}, {1, 0, 0}};
static const ccd_real_t flat_square[][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
static const ccd_real_t corner_points[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/* parry #253 */
static const ccd_real_t parry_upper[][3] = {
    {(ccd_real_t)-13.174434, 1, (ccd_real_t)8.736801},
    {(ccd_real_t)3.5251038, 1, (ccd_real_t)12.1},
    {(ccd_real_t)3.2048466, 1, (ccd_real_t)12.218325},
};
static const ccd_real_t parry_lower[][3] = {
    {(ccd_real_t)-1.63, 0, (ccd_real_t)11.19},
    {(ccd_real_t)-2.349647, 0, (ccd_real_t)11.037681},
    {(ccd_real_t)-2.349647, 1, (ccd_real_t)11.037681},
};

/* --- a shape as data ----------------------------------------------------------- */

typedef struct {
    shape_type_t type;
    double p[3];
    const ccd_real_t *verts;
    int nverts;
    double pos[3];
    int by_rotation; /* else by axis and angle; no axis: not turned */
    double by[12];
} body_row_t;

#define SPHERE(r) .type = SHAPE_SPHERE, .p = {r, 0, 0}
#define CAPSULE(r, half) .type = SHAPE_CAPSULE, .p = {r, half, 0}
#define BOX(x, y, z) .type = SHAPE_BOX, .p = {x, y, z}
#define CYLINDER(r, half) .type = SHAPE_CYLINDER, .p = {r, half, 0}
#define CONE(r, half) .type = SHAPE_CONE, .p = {r, half, 0}
#define ELLIPSOID(x, y, z) .type = SHAPE_ELLIPSOID, .p = {x, y, z}
#define HULL(points) .type = SHAPE_POLYTOPE, .verts = points[0], .nverts = sizeof points / sizeof points[0]
#define AT(x, y, z) .pos = {x, y, z}
#define ABOUT(x, y, z, angle) .by = {x, y, z, angle}
#define TURNED(...) .by_rotation = 1, .by = {__VA_ARGS__} /* rows of R, then p */
#define PI 3.14159265358979323846

typedef struct {
    const char *id, *what;
    body_row_t a, b;
    double expected;
    double within, single; /* bound of that comparison, and what single precision adds */
    int flags;
} configuration_row_t;

static const configuration_row_t configuration_rows[] = {
    {"T01", "cylinder on cylinder, a millimetre deep", {CYLINDER(.5, .5)},
     {CYLINDER(.5, .5), AT(0, 0, .999), ABOUT(1, 0, 0, PI / 2)}, 1e-3, 1e-9, 1e-6, 0},
    {"T03", "unit spheres, deep", {SPHERE(1)},
     {SPHERE(1), AT(.3, .2, .1)}, 2 - 0.37416573867739417, 1e-12, 1e-5, EVERYWHERE},
    {"T04", "cubes, face to face", {BOX(1, 1, 1)}, {BOX(1, 1, 1), AT(0, 0, 1.9)}, .1, 1e-12, 1e-6, EVERYWHERE},
    {"T06", "box and sphere", {BOX(1, 1, 1)}, {SPHERE(.7), AT(.9, .4, .2)}, .8, 1e-12, 1e-6, EVERYWHERE},
    {"T08", "tiny spheres apart", {SPHERE(1e-5)},
     {SPHERE(1e-5), AT(2.0761369963434992e-05, 1.2456821978060995e-05, 6.2284109890304977e-06)}, -5e-6, 1e-15, 1e-10, 0},
    {"T09", "plate and disc, touching", {BOX(.245, .315, .0075), AT(-.25, 0, 0), ABOUT(0, 0, 1, PI / 2)},
     {CYLINDER(.08, .001), AT(0, 0, .0085)}, 0, 1e-15, 1e-8, EVERYWHERE | TOUCHING},
    {"T10", "cube in cube on the diagonal", {BOX(.5, .5, .5)},
     {BOX(.1, .1, .1), AT(.4, .4, .4)}, .2, 1e-12, 1e-6, EVERYWHERE},
    {"T11", "cylinder through a huge triangle", {CYLINDER(.02, .07), AT(28.87991333, 260.53430176, .00036136055),
     ABOUT(-.16498479, .36682746, -.48718625, 1.367667908687469)},
     {HULL(huge_triangle)}, .0617191506, 1e-9, 1e-3, 0},
    {"T12 coaxial", "capsules on one axis", {CAPSULE(.1, .5)},
     {CAPSULE(.1, .5), AT(0, 0, .3)}, .2, 1e-12, 1e-6, EVERYWHERE | SURFACE},
    {"T12 crossed", "capsules crossed at their centres", {CAPSULE(.1, .5)},
     {CAPSULE(.1, .5), ABOUT(1, 0, 0, 1)}, .2, 1e-12, 1e-6, EVERYWHERE},
    {"T17", "small box on a huge plate", {BOX(100, 100, .25), AT(0, 0, .25)},
     {BOX(.1, .1, .1), AT(0, 0, .599)}, 1e-3, 1e-12, 1e-7, EVERYWHERE},
    {"T19 spheres", "concentric spheres", {SPHERE(1)}, {SPHERE(.1)}, 1.1, 1e-12, 1e-6, EVERYWHERE | SURFACE},
    {"T19 cubes", "coincident cubes", {BOX(1, 1, 1)}, {BOX(1, 1, 1)}, 2, 1e-12, 1e-6, EVERYWHERE},
    {"T19 point", "a point in a box's centre", {BOX(.5, .3, .4)}, {HULL(origin_point)}, .3, 1e-12, 1e-6, EVERYWHERE},

    /* Failures found by this project's users and tests. */
    {"U01", "a box's corner on a cylinder's rim", {CYLINDER(0.67214972553380203, 0.31071183401268843),
     TURNED(0.99855106295427354, 0.048532335203084642, 0.023246227922522782, -0.053812323491297345,
            0.90131270477728864, 0.42981349681869718, -9.2267862303379786e-05, -0.43044165765732256,
            0.90261839713128933, 0.40876520371579894, -0.094725323140851803, 0.78201587064166223)},
     {BOX(0.39141664262605902, 0.84827187544719429, 0.73600797777455128),
     TURNED(-0.0778730966162966, 0.22561614781411801, -0.97109893145287063, 0.33813112391531325,
            0.92229990044137855, 0.18716366283440325, 0.93787159241719009, -0.31378375912615553,
            -0.14811019089010324, 1.9728005265422626, 0.474421426773312, -0.12951931706735448)}, 4.00694e-4, 1e-9, 1e-6, 0},
    {"U02", "a sphere around a cylinder", {CYLINDER(0.050343935414477993, 0.030598774417823531),
     TURNED(0.68610705470843958, 0.55929025432912338, -0.46524350709254908, -0.32839520560016827, -0.33254761662587562,
            -0.88406372599223482, -0.64916384558764018, 0.75934609638090222, -0.044495027732908143,
            0.19921819663588103, 0.11038189574981694, -0.42768753090485601)},
     {SPHERE(0.26420555933554174), AT(0.20260051529887335, 0.10806714408406355, -0.41443775293687929)}, 0.294687570, 1e-9, 1e-6, 0},
    {"U12", "cones 11 um apart, the base of one over the apex of the other", {CONE(0.93754327898898726, 0.75800192786697729),
     TURNED(0.90918648647866329, 0.37739526750882713, -0.17593392187558488, 0.079939006405530477, 0.25646224045637289,
            0.96324289484791636, 0.40864371775359543, -0.88983140610007605, 0.20300340060817076,
            -0.49697751924640166, 2.0216922724918875, 0.70127657434067459)},
     {CONE(0.76434195005137706, 0.52757161162981558),
     TURNED(0.90918648647866329, 0.37739526750882713, -0.17593392187558488, 0.079939006405530477, 0.25646224045637289,
            0.96324289484791636, 0.40864371775359543, -0.88983140610007605, 0.20300340060817076,
            -0.48037416746485506, 3.1694007929941179, 1.6026589947444148)}, NAN, 0, 0, 0},
    {"U04 point", "a point in a sphere's centre", {SPHERE(1)}, {HULL(origin_point)}, 1, 1e-12, 1e-6, SURFACE},
    {"U04 capsules", "parallel", {CAPSULE(.3, .5)}, {CAPSULE(.2, .4), AT(1e-7, 0, .1)}, NAN, 0, 0, SURFACE},
    {"U04 cylinders", "coaxial", {CYLINDER(.3, 1)}, {CYLINDER(.2, 1), AT(0, 0, .1)}, NAN, 0, 0, SURFACE},
    {"U04 cylinders", "nearly coaxial", {CYLINDER(.3, 1)}, {CYLINDER(.2, 1), AT(1e-4, 1e-5, .1)}, NAN, 0, 0, SURFACE},
    {"U04 sphere", "on a cylinder's axis", {CYLINDER(.3, 1)}, {SPHERE(.2), AT(0, 0, .1)}, .5, 1e-12, 1e-6, SURFACE},
    {"U04 cone", "coaxial with a capsule", {CONE(.4, 1)}, {CAPSULE(.2, .3), AT(0, 0, -.3)}, NAN, 0, 0, SURFACE},
    {"U04 spheroid", "around a sphere", {ELLIPSOID(.3, .3, 1)}, {SPHERE(.2)}, .5, 1e-12, 1e-6, SURFACE},

    /* Touches without rounding. */
    {"U06 ellipsoid", "and ball", {ELLIPSOID(20, 40, 50)}, {ELLIPSOID(10, 10, 10), AT(30, 0, 0)}, 0, 1e-12, 1e-5, MISSED},
    {"U06 ellipsoid", "and ball", {ELLIPSOID(20, 40, 50)}, {ELLIPSOID(10, 10, 10), AT(-30, 0, 0)}, 0, 1e-12, 1e-5, MISSED},
    {"U06 spheres", "", {SPHERE(.5)}, {SPHERE(.5), AT(1, 0, 0)}, 0, 1e-12, 1e-6, MISSED},
    {"U06 boxes", "", {BOX(.5, .5, .5)}, {BOX(.5, .25, .25), AT(1, 0, 0)}, 0, 1e-12, 1e-6, MISSED},
    {"U06 capsule", "and sphere", {CAPSULE(.5, 1)}, {SPHERE(.5), AT(1, 0, .25)}, 0, 1e-12, 1e-6, MISSED},
    {"U06 cylinder", "and box", {CYLINDER(.5, 1)}, {BOX(.5, 1, 1), AT(1, 0, 0)}, 0, 1e-12, 1e-6, MISSED},
    {"U06 ellipsoid", "and box", {ELLIPSOID(.5, 1, 2)}, {BOX(.5, 1, 1), AT(1, 0, 0)}, 0, 1e-12, 1e-6, MISSED},
    {"U06 corner", "and box", {HULL(corner_points)}, {BOX(.5, .5, .5), AT(-.5, .25, .25)}, 0, 1e-12, 1e-6, MISSED},
    {"U06 cylinders", "", {CYLINDER(.5, .5)}, {CYLINDER(.5, .25), AT(1, 0, 0)}, 0, 1e-12, 1e-6, MISSED},
    {"U06 cone", "and sphere", {CONE(.5, .5)}, {SPHERE(.5), AT(0, 0, 1)}, 0, 1e-12, 1e-6, MISSED},
    {"U14", "a box in itself, 1e-7 rad apart: flat tetrahedra that contain the origin",
     {BOX(0.18756308380208808, 0.59280757868861189, 0.30622484117563226),
      TURNED(-0.21533183913101639, -0.43349862358241731, 0.8750492228489799, 0.77820351758602013, -0.6175027013431249,
             -0.11441022266689505, 0.58994193296730391, 0.65633021961973781, 0.47031814608912104)},
     {BOX(0.18756308380208808, 0.59280757868861189, 0.30622484117563226),
      TURNED(-0.21533172853850877, -0.43349842010511419, 0.87504935086598845, 0.77820346130210827, -0.61750277447809243,
             -0.11441021077367391, 0.58994204757928215, 0.65633028520572489, 0.47031791080048779, -1.4414113453320746e-12,
             -1.9831600985635757e-12, -1.5848350580888996e-12)}, 0.37512625249131, 1e-12, 1e-6, 0},
    {"U14", "the same without centers",
     {BOX(0.18436446473211912, 0.16540824959199474, 0.12569579148032387),
      TURNED(0.93656694188372291, 0.3326646869091725, 0.11034749410019916, -0.19271784709042761, 0.22581413908369952,
             0.95491769593128706, 0.29274937196072998, -0.91561027777372383, 0.27560047993987302)},
     {BOX(0.18436446473211912, 0.16540824959199474, 0.12569579148032387),
      TURNED(0.9365669419178142, 0.33266468675384575, 0.11034749427911469, -0.19271784719249677, 0.22581413898148173,
             0.95491769593485987, 0.29274937178447208, -0.91561027780547422, 0.27560047985585812, -7.8648191803199117e-14,
             -5.7106166740379526e-14, 4.7740823825746833e-14)}, 0.25139158300726, 1e-12, 1e-6, 0},

    /* Objects without area. */
    {"U13 points", "apart", {HULL(origin_point)}, {HULL(origin_point), AT(0, 0, .5)}, -.5, 1e-12, 1e-6, 0},
    {"U13 points", "on each other", {HULL(origin_point)}, {HULL(origin_point)}, 0, 1e-12, 1e-6, MISSED},
    {"U13 rods", "crossed, apart", {HULL(flat_rod)}, {HULL(flat_rod), AT(0, 0, .5), ABOUT(0, 0, 1, 1)}, -.5, 1e-12, 1e-6, 0},
    {"U13 rods", "through each other", {HULL(flat_rod)}, {HULL(flat_rod), ABOUT(0, 0, 1, 1)}, 0, 1e-12, 1e-6, MISSED},
    {"U13 rod", "in a square", {HULL(flat_square)}, {HULL(flat_rod)}, 0, 1e-12, 1e-6, MISSED},
    {"U13 point", "on a rod", {HULL(origin_point)}, {HULL(flat_rod)}, 0, 1e-12, 1e-6, MISSED},
    {"U13 squares", "one over the other", {HULL(flat_square)}, {HULL(flat_square), AT(.3, .2, .5)}, -.5, 1e-12, 1e-6, 0},
    {"U13 squares", "on each other", {HULL(flat_square)}, {HULL(flat_square)}, 0, 1e-12, 1e-6, MISSED},
    {"U13 squares", "side by side", {HULL(flat_square)}, {HULL(flat_square), AT(2.5, 0, 0)}, -.5, 1e-12, 1e-6, 0},

    /* FCL, test_fcl_signed_distance */
    {"FCL #408", "sphere and box, touching", {SPHERE(.06),
     TURNED(-0.9999999999999996, -4.4637642593504145e-09, 0, 4.4637642593504145e-09, -0.9999999999999996, 0,
            0, 0, 1.0000000000000009, 1.7855056639081962e-10, 0.039999999999999994, 0.3300000000000001)},
     {BOX(.05, .05, .05), AT(.05, .15, .35)}, 0, 1e-9, 1e-6, TOUCHING_IN_SINGLE},

    /* The same test: poses for which FCL's users reported that its distance throws. */
    {"FCL #319", "cylinder and box", {CYLINDER(0.05, 0.03),
     TURNED(-0.9999999999799902, 6.257283580204504e-10, 6.3260669852976095e-06, 6.326066985168371e-06,
            -6.394330342995855e-10, 0.9999999999799906, 6.257318015812846e-10, 1, 6.394291294599675e-10,
            0.5750000975675761, -0.42711963046787943, 1.1867093358746836)},
     {BOX(0.0125, 0.175, 0.9225),
     TURNED(0, -1, 0, 1, 0, 0, 0, 0, 1, 0.8, -0.4575, 1.0225)}, NAN, 0, 0, 0},
    {"FCL #390", "cylinder and box", {CYLINDER(0.05, 0.03),
     TURNED(-0.9731301075927928, -0.12202804064972551, 0.19526123781136842, 0.20950801135757172, -0.11745920593569326,
            0.9707263919961958, -0.09552060967892975, 0.9855518719154995, 0.13986894183635, 0.8747278146113856,
            -0.403868788134716, 1.5871328698116491)},
     {BOX(0.0125, 0.175, 0.9225),
     TURNED(0, -1, 0, 1, 0, 0, 0, 0, 1, 0.8, -0.4575, 1.0225)}, NAN, 0, 0, 0},
    {"FCL #388", "boxes", {BOX(0.015, 0.06, 0.05),
     TURNED(-3.062793785257868e-08, -0.9999999999999989, -2.8893865161583314e-08, 0.999999999999998,
            -3.0627939739957804e-08, 6.472992691852751e-08, -6.472992772296385e-08, -2.889386302944875e-08,
            0.9999999999999971, 0.6349997962735081, -0.4850000221563644, 1.0778146458339641)},
     {BOX(0.0125, 0.175, 0.9225),
     TURNED(0, -1, 0, 1, 0, 0, 0, 0, 1, 0.8, -0.4575, 1.0225)}, NAN, 0, 0, 0},
    {"FCL #395", "boxes", {BOX(0.23, 0.24, 0.005),
     TURNED(1, 0, 0, 0, 1, 0, 0, 0, 1, -0.721, -0.772, 0.81)},
     {BOX(0.0247605, 0.073, 0.03625),
     TURNED(0.10758262492983037, -0.6624881850015213, -0.7413065381787736, 0.22682184885125473, -0.7096140407752535,
            0.6670830248314786, -0.9679761503760854, -0.23991106241273435, 0.07392465377049165, -0.4267713300299948,
            -0.7659685124774679, 0.8074673140009105)}, NAN, 0, 0, 0},
    {"FCL #415", "boxes", {BOX(0.245, 0.025, 0.105),
     TURNED(4.896638650109253e-12, -1, 0, 1, 4.896638650109253e-12, 0, 0, 0, 1, -0.43999999999999995,
            -0.61499999999858, 0.355)},
     {BOX(0.0175, 0.06, 0.015),
     TURNED(0.8351215356523634, -0.5500654694576257, -9.454236060823357e-16, 0.5500654694576257, 0.8351215356523631,
            1.1787444236552388e-15, 1.2902271444330666e-16, -1.4878153530113265e-15, 1, -0.40653441507331,
            -0.6916616692373573, 0.4305709385871889)}, NAN, 0, 0, 0},
    {"FCL #398", "boxes", {BOX(0.307, 1.5, 0.185), AT(-0.675, 0, 0.9115)},
     {BOX(0.247, 0.276, 0.005), AT(-0.692, 0, 0.935)}, .1665, 1e-12, 1e-6, 0},
    {"FCL #428", "boxes", {BOX(0.1, 0.165, 0.05), AT(-0.07100000000000004, -0.772, 0.7999999999999999)},
     {BOX(0.226, 0.135, 0.3), AT(0.121, -0.787696056927277, 0.5342204419612515)}, .35 - (.8 - .5342204419612515),
            1e-12, 1e-6, 0},
    {"FCL distance 6", "boxes", {BOX(0.15825, 0.1138, 0.0884),
     TURNED(0.44540578475530235, 0.895328814964934, -8.893740768563868e-09, -0.8953288149649338, 0.4454057847553019,
            -2.8948680226084145e-08, -2.1957263975186326e-08, 2.085673201665292e-08, 0.9999999999999996,
            1.2652949075960072, 1.4551012423210101, 0.4948000623293294)},
     {BOX(0.24715, 0.1773, 0.0376),
     TURNED(0.4417112291348586, 0.8971572827861191, -1.6227645148654682e-09, -0.8971572827861191, 0.4417112291348586,
            -5.162105395230608e-09, -3.914427141382999e-09, 3.736034921809435e-09, 1, 1.1304016226141906,
            1.841080264528428, 0.44400006232932493)}, NAN, 0, 0, 0},
    {"drake #21673", "boxes", {BOX(0.025, 0.275, 0.15),
     TURNED(0.0007963267107332644, -0.9999996829318354, 0, 0.9999996829318354, 0.0007963267107332644, 0, 0, 0, 1,
            0.7500000000000006, -2.4083553715553103e-15, 0.15)},
     {BOX(0.125, 0.1, 0.075),
     TURNED(6.123233995736766e-17, 0, 1, -1, 6.123233995736766e-17, 6.123233995736766e-17, -6.123233995736766e-17, -1,
            3.749399456654644e-33, 0.75, 0, 0.15)}, NAN, 0, 0, 0},

    /* MuJoCo, engine_collision_gjk_test */
    {"MuJoCo BoxBoxDepth", "", {BOX(2.5, 2.5, 2.5), AT(-1, 0, 0)}, {BOX(1, 1, 1), AT(1.5, 0, 0)}, 1, 1e-12, 1e-6, 0},
    {"MuJoCo BoxBoxDepth2", "", {BOX(5, 5, .1)},
     {BOX(1, 1, 1),
     TURNED(0.999999966039443077825, -0.000000033960556969622, -0.000260616790777324183,
            -0.000000033960556972088, 0.999999966039443077825, -0.000260616790777321798,
            0.000260616790777324183, 0.000260616790777321798, 0.999999932078886044629,
            -0.000171208577507291721, -0.000171208577507290908, 1.067119586248553853025)}, 0.033401579411886845, 1e-9, 1e-6, 0},
    {"MuJoCo BoxBoxDepth3", "", {BOX(.25, .25, .05),
     TURNED(0.965925826289068201191, -0.258819045102520739476, 6.339100926609e-18,
            0.258819045102520739476, 0.965925826289068201191, -2.14827792362716e-16,
            4.9478422780336e-17, 2.09148392896446e-16, 1,
            -0.015346499999999199323, -0.023505500000000002087, -4.562296442400120888294)},
     {BOX(.25, .25, .05),
     TURNED(0.866025403784438707611, -0.499999999999999944489, 1.8716705841316e-17,
            0.499999999999999944489, 0.866025403784438707611, -2.63161736875730e-16,
            1.15371725704125e-16, 2.37263102359077e-16, 1,
            -0.015346499999999797803, -0.023505499999999998617, -4.659230360891631228526)}, .003066, 1e-6, 1e-6, 0},
    {"MuJoCo EllipsoidEllipsoidSlowConvergence", "almost touching", {ELLIPSOID(.05, .07, .15),
     TURNED(0.98799245191271645172, -0.13055117805648397411, -0.08262750674904573156,
            -0.03910798838001148386, 0.30606703783583483203, -0.95120635699897815307,
            0.14947066671547387662, 0.94301609650019369013, 0.29728632920665870598,
            0.44826351361072502844, -0.10441423315171689812, 0.21216466278453649519)},
     {ELLIPSOID(.05, .07, .15),
     TURNED(0.53301656081215953442, -0.59335516633486651283, -0.60317741377119038493,
            -0.39469414877746378245, 0.45620167535223110633, -0.79755661888461082398,
            0.74840488695679441289, 0.66318148194106107951, 0.00896923573374096283,
            0.39694137187624300989, 0.00961542646741688108, 0.29832742817753182818)}, 0, 1e-6, 0, 0},
    {"MuJoCo LongBox", "", {BOX(1, 1, .3), AT(0, 0, -.3)},
     {BOX(.6, .03, .03), AT(0, 0, .02), ABOUT(0, 0, 1, 40 * PI / 180)}, .01, 1e-12, 1e-7, 0},
    {"MuJoCo BoxEdgeFlipped", "", {BOX(.65, .48, .04), AT(1.10164554, -0.11389316, 0.74),
     ABOUT(0, 0, 1, 3.8531340790532629)},
     {BOX(.1, 1.2, 1.4), AT(1.4, 0, 1.425)}, 1.907368 - 1.3, 1e-6, 1e-6, 0},
    {"MuJoCo ThinBoxGrazing", "apart by 0.77 um", {BOX(0.015108062742470629, 0.00020768330936692047, 0.00033708479398415232),
     TURNED(0.41747699392674587, 0.7445704580736479, -0.5208913442416622, 0.735898261710082, -0.6133129289446175,
            -0.28688150794614425, -0.5330728917830726, -0.263556605216739, -0.8039721437292835, 0, 0, 0)},
     {BOX(0.0022889234034685867, 0.00039019141130537644, 0.00066943745945985227),
     TURNED(-0.11330328891322261, 0.6014637637569688, -0.7908246996703808, 0.9557435215667675, 0.2834865022971088,
            0.07867479900517776, 0.2715081687621951, -0.7469114699230777, -0.6069650487406557,
            -0.0045224108719272319, -0.0099558526994404459, 0.00749543399075938)}, -7.6933e-7, 1e-10, 1e-8, 0},

    /* parry, epa3 */
    {"parry cuboids 1", "", {BOX(2, 1, 1), AT(3.5, 0, 0)}, {BOX(2, 1, 1)}, .5, 1e-12, 0, 0},
    {"parry cuboids 2", "", {BOX(2, 1, 1), AT(0, .2, 0)}, {BOX(2, 1, 1)}, 1.8, 1e-12, 1e-6, 0},
    {"parry #253", "a triangle's vertex on another's plane", {HULL(parry_upper)}, {HULL(parry_lower)}, 0, 1e-6, 0, 0},

    /* Jolt, EPATests */
    {"Jolt SphereSphereOverlapping", "", {SPHERE(2), AT(1, 2, 3)}, {SPHERE(2), AT(1, 2, 3)}, 4, 1e-12, 0, SURFACE},
    /* nearly concentric: a proof costs as much */
    {"Jolt SphereSphereNearOverlapping", "", {SPHERE(2), AT(1, 2, 3)},
     {SPHERE(1.8), AT(1.1, 2, 3)}, 3.7, 1e-12, 1e-5, SURFACE},
};

/* --- visiting them --------------------------------------------------------------- */

static inline shape_t body_shape(const body_row_t *row)
{
    shape_t s = row->type == SHAPE_POLYTOPE ? shape_polytope(row->verts, row->nverts)
                                            : shape_make(row->type, row->p[0], row->p[1], row->p[2]);
    const double *by = row->by;
    double rot[9];
    rotation_about(by[0], by[1], by[2], by[3], rot);
    shape_turn(&s, row->by_rotation ? by : rot);
    shape_move(&s, row->pos[0] + by[9], row->pos[1] + by[10], row->pos[2] + by[11]);
    return s;
}

static inline int in_single(void) { return sizeof(ccd_real_t) == sizeof(float); }

static inline configuration_t configuration(const char *id, const char *what, shape_t a, shape_t b, double expected,
                                            double within, int flags)
{
    configuration_t c;
    snprintf(c.id, sizeof c.id, "%s", id);
    c.what = what;
    c.a = a;
    c.b = b;
    c.expected = expected;
    c.within = within;
    c.flags = flags;
    return c;
}

static inline void visit_row(configuration_visit_t *visit, const configuration_row_t *row)
{
    static const double offsets[] = {0, 60, 1e4};
    const int flags = row->flags | (in_single() && row->flags & TOUCHING_IN_SINGLE ? TOUCHING : 0);
    for (int i = 0; i < (flags & EVERYWHERE ? 3 : 1); i++) {
        configuration_t c = configuration(row->id, row->what, body_shape(&row->a), body_shape(&row->b), row->expected,
                                          row->within + in_single() * row->single, flags);
        for (int k = 0; k < 3; k++) {
            c.a.pos[k] += (ccd_real_t)offsets[i];
            c.b.pos[k] += (ccd_real_t)offsets[i];
        }
        if (i > 0) {
            snprintf(c.id, sizeof c.id, "%.24s +%g", row->id, offsets[i]);
            /* the positions themselves round too */
            c.within += pair_noise(&c.a, &c.b) + 4 * real_eps() * offsets[i];
        }
        visit(&c);
    }
}

/* Millimetre cubes at every scale. */
static inline void visit_scaled(configuration_visit_t *visit)
{
    for (int i = -6; i <= 6; i++) {
        double s = pow(10, i);
        shape_t a = shape_box(5e-4 * s, 5e-4 * s, 5e-4 * s), b = a;
        char id[48];
        snprintf(id, sizeof id, "T07 x1e%d", i);
        shape_move(&b, 8e-4 * s, 1e-4 * s, 5e-5 * s);
        configuration_t c = configuration(id, "millimetre cubes", a, b, 2e-4 * s, (1e-15 + in_single() * 1e-9) * s, 0);
        visit(&c);
    }
}

/* A cube and the same cube beside it along its own y: gaps in ulps of a metre, or of a larger cube, and
 * the last one as a part of the cube. */
static inline void visit_kissing(configuration_visit_t *visit)
{
    static const double gaps[] = {0, 1e-16, 2.5e-16, 1e-15, -1e-16, -2.5e-16, -1e-15, -1e-6};
    static const double dims[] = {.01, .25, .5, 10, 1000};
    double rot[9];
    rotation_quaternion(.3, .5, -.2, .7, rot);
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < 8; k++) {
            const int is_last = k == 7;
            double dim = dims[i], gap = gaps[k] * (is_last ? dim : fmax(1, dim)), at = dim + gap;
            shape_t a = shape_box(dim / 2, dim / 2, dim / 2), b;
            char id[48];
            snprintf(id, sizeof id, "T15 dim %g gap %g", dim, gap);
            shape_turn(&a, rot);
            b = a;
            shape_move(&b, rot[1] * at, rot[4] * at, rot[7] * at);
            configuration_t c = configuration(id, "kissing cubes", a, b, -gap, (1e-15 + in_single() * 1e-6) * dim,
                                              (is_last ? NOT_IN_SINGLE : 0) | (fabs(gap) < 10 * real_eps() * dim ? TOUCHING : 0));
            visit(&c);
        }
}

static inline void for_each_configuration(configuration_visit_t *visit)
{
    for (size_t i = 0; i < sizeof configuration_rows / sizeof configuration_rows[0]; i++)
        visit_row(visit, &configuration_rows[i]);
    visit_scaled(visit);
    visit_kissing(visit);
}

#endif
