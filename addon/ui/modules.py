# SPDX-License-Identifier: GPL-3.0-or-later
"""All modules that register something with Blender, in this order; they unregister in reverse."""

from ..blender import places, scene_changes
from ..landmarks import curves as landmark_curves
from ..landmarks import last_registration, mask, stored
from ..landmarks import points as landmark_points
from ..operators import couples as operators_of_couples
from ..operators import fix_flips as operator_fix_flips
from ..operators import heat_map as operator_heat_map
from ..operators import landmark_curves as operators_of_curves
from ..operators import landmark_files as operators_of_files
from ..operators import landmark_pick as operator_pick
from ..operators import landmark_points as operators_of_points
from ..operators import live as operator_live
from ..operators import mark_seams as operator_mark_seams
from ..operators import measure as operator_measure
from ..operators import merge_by_distance as operator_merge_by_distance
from ..operators import redo as operator_redo
from ..operators import register as operator_register
from ..operators import seam_preview as operator_seam_preview
from ..operators import select_reported as operator_select_reported
from ..operators import sphere_shape_key as operator_sphere_shape_key
from ..operators import texel_density as operator_texel_density
from ..operators import transfer as operator_transfer
from ..operators import unwrap as operator_unwrap
from ..operators import wrap_options
from ..overlay import curves as overlay_curves
from ..overlay import heat_map as overlay_heat_map
from ..overlay import points as overlay_points
from ..overlay import preview as overlay_preview
from ..overlay import seams as overlay_seams
from . import couple as ui_couple
from . import curves as ui_curves
from . import distortion as ui_distortion
from . import keymap, manual, menus, preferences, translations
from . import landmarks as ui_landmarks
from . import register as ui_register
from . import unwrap as ui_unwrap

MODULES = (
    scene_changes,
    places,
    stored,
    landmark_curves,
    landmark_points,
    last_registration,
    mask,
    overlay_heat_map,  # under the others
    overlay_points,
    overlay_curves,
    overlay_seams,
    overlay_preview,
    operator_redo,
    operator_unwrap,
    operator_live,
    operator_mark_seams,
    operator_seam_preview,
    operator_fix_flips,
    operator_select_reported,
    operator_sphere_shape_key,
    operator_measure,
    operator_heat_map,
    operator_texel_density,
    operators_of_couples,
    operator_merge_by_distance,
    operators_of_points,
    operators_of_curves,
    operator_pick,
    operators_of_files,
    wrap_options,
    operator_register,
    operator_transfer,
    ui_unwrap,
    ui_distortion,
    ui_couple,
    ui_landmarks,
    ui_curves,
    ui_register,
    menus,
    keymap,
    manual,
    preferences,
    translations,
)
