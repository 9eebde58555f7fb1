# SPDX-License-Identifier: MIT OR Apache-2.0
"""`set_threads`: how many threads compute, and that results do not depend on it."""

import subprocess
import sys
from pathlib import Path

import pytest

import authalic

# Counts the threads of the process as Linux lists them: those of the library stay after a call.
PROGRAM = """
import os, sys, time
sys.path.insert(0, sys.argv[1])
import authalic
from api import meshes
def threads():
    return len(os.listdir("/proc/self/task"))
def soon(count):
    end = time.monotonic() + 20
    while threads() != count and time.monotonic() < end:
        time.sleep(0.01)
    return threads()
before, maps = threads(), []
MARKS = [10, 100, 200]
for count in (3, 1, 5):
    authalic.set_threads(count)
    cap = meshes.bumpy_cap()
    found = authalic.register_disks(cap, cap, source_landmarks=MARKS, target_landmarks=MARKS)
    maps.append(authalic.disk_map(*cap).uv.tobytes() + found.positions.tobytes())
    assert soon(before + count) == before + count, (count, threads() - before)
assert len(set(maps)) == 1
"""


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="counts threads as Linux lists them")
def test_as_many_threads_compute_as_are_set():
    tests = Path(__file__).resolve().parents[1]
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(tests)], check=False, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("count", [-1, 1.5, "two"])
def test_what_is_no_number_of_threads_is_refused(count):
    with pytest.raises((TypeError, OverflowError)):
        authalic.set_threads(count)
