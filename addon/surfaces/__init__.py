# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces as arrays. Plain numpy, no bpy."""
