# SPDX-License-Identifier: MIT OR Apache-2.0
"""The site: the documentation, and the page that runs the core in a browser."""
