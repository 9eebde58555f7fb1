# SPDX-License-Identifier: GPL-3.0-or-later
"""Random sequences of operators on random meshes.

After every operator of the extension: vertices, faces, modes and selections are as they were, UVs outside
the selection too, and nothing is NaN. After undo and redo, and after a file is opened again, all is as it was
then.

AUTHALIC_SEQUENCES is the number of sequences, AUTHALIC_SEED the first seed: the failed seed 17 replays with
`AUTHALIC_SEED=17 AUTHALIC_SEQUENCES=1`. Should Blender crash, the profile's sequence.txt has the seed.
"""

import os
import traceback
from collections.abc import Callable
from pathlib import Path

import pytest
import sequence_edits as edits
import sequence_operators as operators
from sequence import Sequence

_FIRST = int(os.environ.get("AUTHALIC_SEED", "0"))
_COUNT = int(os.environ.get("AUTHALIC_SEQUENCES", "25"))
_LENGTH = 10
_ACTIONS: dict[Callable[[Sequence], None], int] = {
    edits.add: 2,
    edits.choose: 4,
    edits.switch_mode: 3,
    edits.choose_faces: 4,
    edits.mark: 3,
    edits.subdivide: 2,
    edits.delete_faces: 2,
    edits.extrude: 2,
    edits.flatten: 1,
    edits.delete_object: 1,
    edits.duplicate: 2,
    edits.link: 2,
    edits.undo: 6,
    edits.redo: 3,
    edits.reopen: 2,
    operators.unwrap: 10,
    operators.mark_seams: 3,
    operators.fix_flips: 2,
    operators.measure: 2,
    operators.set_texel_density: 2,
    operators.heat_map: 2,
    operators.live: 2,
    operators.landmark_curve: 1,
    operators.sphere_shape_key: 2,
    operators.register: 4,
    operators.transfer: 2,
}
"""How often each is chosen, relative to the others."""


@pytest.mark.parametrize("seed", range(_FIRST, _FIRST + _COUNT))
def test_a_random_sequence_of_operators(seed: int, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    Path(os.environ["BLENDER_USER_RESOURCES"], "sequence.txt").write_text(f"{seed}\n")
    sequence = Sequence(seed, tmp_path)
    try:
        _run(sequence)
    except Exception:
        lines = "\n".join(sequence.log)
        raise AssertionError(f"seed {seed}:\n{lines}\n{traceback.format_exc()}") from None
    output = "".join(capfd.readouterr())
    assert "Traceback" not in output, output


def _run(sequence: Sequence) -> None:
    for _ in range(sequence.random.randint(1, 3)):
        sequence.perform(edits.add)
    for action in sequence.random.choices([*_ACTIONS], [*_ACTIONS.values()], k=_LENGTH):
        sequence.perform(action)
