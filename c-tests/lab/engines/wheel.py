# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause

"""Prints the libccd in the process of python-fcl's wheel, its own or a preloaded one, and its depth of two upright
cylinders, which have 0.1 m of their heights in common and 0.5 m of their radii.

usage: python wheel.py
"""

import ctypes

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
