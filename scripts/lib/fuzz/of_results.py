# SPDX-License-Identifier: MIT OR Apache-2.0
"""atheris: a saved result with changed entries is read or refused, and its methods do not panic."""

import contextlib
import sys
import tempfile
from pathlib import Path

import atheris
import numpy as np

with atheris.instrument_imports(include=["authalic"]):
    import authalic

    load = authalic.load  # so that its module is imported here

SAVED = sorted((Path(__file__).resolve().parents[3] / "tests" / "data" / "results").glob("*.npz"))
FILE = Path(tempfile.mkdtemp()) / "result.npz"
NUMBERS = (-1, 0, 1, 2, 7, 2**31, -(2**40), 2**62)
REALS = (0.0, -1.0, 0.5, float("nan"), float("inf"), 1e300, 1e-320)
FORMATS = ("1e400", "NaN", "-1", "0", "99", "true", "null", '"1"', "[]", "9" * 5000)
# Fields of two bytes: where they are in the list of a zip file's entries, and in front of each entry.
ZIP_FIELDS = {"version": (6, 4), "flags": (8, 6), "method": (10, 8), "name": (28, 26), "extra": (30, 28)}
ZIP_VALUES = (0, 1, 8, 9, 12, 14, 0x20, 0x40, 99, 0xFFFF)
DTYPES = (np.float64, np.float32, np.int64, np.int8, bool)


def opened(path):
    with np.load(path) as entries:
        return {name: entries[name] for name in entries}


FILES = [opened(path) for path in SAVED]


@atheris.instrument_func
def changed(data, array):
    """An array with a value, a length, a shape or a type of another kind."""
    array, kind = array.copy(), data.ConsumeIntInRange(0, 4)
    if kind == 0 and array.size and array.dtype.kind in "iuf":
        values = NUMBERS if array.dtype.kind in "iu" else REALS
        with np.errstate(all="ignore"), contextlib.suppress(OverflowError, ValueError):
            array.flat[data.ConsumeIntInRange(0, array.size - 1)] = data.PickValueInList(list(values))
    elif kind == 1 and array.ndim:
        return array[: data.ConsumeIntInRange(0, len(array))]
    elif kind == 2 and array.dtype.kind in "iufb":
        with np.errstate(all="ignore"):
            return array.astype(data.PickValueInList(list(DTYPES)))
    elif kind == 3:
        return array.reshape(-1)
    elif kind == 4 and array.ndim:
        return np.concatenate([array, array])
    return array


@atheris.instrument_func
def with_zip_fields(data, whole):
    """The archive with another version, flag, method or length of one of its entries."""
    whole, field = bytearray(whole), ZIP_FIELDS[data.PickValueInList(sorted(ZIP_FIELDS))]
    for mark, offset in zip((b"PK\x01\x02", b"PK\x03\x04"), field):
        places = [place for place in range(len(whole)) if whole.startswith(mark, place)]
        place = data.PickValueInList(places) + offset
        if data.ConsumeIntInRange(0, 3):
            whole[place : place + 2] = data.PickValueInList(list(ZIP_VALUES)).to_bytes(2, "little")
    return bytes(whole)


def use(result):
    """Every attribute, and every method that needs no argument."""
    repr(result)
    for name in dir(result):
        if name.startswith("_") or name == "save" or not isinstance(result, authalic.Result):
            continue
        attribute = getattr(result, name)
        if callable(attribute):
            with contextlib.suppress(TypeError):
                attribute()


def check(bytes_of_fuzzer):
    data = atheris.FuzzedDataProvider(bytes_of_fuzzer)
    entries = dict(data.PickValueInList(list(FILES)))
    names = sorted(set(entries) - {"authalic"})
    for _ in range(data.ConsumeIntInRange(1, 3)):
        if names and data.ConsumeIntInRange(0, 5):
            name = data.PickValueInList(list(names))
            entries[name] = changed(data, entries[name])
        else:
            text = str(entries["authalic"])
            if not data.ConsumeIntInRange(0, 3):
                text = text.replace('"format": 1', f'"format": {data.PickValueInList(list(FORMATS))}')
            place = data.ConsumeIntInRange(0, len(text) - 1)
            entries["authalic"] = np.array(
                text[:place] + data.ConsumeUnicode(3) + text[place + data.ConsumeIntInRange(0, 9) :]
            )
    np.savez(FILE, **entries)
    if not data.ConsumeIntInRange(0, 9):
        whole = FILE.read_bytes()
        FILE.write_bytes(whole[: data.ConsumeIntInRange(0, len(whole))])
    elif not data.ConsumeIntInRange(0, 4):
        FILE.write_bytes(with_zip_fields(data, FILE.read_bytes()))
    try:
        use(load(FILE))
    except authalic.SolverError as error:
        assert error.kind != "internal", error
    except ValueError as error:
        assert len(str(error)) < 1000, "the message is too long"
        assert "allow_pickle" not in str(error), error


atheris.Setup(sys.argv, check)
atheris.Fuzz()
