# SPDX-License-Identifier: MIT OR Apache-2.0
"""Measurements of maps: a module or a package for each subject of scripts/bench, and their common tools."""
