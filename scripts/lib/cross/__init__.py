# SPDX-License-Identifier: MIT OR Apache-2.0
"""Other platforms on this machine: the crate's tests, the bits of its results, and the wheel."""
