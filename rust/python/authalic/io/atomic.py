# SPDX-License-Identifier: MIT OR Apache-2.0
"""Files that appear whole or not at all."""

import contextlib
import os
from pathlib import Path
from types import TracebackType

from .errors import FileError

PREFIX = ".authalic-"
"""Names of files that are not whole yet begin with this."""
_END = 40
"""Of a file's name so many characters end its temporary name, which must not be too long either."""


class Outputs:
    """Files that are written together: all of them appear at the end of the block, or none after an error.

    Each file is written under a temporary name in its folder. At the end of the block the files get their
    names. An exception, Ctrl-C included, removes them.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from authalic.io import Outputs
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> with Outputs() as outputs:
    ...     _ = outputs.add(folder / "a.txt").write_text("whole")
    ...     (folder / "a.txt").exists()
    False
    >>> (folder / "a.txt").read_text()
    'whole'
    """

    def __init__(self) -> None:
        self._places: dict[Path, Path] = {}

    def add(self, path: str | Path) -> Path:
        """Return the temporary path to write a file to.

        Parameters
        ----------
        path : str or Path
            The file, in an existing folder.

        Returns
        -------
        Path
            A path in the same folder. Its name ends as the file's does.

        Raises
        ------
        FileNotFoundError, PermissionError, IsADirectoryError
            If there is no such folder, if it cannot be written to, or if the file itself is a folder.
        FileError
            If it was added before, or is a device.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> from authalic.io import Outputs
        >>> with Outputs() as outputs:
        ...     temporary = outputs.add(pathlib.Path(tempfile.mkdtemp()) / "a.txt")
        ...     _ = temporary.write_text("whole")
        >>> temporary.name.startswith(".authalic-")
        True
        """
        target = Path(path).resolve()
        if not target.parent.is_dir():
            raise FileNotFoundError(f"there is no folder {target.parent} to write {target.name} into")
        if not os.access(target.parent, os.W_OK):
            raise PermissionError(f"the folder {target.parent} cannot be written to; choose another one")
        if target.is_dir():
            raise IsADirectoryError(f"{target} is a folder, not a file; choose another name")
        if target.exists() and not target.is_file():
            raise FileError(
                path, "it is a device or a pipe, which a file cannot replace; choose another name"
            )
        if target in self._places.values():
            raise FileError(path, "two results would be written to this file; give them different names")
        temporary = target.parent / f"{PREFIX}{os.getpid()}-{os.urandom(4).hex()}-{target.name[-_END:]}"
        self._places[temporary] = target
        return temporary

    def __enter__(self) -> "Outputs":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            if kind is None:
                for temporary, target in self._places.items():
                    os.replace(temporary, target)
        finally:
            for temporary in self._places:
                with contextlib.suppress(OSError):
                    temporary.unlink(missing_ok=True)


def remove_leftovers(folder: Path) -> None:
    """Removes what runs that were killed have left in a folder and below. No run may be writing there."""
    for path in folder.rglob(f"{PREFIX}*"):
        with contextlib.suppress(OSError):
            path.unlink(missing_ok=True)
