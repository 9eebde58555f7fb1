# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's data as arrays and back; the only folder that reads and writes it."""
