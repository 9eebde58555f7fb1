# SPDX-License-Identifier: MIT OR Apache-2.0
"""Authalic beside the papers' methods, libigl, xatlas, lapy and Blender."""
