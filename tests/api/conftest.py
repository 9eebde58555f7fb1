# SPDX-License-Identifier: MIT OR Apache-2.0
"""Fixtures for several files of tests."""

import os
import subprocess
import sys
from pathlib import Path

import pytest


def run_python(code, **variables):
    """Runs code in a fresh interpreter that can import the package `api`; returns what it prints."""
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=Path(__file__).resolve().parents[1],
        env={**os.environ, **variables},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.fixture(name="run_python")
def run_python_fixture():
    return run_python
