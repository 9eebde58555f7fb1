# SPDX-License-Identifier: MIT OR Apache-2.0
"""Targets of fuzzers: what they look at is in rust/fuzz/ and in the files `of_*.py` here."""
