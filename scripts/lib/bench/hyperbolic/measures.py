# SPDX-License-Identifier: MIT OR Apache-2.0
"""The paper's measures of a registration, by the same formulas for every method."""

from dataclasses import dataclass, field

import numpy as np

TRUNCATED = 10.0
"""Area distortions above count as this, as in the paper."""


@dataclass(frozen=True)
class Found:
    """A registration, whoever made it: where the source's vertices lie on the target."""

    triangles: np.ndarray
    barycentric: np.ndarray
    folded: np.ndarray
    """Source faces that lie the wrong way round in the method's own parameter domain."""
    seconds: float
    remark: str = ""


@dataclass(frozen=True)
class Measures:
    """The figures of a registration."""

    flipped: float
    """Per cent of the source's area that is folded in the method's own domain."""
    turned: float
    """The same, where images are seen as straight triangles on the target's reference sphere."""
    variation: float
    """Mean over the curves of the distance between image and partner, in mm."""
    correlation: float
    """Of the convexity (sulc) of both, weighted by area."""
    difference: dict
    """{field: mean absolute difference, weighted by area}."""
    areas: np.ndarray
    """max(J, 1/J) of every source face, at most `TRUNCATED`."""
    differences: np.ndarray
    """Of sulc, absolute, per source vertex."""
    seconds: float
    remark: str = field(default="")

    @property
    def percentiles(self):
        return np.percentile(self.areas, (50, 90, 99))


def measured(pair, found):
    """All measures of a registration."""
    source, target = pair.source, pair.target
    areas = face_areas(source.vertices, source.faces)
    image = interpolated(target.vertices, target, found)
    weights = np.bincount(source.faces.ravel(), np.repeat(areas, 3), len(source.vertices))
    pulled = {name: interpolated(values, target, found) for name, values in target.fields.items()}
    gaps = {name: np.abs(values - pulled[name]) for name, values in source.fields.items()}
    turned = determinants(interpolated(target.sphere, target, found), source.faces) <= 0
    return Measures(
        100 * areas[found.folded].sum() / areas.sum(),
        100 * areas[turned].sum() / areas.sum(),
        curve_variation(pair, image),
        correlation(source.fields["sulc"], pulled["sulc"], weights),
        {name: np.average(gap, weights=weights) for name, gap in gaps.items()},
        area_distortion(areas, face_areas(image, source.faces)),
        gaps["sulc"],
        found.seconds,
        found.remark,
    )


def interpolated(values, target, found):
    """Values of the target's vertices, (n_t,) or (n_t, d), where the source's vertices lie."""
    corners = values[target.faces[found.triangles]]
    return np.einsum("ik,ik...->i...", found.barycentric, corners)


def face_areas(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def determinants(vertices, faces):
    """Six times the volume between each face and the origin."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c))


def area_distortion(areas, images):
    """max(J, 1/J), J the share of the image over the share of the face, truncated."""
    with np.errstate(divide="ignore"):
        ratio = (images / images.sum()) / (areas / areas.sum())
        return np.minimum(np.maximum(ratio, 1 / ratio), TRUNCATED)


def correlation(ours, theirs, weights):
    """Pearson's, weighted."""
    covariance = np.cov(ours, theirs, aweights=weights)
    return covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1])


def curve_variation(pair, image):
    """Equation 3 of the paper, points against polylines, averaged over the curves."""
    distances = []
    for ours, theirs in zip(pair.source.curves, pair.target.curves, strict=True):
        path, partner = image[ours], pair.target.vertices[theirs]
        distances.append((distance(path, partner).mean() + distance(partner, path).mean()) / 2)
    return float(np.mean(distances))


def distance(points, path):
    """The distance of each point from a polyline."""
    start, step = path[:-1], np.diff(path, axis=0)
    squared = np.maximum((step**2).sum(axis=1), 1e-300)
    part = (np.einsum("ijx,jx->ij", points[:, None] - start, step) / squared).clip(0, 1)
    return np.linalg.norm(points[:, None] - start - part[..., None] * step, axis=2).min(axis=1)
