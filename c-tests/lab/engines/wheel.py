# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause

"""Depths of python-fcl's wheel on the libccd in the process: its own, or a preloaded one.

Upright cylinders beside and over each other, whose depth is known: the least of what their radii
and their heights have in common. The first line names the library.

usage: python wheel.py PAIRS
"""

import ctypes
import random
import sys

import fcl

library = "libccd"
try:
    implementation = ctypes.CDLL(None).ccdImplementation
    implementation.restype = ctypes.c_char_p
    library = implementation().decode()
except AttributeError:
    pass
print("library", library)

random.seed(45)
request = fcl.CollisionRequest(num_max_contacts=1, enable_contact=True)
missed = deep = 0
largest = 0.0
for _ in range(int(sys.argv[1])):
    radii = [random.uniform(0.1, 0.5) for _ in range(2)]
    heights = [random.uniform(0.1, 0.5) for _ in range(2)]
    depth = [random.uniform(0.1, 0.9) * total for total in (sum(radii), sum(heights) / 2)]
    across, up = sum(radii) - depth[0], sum(heights) / 2 - depth[1]
    a, b = [fcl.Cylinder(radius, height) for radius, height in zip(radii, heights)]
    result = fcl.CollisionResult()
    fcl.collide(
        fcl.CollisionObject(a, fcl.Transform()),
        fcl.CollisionObject(b, fcl.Transform([across, 0, up])),
        request,
        result,
    )
    if not result.contacts:
        missed += 1
        continue
    error = result.contacts[0].penetration_depth - min(depth)
    deep += error > 0.01 * min(depth) + 2e-6
    largest = max(largest, abs(error))
print("wheel pairs %s missed %d deep %d largest %.9f" % (sys.argv[1], missed, deep, largest))
