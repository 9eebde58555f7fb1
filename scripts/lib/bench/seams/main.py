# SPDX-License-Identifier: MIT OR Apache-2.0
"""Automatic seams beside Blender's Smart UV Project with Minimum Stretch and xatlas, in one run.

Usage: python -m bench.seams.main TARGET_FILE [--meshes NAME ...] [--methods WORD ...]
           [--parts packing pictures] [--timeout SECONDS] [--blender PYTHON] [--absent PACKAGE=MESSAGE ...]

The pictures go to a folder beside the target.
"""

import argparse
from functools import partial
from pathlib import Path

import authalic
from bench.report import Report, machine
from bench.seams import figures, meshes, ours, peers, pictures, table
from bench.seams.layout import Failure, Layout

PARTS = ("table", "packing", "pictures")
"""The table is always written; the others are Blender's packer on all islands, and the sheet."""
BLENDER, XATLAS = "Smart UV Project + Minimum Stretch", "xatlas"
MISSING = "Not measured, as ../shared/data or the folder AUTHALIC_DATA does not have them: {}."


def main(arguments=None):
    """Measures every method on every mesh; then draws the sheet."""
    options = parsed(arguments)
    report = Report(options.target)
    report.line(f"# Automatic seams\n\nauthalic {authalic.__version__}, {machine()}, single runs.")
    named_meshes, missing = meshes.chosen(options.meshes)
    if missing:
        report.line("\n" + MISSING.format(", ".join(missing)))
    if not named_meshes:
        return
    report.section("Seams, islands and distortion", table.NOTE)
    report.columns(table.COLUMNS)
    layouts = {name: measured(report, options, name, mesh) for name, mesh in named_meshes.items()}
    if "pictures" in options.parts:
        path = folder(options) / "sheet.png"
        pictures.draw(path, named_meshes, layouts)
        report.figure(path, "Seams in front and at the back, and the layouts")


def parsed(arguments=None):
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("target", type=Path)
    parser.add_argument("--meshes", nargs="+", default=[])
    parser.add_argument("--methods", nargs="+", default=[])
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=PARTS)
    parser.add_argument("--timeout", type=float, default=300.0)
    parser.add_argument("--blender", default="")
    parser.add_argument("--absent", nargs="+", default=[], type=lambda text: text.split("=", 1))
    options = parser.parse_args(arguments)
    options.absent = dict(options.absent)
    if not methods(options):
        parser.error(f"no method {', '.join(options.methods)}")
    return options


def methods(options):
    """{name: call}, only those that one of the words names."""
    known = {f"authalic {target:g}": partial(ours.unwrapped, target=target) for target in ours.TARGETS}
    known |= {BLENDER: blender(options).unwrapped, XATLAS: partial(xatlas, options)}
    words = [word.casefold() for word in options.methods] or [""]
    return {name: call for name, call in known.items() if any(word in name.casefold() for word in words)}


def blender(options):
    """Blender with its folder of files."""
    absent = options.absent.get("bpy", "no interpreter was given")
    return peers.Blender(options.blender, absent, folder(options), options.timeout)


def xatlas(options, vertices, faces):
    """The layout of xatlas, if it is installed."""
    if XATLAS in options.absent:
        return Failure(f"not installed: {options.absent[XATLAS]}")
    return peers.xatlas(vertices, faces)


def folder(options):
    """The folder of the pictures and of the files for Blender."""
    path = options.target.with_suffix("")
    path.mkdir(parents=True, exist_ok=True)
    return path


def measured(report, options, name, mesh):
    """Writes the rows of a mesh; returns {method: (layout, figures)} of the methods that have one."""
    layouts = {}
    for method, call in methods(options).items():
        layout = call(*mesh)
        quality, packed = None, None
        if isinstance(layout, Layout):
            quality = figures.measured(*mesh, layout.corners)
            packed = packed_by_blender(options, mesh, layout)
            layouts[method] = layout, quality
        report.row(table.cells(name, mesh[0], method, layout, quality, packed))
    return layouts


def packed_by_blender(options, mesh, layout):
    """The share of the square and the seconds of Blender's packer, or why it has none; None if not wanted."""
    if "packing" not in options.parts:
        return None
    packed = blender(options).packed(*mesh, layout.corners)
    if isinstance(packed, Failure):
        return packed
    return figures.uv_areas(packed.corners).sum(), packed.seconds


if __name__ == "__main__":
    main()
