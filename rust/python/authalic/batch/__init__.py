# SPDX-License-Identifier: MIT OR Apache-2.0
"""Many surfaces on many processors and machines, by Dask. It needs the extra `authalic[batch]`.

A batch has a folder. Each subject's map and record are written there by the worker that made them, the map
first, so that a record says that its subject is done. Whatever is killed, the next run of the same batch does
what is missing.
"""

from .errors import SchedulerError, SubjectsError
from .run import Summary, run_batch
from .subjects import Subject, find_subjects

__all__ = ["SchedulerError", "Subject", "SubjectsError", "Summary", "find_subjects", "run_batch"]
