# SPDX-License-Identifier: MIT OR Apache-2.0
"""The papers' tables, repeated on their models and on others, in Markdown.

Usage: python -m bench.tables.main TARGET_FILE [--parts PART ...] [--meshes NAME ...] [--repeat N] [--long]

The plots go beside the target.
"""

import argparse
import time
from dataclasses import dataclass
from pathlib import Path

import authalic
from bench import meshes
from bench.report import Report, Runs, machine
from bench.tables import brain, disk, sphere, stability

PARTS = {
    "disk": disk.write,
    "line-search": sphere.write_line_searches,
    "fixed-point": sphere.write_fixed_point,
    "noise": stability.write_noise,
    "hessian": stability.write_hessian,
    "fsaverage5": brain.write,
}


@dataclass(frozen=True)
class Bench:
    """The report, runs and meshes of all parts."""

    report: Report
    run: Runs
    disks: dict
    spheres: dict
    brains: dict
    long: bool

    @property
    def folder(self):
        """The folder of the plots."""
        return self.report.target.parent


def main(arguments=None):
    """Writes the chosen parts, all of them by default, in the order of the list."""
    options = parsed(arguments)
    began = time.perf_counter()
    bench = prepared(options)
    runs = "single runs" if options.repeat == 1 else f"medians of {options.repeat} runs"
    bench.report.line(f"# The papers' tables, repeated\n\nauthalic {authalic.__version__}, {machine()}.")
    bench.report.line(
        f"Seconds are wall seconds of the whole call, {runs}. E_A is the authalic energy with the areas of "
        "the surface scaled to those of the image. Published figures are the papers', from their machines; "
        "the models they are published for: Chinese Lion, Left Hand, David Head, Bulldog."
    )
    for part in PARTS:
        if part in options.parts:
            PARTS[part](bench)
    bench.report.line(f"\nThe whole took {time.perf_counter() - began:.0f} s.")


def parsed(arguments=None):
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("target", type=Path)
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS))
    parser.add_argument("--meshes", nargs="+", default=[])
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--long", action="store_true")
    return parser.parse_args(arguments)


def prepared(options):
    """The chosen meshes, and an empty report."""
    kinds = [meshes.disks(), meshes.spheres(), meshes.brains()]
    meshes.check_names(options.meshes, [name for kind in kinds for name in kind])
    disks, spheres, brains = (
        {name: mesh for name, mesh in kind.items() if not options.meshes or name in options.meshes}
        for kind in kinds
    )
    return Bench(Report(options.target), Runs(options.repeat), disks, spheres, brains, options.long)


if __name__ == "__main__":
    main()
