/* SPDX-FileCopyrightText: 2026 The warmccd developers
 * SPDX-License-Identifier: BSD-3-Clause */

/* A small world: boxes, capsules and hulls fall on a table. One warm state for each pair. */

#include <ccd/ccd.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

using ccd::Real, ccd::Vec3;
struct Body { /* points, swept along x, y, z by half: the core; with a ball around it */
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
        const auto at = [&](int i) { return pos[i] + best[i] + (d[i] < 0 ? -half[i] : half[i]); };
        return {at(0), at(1), at(2)};
    }
};

int main()
{
    const Real h = CCD_REAL(0.5), q = CCD_REAL(0.25);
    std::vector<Body> body{{{0, 0, -1}, {3, 3, 1}}, /* the table */
                           {{-1, 0, 2}, {h, h, q}},
                           {{1, 0, 2}, {0, h, 0}, q},
                           {{1, 2, 3}, {}, 0, 0, {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}}};
    std::vector<ccd::Warm> warm(body.size() * body.size());
    std::vector<ccd::ManifoldCache> cache(body.size() * body.size());
    for (int frame = 0; frame < 60; frame++) {
        int contacts = 0;
        Real closest = std::numeric_limits<Real>::infinity();
        for (std::size_t i = 1; i < body.size(); i++) /* gravity */
            body[i].pos.z += (body[i].speed -= CCD_REAL(9.81) / 60) / 60;
        for (std::size_t i = 0; i < body.size(); i++)
            for (std::size_t j = i + 1; j < body.size(); j++) {
                Body &a = body[i], &b = body[j];
                const auto d = ccd::signed_distance(a, b, {CCD_REAL(1e-5)}, {a.radius, b.radius}, &warm[i * body.size() + j]);
                if (d.status != ccd::Status::hit) {
                    closest = std::min(closest, d.distance); /* between d.point1 and d.point2 */
                    continue;
                }
                std::array<ccd::Contact, 4> contact; /* of the cores */
                contacts += ccd::contacts(a, b, d.normal, CCD_REAL(1e-3), contact, &cache[i * body.size() + j]);
                const Vec3 p = b.pos, n = d.normal; /* in place of a contact solver */
                b.pos = {p.x - d.distance * n.x, p.y - d.distance * n.y, p.z - d.distance * n.z};
                b.speed = 0;
            }
        if (frame % 10 == 9)
            std::printf("frame %d: %d contacts, other pairs are %.2f m apart\n", frame, contacts, double(closest));
    }
}
