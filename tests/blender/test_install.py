# SPDX-License-Identifier: GPL-3.0-or-later
"""The zip installs, enables, disables and uninstalls without leaving anything behind."""

from typing import Any

import bpy
import conftest
import pytest

MENUS = (
    *("IMAGE_MT_uvs_unwrap", "IMAGE_MT_uvs", "VIEW3D_MT_uv_map", "MESH_MT_shape_key_context_menu"),
    *(
        "VIEW3D_MT_object",
        "VIEW3D_MT_make_links",
        "VIEW3D_MT_edit_mesh_edges",
        "VIEW3D_PT_overlay",
        "IMAGE_PT_overlay",
    ),
)
ENTRIES = len(MENUS) + 2  # the UV menus have those of the heat map too


def _menu_entries() -> list[Any]:
    menus = (getattr(bpy.types, name) for name in MENUS)
    return [f for menu in menus for f in menu._dyn_ui_initialize() if "authalic" in f.__module__]


def _registered() -> set[str]:
    names = {name for name in dir(bpy.types) if name.startswith("AUTHALIC_")}
    return names | ({"figures"} if hasattr(bpy.types.WindowManager, "authalic_figures") else set())


def test_enabled() -> None:
    assert len(_menu_entries()) == ENTRIES
    operators = {f"AUTHALIC_OT_{name}" for name in ("unwrap", "sphere_shape_key", "measure", "fix_flips")}
    assert operators | {"figures"} <= _registered()
    spaces = {getattr(bpy.types, name).bl_space_type for name in _registered() if "_PT_" in name}
    assert spaces == {"VIEW_3D", "IMAGE_EDITOR"}


def test_disabling_leaves_nothing(extension: str) -> None:
    bpy.ops.preferences.addon_disable(module=extension)
    assert not _menu_entries() and not _registered()
    bpy.ops.preferences.addon_enable(module=extension)
    assert len(_menu_entries()) == ENTRIES and _registered()


def test_uninstall_and_install_again(extension: str) -> None:
    repo = next(
        i for i, r in enumerate(bpy.context.preferences.extensions.repos) if r.module == "user_default"
    )
    bpy.ops.extensions.package_uninstall(repo_index=repo, pkg_id="authalic")
    assert extension not in bpy.context.preferences.addons
    assert not _menu_entries() and not _registered()
    conftest.install()
    assert extension in bpy.context.preferences.addons and len(_menu_entries()) == ENTRIES


def test_defaults_are_declared() -> None:
    properties = bpy.ops.authalic.unwrap.get_rna_type().properties
    expected = {
        "domain": "AUTO",
        "fill_holes": True,
        "sphere_layout": "LAMBERT",
        "pole_axis": "Z",
        "seam_direction": 0.0,
        "uv_layer": "",
        "margin_method": "SCALED",
        "method": "GAUSS_NEWTON",
        "angle_preset": "EVEN",
        "angle_weight": pytest.approx(2 / 5.5),  # a weight of .001
        "area_tolerance": 0.0,
        "outline": "FREE",
        "allow_overlap": False,
        "iterations": 0,
    }
    assert {key: properties[key].default for key in expected} == expected
    assert next(iter(properties["method"].enum_items)).name == "Gauss-Newton"
    of_the_key = bpy.ops.authalic.sphere_shape_key.get_rna_type().properties
    shared = ("method", "angle_preset", "angle_weight", "area_tolerance", "iterations")
    assert all(of_the_key[name].default == expected[name] for name in shared)
    for name in ("unwrap", "sphere_shape_key"):
        properties = getattr(bpy.ops.authalic, name).get_rna_type().properties
        named = [p for p in properties if p.identifier != "rna_type"]
        assert all(p.name and p.description and not p.description.endswith(".") for p in named)


def test_defaults_of_seams_are_declared() -> None:
    properties = bpy.ops.authalic.mark_seams.get_rna_type().properties
    expected = {
        "shear_preset": "AUTO",
        "shear": 1.25,
        "keep_off": "",
        "prefer": "",
        "symmetry": "AUTO",
        "front": "NONE",
        "max_islands": 0,
        "allow_overlap": False,
        "clear": False,
        "draft": False,
    }
    named = [p for p in properties if p.identifier != "rna_type"]
    assert {p.identifier: p.default for p in named} == expected
    assert all(p.name and p.description and not p.description.endswith(".") for p in named)
    of_the_unwrap = bpy.ops.authalic.unwrap.get_rna_type().properties
    assert of_the_unwrap["seams"].default == "GIVEN" and of_the_unwrap["mark_seams"].default
    assert all(of_the_unwrap[name].default == expected[name] for name in ("shear_preset", "shear"))


def test_sidebar_has_options_before_the_first_use() -> None:
    options = bpy.context.window_manager.operator_properties_last("authalic.unwrap")
    assert options.iterations == 0 and options.fill_holes
    assert (options.method, options.angle_preset, options.outline) == ("GAUSS_NEWTON", "EVEN", "FREE")
