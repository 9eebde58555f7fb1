# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks in pairs on two meshes, vertices or paths of edges, and how they are kept, picked and filed."""
