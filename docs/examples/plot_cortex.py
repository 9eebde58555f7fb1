# SPDX-License-Identifier: MIT OR Apache-2.0
"""
A cortex from FreeSurfer files
==============================

From ``lh.white`` to a sphere in FreeSurfer's own files, a picture of the areal distortion, and a
registration of the left hemisphere onto the right one by the depth of the folds. Everything works on arrays
in the order of the file's vertices, so that curvature, thickness and labels fit without a detour.

This page needs ``pip install nilearn matplotlib``. nilearn brings the surface fsaverage5 (10,242 vertices a
hemisphere) and nibabel, which reads and writes the files. Yours come from ``recon-all``: put the folder
``surf`` of a subject in the place of the one made here.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import nibabel
import numpy as np
from nibabel import freesurfer
from nilearn import datasets
from pictures import draw_surface

import authalic

SURF = Path(tempfile.mkdtemp()) / "surf"
SURF.mkdir()


def arrays(path):
    """The arrays of a GIFTI file: vertices and faces, or values."""
    return [array.data for array in nibabel.load(path).darrays]


fsaverage = datasets.fetch_surf_fsaverage("fsaverage5")  # from the package, not from the network
for hemisphere, side in (("lh", "left"), ("rh", "right")):
    for name, part in (("white", "white"), ("inflated", "infl"), ("sphere", "sphere")):
        freesurfer.write_geometry(SURF / f"{hemisphere}.{name}", *arrays(fsaverage[f"{part}_{side}"]))
    for name in ("sulc", "curv"):
        freesurfer.write_morph_data(SURF / f"{hemisphere}.{name}", *arrays(fsaverage[f"{name}_{side}"]))
print(*sorted(path.name for path in SURF.iterdir()))

# %%
# The sphere
# ----------
#
# nibabel returns big-endian arrays; all functions take them as they are.

white, faces = freesurfer.read_geometry(SURF / "lh.white")
sphere = authalic.sphere_map(white, faces)
print(sphere.status, "in", round(sphere.seconds, 1), "s")

# %%
# FreeSurfer wants a radius of 100. The areal distortion, log₂ of the area on the sphere over the area on
# the cortex, is one number per face; at a vertex it is the mean over its faces.


def at_vertices(of_faces, faces, count):
    """Values of faces, averaged at the vertices."""
    sums = np.bincount(faces.ravel(), np.repeat(of_faces, 3), count)
    return sums / np.bincount(faces.ravel(), minlength=count)


distortion = at_vertices(sphere.distortion.log2_area_ratio, faces, len(white))
freesurfer.write_geometry(SURF / "lh.authalic.sphere", 100 * sphere.positions, faces)
freesurfer.write_morph_data(SURF / "lh.authalic.distortion", distortion)

# %%
# Beside FreeSurfer's sphere
# --------------------------
#
# ``distortion`` measures any map. FreeSurfer's sphere is made to keep distances; an area-preserving one
# shows what of the surface a study of areas or densities on the sphere would over- and undercount.

theirs, _ = freesurfer.read_geometry(SURF / "lh.sphere")
figures = {"FreeSurfer": authalic.distortion(white, faces, theirs), "Authalic": sphere.distortion}
for name, measured in figures.items():
    print(
        f"{name}: SD of the area ratio {measured.area_ratio_std:.4f}, "
        f"mean σ₁/σ₂ {measured.angle_distortion_mean:.2f}, folded faces {len(measured.folded)}"
    )

inflated, _ = freesurfer.read_geometry(SURF / "lh.inflated")
figure, panels = plt.subplots(1, 3, figsize=(12, 3.8), layout="constrained")
for panel, (name, measured) in zip(panels, figures.items(), strict=False):
    shown = draw_surface(panel, inflated, faces, measured.log2_area_ratio, view=(180, 10), limits=(-2, 2))
    panel.set_title(name)
figure.colorbar(shown, ax=panels[:2], label="log₂ of the area ratio", shrink=0.7)
bins = np.linspace(-3, 3, 121)
for name, measured in figures.items():
    panels[2].hist(measured.log2_area_ratio, bins, alpha=0.6, label=name)
panels[2].set(xlabel="log₂ of the area ratio", ylabel="faces", yscale="log")
panels[2].legend()
plt.show()

# %%
# Left onto right
# ---------------
#
# The right hemisphere, mirrored, is the target. The depth of the folds, ``sulc``, pulls the map; landmarks
# are not needed. Mirroring turns the faces inside out, so they are turned back.

right, right_faces = freesurfer.read_geometry(SURF / "rh.white")
mirrored = right * [-1, 1, 1], right_faces[:, ::-1]
depth = [freesurfer.read_morph_data(SURF / f"{hemisphere}.sulc") for hemisphere in ("lh", "rh")]
registration = authalic.register_spheres((white, faces), mirrored, features=tuple(depth))
print(registration.status, "in", round(registration.seconds), "s")
print("median strain", round(registration.strain.median, 3))
print("folded faces", len(registration.distortion.folded))

# %%
# ``pull`` brings data of the target to the source's vertices, ``compare`` measures how well both agree.
# Curvature had no say in the registration, so it can judge it.

curvature = [freesurfer.read_morph_data(SURF / f"{hemisphere}.curv") for hemisphere in ("lh", "rh")]
for name, values in (("sulc", depth), ("curv", curvature)):
    correlation, difference = registration.compare(*values)
    print(f"{name}: correlation {correlation:.3f}, mean difference {difference:.3f}")

figure, panels = plt.subplots(1, 3, figsize=(12, 3.4), layout="constrained")
strain = registration.strain.symmetric_dirichlet
on_faces = [values[faces].mean(axis=1) for values in (depth[0], registration.pull(depth[1]))]
limits = np.array([-1, 1]) * np.percentile(np.abs(depth[0]), 95)
for panel, values, name in zip(panels, on_faces, ("sulc, left", "sulc of the right, pulled"), strict=False):
    draw_surface(panel, inflated, faces, values, view=(180, 10), cmap="gray_r", limits=limits)
    panel.set_title(name)
shown = draw_surface(panels[2], inflated, faces, strain, view=(180, 10), cmap="magma_r", limits=(1, 3))
panels[2].set_title("strain")
figure.colorbar(shown, ax=panels[2], label="symmetric Dirichlet energy / 4", shrink=0.7)
plt.show()
