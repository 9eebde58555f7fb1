# SPDX-License-Identifier: MIT OR Apache-2.0
"""Starts the processes of the comparison and measures what comes back, always by `authalic.distortion`."""

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
    """A map's quality; areas by those of the surface, the whole image scaled to the disk or the sphere."""

    deviation: float
    energy: float
    folds: int
    angle_mean: float
    """Of σ₁/σ₂ over the faces that are not folded, like its 99th percentile."""
    angle_p99: float


@dataclass(frozen=True)
class Row:
    """What came of one method on one mesh; without figures the remark says why."""

    mesh: str
    vertices: int
    method: object
    remark: str
    figures: Figures = None
    seconds: float = 0.0
    peak: float = 0.0
    """Resident memory in MiB, the interpreter and the tool's own code included."""
    before: float = 0.0
    """The same before the call."""
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
        problem = self._run([python, *WORKER, kind, method.name, source, target])
        return Row(*head, problem) if problem else read(target, head, mesh)

    def _run(self, command):
        """Waits for a process; what went wrong, or nothing."""
        words = [str(word) for word in command]
        with open(self.folder / "log.txt", "ab") as log:
            process = subprocess.Popen(
                words, env={**os.environ, **PYTHONPATH}, stdout=log, stderr=log, start_new_session=True
            )
            try:
                code = process.wait(self.limit)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
                return f"stopped after {self.limit:g} s"
        if code < 0:
            return f"crashed: {signal.Signals(-code).name}"
        return f"ended with code {code}, see {self.folder / 'log.txt'}" if code else ""


def read(path, head, mesh):
    """The row of a result that a worker left."""
    with np.load(path) as arrays:
        found = dict(arrays)
    facts = json.loads(str(found.pop("facts")))
    if "error" in facts:
        return Row(*head, facts["error"])
    vertices, faces = found.get("vertices", mesh[0]), found.get("faces", mesh[1])
    try:
        figures = measured(vertices, faces, found["image"])
    except authalic.MeshError as problem:
        return Row(*head, f"the map cannot be measured: {problem}")
    return Row(
        *head, facts["remark"], figures, facts["seconds"], facts["peak"], facts["before"], "faces" in found
    )


def measured(vertices, faces, image):
    """The figures of a map into the plane or onto a sphere, turned and scaled so that maps compare."""
    image = scaled(upright(np.asarray(image, float), faces), faces)
    found = authalic.distortion(vertices, faces, image)
    angles = np.delete(found.angle_distortion, found.folded)
    mean, p99 = (angles.mean(), np.percentile(angles, 99)) if len(angles) else (np.inf, np.inf)
    return Figures(found.area_ratio_std, found.authalic_energy, len(found.folded), mean, p99)


def upright(image, faces):
    """Mirrors every chart most of whose area is negative: a mirrored chart is no fold."""
    chart = charts(faces, len(image))
    negative = np.bincount(chart[faces[:, 0]], orientation(image, faces), chart.max() + 1) < 0
    image = image.copy()
    image[negative[chart], 0] *= -1
    return image


def charts(faces, count):
    """The number of the connected piece that each vertex belongs to, (count,)."""
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
