# SPDX-License-Identifier: GPL-3.0-or-later
"""Where panels are shown."""

from collections.abc import Iterator
from typing import Any

import bpy
import meshes
import pytest


def image_panels() -> list[Any]:
    """The panels of the image editor that are in its sidebar."""
    names = [name for name in dir(bpy.types) if name.startswith("AUTHALIC_PT_")]
    panels = [getattr(bpy.types, name) for name in names]
    return [panel for panel in panels if panel.bl_space_type == "IMAGE_EDITOR"]


@pytest.fixture
def editor() -> Iterator[Any]:
    """An image editor, in the place of a 3D view."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    area.type = "IMAGE_EDITOR"
    with bpy.context.temp_override(window=window, area=area):
        yield area.spaces.active
    area.type = "VIEW_3D"


def shown() -> set[bool]:
    return {panel.poll(bpy.context) for panel in image_panels()}


def test_panels_of_the_image_editor_are_for_uvs_only(editor: Any) -> None:
    assert len(image_panels()) >= 3
    meshes.add_grid()
    editor.mode = "UV"
    assert shown() == {True}
    editor.mode = "VIEW"
    assert shown() == {False}
    editor.mode = "UV"
    editor.image = bpy.data.images.new("Render Result", 8, 8)
    assert shown() == {True}  # an image of this name is no render
    bpy.context.view_layer.objects.active = None
    assert shown() == {False}


def test_panels_stay_off_renders(editor: Any) -> None:
    meshes.add_grid()
    editor.mode = "UV"
    scene: Any = bpy.context.scene
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    bpy.ops.render.render()
    editor.image = next(image for image in bpy.data.images if image.type == "RENDER_RESULT")
    assert shown() == {False}
