# SPDX-License-Identifier: MIT OR Apache-2.0
"""Pieces of numpy's files, for files that state what they do not hold."""

import struct


def npy(shape, kind="<f8"):
    """The head of an array, without its numbers."""
    head = str({"descr": kind, "fortran_order": False, "shape": shape}).ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head.encode()
