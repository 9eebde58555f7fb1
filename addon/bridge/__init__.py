# SPDX-License-Identifier: GPL-3.0-or-later
"""The only module that talks to the native library: plain data in, plain data out, no bpy.

`unwrap`, `folds`, `measure`, `fix_flips`, `sphere_shape`, `register`, `kept`, `morphed` and `pull` are
ordinary functions on numpy arrays.
"""

from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

import authalic

from .. import messages
from ..registration import curves as curve_registering
from ..registration import points as registering
from ..sphere_layout import projection
from ..surfaces import polygons, spherical, triangulation
from ..surfaces import suitability as domains
from ..surfaces import uv_map as flips
from ..surfaces.suitability import Unsuitable
from .results import Island, Mapping, Measurement, Refusal, Shortfall, SphereShape, Unflipped, UnwrapSettings
from .solver import Solver, weight

__all__ = (
    "Island",
    "Mapping",
    "Measurement",
    "Refusal",
    "Shortfall",
    "Solver",
    "SphereShape",
    "Unflipped",
    "Unsuitable",
    "UnwrapSettings",
    "fix_flips",
    "folds",
    "kept",
    "measure",
    "morphed",
    "pull",
    "register",
    "sphere_shape",
    "unwrap",
)

# Standard deviations of area ratios that are bad: on a disk where areas count, on a sphere, where large
# polygons leave more, and with any weight of angles. A mean angle distortion that is bad.
_UNEVEN_DISK, _UNEVEN_SPHERE, _UNEVEN = 0.1, 0.5, 1.0
_SHEARED = 20.0
_CUT = "cut its long parts open by seams"
_NOT_FREE = f"set Outline to Free, or {_CUT}"
_OF_A_SPHERE = "try another Layout, mark seams that cut its long parts open, or poke large n-gons"
_OF_A_KEY = "its limbs may be too long or too thin, or its n-gons too large (poke them)"
# Where the slider has to stand for shapes that a layout of the sphere does not fold.
_FIT_TO_LAY_FLAT = 0.9
_NOT_REACHED = "was not reached before the end"
_registrations = registering.Kept()


def _keep_going(_fraction, _message):
    return True


def unwrap(surfaces, settings, progress=_keep_going):
    """Maps every island of every surface (`mesh_io.Surface`) to UVs of its own, by a disk or by a sphere.

    When `progress` returns False the island at hand is kept as it is by then, and later ones are refused.
    Islands that cannot be mapped are refused, not raised.
    """
    result = Mapping()
    pieces = [piece for index in range(len(surfaces)) for piece in _pieces(surfaces, index, result)]

    def mapped(piece, step):
        result.islands.append(_map(piece, settings, step))

    _one_by_one(pieces, mapped, result, progress)
    return result


def fix_flips(surfaces, progress=_keep_going):
    """Finds UVs without flipped faces for the islands of `surfaces`, moving as few as it can.

    Outlines, pinned UVs and UVs that other faces share stay. Islands that this leaves no way out are refused,
    not raised, as are all that come after `progress` has returned False.
    """
    result = Unflipped()
    tangles = [tangle for index in range(len(surfaces)) for tangle in _tangles(surfaces, index, result)]
    _one_by_one(tangles, lambda tangle, step: _unflip(tangle, result, step), result, progress)
    return result


def folds(island):
    """Whether a face of an island is folded over, exactly, in UVs of single precision as Blender has them."""
    try:
        figures = authalic.distortion(island.points, island.faces, island.uv.astype(np.float32).astype(float))
    except authalic.MeshError:  # the whole island has shrunk to a line or a point
        return True
    return len(figures.folded) > 0


def measure(surfaces):
    """Figures of the UVs of `surfaces`, all on one scale; None where no triangle has an area."""
    points = np.concatenate([surface.positions[surface.triangles] for surface in surfaces])
    image = np.concatenate([surface.uv[surface.corners] for surface in surfaces])
    good = triangulation.has_area(points) & np.isfinite(image).all(axis=(1, 2))
    points, image = points[good], image[good]
    if not triangulation.signed_areas(image.astype(float)).any():
        return None
    # With the UV islands in one piece the library turns faces of inconsistent normals by itself.
    first, faces = triangulation.welded(_vertices(surfaces)[good], image)
    corner_points, corner_image = points.reshape(-1, 3)[first], image.reshape(-1, 2)[first]
    figures = authalic.distortion(corner_points, faces, corner_image.astype(float))
    log2 = np.clip(figures.log2_area_ratio, -polygons.LOG2_LIMIT, polygons.LOG2_LIMIT)
    log2[figures.folded] = -polygons.LOG2_LIMIT
    unfolded = np.ones(len(log2), bool)
    unfolded[figures.folded] = False
    angles = figures.angle_distortion[unfolded]
    spread = [_spread(good, values) for values in (log2, triangulation.areas(points), ~unfolded)]
    return Measurement(
        triangles=len(log2),
        mean=float(figures.area_ratio_mean),
        deviation=float(figures.area_ratio_std),
        log2_min=float(log2.min()),
        log2_max=float(log2.max()),
        flips=len(figures.folded),
        angle=float(angles.mean()) if len(angles) else float("inf"),
        without_area=int(np.count_nonzero(~good)),
        log2=polygons.log2_area_ratios(surfaces, *spread),
    )


def sphere_shape(surface, solver=None, progress=_keep_going):
    """The vertices of a closed mesh (`mesh_io.Surface`) on the sphere of its area, about its area's centre.

    When `progress` returns False, as they are by then. Raises `Unsuitable`, in the words of an artist, where
    there is no such map.
    """
    solver = solver or Solver()
    mesh = triangulation.sound(surface)
    vertices = np.append(np.arange(len(surface.positions)), np.full(len(mesh.positions), -1))
    try:
        used, patches = _whole(mesh)
        domains.check_closed_mesh(used, len(surface.positions), patches)
        found, positions, turned = _sphere_map(mesh.positions, mesh.triangles, solver, progress)
    except (authalic.MeshError, authalic.SolverError) as error:
        raise Unsuitable(messages.in_mesh_terms(str(error), mesh.polygons, vertices)) from error
    centre = spherical.centroid(mesh.positions, mesh.triangles)
    radius = spherical.radius(mesh.positions, mesh.triangles)
    written = (centre + radius * positions).astype(np.float32)
    faces = np.where(turned[:, None], mesh.triangles[:, ::-1], mesh.triangles)
    if spherical.volume(mesh.positions, faces) < 0:
        faces = faces[:, ::-1]
    figures = authalic.distortion(mesh.positions, faces, written - centre)
    if len(figures.folded):
        raise Unsuitable(
            f"{messages.count(len(figures.folded), 'triangle')} would fold over in the precision of "
            "coordinates; remesh its thin parts"
        )
    return SphereShape(
        positions=written[: len(surface.positions)],
        radius=float(radius),
        deviation=float(figures.area_ratio_std),
        flips=len(figures.folded),
        angle=float(figures.angle_distortion_mean),
        shortfall=_shortfall(found.status, figures, solver, _UNEVEN_SPHERE, _OF_A_KEY),
        ended_early=found.status == "cancelled",
    )


def register(source, target, pairs, settings, progress=_keep_going):
    """The `registering.Registered` of two `Side`s by pairs (name, source vertex, target vertex).

    By curves the pairs are (name, source vertices, target vertices). One that was made before is not made
    again. When `progress` returns False, as it is by then. Raises `Unsuitable`, in the words of an artist,
    where there is none.
    """
    key, settings = registering.key(source, target, pairs), settings.that_count
    found = _registrations.get(key, settings)
    if found is None:
        make = _registered if settings.method == "POINTS" else _registered_by_curves
        try:
            found = make(source, target, pairs, settings, progress)
        except (authalic.MeshError, authalic.SolverError) as error:
            message = registering.in_mesh_terms(str(error), source, target)
            if settings.method == "CURVES":
                message = curve_registering.in_words(message, (source, target), pairs)
            raise Unsuitable(message) from error
        _registrations.put(key, settings, found)
    _registrations.touch(key, settings)
    return found


def kept(source, target, pairs, curves=(), method=None):
    """The latest registration of these meshes by these pairs or by these curves in this session, or None.

    With a method, one of that alone.
    """
    methods = [("POINTS", pairs), ("CURVES", curves)]
    methods = [one for one in methods if method in (None, one[0])]
    return _registrations.latest([(registering.key(source, target, own), method) for method, own in methods])


def morphed(registered, source, target, align):
    """Where the source's points (u, 3) go in the world: onto the target, with `align` laid over the source.

    The sides are those of today, which may have moved since they were registered.
    """
    if not align:
        return registering.moved(np.asarray(registered.native.positions), target.matrix)
    over = authalic.homotopy(source.points, registered.native, 1.0, align=True)
    return registering.moved(np.asarray(over), source.matrix)


def pull(registered, values, per):
    """The target's values as those of the source, `per` "vertex" (u, ...) or per "corner" (m, 3, ...)."""
    return np.asarray(registered.native.pull(np.ascontiguousarray(values, float), per=per))


def _registered_by_curves(source, target, curves, _settings, progress):
    sides = source, target
    patches = [_patches(one) for one in sides]
    for one, part in zip(sides, patches, strict=True):
        registering.check_piece(one, part)
    paths = curve_registering.check_curves(sides, curves, [registering.boundaries(part) for part in patches])
    native = authalic.register_hyperbolic(
        *((one.points, one.faces) for one in sides),
        source_curves=paths[0],
        target_curves=paths[1],
        progress=progress,
    )
    return curve_registering.registered(native, sides, curves)


def _patches(one):
    """The pieces of a side; a bad coordinate is for the solver to name."""
    return authalic.cut(np.nan_to_num(one.points, posinf=0, neginf=0), one.faces)


def _registered(source, target, pairs, settings, progress):
    sides = source, target
    patches = [_patches(one) for one in sides]
    shape = registering.domain(sides, patches, settings.domain)
    borders = [np.concatenate([np.empty(0, int), *registering.boundaries(part)]) for part in patches]
    landmarks = registering.check_landmarks(sides, pairs, shape, borders)
    make = authalic.register_disks if shape == "DISK" else authalic.register_spheres
    native = make(
        *((one.points, one.faces) for one in sides),
        source_landmarks=landmarks[0],
        target_landmarks=landmarks[1],
        weight=settings.weight,
        angle_weight=weight(settings.angle_weight),
        progress=progress,
    )
    return registering.registered(native, sides, shape, landmarks, [name for name, _, _ in pairs])


def _whole(mesh):
    """The vertices (u,) that have triangles, and the pieces that these make up."""
    used, faces = np.unique(mesh.triangles, return_inverse=True)
    # A bad coordinate is for the solver to name.
    points = np.nan_to_num(mesh.positions[used], posinf=0, neginf=0)
    return used, authalic.cut(points, faces.reshape(-1, 3))


@dataclass
class _Piece:
    """A patch of a surface, with what leads back from its numbers to those of the mesh."""

    name: str
    index: int
    patch: object
    points: np.ndarray
    corners: np.ndarray
    polygons: np.ndarray
    vertices: np.ndarray
    pinned: bool

    @property
    def polygon(self):
        return int(self.polygons[0])


def _one_by_one(pieces, do, result, progress):
    """Calls `do(piece, progress)` for every piece; one that it raises for is refused in the result."""
    total = sum(len(piece.polygons) for piece in pieces)
    done = 0
    listen = _noting_the_end(progress, result)
    for number, piece in enumerate(pieces):
        share = len(piece.polygons)
        message = f"Island {number + 1} of {len(pieces)}"
        if result.ended_early or not listen(done / total, message):
            result.refusals.append(Refusal(piece.name, piece.polygon, _NOT_REACHED))
            continue
        step = _sub_progress(listen, done / total, share / total, message)
        try:
            do(piece, step)
        except (Unsuitable, authalic.MeshError, authalic.SolverError) as error:
            reason = messages.in_mesh_terms(str(error), piece.polygons, piece.vertices)
            result.refusals.append(Refusal(piece.name, piece.polygon, reason))
        done += share


def _pieces(surfaces, index, result):
    """The islands of a surface; one that cannot be cut at all is refused as a whole."""
    surface = surfaces[index]
    mesh = triangulation.sound(surface)
    used, faces = np.unique(mesh.triangles, return_inverse=True)
    faces, points = faces.reshape(-1, 3), mesh.positions[used]
    number = np.full(len(mesh.positions), -1)
    number[used] = np.arange(len(used))
    # The centre of a divided polygon is no vertex of the mesh.
    vertices = np.where(used < len(surface.positions), used, -1)
    try:
        # An island with a bad coordinate is refused by itself when its turn comes.
        patches = authalic.cut(np.nan_to_num(points, posinf=0, neginf=0), faces, seams=number[surface.seams])
    except authalic.MeshError as error:
        reason = messages.in_mesh_terms(str(error), mesh.polygons, vertices)
        result.refusals.append(Refusal(surface.name, None, reason))
        return
    for patch in patches:
        corners = mesh.corners.ravel()[np.asarray(patch.corner_of).ravel()]
        yield _Piece(
            name=surface.name,
            index=index,
            patch=patch,
            points=points[patch.vertex_of],
            corners=corners,
            polygons=mesh.polygons[patch.face_of],
            vertices=vertices[patch.vertex_of],
            pinned=bool(surface.pinned is not None and surface.pinned[corners[corners >= 0]].any()),
        )


@dataclass
class _Tangle:
    """An island of a UV map in which faces may be flipped; arrays as those of `flips.Layout`."""

    name: str
    index: int
    patch: object
    points: np.ndarray
    uv: np.ndarray
    corners: np.ndarray
    polygons: np.ndarray
    vertices: np.ndarray
    pinned: np.ndarray
    shared: np.ndarray

    @property
    def polygon(self):
        return int(self.polygons[0])


def _tangles(surfaces, index, result):
    """The islands of a surface's UV map whose faces wind both ways, or have no area."""
    surface = surfaces[index]
    layout = flips.layout(surface)
    if not flips.may_be_flipped(layout.faces, layout.uv):
        return
    try:
        # A bad coordinate is for the island's own turn.
        patches = authalic.cut(np.nan_to_num(layout.points, posinf=0, neginf=0), layout.faces)
    except authalic.MeshError as error:
        reason = messages.in_mesh_terms(str(error), layout.polygons, layout.vertices)
        result.refusals.append(Refusal(surface.name, None, reason))
        return
    for patch in patches:
        points, uv = np.asarray(patch.vertex_of), layout.uv[patch.vertex_of]
        if flips.may_be_flipped(np.asarray(patch.faces), uv):
            yield _Tangle(
                name=surface.name,
                index=index,
                patch=patch,
                points=layout.points[points],
                uv=uv,
                corners=layout.corners[patch.face_of],
                polygons=layout.polygons[patch.face_of],
                vertices=layout.vertices[points],
                pinned=layout.pinned[points],
                shared=layout.shared[points],
            )


def _unflip(tangle, result, progress):
    """Adds what an island needs to have no flipped faces to an `Unflipped`."""
    faces = np.asarray(tangle.patch.faces)
    domains.check_flat(tangle.patch)
    authalic.distortion(tangle.points, faces, tangle.uv.astype(float))  # raises where the mesh is at fault
    found = _untangled(tangle, faces, result, progress)
    folded = np.asarray(found.folded_before)
    if len(folded) == 0:  # only normals that are inconsistent
        return
    uv = np.asarray(found.image).astype(np.float32)
    if not _is_unfolded(tangle.points, faces, uv):
        raise Unsuitable("its faces would flip again in UV precision; scale the island up or unwrap it anew")
    moved = (uv != tangle.uv).any(axis=1)
    write = moved[faces] & (tangle.corners >= 0)
    result.writes.append((tangle.index, tangle.corners[write], uv[faces[write]]))
    result.faces += len(np.unique(tangle.polygons[folded]))
    result.islands += 1
    result.moved += int(np.count_nonzero(moved & (tangle.vertices >= 0)))


def _untangled(tangle, faces, result, progress):
    fixed = np.flatnonzero(tangle.pinned | tangle.shared)
    image = tangle.uv.astype(float)
    try:
        return authalic.untangle((tangle.points, faces), image, fixed=fixed, progress=progress)
    except (authalic.MeshError, authalic.SolverError) as problem:
        if result.ended_early:
            raise Unsuitable(_NOT_REACHED) from problem
        flipped = np.unique(tangle.polygons[list(problem.indices)]) if problem.indices is not None else ()
        raise Unsuitable(flips.why_not(flipped, tangle.pinned.any(), tangle.shared.any())) from problem


def _is_unfolded(points, faces, uv):
    """Whether no face is folded over, exactly, in an image or in its mirror image."""
    images = [uv.astype(float) * [side, 1] for side in (1, -1)]
    return any(not len(authalic.distortion(points, faces, image).folded) for image in images)


def _map(piece, settings, progress):
    """The UVs of one island, counter-clockwise as most of its faces are wound."""
    if piece.pinned:
        raise Unsuitable("has pinned UVs, which would have to move; unpin them first")
    to = _by_disk if domains.choose(piece.patch, settings) == "DISK" else _by_sphere
    return to(piece, settings, progress)


def _by_disk(piece, settings, progress):
    faces = np.asarray(piece.patch.faces)
    found = _disk_map(piece.points, faces, settings, progress)
    turned = spherical.turned(faces, np.asarray(found.faces))
    island = _island(piece, np.array(found.uv), faces, turned, np.arange(len(piece.points)))
    remedy = _CUT if settings.solver.is_free else _NOT_FREE
    island.shortfall = _shortfall(found.status, found.distortion, settings.solver, _UNEVEN_DISK, remedy)
    island.may_turn = settings.solver.is_free
    return island


def _disk_map(points, faces, settings, progress):
    options = {"fill_holes": settings.fill_holes, "progress": progress}
    return authalic.disk_map(points, faces, **options, **settings.solver.disk_options())


def _by_sphere(piece, settings, progress):
    """By the sphere map asked for, or by one with better shapes where its faces are too thin to lay flat."""
    try:
        return _laid_flat(piece, settings, settings.solver, progress)
    except projection.CannotProject as problem:
        if settings.solver.method == "GAUSS_NEWTON" and settings.solver.angle_weight < _FIT_TO_LAY_FLAT:
            with suppress(projection.CannotProject):
                solver = replace(settings.solver, angle_weight=_FIT_TO_LAY_FLAT, area_tolerance=0.0)
                return _laid_flat(piece, settings, solver, progress)
        raise Unsuitable(
            f"{messages.count(problem.count, 'triangle')} would fold over when its sphere is laid flat; try "
            "another Layout, Pole Axis or Angle Weight, poke its n-gons, subdivide the mesh or mark seams"
        ) from problem


def _laid_flat(piece, settings, solver, progress):
    faces = np.asarray(piece.patch.faces)
    found, positions, turned = _sphere_map(piece.points, faces, solver, progress)
    uv = projection.project(
        positions,
        np.where(turned[:, None], faces[:, ::-1], faces),
        polygons=piece.polygons,
        areas=triangulation.areas(piece.points[faces]),
        movable=piece.vertices >= 0,
        layout=settings.layout,
        axis=settings.pole_axis,
        seam=settings.seam_direction,
    )
    uv = np.where(turned[:, None, None], uv[:, ::-1], uv)
    first, corner_point = triangulation.welded(faces, uv)
    island = _island(piece, uv.reshape(-1, 2)[first], corner_point, turned, faces.ravel()[first])
    figures = authalic.distortion(island.points, island.faces, island.uv)
    island.shortfall = _shortfall(found.status, figures, solver, _UNEVEN_SPHERE, _OF_A_SPHERE)
    return island


def _sphere_map(points, faces, solver, progress):
    """A sphere map, its positions laid over the surface, and which faces (m,) it has turned over."""
    found = authalic.sphere_map(points, faces, progress=progress, **solver.sphere_options())
    is_poor = found.status == "stalled" and solver.puts_areas_first
    if is_poor or _is_thin(found):  # coarse meshes may come out worse than the start
        start = authalic.sphere_map(points, faces, method="fixed_point", max_iterations=0)
        found = min(found, start, key=lambda map_: (_is_thin(map_), map_.distortion.authalic_energy))
    oriented = np.asarray(found.faces)
    over = spherical.over_surface(points, oriented, np.array(found.positions))
    return found, over, spherical.turned(faces, oriented)


def _is_thin(found):
    return spherical.is_thin(np.asarray(found.positions), np.asarray(found.faces))


def _island(piece, uv, faces, turned, points):
    """An `Island` of the piece's points (n,) with UVs (n, 2), its triangles `faces` between these."""
    real = piece.corners >= 0
    return Island(
        name=piece.name,
        surface=piece.index,
        polygon=piece.polygon,
        points=piece.points[points],
        faces=faces,
        corners=piece.corners[real],
        corner_point=faces.ravel()[real],
        uv=uv,
        turned=np.unique(piece.polygons[turned]),
    )


def _shortfall(status, figures, solver, uneven, remedy):
    """The `Shortfall` of a map by its figures; None where it has converged to what its weight leaves.

    `uneven` is a deviation of area ratios that is bad where areas count.
    """
    deviation, angle = float(figures.area_ratio_std), float(figures.angle_distortion_mean)
    limit = max(uneven, min(_UNEVEN, _UNEVEN_DISK + solver.area_tolerance + np.sqrt(solver.weight) / 2))
    is_uneven, is_sheared = bool(deviation > limit), bool(angle > _SHEARED)
    if not is_uneven and not is_sheared and status in {"converged", "cancelled"}:
        return None
    return Shortfall(status, deviation, angle, is_uneven, is_sheared, remedy)


def _noting_the_end(progress, result):
    """The progress callback, which also notes in a `Mapping` that it was asked to end."""

    def listen(fraction, message):
        result.ended_early |= progress(fraction, message) is False
        return not result.ended_early

    return listen


def _sub_progress(progress, start, share, name):
    """A part of the whole as a progress callback of its own."""
    return lambda fraction, message: progress(start + share * fraction, f"{name}: {message}")


def _vertices(surfaces):
    """The vertices of the triangles of all surfaces, (t, 3), numbered on from one surface to the next."""
    starts = np.cumsum([0, *(len(surface.positions) for surface in surfaces)])
    return np.concatenate([s.triangles + start for s, start in zip(surfaces, starts[:-1], strict=True)])


def _spread(good, values):
    """Values of some triangles as values of all, 0 for the others."""
    result = np.zeros(len(good), values.dtype)
    result[good] = values
    return result
