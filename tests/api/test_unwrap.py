# SPDX-License-Identifier: MIT OR Apache-2.0
"""UVs in one call: even, hardly sheared, without folds and overlaps, packed at one density."""

import numpy as np
import pytest

import authalic

from . import meshes, oracle, real_meshes
from .test_seams import BUMPY, SURFACES, edge_set, edges_of, every_surface, seam_length


def shear(mesh, result):
    """σ₁/σ₂ of every face, (m,), from the singular values of its map."""
    rest = mesh.vertices[mesh.faces]
    first, second = rest[:, 1] - rest[:, 0], rest[:, 2] - rest[:, 0]
    length = np.linalg.norm(first, axis=1)
    along = np.einsum("ij,ij->i", first, second) / length
    across = np.sqrt(np.maximum(np.einsum("ij,ij->i", second, second) - along**2, 0))
    frame = np.stack([np.stack([length, along], 1), np.stack([0 * along, across], 1)], axis=1)
    image = result.uv[result.faces]
    image = np.stack([image[:, 1] - image[:, 0], image[:, 2] - image[:, 0]], axis=2)
    values = np.linalg.svd(image @ np.linalg.inv(frame), compute_uv=False)
    return values[:, 0] / values[:, 1]


def outline(faces):
    """The boundary edges (k, 2) of some faces, each in the direction of its face."""
    edges = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return edges[~np.isin(edges @ [2**31, 1], edges @ [1, 2**31])]


def crosses_itself(uv, edges):
    """Whether two segments of an outline cross, all pairs compared."""
    start, end = uv[edges[:, 0]], uv[edges[:, 1]]
    for k in range(len(edges) - 1):
        a, b, c, d = start[k], end[k], start[k + 1 :], end[k + 1 :]
        apart = ~np.isin(edges[k + 1 :], edges[k]).any(axis=1)
        sides = [cross(b - a, c - a), cross(b - a, d - a), cross(d - c, a - c), cross(d - c, b - c)]
        if (apart & (sides[0] * sides[1] < 0) & (sides[2] * sides[3] < 0)).any():
            return True
    return False


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def painted(result, size=700):
    """The island over the middle of each pixel, −1 for none; and the number of pixels under two islands."""
    image, shared = np.full((size, size), -1), 0
    for face, island in zip(result.faces, result.island_of, strict=True):
        corners = result.uv[face] * size
        (left, low), (right, high) = np.floor(corners.min(0)).astype(int), np.ceil(corners.max(0)).astype(int)
        x, y = np.meshgrid(np.arange(left, right) + 0.5, np.arange(low, high) + 0.5)
        points = np.stack([x, y], axis=-1)
        inside = np.ones(x.shape, bool)
        for k in range(3):
            inside &= cross(corners[k - 2] - corners[k], points - corners[k]) > 0
        window = image[low:high, left:right]
        shared += (inside & (window >= 0) & (window != island)).sum()
        window[inside] = island
    return image, shared


def assert_sound(mesh, result):
    """No folds, no overlap, all in the square at one density; and the figures are those of the points."""
    assert (result.uv >= 0).all() and (result.uv <= 1).all()
    assert np.array_equal(result.vertex_of[result.faces], mesh.faces)
    assert oracle.folded(result.uv, result.faces) == []
    for island in range(result.islands):
        edges = outline(result.faces[result.island_of == island])
        assert not crosses_itself(result.uv, edges), f"island {island}"
    image, shared = painted(result)
    assert shared == 0
    areas = oracle.face_areas(*mesh)
    ratio = oracle.area_ratio(result.uv, result.faces, areas)
    weights = areas / areas.sum()
    assert result.area_ratio_std == pytest.approx(np.sqrt(weights @ (ratio - 1) ** 2), rel=1e-6, abs=1e-9)
    sheared = shear(mesh, result)
    assert result.shear == pytest.approx(weights @ sheared, rel=1e-6)
    order = np.argsort(-sheared)
    above = np.cumsum(weights[order]) > 0.01
    assert result.shear_p99 == pytest.approx(sheared[order][above][0], rel=1e-6)
    covered = oracle.signed_areas(result.uv, result.faces).sum()
    assert result.packed == pytest.approx(covered, rel=1e-9)
    assert (image >= 0).mean() == pytest.approx(covered, abs=0.01)
    assert result.length == pytest.approx(seam_length(mesh, result.edges), rel=1e-9)
    # one density: no island has more of the texture for its area than another
    for island in range(result.islands):
        own = result.island_of == island
        density = oracle.signed_areas(result.uv, result.faces)[own].sum() / areas[own].sum()
        assert density == pytest.approx(covered / areas.sum(), rel=2e-3)


# Automatic seams


@every_surface
def test_any_surface_is_unwrapped(mesh):
    result = authalic.unwrap(mesh)
    assert_sound(mesh, result)
    assert result.area_ratio_std <= 0.005
    assert result.shear <= 1.012 * 1.4
    assert result.status == "converged"
    patches = authalic.cut(*mesh, seams=result.edges)
    assert [len(patch.faces) for patch in patches] == np.bincount(result.island_of).tolist()
    assert all(patch.is_disk for patch in patches)


@pytest.mark.parametrize("name", ["bumpy_ball", "torus"])
def test_little_shear_is_reached_too(name):
    result = authalic.unwrap(SURFACES[name], target=1.2)
    assert_sound(SURFACES[name], result)
    assert result.area_ratio_std <= 0.005
    assert result.shear <= 1.012 * 1.2


def test_the_seams_are_those_of_the_other_call():
    options = {"target": 1.3, "fixed": edges_of(BUMPY)[40:42], "front": [0, 0, 1], "symmetry": "off"}
    seams, result = authalic.seams(BUMPY, **options), authalic.unwrap(BUMPY, seams="auto", **options)
    assert np.array_equal(result.edges, seams.edges)
    assert np.array_equal(result.island_of, seams.island_of)
    assert (result.length, result.islands) == (seams.length, seams.islands)


def test_weights_and_limits_of_islands_count():
    mesh = SURFACES["limbed_ball"]
    keep_off = mesh.vertices[:, 2] < -0.5
    result = authalic.unwrap(mesh, weights=np.where(keep_off, np.inf, 1.0), max_islands=1)
    assert not keep_off[result.edges].any()
    assert result.islands <= 1 < authalic.unwrap(mesh).islands


def test_islands_that_may_overlap_themselves_have_no_longer_seams():
    mesh = SURFACES["limbed_ball"]
    free, one_to_one = (authalic.unwrap(mesh, target=1.2, overlap=overlap) for overlap in (True, False))
    assert free.islands <= one_to_one.islands
    assert free.length <= 1.02 * one_to_one.length
    assert oracle.folded(free.uv, free.faces) == []


def test_surfaces_and_arrays_have_the_same_map():
    expected = authalic.unwrap(tuple(BUMPY)).uv
    for given in (authalic.Surface(*BUMPY), (BUMPY.vertices.tolist(), BUMPY.faces.tolist())):
        assert np.array_equal(authalic.unwrap(given).uv, expected)


# Given seams


def test_given_seams_are_all_seams():
    mesh, meridian = meshes.sphere(14, 20)
    result = authalic.unwrap(mesh, seams=np.vstack([meridian[:, ::-1], meridian[:3]]))
    assert_sound(mesh, result)
    assert edge_set(result.edges) == edge_set(meridian)
    assert len(result.edges) == len(meridian)
    assert result.islands == 1
    assert result.area_ratio_std <= 0.005


def test_without_seams_the_components_are_the_islands():
    mesh = meshes.bumpy_cap()
    result = authalic.unwrap(mesh, seams=None)
    assert_sound(mesh, result)
    assert (result.islands, result.edges.shape, result.length) == (1, (0, 2), 0.0)
    empty = authalic.unwrap(mesh, seams=np.empty((0, 2), int))
    assert np.array_equal(empty.uv, result.uv)


@pytest.mark.parametrize(
    ("mesh", "kind"),
    [(BUMPY, "closed_surface"), (meshes.torus(), "handles")],
    ids=["closed", "handles"],
)
def test_islands_of_given_seams_must_be_open_and_without_handles(mesh, kind):
    with pytest.raises(authalic.MeshError) as caught:
        authalic.unwrap(mesh, seams=None)
    assert caught.value.kind == kind
    assert 'unwrap with seams="auto"' in str(caught.value)


def holed_torus():
    mesh = meshes.torus()
    return meshes.compact(meshes.Mesh(mesh.vertices, mesh.faces[:-2]))


@pytest.mark.parametrize("mesh", [BUMPY, meshes.torus(), holed_torus()], ids=["closed", "torus", "open"])
def test_a_disk_map_of_what_is_no_disk_names_the_call_that_cuts(mesh):
    with pytest.raises(authalic.MeshError, match='unwrap with seams="auto"'):
        authalic.disk_map(*mesh)


# Packing


def test_the_margin_keeps_islands_apart():
    mesh = SURFACES["two_pieces"]
    result = authalic.unwrap(mesh, margin=0.05)
    assert result.uv.min() >= 0.05 - 1e-9 and result.uv.max() <= 0.95 + 1e-9
    points = [result.uv[np.unique(result.faces[result.island_of == island])] for island in (0, 1)]
    distance = np.linalg.norm(points[0][:, None] - points[1], axis=2).min()
    assert distance >= 0.05 - 1e-9


def test_islands_may_be_left_to_another_packer():
    mesh = SURFACES["two_pieces"]
    packed, alone = authalic.unwrap(mesh), authalic.unwrap(mesh, pack=False, margin=0.7)
    assert alone.packed == 0
    for name in ("faces", "vertex_of", "island_of", "edges"):
        assert np.array_equal(getattr(alone, name), getattr(packed, name))
    for name in ("shear", "shear_p99", "area_ratio_std", "length", "islands", "status"):
        assert getattr(alone, name) == getattr(packed, name)
    areas = oracle.face_areas(*mesh)
    assert oracle.signed_areas(alone.uv, alone.faces).sum() == pytest.approx(areas.sum(), rel=1e-9)
    # each island is that of the packed map, turned, scaled and moved
    for island in range(alone.islands):
        shapes = [result.uv[result.faces[alone.island_of == island]] for result in (alone, packed)]
        sides = [np.linalg.norm(shape - np.roll(shape, 1, axis=1), axis=2) for shape in shapes]
        scale = np.sqrt(packed.packed / areas.sum())
        assert sides[1] == pytest.approx(scale * sides[0], rel=1e-9, abs=1e-12)


def test_islands_need_not_turn():
    mesh = meshes.grid(9, 13, aspect=2.0)
    for rotate in (False, True):
        assert_sound(mesh, authalic.unwrap(mesh, rotate=rotate))


@pytest.mark.parametrize("margin", [-0.1, 0.5, float("nan")])
def test_a_margin_out_of_range_is_refused(margin):
    with pytest.raises(ValueError, match="margin") as caught:
        authalic.unwrap(meshes.grid(), margin=margin)
    assert caught.value.kind == "invalid_option"


# Results and refusals


def test_the_result_is_printed_in_one_line():
    text = repr(authalic.unwrap(meshes.grid()))
    assert text.startswith("Unwrap(1 islands, seam length 0.00, shear 1.000, area ratio std 0.0000, ")
    assert "% packed, converged" in text and "\n" not in text


@pytest.mark.parametrize(
    ("seams", "kind", "words"),
    [
        ("none", "invalid_option", 'seams must be "auto", edges or None, but is "none"'),
        ([[5, 5]], "seam_not_edge", "not an edge"),
        ([[0, 10**6]], "index_out_of_range", "seams"),
        ([[0, 1, 2]], "invalid_array", "seams"),
    ],
)
def test_seams_that_are_none_are_refused(seams, kind, words):
    with pytest.raises(ValueError, match=words) as caught:
        authalic.unwrap(BUMPY, seams=seams)
    assert caught.value.kind == kind


@pytest.mark.parametrize("seams", ["auto", None])
def test_a_false_answer_cancels(seams):
    with pytest.raises(authalic.SolverError, match="cancelled") as caught:
        authalic.unwrap(meshes.bumpy_cap(), seams=seams, progress=lambda *_: False)
    assert caught.value.kind == "cancelled"


@pytest.mark.parametrize("seams", ["auto", None])
def test_progress_grows_to_the_end(seams):
    heard = []
    authalic.unwrap(meshes.bumpy_cap(), seams=seams, progress=lambda *report: heard.append(report))
    fractions, messages = zip(*heard, strict=True)
    assert list(fractions) == sorted(fractions)
    assert 0.5 < fractions[-1] <= 1
    assert all(isinstance(message, str) and message for message in messages)


# Real meshes


@real_meshes.each("seams")
@pytest.mark.parametrize("target", [1.25])
def test_real_surfaces_are_unwrapped(path, target):
    mesh = real_meshes.load(path)
    if len(mesh.vertices) > 20_000:
        pytest.skip("takes long")
    result = authalic.unwrap(mesh, target=target)
    assert_sound(mesh, result)
    assert result.area_ratio_std <= 0.005
    assert result.shear <= 1.012 * target
