# SPDX-License-Identifier: GPL-3.0-or-later
"""Authalic: UVs in which every face has its fair share of the texture."""

from . import ui
from .operators import measure, sphere_shape_key, unwrap

# In this order; unregistered in the reverse one.
_MODULES = (unwrap, sphere_shape_key, measure, ui)


def register():
    for module in _MODULES:
        module.register()


def unregister():
    for module in reversed(_MODULES):
        module.unregister()
