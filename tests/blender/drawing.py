# SPDX-License-Identifier: GPL-3.0-or-later
"""A layout that notes what panels draw, since there is nothing to draw on without a window."""

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import bpy
from installed import part

_KINDS: Any = bpy.types.UILayout.bl_rna
ICONS = set(_KINDS.functions["label"].parameters["icon"].enum_items.keys())


class Layout:
    """Notes labels, operators with their properties, properties and menus; all parts note into one place.

    What Blender would not find (an operator, a property, a menu, an icon) is an error.
    """

    def __init__(self, whole: "Layout | None" = None) -> None:
        self.whole = whole or self
        self.labels: list[str] = []
        self.icons: list[str] = []
        self.operators: list[tuple[str, Any]] = []
        self.properties: list[str] = []

    def _part(self, *_: Any, **__: Any) -> "Layout":
        return Layout(self.whole)

    row = column = split = box = column_flow = grid_flow = menu_pie = _part

    def separator(self, **_: Any) -> None:
        pass

    def panel(self, idname: str, *, default_closed: bool = False) -> tuple["Layout", "Layout"]:
        assert idname and default_closed in (True, False)
        return self._part(), self._part()

    def label(self, *, text: str = "", icon: str = "NONE", translate: bool = True, **_: Any) -> None:
        assert translate in (True, False)
        self._note(text, icon)

    def operator(self, idname: str, *, text: str | None = None, icon: str = "NONE", **_: Any) -> Any:
        group, name = idname.split(".")
        kind = getattr(getattr(bpy.ops, group), name).get_rna_type()
        self._note(kind.name if text is None else text, icon)
        given = SimpleNamespace(**{p.identifier: getattr(p, "default", None) for p in kind.properties})
        self.whole.operators.append((idname, given))
        return given

    def prop(self, data: Any, name: str, *, text: str | None = None, icon: str = "NONE", **_: Any) -> None:
        properties = data.bl_rna.properties
        assert name in properties, f"{data} has no {name}"
        self._note(properties[name].name if text is None else text, icon)
        self.whole.properties.append(name)

    def prop_search(self, data: Any, name: str, where: Any, among: str, **given: Any) -> None:
        assert among in where.bl_rna.properties
        self.prop(data, name, **given)

    def prop_enum(
        self, data: Any, name: str, value: str, *, text: str | None = None, icon: str = "NONE"
    ) -> None:
        item = data.bl_rna.properties[name].enum_items[value]
        self.prop(data, name, text=item.name if text is None else text, icon=icon)

    def menu(self, name: str, *, text: str | None = None, icon: str = "NONE", **_: Any) -> None:
        self._note(getattr(bpy.types, name).bl_label if text is None else text, icon)

    def template_list(self, kind: str, _name: str, data: Any, prop: str, *active: Any, **_: Any) -> None:
        assert hasattr(bpy.types, kind) and hasattr(data, prop) and hasattr(*active)

    def progress(self, *, text: str = "", **_: Any) -> None:
        self._note(text, "NONE")

    def _note(self, text: str, icon: str) -> None:
        assert icon in ICONS, f"{icon} is no icon"
        self.whole.labels.append(text)
        self.whole.icons.append(icon)


def rows(module: str, kind: str, entries: Sequence[Any]) -> list[Layout]:
    """What the list of a kind draws for each of its entries."""
    draw = getattr(part(module), kind).draw_item
    owner, drawn = entries[0].id_data, []
    draw_panel(kind.replace("_UL_", "_PT_"))
    for index, item in enumerate(entries):
        layout = Layout()
        draw(None, bpy.context, layout, owner, item, 0, None, "", index)
        drawn.append(layout)
    return drawn


def context(**more: Any) -> Any:
    """The context as a panel sees it, in a region of usual width."""
    names = ("object", "mode", "scene", "selected_objects", "view_layer", "window_manager")
    seen = {name: getattr(bpy.context, name, None) for name in (*names, "objects_in_mode", "tool_settings")}
    system = SimpleNamespace(ui_scale=1.0)  # which is 0 without a window
    seen["preferences"] = SimpleNamespace(system=system, addons=bpy.context.preferences.addons)
    seen |= {"region": SimpleNamespace(width=280), "area": None, "workspace": None}
    seen["space_data"] = SimpleNamespace(
        type="IMAGE_EDITOR", mode="UV", image=None, show_render=False, region_3d=None
    )
    return SimpleNamespace(**seen | more)


def draw_panel(name: str, **more: Any) -> Layout | None:
    """What a panel draws, its header too; None where it is not shown."""
    panel: Any = getattr(bpy.types, name)
    seen, layout = context(**more), Layout()
    if hasattr(panel, "poll") and not panel.poll(seen):
        return None
    place = SimpleNamespace(layout=layout, bl_label=panel.bl_label)
    if hasattr(panel, "draw_section"):
        place.draw_section = panel.draw_section
    for step in ("draw_header", "draw_header_preset", "draw"):
        if hasattr(panel, step) and step in dir(panel):
            function = getattr(panel, step)
            function(place, seen)
    return layout


def last(idname: str) -> Any:
    """The options that an operator was last used with."""
    return bpy.context.window_manager.operator_properties_last(idname)


def tooltip(idname: str, properties: Any) -> str:
    """The tooltip of a button with its properties."""
    group, name = idname.split(".")
    kind: Any = getattr(bpy.types, f"{group.upper()}_OT_{name}")
    said = kind.description(bpy.context, properties)
    return str(said)
