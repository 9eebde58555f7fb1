# SPDX-License-Identifier: MIT OR Apache-2.0
"""The command line beside the call it makes, and batches on one worker and on several, in Markdown.

Usage: python -m bench.batch TARGET_FILE [--count SUBJECTS] [--level LEVEL]
"""

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import authalic
from authalic.batch import Subject, find_subjects, run_batch
from authalic.io import MeshData, read_mesh, write_mesh
from bench import meshes
from bench.report import Report, machine

COMMAND_RUNS = 3
EMPTY_SUBJECTS = 15
"""For each subject, so many without a file measure what a batch costs besides maps."""
LOOP = "import time; t = time.perf_counter(); sum(range(50_000_000)); print(time.perf_counter() - t)"


def main(words=None):
    """Measures the command, then the batch."""
    parser = argparse.ArgumentParser()
    parser.add_argument("target", type=Path)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--level", type=int, default=5)
    options = parser.parse_args(words)
    report = Report(options.target)
    report.line(f"Command line and batches, authalic {authalic.__version__}, {machine()}.")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_subjects(folder / "in", options.count, options.level)
        command(report, folder)
        batches(report, folder, options.count)


def write_subjects(folder, count, level):
    """Bumpy spheres, each of its own shape."""
    folder.mkdir()
    points, faces = meshes.icosphere(level)
    x, y, z = points.T
    for number in range(count):
        a, b, c = np.random.default_rng(number).normal(size=3)
        radius = 1 + 0.3 * np.sin(3 * x + a) * np.cos(2 * y + b) + 0.1 * c * z
        write_mesh(folder / f"s{number:03}.ply", MeshData(points * radius[:, None], faces))


def command(report, folder):
    """`authalic sphere`, from its start to its end, beside the call of the library alone."""
    report.section(
        "Command",
        f"Seconds of `authalic sphere`, the least of {COMMAND_RUNS} runs, process and files included.",
    )
    report.columns(("mesh", "vertices", "call", "command", "ratio"))
    surfaces = {"bumpy sphere": folder / "in" / "s000.ply"}
    for name, brain in meshes.brains().items():
        surfaces[name] = folder / "lh.white"
        write_mesh(surfaces[name], MeshData(brain["V_white"], brain["F"]))
    for name, path in surfaces.items():
        mesh = read_mesh(path)
        words = [sys.executable, "-m", "authalic", "sphere", path, folder / "lh.sphere", "--quiet"]
        call = least(lambda mesh=mesh: authalic.sphere_map(mesh.vertices, mesh.faces))
        whole = least(lambda words=words: subprocess.run(words, check=True))
        report.row((name, len(mesh.vertices), f"{call:.2f}", f"{whole:.2f}", f"{whole / call:.2f}"))


def batches(report, folder, count):
    """The same subjects on one worker and on two, each of one native thread."""
    report.section(
        "Batch",
        f"{count} spheres on workers with one native thread each, after the start of the cluster. The same "
        "for a plain loop in as many processes shows what the machine has to give. Overhead: milliseconds "
        "for each subject of a batch whose subjects have no file.",
    )
    report.columns(("workers", "seconds", "of one worker", "loop, of one process", "overhead, ms"))
    subjects = find_subjects([folder / "in"])
    empty = [Subject(f"n{k:04}", folder / f"none{k}.off") for k in range(EMPTY_SUBJECTS * count)]
    first = first_loop = None
    for workers in (1, 2):
        seconds = batch_seconds(subjects, folder / f"out{workers}", workers)
        loop = loop_seconds(workers) / workers
        first, first_loop = first or seconds, first_loop or loop
        overhead = 1e3 * batch_seconds(empty, folder / f"empty{workers}", workers) / len(empty)
        shares = f"{seconds / first:.2f}", f"{loop / first_loop:.2f}"
        report.row((workers, f"{seconds:.1f}", *shares, f"{overhead:.1f}"))


def batch_seconds(subjects, folder, workers):
    """Seconds of a batch from the moment when its cluster is there."""
    began = []
    run_batch(
        subjects, folder, workers=workers, threads=1, announce=lambda _: began.append(time.perf_counter())
    )
    return time.perf_counter() - began[0]


def loop_seconds(processes):
    """The mean seconds of a loop that several processes run at the same time."""
    started = [
        subprocess.Popen([sys.executable, "-c", LOOP], stdout=subprocess.PIPE, text=True)
        for _ in range(processes)
    ]
    return float(np.mean([float(process.communicate()[0]) for process in started]))


def least(call):
    """The least seconds of some calls."""
    seconds = []
    for _ in range(COMMAND_RUNS):
        began = time.perf_counter()
        call()
        seconds.append(time.perf_counter() - began)
    return min(seconds)


if __name__ == "__main__":
    main()
