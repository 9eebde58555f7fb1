# SPDX-License-Identifier: GPL-3.0-or-later
"""Markers and lines drawn over the meshes in the 3D view."""
