# SPDX-License-Identifier: GPL-3.0-or-later
"""Landmarks in .blend files and as JSON."""

import io
import json
import os
from pathlib import Path
from typing import Any

import bpy
import pairing
import pytest
from installed import part
from meshes import MeshObject


@pytest.fixture
def heads() -> tuple[MeshObject, MeshObject]:
    return pairing.heads()


def test_saved_with_the_file(heads: tuple[MeshObject, MeshObject], tmp_path: Path) -> None:
    pairing.add(20, 30, name="Nose")
    pairing.add(21, 31)
    path = str(tmp_path / "heads.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert pairing.listed() == [("Nose", 20, 30, None), ("Landmark 2", 21, 31, None)]
    assert bpy.data.objects["Head A"].authalic_target == bpy.data.objects["Head B"]


def test_export_and_import(heads: tuple[MeshObject, MeshObject], tmp_path: Path) -> None:
    pairing.add(20, 30, name="Nase ü")
    pairing.add(21, 31)
    path = tmp_path / "pairs.json"
    bpy.ops.authalic.landmark_export(filepath=str(path))
    assert json.loads(path.read_text(encoding="utf-8")) == {
        "format": "authalic-landmarks",
        "version": 1,
        "source": "Head A",
        "target": "Head B",
        "pairs": [
            {"name": "Nase ü", "source": 20, "target": 30},
            {"name": "Landmark 2", "source": 21, "target": 31},
        ],
    }
    bpy.ops.authalic.landmark_clear()
    heads[0].authalic_target = None
    bpy.ops.authalic.landmark_import(filepath=str(path))
    assert pairing.listed() == [("Nase ü", 20, 30, None), ("Landmark 2", 21, 31, None)]
    assert heads[0].authalic_target == heads[1]


def test_soft_landmarks_keep_their_weights(heads: tuple[MeshObject, MeshObject], tmp_path: Path) -> None:
    for vertex, (is_soft, weight) in enumerate([(True, 0.3), (False, 7.0), (True, 123.456)], 20):
        pairing.add(vertex, vertex)
        landmark = heads[0].authalic_landmarks[-1]
        landmark.is_soft, landmark.weight = is_soft, weight
    path = tmp_path / "pairs.json"
    bpy.ops.authalic.landmark_export(filepath=str(path))
    written = [pair.get("weight") for pair in json.loads(path.read_text(encoding="utf-8"))["pairs"]]
    assert written == [0.3, None, 123.456]
    bpy.ops.authalic.landmark_clear()
    bpy.ops.authalic.landmark_import(filepath=str(path))
    soft = [landmark.is_soft for landmark in heads[0].authalic_landmarks]
    weights = [landmark.weight for landmark in heads[0].authalic_landmarks]
    assert soft == [True, False, True]
    assert (weights[0], weights[2]) == pytest.approx((0.3, 123.456))


def test_a_file_that_cannot_be_written_whole_stays(
    heads: tuple[MeshObject, MeshObject], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pairing.add(20, 30)
    path = tmp_path / "pairs.json"
    bpy.ops.authalic.landmark_export(filepath=str(path))
    before = path.read_bytes()

    class Full(io.FileIO):
        def write(self, data: Any, /) -> int:
            super().write(data[:1])
            raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "open", lambda self, mode: Full(self, mode.replace("b", "")))
    pairing.refused("No space left", bpy.ops.authalic.landmark_export, filepath=str(path))
    assert path.read_bytes() == before
    assert [each.name for each in tmp_path.iterdir()] == ["pairs.json"]


@pytest.mark.skipif(os.name != "posix", reason="needs links")
def test_export_follows_no_link_that_lies_beside(
    heads: tuple[MeshObject, MeshObject], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pairing.add(20, 30)
    folder, victim = tmp_path / "folder", tmp_path / "victim"
    folder.mkdir()
    victim.write_text("precious")
    (folder / ".pairs.json.part").symlink_to(victim)
    bpy.ops.authalic.landmark_export(filepath=str(folder / "pairs.json"))
    assert len(json.loads((folder / "pairs.json").read_text(encoding="utf-8"))["pairs"]) == 1
    # Not even where the name could be guessed.
    monkeypatch.setattr(os, "urandom", bytes)
    (folder / f".pairs.json.{bytes(8).hex()}").symlink_to(victim)
    pairing.refused("exists", bpy.ops.authalic.landmark_export, filepath=str(folder / "pairs.json"))
    assert victim.read_text(encoding="utf-8") == "precious"


def test_export_writes_nothing_that_import_refuses(
    heads: tuple[MeshObject, MeshObject], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pairing.add(20, 30)
    pairing.add(21, 31)
    path = tmp_path / "pairs.json"
    for name, most, said in (("MOST_PAIRS", 1, "there are 2 pairs; 1 are"), ("MOST_BYTES", 99, "MB are the")):
        with monkeypatch.context() as patch:
            patch.setattr(part("landmarks.files"), name, most)
            pairing.refused(said, bpy.ops.authalic.landmark_export, filepath=str(path))
        assert not path.exists()


def test_what_the_limits_of_a_file_are_meant_for_fits() -> None:
    """10,000 pairs with weights, and 1,000 curves of 100 vertices, of meshes of millions."""
    files = part("landmarks.files")
    pairs = [files.Point(f"Landmark {k}", 7_000_000 + k, 8_000_000 + k, 123.456) for k in range(10_000)]
    path = tuple(range(7_000_000, 7_000_100))
    curves = [(f"Curve {k}", path, path) for k in range(1_000)]
    text = files.to_text(files.Landmarks("Head A", "Head B", pairs, curves))
    assert len(text) < files.MOST_BYTES
    again = files.from_text(text)
    assert again.pairs == pairs and again.curves == curves


def test_export_leaves_out_what_is_lost(heads: tuple[MeshObject, MeshObject], tmp_path: Path) -> None:
    pairing.add(20, 30)
    pairing.add(21, 31)
    pairing.in_edit_mode(heads[0], 20, do=lambda: bpy.ops.mesh.delete(type="VERT"))
    path = tmp_path / "pairs.json"
    bpy.ops.authalic.landmark_export(filepath=str(path))
    assert [pair["source"] for pair in json.loads(path.read_text(encoding="utf-8"))["pairs"]] == [20]


GOOD = {"format": "authalic-landmarks", "version": 1, "source": "Head A", "target": "Head B"}


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("nonsense", "pairs.json: it is not JSON"),
        ([], "holds no landmarks"),
        ({**GOOD, "format": "other", "pairs": []}, "holds no landmarks"),
        ({**GOOD, "version": 2, "pairs": []}, "of version 2"),
        (GOOD, '"pairs" is missing'),
        ({**GOOD, "pairs": [7]}, "pair 1 is 7"),
        ({**GOOD, "pairs": [{"source": 1, "target": 2}, {"source": 1}]}, 'pair 2 has no "target"'),
        ({**GOOD, "pairs": [{"source": 1.5, "target": 2}]}, "the source of pair 1 is 1.5"),
        ({**GOOD, "pairs": [{"source": True, "target": 2}]}, "the source of pair 1 is true"),
        ({**GOOD, "pairs": [{"source": 1, "target": -2}]}, "the target of pair 1 is -2"),
        ({**GOOD, "pairs": [{"source": 1, "target": 2, "name": 3}]}, "the name of pair 1 is 3"),
        ({**GOOD, "pairs": [{"source": 1, "target": 2, "weight": 0}]}, "the weight of pair 1 is 0"),
        ({**GOOD, "pairs": [{"source": 1, "target": 2, "weight": "soft"}]}, 'the weight of pair 1 is "soft"'),
        ({**GOOD, "pairs": [{"source": 1, "target": 2, "weight": 10**400}]}, "not a number above 0"),
        ({**GOOD, "pairs": [{"source": 1, "target": 2}, {"source": 99, "target": 3}]}, "no vertex 99"),
        (
            {
                **GOOD,
                "pairs": [{"name": "A", "source": 1, "target": 2}, {"name": "A", "source": 1, "target": 3}],
            },
            'vertex 1 of Head A is in two pairs, "A", "A"',
        ),
    ],
)
def test_a_bad_file_changes_nothing(
    heads: tuple[MeshObject, MeshObject], tmp_path: Path, content: str, words: str
) -> None:
    pairing.add(20, 30)
    path = tmp_path / "pairs.json"
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    pairing.refused(words, bpy.ops.authalic.landmark_import, filepath=str(path))
    heads[0].authalic_target = None
    with pytest.raises(RuntimeError):
        bpy.ops.authalic.landmark_import(filepath=str(path))
    assert heads[0].authalic_target is None


PAIR = {"source": 1, "target": 2}


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("[" * 100_000, "nested too deeply"),
        ('{"format": ' + "9" * 5000 + "}", "it is not JSON"),
        ('{"format": NaN}', "holds no landmarks"),
        ({**GOOD, "version": [1] * 1000, "pairs": []}, "of version a list"),
        ({**GOOD, "pairs": [PAIR] * 10_001}, "10001 pairs; 10000 are the most"),
        ({**GOOD, "pairs": [], "curves": [PAIR] * 1_001}, "1001 curves; 1000 are"),
        ({**GOOD, "pairs": [{**PAIR, "source": 2**31}]}, "not the number of a vertex"),
        ({**GOOD, "pairs": [{**PAIR, "source": 10**4000}]}, "0000…, not the number of a vertex"),
        ({**GOOD, "pairs": [{**PAIR, "source": float("nan")}]}, "is NaN, not the number of a vertex"),
        ({**GOOD, "pairs": [{**PAIR, "weight": float("nan")}]}, "is NaN, not a number above 0"),
        ({**GOOD, "pairs": [{**PAIR, "weight": float("inf")}]}, "is Infinity, not a number above 0"),
        ({**GOOD, "pairs": [{**PAIR, "name": "\ud800"}]}, "characters that are no text"),
        ({**GOOD, "pairs": [{**PAIR, "name": "a\0b"}]}, "characters that are no text"),
        ({**GOOD, "pairs": [{**PAIR, "name": "x" * 201}]}, "has 201 characters"),
        ({**GOOD, "target": "\udfff", "pairs": []}, "characters that are no text"),
        (
            {**GOOD, "pairs": [], "curves": [{**PAIR, "source": [[]]}]},
            "source of curve 1 has a list",
        ),
        (
            {**GOOD, "pairs": [], "curves": [{"source": [1, 2], "target": [1, 2**40]}]},
            "target of curve 1 has",
        ),
    ],
)
def test_a_hostile_file_changes_nothing(
    heads: tuple[MeshObject, MeshObject], tmp_path: Path, content: Any, words: str
) -> None:
    pairing.add(20, 30)
    path = tmp_path / "pairs.json"
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    pairing.refused(words, bpy.ops.authalic.landmark_import, filepath=str(path))


def test_a_huge_file_is_not_read(heads: tuple[MeshObject, MeshObject], tmp_path: Path) -> None:
    pairing.add(20, 30)
    path = tmp_path / "pairs.json"
    path.write_bytes(b" " * (part("landmarks.files").MOST_BYTES + 1))
    pairing.refused("more than 4 MB", bpy.ops.authalic.landmark_import, filepath=str(path))
    if os.path.exists("/dev/zero"):  # which never ends
        pairing.refused("a device or a pipe", bpy.ops.authalic.landmark_import, filepath="/dev/zero")
        os.mkfifo(tmp_path / "pipe.json")
        pairing.refused(
            "a device or a pipe", bpy.ops.authalic.landmark_import, filepath=str(tmp_path / "pipe.json")
        )


def test_files_that_cannot_be_read_or_written(heads: tuple[MeshObject, MeshObject], tmp_path: Path) -> None:
    pairing.add(20, 30)
    pairing.refused(
        "nothing.json: No such file",
        bpy.ops.authalic.landmark_import,
        filepath=str(tmp_path / "nothing.json"),
    )
    pairing.refused("No file is named", bpy.ops.authalic.landmark_import, filepath="")
    away = str(tmp_path / "no" / "folder.json")
    pairing.refused("folder.json: No such file", bpy.ops.authalic.landmark_export, filepath=away)
    binary = tmp_path / "binary.json"
    binary.write_bytes(b"\xff\xfe\x00\x81")
    pairing.refused("binary.json", bpy.ops.authalic.landmark_import, filepath=str(binary))
