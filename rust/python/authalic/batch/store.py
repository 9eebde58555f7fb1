# SPDX-License-Identifier: MIT OR Apache-2.0
"""The folder of a batch: maps, a record of each subject, and the table of them all.

maps/NAME...             the maps, written by the workers
records/NAME.json        what came of each subject
figures.parquet          all records, a row for each subject
"""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from ..io import Outputs, strict_json
from ..io.errors import require
from ..runs.record import Record

MAPS, RECORDS, TABLE = "maps", "records", "figures.parquet"

_COLUMNS = (
    *(("subject", "string"), ("outcome", "string"), ("command", "string"), ("input", "string")),
    *(("output", "string"), ("areal_distortion", "string"), ("vertices", "int64"), ("faces", "int64")),
    *(("status", "string"), ("iterations", "int64"), ("seconds", "float64"), ("total_seconds", "float64")),
    *(("authalic_energy", "float64"), ("area_ratio_std", "float64"), ("angle_distortion_mean", "float64")),
    *(("angle_distortion_p99", "float64"), ("angle_distortion_max", "float64"), ("folded", "int64")),
    *(("folded_in_file", "int64"), ("radius", "float64"), ("islands", "int64"), ("seam_length", "float64")),
    *(("shear", "float64"), ("shear_p99", "float64"), ("packed", "float64"), ("input_sha256", "string")),
    *(("authalic", "string"), ("options", "string"), ("attempts", "int64"), ("worker", "string")),
    *(("error_kind", "string"), ("error_message", "string"), ("error_indices", "string")),
    *(("error_count", "int64"), ("repairs", "string")),
)
"""The columns of the table. Options, indices and repairs are JSON."""


def make_folder(folder: Path) -> None:
    """Makes a batch's folder, so that it can be told from one of surfaces from now on."""
    for part in (MAPS, RECORDS):
        (folder / part).mkdir(parents=True, exist_ok=True)


def is_batch_folder(folder: Path) -> bool:
    return (folder / MAPS).is_dir() and (folder / RECORDS).is_dir()


def map_place(folder: Path, subject: str, surface: Path) -> Path:
    """Where a subject's map would lie if it had the name of the surface.

    A subject from a folder is named after the file; one from a table may be named otherwise, and then has a
    folder of its own.
    """
    place = folder / MAPS / subject
    return place if place.name == surface.name else place / surface.name


def record_path(folder: Path, subject: str) -> Path:
    return folder / RECORDS / f"{subject}.json"


def write_record(folder: Path, record: Record) -> None:
    path = record_path(folder, record["subject"])
    path.parent.mkdir(parents=True, exist_ok=True)
    with Outputs() as outputs:
        outputs.add(path).write_text(strict_json.dumps(record), encoding="utf-8")


def read_records(folder: Path) -> dict[str, Record]:
    """The records in a batch's folder by subject; files that are no records are passed over."""
    records = {}
    for path in sorted((folder / RECORDS).rglob("*.json")):
        record = _read(path)
        if record is not None:
            records[record["subject"]] = record
    return records


def remove_record(folder: Path, subject: str) -> None:
    record_path(folder, subject).unlink(missing_ok=True)


def read_record(folder: Path, subject: str) -> Record | None:
    return _read(record_path(folder, subject))


def is_done(record: Record | None, fingerprint: str, output: str) -> bool:
    """Whether a record says that a map is done, from this input with these options, and it is there."""
    if record is None or record.get("outcome") != "done" or record.get("fingerprint") != fingerprint:
        return False
    return Path(output).exists()


def in_unicode(text: str) -> str:
    """Text in which bytes of file names that are no text are spelled out."""
    return text.encode("utf-8", "backslashreplace").decode()


def write_table(folder: Path, records: Iterable[Record]) -> Path:
    """Writes a row for each record, in the order of the subjects."""
    arrow = require("pyarrow", "the table of figures", "batch")
    parquet = require("pyarrow.parquet", "the table of figures", "batch")
    schema = arrow.schema([(name, arrow.type_for_alias(kind)) for name, kind in _COLUMNS])
    rows = [_row(record) for record in sorted(records, key=lambda record: str(record["subject"]))]
    path = folder / TABLE
    with Outputs() as outputs:
        parquet.write_table(arrow.Table.from_pylist(rows, schema=schema), str(outputs.add(path)))
    return path


def _row(record: Record) -> dict[str, Any]:
    error = record.get("error", {})
    known = {name: record.get(name) for name, _ in _COLUMNS}
    row = known | {
        "options": json.dumps(record.get("options", {})),
        "repairs": json.dumps(record["repairs"]) if "repairs" in record else None,
        "error_kind": error.get("kind"),
        "error_message": error.get("message"),
        "error_indices": json.dumps(error["indices"]) if "indices" in error else None,
        "error_count": error.get("count"),
    }
    return {name: in_unicode(value) if isinstance(value, str) else value for name, value in row.items()}


def _read(path: Path) -> Record | None:
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return record if isinstance(record, dict) and "subject" in record and "outcome" in record else None
