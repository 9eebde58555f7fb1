# SPDX-License-Identifier: MIT OR Apache-2.0
"""The parts of scripts/ that can go wrong without anyone noticing."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts" / "lib"))

import pythons
import steps
from shell import ROOT, CommandFailed, Unavailable, run, version


@pytest.fixture
def no_other_pythons(monkeypatch, tmp_path):
    """Only a folder `bin` on PATH and an empty pyenv, so that a test says what there is to be found."""
    (tmp_path / "bin").mkdir()
    monkeypatch.setattr(pythons, "_USUAL_FOLDERS", ())
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    monkeypatch.setenv("PYENV_ROOT", str(tmp_path / "pyenv"))
    monkeypatch.setenv("UV_PYTHON_INSTALL_DIR", str(tmp_path / "uv"))
    return tmp_path


def fake_python(path: Path, version: str, code: int = 0) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\necho {version}\nexit {code}\n")
    path.chmod(0o755)
    return path


def test_a_shim_that_fails_is_passed_over(no_other_pythons):
    fake_python(no_other_pythons / "bin" / "python3.99", "3.99", code=127)
    real = fake_python(no_other_pythons / "pyenv" / "versions" / "3.99.1" / "bin" / "python", "3.99")
    assert pythons.find("3.99") == (real, "3.99")


def test_the_newest_patch_release_is_taken(no_other_pythons):
    for patch in ("3.99.9", "3.99.10", "3.99.2"):
        fake_python(no_other_pythons / "pyenv" / "versions" / patch / "bin" / "python", "3.99")
    assert "3.99.10" in str(pythons.find("3.99")[0])


def test_a_missing_python_is_named_with_what_to_do(no_other_pythons):
    with pytest.raises(Unavailable, match=r"no Python 3\.98 or 3\.99 .*install python3\.99"):
        pythons.find("3.98", "3.99")


def test_cargo_results_are_summed():
    output = (
        "test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.1s\n"
        "test result: FAILED. 2 passed; 4 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.1s\n"
    )
    assert steps.count_cargo(output) == steps.Count(5, 4, 1)


def test_junit_results_are_summed(tmp_path):
    report = tmp_path / "report.xml"
    report.write_text('<testsuites><testsuite tests="7" failures="1" errors="1" skipped="2"/></testsuites>')
    assert steps.count_junit(report) == steps.Count(3, 2, 2)
    assert steps.count_junit(tmp_path / "absent.xml") == steps.Count()


def test_a_command_that_hangs_after_its_report_is_killed(monkeypatch, tmp_path):
    monkeypatch.setattr("shell.EXIT_SECONDS", 0.1)
    report = tmp_path / "report.xml"
    script = f"import time; open({str(report)!r}, 'w').close(); time.sleep(60)"
    with pytest.raises(CommandFailed):
        run([sys.executable, "-c", script], report=report)


def test_the_changelog_has_an_entry_for_the_version():
    assert f"\n## {version()} " in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
