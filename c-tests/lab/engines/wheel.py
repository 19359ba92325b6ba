# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause

"""Prints the libccd in the process of python-fcl's wheel, its own or a preloaded one; its depth of two upright
cylinders, which have 0.1 m of their heights in common and 0.5 m of their radii; how far the contact position of a cube that
stands on another is from the cube's middle; and how many random cylinders and boxes overlap. Then, if asked, the number of 3,000
signed distances of equal boxes that nearly touch which are off by more than 1e-6 of the size; without
libwarmccd-fcl.so one of them ends the process, or does not end.

usage: python wheel.py [signed]
"""

import ctypes
import random
import sys

import fcl
import numpy as np

try:
    implementation = ctypes.CDLL(None).ccdImplementation
    implementation.restype = ctypes.c_char_p
    print("library", implementation().decode())
except AttributeError:
    print("library libccd")


def contact(first, second, *pose):
    """Returns the contact of two shapes, the second one placed; None if they are apart."""
    result = fcl.CollisionResult()
    pair = fcl.CollisionObject(first, fcl.Transform()), fcl.CollisionObject(second, fcl.Transform(*pose))
    fcl.collide(*pair, fcl.CollisionRequest(num_max_contacts=1, enable_contact=True), result)
    return result.contacts[0] if result.contacts else None


print("wheel depth %.6f" % contact(fcl.Cylinder(0.5, 0.1), fcl.Cylinder(0.3, 0.2), [0.3, 0, 0.05]).penetration_depth)
# Convex: FCL asks libccd about no pair of its boxes.
faces = np.array([4, 0, 1, 3, 2, 4, 4, 6, 7, 5, 4, 0, 4, 5, 1, 4, 2, 3, 7, 6, 4, 0, 2, 6, 4, 4, 1, 5, 7, 3])
cube = fcl.Convex(np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (-0.1, 0.1)]), 6, faces)
print("wheel aside %.6f" % abs(contact(fcl.Box(1, 1, 1), cube, [0.3, 0, 0.599]).pos[0] - 0.3))

random.seed(1)
overlaps = 0
for _ in range(2000):
    turn = np.array([random.gauss(0, 1) for _ in range(4)])
    at = [random.uniform(-0.6, 0.6) for _ in range(3)]
    overlaps += contact(fcl.Cylinder(0.3, 0.4), fcl.Box(0.5, 0.4, 0.3), turn / np.linalg.norm(turn), at) is not None
print("wheel overlaps", overlaps)


def signed_distance(size, gap):
    """Returns FCL's signed distance of two boxes turned at random, side on side, and this far apart."""
    turn = [random.gauss(0, 1) for _ in range(4)]
    length = sum(x * x for x in turn) ** 0.5
    turn = [x / length for x in turn]
    at = [random.uniform(-size, size) for _ in range(3)]
    pose = fcl.Transform(turn, at)
    # The first axis of the boxes.
    axis = [row[0] for row in pose.getRotation()]
    there = fcl.Transform(turn, [x + (size + gap) * a for x, a in zip(at, axis)])
    pair = [fcl.CollisionObject(fcl.Box(size, size, size), placed) for placed in (pose, there)]
    request = fcl.DistanceRequest(enable_nearest_points=True, enable_signed_distance=True)
    return fcl.distance(*pair, request, fcl.DistanceResult())


if "signed" in sys.argv:
    random.seed(5)
    sizes = [0.01, 0.25, 0.5, 10, 1000]
    gaps = [0, 1e-15, -1e-15, 1e-9, -1e-9, -1e-6, 1e-3, -1e-3]
    wrong = 0
    for k in range(3000):
        side, part = sizes[k % len(sizes)], gaps[k % len(gaps)]
        error = abs(signed_distance(side, part * side) - part * side)
        wrong += not error <= 1e-6 * side + 1e-3 * abs(part * side)
    print("signed queries 3000 wrong %d" % wrong)
