# SPDX-License-Identifier: MIT OR Apache-2.0
"""What a worker on this machine does first: it leaves Ctrl-C to the batch, which then ends its workers."""

import signal
from typing import Any


def dask_setup(worker: Any) -> None:
    """Called by Dask in each worker process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
