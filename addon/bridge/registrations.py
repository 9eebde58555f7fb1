# SPDX-License-Identifier: GPL-3.0-or-later
"""Registrations of two surfaces by landmark points or by landmark curves, with morphs and transfers."""

import inspect
from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np

import authalic

from ..messages import problems
from ..registration import elements
from ..registration.curves import check_curves, registered_by_curves
from ..registration.domain import domain, filled_in_words
from ..registration.kept import Kept, fingerprint
from ..registration.piece import check_piece
from ..registration.points import check_landmarks
from ..registration.problems import in_words
from ..registration.pulls import Pulls
from ..registration.registered import Registered, registered_by_points
from ..registration.settings import Settings
from ..registration.sides import CurvePair, PointPair, Side, boundaries, moved
from ..surfaces.arrays import Floats, Reals
from ..surfaces.suitability import Unsuitable
from .patches import cut
from .progress import Progress, keep_going
from .solver import weight

Preview = Callable[[Floats], None]
"""Takes positions of the source's points (u, 3) on the target, in its coordinates, on the way there."""

_registrations = Kept()
_MOST_STRAIN = 1e6  # in place of infinite ones

# The largest size of pieces that keep their shapes, as parts of that of the source.
_RIGID_SIZE = {"AUTO": 0.25, "RIGID": np.inf, "BEND": 0.0}


class MirroredCurves(Unsuitable):
    """The curves fit far better when one surface is mirrored, or when all open ones are reversed."""


def register(
    source: Side,
    target: Side,
    pairs: Sequence[Any],
    settings: Settings,
    progress: Progress = keep_going,
    *,
    pulls: Pulls | None = None,
    preview: Preview | None = None,
) -> Registered:
    """The `Registered` of two `Side`s by pairs (name, source vertex, target vertex).

    By curves the pairs are (name, source vertices, target vertices). A registration that is kept is not
    computed again. `preview` is called on the way, where the library can. When `progress` returns False, the
    result is the best so far. Raises `Unsuitable`, in the words of an artist, if there is none.
    """
    key, settings = fingerprint(source, target, pairs), settings.that_count
    pulls = pulls or Pulls()
    pulled = pulls.fingerprint(settings)
    registered = _registrations.get(key, settings, pulled)
    if registered is None:
        make: Callable[..., Registered] = (
            _registered_by_points if settings.method == "POINTS" else _registered_by_curves
        )
        try:
            registered = make((source, target), pairs, settings, pulls, _Watch(progress, preview))
        except (authalic.MeshError, authalic.SolverError) as error:
            kind = MirroredCurves if error.kind == "mirrored" else Unsuitable
            raise kind(in_words(error, (source, target), pairs)) from error
        _registrations.put(key, settings, pulled, registered)
    _registrations.touch(key, settings, pulled)
    return registered


def kept(
    source: Side,
    target: Side,
    pairs: Sequence[PointPair],
    curves: Sequence[CurvePair] = (),
    method: str | None = None,
) -> Registered | None:
    """The latest registration of these meshes by these pairs or curves in this session, or None.

    With a method, only a registration by that method.
    """
    landmarks: dict[str, Sequence[PointPair] | Sequence[CurvePair]] = {"POINTS": pairs, "CURVES": curves}
    methods = [method] if method else [*landmarks]
    keys = [(fingerprint(source, target, landmarks[method]), method) for method in methods]
    return _registrations.latest(keys)


def morphed(registered: Registered, source: Side, target: Side, align: bool) -> Floats:
    """The places of the source's points (u, 3) in the world: on the target, or with `align` over the source.

    The sides are as they stand now; they may have moved since they were registered.
    """
    if not align:
        return moved(np.asarray(registered.native.positions), target.matrix)
    over = authalic.homotopy(source.points, registered.native, 1.0, align=True)
    return moved(np.asarray(over), source.matrix)


def followed(registered: Registered, source: Side, target: Side, align: bool, how: str) -> Floats:
    """The places in the world of the `followers` that the source leaves out, (k, 3).

    As `morphed` has the places of the source's points. Pieces keep their shapes or bend, as `how` says.
    """
    _, points, pieces = source.rest.followers
    if not len(points):
        return points
    places = np.asarray(registered.native.follow(points, pieces=pieces, rigid_size=_RIGID_SIZE[how]))
    if not align:
        return moved(places, target.matrix)
    positions = np.asarray(registered.native.positions)
    over = np.asarray(authalic.homotopy(source.points, registered.native, 1.0, align=True))
    turn = elements.turn_and_scale(positions, over)
    return moved((places - positions.mean(axis=0)) @ turn.T + over.mean(axis=0), source.matrix)


def pull(
    registered: Registered, values: Reals, per: Literal["vertex", "corner"], smooth: bool = False
) -> Floats:
    """The target's values at the source, `per` "vertex" (u, ...) or "corner" (m, 3, ...).

    With `smooth`, those of vertices without the facets of a target that is coarser than the source.
    """
    values = np.ascontiguousarray(values, float)
    return np.asarray(registered.native.pull(values, per=per, smooth=smooth))


def strain(registered: Registered) -> Floats:
    """The symmetric Dirichlet energy over 4 of each of the source's triangles (m,): 1 for an isometry."""
    return np.minimum(np.asarray(registered.native.strain.symmetric_dirichlet), _MOST_STRAIN)


def local_similarities(registered: Registered) -> Floats:
    """How vectors on the target are turned and scaled on their way to the source's points, (u, 3, 3)."""
    return np.asarray(registered.native.local_similarities())


class _Watch:
    """Who is told about a computation on its way."""

    def __init__(self, progress: Progress, preview: Preview | None) -> None:
        self._progress, self._preview = progress, preview

    def of(self, function: Callable[..., Any]) -> dict[str, Any]:
        """The arguments for a function of the library."""
        watching: dict[str, Any] = {"progress": self._progress}
        if self._preview is not None and "preview" in inspect.signature(function).parameters:
            watching["preview"] = self._preview
        return watching


def _pulled(settings: Settings, pulls: Pulls) -> dict[str, Any]:
    """Arguments of the library for what pulls the energy between the surfaces."""
    options: dict[str, Any] = {"energy": "surface", "position_weight": settings.position_weight}
    if settings.feature:
        options["features"] = tuple(signal[:, None] for signal in pulls.features[settings.feature])
        options["feature_weight"] = settings.feature_weight
    return options


def _registered_by_curves(
    sides: tuple[Side, Side], curves: Sequence[CurvePair], settings: Settings, pulls: Pulls, watch: _Watch
) -> Registered:
    surfaces, patches = zip(*(_in_library(side) for side in sides), strict=True)
    options = _pulled(settings, pulls) if settings.is_pulled else {"energy": "harmonic"}
    make: Any = authalic.register_hyperbolic
    for side, pieces in zip(sides, patches, strict=True):
        check_piece(side, pieces)
    paths = check_curves(sides, curves, [boundaries(pieces) for pieces in patches])
    native = make(
        *surfaces,
        source_curves=paths.source,
        target_curves=paths.target,
        fill_holes=any(paths.holes),
        **options,
        **watch.of(make),
    )
    registered = registered_by_curves(native, sides, curves)
    registered.filled = filled_in_words(sides, paths.holes)
    return registered


def _in_library(side: Side) -> tuple[Any, list[authalic.Patch]]:
    """A side for the library, and its pieces. The registration refuses coordinates that are not finite."""
    try:
        if not np.isfinite(side.points).all():
            return (side.points, side.faces), cut(side.points, side.faces)
        surface = authalic.Surface(side.points, side.faces)
        return surface, surface.cut()
    except authalic.MeshError as error:
        reason = problems.in_words(error, side.polygons, side.vertices)
        raise Unsuitable(f"{side.name}: {reason}") from error


def _registered_by_points(
    sides: tuple[Side, Side], pairs: Sequence[PointPair], settings: Settings, pulls: Pulls, watch: _Watch
) -> Registered:
    surfaces, patches = zip(*(_in_library(side) for side in sides), strict=True)
    common = domain(sides, patches, settings.domain)
    landmarks = check_landmarks(sides, pairs, common, settings)
    make: Any = authalic.register_disks if common.shape == "DISK" else authalic.register_spheres
    native = make(
        *surfaces,
        source_landmarks=landmarks[0],
        target_landmarks=landmarks[1],
        weight=settings.weight,
        **(_of_shapes(settings, pulls) if settings.is_pulled else _of_areas(settings)),
        fill_holes=any(common.holes),
        **watch.of(make),
    )
    names = [name for name, _, _ in pairs]
    registered = registered_by_points(native, sides, common.shape, landmarks, names)
    registered.filled = filled_in_words(sides, common.holes)
    if settings.is_pulled:
        registered.energy = float("nan")
    return registered


def _of_areas(settings: Settings) -> dict[str, Any]:
    return {"energy": "area", "angle_weight": weight(settings.angle_weight)}


def _of_shapes(settings: Settings, pulls: Pulls) -> dict[str, Any]:
    soft = {"weights": pulls.weights} if pulls.is_soft else {}
    return {**_pulled(settings, pulls), **soft}
