# SPDX-License-Identifier: MIT OR Apache-2.0
"""STL, GLB and glTF by trimesh, without its merging."""

from pathlib import Path
from typing import Any

import numpy as np

from .errors import require
from .mesh import MeshData, Reals


def read_mesh(path: Path, name: str) -> MeshData:
    """All triangles of a file. Objects of a scene become one mesh, each where the scene places it."""
    trimesh = require("trimesh", name.upper(), "io")
    found = trimesh.load_mesh(str(path), file_type=name, process=False)
    return MeshData(np.asarray(found.vertices), np.asarray(found.faces), _uv(found))


def write_mesh(path: Path, mesh: MeshData, name: str) -> None:
    trimesh = require("trimesh", name.upper(), "io")
    visual = None if mesh.uv is None else trimesh.visual.TextureVisuals(uv=mesh.uv)
    made = trimesh.Trimesh(mesh.vertices, mesh.faces, visual=visual, process=False)
    if name == "gltf":
        files = trimesh.exchange.gltf.export_gltf(made.scene(), merge_buffers=True, embed_buffers=True)
        path.write_bytes(files["model.gltf"])
    else:
        path.write_bytes(made.export(file_type=name))


def _uv(found: Any) -> Reals | None:
    uv = getattr(found.visual, "uv", None)
    return None if uv is None or len(uv) != len(found.vertices) else np.asarray(uv, np.float64)
