# SPDX-License-Identifier: GPL-3.0-or-later
"""What to do about a map that is uneven or sheared: only what can help there. Plain logic, no bpy."""

from ..surfaces import triangulation
from ..surfaces.arrays import Integers
from .settings import UnwrapSettings
from .solver import PRESETS

_ADD_SEAMS, _AUTOMATIC = "set Seams to Add", "set Seams to Automatic"


def of_disk(settings: UnwrapSettings) -> tuple[str, str]:
    """What helps an island that is uneven, and one that is sheared."""
    solver = settings.solver
    seams = _ADD_SEAMS if settings.seams is None else "lower the Shear of the seams"
    if solver.method != "GAUSS_NEWTON":
        return "set Method to Gauss-Newton", seams
    if not solver.is_free:
        return "set Outline to Free", "set Outline to Free"
    is_soft = solver.angle_weight > PRESETS["EVEN"] and not solver.area_tolerance
    return "choose the preset Even" if is_soft else seams, seams


def of_layout(settings: UnwrapSettings, polygons: Integers) -> tuple[str, str]:
    """What helps a closed island, after both layouts; `polygons` (m,) are those of its faces."""
    is_free = settings.solver.method == "GAUSS_NEWTON"
    even = _AUTOMATIC if is_free else "set Method to Gauss-Newton"
    return even + _or_poke(polygons), _AUTOMATIC


def of_sphere(polygons: Integers) -> tuple[str, str]:
    """What helps a map onto the sphere, which knows no seams."""
    limbs = "its limbs may be too long or too thin for a sphere"
    return limbs + _or_poke(polygons), limbs


def _or_poke(polygons: Integers) -> str:
    """More to do where there are large n-gons among polygons (m,)."""
    has_large = triangulation.has_large_polygon(polygons[polygons >= 0])
    return ", or poke its large n-gons (Face > Poke Faces)" if has_large else ""
