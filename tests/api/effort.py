# SPDX-License-Identifier: MIT OR Apache-2.0
"""How much work is done, which does not depend on what else the machine does."""

import os
import time


def spent():
    """The processor time of this process so far, in seconds for each core."""
    return time.process_time() / (os.cpu_count() or 1)
