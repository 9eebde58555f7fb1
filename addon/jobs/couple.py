# SPDX-License-Identifier: GPL-3.0-or-later
"""The two objects of a registration, read and checked."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import bpy
import numpy as np

from .. import messages
from ..blender import editability, meshes, places, shape_keys, signals, vertex_groups
from ..blender.types import Landmark, LandmarkCurve, MeshObject, is_mesh
from ..landmarks import curves as landmark_curves
from ..landmarks import points as landmark_points
from ..landmarks.curves import Curve
from ..landmarks.objects import active_source, target_problem
from ..landmarks.points import Pair
from ..registration import elements
from ..registration.pulls import Pulls
from ..registration.settings import Settings
from ..registration.sides import CurvePair, PointPair, Side, side
from ..surfaces.arrays import Booleans, Floats, Path
from ..surfaces.surface import Surface

# The weight from which on vertices are masked.
_MASKED = 0.5


class CannotRegister(Exception):
    """There is no registration, or nowhere to write it; nothing was changed."""


@dataclass
class Couple:
    """The two objects, both surfaces as they were read and as sides of a registration, and the landmarks.

    `pairs` are those of points, `curves` those of curves, `problems` for either method what is wrong with its
    pairs. `to_source` is the matrix (4, 4) from the world into the source's space, `pulls` what counts beside
    exact landmarks.
    """

    source: MeshObject
    target: MeshObject
    surfaces: tuple[Surface, Surface]
    sides: tuple[Side, Side]
    pairs: list[PointPair]
    curves: list[CurvePair]
    problems: dict[str, list[str]]
    to_source: Floats
    pulls: Pulls = field(default_factory=Pulls)

    def landmarks(self, method: str) -> list[PointPair] | list[CurvePair]:
        """The pairs that a method goes by. Raises `CannotRegister` where they are not sound."""
        if self.problems[method]:
            raise CannotRegister(messages.listed(self.problems[method]))
        return self.pairs if method == "POINTS" else self.curves

    def check_feature(self, settings: Settings) -> None:
        """Raises `CannotRegister` unless both objects have the feature of some settings, and it varies."""
        name = settings.that_count.feature
        if not name:
            return
        if name not in self.pulls.features:
            both = f"{self.source.name} and {self.target.name}"
            raise CannotRegister(f'{both} do not both have the vertex group or attribute "{name}"')
        for each, signal in zip(self.sides, self.pulls.features[name], strict=True):
            bad = each.vertices[~np.isfinite(signal) & (each.vertices >= 0)]
            if len(bad):
                noun = "vertex" if len(bad) == 1 else "vertices"
                raise CannotRegister(
                    f'"{name}" is NaN or infinite at {noun} {messages.numbers(bad)} of {each.name}; '
                    "repair its values there"
                )
            if not np.ptp(signal) > 0:
                raise CannotRegister(f'"{name}" is the same all over {each.name}, and so tells nothing')


def chosen(context: bpy.types.Context, feature: str = "") -> Couple:
    """The `Couple` of the active object and its target; raises `CannotRegister` where there is none."""
    return of_source(active_source(context), feature)


def of_source(source: MeshObject | None, feature: str = "") -> Couple:
    """The `Couple` of an object and its target; raises `CannotRegister` where there is none.

    It has the signal of a feature, and that of the last registration.
    """
    if not is_mesh(source):
        raise CannotRegister("The active object is no mesh")
    target = source.authalic_target
    problem = target_problem(source)
    if problem or target is None:
        raise CannotRegister(f"{source.name}: {problem}")
    for obj in (source, target):
        _check(obj)
    if reason := editability.why_not_mesh(source):
        raise CannotRegister(f"{source.name}: {reason}")
    surfaces = shape_keys.read(source), shape_keys.read(target)
    matrices = np.array(source.matrix_world), np.array(places.home(target))
    points, curves = landmark_points.pairs(source), landmark_curves.pairs(source)
    on_source: list[Path] = [(pair.source_vertex,) for pair in points]
    on_target: list[Path] = [(pair.target_vertex,) for pair in points]
    on_source += [curve.source.vertices for curve in curves]
    on_target += [curve.target.vertices for curve in curves]
    sides = (
        side(surfaces[0], matrices[0], _masked(source), on_source),
        side(surfaces[1], matrices[1], _masked(target), on_target),
    )
    _check_rest(sides)
    pulls = Pulls(
        weights=[landmark.weight if landmark.is_soft else np.inf for landmark in source.authalic_landmarks],
        features=_features((source, target), sides, {feature, source.authalic_registration.feature}),
    )
    return Couple(
        source=source,
        target=target,
        surfaces=surfaces,
        sides=sides,
        pairs=[pair[:3] for pair in points],
        curves=[(curve.name, curve.source.vertices, curve.target.vertices) for curve in curves],
        problems={"POINTS": _problems("Landmark", points), "CURVES": _problems("Curve", curves)},
        to_source=np.linalg.inv(matrices[0]),
        pulls=pulls,
    )


def check_unchanged(couple: Couple) -> None:
    """Meshes and landmarks may have changed since they were read, where a window was alive meanwhile."""
    for obj, surface in zip((couple.source, couple.target), couple.surfaces, strict=True):
        is_there = meshes.has_corners(obj, len(surface.corner_vertex))
        if not is_there or len(obj.data.vertices) != len(surface.positions):
            raise CannotRegister(f"{surface.name} has changed meanwhile; nothing was written")
    counts = [len(couple.pairs), len(couple.curves)]
    if [len(listed) for listed in pair_lists(couple.source)] != counts:
        raise CannotRegister("The landmarks have changed meanwhile; nothing was written")


def pair_lists(source: MeshObject) -> tuple[list[Landmark], list[LandmarkCurve]]:
    """The lists of points and of curves."""
    return list(source.authalic_landmarks), list(source.authalic_landmark_curves)


def _features(
    objects: tuple[MeshObject, MeshObject], sides: tuple[Side, Side], names: set[str]
) -> dict[str, tuple[Floats, Floats]]:
    """The named signals at the points of both sides; those that both objects have."""
    found = {}
    for name in names - {""}:
        on_source, on_target = (signals.read(obj, name) for obj in objects)
        if on_source is not None and on_target is not None:
            found[name] = (
                elements.by_points(sides[0], on_source[:, None])[:, 0],
                elements.by_points(sides[1], on_target[:, None])[:, 0],
            )
    return found


def _masked(obj: MeshObject) -> Booleans:
    """Which vertices (n,) the mask of an object leaves out."""
    name = obj.authalic_mask
    if name and name not in vertex_groups.names(obj):
        raise CannotRegister(f'{obj.name} has no vertex group "{name}"; choose its mask again')
    return vertex_groups.weights(obj, name) >= _MASKED


def _check_rest(sides: Sequence[Side]) -> None:
    for each in sides:
        if not len(each.faces):
            raise CannotRegister(f"{each.name} has no faces without masked vertices; paint a smaller mask")
    followers, points, _ = sides[0].rest.followers
    bad = np.sort(followers[~np.isfinite(points).all(axis=1)])
    if len(bad):
        raise CannotRegister(
            f"{sides[0].name}: NaN or infinite coordinates at {'vertex' if len(bad) == 1 else 'vertices'} "
            f"{messages.numbers(bad)}: repair or remove them"
        )


def _check(obj: MeshObject) -> None:
    if obj.data.is_editmode:
        raise CannotRegister(f"{obj.name} is in Edit Mode; leave that first")
    if not meshes.has_faces(obj):
        raise CannotRegister(f"{obj.name} has no faces")
    scale = np.abs(np.linalg.svd(np.array(obj.matrix_world)[:3, :3], compute_uv=False))
    if not scale.min() > 1e-9 * scale.max():
        raise CannotRegister(f"{obj.name} has a scale of zero along an axis; clear its scale")


def _problems(kind: str, pairs: Sequence[Pair] | Sequence[Curve]) -> list[str]:
    return [f'{kind} "{pair.name}": {pair.problem}' for pair in pairs if pair.problem]
