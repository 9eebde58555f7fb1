# SPDX-License-Identifier: GPL-3.0-or-later
"""Which shape an island is mapped onto, or why none, in the words of an artist. Plain logic, no bpy."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from .. import messages
from . import coincident
from .arrays import Floats, Integers

# What cuts open whatever can be cut open.
_AUTOMATIC = "set Seams to Automatic"


class Patch(Protocol):
    """The topology of a piece of a surface, as `authalic.Patch` has it."""

    @property
    def genus(self) -> int | None: ...
    @property
    def is_closed(self) -> bool: ...
    @property
    def boundary_loops(self) -> Sequence[Integers]: ...
    @property
    def vertex_of(self) -> Integers: ...


class Unsuitable(Exception):
    """A surface has no map of the wanted kind; the message says why and what to do about it."""


class Unjoined(Unsuitable):
    """A surface has vertices that lie on each other; merging them joins its faces."""


def choose(patch: Patch, domain: str, fill_holes: bool) -> str:
    """ "DISK" or "SPHERE", by the topology of an island and the wanted one, which may be "AUTO"."""
    check_sides(patch)
    if domain == "SPHERE" and not patch.is_closed:
        raise Unsuitable(
            "has a boundary, but a sphere has none; clear its seams, fill its holes or set Domain to "
            "Automatic"
        )
    if domain == "DISK" and patch.is_closed:
        if patch.genus:
            automatic = f"has {handles(patch)}, which Seams set to Automatic cuts open, and"
            raise Unsuitable(f"{automatic} is closed; mark seams to cut it open")
        remedy = f"set Domain to Automatic or Sphere, or {_AUTOMATIC}"
        raise Unsuitable(f"is closed; mark seams to cut it open, or {remedy}")
    if patch.genus:
        closed = "is closed and " if patch.is_closed else ""
        raise Unsuitable(
            f"{closed}has {handles(patch)}, like a torus; mark seams to cut it open, or {_AUTOMATIC}"
        )
    if patch.is_closed:
        return "SPHERE"
    if len(patch.boundary_loops) > 1 and not fill_holes:
        raise Unsuitable(
            f"has {len(patch.boundary_loops)} boundaries; turn on Fill Holes, mark seams to join them, or "
            f"{_AUTOMATIC}"
        )
    return "DISK"


def check_sides(patch: Patch) -> None:
    """Raises `Unsuitable` if an island is one-sided."""
    if patch.genus is None:
        raise Unsuitable("is one-sided, like a Moebius strip; mark seams across it")


def check_flat(patch: Patch) -> None:
    """Raises `Unsuitable` unless there can be UVs of an island without flipped faces."""
    if patch.genus is None:
        raise Unsuitable("is one-sided, like a Moebius strip; mark seams across it and unwrap it")
    if patch.is_closed or patch.genus > 0:
        kind = "closed" if patch.is_closed else "not flat"
        raise Unsuitable(
            f"is {kind} in its UV map, where faces must overlap; mark seams and unwrap it, or unwrap it with "
            "Seams set to Automatic"
        )


def handles(patch: Patch) -> str:
    return "a handle" if patch.genus == 1 else f"{patch.genus} handles"


def check_closed_mesh(used: Integers, points: Floats, count: int, patches: Sequence[Patch]) -> None:
    """Raises `Unsuitable` unless a mesh is one closed surface without handles.

    `used` (u,) are the vertices that have faces, of the mesh's `count` and of centers beyond these, all of
    which are `points` (n, 3); `patches` are the pieces that the mesh is cut into without seams.
    """
    loose = np.setdiff1d(np.arange(count), used)
    if len(loose):
        raise Unsuitable(
            f"has {messages.count(len(loose), 'loose vertex')} without a face ({messages.numbers(loose)}); "
            "delete loose geometry"
        )
    check_one_piece(points[used], patches)
    patch = patches[0]
    if patch.genus is None:
        raise Unsuitable("is one-sided, like a Klein bottle, and has no map onto a sphere; remesh it")
    if not patch.is_closed:
        check_joined(points[used], patches)
        holes = messages.count(len(patch.boundary_loops), "open boundary")
        raise Unsuitable(f"has {holes}, but a sphere has none; fill the holes first")
    if patch.genus > 0:
        raise Unsuitable(
            f"has {handles(patch)}, like a torus, but a sphere has none; close it up or remesh it"
        )


def check_one_piece(points: Floats, patches: Sequence[Patch]) -> None:
    """Raises `Unsuitable` unless vertices with faces, at `points` (u, 3), are in one patch, none twice."""
    if sum(len(patch.vertex_of) for patch in patches) > len(points):
        raise Unsuitable(
            "has edges or vertices where surfaces meet that should be apart; separate them or delete inner "
            "faces (Select > All by Trait > Non Manifold shows them)"
        )
    if len(patches) > 1:
        check_joined(points, patches)
        raise Unsuitable(
            f"consists of {len(patches)} pieces where one is allowed; separate it by loose parts"
        )


def check_joined(points: Floats, patches: Sequence[Patch]) -> None:
    """Raises `Unsuitable` if boundary vertices lie on each other: faces that touch, but are not joined.

    Vertices with faces are at `points` (u, 3).
    """
    loops = [np.asarray(patch.vertex_of)[loop] for patch in patches for loop in patch.boundary_loops]
    border = np.unique(np.concatenate([np.empty(0, int), *loops]))
    first = coincident.stands_for(points[border], coincident.distance(points))
    doubles = int((np.bincount(first, minlength=1)[first] > 1).sum())
    if doubles:
        raise Unjoined(
            f"has {messages.count(doubles, 'vertex')} that lie on each other, but are not joined; join them "
            "(Mesh > Merge > By Distance)"
        )
