# SPDX-License-Identifier: MIT OR Apache-2.0
"""The methods of the comparison: which tool, on which kind of mesh, and the call.

A call takes vertices (n, 3) and faces (m, 3) and returns a `Map`. It uses the tool as the tool's own
documentation says; `prepare` imports the tool, outside the measured time.
"""

import importlib
from dataclasses import dataclass
from typing import Callable, Optional

import numpy as np


@dataclass
class Map:
    """An image (n, 2) or (n, 3), the cut mesh if the tool cuts it, and a remark."""

    image: np.ndarray
    remark: str = ""
    vertices: Optional[np.ndarray] = None
    faces: Optional[np.ndarray] = None
    seconds: Optional[float] = None
    """The seconds, if not those of the whole call."""


@dataclass(frozen=True)
class Method:
    """A row of the table; `package` names the package that it needs ("bpy": it runs in Blender)."""

    name: str
    kinds: tuple
    package: str
    modules: tuple
    call: Callable
    family: str

    def prepare(self):
        """Imports the modules that the call needs."""
        for module in self.modules:
            importlib.import_module(module)


def authalic_map(function, **options):
    """One of this package's maps."""

    def call(vertices, faces):
        import authalic

        result = getattr(authalic, function)(vertices, faces, **options)
        image = result.uv if function == "disk_map" else result.positions
        return Map(image, f"{result.status}, {result.iterations} iterations")

    return call


def libigl_slim(iterations):
    """Symmetric Dirichlet energy, free boundary, from the start of `disk_start`."""

    def call(vertices, faces):
        import igl

        scaled, start, remark = disk_start(vertices, faces)
        column = np.asfortranarray
        data = igl.slim_precompute(
            column(scaled), column(faces.astype(np.int32)), column(start),
            igl.MappingEnergyType.SYMMETRIC_DIRICHLET, np.zeros(0, np.int32), column(np.zeros((0, 2))), 0.0,
        )  # fmt: skip
        return Map(igl.slim_solve(data, iterations), remark)

    return call


def libigl_arap(iterations):
    """As rigid as possible, free boundary; one vertex is held, as the system has no translation."""

    def call(vertices, faces):
        import igl

        scaled, start, remark = disk_start(vertices, faces)
        data, held = igl.ARAPData(), np.zeros(1, np.int32)
        data.max_iter = iterations
        igl.arap_precomputation(scaled, faces, 2, held, data)
        return Map(igl.arap_solve(start[held], data, np.ascontiguousarray(start)), remark)

    return call


def disk_start(vertices, faces):
    """The mesh scaled to the disk's area, and its harmonic map to the circle, or Tutte's if that folds."""
    import igl

    scaled = vertices * np.sqrt(2 * np.pi / igl.doublearea(vertices, faces).sum())
    loop = igl.boundary_loop(faces)
    circle = igl.map_vertices_to_circle(np.asfortranarray(scaled), loop.astype(np.int32))
    harmonic = igl.harmonic(scaled, faces, loop, np.ascontiguousarray(circle), 1)
    if (signed_areas(harmonic, faces) > 0).all():
        return scaled, harmonic, "start: harmonic map to the circle"
    return scaled, tutte(faces, loop, circle, len(vertices)), "start: Tutte's map to the circle"


def tutte(faces, loop, circle, count):
    """Every inner vertex at the mean of its neighbors, the loop on the circle: (count, 2)."""
    from scipy.sparse import coo_matrix, diags
    from scipy.sparse.linalg import spsolve

    i, j = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).T
    adjacency = coo_matrix((np.ones(2 * len(i)), (np.r_[i, j], np.r_[j, i])), (count, count)).tocsr()
    adjacency.data[:] = 1.0
    laplacian = (diags(np.asarray(adjacency.sum(axis=1)).ravel()) - adjacency).tocsr()
    image = np.zeros((count, 2))
    image[loop] = circle
    inner = np.setdiff1d(np.arange(count), loop)
    image[inner] = spsolve(laplacian[inner][:, inner].tocsc(), -laplacian[inner][:, loop] @ circle)
    return image


def signed_areas(uv, faces):
    """The signed areas of the faces of a plane map, (m,)."""
    a, b = uv[faces[:, 1]] - uv[faces[:, 0]], uv[faces[:, 2]] - uv[faces[:, 0]]
    return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2


def xatlas_atlas(vertices, faces):
    """The atlas with xatlas' own options; it cuts the mesh into charts."""
    import xatlas

    atlas = xatlas.Atlas()
    atlas.add_mesh(vertices.astype(np.float32), faces.astype(np.uint32))
    atlas.generate()
    source, faces, uv = atlas[0]
    uv = uv.astype(float) * [atlas.width, atlas.height]  # it scales both axes to 1
    charts = f"cut into {atlas.chart_count} charts"
    return Map(uv, charts, vertices[source], faces.astype(np.int64))


def lapy_map(module, function):
    """One of lapy's maps of closed meshes."""

    def call(vertices, faces):
        from lapy import TriaMesh

        return Map(getattr(importlib.import_module(module), function)(TriaMesh(vertices, faces)))

    return call


def lapy_corrected(vertices, faces):
    """The conformal map, then the Möbius transformation with the least area distortion."""
    from lapy import TriaMesh, conformal

    mesh = TriaMesh(vertices, faces)
    return Map(conformal.mobius_area_correction_spherical(mesh, conformal.spherical_conformal_map(mesh))[0])


def lapy_spectral(vertices, faces):
    """The first three eigenfunctions, projected; lapy wants the mesh long from front to back."""
    from lapy import TriaMesh, diffgeo

    axes = np.linalg.svd(vertices - vertices.mean(axis=0), full_matrices=False)[2][[2, 0, 1]]
    axes[0] *= np.linalg.det(axes)
    projected = diffgeo.tria_spherical_project(TriaMesh(vertices @ axes.T, faces))
    return Map(np.asarray(projected.v))


def blender_unwrap(method, **options):
    """Blender's operator on the whole mesh, without seams."""

    def call(vertices, faces):
        from bench import blender

        image, seconds = blender.unwrapped(vertices, faces, method, **options)
        return Map(image, seconds=seconds)

    return call


def _ours(name, function, family="the papers' methods", **options):
    kind = "disk" if function == "disk_map" else "sphere"
    call = authalic_map(function, **options)
    return Method(name, (kind,), "authalic", ("authalic",), call, family)


def _blender(name, method, **options):
    call = blender_unwrap(method, **options)
    return Method(name, ("disk",), "bpy", ("bench.blender",), call, "Blender")


def _lapy(name, module, call=None):
    call = call or lapy_map(module, name.split()[-1])
    return Method(name, ("sphere",), "lapy", (module,), call, "lapy")


def _libigl(name, call):
    return Method(name, ("disk",), "libigl", ("igl", "scipy.sparse.linalg"), call, "libigl")


OURS = "authalic"
PAPER = {"boundary": "arc_length", "max_iterations": 50}
METHODS = (
    _ours(OURS, "disk_map", "ours"),
    _ours("authalic fixed_point 50", "disk_map", method="fixed_point", **PAPER),
    _ours("authalic conjugate_gradient 50", "disk_map", method="conjugate_gradient", **PAPER),
    _libigl("libigl SLIM 10", libigl_slim(10)),
    _libigl("libigl SLIM 50", libigl_slim(50)),
    _libigl("libigl ARAP 10", libigl_arap(10)),
    _libigl("libigl ARAP 100", libigl_arap(100)),
    _blender("Blender ABF", "ANGLE_BASED"),
    _blender("Blender Minimum Stretch 10", "MINIMUM_STRETCH", no_flip=True, iterations=10),
    _blender("Blender Minimum Stretch 50", "MINIMUM_STRETCH", no_flip=True, iterations=50),
    _ours(OURS, "sphere_map", "ours"),
    _ours("authalic fixed_point", "sphere_map", method="fixed_point"),
    _ours("authalic gradient_descent 100", "sphere_map", method="gradient_descent", max_iterations=100),
    _lapy("lapy spherical_conformal_map", "lapy.conformal"),
    _lapy("lapy mobius_area_correction_spherical", "lapy.conformal", lapy_corrected),
    _lapy("lapy spherical_tutte_map", "lapy.conformal"),
    _lapy("lapy tria_spherical_project", "lapy.diffgeo", lapy_spectral),
    Method("xatlas", ("disk", "sphere"), "xatlas", ("xatlas",), xatlas_atlas, "xatlas"),
)
"""All methods, in the order of the tables."""


def of_kind(kind, words=()):
    """The methods for "disk" or "sphere"; with words, only methods that one of them names."""
    wanted = [method for word in words for method in METHODS if method.name in called(word)]
    return [method for method in METHODS if kind in method.kinds and (not words or method in wanted)]


def called(word):
    """The names that a word stands for: itself if it is a name, else all names that contain it."""
    names = list(dict.fromkeys(method.name for method in METHODS))
    return [word] if word in names else [name for name in names if word.casefold() in name.casefold()]


def named(name, kind):
    """The method with exactly this name."""
    return next(method for method in METHODS if method.name == name and kind in method.kinds)
