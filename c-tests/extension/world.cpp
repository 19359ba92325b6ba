/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A small world: boxes, capsules and hulls fall on a table. One warm state for each pair. */

#include <ccd/ccd.hpp>

#include <array>
#include <cstdio>
#include <map>
#include <vector>

using ccd::Real, ccd::Vec3;

struct Body { /* points, swept along x, y, z by half, with a ball all around */
    Vec3 pos, half;
    Real radius = 0, speed = 0;
    std::vector<Vec3> points{{0, 0, 0}};

    Vec3 support(const Vec3 &d) const
    {
        const auto along = [&](const Vec3 &p) { return p.x * d.x + p.y * d.y + p.z * d.z; };
        Vec3 best = points[0];
        for (const Vec3 &p : points)
            if (along(p) > along(best))
                best = p;
        const auto at = [&](int i) { return pos[i] + best[i] + (d[i] < 0 ? -half[i] : half[i]) + radius * d[i]; };
        return {at(0), at(1), at(2)};
    }
    Vec3 centre() const { return pos; }
};

int main()
{
    const Real h = CCD_REAL(0.5), q = CCD_REAL(0.25);
    std::vector<Body> body{{{0, 0, -1}, {3, 3, 1}}, /* the table */
                           {{-1, 0, 2}, {h, h, q}},
                           {{1, 0, 2}, {0, h, 0}, q},
                           {{1, 2, 3}, {}, 0, 0, {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}}};
    std::map<std::array<std::size_t, 2>, ccd::Warm> warm;
    for (int frame = 0; frame < 60; frame++) {
        int touching = 0, contacts = 0;
        for (std::size_t i = 1; i < body.size(); i++) /* they fall */
            body[i].pos.z += (body[i].speed -= CCD_REAL(9.81) / 60) / 60;
        for (std::size_t i = 0; i < body.size(); i++)
            for (std::size_t j = i + 1; j < body.size(); j++) {
                const auto hit = ccd::penetration_local(body[i], body[j], {CCD_REAL(1e-5)}, &warm[{i, j}]);
                if (!hit)
                    continue; /* apart: one support while the last separating direction still separates */
                std::array<ccd::ContactPoint, 4> contact;
                touching++;
                contacts += ccd::contacts(body[i], body[j], hit.dir, CCD_REAL(1e-3), contact);
                const Vec3 p = body[j].pos, d = hit.dir; /* what a solver would do with the contacts */
                body[j].pos = {p.x + hit.depth * d.x, p.y + hit.depth * d.y, p.z + hit.depth * d.z};
                body[j].speed = 0;
            }
        if (frame % 10 == 9)
            std::printf("frame %d: %d pairs touch in %d points\n", frame, touching, contacts);
    }
}
