# SPDX-License-Identifier: MIT OR Apache-2.0
"""The front of areas against angles: SD and mean σ₁/σ₂ at each `angle_weight`, for every boundary."""

import authalic
from bench.angle import plot

WEIGHTS = (1, 0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5)
BOUNDARIES = ("sliding", "arc_length", "free")
SPHERE = "sphere"
MODELS = (
    "cowboyhat_2327", "lionhead_8356", "chineselion_17334", "camelhead_11381", "face_17157",
    "spot_2930", "david_10671", "maxplanck_9002", "brain_12502", "fsavg5_pialL_10242",
)  # fmt: skip
"""The meshes that are measured if none are named."""
NOTE = """\
SD of the area ratio and mean of σ₁/σ₂ over the faces, both `authalic.distortion`'s, at each `angle_weight`
for each boundary of a disk, and for spheres. A star: the map has not converged. Further left angles count
more, further right areas; a map below and left of another one in the plot is better in both."""


def write(report, models):
    """The table and the plot of {name: (mesh, function)}."""
    report.section("The front", NOTE)
    report.columns(("mesh", "boundary", *(f"{weight:g}" for weight in WEIGHTS)))
    fronts = {}
    for name, (mesh, call) in models.items():
        fronts[name] = {kind: _row(report, name, kind, mesh, call) for kind in kinds(call)}
    fronts = {name: {kind: front for kind, front in rows.items() if front} for name, rows in fronts.items()}
    fronts = {name: rows for name, rows in fronts.items() if rows}
    if fronts:
        path = report.target.parent / f"{report.target.stem}-front.png"
        plot.draw_fronts(path, "The front of areas against angles", fronts)
        report.figure(path, "The front of areas against angles")


def kinds(call):
    """The boundaries to measure."""
    return BOUNDARIES if call is authalic.disk_map else (SPHERE,)


def _row(report, name, kind, mesh, call):
    """One row of the table; returns the (weight, SD, σ₁/σ₂) of its maps."""
    options = {"boundary": kind} if kind in BOUNDARIES else {}
    maps = [_map(mesh, call, weight, options) for weight in WEIGHTS]
    report.row((name, kind, *map(cell, maps)))
    pairs = zip(WEIGHTS, maps, strict=True)
    return [(weight, *_figures(map_)) for weight, map_ in pairs if not isinstance(map_, str)]


def _map(mesh, call, weight, options):
    """A map, or the name of the error that there was."""
    try:
        return call(*mesh, angle_weight=float(weight), **options)
    except (authalic.SolverError, ValueError) as problem:
        return type(problem).__name__


def cell(map_):
    """SD and σ₁/σ₂ of a map, or the name of an error."""
    if isinstance(map_, str):
        return map_
    deviation, angle = _figures(map_)
    return f"{deviation:.4f} {angle:.2f}{'' if map_.status == 'converged' else '*'}"


def _figures(map_):
    return map_.distortion.area_ratio_std, map_.distortion.angle_distortion_mean
