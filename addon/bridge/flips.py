# SPDX-License-Identifier: GPL-3.0-or-later
"""UV maps without flipped faces, by moving as few UVs as possible."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

import authalic

from .. import messages
from ..messages import problems
from ..surfaces import suitability, uv_map
from ..surfaces.arrays import Booleans, Floats, Integers, Singles
from ..surfaces.suitability import Unsuitable
from ..surfaces.surface import Surface
from .patches import checked, cut
from .progress import NOT_REACHED, Progress, keep_going, one_by_one
from .results import Refusal, Unflipped

# The kinds of errors that say that the outline, pins or shared UVs leave no way out; their indices are faces.
_NO_WAY_OUT = {"fixed_fold", "outline_fold", "still_folded"}


def fix_flips(surfaces: Sequence[Surface], progress: Progress = keep_going) -> Unflipped:
    """Finds UVs without flipped faces for the islands of `surfaces`, moving as few as possible.

    Outlines, pinned UVs and UVs that other faces share stay. Islands that cannot be unfolded so are refused,
    not raised, as are all that come after `progress` has returned False.
    """
    result = Unflipped()
    tangles = [tangle for index in range(len(surfaces)) for tangle in _tangles(surfaces, index, result)]
    one_by_one(tangles, lambda tangle, step: _unflip(tangle, result, step), result, progress)
    return result


@dataclass
class _Tangle:
    """An island of a UV map in which faces may be flipped, with arrays as in `uv_map.UvMap`."""

    name: str
    index: int
    patch: authalic.Patch
    points: Floats
    uv: Singles
    corners: Integers
    polygons: Integers
    vertices: Integers
    pinned: Booleans
    shared: Booleans

    @property
    def polygon(self) -> int:
        return int(self.polygons[0])


def _tangles(surfaces: Sequence[Surface], index: int, result: Unflipped) -> Iterator[_Tangle]:
    """The islands of a surface's UV map whose faces wind both ways, or have no area."""
    surface = surfaces[index]
    joined = uv_map.joined(surface)
    if not uv_map.may_be_flipped(joined.faces, joined.uv):
        return
    try:
        patches = cut(joined.points, joined.faces)
    except authalic.MeshError as error:
        reason = problems.in_words(error, joined.polygons, joined.vertices)
        result.refusals.append(Refusal(surface.name, None, reason))
        return
    for patch in patches:
        points, uv = np.asarray(patch.vertex_of), joined.uv[patch.vertex_of]
        if uv_map.may_be_flipped(np.asarray(patch.faces), uv):
            yield _Tangle(
                name=surface.name,
                index=index,
                patch=patch,
                points=joined.points[points],
                uv=uv,
                corners=joined.corners[patch.face_of],
                polygons=joined.polygons[patch.face_of],
                vertices=joined.vertices[points],
                pinned=joined.pinned[points],
                shared=joined.shared[points],
            )


def _unflip(tangle: _Tangle, result: Unflipped, progress: Progress) -> None:
    """Adds the UVs with which an island has no flipped faces to an `Unflipped`."""
    faces = np.asarray(tangle.patch.faces)
    suitability.check_flat(tangle.patch)
    native = checked(tangle.patch, tangle.points)
    authalic.distortion(native, tangle.uv)  # raises if the mesh is at fault
    untangled = _untangled(tangle, native, result, progress)
    folded = np.asarray(untangled.folded_before)
    if len(folded) == 0:  # only normals were inconsistent
        return
    uv = np.asarray(untangled.image).astype(np.float32)
    if not _is_unfolded(native, uv):
        raise Unsuitable("its faces would flip again in UV precision; scale the island up or unwrap it anew")
    moved = (uv != tangle.uv).any(axis=1)
    write = moved[faces] & (tangle.corners >= 0)
    result.writes.append((tangle.index, tangle.corners[write], uv[faces[write]]))
    result.faces += len(np.unique(tangle.polygons[folded]))
    result.islands += 1
    result.moved += int(np.count_nonzero(moved & (tangle.vertices >= 0)))


def _untangled(
    tangle: _Tangle, native: authalic.Surface, result: Unflipped, progress: Progress
) -> authalic.Untangled:
    fixed = np.flatnonzero(tangle.pinned | tangle.shared)
    try:
        return authalic.untangle(native, tangle.uv, fixed=fixed, progress=progress)
    except (authalic.MeshError, authalic.SolverError) as problem:
        if result.ended_early:
            raise Unsuitable(NOT_REACHED) from problem
        if problem.kind not in _NO_WAY_OUT:
            raise
        flipped = np.unique(tangle.polygons[np.array(problem.indices, int)])
        raise Unsuitable(_why_not(flipped, bool(tangle.pinned.any()), bool(tangle.shared.any()))) from problem


def _why_not(polygons: Integers, has_pins: bool, is_partial: bool) -> str:
    """Why polygons (k,) stay flipped, and what to do. `is_partial`: the island is only partly selected."""
    faces = f"{messages.count(len(polygons), 'face')} ({messages.numbers(polygons)})"
    pins = " and pinned UVs" if has_pins else ""
    remedies = [
        *(["select the faces around as well"] if is_partial else []),
        *(["unpin UVs"] if has_pins else []),
        "smooth the outline there or unwrap the island again",
    ]
    return (
        f"{faces if len(polygons) else 'its faces'} cannot be turned without moving its outline{pins}; "
        f"{', '.join(remedies)}"
    )


def _is_unfolded(native: authalic.Surface, uv: Singles) -> bool:
    """Whether no face of an image, or of its mirror image, is folded; the answer is exact."""
    images = [uv * np.array([side, 1], np.float32) for side in (1, -1)]
    return any(not len(authalic.distortion(native, image).folded) for image in images)
