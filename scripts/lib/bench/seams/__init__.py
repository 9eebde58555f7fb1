# SPDX-License-Identifier: MIT OR Apache-2.0
"""Automatic seams: how long they are and what the maps cost, beside Blender's Smart UV Project and xatlas."""
