# SPDX-License-Identifier: MIT OR Apache-2.0
"""Maps a few surfaces with whatever `authalic` is installed, and checks the maps by formulas of its own."""

import sys
import sysconfig

import numpy as np

import authalic


def octahedron(level: int) -> tuple[np.ndarray, np.ndarray]:
    """An octahedron whose faces are split in four, again and again, with its vertices on the unit sphere."""
    corners = np.concatenate([np.eye(3), -np.eye(3)])
    x, y, z, left, front, low = range(6)
    upper = [[x, y, z], [y, left, z], [left, front, z], [front, x, z]]
    faces = np.array(upper + [[b, a, low] for a, b, _ in upper])
    points = corners[faces]
    for _ in range(level):
        a, b, c = points[:, 0], points[:, 1], points[:, 2]
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        split = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        points = np.concatenate([np.stack(corners, axis=1) for corners in split])
    points = points / np.linalg.norm(points, axis=2, keepdims=True)
    vertices, index = np.unique(points.reshape(-1, 3).round(12), axis=0, return_inverse=True)
    return vertices, index.reshape(-1, 3)


def areas(points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """The shares of the faces in the whole area."""
    a, b, c = points[faces[:, 0]], points[faces[:, 1]], points[faces[:, 2]]
    sizes = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return sizes / sizes.sum()


def main() -> None:
    if sysconfig.get_config_var("Py_GIL_DISABLED"):
        assert not sys._is_gil_enabled(), "a module has switched the global lock on"

    vertices, faces = octahedron(3)
    egg = vertices * [1, 1, 1.5]
    sphere = authalic.sphere_map(egg, faces)
    assert np.abs(areas(sphere.positions, faces) / areas(egg, faces) - 1).max() < 0.02
    assert np.allclose(np.linalg.norm(sphere.positions, axis=1), 1)

    upper = faces[egg[faces][:, :, 2].min(axis=1) > -1e-9]
    [dome] = authalic.cut(egg, upper)
    disk = authalic.disk_map(dome)
    flat = np.column_stack([disk.uv, np.zeros(len(disk.uv))])
    assert np.abs(areas(flat, dome.faces) / areas(dome.vertices, dome.faces) - 1).max() < 0.02

    unwrapped = authalic.unwrap(authalic.Surface(egg, faces))
    assert unwrapped.uv.min() >= 0 and unwrapped.uv.max() <= 1

    registration = authalic.register_spheres(
        (egg, faces), (vertices, faces), source_landmarks=[0, 5], target_landmarks=[0, 5]
    )
    assert np.allclose(registration.positions[[0, 5]], vertices[[0, 5]])
    print(f"authalic {authalic.__version__} maps on Python {sys.version.split()[0]}, numpy {np.__version__}")


main()
