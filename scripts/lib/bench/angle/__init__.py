# SPDX-License-Identifier: MIT OR Apache-2.0
"""Areas against angles: the curve over `angle_weight`, the front, and Blender's Minimum Stretch beside it."""
