# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause

"""Prints the library of the process, the depth of two upright cylinders with 0.1 m of their heights in common, and how many
random cylinders and boxes overlap, which `compare` judges.

usage: python programs.py            these
       python programs.py distance   the signed distance of two cones in one place, -2/sqrt(5) m; FCL's own does not end
"""

import ctypes
import sys

import fcl
import numpy as np


def pair(first, first_pose, second, second_pose):
    return fcl.CollisionObject(first, fcl.Transform(*first_pose)), fcl.CollisionObject(second, fcl.Transform(*second_pose))


def depth(objects):
    """Returns the depth of an overlap, None of a miss."""
    result = fcl.CollisionResult()
    fcl.collide(*objects, fcl.CollisionRequest(num_max_contacts=1, enable_contact=True), result)
    return result.contacts[0].penetration_depth if result.contacts else None


def turned(random):
    turn = random.normal(size=4)
    return turn / np.linalg.norm(turn)


if sys.argv[1:] == ["distance"]:
    request = fcl.DistanceRequest(enable_nearest_points=True, enable_signed_distance=True)
    cone = fcl.Cone(0.5, 1)
    print("distance %.6f" % fcl.distance(*pair(cone, [], cone, []), request, fcl.DistanceResult()))
    sys.exit()
try:
    implementation = ctypes.CDLL(None).ccdImplementation
    implementation.restype = ctypes.c_char_p
    print("library", implementation().decode())
except AttributeError:
    print("library libccd")
print("depth %.6f" % depth(pair(fcl.Cylinder(0.5, 0.1), [], fcl.Cylinder(0.3, 0.2), [[0.3, 0, 0.05]])))

random = np.random.default_rng(1)
near = lambda: random.uniform(-0.3, 0.3, 3)  # noqa: E731
overlaps = [depth(pair(fcl.Cylinder(0.3, 0.4), [near()], fcl.Box(0.5, 0.4, 0.3), [turned(random), near()])) for _ in range(2000)]
print("overlaps", sum(d is not None for d in overlaps))
