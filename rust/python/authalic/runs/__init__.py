# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs from files to files: each reads, computes, writes, and returns a record of figures.

The command line and the batch share them. A record is a dictionary that fits into JSON. The files of a run
appear together at its end or not at all.
"""
