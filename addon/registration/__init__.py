# SPDX-License-Identifier: GPL-3.0-or-later
"""Two meshes and their landmarks as arrays, and the report of a registration. Plain numpy, no bpy."""
