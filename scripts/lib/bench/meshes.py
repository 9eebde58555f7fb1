# SPDX-License-Identifier: MIT OR Apache-2.0
"""Meshes for the benches: real ones from a data folder, or surfaces built on the spot."""

import numpy as np

from shell import DATA

FSAVERAGE5 = ("fsaverage5_left_10242", "fsaverage5_right_10242")


def data_folder(kind):
    """The folder of real meshes of a kind ("disk", "sphere", "brain"), or None."""
    return DATA / kind if (DATA / kind).is_dir() else None


def disks(names=()):
    """{name: (vertices, faces)}, smallest first; only the given names if there are any."""
    known = stored("disk") or built_disks()
    check_names(names, known)
    return only(names, known)


def spheres():
    """Closed meshes of genus 0: {name: (vertices, faces)}, smallest first."""
    return only((), stored("sphere") or built_spheres())


def brains():
    """The hemispheres of fsaverage5 with FreeSurfer's own sphere: {name: arrays}; empty without them."""
    folder = data_folder("brain")
    paths = [folder / f"{name}.npz" for name in FSAVERAGE5] if folder else []
    return {path.stem: _arrays(path) for path in paths if path.exists()}


def stored(kind):
    """The real meshes of one kind; empty without their folder."""
    folder = data_folder(kind)
    loaded = {path.stem: _arrays(path) for path in sorted(folder.glob("*.npz"))} if folder else {}
    return {name: (arrays["V"], arrays["F"]) for name, arrays in loaded.items()}


def only(names, known):
    """The known meshes with these names, or all for no names, smallest first."""
    chosen = {name: mesh for name, mesh in known.items() if not names or name in names}
    return dict(sorted(chosen.items(), key=lambda item: len(item[1][0])))


def check_names(names, known):
    """Ends the program if a name is not known."""
    unknown = set(names) - set(known)
    if unknown:
        raise SystemExit(f"no mesh {', '.join(sorted(unknown))}; there are: {', '.join(sorted(known))}")


def built_disks():
    """Graphs over a square grid: gentle bumps, and one tall peak that needs much stretching."""
    bumps = _graph(140, lambda x, y: 0.15 * np.sin(5 * x) * np.cos(7 * y))
    peak = _graph(140, lambda x, y: 2.0 * np.exp(-12 * (x**2 + y**2)))
    return {"bumps (built)": bumps, "peak (built)": peak}


def built_spheres(level=4):
    """An ellipsoid with half-axes 3, 2, 1, and a sphere with bumps, each of 20 · 4^level faces."""
    vertices, faces = icosphere(level)
    radius = 1 + 0.15 * np.prod(np.sin(5 * vertices + [0, 1, 2]), axis=1)
    return {
        "ellipsoid (built)": (vertices * [3, 2, 1], faces),
        "bumpy sphere (built)": (vertices * radius[:, None], faces),
    }


def icosphere(level):
    """An icosahedron subdivided `level` times, on the unit sphere, counter-clockwise from outside."""
    vertices, faces = _icosahedron()
    for _ in range(level):
        sides = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, edge_of = np.unique(sides, axis=0, return_inverse=True)
        c, a, b = (len(vertices) + edge_of.reshape(-1, 3)).T  # on the sides 01, 12, 20
        i, j, k = faces.T
        corners = [[i, c, b], [j, a, c], [k, b, a], [a, b, c]]
        faces = np.concatenate([np.stack(corner, axis=1) for corner in corners])
        vertices = np.concatenate([vertices, vertices[edges].sum(axis=1)])
        vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
    return vertices, faces


def _icosahedron():
    # two poles, and two rings of five vertices; the lower ring is turned by half a step
    turn = 2 * np.pi * np.arange(5) / 5
    height, radius = 1 / np.sqrt(5), 2 / np.sqrt(5)
    upper = np.stack([radius * np.cos(turn), radius * np.sin(turn), np.full(5, height)], axis=1)
    turn = turn + np.pi / 5
    lower = np.stack([radius * np.cos(turn), radius * np.sin(turn), np.full(5, -height)], axis=1)
    vertices = np.concatenate([[[0, 0, 1]], upper, lower, [[0, 0, -1]]])
    faces = []
    for k in range(5):
        u, v, low, next_low = 1 + k, 1 + (k + 1) % 5, 6 + k, 6 + (k + 1) % 5
        faces += [[0, u, v], [u, low, v], [v, low, next_low], [11, next_low, low]]
    return vertices, np.array(faces)


def _arrays(path):
    with np.load(path) as arrays:
        return dict(arrays)


def _graph(side, height):
    x, y = np.meshgrid(np.linspace(-1, 1, side), np.linspace(-1, 1, side), indexing="ij")
    vertices = np.stack([x, y, height(x, y)], axis=-1).reshape(-1, 3)
    first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    lower = np.stack([first, first + side, first + side + 1], axis=1)
    upper = np.stack([first, first + side + 1, first + 1], axis=1)
    return vertices, np.concatenate([lower, upper])
