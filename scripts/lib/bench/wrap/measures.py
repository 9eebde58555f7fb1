# SPDX-License-Identifier: MIT OR Apache-2.0
"""The measures of a map between surfaces, by the same formulas for every method."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bench.hyperbolic.measures import area_distortion, correlation, face_areas, interpolated
from bench.wrap.geodesics import Geodesics

SIGNAL = "sulc"


@dataclass(frozen=True)
class Measures:
    """The figures of a map; lengths are over the root of the target's area."""

    error: float | None
    """Mean distance between the images and the true partners; None without truth."""
    error_p95: float | None
    median: float
    """The strain's median by area; mean and 95th percentile follow."""
    mean: float
    p95: float
    areas: float
    """The mean of max(J, 1/J) over the faces, each at most 10."""
    landmarks: float | None
    """The greatest distance of a landmark's image from its partner."""
    folded: int | None
    correlation: float | None
    """Of sulc and its image, weighted by area."""
    seconds: float
    remark: str


def measured(pair, placed):
    """The measures and the strain of each face."""
    source, target = pair.source, pair.target
    image = interpolated(target.vertices, target, placed)
    weights = face_areas(source.vertices, source.faces)
    strains = strain(source.vertices, source.faces, image, face_areas(target.vertices, target.faces).sum())
    errors = distances(pair, placed, pair.truth)
    gaps = image[pair.landmarks[:, 0]] - target.vertices[pair.landmarks[:, 1]]
    root = np.sqrt(face_areas(target.vertices, target.faces).sum())
    images = face_areas(image, source.faces)
    figures = Measures(
        errors.mean() if len(errors) else None,
        np.percentile(errors, 95) if len(errors) else None,
        *quantiles(strains, weights, (0.5,)),
        np.average(strains, weights=weights),
        *quantiles(strains, weights, (0.95,)),
        area_distortion(weights, images).mean(),
        np.linalg.norm(gaps, axis=1).max() / root if len(gaps) else None,
        placed.folded,
        agreement(pair, placed, weights),
        placed.seconds,
        placed.remark,
    )
    return figures, strains


def strain(vertices, faces, image, target_area):
    """(σ₁² + σ₂² + σ₁⁻² + σ₂⁻²)/4 of each face onto its image, (m,), both surfaces scaled to area 1.

    From the metrics G and H of a face and its image: tr(G⁻¹H) is σ₁² + σ₂², det H / det G is σ₁²σ₂².
    """
    scale = face_areas(vertices, faces).sum() / target_area
    first, second = metric(vertices, faces), scale * metric(image, faces)
    determinant, squared = np.linalg.det(first), np.linalg.det(second)
    trace = (
        first[:, 1, 1] * second[:, 0, 0] + first[:, 0, 0] * second[:, 1, 1]
        - 2 * first[:, 0, 1] * second[:, 0, 1]
    )  # fmt: skip
    with np.errstate(divide="ignore", invalid="ignore"):
        stretched, shrunk = trace / determinant, trace / squared
    return np.where(squared > 0, (stretched + shrunk) / 4, np.inf)


def metric(points, faces):
    """The scalar products of two edges of each face, (m, 2, 2)."""
    edges = points[faces[:, 1:]] - points[faces[:, :1]]
    return edges @ edges.transpose(0, 2, 1)


def quantiles(values, weights, shares):
    """The values below which these shares of the weight lie."""
    order = np.argsort(values)
    below = np.cumsum(weights[order]) / weights.sum()
    return [values[order][min(np.searchsorted(below, share), len(values) - 1)] for share in shares]


def distances(pair, placed, partners):
    """The geodesic distance of each image from the true partner."""
    if len(partners) == 0:
        return np.empty(0)
    geodesics = Geodesics(*pair.target.mesh)
    places = ((q, placed.triangles[p], placed.barycentric[p]) for p, q in partners)
    return np.array([geodesics.to_place(*place) for place in places])


def agreement(pair, placed, areas):
    """The correlation of the signal with its image; None without the signal."""
    if SIGNAL not in pair.source.signals:
        return None
    pulled = interpolated(pair.target.signals[SIGNAL], pair.target, placed)
    weights = np.bincount(pair.source.faces.ravel(), np.repeat(areas, 3))
    return correlation(pair.source.signals[SIGNAL], pulled, weights)
