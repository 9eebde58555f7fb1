# SPDX-License-Identifier: MIT OR Apache-2.0
"""The subjects of a batch: from files, folders and tables."""

import csv
import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..io import FileError
from ..io.atomic import PREFIX
from ..io.formats import is_mesh_file
from .errors import SubjectsError
from .store import is_batch_folder

TABLES = (".csv", ".tsv")
_CORTEX = ("lh.white", "rh.white")


@dataclass(frozen=True)
class Subject:
    """A surface of a batch.

    Parameters
    ----------
    name : str
        A path below the batch's folder, with slashes; no other subject has it.
    surface : Path
        The file, absolute, as every worker sees it.
    """

    name: str
    surface: Path


def find_subjects(places: Iterable[str | Path], pattern: str | None = None) -> list[Subject]:
    """Find the subjects of a batch.

    Parameters
    ----------
    places : iterable of str or Path
        Files of surfaces; folders, which are searched with those below them, but for what batches have
        written there; and tables: csv or tsv with the columns `subject` and `surface`, whose paths are
        relative to the table.
    pattern : str, optional
        The names of files in folders, such as ``"*.pial"``. Default: all meshes by their suffix, and
        FreeSurfer's `lh.white` and `rh.white`.

    Returns
    -------
    list of Subject
        Each file once, in the order of their names. A name is the path below the folder that all files share.

    Raises
    ------
    SubjectsError
        If there are no subjects, or two with one name.
    FileError, OSError
        If a table cannot be read.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from authalic.batch import find_subjects
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> for name in ("a.ply", "b.ply", "notes.txt"):
    ...     (folder / name).touch()
    >>> [subject.name for subject in find_subjects([folder])]
    ['a.ply', 'b.ply']
    """
    listed: list[Subject] = []
    files: set[Path] = set()
    for place in map(Path, places):
        if place.is_dir():
            files |= set(_search(place, pattern))
        elif place.suffix.lower() in TABLES:
            listed += _read_table(place)
        else:
            files.add(_absolute(place))
    subjects = listed + _named(sorted(files))
    _check(subjects)
    return sorted(subjects, key=lambda subject: subject.name)


def _search(folder: Path, pattern: str | None) -> Iterator[Path]:
    """The surfaces in a folder and below, except for the maps of batches."""
    for place, folders, files in os.walk(folder):
        here = Path(place)
        if here != folder and is_batch_folder(here):
            folders.clear()
            continue
        for path in (here / name for name in files if not name.startswith(PREFIX)):
            if path.match(pattern) if pattern is not None else path.name in _CORTEX or is_mesh_file(path):
                yield _absolute(path)


def _read_table(path: Path) -> list[Subject]:
    with open(path, newline="", encoding="utf-8-sig") as file:
        rows = csv.DictReader(file, delimiter="\t" if path.suffix.lower() == ".tsv" else ",")
        absent = {"subject", "surface"} - set(rows.fieldnames or ())
        if absent:
            raise FileError(path, f"the table lacks the columns {', '.join(sorted(absent))}")
        return [_subject_of_row(path, number, row) for number, row in enumerate(rows, start=2)]


def _subject_of_row(path: Path, number: int, row: dict[str, str]) -> Subject:
    name, surface = (row["subject"] or "").strip(), (row["surface"] or "").strip()
    if not name or not surface:
        raise FileError(path, f"line {number} has no subject or no surface")
    if os.path.isabs(name) or ".." in Path(name).parts:
        raise FileError(path, f"line {number}: the subject {name} must be a name, or a path without ..")
    return Subject(name, _absolute(path.parent / surface))


def _named(files: Sequence[Path]) -> list[Subject]:
    if not files:
        return []
    shared = Path(os.path.commonpath([file.parent for file in files]))
    return [Subject(file.relative_to(shared).as_posix(), file) for file in files]


def _absolute(path: Path) -> Path:
    return Path(os.path.abspath(path))


def _check(subjects: list[Subject]) -> None:
    if not subjects:
        raise SubjectsError("there are no surfaces; files of other names need a pattern, such as '*.pial'")
    seen: dict[str, Subject] = {}
    for subject in subjects:
        if subject.name in seen:
            first = seen[subject.name].surface
            raise SubjectsError(
                f"two subjects are named {subject.name}: {first} and {subject.surface}; "
                "name them for example sub-01/lh and sub-01/rh"
            )
        seen[subject.name] = subject
