# SPDX-License-Identifier: MIT OR Apache-2.0
"""atheris: the text of a file of landmarks is read, or refused in few words."""

import importlib.util
import json
import sys
import types
from pathlib import Path

import atheris

ADDON = Path(__file__).resolve().parents[3] / "addon"


def module(name):
    """A module of the extension that needs no Blender, without the package around it."""
    spec = importlib.util.spec_from_file_location(f"addon.{name}", ADDON / f"{name.replace('.', '/')}.py")
    made = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = made
    spec.loader.exec_module(made)
    return made


for package in ("addon", "addon.surfaces", "addon.landmarks"):
    sys.modules[package] = types.ModuleType(package)
    sys.modules[package].__path__ = []
module("surfaces.arrays")
files = module("landmarks.files")

VALUES = (
    None,
    True,
    -1,
    0,
    7,
    2**31,
    10**30,
    1.5,
    1e400,
    "",
    "Nose",
    "\ud800",
    "a\0",
    [],
    {},
    [1, 2],
    "x" * 300,
)


def value(data, depth=0):
    kind = data.ConsumeIntInRange(0, 9)
    if kind < 7 or depth > 4:
        return data.PickValueInList(list(VALUES))
    if kind == 7:
        return [value(data, depth + 1) for _ in range(data.ConsumeIntInRange(0, 4))]
    names = ("name", "source", "target", "weight", "pairs", "curves", "format", "version")
    return {
        data.PickValueInList(list(names)): value(data, depth + 1) for _ in range(data.ConsumeIntInRange(0, 4))
    }


def entry(data):
    made = {"name": "Nose", "source": data.ConsumeIntInRange(0, 9), "target": [1, 2, 3]}
    for _ in range(data.ConsumeIntInRange(0, 2)):
        made[data.PickValueInList(["name", "source", "target", "weight"])] = value(data)
    return made


def check(bytes_of_fuzzer):
    data = atheris.FuzzedDataProvider(bytes_of_fuzzer)
    if data.ConsumeBool():
        text = data.ConsumeUnicode(400)
    else:
        content = {"format": files.FORMAT, "version": 1, "source": "A", "target": "B", "pairs": []}
        content["pairs"] = [entry(data) for _ in range(data.ConsumeIntInRange(0, 3))]
        content["curves"] = [entry(data) for _ in range(data.ConsumeIntInRange(0, 2))]
        if data.ConsumeBool():
            content[data.PickValueInList(sorted(content))] = value(data)
        text = json.dumps(content)
    try:
        landmarks = files.from_text(text)
    except files.CannotRead as problem:
        assert len(str(problem)) < 400, "the message is too long"
        return
    # What was read can be kept by Blender, and be written and read again.
    assert all(0 <= pair.source < 2**31 and 0 <= pair.target < 2**31 for pair in landmarks.pairs)
    files.to_text(landmarks).encode("utf-8")
    again = files.from_text(files.to_text(landmarks))
    assert again.pairs == landmarks.pairs and (again.curves or []) == (landmarks.curves or [])


atheris.instrument_all()
atheris.Setup(sys.argv, check)
atheris.Fuzz()
