# SPDX-License-Identifier: MIT OR Apache-2.0
"""The command `authalic`. It needs the extra `authalic[cli]`; importing this module does not."""

import gc
import os
import sys
from collections.abc import Callable, Sequence

MISSING_PACKAGE = 6
"""The exit code if a package is not installed."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command.

    Parameters
    ----------
    arguments : sequence of str, optional
        The words after `authalic`. Default: those of this process.

    Returns
    -------
    int
        The exit code.

    Examples
    --------
    >>> from authalic.cli import main
    >>> code = main(["--version"])  # doctest: +ELLIPSIS
    authalic ...
    >>> code
    0
    """
    try:
        import click  # noqa: F401
        import rich  # noqa: F401
    except ImportError as error:
        print(
            f"authalic: error: the command line needs the package {error.name}; "
            "install it with: pip install 'authalic[cli]'",
            file=sys.stderr,
        )
        return MISSING_PACKAGE
    if arguments is None:
        return _app_of_this_process()(sys.argv[1:])
    from .app import run

    return run(list(arguments))


def _app_of_this_process() -> Callable[[Sequence[str]], int]:
    """The app, loaded as a process can that runs one command: in less than half the time.

    numpy's BLAS would start threads that no command uses. Modules stay until the end, so that nothing of them
    is garbage, neither while they are loaded nor when the process ends.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    gc.disable()
    from .app import run

    gc.freeze()
    gc.enable()
    return run
