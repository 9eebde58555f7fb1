# SPDX-License-Identifier: GPL-3.0-or-later
"""Thousands of islands come out right."""

import bpy
import meshes
import numpy as np
import pytest
from meshes import Array, MeshObject


def squares(count: int) -> MeshObject:
    """Separate squares, each turned another way in space."""
    rng = np.random.default_rng(7)
    turns, _ = np.linalg.qr(rng.normal(size=(count, 3, 3)))
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]) @ turns
    column = np.arange(count)[:, None]
    corners += np.stack([column % 100, column // 100, 0 * column], axis=-1) * 3.0
    return meshes.add(corners.reshape(-1, 3), np.arange(4 * count).reshape(-1, 4))


def hills(count: int) -> MeshObject:
    """Separate pieces of hilly ground of 8 to 50 triangles."""
    rng = np.random.default_rng(7)
    pieces = []
    for number in range(count):
        columns, rows = rng.integers(2, 6, 2)
        x, y = (axis.ravel() for axis in np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0)))
        points = np.stack(
            [x + number % 100 * 8, y + number // 100 * 8, 0.5 * rng.normal(size=x.size)], axis=1
        )
        first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
        pieces.append(
            (points, np.stack([first, first + 1, first + columns + 2, first + columns + 1], axis=1))
        )
    return meshes.add(*meshes.together(*pieces))


def boxes(uv: Array) -> Array:
    """The lowest and the highest coordinates (k, 2, 2) of squares (k, 4, 2)."""
    return np.stack([uv.min(axis=1), uv.max(axis=1)], axis=1)


def test_ten_thousand_squares_are_squares_of_one_size_apart_from_each_other() -> None:
    obj = squares(10_000)
    assert bpy.ops.authalic.unwrap() == {"FINISHED"}
    uv = meshes.uv(obj).reshape(-1, 4, 2)
    sides = np.linalg.norm(uv - np.roll(uv, 1, axis=1), axis=2)
    np.testing.assert_allclose(sides, sides.mean(), rtol=1e-3)
    diagonals = np.linalg.norm(uv[:, 0] - uv[:, 2], axis=1)
    np.testing.assert_allclose(diagonals, np.sqrt(2) * sides.mean(), rtol=1e-3)
    assert (uv >= 0).all() and (uv <= 1).all()
    low, high = boxes(uv).transpose(1, 0, 2)
    order = np.argsort(low[:, 0])
    low, high = low[order], high[order]
    for number in range(len(low)):
        beside = np.searchsorted(low[:, 0], high[number, 0])
        rest = slice(number + 1, beside)
        assert ((low[rest, 1] >= high[number, 1]) | (high[rest, 1] <= low[number, 1])).all()


@pytest.mark.parametrize("count", [3000])
def test_thousands_of_hills_are_even(count: int) -> None:
    obj = hills(count)
    assert bpy.ops.authalic.unwrap() == {"FINISHED"}
    ratios = meshes.area_ratios(obj)
    assert (ratios > 0).all()
    assert ratios.std() < 0.01
