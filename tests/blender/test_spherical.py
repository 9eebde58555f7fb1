# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps onto the sphere compared with their surfaces, in numpy alone."""

import numpy as np
import pytest
import spheres
from installed import part


def test_map_of_an_inside_out_surface_lies_over_it() -> None:
    spherical = part("surfaces.spherical")
    vertices, faces = spheres.icosphere(3)
    surface = vertices * [1, 2, 3] + [5, 6, 7]
    # Oriented outward for faces that look inward, so it is turned inside out, and rotated at random.
    positions = vertices * [1, 1, -1] @ spheres.rotation(2).T
    over = positions @ spherical.over_surface(surface, faces[:, ::-1], positions)
    assert (np.linalg.det(over[faces]) > 0).all()
    np.testing.assert_allclose(over, vertices, atol=1e-9)
    assert (vertices @ spherical.over_surface(surface, faces, vertices) == vertices).all()
    assert spherical.radius(3 * vertices, faces) == pytest.approx(3, rel=2e-2)
    np.testing.assert_allclose(spherical.centroid(surface, faces), [5, 6, 7], atol=1e-9)
