# SPDX-License-Identifier: MIT OR Apache-2.0
"""Tests of the installed package `authalic`; none imports from the source tree."""
