# SPDX-License-Identifier: MIT OR Apache-2.0
"""Looks for failures: random meshes, sound and hostile, in Rust and in Python.

Usage: python -m bench.fuzz.main TARGET_FILE [--seconds N | --cases N | --seed N] [--limit SECONDS]

With --seconds, the property tests of the crates take half of the time, a loop over numbered cases the other
half. A case follows from its number: of three, one is a sound mesh with the default options, one a sound mesh
with any options, one a mesh that may be spoiled. --cases makes the first kind only. Each must be mapped onto
an embedding, judged by exact arithmetic outside the library, or be refused with a named error; a crash, a
hang or anything else fails. --seed repeats one case, in this process.
"""

import argparse
import sys
import time
from collections import Counter
from itertools import count
from pathlib import Path

import numpy as np

import authalic
from bench.fuzz import rust
from bench.fuzz.cases import Worker, case_of, judged
from bench.report import Report, machine

COLUMNS = ("surface", "cases", "folds", "statuses", "refused", "SD median", "SD worst", "slowest, s")


def main(arguments=None):
    """Searches and reports; returns 0 if nothing failed."""
    options = parsed(arguments)
    if options.seed is not None:
        return replay(options.seed)
    report = Report(options.target)
    report.line(f"# Random meshes\n\nauthalic {authalic.__version__}, {machine()}.\n")
    failures = []
    if options.cases is None:
        failures += rust.search(report, options.seconds / 2, options.limit)
    done = search(options)
    write_table(report, [case for case in done if case.kind == "sound"])
    failures += write_failures(report, done)
    report.line(f"\n{len(done)} cases in Python, {len(failures)} failures in all.")
    return 1 if failures else 0


def parsed(arguments=None):
    """The options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("target", type=Path)
    chosen = parser.add_mutually_exclusive_group()
    chosen.add_argument("--seconds", type=float, default=300.0)
    chosen.add_argument("--cases", type=int)
    chosen.add_argument("--seed", type=int)
    parser.add_argument("--limit", type=float, default=60.0)
    return parser.parse_args(arguments)


def search(options):
    """The outcomes of the cases: as many as asked for, or until the time is over."""
    ends = time.monotonic() + options.seconds / 2
    numbers = count() if options.cases is None else range(0, 3 * options.cases, 3)
    done, worker = [], Worker(options.limit)
    for number in numbers:
        if options.cases is None and time.monotonic() > ends:
            break
        done.append(worker(number))
        if done[-1].failure:
            print(f"FAILED {done[-1].failure}\n  again: scripts/bench fuzz --seed {number}", flush=True)
        elif len(done) % 200 == 0:
            print(f"{len(done)} cases ...", flush=True)
    worker.stop()
    return done


def write_table(report, cases):
    """The outcomes of the sound meshes with the default options, by kind of surface."""
    report.section("Sound meshes, default options", "Folds by exact arithmetic, outside the library.")
    report.columns(COLUMNS)
    for name in sorted({case.name for case in cases}):
        report.row((name, *summary([case for case in cases if case.name == name])))
    if cases:
        report.row(("all", *summary(cases)))


def summary(cases):
    """The cells of a group of cases."""
    mapped = [case for case in cases if not np.isnan(case.deviation)]
    statuses = Counter(case.status for case in mapped)
    folds = sum("folded" in case.failure for case in cases)
    text = ", ".join(f"{number} {status}" for status, number in statuses.most_common())
    deviations = [case.deviation for case in mapped] or [np.nan]
    refused, slowest = sum(map(is_refused, cases)), max(case.seconds for case in cases)
    return (
        len(cases), folds, text, refused,
        f"{np.median(deviations):.1e}", f"{max(deviations):.1e}", f"{slowest:.2f}",
    )  # fmt: skip


def is_refused(case):
    """Whether a sound mesh got no map."""
    return case.kind != "hostile" and case.status.startswith("SolverError")


def write_failures(report, cases):
    """Names every failure, and the sound meshes that were refused; returns the failures."""
    refused = list(filter(is_refused, cases))
    if refused:
        report.line("\nSound meshes that were refused:\n")
    for case in refused:
        report.line(f"- case {case.number}, {case.name}: {case.status}")
    failed = [case for case in cases if case.failure]
    if failed:
        report.line("\nFailures (again: `scripts/bench fuzz --seed CASE`):\n")
    for case in failed:
        report.line(f"- case {case.number}, {case.name}: {case.failure}")
    return failed


def replay(number):
    """Repeats one case and prints everything about it."""
    case, options = case_of(number)
    vertices, faces = case.mesh
    print(f"case {number}: {case.name} ({case.kind}), {len(vertices)} vertices, {len(faces)} faces")
    print(f"options: {options}")
    began = time.perf_counter()
    print(f"outcome: {judged(case, options)}, {time.perf_counter() - began:.2f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
