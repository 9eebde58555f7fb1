# SPDX-License-Identifier: MIT OR Apache-2.0
"""Results in files: numpy's npz, with a table of contents as JSON in the entry "authalic".

The table says which format the file has, which version wrote it, and what the result consists of: texts and
numbers as they are, arrays as the names of their entries, results within the result as tables of their own.
"""

import json
import os
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from . import _native, _objects
from ._reading import check_regular, open_numpy, short, words
from ._warnings import RegistrationWarning

FORMAT = 1
"""The format that is written. Formats from 1 up to this one are read."""

_TABLE = "authalic"

Arrays = dict[str, np.ndarray[Any, Any]]


def save(result: _native.Result, path: str | os.PathLike[str]) -> None:
    arrays: Arrays = {}
    content = _described(result, "", arrays)
    table = {"format": FORMAT, "version": _native.__version__, "content": content}
    _write(Path(path), {_TABLE: np.array(json.dumps(table)), **arrays})


def load(path: str | os.PathLike[str]) -> Any:
    """Load a result that its method `save` has written, in this version or an earlier one.

    Parameters
    ----------
    path : str or path-like
        The file.

    Returns
    -------
    Result
        Equal to the result that was saved, and with its methods.

    Raises
    ------
    ValueError
        The file holds no result, a damaged one, or one of a later version; or there is no memory for it.
    OSError
        The file cannot be opened.

    Examples
    --------
    >>> import authalic, os, tempfile
    >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    >>> result = authalic.disk_map(square, [[0, 1, 2], [0, 2, 3]])
    >>> file = os.path.join(tempfile.mkdtemp(), "square.npz")
    >>> result.save(file)
    >>> authalic.load(file) == result
    True
    """
    try:
        with _opened(path) as entries:
            result = _in(entries, path)
    except _NoResult as problem:
        raise ValueError(str(problem)) from problem.__cause__
    if not isinstance(result, _native.Result):
        raise ValueError(
            f"{os.fspath(path)} is damaged: it holds {type(result).__name__} in place of a result"
        )
    return result


def provenance_in(path: str | os.PathLike[str]) -> dict[str, Any] | None:
    """What the result in a file was computed from; None where the file holds no result.

    Raises `ValueError` as `load` does where it is a damaged result, or one of a later version.
    """
    try:
        with _opened(path) as entries:
            if _TABLE not in entries:
                return None
            content = _table(entries, path)["content"]
    except _NoResult:
        return None
    try:
        provenance: dict[str, Any] = {"result": content["kind"]} | content["provenance"]
    except (KeyError, TypeError) as problem:
        raise _damage(path, problem) from problem
    return provenance


class _NoResult(ValueError):
    """The file is no archive of numpy."""


def _in(entries: Mapping[str, Any], path: str | os.PathLike[str]) -> Any:
    """What the entries of an archive describe."""
    table = _table(entries, path)
    try:
        return _made(table["content"], entries)
    except Exception as problem:  # zip files and numpy raise what they like for a damaged file
        raise _damage(path, problem) from problem


def _described(value: Any, place: str, arrays: Arrays) -> Any:
    """A value as JSON; the arrays in it go to `arrays`, by the names of the attributes that lead to them."""
    if isinstance(value, np.ndarray):
        name = place.lstrip("/")
        arrays[name] = value
        return {"array": name}
    if isinstance(value, _native.Result):
        content = _described(_objects.state(value), place, arrays)["items"]
        return {"kind": type(value).__name__, "state": content, "provenance": value.provenance}
    if isinstance(value, RegistrationWarning):
        return {"warning": str(value), "facts": {**vars(value), "indices": list(value.indices)}}
    if isinstance(value, dict):
        return {"items": {key: _described(entry, f"{place}/{key}", arrays) for key, entry in value.items()}}
    if isinstance(value, (list, tuple)):
        entries = [_described(entry, f"{place}/{number}", arrays) for number, entry in enumerate(value)]
        return {"list" if isinstance(value, list) else "tuple": entries}
    return value


def _made(content: Any, entries: Mapping[str, Any]) -> Any:
    """The value that `_described` has described."""
    match content:
        case {"array": name}:
            return entries[name]
        case {"kind": kind, "state": items, "provenance": provenance}:
            state = {key: _made(entry, entries) for key, entry in items.items()}
            return _objects.restored(kind, state, provenance)
        case {"warning": message, "facts": facts}:
            return RegistrationWarning(message, **{**facts, "indices": tuple(facts["indices"])})
        case {"items": items}:
            return {key: _made(entry, entries) for key, entry in items.items()}
        case {"list": values}:
            return [_made(value, entries) for value in values]
        case {"tuple": values}:
            return tuple(_made(value, entries) for value in values)
        case _:
            return content


@contextmanager
def _opened(path: str | os.PathLike[str]) -> Iterator[Mapping[str, Any]]:
    """The entries of an archive of numpy, which are read as they are asked for."""
    name = os.fspath(path)
    with ExitStack() as stack:
        try:
            check_regular(path)
            entries = stack.enter_context(open_numpy(path))
        except OSError:
            raise
        except Exception as problem:
            raise _NoResult(f"{name} is no result of authalic: {words(problem)}") from problem
        if not isinstance(entries, np.lib.npyio.NpzFile):
            raise _NoResult(f"{name} is no result of authalic: it holds one array")
        yield entries


def _table(entries: Mapping[str, Any], path: str | os.PathLike[str]) -> dict[str, Any]:
    if _TABLE not in entries:
        raise ValueError(f"{os.fspath(path)} is no result of authalic: save results by their method save")
    try:
        table: dict[str, Any] = json.loads(str(entries[_TABLE]))
        format, _, version = table["format"], table["content"], table["version"]
        if not isinstance(format, int) or isinstance(format, bool) or format < 1:
            raise ValueError(f"its format is {short(repr(format))}, not a number from 1 on")
    except Exception as problem:
        raise _damage(path, problem) from problem
    if format > FORMAT:
        raise ValueError(
            f"{os.fspath(path)} was saved by authalic {short(str(version))} in format {short(str(format))}, "
            f"but this version, {_native.__version__}, reads formats up to {FORMAT}: install a newer one"
        )
    return table


def _damage(path: str | os.PathLike[str], problem: Exception) -> ValueError:
    return ValueError(f"{os.fspath(path)} is damaged: {words(problem)}")


def _write(path: Path, arrays: Arrays) -> None:
    """Writes beside the place and moves there, so that there is no half file at any time."""
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise ValueError(f"{path} is a device or a pipe, which no file can replace; choose another name")
    temporary = path.with_name(f".{path.name[-40:]}.{os.urandom(8).hex()}")
    try:
        with temporary.open("xb") as file:
            np.savez(file, **arrays)  # type: ignore[arg-type]
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
