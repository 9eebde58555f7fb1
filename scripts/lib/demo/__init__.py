# SPDX-License-Identifier: MIT OR Apache-2.0
"""What scripts/demo runs: the scenes and pictures in Blender, the figures outside it."""
