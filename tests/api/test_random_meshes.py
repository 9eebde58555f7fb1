# SPDX-License-Identifier: MIT OR Apache-2.0
"""Random sound meshes are mapped without a fold; random spoiled ones are mapped or refused."""

import numpy as np
import pytest

import authalic

from . import oracle, random_checks, random_meshes
from .random_meshes import CLOSED, OPEN, SPOILERS


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", [*CLOSED, *OPEN])
def test_the_generators_keep_their_word(name, seed):
    """One disk or sphere, no face without area, of the requested size."""
    case = random_meshes.sound_case(seed, 200, [name])
    (patch,) = authalic.cut(*case.mesh)
    assert patch.is_disk if case.kind == "disk" else patch.is_closed and patch.genus == 0
    assert 3 <= len(case.mesh.vertices) <= 260
    assert len(np.unique(case.mesh.faces)) == len(case.mesh.vertices)
    assert oracle.face_areas(*case.mesh).min() >= 0


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("name", [*CLOSED, *OPEN])
def test_sound_meshes_are_mapped_without_a_fold(name, seed):
    case = random_meshes.sound_case(100 + seed, 200, [name])
    outcome = random_checks.assert_sound_case(case)
    assert outcome.status in ("converged", "max_iterations", "stalled")


@pytest.mark.parametrize("seed", range(30))
def test_any_options_leave_a_sound_map(seed):
    case = random_meshes.sound_case(200 + seed, 150)
    random_checks.assert_sound_case(case, **random_checks.random_options(seed, case))


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("spoil", SPOILERS, ids=lambda spoil: spoil.__name__)
def test_spoiled_meshes_are_mapped_or_refused(spoil, seed):
    random_checks.assert_hostile_case(random_meshes.hostile_case(300 + seed, 120, [spoil]))


def test_a_case_follows_from_its_seed():
    for make in (random_meshes.sound_case, random_meshes.hostile_case):
        first, second = make(7), make(7)
        assert first.name == second.name
        assert np.array_equal(first.mesh.vertices, second.mesh.vertices, equal_nan=True)
        assert np.array_equal(first.mesh.faces, second.mesh.faces)
