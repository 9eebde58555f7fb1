# SPDX-License-Identifier: GPL-3.0-or-later
"""The words of the interface in other languages. Reports, figures and problems stay English."""

import re
from collections.abc import Iterable

import bpy

from . import german

# Blender's names of the languages have changed: German was de_DE.
_LANGUAGES = {"de": german.WORDS, "de_DE": german.WORDS}
# Labels of buttons have a context of their own.
_CONTEXTS = ("*", "Operator")


def forms(message: str) -> Iterable[str]:
    """A message as it is and, for Python before 3.13, with the indents that it has as a docstring."""
    return dict.fromkeys((message, re.sub(r"\n(?=[^\n])", "\n    ", message)))


def register() -> None:
    words = {
        language: {
            (context, form): text
            for message, text in translations.items()
            for form in forms(message)
            for context in _CONTEXTS
        }
        for language, translations in _LANGUAGES.items()
    }
    bpy.app.translations.register(__name__, words)


def unregister() -> None:
    bpy.app.translations.unregister(__name__)
