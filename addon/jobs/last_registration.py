# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of the last registration, which its source keeps: transfers go by them, also when reopened."""

from dataclasses import fields

from ..blender.types import MeshObject
from ..registration.settings import Settings


def remember(source: MeshObject, settings: Settings) -> None:
    """Keeps the settings of a registration of an object with its target."""
    for field in fields(Settings):
        setattr(source.authalic_registration, field.name, getattr(settings, field.name))


def settings(source: MeshObject) -> Settings | None:
    """The settings of the last registration with the present target, or None."""
    kept = source.authalic_registration
    if not kept.method:
        return None
    return Settings(**{field.name: getattr(kept, field.name) for field in fields(Settings)})
