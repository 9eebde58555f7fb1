# SPDX-License-Identifier: GPL-3.0-or-later
"""The work from a context's objects to their meshes: one path, for the operators and for scripts."""
