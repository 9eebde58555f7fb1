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
DISK = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]], float)
FACES = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])
TETRAHEDRON = authalic.Surface(
    [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]
)
FLAT = DISK[:, :2]
# Results whose methods are called.
DISK_MAP = authalic.disk_map(DISK, FACES)
SPHERE_MAP = authalic.sphere_map(TETRAHEDRON)
VALUES, BALL = SPHERE_MAP.resample(np.arange(4.0), 1)
BALL_MAP = authalic.sphere_map(BALL)
SLITS = [BALL.faces[0], BALL.faces[41], BALL.faces[77]]
REPAIRED = authalic.repair(DISK, FACES)
BETWEEN_DISKS = authalic.register_disks(
    (DISK, FACES), (DISK, FACES), source_landmarks=[0], target_landmarks=[0]
)
BETWEEN_SPHERES = authalic.register_spheres(BALL, BALL, source_landmarks=[0, 5], target_landmarks=[0, 5])


def usual(given, otherwise):
    """What the fuzzer gives, or what the call takes."""
    return otherwise if given is None else given


CALLS = (
    lambda a, b, c: authalic.Surface(a, b),
    lambda a, b, c: authalic.Surface(usual(c, FLAT), b, flat=True),
    lambda a, b, c: authalic.disk_map(a, b, density=c, max_iterations=1),
    lambda a, b, c: authalic.disk_map(a, b, initial=c, boundary="free", angle_weight=0.1, max_iterations=1),
    lambda a, b, c: authalic.disk_map(a, b, fill_holes=True, repair=True, max_iterations=1),
    lambda a, b, c: authalic.disk_maps([(a, b), (DISK, FACES)], densities=[c, None], max_iterations=1),
    lambda a, b, c: authalic.sphere_map(a, b, initial=c, fill_holes=True, max_iterations=1),
    lambda a, b, c: authalic.sphere_map(TETRAHEDRON, density=c, max_iterations=1),
    lambda a, b, c: authalic.distortion(a, b, usual(c, FLAT)),
    lambda a, b, c: authalic.distortion(DISK, FACES, FLAT, density=c),
    lambda a, b, c: authalic.distortions([(a, b)], [usual(c, FLAT)]),
    lambda a, b, c: authalic.stretch_hessian(a, b, usual(c, DISK)),
    lambda a, b, c: authalic.stretch_hessian(DISK, FACES, DISK, density=c),
    lambda a, b, c: authalic.cut(a, b, seams=c),
    lambda a, b, c: authalic.repair(a, b),
    lambda a, b, c: authalic.untangle((a, b), usual(c, FLAT)),
    lambda a, b, c: authalic.pack(usual(c, FLAT), b, [0, 0, 0, 0]),
    lambda a, b, c: authalic.pack(FLAT, FACES, usual(c, [0, 0, 0, 0])),
    lambda a, b, c: authalic.seams((a, b), weights=c, target=2.0),
    lambda a, b, c: authalic.seams(TETRAHEDRON, fixed=c, target=2.0),
    lambda a, b, c: authalic.seams(TETRAHEDRON, diagonals=c, method="cones"),
    lambda a, b, c: authalic.seams(TETRAHEDRON, front=c, target=2.0),
    lambda a, b, c: authalic.unwrap((a, b), seams=c),
    lambda a, b, c: authalic.unwrap((a, b), fixed=c, target=2.0),
    lambda a, b, c: authalic.register_disks(
        (a, b), (a, b), source_landmarks=usual(c, [0]), target_landmarks=usual(c, [0])
    ),
    lambda a, b, c: authalic.register_disks(
        (DISK, FACES),
        (DISK, FACES),
        source_landmarks=[0],
        target_landmarks=[0],
        weights=c,
        features=(a, a),
    ),
    lambda a, b, c: authalic.register_spheres(
        BALL, BALL, source_landmarks=usual(c, [0, 5]), target_landmarks=[0, 5]
    ),
    lambda a, b, c: authalic.register_spheres(
        (a, b), TETRAHEDRON, source_landmarks=[0, 1], target_landmarks=[0, 1], fill_holes=True
    ),
    lambda a, b, c: authalic.hyperbolic_structure(BALL, curves=usual(c, SLITS)),
    lambda a, b, c: authalic.register_hyperbolic(
        BALL, BALL, source_curves=[usual(c, SLITS[0]), *SLITS[1:]], target_curves=SLITS, max_iterations=1
    ),
    lambda a, b, c: authalic.homotopy(a, BETWEEN_DISKS, 0.5),
    lambda a, b, c: DISK_MAP.locate(usual(c, [[0, 0]]), outside="nearest"),
    lambda a, b, c: DISK_MAP.image_of([0], usual(c, [[1, 0, 0]])),
    lambda a, b, c: DISK_MAP.sample(a, usual(c, [[0, 0]]), outside="nearest"),
    lambda a, b, c: DISK_MAP.image(a, (3, 4), extent=c),
    lambda a, b, c: DISK_MAP.image(a, (3, 4), conservative=True),
    lambda a, b, c: SPHERE_MAP.locate(usual(c, [[0, 0, 1]])),
    lambda a, b, c: SPHERE_MAP.image_of(usual(c, [0]), [[1, 0, 0]]),
    lambda a, b, c: SPHERE_MAP.sample(usual(c, [1, 2, 3, 4]), a),
    lambda a, b, c: SPHERE_MAP.equirectangular(usual(c, [1, 2, 3, 4]), (3, 6)),
    lambda a, b, c: SPHERE_MAP.equal_area_grid(usual(c, [1, 2, 3, 4]), 3, conservative=True),
    lambda a, b, c: SPHERE_MAP.resample(usual(c, [1, 2, 3, 4]), 1, nearest=True),
    lambda a, b, c: BALL_MAP.layout(pole=usual(c, "z")),
    lambda a, b, c: BALL_MAP.layout("octahedral", candidates=c),
    lambda a, b, c: BALL_MAP.layout(polygons=c),
    lambda a, b, c: BETWEEN_DISKS.pull(a),
    lambda a, b, c: BETWEEN_DISKS.pull(a, nearest=True),
    lambda a, b, c: BETWEEN_SPHERES.pull(usual(c, VALUES), smooth=True),
    lambda a, b, c: BETWEEN_DISKS.follow(a, pieces=c),
    lambda a, b, c: BETWEEN_DISKS.compare(usual(c, np.arange(5)), np.arange(5)),
    lambda a, b, c: REPAIRED.carry(a),
)
ALLOWED = (ValueError, TypeError, OverflowError)
OUTCOMES = ("done", *(each.__name__ for each in ALLOWED), *authalic.ERROR_KINDS)
# The fuzzer keeps inputs that reach new code, and sees none of the native module's: so each outcome of each
# call has a function of its own.
REACHED = {(call, outcome): atheris.instrument_func(lambda: None) for call in CALLS for outcome in OUTCOMES}


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
