# SPDX-License-Identifier: GPL-3.0-or-later
"""The modules of the extension as installed."""

import importlib
from typing import Any

MODULE = "bl_ext.user_default.authalic"


def part(name: str) -> Any:
    """The extension's module of this name; looked up anew, since installing again replaces them all."""
    return importlib.import_module(f"{MODULE}.{name}")


def library() -> Any:
    """The package `authalic`, which is installed with the extension."""
    return importlib.import_module("authalic")
