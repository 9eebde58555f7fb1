# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators: properties, polls and reports; the work is done by the modules above."""
