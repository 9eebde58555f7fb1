# SPDX-License-Identifier: GPL-3.0-or-later
"""Authalic: UVs in which every face has its fair share of the texture, and morphs between meshes."""

from .blender import scene_changes
from .landmarks import curves as landmark_curves
from .landmarks import points as landmarks
from .operators import fix_flips, landmark_files, landmark_pick, measure, sphere_shape_key, transfer, unwrap
from .operators import landmark_curves as curve_operators
from .operators import landmarks as landmark_operators
from .operators import register as register_operator
from .overlay import curves as curve_markers
from .overlay import points as markers
from .ui import landmarks as ui_landmarks
from .ui import unwrap as ui

# In this order; unregistered in the reverse one.
_MODULES = (
    scene_changes,
    landmark_curves,
    landmarks,
    markers,
    curve_markers,
    unwrap,
    fix_flips,
    sphere_shape_key,
    measure,
    landmark_operators,
    curve_operators,
    landmark_pick,
    landmark_files,
    register_operator,
    transfer,
    ui,
    ui_landmarks,
)


def register():
    for module in _MODULES:
        module.register()


def unregister():
    for module in reversed(_MODULES):
        module.unregister()
