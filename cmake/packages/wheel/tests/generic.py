# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause

"""Stands for the module of this name of trimesh's tests, which its package does not contain."""

import logging
import unittest  # noqa: F401 (the tests use it)

import numpy as np
import trimesh

log = logging.getLogger("trimesh")


def random(shape):
    return np.random.default_rng(0).random(shape)


def get_mesh(name):
    """Returns the cube of trimesh's models, with its corners in their order, on which libccd's contact position depends."""
    assert name == "unit_cube.STL", name
    cube = trimesh.creation.box()
    order = np.array([1, 3, 0, 2, 5, 4, 7, 6])
    return trimesh.Trimesh(cube.vertices[order], np.argsort(order)[cube.faces], process=False)
