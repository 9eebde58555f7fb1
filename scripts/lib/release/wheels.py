# SPDX-License-Identifier: MIT OR Apache-2.0
"""The wheels: built from the unpacked sdist, with the same bytes wherever and whenever that is done."""

from __future__ import annotations

import hashlib
import os
import shutil
import stat
from pathlib import Path

import changelog
import environment
import pythons
from release import notices, own_crates, places, sources
from release.platforms import FREE_THREADED, Platform, named
from shell import ROOT, CommandFailed, Unavailable, run, tail

_INLINED = 150
"""The size of functions that are inlined. With LLVM's own 225 zips are 3 % larger, and runs hardly faster."""
_NO_GIT = "#!/bin/sh\necho 'a build must not need git' >&2\nexit 127\n"


def build(platform: str | None = None, free_threaded: bool = False, log: Path | None = None) -> Path:
    """The wheel in dist/release/: the one of the stable interface, or the one for free threads."""
    return _build(named(platform), free_threaded, places.FILES, log)


def build_again(platform: str | None = None, free_threaded: bool = False, log: Path | None = None) -> None:
    """Builds a wheel a second time, in the same place from nothing, and compares the bytes."""
    first = {path.name: digest(path) for path in places.wheels()}
    wheel = _build(named(platform), free_threaded, places.WORK / "again", log)
    if wheel.name not in first:
        raise Unavailable(f"{wheel.name} has not been built before: run `scripts/release wheel`")
    if digest(wheel) != first[wheel.name]:
        raise CommandFailed(["compare", wheel.name], 1, f"two builds of {wheel.name} differ; both are kept")


def digest(path: Path) -> str:
    """The SHA-256 of a file, as hexadecimal digits."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _build(platform: Platform, free_threaded: bool, folder: Path, log: Path | None) -> Path:
    tools = environment.build()
    if platform.needs_zig:
        environment.add(tools, "portable")
    source = sources.unpack(places.WORK / "build")
    python = pythons.find(FREE_THREADED)[0] if free_threaded else tools.python
    command = [tools.python, "-m", "maturin", "build", "--profile", "dist", "--locked"]
    command += ["--interpreter", python, "--compression-level", "9"]
    command += ["--manifest-path", source / "rust/python/Cargo.toml", "--out", places.WORK / "new"]
    shutil.rmtree(places.WORK / "new", ignore_errors=True)
    run(["cargo", "fetch", "--locked", "--manifest-path", source / "Cargo.toml"], log=log)
    run([*command, *platform.options], {**_variables(tools, source), **platform.variables}, log)
    shutil.rmtree(source.parent)  # half a gigabyte of objects
    [wheel] = (places.WORK / "new").glob("*.whl")
    folder.mkdir(parents=True, exist_ok=True)
    return own_crates.narrow(wheel, notices.compiled([platform.target]), folder / wheel.name)


def _variables(tools: environment.Environment, source: Path) -> dict[str, str]:
    """The environment of a build: no git, no clock, and no path of this machine in what is built."""
    renamed = _renamed_paths(source)
    c_flags = " ".join(f"-ffile-prefix-map={path}={name}" for path, name in renamed)
    flags = [f"--remap-path-prefix={path}={name}" for path, name in renamed]
    flags.append(f"-Cllvm-args=-inline-threshold={_INLINED}")
    is_windows = os.name == "nt"
    if is_windows:
        flags.append("-Clink-arg=/Brepro")  # a hash in the place of the time
    path = [str(tools.python.parent), os.environ.get("PATH", "")]
    return {
        "VIRTUAL_ENV": str(tools.folder),
        # maturin finds zig through the `python3` that is first on PATH.
        "PATH": os.pathsep.join(path if is_windows else [str(_without_git()), *path]),
        "SOURCE_DATE_EPOCH": changelog.source_date_epoch(),
        "CARGO_TARGET_DIR": str(source / "target"),
        "CARGO_INCREMENTAL": "0",
        "CARGO_ENCODED_RUSTFLAGS": "\x1f".join(flags),
        **({} if is_windows else {"CFLAGS": c_flags}),
    }


def _renamed_paths(source: Path) -> list[tuple[str, str]]:
    """Paths of this machine, and what stands for each in messages of panics. Of two, the last counts."""
    cargo = Path(os.environ.get("CARGO_HOME") or Path.home() / ".cargo")
    try:
        sysroot = tail(run(["rustc", "--print", "sysroot"]), 1)
    except OSError as problem:
        raise Unavailable("a wheel needs the Rust toolchain: `rustc` does not run") from problem
    crates = sorted((cargo / "registry" / "src").glob("*"))
    return [
        (str(ROOT), "/authalic"),
        (str(source), "/authalic"),
        *((str(folder), "/crates") for folder in crates),
        (str(Path(sysroot) / "lib/rustlib/src/rust"), "/rust"),
    ]


def _without_git() -> Path:
    """A folder whose `git` fails, to be first on PATH."""
    folder = places.WORK / "no-git"
    folder.mkdir(parents=True, exist_ok=True)
    git = folder / "git"
    git.write_text(_NO_GIT, encoding="utf-8")
    git.chmod(git.stat().st_mode | stat.S_IXUSR)
    return folder
