# SPDX-License-Identifier: MIT OR Apache-2.0
"""The pairs of the bench, of the data folder: animals, poses, cortices and heads."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field

import numpy as np

from bench import meshes
from bench.hyperbolic import pairs as cortices
from bench.wrap.geodesics import Geodesics, farthest
from shell import DATA

CLASSES = ("cat", "dog", "horse", "centaur", "michael", "victoria", "8_gorilla")
GORILLA, HUMANS = "8_gorilla", ("8_man", "8_woman")
LANDMARKS = 8
"""The landmarks of a pair of TOSCA."""
CHECKED = 500
"""About as many true correspondences are measured, evenly spaced in the list."""
PARCELS = 12
"""The parcels with landmarks of the HCP averages."""
HEADS = {
    "david_10671": (9647, 2244, 650, 101, 6851, 48, 6344, 3237, 4348),
    "maxplanck_9002": (7478, 73, 1188, 6628, 704, 2498, 3595, 5077, 8261),
}
"""Nose, chin, left and right eye, left and right ear, front and back of the neck's rim, crown; by eye."""


@dataclass(frozen=True)
class Surface:
    """A mesh and its signals, {name: one value per vertex}."""

    name: str
    vertices: np.ndarray
    faces: np.ndarray
    signals: dict = field(default_factory=dict)

    @property
    def mesh(self):
        return self.vertices, self.faces


@dataclass(frozen=True)
class Pair:
    """A source to be mapped onto a target: `landmarks` (k, 2) are given, `truth` (l, 2) is measured."""

    source: Surface
    target: Surface
    landmarks: np.ndarray
    truth: np.ndarray
    features: bool = False
    """Whether the signals lead the map."""

    @property
    def name(self):
        return f"{self.source.name} → {self.target.name}"


NO_PAIRS = np.empty((0, 2), int)


def arrays(kind, name):
    """The arrays of a file of the data folder."""
    with np.load(DATA / kind / f"{name}.npz") as stored:
        return dict(stored)


def surface(kind, name):
    """A mesh of the data folder, and all its arrays."""
    stored = arrays(kind, name)
    return Surface(name, stored["V"].astype(float), stored["F"]), stored


def names(kind, *starts):
    """The files of a folder of the data folder whose names begin with one of the words."""
    return sorted(path.stem for path in (DATA / kind).glob("*.npz") if path.stem.startswith(starts or ("",)))


def animals(step):
    """SHREC'07: nine animals in pairs; every `step`-th of the 21 landmarks is given, the others measured."""
    stored = [surface("bench/shrec07", name) for name in names("bench/shrec07")]
    marked = [(mesh, of_file["landmarks"]) for mesh, of_file in stored if "landmarks" in of_file]
    for (source, p), (target, q) in itertools.combinations(marked, 2):
        both = np.stack([p, q], axis=1)
        given = np.arange(len(both)) % step == 0
        yield Pair(source, target, both[given], both[~given])


def poses():
    """TOSCA: all pairs within a class."""
    for start in CLASSES:
        yield from map(corresponding, itertools.combinations(names("bench/tosca", start), 2))


def primates():
    """TOSCA: the gorillas onto men and women."""
    across = itertools.product(names("bench/tosca", GORILLA), names("bench/tosca", *HUMANS))
    yield from map(corresponding, across)


def corresponding(both):
    """A pair of TOSCA; its landmarks are the true correspondences farthest from each other on the source."""
    (source, first), (target, second) = (surface("bench/tosca", name) for name in both)
    true = np.stack([first["corres"], second["corres"]], axis=1)
    chosen = farthest(Geodesics(*source.mesh), true[:, 0], LANDMARKS)
    others = np.setdiff1d(np.arange(len(true)), chosen)
    return Pair(source, target, true[chosen], true[others[:: max(len(others) // CHECKED, 1)]])


def hemispheres(features):
    """fsaverage5, white, left onto mirrored right: by ends and middles of 12 curves, or by signals alone."""
    pair = cortices.across("white", 12)
    source, target = (
        Surface(name, side.vertices, side.faces, dict(side.fields))
        for name, side in (("fsaverage5 left", pair.source), ("right", pair.target))
    )
    marks = [
        [(p[0], q[0]), (p[len(p) // 2], q[len(q) // 2]), (p[-1], q[-1])]
        for p, q in zip(pair.source.curves, pair.target.curves, strict=True)
    ]
    landmarks = NO_PAIRS if features else distinct(np.concatenate(marks))
    yield Pair(source, target, landmarks, NO_PAIRS, features)


def averages():
    """The HCP averages S1200 and Conte69, which have the same vertices: landmarks amid parcels far apart."""
    stored = arrays("brain", cortices.HCP[0])
    source = Surface("S1200", stored["V_midthickness"], stored["F"])
    target = Surface("Conte69", stored["V_conte69_midthickness"], stored["F"])
    centers = parcel_centers(stored["V_sphere"], stored["mmp"])
    chosen = centers[farthest(Geodesics(*source.mesh), centers, PARCELS)]
    checked = np.setdiff1d(np.arange(0, len(source.vertices), len(source.vertices) // CHECKED), chosen)
    yield Pair(source, target, np.stack([chosen] * 2, axis=1), np.stack([checked] * 2, axis=1))


def parcel_centers(sphere, labels):
    """For each parcel the vertex nearest to its mean on the sphere; label 0 is no parcel."""
    centers = []
    for label in np.unique(labels[labels > 0]):
        inside = np.flatnonzero(labels == label)
        offsets = sphere[inside] - sphere[inside].mean(axis=0)
        centers.append(inside[np.linalg.norm(offsets, axis=1).argmin()])
    return np.array(centers)


def distinct(landmarks):
    """The landmarks (k, 2) without those that share a vertex with one before."""
    for side in (0, 1):
        first = np.unique(landmarks[:, side], return_index=True)[1]
        landmarks = landmarks[np.sort(first)]
    return landmarks


def heads():
    """David onto Max Planck, with nine landmarks chosen by eye."""
    source, target = (surface("sphere", name)[0] for name in HEADS)
    yield Pair(source, target, np.stack(list(HEADS.values()), axis=1), NO_PAIRS)


@dataclass(frozen=True)
class Collection:
    """A table of the bench: its part, its title, a note, what it needs and its pairs."""

    part: str
    title: str
    note: str
    files: tuple
    pairs: object

    def available(self):
        """Whether the data folder has its files."""
        return all((DATA / file).exists() for file in self.files)


_BRAINS = (*(f"brain/{name}.npz" for name in meshes.FSAVERAGE5), f"brain/{cortices.CURVES}")
_FARTHEST = (
    "The landmarks are the true correspondences farthest from each other on the source: the first from the "
    f"mean of all, each further one from those before it. About {CHECKED} of the others are measured."
)
COLLECTIONS = (
    Collection(
        "shrec", "SHREC'07, 21 landmarks", "Four-legged animals of different kinds; all landmarks are given.",
        ("bench/shrec07",), lambda: animals(1),
    ),
    Collection(
        "shrec11", "SHREC'07, 11 landmarks", "Every other landmark is given, the ten others are measured.",
        ("bench/shrec07",), lambda: animals(2),
    ),
    Collection("tosca", "TOSCA within classes, 8 landmarks", _FARTHEST, ("bench/tosca",), poses),
    Collection(
        "primates", "TOSCA, gorillas onto humans, 8 landmarks", _FARTHEST, ("bench/tosca",), primates,
    ),
    Collection(
        "brains", "fsaverage5, left onto mirrored right, by landmarks",
        "White surfaces; the ends and middles of 12 curves.", _BRAINS, lambda: hemispheres(False),
    ),
    Collection(
        "signals", "fsaverage5, left onto mirrored right, by signals",
        "White surfaces; sulc and curv lead the map, without a landmark.", _BRAINS, lambda: hemispheres(True),
    ),
    Collection(
        "averages", "S1200 onto Conte69",
        f"Two averages with the same vertices; landmarks amid {PARCELS} parcels far apart.",
        (f"brain/{cortices.HCP[0]}.npz",), averages,
    ),
    Collection(
        "heads", "David onto Max Planck", "Nine landmarks by eye: nose, chin, eyes, ears, neck and crown.",
        tuple(f"sphere/{name}.npz" for name in HEADS), heads,
    ),
)  # fmt: skip
