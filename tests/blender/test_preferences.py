# SPDX-License-Identifier: GPL-3.0-or-later
"""The preferences, the key, the entries in menus, the manual, and why buttons are gray."""

import contextlib
import re
import sys
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from urllib.parse import unquote, urlsplit
from urllib.request import url2pathname

import bpy
import drawing
import meshes
import pairing
import pytest
from installed import part

TASKS = Path("/proc/self/task")


def operators() -> list[str]:
    """The names of all operators."""
    return sorted(name for name in dir(bpy.ops.authalic) if not name.startswith("_"))


def of(extension: str) -> Any:
    """The preferences of the extension; the type checker does not know them."""
    addon: Any = bpy.context.preferences.addons[extension]
    return addon.preferences


def is_5() -> bool:
    """From Blender 5.0 on, what properties keep is apart from what scripts keep."""
    return bpy.app.version >= (5, 0)


@pytest.fixture
def preferences(extension: str) -> Any:
    """The preferences, which are as they were afterwards."""
    yield of(extension)
    values = of(extension)  # anew: a test may have registered the class again
    for name in ("threads", "preset", "small", "fair", "large", "flipped"):
        prop = values.bl_rna.properties[name]
        setattr(values, name, tuple(prop.default_array) if prop.type == "FLOAT" else prop.default)


def test_they_are_drawn(preferences: Any) -> None:
    layout = drawing.Layout()
    type(preferences).draw(SimpleNamespace(layout=layout, bl_rna=preferences.bl_rna), bpy.context)
    assert {"threads", "preset", "small", "flipped"} <= set(layout.properties)
    assert "Manual" in layout.labels


def _named(name: str) -> list[str]:
    """The names of the threads of this process that begin so."""
    names = []
    for task in TASKS.iterdir():
        with contextlib.suppress(FileNotFoundError):  # it has ended meanwhile
            names.append((task / "comm").read_text(encoding="utf-8"))
    return [each for each in names if each.startswith(name)]


@pytest.mark.skipif(not TASKS.exists(), reason="counts threads as Linux lists them")
def test_threads_reach_the_library(preferences: Any) -> None:
    """Those of the library stay after a run, until their number is changed."""
    meshes.add_grid(n=80)
    for threads in (7, 2):
        preferences.threads = threads
        part("bridge").forget()  # or the maps of the run before would be taken
        assert bpy.ops.authalic.unwrap() == {"FINISHED"}
        end = time.monotonic() + 20  # those of the run before need a moment to end
        while (count := len(_named("authalic"))) != threads and time.monotonic() < end:
            time.sleep(0.02)
        assert count == threads


def test_the_panels_start_with_the_preset_and_scripts_with_even(preferences: Any) -> None:
    last = bpy.context.window_manager.operator_properties_last
    for name in ("authalic.unwrap", "authalic.sphere_shape_key"):
        assert last(name).angle_preset == "EVEN"
    preferences.preset = "SOFT"
    solver = part("bridge.solver")
    for name in ("authalic.unwrap", "authalic.sphere_shape_key"):
        assert last(name).angle_preset == "SOFT"
        assert last(name).angle_weight == pytest.approx(solver.slider("SOFT"))
    seen = []
    unwrap: Any = part("jobs.unwrap")
    job = unwrap.job

    def noted(context: Any, settings: Any) -> Any:
        seen.append(settings.mapping.solver.angle_weight)
        return job(context, settings)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(unwrap, "job", noted)
        meshes.add_grid()
        bpy.ops.authalic.unwrap()
    assert seen == [pytest.approx(solver.slider("EVEN"))]


def test_saved_preferences_count_when_the_extension_is_enabled(preferences: Any, extension: str) -> None:
    preferences.preset, preferences.small = "BALANCED", (0.0, 1.0, 0.0)
    bpy.context.window_manager.operator_properties_last("authalic.unwrap").angle_preset = "EVEN"
    part("ui.preferences").unregister()
    assert part("overlay.heat_map").colors().small != (0.0, 1.0, 0.0)
    part("ui.preferences").register()
    assert bpy.context.window_manager.operator_properties_last("authalic.unwrap").angle_preset == "BALANCED"
    assert part("overlay.heat_map").colors().small == (0.0, 1.0, 0.0)


def test_the_panels_start_with_the_preset_in_every_file(preferences: Any, tmp_path: Path) -> None:
    """Blender forgets the last options of operators as it opens a file; a timer sets them anew."""
    preferences.preset = "SOFT"
    path, timer = str(tmp_path / "file.blend"), part("ui.preferences").start_with_preset
    bpy.ops.wm.save_as_mainfile(filepath=path)
    for load, options in ((bpy.ops.wm.read_homefile, {}), (bpy.ops.wm.open_mainfile, {"filepath": path})):
        load(**options)
        assert bpy.app.timers.is_registered(timer)
        timer()  # Blender without a window runs none
        for name in ("authalic.unwrap", "authalic.sphere_shape_key"):
            assert bpy.context.window_manager.operator_properties_last(name).angle_preset == "SOFT"
    part("ui.preferences").unregister()
    assert not bpy.app.timers.is_registered(timer)
    part("ui.preferences").register()


def test_a_saved_preset_that_is_none_counts_as_the_default(preferences: Any) -> None:
    """Blender keeps a number, which another version of the extension may have saved."""
    stored: Any = preferences.bl_system_properties_get(do_create=True) if is_5() else preferences
    stored["preset"] = 99
    assert preferences.preset == ""
    part("ui.preferences").unregister()
    part("ui.preferences").register()
    assert bpy.context.window_manager.operator_properties_last("authalic.unwrap").angle_preset == "EVEN"


def test_the_colors_are_those_of_the_heat_map(preferences: Any) -> None:
    heat_map = part("overlay.heat_map")
    for name in ("small", "fair", "large", "flipped"):
        assert getattr(heat_map.colors(), name) == pytest.approx(
            getattr(part("surfaces.heat_map").Colors(), name)
        )
    look = part("operators.heat_map")
    before = look._look(bpy.context.window_manager.authalic_heat_map)
    preferences.large = (0.0, 0.5, 0.25)
    assert heat_map.colors().large == pytest.approx((0.0, 0.5, 0.25))
    assert look._look(bpy.context.window_manager.authalic_heat_map) != before, "it is painted anew"


def keys() -> list[tuple[str, Any]]:
    maps = bpy.context.window_manager.keyconfigs.addon.keymaps
    return [(m.name, item) for m in maps for item in m.keymap_items if item.idname.startswith("authalic.")]


def test_the_key_is_free_in_the_key_maps_of_blender() -> None:
    found = keys()
    assert {(name, item.idname) for name, item in found} == {
        ("Mesh", "authalic.unwrap"),
        ("UV Editor", "authalic.unwrap"),
    }
    folder = next(Path(bpy.utils.resource_path("LOCAL")).rglob("keymap_data"), None)
    folder = folder or next(Path(str(bpy.__file__)).parents[1].rglob("keymap_data"))
    sys.path.insert(0, str(folder))
    try:
        import blender_default  # type: ignore[import-not-found]
        import industry_compatible_data as industry  # type: ignore[import-not-found]
    finally:
        sys.path.remove(str(folder))
    parameters = blender_default.Params(select_mouse="LEFT")
    taken = [
        *blender_default.generate_keymaps(parameters),
        *industry.generate_keymaps(industry.Params()),
    ]
    for _, item in found:
        wanted = (item.type, item.ctrl, item.alt, item.shift)
        assert (item.ctrl, item.alt) == (True, True)
        for name, _, content in taken:
            for idname, event, *_ in content["items"]:
                pressed = tuple(bool(event.get(key)) for key in ("ctrl", "alt", "shift"))
                is_any = event.get("any") and "Modal" not in name
                assert (event.get("type"), *pressed) != wanted and not (
                    is_any and event.get("type") == item.type
                ), (name, idname)


def test_the_key_goes_with_the_extension(extension: str) -> None:
    bpy.ops.preferences.addon_disable(module=extension)
    assert not keys()
    bpy.ops.preferences.addon_enable(module=extension)
    assert len(keys()) == 2


def test_object_mode_finds_the_operators() -> None:
    layout = drawing.Layout()
    menu: Any = bpy.types.AUTHALIC_MT_object
    menu.draw(SimpleNamespace(layout=layout), bpy.context)
    shown = {idname.split(".")[1] for idname, _ in layout.operators}
    assert {"unwrap", "mark_seams", "measure", "fix_flips", "show_heat_map", "register", "transfer"} <= shown
    assert {"sphere_shape_key", "swap_target", "side_by_side", "landmark_pick"} <= shown
    for name, words in (
        ("VIEW3D_MT_object", "Authalic"),
        ("VIEW3D_MT_make_links", "Transfer through Landmarks"),
        ("IMAGE_MT_uvs", "Show Heat Map"),
    ):
        layout = drawing.Layout()
        kind: Any = getattr(bpy.types, name)
        for draw in kind._dyn_ui_initialize():
            if "authalic" in draw.__module__:
                draw(SimpleNamespace(layout=layout), bpy.context)
        assert words in layout.labels


def test_the_manual_of_every_operator_is_a_heading_of_its_page() -> None:
    look_up = bpy.types.WM_OT_doc_view_manual._lookup_rna_url
    for name in operators():
        for rna in (f"bpy.ops.authalic.{name}", f"bpy.types.AUTHALIC_OT_{name}.index"):
            url = urlsplit(look_up(rna, verbose=False))
            page = Path(url2pathname(unquote(url.path))).read_text(encoding="utf-8")
            assert url.scheme == "file" and f'id="{url.fragment}"' in page, (name, url)
    url = urlsplit(look_up("bpy.ops.authalic.unwrap", verbose=False))
    page = Path(url2pathname(unquote(url.path))).read_text(encoding="utf-8")
    assert url.fragment == "unwrap"
    anchors = set(re.findall(r'id="([^"]+)"', page))
    assert set(re.findall(r'href="#([^"]+)"', page)) <= anchors
    assert "](" not in re.sub(r"<(pre|code)>.*?</\1>", "", page, flags=re.DOTALL), "Markdown is left"


@pytest.mark.parametrize("scene", ["nothing", "camera", "sculpt", "pair"])
def test_a_gray_button_says_why(scene: str) -> None:
    if scene == "camera":
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        bpy.context.collection.objects.link(camera)
        meshes.select(camera)
    elif scene == "sculpt":
        meshes.add_grid()
        bpy.ops.object.mode_set(mode="SCULPT")
    elif scene == "pair":
        pairing.heads()
    gray = [name for name in operators() if not getattr(bpy.ops.authalic, name).poll()]
    assert gray and len(operators()) > 20
    for name in gray:
        with pytest.raises(RuntimeError, match=r"poll\(\)") as problem:
            getattr(bpy.ops.authalic, name)()
        assert "context is incorrect" not in str(problem.value)
