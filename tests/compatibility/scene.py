# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made with one version and looked at with another."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import bpy
import meshes
import numpy as np
import spheres
from meshes import MeshObject

# "user_default" gets files; another one is a remote repository, as of the site, whose index is a file here.
REPOSITORY = os.environ.get("AUTHALIC_REPOSITORY", "user_default")
MODULE = f"bl_ext.{REPOSITORY}.authalic"
FOLDER = Path(os.environ["AUTHALIC_COMPATIBILITY"])
PROFILE = Path(os.environ["BLENDER_USER_RESOURCES"])
SAVED, LANDMARKS, FACTS = FOLDER / "before.blend", FOLDER / "landmarks.json", FOLDER / "facts.json"
POINTS = [("Nose", 0), ("Landmark 2", 5), ("Chin", 17), ("Back", 40)]
ROW, ROW_B = (8, 9, 10, 11), (10, 11, 12, 13, 14)
KEY, KEY_OF_SHEETS = "Morph → Ball B", "Morph → Sheet B"
# Preferences that are not the defaults, of numbers that have no rounding.
PREFERENCES: dict[str, Any] = {
    "threads": 3,
    "preset": "SOFT",
    "small": [0.0, 1.0, 0.5],
    "fair": [0.5, 0.25, 0.75],
    "large": [1.0, 0.0, 0.25],
    "flipped": [0.125, 0.0, 0.0],
}
COLORS = ("small", "fair", "large", "flipped")
SETTINGS = {"show": False, "landmarks": [2, 0], "curves": [0, 0]}


def install(archive: str) -> None:
    """Installs and enables a zip as a person would; a version that is installed is updated."""
    if REPOSITORY == "user_default":
        bpy.ops.extensions.package_install_files(
            filepath=os.path.abspath(archive), repo=REPOSITORY, enable_on_install=True
        )
    else:
        _install_from_repository(_published(archive))


def _published(archive: str) -> str:
    """Makes a zip the only one of the remote repository; returns the address of its index."""
    place = FOLDER / "repository"
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir()
    shutil.copy(archive, place)
    tool = [sys.executable, os.environ["AUTHALIC_BLENDER_EXT"], "server-generate", "--repo-dir", str(place)]
    subprocess.run(tool, check=True)
    return (place / "index.json").as_uri()


def _install_from_repository(address: str) -> None:
    """Looks for updates; updates all that Blender finds to be newer, or installs what is not there yet."""
    preferences: Any = bpy.context.preferences
    preferences.system.use_online_access = True
    repos = preferences.extensions.repos
    if not any(repo.module == REPOSITORY for repo in repos):
        repos.new(name="Authalic", module=REPOSITORY, remote_url=address)
    bpy.ops.extensions.repo_sync(repo_index=repo_index())
    if folder().exists():
        bpy.ops.extensions.package_upgrade_all()
    else:
        bpy.ops.extensions.package_install(repo_index=repo_index(), pkg_id="authalic", enable_on_install=True)


def repo_index() -> int:
    """The number of the repository."""
    repos: Any = bpy.context.preferences.extensions.repos
    return [repo.module for repo in repos].index(REPOSITORY)


def is_enabled() -> bool:
    return MODULE in bpy.context.preferences.addons


def manifest() -> str:
    """The manifest of the installed extension."""
    return (folder() / "blender_manifest.toml").read_text(encoding="utf-8")


def folder() -> Path:
    return PROFILE / "extensions" / REPOSITORY / "authalic"


def preferences() -> Any:
    """The preferences of the extension, or None: an early version 0.1.0 has none."""
    addon: Any = bpy.context.preferences.addons[MODULE]
    return addon.preferences


def values_of_preferences() -> dict[str, Any] | None:
    """What the preferences are, in the form of PREFERENCES."""
    found = preferences()
    if found is None:
        return None
    values = {name: getattr(found, name) for name in PREFERENCES}
    return {name: list(value) if name in COLORS else value for name, value in values.items()}


def settings() -> dict[str, Any]:
    """What the open file keeps of the panels."""
    scene: Any = bpy.context.scene
    objects: list[Any] = [bpy.data.objects[name] for name in ("Ball A", "Sheet A")]
    return {
        "show": scene.authalic_show_landmarks,
        "landmarks": [obj.authalic_landmark_index for obj in objects],
        "curves": [obj.authalic_landmark_curve_index for obj in objects],
    }


def installed_libraries() -> list[str]:
    """The native libraries that Blender has unpacked for its extensions."""
    place = PROFILE / "extensions" / ".local"
    found = place.rglob("authalic/_native*")
    return sorted(path.relative_to(place).as_posix() for path in found if path.suffix != ".pyi")


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
