# SPDX-License-Identifier: GPL-3.0-or-later
"""The zip installs, enables, disables and uninstalls without leaving anything behind."""

import bpy
import conftest


def _menu_entries():
    return [f for f in bpy.types.IMAGE_MT_uvs_unwrap._dyn_ui_initialize() if "authalic" in f.__module__]


def _registered():
    found = {name for name in dir(bpy.types) if name.startswith("AUTHALIC_")}
    return found | ({"figures"} if hasattr(bpy.types.WindowManager, "authalic_figures") else set())


def test_enabled():
    assert len(_menu_entries()) == 1
    assert {"AUTHALIC_OT_unwrap", "AUTHALIC_OT_measure", "figures"} <= _registered()
    spaces = {getattr(bpy.types, name).bl_space_type for name in _registered() if "_PT_" in name}
    assert spaces == {"VIEW_3D", "IMAGE_EDITOR"}


def test_disabling_leaves_nothing(extension):
    bpy.ops.preferences.addon_disable(module=extension)
    assert not _menu_entries() and not _registered()
    bpy.ops.preferences.addon_enable(module=extension)
    assert len(_menu_entries()) == 1 and _registered()


def test_uninstall_and_install_again(extension):
    repo = next(
        i for i, r in enumerate(bpy.context.preferences.extensions.repos) if r.module == "user_default"
    )
    bpy.ops.extensions.package_uninstall(repo_index=repo, pkg_id="authalic")
    assert extension not in bpy.context.preferences.addons
    assert not _menu_entries() and not _registered()
    conftest.install()
    assert extension in bpy.context.preferences.addons and len(_menu_entries()) == 1


def test_defaults_are_declared():
    properties = bpy.ops.authalic.unwrap.get_rna_type().properties
    found = {key: properties[key].default for key in ("domain", "fill_holes", "uv_layer", "margin_method")}
    assert found == {
        "domain": "AUTO",
        "fill_holes": True,
        "uv_layer": "",
        "margin_method": "SCALED",
    }
    assert all(p.name and not p.description.endswith(".") for p in properties if p.identifier != "rna_type")


def test_sidebar_has_options_before_the_first_use():
    options = bpy.context.window_manager.operator_properties_last("authalic.unwrap")
    assert options.iterations == 100 and options.fill_holes
