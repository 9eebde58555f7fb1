# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors and warnings of the library as sentences for an artist, made from their data. No bpy.

The library's own messages are not read: each kind of error and of warning has its sentence here.
"""

from collections.abc import Sequence
from typing import Protocol

from . import count as counted
from . import elements
from .elements import Index, Numbers

_REPORT = "is the fault of Authalic itself ({its.kind}); please report it with the mesh"
FLIP = "flip the normals of one (Mesh > Normals > Flip)"

ERRORS = {
    # The mesh
    "no_vertices": "has no vertices",
    "no_faces": "has no faces",
    "too_many_faces": "has too many faces; simplify it or split it",
    "not_finite": "NaN or infinite coordinates at {its.vertices}: repair or remove them",
    "index_out_of_range": _REPORT,
    "repeated_vertex": "the same vertex twice in {its.faces}: remove these degenerate faces",
    "duplicate_face": "{its.faces} on the vertices of another face: remove the duplicates",
    "zero_area": (
        "no area in {its.faces}: the corners lie on a line; remove these faces (Mesh > Clean Up > Degenerate "
        "Dissolve)"
    ),
    "non_manifold_edge": (
        "more than two faces at {its.edges}: delete the inner faces there, or mark these edges as seams"
    ),
    "non_manifold_vertex": "parts that touch only in a point, at {its.vertices}: split these vertices",
    "not_orientable": "is one-sided, like a Moebius strip; mark seams across it, as at {its.edges}",
    "loose_vertex": "{its.vertices} without a face: delete loose geometry",
    "several_components": "consists of {its.count} pieces where one is allowed; separate it by loose parts",
    "closed_surface": "is closed; mark seams to cut it open, or unwrap it with Seams set to Automatic",
    "open_surface": "has a boundary, as at {its.vertices}, but a sphere has none; fill its holes",
    "handles": (
        "has handles, like a torus; close them up, mark seams to cut them open, or unwrap it with Seams set "
        "to Automatic"
    ),
    "several_boundaries": (
        "has {its.count} boundaries; turn on Fill Holes, mark seams to join them, or unwrap it with Seams "
        "set to Automatic"
    ),
    "seam_not_edge": _REPORT,
    # Options and arrays, which the extension should get right
    "invalid_array": _REPORT,
    "invalid_option": _REPORT,
    "invalid_density": _REPORT,
    "initial_boundary": _REPORT,
    "initial_sphere": _REPORT,
    "no_direction": _REPORT,
    # Maps
    "map_not_finite": "NaN or infinite UVs at {its.vertices}: unwrap these faces again",
    "no_rectangle": "its boundary fits onto no rectangle; set Outline to Free",
    "fixed_fold": "{its.faces} cannot be unfolded, because vertices around them stay; unpin some",
    "outline_fold": "{its.faces} cannot be unfolded without moving the outline; unwrap them again",
    "still_folded": "{its.faces} could not be unfolded; smooth the outline there or unwrap them again",
    "layout_fold": (
        "{its.triangles} would fold over when its sphere is laid flat; set Seams to Automatic, or try "
        "another Pole Axis or Angle Weight"
    ),
    "no_embedding": (
        "no map without folds was found in double precision, left over: {its.faces}; cut the long thin parts "
        "there open by seams, or remesh them"
    ),
    "factorization_failed": (
        "is too badly conditioned; dissolve its slivers (Mesh > Clean Up > Degenerate Dissolve)"
    ),
    "out_of_memory": "has too many vertices for the memory that is free; close other programs or decimate it",
    "cancelled": "cancelled before there was a map without folds; let it run longer",
    "internal": _REPORT,
    # Landmark points
    "landmark_counts": "has landmarks without a partner; remove them or pick their partners",
    "too_few_landmarks": "needs more landmark pairs; add vertices that belong together",
    "repeated_landmark": "{its.landmarks} on a vertex that has a landmark already; remove one of them",
    "landmark_on_boundary": "{its.landmarks} on the boundary, which becomes a circle; pick vertices inside",
    # Landmark curves
    "curve_counts": "give a partner to {its.unpaired}, or leave it out",
    "no_curves": "a landmark curve is needed; select edges that belong together on both and add them",
    "short_curve": "{its.curve} is too short: it needs at least two edges; lengthen it, or subdivide there",
    "curve_off_edges": "{its.curve} leaves the edges of the mesh between {its.vertices}: add it again",
    "curve_meets_itself": "{its.curve} meets itself at {its.vertices}: remove the crossing",
    "curves_meet": (
        "{its.curves} meet at {its.vertices}: shorten or move one, so that they have no vertex in common"
    ),
    "curve_on_boundary": (
        "{its.curve} meets the boundary at {its.vertices}: end it inside, or make it a closed curve along "
        "the whole boundary"
    ),
    "curve_not_closed": "{its.curve} is open, but its partner is closed: close it, or open both",
    "curve_bounds_one_side": (
        "{its.curve} runs along a boundary, but its partner lies inside the other surface: delete the faces "
        "that the partner encloses, or fill the hole"
    ),
    "curve_sides": (
        "{its.curve} lies inside the closed {its.second_curve} here, but outside on the other surface: "
        "move it, or check the order of the curves"
    ),
    "curve_divides": "{its.curve} is closed and divides the surface: open it, or delete one side",
    "loop_counts": "the surfaces have different numbers of open boundaries: fill the holes without a partner",
    "loop_sides": (
        "the closed {its.curve} has different numbers of open boundaries inside it on the two surfaces: "
        "fill the holes without a partner"
    ),
    "too_few_features": "needs at least three curves and boundaries: add curves",
    "mirrored": (
        "the curves fit far better when one surface is mirrored: mirror one (Object > Mirror), or check the "
        "order of the curves"
    ),
    "uncuttable_curve": (
        "the surface cannot be cut open along {its.curve}, which touches itself or another: move it"
    ),
    "no_arc": "no path joins {its.curve} to the next without touching a curve: subdivide the mesh there",
    "no_hyperbolic_metric": "the faces are too thin at {its.faces}: dissolve the slivers there or remesh",
}

WARNINGS = {
    "opposite_normals": f"the surfaces face opposite ways, so the map mirrors one: {FLIP}",
    "backward_curve": ("{its.curve} fits far better in reverse: reverse its path on one of the surfaces"),
    "uncertain_winding": (
        "the curves move too far to tell how the surface between them follows: it may wind around them more "
        "than intended"
    ),
    "strained": (
        "the map is strained, its energy is {its.value:.1f} times that of the surface itself (1.0 to 1.2 is "
        "usual): check that curves with the same name belong together and run the same way"
    ),
    "distorted": (
        "{its.percent:.0f} % of the surface is stretched or squeezed more than tenfold: limbs far from all "
        "curves are loosely held; give them curves or closed rings of their own"
    ),
}


class Problem(Protocol):
    """The data of an error or a warning of the library."""

    @property
    def kind(self) -> str: ...
    @property
    def side(self) -> str | None: ...
    @property
    def curve(self) -> int | None: ...
    @property
    def second_curve(self) -> int | None: ...
    @property
    def indices(self) -> Sequence[Index]: ...
    @property
    def count(self) -> int: ...


def in_words(
    problem: Problem,
    polygons: Numbers | None = None,
    vertices: Numbers | None = None,
    names: Sequence[str] = (),
) -> str:
    """The sentence for an error or a warning; the library's message where its kind is not known here.

    `polygons` (m,) and `vertices` (n,) are the numbers in the mesh of the library's faces and vertices, -1
    for those that the mesh does not have; `names` are those of the landmarks or curves.
    """
    sentence = (ERRORS | WARNINGS).get(problem.kind)
    return sentence.format(its=_Terms(problem, polygons, vertices, names)) if sentence else str(problem)


class _Terms:
    """The terms that the sentence for a problem may name."""

    def __init__(
        self,
        problem: Problem,
        polygons: Numbers | None,
        vertices: Numbers | None,
        names: Sequence[str],
    ) -> None:
        self.kind, self.count, self._problem = problem.kind, problem.count, problem
        self._polygons, self._vertices, self._names = polygons, vertices, names

    @property
    def faces(self) -> str:
        return elements.phrase("face", self._problem.indices, self.count, self._polygons)

    @property
    def triangles(self) -> str:
        return counted(self.count, "triangle")

    @property
    def vertices(self) -> str:
        return elements.phrase("vertex", self._problem.indices, self.count, self._vertices)

    @property
    def edges(self) -> str:
        return elements.phrase("edge", self._problem.indices, self.count, self._vertices)

    @property
    def curve(self) -> str:
        return self._listed("curve", [self._problem.curve])

    @property
    def second_curve(self) -> str:
        return self._listed("curve", [self._problem.second_curve])

    @property
    def curves(self) -> str:
        return self._listed("curve", [self._problem.curve, self._problem.second_curve])

    @property
    def unpaired(self) -> str:
        return self._listed("curve", _plain(self._problem.indices))

    @property
    def landmarks(self) -> str:
        return self._listed("landmark", _plain(self._problem.indices))

    @property
    def value(self) -> float:
        return float(getattr(self._problem, "value", None) or 0)

    @property
    def percent(self) -> float:
        return 100 * self.value

    def _listed(self, noun: str, numbers: Sequence[int | None]) -> str:
        """The noun with some of the names, or numbers where there are none; a boundary is no curve."""
        known = [number for number in numbers if number is not None]
        if not known:
            return "a boundary"
        named = [f'"{self._names[n]}"' if n < len(self._names) else str(n) for n in known]
        joined = " and ".join(named) if len(named) < 3 else ", ".join(named)
        return f"{noun if len(named) == 1 else noun + 's'} {joined}"


def _plain(indices: Sequence[Index]) -> list[int]:
    """Indices that are no edges."""
    return [index for index in indices if isinstance(index, int)]
