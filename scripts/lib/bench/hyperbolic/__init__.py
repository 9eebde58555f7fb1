# SPDX-License-Identifier: MIT OR Apache-2.0
"""Registration by landmark curves of cortices, beside the paper's conventional method and points."""
