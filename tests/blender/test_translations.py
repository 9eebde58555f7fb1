# SPDX-License-Identifier: GPL-3.0-or-later
"""The German translation: complete, and used by Blender."""

import re
from typing import Any

import bpy
import pytest
import words
from installed import part

LOCALES = ("de", "de_DE")


def german() -> dict[str, str]:
    return dict(part("ui.translations.german").WORDS)


def test_no_word_is_missing_and_none_is_left_over() -> None:
    used = {message: where for (_, message), where in words.all_words().items()}
    assert len(used) > 200
    translated = {form for message in german() for form in part("ui.translations").forms(message)}
    missing = {message: where for message, where in used.items() if message not in translated}
    assert not missing, "\n".join(f"{where}: {message!r}" for message, where in missing.items())
    left_over = [
        message for message in german() if not used.keys() & {*part("ui.translations").forms(message)}
    ]
    assert not left_over


def test_every_translation_says_something() -> None:
    for message, translation in german().items():
        assert translation.strip() == translation != ""
        assert not translation.endswith(".") or message.endswith("."), translation
        assert sorted(re.findall(r"\{[^}]*\}", message)) == sorted(re.findall(r"\{[^}]*\}", translation))


@pytest.fixture
def in_german() -> Any:
    """Blender in German, where it has the language."""
    view: Any = bpy.context.preferences.view
    before = view.language, view.use_translate_interface, view.use_translate_tooltips
    names = view.bl_rna.properties["language"].enum_items_static.keys()
    locale = next((name for name in LOCALES if name in names), None)
    if locale is None:
        pytest.skip("this Blender has no German")
    try:
        view.language = locale
    except TypeError:
        pytest.skip("this Blender has no languages")
    view.use_translate_interface = view.use_translate_tooltips = True
    yield locale
    view.language, view.use_translate_interface, view.use_translate_tooltips = before


def test_blender_finds_the_words(in_german: str) -> None:
    find = bpy.app.translations
    assert find.locale == in_german
    assert find.pgettext_iface("Wrap onto Target", "Operator") == german()["Wrap onto Target"]
    assert find.pgettext_iface("Angle Weight") == german()["Angle Weight"] != "Angle Weight"
    assert find.pgettext_tip("Select at least one mesh object") == "Select at least one mesh object"


def test_unregistering_takes_the_words_away(in_german: str, extension: str) -> None:
    bpy.ops.preferences.addon_disable(module=extension)
    assert bpy.app.translations.pgettext_iface("Wrap onto Target", "Operator") == "Wrap onto Target"
    bpy.ops.preferences.addon_enable(module=extension)
    assert bpy.app.translations.pgettext_iface("Wrap onto Target", "Operator") != "Wrap onto Target"
