# SPDX-License-Identifier: MIT OR Apache-2.0
"""Maps between surfaces of which others know the right places: error, strain, folds and seconds.

Usage: python -m bench.wrap.main TARGET_FILE [--parts shrec tosca ...] [--pairs 3] [--methods surface ...]

Beside the target go the pictures, and all figures of all pairs as JSON.
"""

from __future__ import annotations

import argparse
import json
import os
from dataclasses import asdict, fields
from pathlib import Path

import numpy as np

import authalic
from bench.peers.worker import message
from bench.report import Report, fixed, machine, plain, scientific
from bench.wrap import geodesics, pairs, pictures
from bench.wrap.measures import Measures, measured
from bench.wrap.methods import AREA, METHODS, PACKAGE, SURFACE, ZOOMOUT, suits

DRAWN = 3
"""The pairs of a collection that are drawn, the first ones."""
COLUMNS = (
    "pair", "V", "method", "error", "error, 95 %", "strain, median", "mean", "95 %", "max(J, 1/J)",
    "sulc, r", "landmarks", "folds", "s", "remark",
)  # fmt: skip
TITLE = f"""\
# Maps between surfaces

authalic {authalic.__version__}, {machine()}, {{load}} processes waiting or running at the start.

*Strain* is (σ₁² + σ₂² + σ₁⁻² + σ₂⁻²)/4 of each source face onto the triangle of its vertices' images, both
surfaces scaled to one area: 1 is an isometry; median, mean and 95th percentile by area. *Error* is the mean
geodesic distance ({{distance}}) between image and true partner where truth is known and not given, over the
root of the target's area; so is *landmarks*, the greatest distance of a given landmark, straight. *max(J,
1/J)* is the mean area distortion, each face at most 10. *Folds* are counted exactly in the domain.

`{SURFACE}` and `{AREA}`, the papers' energy, are `authalic.register_spheres` with holes filled and no
other option. *{ZOOMOUT}* is pyFM's (package {PACKAGE}): wave kernels and the same landmarks, then 30 to 200
eigenfunctions. It takes vertices to vertices and is not one-to-one: faces that it takes to a line or a point
have infinite strain."""


def _load() -> str:
    """How many processes want a processor, which Windows does not say."""
    return f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"


def main(arguments=None):
    """Writes the chosen collections, all by default."""
    options = parsed(arguments)
    report = Report(options.target)
    distance = "along edges and midlines" if geodesics.PyGeodesicAlgorithmExact is None else "exact"
    report.line(TITLE.format(load=_load(), distance=distance))
    records, strains = [], {}
    for collection in pairs.COLLECTIONS:
        if options.parts and collection.part not in options.parts:
            continue
        if not collection.available():
            report.line(f"\nNot measured: the data folder has no {', '.join(collection.files)}.")
            continue
        rows, strains[collection.title] = write(report, options, collection)
        records += rows
        store(options.target.with_suffix(".json"), records)
    if any(strains.values()):
        path = picture(report, "strain")
        pictures.draw_strains(path, "Strain", {title: each for title, each in strains.items() if each})
        report.figure(path, "Strain")


def parsed(arguments=None):
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("target", type=Path)
    known = [collection.part for collection in pairs.COLLECTIONS]
    parser.add_argument("--parts", nargs="+", choices=known)
    parser.add_argument("--pairs", type=int)
    parser.add_argument("--methods", nargs="+", default=[""])
    parser.add_argument("--absent", nargs="+", default=[], type=lambda text: text.split("=", 1))
    options = parser.parse_args(arguments)
    options.absent = dict(options.absent)
    options.methods = [
        name for name in METHODS if any(word.casefold() in name.casefold() for word in options.methods)
    ]
    if not options.methods:
        parser.error(f"there are: {', '.join(METHODS)}")
    return options


def write(report, options, collection):
    """The table of a collection and its pictures; returns its records and {method: strains of all faces}."""
    report.section(collection.title, collection.note)
    report.columns(COLUMNS)
    records, strains, drawn = [], {}, []
    for pair in spread(collection.pairs(), options.pairs):
        maps = {}
        for method in (method for method in options.methods if suits(method, pair)):
            placed, figures, of_faces = run(options, method, pair)
            report.row(cells(pair, method, figures))
            records.append(record(collection, pair, method, figures))
            if placed:
                maps[method] = placed
                strains.setdefault(method, []).append(of_faces)
        if maps and len(drawn) < DRAWN:
            drawn.append((pair, maps))
    for line in means(records):
        report.row(line)
    if drawn:
        path = picture(report, collection.part)
        pictures.draw_pairs(path, collection.title, drawn)
        report.figure(path, f"{collection.title}: the target, and its colors on the source")
    return records, {method: np.concatenate(each) for method, each in strains.items()}


def spread(all_pairs, count):
    """All pairs, or so many of them, evenly spaced."""
    if count is None:
        return all_pairs
    all_pairs = list(all_pairs)
    chosen = np.linspace(0, len(all_pairs) - 1, min(count, len(all_pairs))).round().astype(int)
    return [all_pairs[k] for k in chosen]


def run(options, method, pair):
    """(The places, the measures, the strains), or (None, why there are none, None)."""
    if method == ZOOMOUT and PACKAGE in options.absent:
        return None, f"not installed: {options.absent[PACKAGE]}", None
    try:
        placed = METHODS[method](pair)
    except Exception as problem:  # of a peer, any
        if method != ZOOMOUT and not isinstance(problem, (authalic.MeshError, authalic.SolverError)):
            raise
        return None, message(problem).replace("|", "/"), None
    return placed, *measured(pair, placed)


def cells(pair, method, figures):
    """A row of the table."""
    head = (pair.name, f"{len(pair.source.vertices)} → {len(pair.target.vertices)}", method)
    if not isinstance(figures, Measures):
        return *head, *("–",) * 10, figures
    return *head, *columns(figures), figures.remark


def columns(figures):
    """The cells from the error to the seconds."""
    return (
        fixed(figures.error, 4), fixed(figures.error_p95, 4), fixed(figures.median, 3),
        fixed(figures.mean, 3), fixed(figures.p95, 3), fixed(figures.areas, 3),
        fixed(figures.correlation, 3), scientific(figures.landmarks),
        "not one-to-one" if figures.folded is None else plain(figures.folded), fixed(figures.seconds, 1),
    )  # fmt: skip


def store(path, records):
    """Writes the records; what is infinite becomes null."""
    finite = json.loads(json.dumps(records), parse_constant=lambda _: None)
    path.write_text(json.dumps(finite, indent=1), encoding="utf-8")


def record(collection, pair, method, figures):
    """The figures of a row as a dictionary, for JSON."""
    head = {"collection": collection.part, "pair": pair.name, "method": method}
    head |= {"landmarks_given": len(pair.landmarks)}
    if not isinstance(figures, Measures):
        return head | {"failure": figures}
    return head | {"measures": {key: number(value) for key, value in asdict(figures).items()}}


def number(value):
    """A number of Python's own in the place of numpy's."""
    return value.item() if isinstance(value, np.generic) else value


def means(records):
    """Rows with the mean of each figure over the pairs; folds are added up."""
    for method in dict.fromkeys(each["method"] for each in records):
        rows = [each for each in records if each["method"] == method]
        found = [each["measures"] for each in rows if "measures" in each]
        if found and len(rows) > 1:
            names = (each.name for each in fields(Measures))
            average = {name: mean([figures[name] for figures in found]) for name in names}
            if average["folded"] is not None:
                average["folded"] = sum(figures["folded"] for figures in found)
            failed = f"{len(rows) - len(found)} failed" if len(found) < len(rows) else ""
            figures = Measures(**{**average, "remark": failed})
            yield f"**mean of {len(found)}**", "", method, *columns(figures), figures.remark


def mean(values):
    """The mean, or None where a pair has no figure or a word."""
    numbers = [value for value in values if isinstance(value, (int, float))]
    return sum(numbers) / len(numbers) if len(numbers) == len(values) else None


def picture(report, name):
    """The path of a picture."""
    return report.target.parent / f"{report.target.stem}-{name}.png"


if __name__ == "__main__":
    main()
