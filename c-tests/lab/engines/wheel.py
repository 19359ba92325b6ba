# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause

"""Prints the libccd in the process of python-fcl's wheel, its own or a preloaded one, and its depth of two upright
cylinders, which have 0.1 m of their heights in common and 0.5 m of their radii. Then, if asked, the number of 3,000
signed distances of equal boxes that nearly touch which are off by more than 1e-6 of the size; without
libwarmccd-fcl.so one of them ends the process, or does not end.

usage: python wheel.py [signed]
"""

import ctypes
import random
import sys

import fcl

try:
    implementation = ctypes.CDLL(None).ccdImplementation
    implementation.restype = ctypes.c_char_p
    print("library", implementation().decode())
except AttributeError:
    print("library libccd")
first = fcl.CollisionObject(fcl.Cylinder(0.5, 0.1), fcl.Transform())
second = fcl.CollisionObject(fcl.Cylinder(0.3, 0.2), fcl.Transform([0.3, 0, 0.05]))
result = fcl.CollisionResult()
fcl.collide(first, second, fcl.CollisionRequest(num_max_contacts=1, enable_contact=True), result)
print("wheel depth %.6f" % result.contacts[0].penetration_depth)


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
