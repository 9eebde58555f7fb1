# SPDX-License-Identifier: MIT OR Apache-2.0
"""Checks for any mesh, sound or not: a sound map or a named error, judged without the library."""

import inspect
from typing import NamedTuple

import numpy as np

import authalic

from . import oracle

STATUSES = {"converged", "max_iterations", "stalled", "cancelled"}
DEFAULT = inspect.signature(authalic.disk_map).parameters["method"].default
METHODS = {
    authalic.disk_map: ("fixed_point", "conjugate_gradient"),
    authalic.sphere_map: ("fixed_point", "gradient_descent"),
}


class Outcome(NamedTuple):
    """The outcome of a map: its status, or the error; the SD of the area ratio if there is a map."""

    status: str
    deviation: float = np.nan


def assert_sound_case(case, **options):
    """The map of a sound mesh is an embedding; returns the outcome.

    The contract allows a SolverError; the caller says whether it is welcome.
    """
    call = authalic.disk_map if case.kind == "disk" else authalic.sphere_map
    try:
        result = call(*case.mesh, **options)
    except authalic.SolverError as error:
        assert_says_what(error)
        return Outcome(f"SolverError: {error}")
    assert_sound_result(result, call)
    return Outcome(result.status, result.distortion.area_ratio_std)


def assert_hostile_case(case, **options):
    """Every function does its work on the mesh, or says what is wrong with it."""
    outcomes = [attempted(call, case.mesh, **options) for call in (authalic.disk_map, authalic.sphere_map)]
    holes = attempted(authalic.disk_map, case.mesh, fill_holes=True, **options)
    patches = cut_or_refused(case.mesh)
    if patches is not None:
        assert sum(len(patch.faces) for patch in patches) == len(case.mesh.faces)
    return Outcome(", ".join([*outcomes, holes]))


def attempted(call, mesh, **options):
    """Maps a mesh; returns the status, or the name of the error."""
    try:
        result = call(*mesh, **options)
    except (authalic.MeshError, authalic.SolverError) as error:
        assert_says_what(error)
        return type(error).__name__
    assert_sound_result(result, call, options.get("fill_holes", False))
    return result.status


def cut_or_refused(mesh):
    """The patches, or None."""
    try:
        return authalic.cut(*mesh)
    except authalic.MeshError as error:
        assert_says_what(error)
        return None


def assert_says_what(error):
    """The error's message is readable, and names no internal error."""
    text = str(error)
    assert text.isprintable() and len(text) > 15, repr(text)
    assert "internal error" not in text and "panic" not in text, text


def assert_sound_result(result, call, holes=False):
    """An embedding without a folded face by exact arithmetic, with figures that are numbers."""
    assert result.status in STATUSES
    assert np.isfinite(result.distortion.authalic_energy)
    assert np.isfinite(result.history["authalic_energy"]).all()
    if call is authalic.sphere_map:
        oracle.assert_sphere_embedding(result)
    elif holes:
        assert oracle.folded(result.uv, result.faces) == []
        assert np.hypot(*result.uv.T).max() <= 1 + 1e-12
    else:
        oracle.assert_disk_embedding(result)


def random_options(seed, case):
    """Random options, often none: method, boundary, density, limit, or a cancel after a few reports."""
    rng = np.random.default_rng([seed, 1])
    call = authalic.sphere_map if case.kind == "sphere" else authalic.disk_map
    options = {}
    if rng.random() < 0.5:
        return options
    if case.kind != "hostile" and rng.random() < 0.3:
        options["method"] = str(rng.choice(METHODS[call]))
    elif case.kind != "hostile" and DEFAULT == "gauss_newton" and rng.random() < 0.3:
        options["angle_weight"] = float(10 ** rng.uniform(-6, 1))
    if case.kind == "disk" and rng.random() < 0.3:
        options["boundary"] = str(rng.choice(["arc_length", "sliding"]))
    if case.kind != "hostile" and rng.random() < 0.3:
        options["density"] = np.exp(rng.uniform(0, 2) * rng.standard_normal(len(case.mesh.faces)))
    if rng.random() < 0.3:
        options["max_iterations"] = int(rng.integers(0, 8))
    if rng.random() < 0.2:
        options["progress"] = cancel_after(int(rng.integers(0, 30)))
    return options


def cancel_after(reports):
    """A progress function that cancels after some reports."""
    left = iter(range(reports))
    return lambda fraction, message: next(left, None) is not None
