# SPDX-License-Identifier: GPL-3.0-or-later
"""The modules of the extension as installed."""

import importlib
from typing import Any

MODULE = "bl_ext.user_default.authalic"


def part(name: str) -> Any:
    """A module by its name within the extension; looked up anew, since installing again replaces them all."""
    return importlib.import_module(f"{MODULE}.{name}")


def library() -> Any:
    """The package `authalic`, which comes with the extension and is there once that is installed."""
    return importlib.import_module("authalic")
