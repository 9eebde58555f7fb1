# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made with one version and looked at with another."""

import json
import os
from pathlib import Path
from typing import Any

import bpy
import meshes
import numpy as np
import spheres
from meshes import MeshObject

MODULE = "bl_ext.user_default.authalic"
FOLDER = Path(os.environ["AUTHALIC_COMPATIBILITY"])
SAVED, LANDMARKS, FACTS = FOLDER / "before.blend", FOLDER / "landmarks.json", FOLDER / "facts.json"
POINTS = [("Nose", 0), ("Landmark 2", 5), ("Chin", 17), ("Back", 40)]
ROW, ROW_B = (8, 9, 10, 11), (10, 11, 12, 13, 14)
KEY, KEY_OF_SHEETS = "Morph → Ball B", "Morph → Sheet B"


def install(archive: str) -> None:
    """Installs and enables a zip as a person would; a version that is installed is updated."""
    bpy.ops.extensions.package_install_files(
        filepath=os.path.abspath(archive), repo="user_default", enable_on_install=True
    )


def is_enabled() -> bool:
    return MODULE in bpy.context.preferences.addons


def manifest() -> str:
    """The manifest of the installed extension."""
    return (folder() / "blender_manifest.toml").read_text(encoding="utf-8")


def folder() -> Path:
    return Path(os.environ["BLENDER_USER_RESOURCES"]) / "extensions" / "user_default" / "authalic"


def installed_libraries() -> list[str]:
    """The native libraries that Blender has unpacked for its extensions."""
    place = Path(os.environ["BLENDER_USER_RESOURCES"]) / "extensions" / ".local"
    found = place.rglob("authalic/_native*")
    return sorted(str(path.relative_to(place)) for path in found if path.suffix != ".pyi")


def balls() -> tuple[MeshObject, MeshObject]:
    """Two spheres, the active one with the other as its target."""
    vertices, faces = spheres.icosphere(2)
    source = meshes.add(vertices * (1.0, 0.8, 1.2), faces, "Ball A")
    target = meshes.add(vertices * (1.1, 1.0, 0.9), faces, "Ball B")
    target.location.x = 3
    source.authalic_target = target
    meshes.select(source)
    bpy.context.view_layer.update()
    return source, target


def sheets() -> tuple[MeshObject, MeshObject]:
    """Two bumpy squares, the active one with the other as its target."""
    source, target = meshes.add_grid("Sheet A"), meshes.add_grid("Sheet B", n=8)
    target.location = (0, 4, 0)
    source.authalic_target = target
    meshes.select(source)
    bpy.context.view_layer.update()
    return source, target


def text(path: tuple[int, ...]) -> str:
    return " ".join(map(str, path))


def key_positions(name: str, key: str) -> list[list[float]]:
    """The positions of a shape key."""
    block: Any = bpy.data.objects[name].data.shape_keys.key_blocks[key]
    return np.array([tuple(point.co) for point in block.data]).round(6).tolist()


def options(operator: str) -> list[str]:
    """The names of the options of an operator, such as a script or a preset may set."""
    area, name = operator.split(".")
    properties = getattr(getattr(bpy.ops, area), name).get_rna_type().properties
    return sorted(each.identifier for each in properties if each.identifier != "rna_type")


def values(operator: str) -> dict[str, list[str]]:
    """The values of the options of an operator that are chosen from a list."""
    area, name = operator.split(".")
    properties = getattr(getattr(bpy.ops, area), name).get_rna_type().properties
    return {
        each.identifier: [item.identifier for item in each.enum_items]
        for each in properties
        if each.type == "ENUM"
    }


def operators() -> list[str]:
    return sorted(f"authalic.{name}" for name in dir(bpy.ops.authalic) if not name.startswith("_"))


def read_facts() -> dict[str, Any]:
    facts: dict[str, Any] = json.loads(FACTS.read_text(encoding="utf-8"))
    return facts
