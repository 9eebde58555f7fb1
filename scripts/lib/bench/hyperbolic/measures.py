# SPDX-License-Identifier: MIT OR Apache-2.0
"""The paper's measures of a registration, by the same formulas for every method."""

from dataclasses import dataclass, field

import numpy as np

TRUNCATED = 10.0
"""Larger area distortions count as this, as in the paper."""


@dataclass(frozen=True)
class Registration:
    """A registration by any method: the places of the source's vertices on the target."""

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
    """The percentage of the source's area that is folded in the method's own domain."""
    turned: float
    """The percentage with images, as straight triangles, turned over on the target's reference sphere."""
    variation: float
    """Mean over the curves of the distance between image and partner, in mm."""
    correlation: float
    """The correlation of the convexity (sulc) of both, weighted by area."""
    difference: dict
    """{field: mean absolute difference, weighted by area}."""
    areas: np.ndarray
    """max(J, 1/J) of every source face, at most `TRUNCATED`."""
    differences: np.ndarray
    """The absolute differences of sulc at the source's vertices."""
    seconds: float
    remark: str = field(default="")

    @property
    def percentiles(self):
        return np.percentile(self.areas, (50, 90, 99))


def measured(pair, registration):
    """All measures of a registration."""
    source, target = pair.source, pair.target
    areas = face_areas(source.vertices, source.faces)
    image = interpolated(target.vertices, target, registration)
    weights = np.bincount(source.faces.ravel(), np.repeat(areas, 3), len(source.vertices))
    pulled = {name: interpolated(values, target, registration) for name, values in target.fields.items()}
    gaps = {name: np.abs(values - pulled[name]) for name, values in source.fields.items()}
    turned = determinants(interpolated(target.sphere, target, registration), source.faces) <= 0
    return Measures(
        100 * areas[registration.folded].sum() / areas.sum(),
        100 * areas[turned].sum() / areas.sum(),
        curve_variation(pair, image),
        correlation(source.fields["sulc"], pulled["sulc"], weights),
        {name: np.average(gap, weights=weights) for name, gap in gaps.items()},
        area_distortion(areas, face_areas(image, source.faces)),
        gaps["sulc"],
        registration.seconds,
        registration.remark,
    )


def interpolated(values, target, registration):
    """Values of the target's vertices, (n_t,) or (n_t, d), at the places of the source's vertices."""
    corners = values[target.faces[registration.triangles]]
    return np.einsum("ik,ik...->i...", registration.barycentric, corners)


def face_areas(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def determinants(vertices, faces):
    """Six times the volume between each face and the origin."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c))


def area_distortion(areas, images):
    """max(J, 1/J), truncated, with J the image's share of the area over the face's."""
    with np.errstate(divide="ignore"):
        ratio = (images / images.sum()) / (areas / areas.sum())
        return np.minimum(np.maximum(ratio, 1 / ratio), TRUNCATED)


def correlation(first, second, weights):
    """Pearson's correlation, weighted."""
    covariance = np.cov(first, second, aweights=weights)
    return covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1])


def curve_variation(pair, image):
    """Equation 3 of the paper, points against polylines, averaged over the curves."""
    distances = []
    for source, target in zip(pair.source.curves, pair.target.curves, strict=True):
        path, partner = image[source], pair.target.vertices[target]
        distances.append((distance(path, partner).mean() + distance(partner, path).mean()) / 2)
    return float(np.mean(distances))


def distance(points, path):
    """The distance of each point from a polyline."""
    start, step = path[:-1], np.diff(path, axis=0)
    squared = np.maximum((step**2).sum(axis=1), 1e-300)
    share = (np.einsum("ijx,jx->ij", points[:, None] - start, step) / squared).clip(0, 1)
    return np.linalg.norm(points[:, None] - start - share[..., None] * step, axis=2).min(axis=1)
