# SPDX-License-Identifier: MIT OR Apache-2.0
"""What can be wrong with a file, and packages that are not installed."""

import importlib
from pathlib import Path
from types import ModuleType


class FileError(ValueError):
    """A file cannot be read as what it should be, or cannot hold what is to be written.

    Parameters
    ----------
    path : str or Path
        The file; a string as an attribute.
    message : str
        What is wrong with it.
    """

    def __init__(self, path: str | Path, message: str) -> None:
        super().__init__(f"{path}: {message}")
        self.path = str(path)

    def __reduce__(self) -> tuple[type, tuple[str, str]]:
        return type(self), (self.path, str(self)[len(self.path) + 2 :])


class MissingExtra(ImportError):
    """A package is needed that `pip install authalic` leaves out.

    Parameters
    ----------
    purpose : str
        What needs the package.
    package : str
        The package.
    extra : str
        The extra that installs it, e.g. "io".
    """

    def __init__(self, purpose: str, package: str, extra: str) -> None:
        message = f"{purpose} needs the package {package}; install it with: pip install 'authalic[{extra}]'"
        super().__init__(message, name=package)
        self.purpose, self.extra = purpose, extra

    def __reduce__(self) -> tuple[type, tuple[str, str, str]]:
        return type(self), (self.purpose, str(self.name), self.extra)


def require(name: str, purpose: str, extra: str) -> ModuleType:
    """The module of an optional package; MissingExtra without the package."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise MissingExtra(purpose, name.split(".")[0], extra) from error
