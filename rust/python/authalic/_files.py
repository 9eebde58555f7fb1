# SPDX-License-Identifier: MIT OR Apache-2.0
"""Results in files: numpy's npz, with a table of contents as JSON in the entry "authalic".

The table says which format the file has, which version wrote it, and what the result consists of: texts and
numbers as they are, arrays as the names of their entries, results within the result as tables of their own.
"""

import json
import os
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from . import _native, _objects
from ._warnings import RegistrationWarning

FORMAT = 1
"""The format that is written. Formats from 1 up to this one are read."""

_TABLE = "authalic"

# What a file raises whose entries are not those that its table names, or are cut short.
_DAMAGE = (AttributeError, KeyError, RecursionError, TypeError, ValueError, EOFError, BadZipFile, zlib.error)

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
        The file holds no result, a damaged one, or one of a later version.

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
    with _opened(path) as entries:
        table = _table(entries, path)
        try:
            result = _made(table["content"], entries)
        except _DAMAGE as problem:
            raise ValueError(f"{os.fspath(path)} is damaged: {_words(problem)}") from problem
    if not isinstance(result, _native.Result):
        raise ValueError(
            f"{os.fspath(path)} is damaged: it holds {type(result).__name__} in place of a result"
        )
    return result


def provenance_in(path: str | os.PathLike[str]) -> dict[str, Any] | None:
    """What the result in a file was computed from; None where the file holds no result."""
    try:
        with _opened(path) as entries:
            content: dict[str, Any] = _table(entries, path)["content"]
            provenance: dict[str, Any] = content["provenance"]
            return {"result": content["kind"]} | provenance
    except (ValueError, KeyError, TypeError):
        return None


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


def _opened(path: str | os.PathLike[str]) -> Any:
    try:
        opened = np.load(path, allow_pickle=False)
    except (ValueError, EOFError, BadZipFile) as problem:
        raise ValueError(f"{os.fspath(path)} is no result of authalic: {problem}") from problem
    if not isinstance(opened, np.lib.npyio.NpzFile):
        raise ValueError(f"{os.fspath(path)} is no result of authalic: it holds one array")
    return opened


def _table(entries: Mapping[str, Any], path: str | os.PathLike[str]) -> dict[str, Any]:
    if _TABLE not in entries:
        raise ValueError(f"{os.fspath(path)} is no result of authalic: save results by their method save")
    try:
        table: dict[str, Any] = json.loads(str(entries[_TABLE]))
        is_newer = int(table["format"]) > FORMAT
        table["content"], table["version"]
    except _DAMAGE as problem:
        raise ValueError(f"{os.fspath(path)} is damaged: {_words(problem)}") from problem
    if is_newer:
        raise ValueError(
            f"{os.fspath(path)} was saved by authalic {table['version']} in format {table['format']}, but "
            f"this version, {_native.__version__}, reads formats up to {FORMAT}: install a newer one"
        )
    return table


def _words(problem: Exception) -> str:
    return str(problem) or type(problem).__name__


def _write(path: Path, arrays: Arrays) -> None:
    """Writes beside the place and moves there, so that there is no half file at any time."""
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise ValueError(f"{path} is a device or a pipe, which no file can replace; choose another name")
    temporary = path.with_name(f".{path.name[-40:]}.{os.urandom(4).hex()}")
    try:
        with temporary.open("xb") as file:
            np.savez(file, **arrays)  # type: ignore[arg-type]
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
