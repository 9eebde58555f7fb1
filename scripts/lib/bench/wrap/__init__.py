# SPDX-License-Identifier: MIT OR Apache-2.0
"""Maps between surfaces of which others know the right places."""
