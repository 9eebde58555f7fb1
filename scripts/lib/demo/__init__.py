# SPDX-License-Identifier: MIT OR Apache-2.0
"""The work of scripts/demo: scenes and pictures in Blender, figures outside it."""
