# SPDX-License-Identifier: MIT OR Apache-2.0
"""How much work is done by two threads, which does not depend on what else the machine does."""

import contextlib
import time

import authalic

THREADS = 2


@contextlib.contextmanager
def counted():
    """All that is computed meanwhile has two threads, so that work means the same on every machine."""
    authalic.set_threads(THREADS)
    try:
        yield
    finally:
        authalic.set_threads(0)


def spent():
    """The processor time of this process so far, in seconds for each thread."""
    return time.process_time() / THREADS
