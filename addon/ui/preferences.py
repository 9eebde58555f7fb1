# SPDX-License-Identifier: GPL-3.0-or-later
"""The preferences of the extension: threads, the preset to start with, colors of the heat map, the manual."""

from typing import Any

import bpy
from bpy.app.handlers import persistent
from bpy.props import EnumProperty, FloatVectorProperty, IntProperty

from .. import bridge
from ..operators import solving
from ..overlay import heat_map
from ..surfaces.heat_map import Colors
from . import manual

_ADDON = __package__.rpartition(".")[0]
# The operators that begin with the preset.
_OPERATORS = ("authalic.unwrap", "authalic.sphere_shape_key")


def _threads_changed(preferences: Any, _context: bpy.types.Context) -> None:
    bridge.set_threads(preferences.threads)


def _preset_changed(preferences: Any, context: bpy.types.Context) -> None:
    for name in _OPERATORS:
        context.window_manager.operator_properties_last(name).angle_preset = preferences.preset


def _colors_changed(preferences: Any, _context: bpy.types.Context) -> None:
    heat_map.use(Colors(**{name: tuple(getattr(preferences, name)) for name in _COLORS}))


_COLORS = ("small", "fair", "large", "flipped")


def _color(name: str, field: str, description: str) -> Any:
    return FloatVectorProperty(
        name=name,
        description=description,
        subtype="COLOR_GAMMA",
        min=0.0,
        max=1.0,
        default=getattr(Colors(), field),
        update=_colors_changed,
    )


class AUTHALIC_AP_preferences(bpy.types.AddonPreferences):
    bl_idname = _ADDON

    threads: IntProperty(
        name="Threads",
        description="The number of threads that compute; 0 for as many as there are processors. Results do "
        "not depend on it",
        min=0,
        soft_max=64,
        default=0,
        update=_threads_changed,
    )
    preset: EnumProperty(
        name="Default Preset",
        description="The trade-off between areas and shapes that the panels start with. Scripts start with "
        "Even, whatever is set here",
        items=solving.SHOWN,
        default="EVEN",
        update=_preset_changed,
    )
    small: _color("Too Small", "small", "The heat map's color of faces with too little of the texture")
    fair: _color("As It Should Be", "fair", "The heat map's color of faces with their share, and of no shear")
    large: _color("Too Large", "large", "The heat map's color of faces with too much of the texture or shear")
    flipped: _color("Flipped", "flipped", "The heat map's color of the stripes on flipped faces")

    def draw(self, _context: bpy.types.Context) -> None:
        column = self.layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        column.prop(self, "threads")
        column.prop(self, "preset")
        colors = column.column(align=True)
        colors.label(text="Heat Map")
        for name in _COLORS:
            colors.prop(self, name)
        self.layout.operator("wm.url_open", text="Manual", icon="HELP").url = manual.address()


def _saved() -> Any:
    """The preferences, or None."""
    addon: Any = bpy.context.preferences.addons.get(_ADDON)
    return None if addon is None else addon.preferences


def start_with_preset() -> None:
    """Lets the panels start with the preset."""
    preferences = _saved()
    # Empty if it is none of this version's presets.
    if preferences is not None and preferences.preset not in ("EVEN", ""):
        _preset_changed(preferences, bpy.context)


@persistent  # type: ignore[untyped-decorator]
def _loaded(*_: object) -> None:
    """Blender forgets the last options of operators once it has opened a file and called this."""
    if not bpy.app.timers.is_registered(start_with_preset):
        bpy.app.timers.register(start_with_preset, first_interval=0)


def _apply() -> None:
    """Lets saved preferences count from the start."""
    if (preferences := _saved()) is None:
        return
    if preferences.threads:
        bridge.set_threads(preferences.threads)
    start_with_preset()
    _colors_changed(preferences, bpy.context)


def register() -> None:
    bpy.utils.register_class(AUTHALIC_AP_preferences)
    _apply()
    bpy.app.handlers.load_post.append(_loaded)


def unregister() -> None:
    bpy.app.handlers.load_post.remove(_loaded)
    if bpy.app.timers.is_registered(start_with_preset):
        bpy.app.timers.unregister(start_with_preset)
    heat_map.use(Colors())
    bpy.utils.unregister_class(AUTHALIC_AP_preferences)
