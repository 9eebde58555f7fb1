# SPDX-License-Identifier: MIT OR Apache-2.0
"""The command `authalic`. It needs the extra `authalic[cli]`; importing this module does not."""

import sys
from collections.abc import Sequence

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
    from .app import run

    return run(sys.argv[1:] if arguments is None else list(arguments))
