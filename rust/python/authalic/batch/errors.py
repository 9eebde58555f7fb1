# SPDX-License-Identifier: MIT OR Apache-2.0
"""What can be wrong with a batch as a whole."""


class SchedulerError(RuntimeError):
    """A scheduler cannot be reached, or has no workers.

    Parameters
    ----------
    message : str
        What was found, and what to do.
    """

    def __init__(self, message: str) -> None:
        super().__init__(message)
        self.kind = "scheduler"


class SubjectsError(ValueError):
    """The subjects of a batch are none, or two of them would write the same file.

    Parameters
    ----------
    message : str
        What was found, and what to do.
    """

    def __init__(self, message: str) -> None:
        super().__init__(message)
        self.kind = "subjects"
