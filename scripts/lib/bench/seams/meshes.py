# SPDX-License-Identifier: MIT OR Apache-2.0
"""The meshes of the comparison, out of the data folder; any of them may be missing."""

from dataclasses import dataclass

import numpy as np

from bench import meshes


@dataclass(frozen=True)
class Model:
    """A file of the data folder, and how it stands there."""

    folder: str
    file: str
    up: str = "y"
    front: str = "z"
    """The axis that points to the eye in the first picture, with "-" for its negative."""


MODELS = {
    "spot": Model("sphere", "spot_2930", front="-z"),
    "suzanne": Model("seams", "suzanne", up="z", front="-y"),
    "hand_1": Model("seams", "hand_1"),
    "max_planck": Model("seams", "max_planck", front="-z"),
    "david": Model("sphere", "david_10671", up="z", front="y"),
    "triceratops": Model("hard", "triceratops_2832"),
    "bull": Model("sphere", "bull_6200"),
    "torus": Model("seams", "torus"),
    "holes3": Model("seams", "holes3"),
    "fertility": Model("seams", "fertility"),
    "cannon": Model("seams", "cannon", front="x"),
    "horsequad": Model("seams", "horsequad"),
    "bulldog": Model("sphere", "bulldog_49797", up="z", front="-y"),
}


def chosen(names):
    """{name: (vertices, faces)} of the named models, or of all, and the names of those that are missing."""
    meshes.check_names(names, MODELS)
    wanted = [name for name in MODELS if not names or name in names]
    loaded = {name: load(MODELS[name]) for name in wanted}
    there = {name: mesh for name, mesh in loaded.items() if mesh is not None}
    return there, [name for name in wanted if name not in there]


def load(model):
    """The vertices and faces of a model, or None without its file."""
    folder = meshes.data_folder(model.folder)
    path = folder / f"{model.file}.npz" if folder else None
    if path is None or not path.exists():
        return None
    with np.load(path) as arrays:
        return arrays["V"].astype(float), arrays["F"].astype(np.int64)
