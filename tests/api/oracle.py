# SPDX-License-Identifier: MIT OR Apache-2.0
"""The figures of a map by other formulas than the library's, in numpy and in exact fractions."""

from fractions import Fraction

import numpy as np
from scipy import sparse


def face_areas(vertices, faces):
    """Areas by Heron's formula from the edge lengths, (m,)."""
    a, b, c = np.sort(edge_lengths(vertices, faces), axis=1)[:, ::-1].T
    return np.sqrt(np.maximum((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)), 0)) / 4


def edge_lengths(vertices, faces):
    """The length of the edge opposite to each corner, (m, 3)."""
    corners = np.asarray(vertices)[faces]
    return np.linalg.norm(np.roll(corners, -1, axis=1) - np.roll(corners, -2, axis=1), axis=2)


def signed_areas(uv, faces):
    """Image areas by the determinant of homogeneous coordinates, (m,)."""
    return np.linalg.det(np.concatenate([np.asarray(uv)[faces], np.ones((len(faces), 3, 1))], axis=2)) / 2


def folded(uv, faces):
    """Faces whose orientation is not positive, by exact arithmetic where rounding could decide."""
    a, b, c = np.moveaxis(np.asarray(uv, float)[faces], 1, 0)
    left = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1])
    right = (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    doubtful = left - right <= 1e-13 * (np.abs(left) + np.abs(right))
    return [face for face in np.flatnonzero(doubtful) if exact_area(uv[faces[face]]) <= 0]


def exact_area(corners):
    """Twice the signed area of a triangle as a fraction."""
    (ax, ay), (bx, by), (cx, cy) = [[Fraction(float(x)) for x in corner] for corner in corners]
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


def authalic_energy(uv, faces, targets):
    """Σ (a − |τ|)²/|τ| with the targets rescaled to the image's area."""
    areas = signed_areas(uv, faces)
    targets = targets * np.abs(areas).sum() / targets.sum()
    return ((areas - targets) ** 2 / targets).sum()


def area_ratio(uv, faces, targets):
    """Signed image area over the rescaled target, (m,)."""
    areas = signed_areas(uv, faces)
    return areas / targets * (targets.sum() / np.abs(areas).sum())


def stretch_laplacian(uv, faces, targets):
    """L_S: half the sum of cotangent weights of the image, each times its image area over the target."""
    cotangents, areas = image_cotangents(uv, faces), signed_areas(uv, faces)
    weights = 0.5 * cotangents * (areas / targets)[:, None]
    i, j = np.roll(faces, -1, axis=1).ravel(), np.roll(faces, -2, axis=1).ravel()
    half = sparse.coo_matrix((weights.ravel(), (i, j)), shape=(len(uv), len(uv)))
    adjacency = (half + half.T).tocsr()
    return sparse.diags(np.asarray(adjacency.sum(axis=1)).ravel()) - adjacency


def image_cotangents(uv, faces):
    """The cotangent of the angle at each corner of the image, by the law of cosines, (m, 3)."""
    square = edge_lengths(uv, faces) ** 2
    areas = signed_areas(uv, faces)
    return (square.sum(axis=1, keepdims=True) - 2 * square) / (4 * areas[:, None])


def stretch_energy(uv, faces, targets):
    """½ fᵀ (I ⊗ L_S) f."""
    laplacian = stretch_laplacian(uv, faces, targets)
    return 0.5 * sum(column @ (laplacian @ column) for column in np.asarray(uv).T)


def angle_distortion(vertices, faces, uv):
    """σ₁/σ₂ of the linear map of each face, (m,), by the singular value decomposition."""
    ratio = np.empty(len(faces))
    for k, face in enumerate(faces):
        rest = in_own_plane(vertices[face])
        image = (uv[face[1:]] - uv[face[0]]).T
        first, second = np.linalg.svd(image @ np.linalg.inv(rest), compute_uv=False)
        ratio[k] = first / second
    return ratio


def in_own_plane(corners):
    """The two edges from the first corner as columns (2, 2), in an orthonormal frame of the face."""
    edges = (corners[1:] - corners[0]).T
    triangle = np.linalg.qr(edges).R
    return triangle if np.linalg.det(triangle) > 0 else np.diag([1, -1]) @ triangle


def boundary_loop(faces):
    """The vertices of the one boundary loop in its order, the surface on its left."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    unpaired = ~np.isin(edges @ [2**31, 1], edges @ [1, 2**31])
    after = dict(edges[unpaired].tolist())
    loop = [min(after)]
    while after[loop[-1]] != loop[0]:
        loop.append(after[loop[-1]])
    assert len(loop) == len(after), "more than one loop"
    return np.array(loop)


def boundary_arcs(uv, loop):
    """The arc of the circle from each boundary vertex to the next, (k,)."""
    angle = np.arctan2(*uv[loop].T[::-1])
    return (np.roll(angle, -1) - angle) % (2 * np.pi)


def assert_disk_embedding(result):
    """No fold by exact arithmetic, boundary once around the unit circle in its order, all in the disk."""
    loop = boundary_loop(result.faces)
    radius = np.hypot(*result.uv.T)
    assert folded(result.uv, result.faces) == []
    assert len(result.distortion.folded) == 0
    assert np.abs(radius[loop] - 1).max() <= 1e-12
    arcs = boundary_arcs(result.uv, loop)
    assert (arcs > 0).all()
    assert abs(arcs.sum() - 2 * np.pi) < 1e-9
    assert radius.max() <= 1 + 1e-12


# Maps onto the unit sphere


def folded_on_sphere(positions, faces):
    """Faces whose determinant is not positive, by exact arithmetic where rounding could decide."""
    corners = np.asarray(positions, float)[faces]
    a, b, c = np.moveaxis(corners, 1, 0)
    size = np.einsum("ij,ij->i", np.abs(a), np.abs(np.roll(b, -1, 1) * np.roll(c, -2, 1)))
    size += np.einsum("ij,ij->i", np.abs(a), np.abs(np.roll(b, -2, 1) * np.roll(c, -1, 1)))
    doubtful = np.linalg.det(corners) <= 1e-13 * size
    return [face for face in np.flatnonzero(doubtful) if exact_volume(corners[face]) <= 0]


def exact_volume(corners):
    """The determinant of three points as a fraction."""
    a, b, c = [[Fraction(float(x)) for x in corner] for corner in corners]
    return sum(a[i] * (b[i - 2] * c[i - 1] - b[i - 1] * c[i - 2]) for i in range(3))


def solid_angles(positions, faces):
    """Signed areas of the spherical triangles, (m,) (Van Oosterom & Strackee 1983)."""
    a, b, c = np.moveaxis(np.asarray(positions)[faces], 1, 0)
    volume = np.einsum("ij,ij->i", a, np.cross(b - a, c - a))
    cosines = sum(np.einsum("ij,ij->i", p, q) for p, q in ((a, b), (b, c), (c, a)))
    return 2 * np.arctan2(volume, 1 + cosines)


def sphere_energy(positions, faces, targets):
    """Σ (a − |τ|)²/|τ| of the flat faces with the targets rescaled to the image's area."""
    areas = face_areas(positions, faces)
    targets = targets * areas.sum() / targets.sum()
    return ((areas - targets) ** 2 / targets).sum()


def vertex_weights(faces, targets, n):
    """Each vertex's share of the targets, (n,)."""
    return np.bincount(faces.ravel(), np.repeat(targets / 3, 3), n)


def assert_lies_over(positions, vertices, weights):
    """No rotation R makes Σ w (R f)·(v − c) larger: Σ w f (v − c)ᵀ is symmetric, and tr − it is positive."""
    centered = vertices - weights @ vertices / weights.sum()
    moment = (weights[:, None] * positions).T @ centered
    scale = np.abs(moment).max()
    assert np.abs(moment - moment.T).max() < 1e-7 * scale
    assert np.linalg.eigvalsh(np.trace(moment) * np.eye(3) - moment).min() > -1e-9 * scale


def assert_sphere_embedding(result):
    """Unit rows, no fold by exact arithmetic, the sphere covered once."""
    assert np.abs(np.linalg.norm(result.positions, axis=1) - 1).max() < 1e-14
    assert folded_on_sphere(result.positions, result.faces) == []
    assert len(result.distortion.folded) == 0
    assert abs(solid_angles(result.positions, result.faces).sum() - 4 * np.pi) < 1e-8
