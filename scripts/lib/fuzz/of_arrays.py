# SPDX-License-Identifier: MIT OR Apache-2.0
"""atheris: arrays of any type, shape and layout are taken or refused, by the documented exceptions alone."""

import sys

import atheris
import numpy as np

with atheris.instrument_imports(include=["authalic"]):
    import authalic

DTYPES = (
    *("float64", "float32", "float16", "int64", "int32", "int8", "uint8", "uint64", "bool", "complex64"),
    *("object", "U3", "S2", "datetime64[s]", ">f8", ">i4"),
)
CALLS = (
    lambda a, b, c: authalic.Surface(a, b),
    lambda a, b, c: authalic.disk_map(a, b, density=c, max_iterations=1),
    lambda a, b, c: authalic.sphere_map(a, b, initial=c, max_iterations=1),
    lambda a, b, c: authalic.distortion(a, b, c),
    lambda a, b, c: authalic.cut(a, b, seams=c),
    lambda a, b, c: authalic.repair(a, b),
    lambda a, b, c: authalic.untangle((a, b), c),
    lambda a, b, c: authalic.pack(a, b, c),
    lambda a, b, c: authalic.register_disks((a, b), (a, b), source_landmarks=c, target_landmarks=c),
)
ALLOWED = (ValueError, TypeError, OverflowError)
OUTCOMES = ("done", *(each.__name__ for each in ALLOWED), *authalic.ERROR_KINDS)
# The fuzzer keeps inputs that reach new code, and sees none of the native module's: so each outcome of each
# call has a function of its own.
REACHED = {(call, outcome): atheris.instrument_func(lambda: None) for call in CALLS for outcome in OUTCOMES}
DISK = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]], float)
FACES = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])


@atheris.instrument_func
def array(data, usual):
    """The usual array, or one made of bytes."""
    if data.ConsumeIntInRange(0, 2):
        return usual
    shape = [data.ConsumeIntInRange(0, 6) for _ in range(data.ConsumeIntInRange(0, 3))]
    values = [
        data.ConsumeFloat() if data.ConsumeBool() else data.ConsumeInt(4) for _ in range(int(np.prod(shape)))
    ]
    try:
        made = np.array(values, dtype=object).reshape(shape).astype(data.PickValueInList(list(DTYPES)))
    except (ValueError, TypeError, OverflowError):
        return values
    layout = data.ConsumeIntInRange(0, 5)
    if layout == 1:
        made = np.asfortranarray(made)
    elif layout == 2 and made.ndim:
        made = made[::-1]
    elif layout == 3:
        made = np.ma.masked_array(made, mask=data.ConsumeBool())
    elif layout == 4:
        made = np.broadcast_to(made, (2, *made.shape))
    elif layout == 5:
        return made.tolist()
    return made


def outcome(call, arguments):
    """The kind of the error, or the exception's name where it has none."""
    try:
        call(*arguments)
    except authalic.SolverError as error:
        assert error.kind != "internal", error
        return error.kind
    except ALLOWED as error:
        named = next(each.__name__ for each in ALLOWED if isinstance(error, each))
        return getattr(error, "kind", named)
    return "done"


def check(data_of_fuzzer):
    data = atheris.FuzzedDataProvider(data_of_fuzzer)
    call = data.PickValueInList(list(CALLS))
    arguments = array(data, DISK), array(data, FACES), array(data, None)
    REACHED[call, outcome(call, arguments)]()


atheris.Setup(sys.argv, check)
atheris.Fuzz()
