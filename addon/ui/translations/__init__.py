# SPDX-License-Identifier: GPL-3.0-or-later
"""The words of the interface in other languages. Reports, figures and problems stay English."""

import bpy

from . import german

# Blender's names of the languages have changed: German was de_DE.
_LANGUAGES = {"de": german.WORDS, "de_DE": german.WORDS}
# Labels of buttons have a context of their own.
_CONTEXTS = ("*", "Operator")


def register() -> None:
    words = {
        language: {
            (context, message): text for message, text in translations.items() for context in _CONTEXTS
        }
        for language, translations in _LANGUAGES.items()
    }
    bpy.app.translations.register(__name__, words)


def unregister() -> None:
    bpy.app.translations.unregister(__name__)
