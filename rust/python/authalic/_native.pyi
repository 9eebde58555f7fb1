# SPDX-License-Identifier: MIT OR Apache-2.0
"""Types of the native module, whose own docstrings document it."""

from collections.abc import Callable, Iterable, Sequence
from os import PathLike
from typing import Any, Literal, Protocol, Self, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import disjoint_base

from ._warnings import RegistrationWarning

__all__ = [
    "ERROR_KINDS",
    "WARNING_KINDS",
    "Certificates",
    "DiskMap",
    "Distortion",
    "HyperbolicStructure",
    "Layout",
    "MeshError",
    "Packing",
    "Pants",
    "Patch",
    "Refinement",
    "Registration",
    "Repaired",
    "Result",
    "Seams",
    "SolverError",
    "SphereMap",
    "Strain",
    "Surface",
    "Untangled",
    "Unwrap",
    "__version__",
    "_fields",
    "_restored",
    "cut",
    "disk_map",
    "disk_maps",
    "distortion",
    "distortions",
    "homotopy",
    "hyperbolic_structure",
    "pack",
    "register_disks",
    "register_hyperbolic",
    "register_spheres",
    "repair",
    "seams",
    "set_threads",
    "sphere_map",
    "stretch_hessian",
    "untangle",
    "unwrap",
]

_Reals: TypeAlias = NDArray[np.float64]
_Indices: TypeAlias = NDArray[np.int64]
_Complex: TypeAlias = NDArray[np.complex128]
_Progress: TypeAlias = Callable[[float, str], bool | None]

class _FacesMesh(Protocol):
    """A mesh as trimesh has it, with vertices and faces, also those of VTK in their layout beside points."""

    @property
    def faces(self) -> Any: ...

class _TrianglesMesh(Protocol):
    """A mesh as Open3D has it."""

    @property
    def vertices(self) -> Any: ...
    @property
    def triangles(self) -> Any: ...

class _CellsMesh(Protocol):
    """A mesh as meshio has it."""

    @property
    def points(self) -> Any: ...
    @property
    def cells_dict(self) -> Any: ...

_Handle: TypeAlias = Surface | Patch | Repaired | _FacesMesh | _TrianglesMesh | _CellsMesh
_Surface: TypeAlias = _Handle | tuple[ArrayLike, ArrayLike]
_Side: TypeAlias = Literal["source", "target"] | None
_Status: TypeAlias = Literal["converged", "max_iterations", "stalled", "cancelled"]

__version__: str
ERROR_KINDS: dict[str, str]
WARNING_KINDS: dict[str, str]

class MeshError(ValueError):
    kind: str
    side: _Side
    curve: int | None
    second_curve: int | None
    indices: tuple[int, ...] | tuple[tuple[int, ...], ...]
    count: int

class SolverError(RuntimeError):
    kind: str
    side: _Side
    curve: int | None
    second_curve: int | None
    indices: tuple[int, ...] | tuple[tuple[int, ...], ...]
    count: int

@disjoint_base
class Result:
    @property
    def provenance(self) -> dict[str, Any] | None: ...
    def save(self, path: str | PathLike[str]) -> None: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, _memo: object, /) -> Self: ...
    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]: ...
    def _repr_html_(self) -> str: ...

@final
class Surface(Result):
    def __new__(
        cls, vertices: ArrayLike | _Handle, faces: ArrayLike | None = None, *, flat: bool = False
    ) -> Self: ...
    @property
    def vertices(self) -> _Reals: ...
    @property
    def faces(self) -> _Indices: ...
    @property
    def n_vertices(self) -> int: ...
    @property
    def n_faces(self) -> int: ...
    @property
    def n_components(self) -> int: ...
    @property
    def euler_characteristic(self) -> int: ...
    @property
    def genus(self) -> int: ...
    @property
    def boundary_loops(self) -> list[_Indices]: ...
    @property
    def is_disk(self) -> bool: ...
    @property
    def is_closed(self) -> bool: ...
    def cut(self, *, seams: ArrayLike | None = None) -> list[Patch]: ...

@final
class Patch(Result):
    @property
    def surface(self) -> Surface: ...
    @property
    def vertices(self) -> _Reals: ...
    @property
    def faces(self) -> _Indices: ...
    @property
    def vertex_of(self) -> _Indices: ...
    @property
    def corner_of(self) -> _Indices: ...
    @property
    def face_of(self) -> _Indices: ...
    @property
    def euler_characteristic(self) -> int: ...
    @property
    def genus(self) -> int | None: ...
    @property
    def boundary_loops(self) -> list[_Indices]: ...
    @property
    def is_disk(self) -> bool: ...
    @property
    def is_closed(self) -> bool: ...

@final
class Repaired(Result):
    @property
    def surface(self) -> Surface: ...
    @property
    def vertices(self) -> _Reals: ...
    @property
    def faces(self) -> _Indices: ...
    @property
    def vertex_of(self) -> _Indices: ...
    @property
    def face_of(self) -> _Indices: ...
    @property
    def vertex_to(self) -> _Indices: ...
    @property
    def face_to(self) -> _Indices: ...
    @property
    def counts(self) -> dict[str, int]: ...
    @property
    def report(self) -> str: ...
    @property
    def is_changed(self) -> bool: ...
    def carry(
        self, values: ArrayLike, *, per: Literal["vertex", "face"] | None = None, nearest: bool = False
    ) -> NDArray[Any]: ...

@final
class Distortion(Result):
    @property
    def authalic_energy(self) -> float: ...
    @property
    def area_ratio_mean(self) -> float: ...
    @property
    def area_ratio_std(self) -> float: ...
    @property
    def log2_area_ratio(self) -> _Reals: ...
    @property
    def folded(self) -> _Indices: ...
    @property
    def angle_distortion(self) -> _Reals: ...
    @property
    def angle_distortion_mean(self) -> float: ...
    @property
    def angle_distortion_p99(self) -> float: ...
    @property
    def angle_distortion_max(self) -> float: ...

@final
class DiskMap(Result):
    @property
    def uv(self) -> _Reals: ...
    @property
    def faces(self) -> _Indices: ...
    @property
    def status(self) -> _Status: ...
    @property
    def iterations(self) -> int: ...
    @property
    def history(self) -> NDArray[np.void]: ...
    @property
    def distortion(self) -> Distortion: ...
    @property
    def repaired(self) -> Repaired | None: ...
    @property
    def seconds(self) -> float: ...
    def locate(
        self, points: ArrayLike, *, outside: Literal["nearest"] | None = None
    ) -> tuple[_Indices, _Reals]: ...
    def image_of(self, triangles: ArrayLike, barycentric: ArrayLike) -> _Reals: ...
    def sample(
        self,
        values: ArrayLike,
        points: ArrayLike,
        *,
        per: Literal["vertex", "face"] | None = None,
        nearest: bool = False,
        outside: Literal["nearest"] | complex | None = None,
    ) -> NDArray[Any]: ...
    def image(
        self,
        values: ArrayLike,
        shape: Sequence[int],
        *,
        extent: ArrayLike | None = None,
        per: Literal["vertex", "face"] | None = None,
        nearest: bool = False,
        conservative: bool | Literal["total"] = False,
        outside: Literal["nearest"] | complex | None = None,
    ) -> NDArray[Any]: ...

@final
class Refinement(Result):
    @property
    def parents(self) -> _Indices: ...
    @property
    def vertices(self) -> _Reals: ...
    @property
    def positions(self) -> _Reals: ...
    @property
    def faces(self) -> _Indices: ...
    @property
    def face_of(self) -> _Indices: ...
    @property
    def distortion(self) -> Distortion: ...

@final
class SphereMap(Result):
    @property
    def positions(self) -> _Reals: ...
    @property
    def faces(self) -> _Indices: ...
    @property
    def status(self) -> _Status: ...
    @property
    def iterations(self) -> int: ...
    @property
    def history(self) -> NDArray[np.void]: ...
    @property
    def distortion(self) -> Distortion: ...
    @property
    def refinement(self) -> Refinement | None: ...
    @property
    def repaired(self) -> Repaired | None: ...
    @property
    def seconds(self) -> float: ...
    def locate(self, points: ArrayLike) -> tuple[_Indices, _Reals]: ...
    def image_of(self, triangles: ArrayLike, barycentric: ArrayLike) -> _Reals: ...
    def sample(
        self,
        values: ArrayLike,
        points: ArrayLike,
        *,
        per: Literal["vertex", "face"] | None = None,
        nearest: bool = False,
    ) -> NDArray[Any]: ...
    def equirectangular(
        self,
        values: ArrayLike,
        shape: Sequence[int],
        *,
        per: Literal["vertex", "face"] | None = None,
        nearest: bool = False,
        conservative: bool | Literal["total"] = False,
    ) -> NDArray[Any]: ...
    def equal_area_grid(
        self,
        values: ArrayLike,
        n: int,
        *,
        per: Literal["vertex", "face"] | None = None,
        nearest: bool = False,
        conservative: bool | Literal["total"] = False,
    ) -> NDArray[Any]: ...
    def resample(
        self,
        values: ArrayLike,
        level: int,
        *,
        per: Literal["vertex", "face"] | None = None,
        nearest: bool = False,
        conservative: bool | Literal["total"] = False,
    ) -> tuple[NDArray[Any], Surface]: ...
    def layout(
        self,
        kind: Literal["lambert", "octahedral"] = "lambert",
        *,
        pole: Literal["x", "y", "z"] | ArrayLike = "z",
        seam: float | ArrayLike = 0.0,
        polygons: ArrayLike | None = None,
        density: ArrayLike | None = None,
        candidates: ArrayLike | None = None,
        precision: Literal["float64", "float32"] = "float64",
        progress: _Progress | None = None,
    ) -> Layout: ...

@final
class Layout(Result):
    @property
    def points(self) -> NDArray[np.float64] | NDArray[np.float32]: ...
    @property
    def faces(self) -> _Indices: ...
    @property
    def vertex_of(self) -> _Indices: ...
    @property
    def status(self) -> Literal["converged", "stalled", "cancelled"]: ...
    @property
    def seconds(self) -> float: ...

@final
class Untangled(Result):
    @property
    def image(self) -> _Reals: ...
    @property
    def moved(self) -> _Indices: ...
    @property
    def folded_before(self) -> _Indices: ...
    @property
    def status(self) -> Literal["converged", "stalled", "cancelled"]: ...
    @property
    def distortion(self) -> Distortion: ...
    @property
    def seconds(self) -> float: ...

@final
class Seams(Result):
    @property
    def edges(self) -> _Indices: ...
    @property
    def islands(self) -> int: ...
    @property
    def island_of(self) -> _Indices: ...
    @property
    def length(self) -> float: ...
    @property
    def predicted(self) -> float: ...
    @property
    def status(self) -> Literal["converged", "stalled"]: ...
    @property
    def seconds(self) -> float: ...

@final
class Unwrap(Result):
    @property
    def uv(self) -> _Reals: ...
    @property
    def faces(self) -> _Indices: ...
    @property
    def vertex_of(self) -> _Indices: ...
    @property
    def islands(self) -> int: ...
    @property
    def island_of(self) -> _Indices: ...
    @property
    def edges(self) -> _Indices: ...
    @property
    def length(self) -> float: ...
    @property
    def shear(self) -> float: ...
    @property
    def shear_p99(self) -> float: ...
    @property
    def area_ratio_std(self) -> float: ...
    @property
    def packed(self) -> float: ...
    @property
    def status(self) -> Literal["converged", "stalled"]: ...
    @property
    def seconds(self) -> float: ...

@final
class Packing(Result):
    @property
    def uv(self) -> _Reals: ...
    @property
    def scale(self) -> float: ...
    @property
    def angles(self) -> _Reals: ...
    @property
    def seconds(self) -> float: ...

@final
class Registration(Result):
    @property
    def positions(self) -> _Reals: ...
    @property
    def triangles(self) -> _Indices: ...
    @property
    def barycentric(self) -> _Reals: ...
    @property
    def registered(self) -> _Reals: ...
    @property
    def target_registered(self) -> _Reals: ...
    @property
    def faces(self) -> _Indices: ...
    @property
    def target_faces(self) -> _Indices: ...
    @property
    def source_map(self) -> DiskMap | SphereMap: ...
    @property
    def target_map(self) -> DiskMap | SphereMap: ...
    @property
    def landmark_error(self) -> _Reals: ...
    @property
    def missed(self) -> _Indices: ...
    @property
    def off_boundary(self) -> _Indices: ...
    @property
    def in_holes(self) -> _Indices: ...
    @property
    def status(
        self,
    ) -> Literal["converged", "landmarks_missed", "max_iterations", "stalled", "cancelled"]: ...
    @property
    def distortion(self) -> Distortion: ...
    @property
    def area_ratio(self) -> _Reals: ...
    @property
    def area_distortion(self) -> _Reals: ...
    @property
    def target_distortion(self) -> Distortion: ...
    @property
    def strain(self) -> Strain: ...
    @property
    def certificates(self) -> Certificates | None: ...
    @property
    def warnings(self) -> list[RegistrationWarning]: ...
    @property
    def energies(self) -> list[_Reals]: ...
    @property
    def iterations(self) -> int: ...
    @property
    def source_repaired(self) -> Repaired | None: ...
    @property
    def target_repaired(self) -> Repaired | None: ...
    @property
    def seconds(self) -> float: ...
    def pull(
        self,
        values: ArrayLike,
        *,
        per: Literal["vertex", "corner"] | None = None,
        nearest: bool = False,
        smooth: bool = False,
    ) -> NDArray[Any]: ...
    def follow(
        self, points: ArrayLike, *, pieces: ArrayLike | None = None, rigid_size: float = 0.25
    ) -> _Reals: ...
    def local_similarities(self) -> _Reals: ...
    def inverse(self) -> Registration: ...
    def compare(self, source_values: ArrayLike, target_values: ArrayLike) -> tuple[float, float]: ...

@final
class Strain(Result):
    @property
    def sigma(self) -> _Reals: ...
    @property
    def symmetric_dirichlet(self) -> _Reals: ...
    @property
    def mean(self) -> float: ...
    @property
    def median(self) -> float: ...
    @property
    def p95(self) -> float: ...
    @property
    def stretched(self) -> float: ...
    @property
    def worst_landmark(self) -> int | None: ...

@final
class Certificates(Result):
    @property
    def folded(self) -> _Indices: ...
    @property
    def area(self) -> float: ...
    @property
    def expected_area(self) -> float: ...
    @property
    def area_error(self) -> float: ...
    @property
    def curve_error(self) -> float: ...
    @property
    def bank_error(self) -> float: ...
    @property
    def cocycle_error(self) -> float: ...
    @property
    def outside(self) -> int: ...
    @property
    def energy_ratio(self) -> float: ...
    @property
    def curvature(self) -> tuple[float, float]: ...

@final
class Pants(Result):
    @property
    def boundary_lengths(self) -> _Reals: ...
    @property
    def hexagons(self) -> _Reals: ...
    @property
    def angles(self) -> _Reals: ...
    @property
    def placement(self) -> _Complex: ...

@final
class HyperbolicStructure(Result):
    @property
    def vertices(self) -> _Reals: ...
    @property
    def faces(self) -> _Indices: ...
    @property
    def vertex_of(self) -> _Indices: ...
    @property
    def disk_faces(self) -> _Indices: ...
    @property
    def positions(self) -> _Reals: ...
    @property
    def disk_vertex_of(self) -> _Indices: ...
    @property
    def order(self) -> _Indices: ...
    @property
    def reversed(self) -> NDArray[np.bool_]: ...
    @property
    def banks(self) -> list[tuple[_Indices, _Indices]]: ...
    @property
    def arcs(self) -> list[tuple[_Indices, _Indices]]: ...
    @property
    def generators(self) -> _Complex: ...
    @property
    def boundary_lengths(self) -> _Reals: ...
    @property
    def pants(self) -> list[Pants]: ...
    @property
    def pants_curves(self) -> list[_Reals]: ...
    @property
    def lengths(self) -> _Reals: ...
    @property
    def curvature(self) -> float: ...
    @property
    def area(self) -> float: ...
    def cover(self, copies: int) -> tuple[list[tuple[int, ...]], _Complex]: ...

def repair(
    vertices: ArrayLike | _Handle,
    faces: ArrayLike | None = None,
    *,
    merge: float | bool | None = 0.0,
    close_holes: bool | int | Literal["pinholes"] = "pinholes",
    keep_outline: bool = False,
    close_handles: bool | float | Literal["noise"] = False,
    keep: Literal["all", "largest"] = "all",
) -> Repaired: ...
def cut(
    vertices: ArrayLike | _Handle, faces: ArrayLike | None = None, *, seams: ArrayLike | None = None
) -> list[Patch]: ...
def distortion(
    vertices: ArrayLike | _Handle,
    faces: ArrayLike | None = None,
    image: ArrayLike | None = None,
    *,
    density: ArrayLike | None = None,
) -> Distortion: ...
def distortions(
    surfaces: Iterable[_Surface],
    images: Iterable[ArrayLike],
    *,
    densities: Iterable[ArrayLike | None] | None = None,
) -> list[Distortion | MeshError]: ...
def disk_map(
    vertices: ArrayLike | _Handle,
    faces: ArrayLike | None = None,
    *,
    method: Literal["gauss_newton", "conjugate_gradient", "fixed_point"] = "gauss_newton",
    boundary: Literal["sliding", "arc_length", "free", "rectangle"] = "sliding",
    density: ArrayLike | None = None,
    angle_weight: float = 0.0,
    area_tolerance: float | None = None,
    initial: ArrayLike | None = None,
    max_iterations: int | None = None,
    tolerance: float | None = None,
    fill_holes: bool = False,
    overlap: bool = False,
    corners: ArrayLike | None = None,
    aspect: float | None = None,
    repair: bool = False,
    progress: _Progress | None = None,
) -> DiskMap: ...
def disk_maps(
    surfaces: Iterable[_Surface],
    *,
    densities: Iterable[ArrayLike | None] | None = None,
    method: Literal["gauss_newton", "conjugate_gradient", "fixed_point"] = "gauss_newton",
    boundary: Literal["sliding", "arc_length", "free", "rectangle"] = "sliding",
    angle_weight: float = 0.0,
    area_tolerance: float | None = None,
    max_iterations: int | None = None,
    tolerance: float | None = None,
    fill_holes: bool = False,
    overlap: bool = False,
    repair: bool = False,
    progress: _Progress | None = None,
) -> list[DiskMap | MeshError | SolverError | None]: ...
def sphere_map(
    vertices: ArrayLike | _Handle,
    faces: ArrayLike | None = None,
    *,
    method: Literal["gauss_newton", "gradient_descent", "fixed_point"] = "gauss_newton",
    line_search: Literal["interpolation", "bounded"] = "interpolation",
    density: ArrayLike | None = None,
    angle_weight: float = 0.0,
    area_tolerance: float | None = None,
    initial: ArrayLike | None = None,
    max_iterations: int | None = None,
    tolerance: float | None = None,
    refine: bool = False,
    unfold: bool = True,
    fill_holes: bool = False,
    repair: bool = False,
    progress: _Progress | None = None,
) -> SphereMap: ...
def stretch_hessian(
    vertices: ArrayLike | _Handle,
    faces: ArrayLike | None = None,
    image: ArrayLike | None = None,
    *,
    density: ArrayLike | None = None,
) -> tuple[_Reals, _Indices, _Indices]: ...
def untangle(
    surface: _Surface,
    image: ArrayLike,
    *,
    fixed: ArrayLike | None = None,
    tolerance: float = 0.01,
    progress: _Progress | None = None,
) -> Untangled: ...
def seams(
    surface: _Surface,
    *,
    target: float = 1.4,
    fixed: ArrayLike | None = None,
    weights: ArrayLike | None = None,
    front: ArrayLike | None = None,
    symmetry: Literal["auto", "off"] | bool | None = "auto",
    max_islands: int | None = None,
    overlap: bool = False,
    diagonals: ArrayLike | None = None,
    method: Literal["search", "cones"] = "search",
    progress: _Progress | None = None,
) -> Seams: ...
def _fields(kind: str) -> tuple[str, ...]: ...
def _restored(kind: str, state: dict[str, Any], provenance: dict[str, Any] | None) -> Any: ...
def set_threads(count: int) -> None: ...
def unwrap(
    surface: _Surface,
    *,
    seams: Literal["auto"] | ArrayLike | None = "auto",
    target: float = 1.4,
    fixed: ArrayLike | None = None,
    weights: ArrayLike | None = None,
    front: ArrayLike | None = None,
    symmetry: Literal["auto", "off"] | bool | None = "auto",
    max_islands: int | None = None,
    overlap: bool = False,
    diagonals: ArrayLike | None = None,
    pack: bool = True,
    margin: float = 0.002,
    rotate: bool = True,
    progress: _Progress | None = None,
) -> Unwrap: ...
def pack(
    uv: ArrayLike,
    faces: ArrayLike,
    island_of: ArrayLike,
    *,
    margin: float = 0.002,
    margin_unit: Literal["square", "islands"] = "square",
    rotate: bool | Literal["cardinal"] = True,
    aspect: float = 1.0,
    progress: _Progress | None = None,
) -> Packing: ...
def register_disks(
    source: _Surface,
    target: _Surface,
    *,
    source_landmarks: ArrayLike,
    target_landmarks: ArrayLike,
    energy: Literal["area", "surface"] = "surface",
    weight: float = 1.0,
    area_weight: float = 1.0,
    angle_weight: float | None = None,
    weights: ArrayLike | None = None,
    features: tuple[ArrayLike, ArrayLike] | None = None,
    feature_weight: ArrayLike | None = None,
    position_weight: float = 0.0,
    fill_holes: bool = False,
    repair: bool = False,
    progress: _Progress | None = None,
    preview: Callable[[_Reals], object] | None = None,
) -> Registration: ...
def register_spheres(
    source: _Surface,
    target: _Surface,
    *,
    source_landmarks: ArrayLike | None = None,
    target_landmarks: ArrayLike | None = None,
    energy: Literal["area", "surface"] = "surface",
    weight: float = 1.0,
    area_weight: float = 1.0,
    angle_weight: float | None = None,
    weights: ArrayLike | None = None,
    features: tuple[ArrayLike, ArrayLike] | None = None,
    feature_weight: ArrayLike | None = None,
    position_weight: float = 0.0,
    fill_holes: bool = False,
    repair: bool = False,
    progress: _Progress | None = None,
    preview: Callable[[_Reals], object] | None = None,
) -> Registration: ...
def register_hyperbolic(
    source: _Surface,
    target: _Surface,
    *,
    source_curves: Iterable[ArrayLike],
    target_curves: Iterable[ArrayLike],
    energy: Literal["harmonic", "surface"] = "surface",
    area_weight: float = 1.0,
    angle_weight: float = 1.0,
    features: tuple[ArrayLike, ArrayLike] | None = None,
    feature_weight: ArrayLike | None = None,
    position_weight: float = 0.0,
    fill_holes: bool = False,
    repair: bool = False,
    metric: Literal["newton", "ricci_flow"] = "newton",
    solver: Literal["newton", "heat"] = "newton",
    max_iterations: int | None = None,
    tolerance: float | None = None,
    source_sphere: ArrayLike | None = None,
    target_sphere: ArrayLike | None = None,
    progress: _Progress | None = None,
    preview: Callable[[_Reals], object] | None = None,
) -> Registration: ...
def homotopy(
    vertices: ArrayLike | _Handle, registration: Registration, t: float, *, align: bool = False
) -> _Reals: ...
def hyperbolic_structure(
    vertices: ArrayLike | _Handle,
    faces: ArrayLike | None = None,
    *,
    curves: Iterable[ArrayLike],
    metric: Literal["newton", "ricci_flow"] = "newton",
    progress: _Progress | None = None,
) -> HyperbolicStructure: ...
