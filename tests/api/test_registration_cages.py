# SPDX-License-Identifier: MIT OR Apache-2.0
"""Cages on targets that are much finer: what lies between the vertices of the source counts."""

import numpy as np
import pytest

import authalic

from .meshes import grid
from .volumes import voxel_sides


def animal(leg, fineness):
    """A box with a leg of two by two cells of some length; each cell has some voxels along its side."""
    mask = np.zeros((6, 5, 4 + leg), dtype=bool)
    mask[:, :, leg:] = True
    mask[:2, :2, :leg] = True
    surface = voxel_sides(np.kron(mask, np.ones((fineness,) * 3, dtype=bool)))
    return (surface.vertices - 1) / fineness - [0, 0, leg], surface.faces


def vertices_at(vertices, places):
    """The numbers of the vertices at some places."""
    return [int(np.flatnonzero(np.all(np.isclose(vertices, place), axis=1))[0]) for place in places]


ON_THE_BOX = [(3, 2, 4), (6, 0, 0), (6, 5, 0), (0, 5, 0), (4, 3, 0), (0, 0, 4), (6, 5, 4)]


@pytest.mark.parametrize("length", [3, 6, 9])
def test_a_cage_reaches_the_end_of_a_leg_that_is_longer(length):
    (cage, faces), (scan, scan_faces) = animal(3, 1), animal(length, 3)
    registration = authalic.register_spheres(
        (cage, faces),
        (scan, scan_faces),
        source_landmarks=vertices_at(cage, ON_THE_BOX),
        target_landmarks=vertices_at(scan, ON_THE_BOX),
    )
    assert registration.positions[:, 2].min() < 1 - length  # within one cell
    assert len(registration.distortion.folded) == 0
    assert registration.landmark_error.max() < 1e-9
    foot = vertices_at(cage, [(1, 1, -3)])
    assert np.linalg.norm(registration.positions[foot] - [1, 1, -length]) < 1.5


def test_a_coarse_disk_covers_a_fine_one_without_folds():
    coarse, fine = grid(5, 5, aspect=1.0), grid(25, 25, aspect=1.0)
    height = 0.4 * np.sin(3 * fine.vertices[:, 0]) * np.cos(2 * fine.vertices[:, 1])
    dome = np.column_stack([fine.vertices[:, :2], height])
    registration = authalic.register_disks(
        coarse, (dome, fine.faces), source_landmarks=[12], target_landmarks=[312]
    )
    assert len(registration.distortion.folded) == 0
    assert registration.strain.mean < 1.2
