# SPDX-License-Identifier: GPL-3.0-or-later
"""Authalic: UVs that preserve areas, and morphs between meshes."""

from typing import Any

from .ui import restart

_MODULES: tuple[Any, ...] = restart.MODULES
if not restart.is_needed():
    # Only now, because this imports the native library.
    from .ui import modules

    _MODULES = modules.MODULES


def register() -> None:
    for module in _MODULES:
        module.register()


def unregister() -> None:
    for module in reversed(_MODULES):
        module.unregister()
