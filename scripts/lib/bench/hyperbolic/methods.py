# SPDX-License-Identifier: MIT OR Apache-2.0
"""The three registrations that are compared, each a function of a pair."""

import time

import numpy as np

import authalic
from bench.hyperbolic.harmonic import register
from bench.hyperbolic.measures import Found
from bench.hyperbolic.pairs import shares

HYPERBOLIC, HARMONIC, SPHERES = "hyperbolic", "harmonic, point landmarks", "spheres, point landmarks"
STATIONS = (0, 0.25, 0.5, 0.75, 1)
"""Where on a curve the points of `register_spheres` lie, by shares of its length."""


def hyperbolic(pair, **options):
    """`authalic.register_hyperbolic`, and its certificates as the remark."""
    began = time.perf_counter()
    result = curves_result(pair, **options)
    seconds = time.perf_counter() - began
    return found_of(result, result.certificates.folded, seconds, hyperbolic_remark(result))


def curves_result(pair, **options):
    """What `authalic.register_hyperbolic` returns for a pair."""
    return authalic.register_hyperbolic(
        pair.source.mesh,
        pair.target.mesh,
        source_curves=pair.source.curves,
        target_curves=pair.target.curves,
        **options,
    )


def found_of(result, folded, seconds, remark):
    """What is measured of a result of the package."""
    return Found(result.triangles, result.barycentric, folded, seconds, remark)


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
    return Found(place.triangles, place.barycentric, place.folded, seconds, remark)


def spheres(pair):
    """`authalic.register_spheres` with points on the curves."""
    ours, theirs = landmarks(pair)
    began = time.perf_counter()
    result = authalic.register_spheres(
        pair.source.mesh, pair.target.mesh, source_landmarks=ours, target_landmarks=theirs
    )
    seconds = time.perf_counter() - began
    remark = f"{result.status}, {len(ours)} points" + missed(result)
    return found_of(result, result.distortion.folded, seconds, remark)


def missed(result):
    return f", {len(result.missed)} missed" if len(result.missed) else ""


def landmarks(pair):
    """The vertices of both sides nearest to equal shares of the curves, each pair once."""
    found = {}
    for ours, theirs in zip(pair.source.curves, pair.target.curves, strict=True):
        for share in STATIONS:
            sides = (pair.source.vertices, ours), (pair.target.vertices, theirs)
            place = [int(curve[np.abs(shares(at[curve]) - share).argmin()]) for at, curve in sides]
            # a closed curve begins where it ends
            if place[0] not in found and place[1] not in found.values():
                found[place[0]] = place[1]
    return np.array(list(found)), np.array(list(found.values()))


METHODS = {HYPERBOLIC: hyperbolic, HARMONIC: harmonic, SPHERES: spheres}
