# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of the last registration, which its source keeps: transfers go by them, also when reopened."""

from dataclasses import fields

from ..blender.types import MeshObject
from ..registration.settings import Settings


def remember(source: MeshObject, settings: Settings) -> None:
    """Keeps the settings of a registration of an object with its target."""
    source.authalic_registered_by = ""
    for field in fields(Settings):
        setattr(source.authalic_registration, field.name, getattr(settings, field.name))


def settings(source: MeshObject) -> Settings | None:
    """The settings of the last registration with the present target, or None.

    Files may hold anything: settings that no registration can have had are none.
    """
    kept = source.authalic_registration
    if kept.method:
        last = Settings(**{field.name: getattr(kept, field.name) for field in fields(Settings)})
        return last if last.are_possible else None
    # Version 0.1.0 registered by areas and kept the method alone.
    last = Settings(method=source.authalic_registered_by, energy="AREA")
    return last if last.are_possible else None
