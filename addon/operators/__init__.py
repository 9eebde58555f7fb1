# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators: properties, polls and reports. The jobs do the work."""
