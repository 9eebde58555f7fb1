# SPDX-License-Identifier: MIT OR Apache-2.0
"""What a command prints at its end, and its exit code."""

import sys
from collections.abc import Mapping
from enum import IntEnum
from typing import Any, TextIO

import click

from .._native import MeshError, SolverError
from ..io import FileError, MissingExtra, strict_json
from ..runs.record import problem


class Exit(IntEnum):
    """One code for each kind of end."""

    DONE = 0
    FAULT = 1
    USAGE = 2
    FILE = 3
    MESH = 4
    SOLVER = 5
    PACKAGE = 6
    SCHEDULER = 7
    SUBJECTS = 8
    INTERRUPTED = 130
    TERMINATED = 143


_BY_KIND = {"invalid_option": Exit.USAGE, "subjects": Exit.USAGE, "scheduler": Exit.SCHEDULER}
_FIGURES = (
    ("islands", "islands {}"),
    ("area_ratio_std", "area ratio SD {:.4g}"),
    ("angle_distortion_mean", "σ₁/σ₂ mean {:.4g}"),
    ("angle_distortion_p99", "99 % below {:.4g}"),
    ("shear", "mean by area {:.4g}"),
    ("strain_mean", "strain mean {:.4g}"),
    ("folded", "folded faces {}"),
)
_COMMAND_WORDS = (
    ('unwrap with seams="auto"', "authalic unwrap"),
    ("repair with close_handles=True", "authalic repair --close-handles all"),
    ("authalic.repair mends", "authalic repair mends"),
    ("repair=True", "--repair"),
    ("fill_holes=True", "--fill-holes"),
    ("by sphere_map", "by authalic sphere"),
    ("by disk_map", "by authalic disk"),
    ("(cut returns them)", "(authalic repair --keep largest keeps one)"),
    ("source_landmarks, target_landmarks", "--landmarks"),
    ("features=", "--features"),
)
"""Functions and arguments of the library, as its messages name them, and what the command calls them."""
_FOLLOWED = ("areal_distortion", "pulled", "table")


def exit_code(error: BaseException) -> Exit:
    """The code of an exception."""
    if (kind := getattr(error, "kind", None)) in _BY_KIND:
        return _BY_KIND[kind]
    kinds: tuple[tuple[type[BaseException] | tuple[type[BaseException], ...], Exit], ...] = (
        (MissingExtra, Exit.PACKAGE),
        ((FileError, OSError), Exit.FILE),
        (MeshError, Exit.MESH),
        (SolverError, Exit.SOLVER),
    )
    return next((code for kind, code in kinds if isinstance(error, kind)), Exit.FAULT)


def show_error(error: BaseException, as_json: bool) -> Exit:
    """Prints an error on stderr, with the elements at fault; returns the exit code."""
    code = exit_code(error)
    data = problem(error)  # type: ignore[arg-type]
    data["message"] = in_command_words(data["message"])
    if as_json:
        print(strict_json.dumps({"error": data | {"exit_code": int(code)}}), file=sys.stderr)
        return code
    print(f"authalic: error: {data['message'] or type(error).__name__}", file=sys.stderr)
    if elements := _elements(data):
        print(f"  {elements}", file=sys.stderr)
    return code


def in_command_words(message: str) -> str:
    """A message of the library as a user of the command needs it."""
    for library, command in _COMMAND_WORDS:
        message = message.replace(library, command)
    return message


def show_usage_error(error: click.ClickException, as_json: bool) -> Exit:
    """Prints what is wrong with the words of a command."""
    if as_json:
        data = {"message": error.format_message(), "kind": "usage", "exit_code": int(Exit.USAGE)}
        print(strict_json.dumps({"error": data}), file=sys.stderr)
    else:
        error.show()
    return Exit.USAGE


def show_record(record: Mapping[str, Any], as_json: bool, stream: TextIO) -> None:
    """Prints the record of a run: as one line of JSON, or in words."""
    if as_json:
        print(strict_json.dumps(record), file=stream)
        return
    place = f" -> {record['output']}" if "output" in record else ""
    print(f"{record['input']}{place}", file=stream)
    print(f"  {_counted(record['vertices'], 'vertices')}, {_counted(record['faces'], 'faces')}", file=stream)
    for line in record.get("repair_report", ()):
        print(f"  {line}", file=stream)
    if "status" in record:
        after = f" after {_counted(record['iterations'], 'iterations')}" if "iterations" in record else ""
        print(f"  {record['status']}{after}, {record['seconds']:.2f} s", file=stream)
    figures = [text.format(record[key]) for key, text in _FIGURES if record.get(key) is not None]
    if figures:
        print(f"  {', '.join(figures)}", file=stream)
    for key in _FOLLOWED:
        if key in record:
            print(f"  {key.replace('_', ' ')}: {record[key]}", file=stream)


def show_info(record: Mapping[str, Any], as_json: bool, stream: TextIO) -> None:
    """Prints what a mesh is like."""
    if as_json:
        print(strict_json.dumps(record), file=stream)
        return
    if record["format"] == "result":
        print(strict_json.dumps(record, indent=2), file=stream)
        return
    show_record(record, False, stream)
    for key in ("components", "genus", "boundary_loops", "area", "uv_points"):
        if key in record:
            number = f"{record[key]:,.6g}" if key == "area" else f"{record[key]:,}"
            print(f"  {key.replace('_', ' ')}: {number}", file=stream)
    if "problem" in record:
        print(f"  problem: {in_command_words(record['problem']['message'])}", file=stream)
    else:
        print(f"  suits: {', '.join(record['suits'])}", file=stream)


def show_notes(record: Mapping[str, Any]) -> None:
    """Prints on stderr what a user should know of a map that is written nevertheless."""
    if record.get("status") not in (None, "converged"):
        _note(f"the run ended early ({record['status']}); the map is sound, but not as good as it could be")
    if record.get("folded_in_file"):
        _note(f"folded by the single precision of the file: {_counted(record['folded_in_file'], 'faces')}")
    if record.get("folded"):
        _note(f"folded: {_counted(record['folded'], 'faces')}")
    for warning in record.get("warnings", ()):
        _note(warning)


def _counted(count: int, noun: str) -> str:
    singular = {"vertices": "vertex", "faces": "face", "iterations": "iteration"}
    return f"{count:,} {singular[noun] if count == 1 else noun}"


def _note(text: str) -> None:
    print(f"authalic: note: {text}", file=sys.stderr)


def _elements(data: Mapping[str, Any]) -> str:
    if "kind" not in data:
        return ""
    words = [f"kind: {data['kind']}"]
    words += [f"{key}: {data[key]}" for key in ("side", "curve", "second_curve") if key in data]
    if data.get("indices"):
        listed = ", ".join(map(str, data["indices"]))
        words.append(f"elements: {listed} ({data['count']} in all)")
    return "; ".join(words)
