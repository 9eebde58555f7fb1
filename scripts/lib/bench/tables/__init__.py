# SPDX-License-Identifier: MIT OR Apache-2.0
"""The papers' tables, measured beside the published figures."""
