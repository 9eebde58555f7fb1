# SPDX-License-Identifier: MIT OR Apache-2.0
"""Models as artists have them: the operator beside Blender's ABF and Minimum Stretch on the same islands."""
