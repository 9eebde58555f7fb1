# SPDX-License-Identifier: MIT OR Apache-2.0
"""The steps of scripts/test, in the order in which they run."""

from __future__ import annotations

import re
import xml.etree.ElementTree as xml
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import Callable

import distribution
import documentation
import environment
import windows
from environment import Environment
from shell import OUT, ROOT, CommandFailed, run

LOGS = OUT / "test"
CARGO_OPTIONS = ("--locked", "--release", "--workspace", "--features", "metis")
"""The wheel's profile and features everywhere: the tests run real solves, and no crate is built twice."""
_WORKFLOWS = ROOT / ".github" / "workflows"
_DOCSTRINGS = "tests/test_docstrings.py"
_NOT_OF_THE_PACKAGE = ("tests/blender", "tests/compatibility", "tests/gui", "tests/web", _DOCSTRINGS)
_PYTHON_TESTS = ("tests", *(f"--ignore={place}" for place in _NOT_OF_THE_PACKAGE))
_BLENDER_TESTS = ("tests/blender",)
_SIDE_BY_SIDE = ("--numprocesses=2", "--dist=worksteal")
"""Small meshes keep one processor busy; more processes would only be in the way of large ones."""
_PYTHON_SOURCES = (
    "addon",
    "docs/conf.py",
    "docs/_extensions",
    "docs/examples",
    "scripts",
    "tests",
    "rust/python",
)

_BUILDING = Lock()
"""Keeps steps that run side by side from building the same file."""

# Tests do much that Blender's types refuse: they pass any sequence, and use properties of the extension.
_LAX_ABOUT_BLENDER = (
    *("--no-strict-optional", "--no-warn-return-any", "--disable-error-code=arg-type"),
    *("--disable-error-code=attr-defined", "--disable-error-code=union-attr"),
    "--disable-error-code=func-returns-value",
)


@dataclass
class Count:
    """Tests that passed, failed, and were skipped."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0

    def __add__(self, other: Count) -> Count:
        pairs = zip((self.passed, self.failed, self.skipped), (other.passed, other.failed, other.skipped))
        return Count(*map(sum, pairs))


class TestsFailed(Exception):
    """Tests failed, or their run did not end well."""

    def __init__(self, count: Count, message: str, output: str) -> None:
        super().__init__(message)
        self.count = count
        self.output = output


@dataclass(frozen=True)
class Step:
    """A named step; `run` takes the file for its log and returns the tests it counted.

    If it runs pytest, it also takes `places`, the files and folders to run instead of all. Neighbors of the
    same `group` run side by side.
    """

    name: str
    what: str
    run: Callable[..., Count]
    group: str = ""


def make_environments(log: Path) -> Count:
    """Downloading and unpacking takes a minute, which the compiler's processors can spare."""
    environment.dev()
    environment.any_blender()
    environment.blender_oldest()
    environment.docs()
    return Count()


def check_rust_format(log: Path) -> Count:
    run(["cargo", "fmt", "--all", "--check"], log=log)
    return Count()


def check_clippy(log: Path) -> Count:
    run(["cargo", "clippy", *CARGO_OPTIONS, "--all-targets", "--", "-D", "warnings"], log=log)
    return Count()


def test_rust(log: Path) -> Count:
    try:
        output = run(["cargo", "test", *CARGO_OPTIONS, "--no-fail-fast"], log=log)
    except CommandFailed as failure:
        raise TestsFailed(count_cargo(failure.output), str(failure), failure.output) from failure
    return count_cargo(output)


def test_web(log: Path) -> Count:
    """Formatting, lints and tests of the crate of the page, in its own workspace."""
    manifest = ("--manifest-path", ROOT / "rust" / "web" / "Cargo.toml")
    run(["cargo", "fmt", "--all", "--check", *manifest], log=log)
    variables = {"CARGO_TARGET_DIR": str(ROOT / "target")}
    options = ("--locked", "--release", *manifest)
    run(["cargo", "clippy", *options, "--all-targets", "--", "-D", "warnings"], variables, log)
    try:
        output = run(["cargo", "test", *options], variables, log)
    except CommandFailed as failure:
        raise TestsFailed(count_cargo(failure.output), str(failure), failure.output) from failure
    return count_cargo(output)


def check_rust_docs(log: Path) -> Count:
    command = ["cargo", "doc", *CARGO_OPTIONS, "--no-deps", "--document-private-items"]
    run(command, {"RUSTDOCFLAGS": "-D warnings"}, log)
    return Count()


def check_python_style(log: Path) -> Count:
    ruff = environment.dev().tool("ruff")
    run([ruff, "check", *_PYTHON_SOURCES], log=log)
    run([ruff, "format", "--check", *_PYTHON_SOURCES], log=log)
    return Count()


def check_workflows(log: Path) -> Count:
    """The form of the workflows, the types in their expressions, and what strangers could misuse."""
    dev = environment.dev()
    environment.add(dev, "workflows")
    run([dev.tool("actionlint"), *sorted(_WORKFLOWS.glob("*.yml"))], log=log)
    run([dev.tool("zizmor"), "--offline", "--persona=pedantic", "--quiet", _WORKFLOWS], log=log)
    return Count()


def install_wheel(log: Path) -> Count:
    dev = environment.dev()
    distribution.install_wheel(distribution.build_wheel(dev, log=log), dev, log)
    return Count()


def check_types(log: Path) -> Count:
    """The stub against the built module, then the types of the package, of the extension and of its tests."""
    install_wheel(log)
    python = environment.dev().python
    run([python, "-m", "mypy.stubtest", "authalic._native"], log=log)
    run([python, "-m", "mypy", "rust/python/authalic"], log=log)
    run([python, "-m", "mypy", "addon"], log=log)
    run([python, "-m", "mypy", *_LAX_ABOUT_BLENDER, "tests/blender", "tests/gui"], log=log)
    return Count()


def check_docstrings(log: Path) -> Count:
    install_wheel(log)
    environment.add(environment.dev(), "docstrings")
    return run_pytest(environment.dev(), (_DOCSTRINGS,), {}, log)


def test_python(log: Path, places: tuple[str, ...] = _PYTHON_TESTS) -> Count:
    install_wheel(log)
    environment.add(environment.dev(), "surfaces", "--no-deps")
    return run_pytest(environment.dev(), places, {}, log, _SIDE_BY_SIDE)


def build_documentation(log: Path) -> Count:
    with _BUILDING:
        wheel = distribution.build_wheel(environment.dev(), log=log)
    documentation.build(wheel, log)
    return Count()


def build_extension(log: Path) -> Count:
    _extension(environment.any_blender(), log)
    return Count()


def test_blender_oldest(log: Path, places: tuple[str, ...] = _BLENDER_TESTS) -> Count:
    return _test_in_blender(environment.blender_oldest(), places, log)


def test_blender_newest(log: Path, places: tuple[str, ...] = _BLENDER_TESTS) -> Count:
    return _test_in_blender(environment.blender_newest(), places, log)


def test_in_window(log: Path, places: tuple[str, ...] = ()) -> Count:
    """Skipped where there can be no window, whatever the reason."""
    archive = _extension(environment.any_blender(), log)
    names = [Path(place).stem for place in places] or windows.scripts()
    count = Count(*windows.run_scripts(archive, names, log))
    if count.failed:
        raise TestsFailed(count, f"screenshots are in {windows.PICTURES}", log.read_text(encoding="utf-8"))
    return count


STEPS = (
    Step("environments", "Python environments in .venv/", make_environments, "first"),
    Step("rustfmt", "formatting of the Rust code", check_rust_format, "first"),
    Step("clippy", "lints of the Rust code", check_clippy, "first"),
    Step("rust", "tests of the Rust crates", test_rust),
    Step("web", "format, lints and tests of the crate of the page that runs the core", test_web),
    Step("rustdoc", "documentation of the Rust crates", check_rust_docs, "documentation"),
    Step("ruff", "formatting and lints of the Python code", check_python_style, "documentation"),
    Step("workflows", "lints of the workflows", check_workflows, "documentation"),
    Step("wheel", "build of the wheel, installed into .venv/dev", install_wheel),
    Step("types", "stub against the built module, types of the package and of the extension", check_types),
    Step("docstrings", "rules and examples of the docstrings of the package", check_docstrings),
    Step("python", "tests of the Python package and of the project's structure", test_python),
    Step("extension", "build and validation of the extension zip", build_extension),
    Step("blender-4.2", "tests of the installed extension in Blender 4.2", test_blender_oldest, "blender"),
    Step(
        "blender-5", "tests of the installed extension in the newest Blender", test_blender_newest, "blender"
    ),
    Step(
        "docs",
        "the site of the documentation, with the examples of its gallery",
        build_documentation,
        "blender",
    ),
    Step("window", "tests of the installed extension in a real window", test_in_window, "blender"),
)


def count_cargo(output: str) -> Count:
    """The sums over the lines `test result: ok. 3 passed; 0 failed; 1 ignored; ...`."""
    rows = re.findall(r"(?m)^test result: \w+\. (\d+) passed; (\d+) failed; (\d+) ignored", output)
    return sum((Count(*map(int, row)) for row in rows), Count())


def count_junit(report: Path) -> Count:
    """The sums over the test suites of a JUnit report; zeros without a readable report."""
    try:
        suites = list(xml.parse(str(report)).getroot().iter("testsuite"))
    except (OSError, xml.ParseError):
        return Count()
    total, bad, skipped = (
        sum(int(suite.get(key, 0)) for suite in suites for key in keys)
        for keys in (("tests",), ("failures", "errors"), ("skipped",))
    )
    return Count(total - bad - skipped, bad, skipped)


def _extension(blender: Environment, log: Path) -> Path:
    with _BUILDING:
        wheel = distribution.build_wheel(environment.dev(), log=log)
        return distribution.build_zip(wheel, blender, log)


def _test_in_blender(blender: Environment, places: tuple[str, ...], log: Path) -> Count:
    archive = _extension(blender, log)
    variables = distribution.fresh_profile(archive, LOGS / f"profile-{blender.name}")
    return run_pytest(blender, places, variables, log)


def run_pytest(
    where: Environment,
    places: tuple[str, ...],
    variables: dict[str, str],
    log: Path,
    options: tuple[str, ...] = (),
) -> Count:
    """Runs pytest; a run that does not end after it has written its report is killed and fails."""
    report = log.with_suffix(".xml")
    report.unlink(missing_ok=True)
    command = [where.python, "-m", "pytest", f"--junitxml={report}", *options, *places]
    try:
        run(command, variables, log, report)
    except CommandFailed as failure:
        raise TestsFailed(count_junit(report), str(failure), failure.output) from failure
    return count_junit(report)
