# SPDX-License-Identifier: GPL-3.0-or-later
"""A map onto the sphere laid out in the plane. Plain numpy, no bpy."""
