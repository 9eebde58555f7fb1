# SPDX-License-Identifier: MIT OR Apache-2.0
"""
Cells to spherical harmonics
============================

Spherical harmonics describe the shape of a cell, a nucleus or a grain by a list of numbers. For that, its
surface must first become a function on the sphere: a place in space for each direction. A ray from the
middle gives one only if the cell has no arms; a map onto the sphere does for every surface without handles.
A map that keeps areas gives each part of the cell as much of the sphere as it has of the surface, so that
arms are not lost in a point.

This page needs ``pip install pyshtools matplotlib``. A body made by code stands for a cell; yours comes
from a segmentation.
"""

import matplotlib.pyplot as plt
import numpy as np
import pyshtools
from pictures import draw_surface, star

import authalic

vertices, faces = star(arms=4, length=1.2, width=0.45)

# %%
# From the surface to the sphere
# ------------------------------
#
# ``sphere_map`` takes the arrays as the segmentation gives them, in any unit. The surface must be closed
# and without handles.

sphere = authalic.sphere_map(vertices, faces)
print(sphere.status)
print("SD of the area ratio:", round(sphere.distortion.area_ratio_std, 5))
print("folded faces:", len(sphere.distortion.folded))

# %%
# From the sphere to coefficients
# -------------------------------
#
# Each of x, y and z is expanded by least squares over the vertices. A vertex counts by its share of the
# area, so that the density of the mesh has no say.


def share_of_area(vertices, faces):
    """The share of the surface that belongs to each vertex: a third of each of its faces."""
    sides = vertices[faces[:, 1:]] - vertices[faces[:, :1]]
    areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    return np.bincount(faces.ravel(), np.repeat(areas / 3, 3)) / areas.sum()


def latitude_and_longitude(positions):
    x, y, z = positions.T
    return np.degrees(np.arcsin(z)), np.degrees(np.arctan2(y, x))


def expand(vertices, faces, positions, degree):
    """The coefficients of x, y and z up to a degree."""
    shares = share_of_area(vertices, faces)
    places = latitude_and_longitude(positions)
    fits = [pyshtools.expand.SHExpandWLSQ(values, shares, *places, degree)[0] for values in vertices.T]
    return [pyshtools.SHCoeffs.from_array(fit) for fit in fits]


def rebuild(coefficients, positions):
    """The surface that the coefficients describe, at the vertices of the mesh."""
    latitude, longitude = latitude_and_longitude(positions)
    return np.stack([each.expand(lat=latitude, lon=longitude) for each in coefficients], axis=1)


# %%
# How many degrees it takes
# -------------------------
#
# The error is the root of the mean squared distance over the area, as a share of the cell's diameter.

degrees = [2, 4, 8, 16]
shares = share_of_area(vertices, faces)
diameter = np.ptp(vertices, axis=0).max()
shapes = []
for degree in degrees:
    coefficients = expand(vertices, faces, sphere.positions, degree)
    shapes.append(rebuild(coefficients, sphere.positions))
    error = np.sqrt(((shapes[-1] - vertices) ** 2).sum(axis=1) @ shares) / diameter
    print(f"degree {degree:2}: {3 * (degree + 1) ** 2:3} numbers, error {100 * error:.2f} %")

figure, panels = plt.subplots(1, 5, figsize=(13, 3), layout="constrained")
names = ["the cell", *(f"degree {degree}" for degree in degrees)]
for panel, shape, name in zip(panels, [vertices, *shapes], names, strict=True):
    draw_surface(panel, shape, faces, view=(-70, 50))
    panel.set_title(name)
plt.show()

# %%
# A description that does not turn with the cell
# ----------------------------------------------
#
# The power at a degree, summed over x, y and z, is the same however the cell lies in space and however its
# map lies on the sphere. So cells are compared without laying them over each other. The first two below are
# one cell, turned; the third has other arms.

cosine, sine = np.cos(0.9), np.sin(0.9)
turn = np.array([[cosine, 0, sine], [0, 1, 0], [-sine, 0, cosine]])
cells = {
    "four arms": (vertices, faces),
    "four arms, turned": (vertices @ turn, faces),
    "five short arms": star(arms=5, length=0.5, width=0.35),
}

figure, panel = plt.subplots(figsize=(7, 3.6), layout="constrained")
powers = {}
for name, (places, triangles) in cells.items():
    onto = authalic.sphere_map(places, triangles).positions
    coefficients = expand(places, triangles, onto, 12)
    powers[name] = sum(each.spectrum() for each in coefficients)[1:]
    powers[name] /= powers[name].sum()
    panel.semilogy(np.arange(1, 13), powers[name], marker="o", alpha=0.7, label=name)
panel.set(xlabel="degree", ylabel="share of the power")
panel.legend()
plt.show()

# %%
# How far the logarithms of two spectra lie apart:

for name in list(cells)[1:]:
    apart = np.abs(np.log2(powers[name] / powers["four arms"])).mean()
    print(f"four arms against {name}: {apart:.3f}")
