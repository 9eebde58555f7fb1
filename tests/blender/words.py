# SPDX-License-Identifier: GPL-3.0-or-later
"""All words that the extension shows, collected from what is registered and from its sources."""

import ast
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
from installed import MODULE

OPERATOR, ANY = "Operator", "*"
UNTRANSLATABLE = "a text with figures, which needs translate=False or a template"
Word = tuple[str, str]
"""A context of Blender's translations, and a message."""

# Names of Blender itself, which it translates: of files, and what every class has.
_OF_BLENDER = {"rna_type", "bl_idname", "filepath", "filter_glob", "check_existing"}
# What the name of every property group says; Blender 5.3 has other words for it.
_OF_NAMES = (
    bpy.types.PropertyGroup.bl_rna.properties["name"].description,
    "Unique name used in the code and scripting",
)
# Types to which the extension adds properties.
_EXTENDED = ("Object", "Scene", "WindowManager", "Mesh", "Image", "Screen")
# Arguments of layouts that are shown.
_SHOWN = {"text", "placeholder", "heading", "text_ctxt"}


def all_words() -> dict[Word, str]:
    """{(context, message): where it is shown} of everything that Blender would translate."""
    words: dict[Word, str] = {}
    for context, message, where in (*_of_classes(), *_of_types(), *_of_sources()):
        if message:
            words.setdefault((context, message), where)
    return words


def _of_classes() -> Iterator[tuple[str, str, str]]:
    for name in sorted(dir(bpy.types)):
        if not name.startswith("AUTHALIC_"):
            continue
        cls: Any = getattr(bpy.types, name)
        if "_OT_" in name:
            rna = getattr(bpy.ops.authalic, name.split("_OT_")[1]).get_rna_type()
            yield OPERATOR, rna.name, name
            yield ANY, rna.description, name
            yield from _of_properties(rna, name)
        else:
            yield ANY, getattr(cls, "bl_label", ""), name
            yield ANY, getattr(cls, "bl_description", ""), name
    for base in (bpy.types.PropertyGroup, bpy.types.AddonPreferences):
        for cls in base.__subclasses__():
            if cls.__name__.startswith("AUTHALIC_") and cls.is_registered:
                yield from _of_properties(cls.bl_rna, cls.__name__)


def _of_types() -> Iterator[tuple[str, str, str]]:
    for name in _EXTENDED:
        yield from _of_properties(getattr(bpy.types, name).bl_rna, name, "authalic")


def _of_properties(rna: Any, where: str, start: str = "") -> Iterator[tuple[str, str, str]]:
    for prop in rna.properties:
        key = prop.identifier
        if key == "name" and prop.description in _OF_NAMES:
            continue
        if key in _OF_BLENDER or not key.startswith(start) or prop.is_hidden:
            continue
        place = f"{where}.{key}"
        if prop.name == key:  # it has none
            continue
        yield prop.translation_context, prop.name, place
        yield ANY, prop.description, place
        for item in getattr(prop, "enum_items", ()) if prop.type == "ENUM" else ():
            yield prop.translation_context, item.name, f"{place}: {item.identifier}"
            yield ANY, item.description, f"{place}: {item.identifier}"


def _of_sources() -> Iterator[tuple[str, str, str]]:
    """Texts that are written in calls of layouts, and those that are looked up by hand."""
    folder = Path(str(sys.modules[MODULE].__file__)).parent
    for file in sorted(folder.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call):
                where = f"{file.relative_to(folder).as_posix()}:{node.lineno}"
                yield from ((_context(node), text, where) for text in _texts(node))


def _context(call: ast.Call) -> str:
    return OPERATOR if isinstance(call.func, ast.Attribute) and call.func.attr == "operator" else ANY


def _texts(call: ast.Call) -> Iterator[str]:
    name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    if name in {"pgettext", "pgettext_iface", "pgettext_tip", "pgettext_rpt", "words"}:
        yield from _constants(call.args[0])
    is_plain = any(key.arg == "translate" and _is_false(key.value) for key in call.keywords)
    for key in call.keywords:
        if key.arg in _SHOWN and not is_plain and name in _LAYOUT:
            yield from _constants(key.value)


# Functions of layouts that translate what they are given.
_LAYOUT = {"label", "operator", "prop", "prop_enum", "menu", "prop_search", "operator_menu_enum", "progress"}


def _is_false(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value is False


def _constants(node: ast.expr) -> Iterator[str]:
    """The texts that an expression may stand for; `UNTRANSLATABLE` for one with figures in it."""
    if isinstance(node, ast.IfExp):
        yield from _constants(node.body)
        yield from _constants(node.orelse)
    elif isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    elif isinstance(node, ast.JoinedStr):
        yield UNTRANSLATABLE
