# SPDX-License-Identifier: MIT OR Apache-2.0
"""The cortex: sphere maps of fsaverage5 beside FreeSurfer's own sphere."""

import numpy as np

import authalic
from bench.report import Outcome, fixed, scientific

SURFACES = ("white", "pial")
DESCENTS = {
    "authalic, 100 iterations": {},
    "authalic, 1000 iterations": {"max_iterations": 1000},
}
COLUMNS = (
    "hemisphere", "surface", "map", "area ratio SD", "mean log2 ratio, absolute", "E_A",
    "angle distortion, mean", "p99", "folds", "s",
)  # fmt: skip
NOTE = """\
fsaverage5, 10,242 vertices a hemisphere, the white and the pial surface. FreeSurfer's map is the sphere
that comes with the surfaces (`V_sphere`, scaled to radius 1; one for both surfaces); it respects distances
and angles as well as areas. Angle distortion is σ₁/σ₂ of the faces. All maps are measured by the
same call, `authalic.distortion`."""


def write(bench):
    """The table, or a sentence if there are no data."""
    bench.report.section("fsaverage5 beside FreeSurfer's sphere", NOTE)
    if not bench.brains:
        bench.report.line("Left out: not in the data folder, or not among the chosen meshes.")
        return
    bench.report.columns(COLUMNS)
    for name, arrays in bench.brains.items():
        for surface in SURFACES:
            mesh = arrays[f"V_{surface}"], arrays["F"]
            for method, outcome in _maps(bench, f"{name} {surface}", mesh, arrays["V_sphere"]).items():
                bench.report.row((name, surface, method, *_cells(mesh, outcome)))


def _maps(bench, name, mesh, sphere):
    """{method: outcome whose result is an image (n, 3)}."""
    reference = sphere / np.linalg.norm(sphere, axis=1, keepdims=True)
    maps = {"FreeSurfer": Outcome(reference, "", None)}
    for method, options in DESCENTS.items():
        outcome = bench.run(authalic.sphere_map, name, mesh, **options)
        image = None if outcome.error else outcome.result.positions
        maps[method] = Outcome(image, outcome.error, outcome.seconds)
    return maps


def _cells(mesh, outcome):
    """The figures of a map; maps of all methods are measured by one call."""
    if outcome.error:
        return (outcome.error, "", "", "", "", "", "")
    figures = authalic.distortion(*mesh, outcome.result)
    return (
        fixed(figures.area_ratio_std, 4), fixed(float(np.abs(figures.log2_area_ratio).mean()), 4),
        scientific(figures.authalic_energy), fixed(figures.angle_distortion_mean, 3),
        fixed(figures.angle_distortion_p99, 2), len(figures.folded), fixed(outcome.seconds, 2),
    )  # fmt: skip
