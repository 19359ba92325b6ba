/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* The configurations where penetration methods are known to fail: for each the
 * shapes, what the truth must come to, and how fine a query is asked. T numbers are
 * this project's own list; the others are named after their source. */

#ifndef STABILITY_CONFIGURATIONS_H
#define STABILITY_CONFIGURATIONS_H

#include "judge.h"
#include "ports.h"

typedef struct {
    char id[48];
    const char *what;
    shape_t a, b;
    double expected; /* what the truth comes to, or NAN: whatever it is */
    double within;   /* absolute bound of that comparison */
    double tol;      /* of the query, metres; 0: TOL_TIGHT of the size */
    int surface;     /* minima form a curve or surface */
    int touching;    /* hit and miss are both right */
    int not_single;  /* the difference is below float's resolution */
} configuration_t;

typedef void (*configuration_visitor_t)(const configuration_t *c, void *context);

typedef struct {
    configuration_visitor_t visit;
    void *context;
} configuration_run_t;

static inline configuration_t configuration(const char *id, const char *what, shape_t a, shape_t b, double expected,
                                            double within)
{
    configuration_t c;
    memset(&c, 0, sizeof c);
    snprintf(c.id, sizeof c.id, "%s", id);
    c.what = what;
    c.a = a;
    c.b = b;
    c.expected = expected;
    c.within = within;
    return c;
}

static inline shape_t shape_at(shape_t s, double x, double y, double z)
{
    shape_move(&s, x, y, z);
    return s;
}

static inline shape_t shape_about(shape_t s, double x, double y, double z, double angle)
{
    double r[9];
    rotation_about(x, y, z, angle, r);
    shape_turn(&s, r);
    return s;
}

/* pose: rows of [R | p] */
static inline shape_t shape_posed(shape_t s, const double pose[12])
{
    double r[9];
    int i;
    for (i = 0; i < 9; i++)
        r[i] = pose[4 * (i / 3) + i % 3];
    shape_turn(&s, r);
    shape_move(&s, pose[3], pose[7], pose[11]);
    return s;
}

/* rows of R, then p */
static inline shape_t shape_turned(shape_t s, const double rot_pos[12])
{
    shape_turn(&s, rot_pos);
    shape_move(&s, rot_pos[9], rot_pos[10], rot_pos[11]);
    return s;
}

static inline void visit(const configuration_run_t *run, configuration_t c) { run->visit(&c, run->context); }

/* T03 to T19 once more, far from the origin: rounding must not become failure. */
static inline void visit_moved(const configuration_run_t *run, configuration_t c)
{
    static const double offsets[] = {0, 60, 1e4};
    char id[sizeof c.id];
    int i, k;
    memcpy(id, c.id, sizeof id);
    for (i = 0; i < 3; i++) {
        configuration_t moved = c;
        if (i > 0)
            snprintf(moved.id, sizeof moved.id, "%.24s +%g", id, offsets[i]);
        for (k = 0; k < 3; k++) {
            moved.a.pos[k] += (ccd_real_t)offsets[i];
            moved.b.pos[k] += (ccd_real_t)offsets[i];
        }
        if (i > 0) {
            moved.within += pair_noise(&moved.a, &moved.b);
            /* the roundings of the positions themselves */
            moved.within += 4 * real_ulp() * offsets[i];
        }
        visit(run, moved);
    }
}

static inline void configurations_listed(const configuration_run_t *run)
{
    static const double pi = 3.14159265358979323846;
    const int single = sizeof(ccd_real_t) == sizeof(float);
    configuration_t c;
    shape_t a, b;
    double r[9];
    int i, k;

    visit(run, configuration("T01", "cylinder on cylinder, a millimetre deep", shape_cylinder(.5, .5),
                             shape_about(shape_at(shape_cylinder(.5, .5), 0, 0, .999), 1, 0, 0, pi / 2), 1e-3, 1e-9 + single * 1e-6));

    c = configuration("T03", "unit spheres, deep", shape_sphere(1), shape_at(shape_sphere(1), .3, .2, .1),
                      2 - sqrt(.14), 1e-12 + single * 1e-5);
    visit_moved(run, c);

    c = configuration("T04", "cubes, face to face", shape_box(1, 1, 1), shape_at(shape_box(1, 1, 1), 0, 0, 1.9), .1,
                      1e-12 + single * 1e-6);
    visit_moved(run, c);

    c = configuration("T06", "box and sphere", shape_box(1, 1, 1), shape_at(shape_sphere(.7), .9, .4, .2), .8,
                      1e-12 + single * 1e-6);
    visit_moved(run, c);

    for (i = -6; i <= 6; i++) {
        double s = pow(10, i);
        char id[48];
        snprintf(id, sizeof id, "T07 x1e%d", i);
        c = configuration(id, "millimetre cubes", shape_box(5e-4 * s, 5e-4 * s, 5e-4 * s),
                          shape_at(shape_box(5e-4 * s, 5e-4 * s, 5e-4 * s), 8e-4 * s, 1e-4 * s, 5e-5 * s), 2e-4 * s,
                          (1e-15 + single * 1e-9) * s);
        visit(run, c);
    }

    a = shape_sphere(1e-5);
    b = shape_sphere(1e-5);
    {
        double l = sqrt(1 + .36 + .09), d = 2.5e-5;
        shape_move(&b, d / l, .6 * d / l, .3 * d / l);
    }
    visit(run, configuration("T08", "tiny spheres apart", a, b, -5e-6, 1e-15 + single * 1e-10));

    a = shape_about(shape_at(shape_box(.245, .315, .0075), -.25, 0, 0), 0, 0, 1, pi / 2);
    b = shape_at(shape_cylinder(.08, .001), 0, 0, .0085);
    c = configuration("T09", "plate and disc, touching", a, b, 0, 1e-15 + single * 1e-8);
    c.touching = 1;
    visit_moved(run, c);

    c = configuration("T10", "cube in cube on the diagonal", shape_box(.5, .5, .5),
                      shape_at(shape_box(.1, .1, .1), .4, .4, .4), .2, 1e-12 + single * 1e-6);
    visit_moved(run, c);

    {
        static const ccd_real_t triangle[9] = {0, 0, 0, 100, 320, 0, 0, 320, 0};
        a = shape_cylinder(.02, .07);
        rotation_quaternion(.77515626, -.16498479, .36682746, -.48718625, r);
        shape_turn(&a, r);
        shape_move(&a, 28.87991333, 260.53430176, .00036136055);
        c = configuration("T11", "cylinder through a huge triangle", a, shape_polytope(triangle, 3), .0617191506,
                          1e-9 + single * 1e-3);
        visit(run, c);
    }

    c = configuration("T12 coaxial", "capsules on one axis", shape_capsule(.1, .5),
                      shape_at(shape_capsule(.1, .5), 0, 0, .3), .2, 1e-12 + single * 1e-6);
    c.surface = 1;
    visit_moved(run, c);
    c = configuration("T12 crossed", "capsules crossed at their centres", shape_capsule(.1, .5),
                      shape_about(shape_capsule(.1, .5), 1, 0, 0, 1), .2, 1e-12 + single * 1e-6);
    visit_moved(run, c);

    {
        static const double dims[] = {.01, .25, .5, 10, 1000};
        static const double gaps[] = {0, 1e-16, 2.5e-16, 1e-15, -1e-16, -2.5e-16, -1e-15, -1e-6};
        rotation_quaternion(.3, .5, -.2, .7, r);
        for (i = 0; i < 5; i++)
            for (k = 0; k < 8; k++) {
                char id[48];
                double dim = dims[i], gap = gaps[k] * (k == 7 ? dim : fmax(1, dim)), at = dim + gap;
                snprintf(id, sizeof id, "T15 dim %g gap %g", dim, gap);
                a = shape_box(dim / 2, dim / 2, dim / 2);
                shape_turn(&a, r);
                b = shape_at(a, r[1] * at, r[4] * at, r[7] * at);
                c = configuration(id, "kissing cubes", a, b, -gap, (1e-15 + single * 1e-6) * dim);
                c.touching = fabs(gap) < 10 * real_ulp() * dim;
                c.not_single = k == 7;
                visit(run, c);
            }
    }

    c = configuration("T17", "small box on a huge plate", shape_at(shape_box(100, 100, .25), 0, 0, .25),
                      shape_at(shape_box(.1, .1, .1), 0, 0, .599), 1e-3, 1e-12 + single * 1e-7);
    visit_moved(run, c);

    c = configuration("T19 spheres", "concentric spheres", shape_sphere(1), shape_sphere(.1), 1.1, 1e-12 + single * 1e-6);
    c.surface = 1;
    visit_moved(run, c);
    c = configuration("T19 cubes", "coincident cubes", shape_box(1, 1, 1), shape_box(1, 1, 1), 2, 1e-12 + single * 1e-6);
    visit_moved(run, c);
    {
        static const ccd_real_t point[3] = {0, 0, 0};
        c = configuration("T19 point", "a point in a box's centre", shape_box(.5, .3, .4), shape_polytope(point, 1), .3,
                          1e-12 + single * 1e-6);
        visit_moved(run, c);
    }
}

/* Cases of other projects' test suites: configurations and numbers alone. */
static inline void configurations_ported(const configuration_run_t *run)
{
    static const double pi = 3.14159265358979323846;
    const int single = sizeof(ccd_real_t) == sizeof(float);
    configuration_t c;
    shape_t a, b;
    double r[9];
    int i, k;

    /* FCL, test_fcl_signed_distance */
    visit(run, configuration("FCL spheres 1", "apart", shape_sphere(20), shape_at(shape_sphere(10), 40, 0, 0), -10, 1e-9));
    visit(run, configuration("FCL spheres 2", "overlap", shape_sphere(20), shape_at(shape_sphere(10), 25, 0, 0), 5, 1e-9));
    visit(run, configuration("FCL spheres 3", "oblique", shape_sphere(20), shape_at(shape_sphere(10), 20, 0, 20),
                             30 - 20 * sqrt(2), 1e-9 + single * 1e-5));
    visit(run, configuration("FCL capsule 1", "apart", shape_sphere(20), shape_at(shape_capsule(10, 10), 40, 0, 0), -10, 1e-9));
    visit(run, configuration("FCL capsule 2", "overlap", shape_sphere(20), shape_at(shape_capsule(10, 10), 25, 0, 0), 5, 1e-9));
    {
        static const double pose[12] = {
            -0.9954758066, -0.0295866301, 0.0902914702, 0.5419794018,
            -0.0851034786, -0.1449450565, -0.9857729599, -0.0621175025,
            0.0422530022, -0.9889972506, 0.1417713719, 0.6016236576};
        a = shape_at(shape_cylinder(.03, .325), .6, 0, .325);
        visit(run, configuration("FCL #391", "cylinder and sphere", a, shape_posed(shape_sphere(.055), pose), NAN, 0));
    }
    {
        static const double cylinder1[12] = {
            -0.9999999999799902, 6.257283580204504e-10, 6.3260669852976095e-06, 0.5750000975675761,
            6.326066985168371e-06, -6.394330342995855e-10, 0.9999999999799906, -0.42711963046787943,
            6.257318015812846e-10, 1, 6.394291294599675e-10, 1.1867093358746836};
        static const double cylinder2[12] = {
            -0.9731301075927928, -0.12202804064972551, 0.19526123781136842, 0.8747278146113856,
            0.20950801135757172, -0.11745920593569326, 0.9707263919961958, -0.403868788134716,
            -0.09552060967892975, 0.9855518719154995, 0.13986894183635, 1.5871328698116491};
        static const double door[12] = {0, -1, 0, 0.8, 1, 0, 0, -0.4575, 0, 0, 1, 1.0225};
        static const double gripper[12] = {
            -3.062793785257868e-08, -0.9999999999999989, -2.8893865161583314e-08, 0.6349997962735081,
            0.999999999999998, -3.0627939739957804e-08, 6.472992691852751e-08, -0.4850000221563644,
            -6.472992772296385e-08, -2.889386302944875e-08, 0.9999999999999971, 1.0778146458339641};
        b = shape_posed(shape_box(.0125, .175, .9225), door);
        visit(run, configuration("FCL #319", "cylinder and door", shape_posed(shape_cylinder(.05, .03), cylinder1), b, NAN, 0));
        visit(run, configuration("FCL #390", "cylinder and door", shape_posed(shape_cylinder(.05, .03), cylinder2), b, NAN, 0));
        visit(run, configuration("FCL #388", "box and door", shape_posed(shape_box(.015, .06, .05), gripper), b, NAN, 0));
    }
    {
        static const double cylinder[12] = {
            0.6228644976275455, 0.7165153556804436, -0.3140789115322978, 0.2023803334682546,
            -0.20605566270224238, -0.23703718387133413, -0.9493968808305023, 0.02784568359401101,
            -0.7547058244531608, 0.6560633494842361, 4.0172294049188053e-17, 0.31142339392466933};
        b = shape_at(shape_box(.15, .3, .008), .4, 0, .26885);
        visit(run, configuration("FCL drake#21234", "cylinder and plate", shape_posed(shape_cylinder(.041, .085), cylinder), b, NAN, 0));
    }
    {
        static const double box2[12] = {
            0.10758262492983037, -0.6624881850015213, -0.7413065381787736, -0.4267713300299948,
            0.22682184885125473, -0.7096140407752535, 0.6670830248314786, -0.7659685124774679,
            -0.9679761503760854, -0.23991106241273435, 0.07392465377049165, 0.8074673140009105};
        a = shape_at(shape_box(.23, .24, .005), -0.721, -0.772, 0.81);
        visit(run, configuration("FCL #395", "box and tray", a, shape_posed(shape_box(.0247605, .073, .03625), box2), NAN, 0));
    }
    {
        static const double box1[12] = {
            4.896638650109253e-12, -1, 0, -0.43999999999999995,
            1, 4.896638650109253e-12, 0, -0.61499999999858, 0, 0, 1, 0.355};
        static const double box2[12] = {
            0.8351215356523634, -0.5500654694576257, -9.454236060823357e-16, -0.40653441507331,
            0.5500654694576257, 0.8351215356523631, 1.1787444236552388e-15, -0.6916616692373573,
            1.2902271444330666e-16, -1.4878153530113265e-15, 1, 0.4305709385871889};
        visit(run, configuration("FCL #415", "brick and shelf", shape_posed(shape_box(.245, .025, .105), box1),
                                 shape_posed(shape_box(.0175, .06, .015), box2), NAN, 0));
    }
    visit(run, configuration("FCL #398", "thin plate in a box", shape_at(shape_box(.307, 1.5, .185), -.675, 0, .9115),
                             shape_at(shape_box(.247, .276, .005), -.692, 0, .935), NAN, 0));
    visit(run, configuration("FCL #428", "boxes", shape_at(shape_box(.1, .165, .05), -0.07100000000000004, -0.772, 0.7999999999999999),
                             shape_at(shape_box(.226, .135, .3), 0.121, -0.787696056927277, 0.5342204419612515), NAN, 0));
    {
        static const double box1[12] = {
            0.44540578475530235, 0.895328814964934, -8.893740768563868e-09, 1.2652949075960072,
            -0.8953288149649338, 0.4454057847553019, -2.8948680226084145e-08, 1.4551012423210101,
            -2.1957263975186326e-08, 2.085673201665292e-08, 0.9999999999999996, 0.4948000623293294};
        static const double box2[12] = {
            0.4417112291348586, 0.8971572827861191, -1.6227645148654682e-09, 1.1304016226141906,
            -0.8971572827861191, 0.4417112291348586, -5.162105395230608e-09, 1.841080264528428,
            -3.914427141382999e-09, 3.736034921809435e-09, 1, 0.44400006232932493};
        visit(run, configuration("FCL box 6", "stacked, almost aligned", shape_posed(shape_box(.15825, .1138, .0884), box1),
                                 shape_posed(shape_box(.24715, .1773, .0376), box2), NAN, 0));
    }
    {
        static const double box1[12] = {
            0.0007963267107332644, -0.9999996829318354, 0, 0.7500000000000006,
            0.9999996829318354, 0.0007963267107332644, 0, -2.4083553715553103e-15, 0, 0, 1, 0.15};
        static const double box2[12] = {
            6.123233995736766e-17, 0, 1, 0.75, -1, 6.123233995736766e-17, 6.123233995736766e-17, 0,
            -6.123233995736766e-17, -1, 3.749399456654644e-33, 0.15};
        visit(run, configuration("FCL drake#21673 box", "one inside the other", shape_posed(shape_box(.025, .275, .15), box1),
                                 shape_posed(shape_box(.125, .1, .075), box2), NAN, 0));
    }
    {
        static const double frame[9] = {
            0.9409606321741776, 0.292968400372895, 0.16959541586174812, -0.2356983684129988, 0.9266152359584843,
            -0.29296840037289507, -0.2429801799032639, 0.23569836841299885, 0.9409606321741776};
        static const double dims[] = {.01, .25, .5, 10, 1000};
        static const double gaps[] = {-1e-15, -2.5e-16, -1e-16, 0, 1e-16, 2.5e-16, 1e-15};
        for (i = 0; i < 5; i++)
            for (k = 0; k < 7; k++) {
                char id[48];
                double dim = dims[i], at = dim + gaps[k] * fmax(1, dim);
                snprintf(id, sizeof id, "FCL #493 dim %g gap %g", dim, gaps[k]);
                a = shape_box(dim / 2, dim / 2, dim / 2);
                shape_turn(&a, frame);
                shape_move(&a, 0, 0, 5 * dim);
                b = shape_at(a, frame[1] * at, frame[4] * at, 5 * dim + frame[7] * at);
                c = configuration(id, "kissing cubes", a, b, -gaps[k] * fmax(1, dim), 20 * real_ulp() * dim);
                c.touching = fabs(gaps[k]) * fmax(1, dim) < 10 * real_ulp() * dim;
                visit(run, c);
            }
    }
    {
        static const double pose[12] = {
            -0.9999999999999996, -4.4637642593504145e-09, 0, 1.7855056639081962e-10,
            4.4637642593504145e-09, -0.9999999999999996, 0, 0.039999999999999994,
            0, 0, 1.0000000000000009, 0.3300000000000001};
        c = configuration("FCL #408", "sphere and box, touching", shape_posed(shape_sphere(.06), pose),
                          shape_at(shape_box(.05, .05, .05), .05, .15, .35), 0, 1e-9 + single * 1e-6);
        c.touching = single;
        visit(run, c);
    }
#define STABILITY_CONVEX(n) shape_polytope(fcl_convex##n##_a[0], sizeof fcl_convex##n##_a / sizeof fcl_convex##n##_a[0])
#define STABILITY_CONVEX_B(n) shape_polytope(fcl_convex##n##_b[0], sizeof fcl_convex##n##_b / sizeof fcl_convex##n##_b[0])
#define STABILITY_PORT(n) \
    visit(run, configuration("FCL convex " #n, "hulls, reported from the field", \
                             shape_posed(STABILITY_CONVEX(n), fcl_convex##n##_pose), STABILITY_CONVEX_B(n), NAN, 0))
    STABILITY_PORT(1);
    STABILITY_PORT(2);
    STABILITY_PORT(3);
    STABILITY_PORT(4);
    STABILITY_PORT(5);
    STABILITY_PORT(6);
    STABILITY_PORT(7);
    visit(run, configuration("FCL convex 8", "hulls, reported from the field", STABILITY_CONVEX(8), STABILITY_CONVEX_B(8), NAN, 0));
#undef STABILITY_PORT
#undef STABILITY_CONVEX_B
#undef STABILITY_CONVEX

    /* MuJoCo, engine_collision_gjk_test */
    visit(run, configuration("MuJoCo BoxBoxDepth", "", shape_at(shape_box(2.5, 2.5, 2.5), -1, 0, 0),
                             shape_at(shape_box(1, 1, 1), 1.5, 0, 0), 1, 1e-12 + single * 1e-6));
    {
        static const double box[12] = {
            0.999999966039443077825, -0.000000033960556969622, -0.000260616790777324183,
            -0.000000033960556972088, 0.999999966039443077825, -0.000260616790777321798,
            0.000260616790777324183, 0.000260616790777321798, 0.999999932078886044629,
            -0.000171208577507291721, -0.000171208577507290908, 1.067119586248553853025};
        visit(run, configuration("MuJoCo BoxBoxDepth2", "", shape_box(5, 5, .1), shape_turned(shape_box(1, 1, 1), box),
                                 0.033401579411886845, 1e-9 + single * 1e-6));
    }
    {
        static const double box1[12] = {
            0.965925826289068201191, -0.258819045102520739476, 6.339100926609e-18,
            0.258819045102520739476, 0.965925826289068201191, -2.14827792362716e-16,
            4.9478422780336e-17, 2.09148392896446e-16, 1,
            -0.015346499999999199323, -0.023505500000000002087, -4.562296442400120888294};
        static const double box2[12] = {
            0.866025403784438707611, -0.499999999999999944489, 1.8716705841316e-17,
            0.499999999999999944489, 0.866025403784438707611, -2.63161736875730e-16,
            1.15371725704125e-16, 2.37263102359077e-16, 1,
            -0.015346499999999797803, -0.023505499999999998617, -4.659230360891631228526};
        visit(run, configuration("MuJoCo BoxBoxDepth3", "", shape_turned(shape_box(.25, .25, .05), box1),
                                 shape_turned(shape_box(.25, .25, .05), box2), .003066, 1e-6 + single * 1e-6));
    }
    {
        static const double one[12] = {
            1, 0.000000047289880, -0.000000050905665, -0.000000047289880, 1, 0.000000017136196,
            0.000000050905665, -0.000000017136193, 1, 0.000000009724202, -0.000000014139289, 7.369161128997803};
        static const double two[12] = {
            1, -0.000000013726950, 0.000000008946020, 0.000000013726950, 1, -0.000000012039017,
            -0.000000008946020, 0.000000012039017, 1, 0.000000013445962, -0.000000019194527, 8.264492034912109};
        visit(run, configuration("MuJoCo BoxBoxSize05", "", shape_turned(shape_box(.5, .5, .5), one),
                                 shape_turned(shape_box(.5, .5, .5), two), NAN, 0));
    }
    {
        static const double one[12] = {
            1, -0.000000008764291, 0.000000386995168, 0.000000008764733, 1, -0.000001144207772,
            -0.000000386995168, 0.000001144207772, 1, 0.000000962082822, -0.000001747370789, 3.469238519668579};
        static const double two[12] = {
            1, 0.000000003313412, -0.000000196321196, -0.000000003313673, 1, -0.000001329654879,
            0.000000196321196, 0.000001329654879, 1, 0.000002897753802, -0.000004625266229, 4.435211658477783};
        visit(run, configuration("MuJoCo BoxBoxSize05b", "", shape_turned(shape_box(.5, .5, .5), one),
                                 shape_turned(shape_box(.5, .5, .5), two), NAN, 0));
    }
    {
        static const double one[12] = {
            1, -0.000000000570266, 0.000000168314983, 0.000000000570290, 1, -0.000000142656916,
            -0.000000168314983, 0.000000142656916, 1, 0.000000188941314, -0.000000195227585, 0.497281551361084};
        static const double two[12] = {
            1, -0.000000000058608, 0.000001607574859, 0.000000000060496, 1, -0.000001174638669,
            -0.000001607574859, 0.000001174638669, 1, 0.000000953407323, -0.000000923845278, 1.493984460830688};
        visit(run, configuration("MuJoCo BoxBoxSize05c", "", shape_turned(shape_box(.5, .5, .5), one),
                                 shape_turned(shape_box(.5, .5, .5), two), NAN, 0));
    }
    {
        static const double one[12] = {
            0.98799245191271645172, -0.13055117805648397411, -0.08262750674904573156,
            -0.03910798838001148386, 0.30606703783583483203, -0.95120635699897815307,
            0.14947066671547387662, 0.94301609650019369013, 0.29728632920665870598,
            0.44826351361072502844, -0.10441423315171689812, 0.21216466278453649519};
        static const double two[12] = {
            0.53301656081215953442, -0.59335516633486651283, -0.60317741377119038493,
            -0.39469414877746378245, 0.45620167535223110633, -0.79755661888461082398,
            0.74840488695679441289, 0.66318148194106107951, 0.00896923573374096283,
            0.39694137187624300989, 0.00961542646741688108, 0.29832742817753182818};
        visit(run, configuration("MuJoCo EllipsoidEllipsoidSlowConvergence", "almost touching",
                                 shape_turned(shape_ellipsoid(.05, .07, .15), one),
                                 shape_turned(shape_ellipsoid(.05, .07, .15), two), 0, 1e-6));
    }
    a = shape_at(shape_box(1, 1, .3), 0, 0, -.3);
    visit(run, configuration("MuJoCo LongBox", "", a,
                             shape_about(shape_at(shape_box(.6, .03, .03), 0, 0, .02), 0, 0, 1, 40 * pi / 180), .01,
                             1e-12 + single * 1e-7));
    a = shape_at(shape_box(.65, .48, .04), 1.10164554, -0.11389316, 0.74);
    rotation_quaternion(-0.348312918, 0, 0, 0.937378318, r);
    shape_turn(&a, r);
    visit(run, configuration("MuJoCo BoxEdgeFlipped", "", a, shape_at(shape_box(.1, 1.2, 1.4), 1.4, 0, 1.425), 1.907368 - 1.3,
                             1e-6 + single * 1e-6));
    {
        static const double one[12] = {
            0.41747699392674587, 0.7445704580736479, -0.5208913442416622, 0.735898261710082, -0.6133129289446175,
            -0.28688150794614425, -0.5330728917830726, -0.263556605216739, -0.8039721437292835, 0, 0, 0};
        static const double two[12] = {
            -0.11330328891322261, 0.6014637637569688, -0.7908246996703808, 0.9557435215667675, 0.2834865022971088,
            0.07867479900517776, 0.2715081687621951, -0.7469114699230777, -0.6069650487406557,
            -0.0045224108719272319, -0.0099558526994404459, 0.00749543399075938};
        c = configuration("MuJoCo ThinBoxGrazing", "apart by 0.77 um",
                          shape_turned(shape_box(0.015108062742470629, 0.00020768330936692047, 0.00033708479398415232), one),
                          shape_turned(shape_box(0.0022889234034685867, 0.00039019141130537644, 0.00066943745945985227), two),
                          -7.6933e-7, 1e-10 + single * 1e-8);
        visit(run, c);
    }

    /* parry, epa3 and cylinder_cuboid_contact */
    a = shape_at(shape_box(2, 1, 1), 3.5, 0, 0);
    visit(run, configuration("parry cuboids 1", "", a, shape_box(2, 1, 1), .5, 1e-12));
    a = shape_at(shape_box(2, 1, 1), 0, .2, 0);
    visit(run, configuration("parry cuboids 2", "", a, shape_box(2, 1, 1), 1.8, 1e-12 + single * 1e-6));
    {
        static const ccd_real_t upper[] = {(ccd_real_t)-13.174434, 1, (ccd_real_t)8.736801, (ccd_real_t)3.5251038, 1,
                                           (ccd_real_t)12.1, (ccd_real_t)3.2048466, 1, (ccd_real_t)12.218325};
        static const ccd_real_t lower[] = {(ccd_real_t)-1.63, 0, (ccd_real_t)11.19, (ccd_real_t)-2.349647, 0,
                                           (ccd_real_t)11.037681, (ccd_real_t)-2.349647, 1, (ccd_real_t)11.037681};
        c = configuration("parry #253", "a triangle's vertex on another's plane", shape_polytope(upper, 3),
                          shape_polytope(lower, 3), 0, 1e-6);
        visit(run, c);
    }
    a = shape_about(shape_at(shape_cylinder(.5, .925), 10.97, .925, 61.02), 1, 0, 0, -pi / 2);
    visit(run, configuration("parry #157", "cylinder and cuboid, nearly tangent", a, shape_at(shape_box(.05, .75, .5), 11.5, .75, 60.5), NAN, 0));

    /* Jolt, EPATests */
    {
        static const struct {
            double box[6], sphere[4];
            int hit;
        } cases[] = {
            {{-2, -3, -4, 2, 3, 4}, {4, 0, 0, 1.99}, 0},
            {{-2, -3, -4, 2, 3, 4}, {4, 0, 0, 2.01}, 1},
            {{-2, -3, -4, 2, 3, 4}, {3, 0, 0, 2}, 1},
            {{1, 1, -2, 2, 2, 2}, {4, 4, 0, 2.8284271247461903 - .01}, 0},
            {{1, 1, -2, 2, 2, 2}, {4, 4, 0, 2.8284271247461903 + .01}, 1},
            {{1, 1, 1, 2, 2, 2}, {4, 4, 4, 3.4641016151377544 - .01}, 0},
            {{1, 1, 1, 2, 2, 2}, {4, 4, 4, 3.4641016151377544 + .01}, 1},
        };
        static const double expected[] = {-.01, .01, 1, -.01, .01, -.01, .01};
        for (i = 0; i < 7; i++) {
            char id[48];
            const double *p = cases[i].box, *s = cases[i].sphere;
            a = shape_at(shape_box((p[3] - p[0]) / 2, (p[4] - p[1]) / 2, (p[5] - p[2]) / 2), (p[0] + p[3]) / 2,
                         (p[1] + p[4]) / 2, (p[2] + p[5]) / 2);
            b = shape_at(shape_sphere(s[3]), s[0], s[1], s[2]);
            snprintf(id, sizeof id, "Jolt SphereBox %d", i + 1);
            visit(run, configuration(id, "", a, b, expected[i], 1e-12 + single * 1e-5));
        }
    }
    c = configuration("Jolt SphereSphereOverlapping", "", shape_at(shape_sphere(2), 1, 2, 3), shape_at(shape_sphere(2), 1, 2, 3), 4, 1e-12);
    c.surface = 1;
    visit(run, c);
    c = configuration("Jolt SphereSphereNearOverlapping", "", shape_at(shape_sphere(2), 1, 2, 3),
                      shape_at(shape_sphere(1.8), 1.1, 2, 3), 3.7, 1e-12 + single * 1e-5);
    c.surface = 1; /* nearly: a proof costs as much */
    visit(run, c);
}

#endif
