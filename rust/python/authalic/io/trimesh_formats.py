# SPDX-License-Identifier: MIT OR Apache-2.0
"""STL, GLB and glTF by trimesh, without its merging."""

import json
import struct
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np

from .errors import require
from .mesh import MeshData, Reals
from .words import quoted

_ONLY_LOOKS = ("KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_")
"""Extensions of glTF whose names begin so say nothing of vertices, triangles or UVs."""
_TEXT = "model.gltf"
"""What trimesh looks for where the text of a glTF file cannot be read."""


class _Neighbors:
    """The files that a glTF file names, of which only those beside it are read.

    Parameters
    ----------
    folder : Path
        The folder of the glTF file.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder.resolve()

    def __getitem__(self, name: str) -> bytes:
        """The content of a file of this name in the folder; a link to a file elsewhere is none."""
        if name == _TEXT:
            raise ValueError("it is damaged: it is no JSON")
        name = unquote(name)
        if Path(name).name != name or set(name) & set("/\\:\0"):
            raise ValueError(f"it names the file {quoted(name)}; only files in its own folder are read")
        file = (self._folder / name).resolve()
        if not file.is_file() or file.parent != self._folder:
            raise ValueError(f"it names the file {quoted(name)}, which is not in its folder")
        return file.read_bytes()


def read_mesh(path: Path, name: str) -> MeshData:
    """All triangles of a file. Objects of a scene become one mesh, each where the scene places it."""
    trimesh = require("trimesh", name.upper(), "io")
    if name in ("glb", "gltf"):
        _check_extensions(path.read_bytes())
    with open(path, "rb") as file:
        found = trimesh.load_mesh(file, file_type=name, process=False, resolver=_Neighbors(path.parent))
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


def _check_extensions(content: bytes) -> None:
    """Refuses files that cannot be read without an extension of glTF, e.g. with compressed vertices."""
    if content[:4] == b"glTF":  # three numbers, then the length of the JSON, its kind and itself
        [length] = struct.unpack_from("<I", content, 12) if len(content) >= 20 else [0]
        content = content[20 : 20 + length]
    try:
        required = json.loads(content)["extensionsRequired"]
    except (ValueError, LookupError, TypeError):  # trimesh says what is wrong with the file, if anything
        return
    for extension in required if isinstance(required, list) else [required]:
        if not str(extension).startswith(_ONLY_LOOKS):
            raise ValueError(f"it requires the extension {quoted(str(extension))}, which is not read")


def _uv(found: Any) -> Reals | None:
    uv = getattr(found.visual, "uv", None)
    return None if uv is None or len(uv) != len(found.vertices) else np.asarray(uv, np.float64)
