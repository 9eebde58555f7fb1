# SPDX-License-Identifier: MIT OR Apache-2.0
"""The files that differ from the main branch, and the steps that they can touch."""

from __future__ import annotations

import subprocess
from fnmatch import fnmatch
from typing import Dict, Iterable, Tuple

from shell import ROOT, Unavailable

Selection = Dict[str, Tuple[str, ...]]
"""{step: the places that pytest runs}; an empty tuple is the whole step."""

BLENDER = ("blender-4.2", "blender-5")
INSTALLED = (*BLENDER, "window")
BUILT = ("wheel", "types", "docstrings", "python", "extension", "docs", *INSTALLED)
RUST = ("rustfmt", "clippy", "rust", "web", "rustdoc")
EVERYTHING = ("environments", *RUST, "ruff", "workflows", *BUILT)
STRUCTURE = ("tests/test_architecture.py", "tests/test_docs.py")
PROJECT = (*STRUCTURE, "tests/test_scripts.py")
_OF_TUTORIAL = ("tests/blender/test_tutorial.py",)
_OF_MANUAL = ("tests/blender/test_preferences.py",)


def _whole(*steps: str) -> Selection:
    return dict.fromkeys(steps, ())


# The first pattern that fits a file counts (`*` also stands for slashes); {file} is the file itself.
_RULES: tuple[tuple[str, Selection], ...] = (
    ("rust/fuzz/fuzz_targets/*", {}),
    ("rust/fuzz/Cargo.*", {}),
    ("rust/fuzz/*", _whole("rustfmt", "clippy", "rust")),
    ("rust/web/page/*", {"python": STRUCTURE}),
    ("rust/web/Cargo.lock", {"web": (), "python": PROJECT}),
    ("rust/web/*", {"web": (), "python": STRUCTURE}),
    ("rust/core/tests/*", _whole("rustfmt", "clippy", "rust")),
    ("rust/core/*", _whole(*EVERYTHING)),
    ("rust/python/authalic/*", _whole("ruff", *BUILT)),
    ("rust/python/*", _whole("rustfmt", "clippy", "rustdoc", *BUILT)),
    ("addon/*", {**_whole("ruff", "types", "extension", *INSTALLED), "python": STRUCTURE}),
    ("tests/api/test_*.py", {"ruff": (), "python": ("{file}",)}),
    ("tests/api/*", {"ruff": (), "python": ("tests/api", "tests/cli", "tests/test_scripts.py")}),
    ("tests/cli/test_*.py", {"ruff": (), "python": ("{file}",)}),
    ("tests/cli/*", {"ruff": (), "python": ("tests/cli",)}),
    ("tests/blender/test_*.py", {"ruff": (), "types": (), **dict.fromkeys(BLENDER, ("{file}",))}),
    ("tests/blender/*", _whole("ruff", "types", *BLENDER)),
    ("tests/data/*", {"python": ("tests/api",), **_whole(*BLENDER)}),
    ("tests/compatibility/*", {"ruff": (), "python": STRUCTURE}),
    ("tests/web/*", {"ruff": (), "python": STRUCTURE}),
    ("tests/gui/driver.py", _whole("ruff", "types", "window")),
    ("tests/gui/start.py", _whole("ruff", "types", "window")),
    ("tests/gui/*.py", {"ruff": (), "types": (), "window": ("{file}",)}),
    ("tests/gui/*.sh", _whole("window")),
    ("tests/test_architecture.py", {"ruff": (), "python": STRUCTURE}),
    ("tests/test_docstrings.py", _whole("ruff", "docstrings")),
    ("tests/test_*.py", {"ruff": (), "python": ("{file}",)}),
    ("scripts/lib/bench/*", {"ruff": (), "python": PROJECT}),
    ("scripts/lib/demo/*", {"ruff": (), "python": PROJECT}),
    ("scripts/examples/*", {"ruff": (), "python": PROJECT}),
    ("scripts/bench", {"ruff": (), "python": PROJECT}),
    ("scripts/build", {"ruff": (), "python": PROJECT}),
    ("scripts/docs", {"ruff": (), "python": PROJECT}),
    ("scripts/demo", {"ruff": (), "python": PROJECT}),
    ("scripts/compatibility", {"ruff": (), "python": PROJECT}),
    ("scripts/cross", {"ruff": (), "python": PROJECT}),
    ("scripts/lib/cross/*", {"ruff": (), "python": PROJECT}),
    ("scripts/fuzz", {"ruff": (), "python": PROJECT}),
    ("scripts/lib/fuzz/*", {"ruff": (), "python": PROJECT}),
    ("scripts/site", {"ruff": (), "python": PROJECT}),
    ("scripts/lib/web/*", {"ruff": (), "python": PROJECT}),
    ("scripts/requirements/web.txt", {}),
    ("scripts/requirements/fuzz.txt", {}),
    ("scripts/lib/compatibility.py", {"ruff": (), "python": PROJECT}),
    ("scripts/release", {"ruff": (), "python": PROJECT}),
    ("scripts/lib/release/*", {"ruff": (), "python": PROJECT}),
    ("scripts/licenses.*", {"python": PROJECT}),
    (".github/*", {"workflows": (), "python": PROJECT}),
    ("scripts/requirements/workflows.txt", _whole("workflows")),
    ("scripts/requirements/release.txt", {}),
    ("scripts/requirements/build.txt", {}),
    ("scripts/requirements/docstrings.txt", _whole("docstrings")),
    ("scripts/requirements/surfaces.txt", _whole("python")),
    ("scripts/requirements/docs.txt", _whole("docs")),
    ("scripts/requirements/peer-*", {}),
    ("scripts/requirements/numpy-*", {}),
    ("scripts/requirements/bpy-4.5.txt", {}),
    ("scripts/requirements/bpy-5.[13].txt", {}),
    # The manual, which the zip holds.
    (
        "docs/blender.md",
        {"python": PROJECT, "extension": (), "docs": (), **dict.fromkeys(BLENDER, _OF_MANUAL)},
    ),
    ("docs/tutorials/artist.md", {"python": PROJECT, "docs": (), **dict.fromkeys(BLENDER, _OF_TUTORIAL)}),
    ("docs/*.py", {"ruff": (), "python": PROJECT, "docs": ()}),
    ("docs/*", {"python": PROJECT, "docs": ()}),
    ("THIRD-PARTY-LICENSES.md", {"wheel": (), "python": PROJECT, "extension": ()}),
    ("*.md", {"python": PROJECT, "docs": ()}),
    ("CITATION.cff", {"python": PROJECT}),
    ("*", _whole(*EVERYTHING)),
)


def touched(files: Iterable[str]) -> Selection:
    """The steps that any of the files can touch, each with the places that pytest runs."""
    selection: Selection = {}
    for file in files:
        for step, places in _rule(file).items():
            before = selection.get(step)
            whole = places == () or before == ()
            selection[step] = () if whole else tuple(sorted({*(before or ()), *places}))
    return selection


def changed_files() -> list[str]:
    """The files that differ from the main branch where HEAD left it, committed or not, and new files."""
    differing = _git("diff", "--name-only", "--no-renames", "-z", base(), "--")
    new = _git("ls-files", "--others", "--exclude-standard", "-z")
    if differing is None or new is None:
        raise Unavailable("`--only changed` asks git what has changed, and git answers nothing here")
    return sorted(filter(None, [*differing.split("\0"), *new.split("\0")]))


def base() -> str:
    """The commit at which HEAD left the main branch, origin's or the local `main`; HEAD if neither exists."""
    for branch in ("origin/HEAD", "main"):
        commit = _git("merge-base", branch, "HEAD")
        if commit is not None:
            return commit.strip()
    return "HEAD"


def _rule(file: str) -> Selection:
    """The steps that one file can touch. Deleted tests are left out."""
    steps = next(steps for pattern, steps in _RULES if fnmatch(file, pattern))
    places = {step: tuple(place.format(file=file) for place in names) for step, names in steps.items()}
    existing = {step: tuple(filter(_exists, names)) for step, names in places.items()}
    return {step: existing[step] for step in steps if existing[step] or not places[step]}


def _exists(place: str) -> bool:
    return (ROOT / place).exists()


def _git(*words: str) -> str | None:
    """The output of git, or None if it fails or is missing."""
    try:
        done = subprocess.run(["git", *words], cwd=str(ROOT), capture_output=True, text=True)
    except OSError:
        return None
    return done.stdout if done.returncode == 0 else None
