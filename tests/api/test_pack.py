# SPDX-License-Identifier: MIT OR Apache-2.0
"""Islands packed into the unit square by their outlines."""

import json

import numpy as np
import pytest

import authalic


def squares(*sides):
    """Squares that all lie at the origin: points, faces, and the island of each face."""
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    uv = np.concatenate([side * corners for side in sides])
    faces = np.concatenate([4 * k + np.array([[0, 1, 2], [0, 2, 3]]) for k in range(len(sides))])
    return uv, faces, np.repeat(np.arange(len(sides)), 2)


def boxes(uv):
    """The lowest and highest corners of squares, (k, 2) each."""
    corners = uv.reshape(-1, 4, 2)
    return corners.min(axis=1), corners.max(axis=1)


def assert_apart(uv, margin):
    """Boxes of islands keep the margin; for squares that are not turned, or by right angles only."""
    low, high = boxes(uv)
    assert low.min() >= margin - 1e-9 and high.max() <= 1 - margin + 1e-9
    for k in range(len(low)):
        for other in range(k):
            gaps = np.maximum(low[k] - high[other], low[other] - high[k])
            assert gaps.max() >= -1e-9 and np.linalg.norm(gaps.clip(0)) >= margin - 1e-9


@pytest.mark.parametrize("margin", [0.0, 0.01, 0.05])
def test_islands_lie_apart_at_one_scale(margin):
    uv, faces, island_of = squares(1, 2, 1, 0.5, 0.5, 3)
    packing = authalic.pack(uv, faces, island_of, margin=margin, rotate=False)
    assert (packing.angles == 0).all()
    assert_apart(packing.uv, margin)
    low, high = boxes(packing.uv)
    assert high - low == pytest.approx(packing.scale * np.outer([1, 2, 1, 0.5, 0.5, 3], [1, 1]))


def test_a_margin_in_the_units_of_the_islands_and_right_angles():
    uv, faces, island_of = squares(1, 2, 1, 0.5, 0.5, 3)
    packing = authalic.pack(uv, faces, island_of, margin=0.1, margin_unit="islands", rotate="cardinal")
    assert_apart(packing.uv, 0.1 * packing.scale)
    assert packing.angles % (np.pi / 2) == pytest.approx(0)


def test_islands_are_turned_and_never_mirrored():
    uv, faces, island_of = squares(1, 2, 3)
    packing = authalic.pack(uv, faces, island_of)
    for island, angle in enumerate(packing.angles):
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        moved = (
            packing.uv[4 * island : 4 * island + 4] - packing.scale * uv[4 * island : 4 * island + 4] @ turn
        )
        assert np.ptp(moved, axis=0) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("aspect", [2.0, 0.25])
def test_islands_keep_their_shapes_on_the_texture(aspect):
    uv, faces, island_of = squares(1, 1, 1)
    packing = authalic.pack(uv, faces, island_of, aspect=aspect)
    on_texture = packing.uv * [aspect, 1]
    lengths = np.linalg.norm(np.diff(on_texture.reshape(-1, 4, 2), axis=1), axis=2)
    assert lengths == pytest.approx(packing.scale)


def test_the_same_call_gives_the_same_bits_with_any_number_of_threads(run_python):
    code = "import authalic, json; from api.test_pack import squares; "
    code += "print(json.dumps(authalic.pack(*squares(*[1, 2, 3] * 7)).uv.tolist()))"
    one, many = (run_python(code, RAYON_NUM_THREADS=threads) for threads in ("1", "5"))
    assert one == many and len(json.loads(one)) == 84


def test_points_without_a_face_stay_and_nothing_is_packed_from_nothing():
    uv, faces, island_of = squares(1, 1)
    packing = authalic.pack(np.concatenate([uv, [[7, 8]]]), faces, island_of)
    assert packing.uv[-1].tolist() == [7, 8]
    empty = authalic.pack(np.empty((0, 2)), np.empty((0, 3), int), np.empty(0, int))
    assert empty.uv.shape == (0, 2) and len(empty.angles) == 0


UV, FACES, ISLAND_OF = squares(1, 1)


@pytest.mark.parametrize(
    ("arguments", "kind", "words"),
    [
        ((UV, FACES, [0, 0, 1]), "invalid_array", "one number per face"),
        ((UV, FACES, [0, 0, 1, -1]), "invalid_array", "numbers from 0"),
        ((UV, FACES, [0, 0, 1, 9]), "invalid_array", "numbers from 0"),
        ((UV, FACES, [0, 1, 2, 2]), "invalid_array", "one island per point"),
        ((UV, [[0, 1, 8]], [0]), "index_out_of_range", "8"),
        ((UV * np.nan, FACES, ISLAND_OF), "invalid_array", "not finite"),
        ((UV * 0, FACES, ISLAND_OF), "invalid_array", "area"),
        ((UV.T, FACES, ISLAND_OF), "invalid_array", "uv"),
    ],
)
def test_broken_arrays_are_refused(arguments, kind, words):
    with pytest.raises(authalic.MeshError, match=words) as caught:
        authalic.pack(*arguments)
    assert caught.value.kind == kind


@pytest.mark.parametrize(
    "options",
    [
        {"margin": 0.5},
        {"margin": -1},
        {"margin": np.inf, "margin_unit": "islands"},
        {"margin_unit": "pixels"},
        {"rotate": "diagonal"},
        {"rotate": 3.5},
        {"aspect": 0},
        {"aspect": np.nan},
    ],
)
def test_options_out_of_range_are_refused(options):
    with pytest.raises(ValueError, match=next(iter(options))):
        authalic.pack(UV, FACES, ISLAND_OF, **options)


def test_a_false_answer_cancels():
    with pytest.raises(authalic.SolverError) as caught:
        authalic.pack(*squares(1, 2, 3), progress=lambda fraction, message: False)
    assert caught.value.kind == "cancelled"
