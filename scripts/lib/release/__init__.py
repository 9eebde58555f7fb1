# SPDX-License-Identifier: MIT OR Apache-2.0
"""Builds and checks what a release publishes; `scripts/release` runs it."""
