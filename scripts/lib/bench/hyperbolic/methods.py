# SPDX-License-Identifier: MIT OR Apache-2.0
"""The three registrations of the comparison, each a function of a pair."""

import time

import numpy as np

import authalic
from bench.hyperbolic.harmonic import register
from bench.hyperbolic.measures import Registration
from bench.hyperbolic.pairs import shares

HYPERBOLIC, HARMONIC, SPHERES = "hyperbolic", "harmonic, point landmarks", "spheres, point landmarks"
STATIONS = (0, 0.25, 0.5, 0.75, 1)
"""The points of `register_spheres` on a curve, by shares of its length."""


def hyperbolic(pair, **options):
    """`authalic.register_hyperbolic`, and its certificates as the remark."""
    began = time.perf_counter()
    result = curves_result(pair, **options)
    seconds = time.perf_counter() - began
    return registration_of(result, result.certificates.folded, seconds, hyperbolic_remark(result))


def curves_result(pair, **options):
    """The result of `authalic.register_hyperbolic` for a pair, by the paper's harmonic map."""
    return authalic.register_hyperbolic(
        pair.source.mesh,
        pair.target.mesh,
        source_curves=pair.source.curves,
        target_curves=pair.target.curves,
        energy="harmonic",
        **options,
    )


def registration_of(result, folded, seconds, remark):
    """A result of the package, to be measured."""
    return Registration(result.triangles, result.barycentric, folded, seconds, remark)


def hyperbolic_remark(result):
    proof = result.certificates
    words = [result.status, f"curves off by {proof.curve_error:.0e}", *result.warnings]
    return "; ".join(words).replace("|", "/")


def harmonic(pair):
    """The conventional method."""
    began = time.perf_counter()
    place = register(pair)
    seconds = time.perf_counter() - began
    remark = f"faces folded: {len(place.folded)}"
    if place.target_folded:
        remark += f"; in the flattening of the target: {place.target_folded}"
    return Registration(place.triangles, place.barycentric, place.folded, seconds, remark)


def spheres(pair):
    """`authalic.register_spheres` with points on the curves, by the papers' energy of areas."""
    source, target = landmarks(pair)
    began = time.perf_counter()
    result = authalic.register_spheres(
        pair.source.mesh, pair.target.mesh, source_landmarks=source, target_landmarks=target, energy="area"
    )
    seconds = time.perf_counter() - began
    remark = f"{result.status}, {len(source)} points" + missed(result)
    return registration_of(result, result.distortion.folded, seconds, remark)


def missed(result):
    return f", {len(result.missed)} missed" if len(result.missed) else ""


def landmarks(pair):
    """The vertices of both sides nearest to equal shares of the curves, each pair once."""
    partner_of = {}
    for curves in zip(pair.source.curves, pair.target.curves, strict=True):
        for share in STATIONS:
            sides = zip((pair.source.vertices, pair.target.vertices), curves, strict=True)
            source, target = (
                int(curve[np.abs(shares(vertices[curve]) - share).argmin()]) for vertices, curve in sides
            )
            # a closed curve begins where it ends
            if source not in partner_of and target not in partner_of.values():
                partner_of[source] = target
    return np.array(list(partner_of)), np.array(list(partner_of.values()))


METHODS = {HYPERBOLIC: hyperbolic, HARMONIC: harmonic, SPHERES: spheres}
