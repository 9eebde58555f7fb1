# SPDX-License-Identifier: MIT OR Apache-2.0
"""The search for failures: random meshes, sound and hostile, and the property tests of the crates."""
