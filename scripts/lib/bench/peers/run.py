# SPDX-License-Identifier: MIT OR Apache-2.0
"""Starts the processes of the comparison and measures their maps, always by `authalic.distortion`."""

import json
import os
import signal
import subprocess
import sys
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

import authalic
from shell import PYTHONPATH

WORKER = ("-m", "bench.peers.worker")


@dataclass(frozen=True)
class Figures:
    """A map's quality, with the whole image scaled to the disk or the sphere."""

    deviation: float
    energy: float
    folds: int
    angle_mean: float
    """The mean of σ₁/σ₂ over the faces that are not folded; the percentile is over these too."""
    angle_p99: float


@dataclass(frozen=True)
class Row:
    """The outcome of one method on one mesh; without figures the remark says why."""

    mesh: str
    vertices: int
    method: object
    remark: str
    figures: Figures = None
    seconds: float = 0.0
    peak: float = 0.0
    """Peak of resident memory in MiB, including the interpreter and the tool's code."""
    before: float = 0.0
    """Peak of resident memory before the call, in MiB."""
    cut: bool = False
    """Whether the map is of the mesh cut into charts."""


class Starter:
    """Runs methods one after the other."""

    def __init__(self, folder, limit, blender, absent):
        self.folder, self.limit, self.absent = folder, limit, absent
        self.python = {"bpy": blender}
        folder.mkdir(parents=True, exist_ok=True)

    def __call__(self, kind, name, mesh, method):
        """The row of a method on a mesh."""
        head = (name, len(mesh[0]), method)
        if method.package in self.absent:
            return Row(*head, f"not installed: {self.absent[method.package]}")
        source, target = self.folder / "mesh.npz", self.folder / "map.npz"
        np.savez(source, V=mesh[0], F=mesh[1])
        target.unlink(missing_ok=True)
        python = self.python.get(method.package) or sys.executable
        command = [python, *WORKER, kind, method.name, source, target]
        problem = finished(command, self.limit, self.folder / "log.txt")
        return Row(*head, problem) if problem else read(target, head, mesh)


def finished(command, limit, log_file):
    """Waits for a process, `limit` seconds at most; returns its problem, or an empty string."""
    words = [str(word) for word in command]
    with open(log_file, "ab") as log:
        process = subprocess.Popen(
            words, env={**os.environ, **PYTHONPATH}, stdout=log, stderr=log, start_new_session=True
        )
        try:
            code = process.wait(limit)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return f"stopped after {limit:g} s"
    if code < 0:
        return f"crashed: {signal.Signals(-code).name}"
    return f"ended with code {code}, see {log_file}" if code else ""


def read(path, head, mesh):
    """The row of a result that a worker left."""
    with np.load(path) as arrays:
        stored = dict(arrays)
    facts = json.loads(str(stored.pop("facts")))
    if "error" in facts:
        return Row(*head, facts["error"])
    vertices, faces = stored.get("vertices", mesh[0]), stored.get("faces", mesh[1])
    try:
        figures = measured(vertices, faces, stored["image"])
    except authalic.MeshError as problem:
        return Row(*head, f"the map cannot be measured: {problem}")
    return Row(
        *head, facts["remark"], figures, facts["seconds"], facts["peak"], facts["before"], "faces" in stored
    )


def measured(vertices, faces, image):
    """The figures of a map into the plane or onto a sphere, with its image turned and scaled."""
    image = scaled(upright(np.asarray(image, float), faces), faces)
    quality = authalic.distortion(vertices, faces, image)
    angles = np.delete(quality.angle_distortion, quality.folded)
    mean, p99 = (angles.mean(), np.percentile(angles, 99)) if len(angles) else (np.inf, np.inf)
    return Figures(quality.area_ratio_std, quality.authalic_energy, len(quality.folded), mean, p99)


def upright(image, faces):
    """Mirrors every chart whose area is mostly negative: a mirrored chart is no fold."""
    chart = charts(faces, len(image))
    negative = np.bincount(chart[faces[:, 0]], orientation(image, faces), chart.max() + 1) < 0
    image = image.copy()
    image[negative[chart], 0] *= -1
    return image


def charts(faces, count):
    """The number of the component that each vertex belongs to, (count,)."""
    i, j = np.concatenate([faces[:, :2], faces[:, 1:]]).T
    graph = coo_matrix((np.ones(len(i)), (i, j)), (count, count))
    return connected_components(graph, directed=False)[1]


def orientation(image, faces):
    """Twice the signed area of each face in the plane; its determinant on a sphere, (m,)."""
    a, b, c = (image[faces[:, k]] for k in range(3))
    if image.shape[1] == 3:
        return np.einsum("ij,ij->i", a, np.cross(b - a, c - a))
    u, v = b - a, c - a
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def scaled(image, faces):
    """A plane image of area π, or one on the unit sphere, so that energies compare."""
    if image.shape[1] == 3:
        return image / np.linalg.norm(image, axis=1, keepdims=True)
    area = np.abs(orientation(image, faces)).sum() / 2
    return image * np.sqrt(np.pi / area) if area > 0 else image
