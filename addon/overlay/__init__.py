# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn over the meshes in the 3D view."""
