# SPDX-License-Identifier: MIT OR Apache-2.0
"""Inspects the sdist and the wheels: by the tools of packaging, and for what a release promises besides."""

from __future__ import annotations

import re
import tarfile
import zipfile
from pathlib import Path

import environment
from release import libraries, notices, places, platforms
from release.problems import Refused, refuse_any
from shell import ROOT, run, version

_LICENSES = ("LICENSE-MIT", "LICENSE-APACHE", notices.NAME)
# Messages of getopt.c and gkregex.c, the LGPL files among the C sources of METIS, which nothing here calls.
# Linkers of Linux and macOS leave them out; wheels for Windows are built without METIS.
_LGPL = (b"Premature end of regular expression", b"option `%s' is ambiguous")
# A folder of somebody's machine in messages of panics: of a user, of a runner, of a temporary build.
_FOREIGN_PATH = re.compile(rb"(?:/root|/home|/Users|/tmp|/work|[A-Z]:\\(?:Users|a))[/\\][\w./\\-]+")


def inspect(log: Path | None = None) -> None:
    """Everything about the files in dist/release/ that can be seen without installing them."""
    tools = environment.release()
    files = [places.sdist(), *places.wheels()]
    run([tools.python, "-m", "twine", "check", "--strict", *files], log=log)
    problems = _problems_of_sdist(places.sdist())
    for wheel in places.wheels():
        _audit(wheel, tools, log)
        problems += problems_of_wheel(wheel)
        problems += _problems_of_libraries(wheel, tools, log)
        problems += problems_of_lists(wheel, _in_sbom(wheel, tools, log))
    refuse_any(problems)


def problems_of_wheel(wheel: Path) -> list[str]:
    """What a wheel lacks or has too much of, a sentence each."""
    problems = problems_of_contents(wheel)
    paths = sorted(set(_FOREIGN_PATH.findall(_native_code(wheel))))
    if paths:
        problems.append(f"{wheel.name} names a folder of the machine that built it: {paths[0].decode()}")
    return problems


def problems_of_contents(wheel: Path) -> list[str]:
    """The same, wherever the wheel was built."""
    code, info = _native_code(wheel), f"authalic-{version()}.dist-info"
    with zipfile.ZipFile(str(wheel)) as archive:
        names = archive.namelist()
        metadata = archive.read(f"{info}/METADATA").decode() if f"{info}/METADATA" in names else ""
    wanted = [*(f"{info}/licenses/{name}" for name in _LICENSES), "authalic/py.typed", f"{info}/METADATA"]
    problems = [f"{wheel.name} lacks {name}" for name in wanted if name not in names]
    if not any(name.startswith(f"{info}/sboms/") for name in names):
        problems.append(f"{wheel.name} has no list of its crates (SBOM)")
    problems += [f"the description of {wheel.name} has {target}" for target in relative_targets(metadata)]
    return problems + [
        f"{wheel.name} holds code under the LGPL: {text.decode()}" for text in _LGPL if text in code
    ]


def relative_targets(text: str) -> list[str]:
    """The links and pictures of a Markdown text that lead to files beside it: in a registry, nowhere."""
    targets = re.findall(r"\]\(([^)\s]+)", text) + re.findall(r"(?m)^ *\[[^\]]+\]: *(\S+)", text)
    targets += re.findall(r"""(?:src|href)=["']([^"']+)""", text)
    return [target for target in targets if not re.match(r"https?://|mailto:|#", target)]


def _native_code(wheel: Path) -> bytes:
    """The native module in a wheel."""
    with zipfile.ZipFile(str(wheel)) as archive:
        pattern = r"/_native\.[\w.-]*(so|pyd)$"
        [native] = [name for name in archive.namelist() if re.search(pattern, name)]
        return archive.read(native)


def _audit(wheel: Path, tools: environment.Environment, log: Path | None) -> None:
    """Python's stable interface is kept to, and a Linux wheel needs no newer system than its name says."""
    if "-abi3-" in wheel.name:
        run([tools.python, "-m", "abi3audit", "--strict", "--summary", wheel], log=log)
    if "linux" in wheel.name:
        shown = run([tools.python, "-m", "auditwheel", "show", wheel], log=log)
        policy = re.search(r'consistent with\s+the\s+following\s+platform\s+tag:\s+"(\w+)"', shown)
        if policy is None or not is_promised(policy[1], wheel.name):
            found = policy[1] if policy else "no tag at all"
            raise Refused([f"{wheel.name} is consistent with {found}, as auditwheel says"])


def _problems_of_libraries(wheel: Path, tools: environment.Environment, log: Path | None) -> list[str]:
    """Why a wheel needs another system than its name says, on macOS and Windows."""
    if "-macosx_" in wheel.name:
        return libraries.problems_on_macos(_native_code(wheel), wheel.name)
    if "-win_" in wheel.name:
        return libraries.problems_on_windows(dlls(_native_code(wheel), tools, log), wheel.name)
    return []


def dlls(code: bytes, tools: environment.Environment, log: Path | None = None) -> list[str]:
    """The names of the libraries that a library for Windows loads."""
    places.WORK.mkdir(parents=True, exist_ok=True)
    library = places.WORK / "library.dll"
    library.write_bytes(code)
    return run([tools.python, ROOT / "scripts/lib/release/read_dll.py", library], log=log).split()


def is_promised(policy: str, name: str) -> bool:
    """Whether a policy, such as manylinux_2_17_x86_64, asks for no newer system than the name of a wheel."""
    pattern = r"(manylinux|musllinux)_(\d+)_(\d+)_(\w+)"
    found, named = re.fullmatch(pattern, policy), re.search(pattern, name)
    if found is None or named is None or (found[1], found[4]) != (named[1], named[4]):
        return False
    return (int(found[2]), int(found[3])) <= (int(named[2]), int(named[3]))


def problems_of_lists(wheel: Path, in_sbom: set[tuple[str, str]]) -> list[str]:
    """What of a wheel's two lists of crates is not what its platform's compiler compiles, a sentence each."""
    with zipfile.ZipFile(str(wheel)) as archive:
        info = f"authalic-{version()}.dist-info"
        text = archive.read(f"{info}/licenses/{notices.NAME}").decode()
    licensed = notices.listed(text)
    unnamed = notices.in_standard_library(_native_code(wheel)) - notices.of_standard_library(text)
    crates = notices.compiled([platforms.of_wheel(wheel).target])
    return [
        f"{what} of {wheel.name} {fault} {name} {number}"
        for what, found in ((notices.NAME, licensed), ("the SBOM", in_sbom))
        for fault, differing in (
            ("lacks", crates - found),
            ("has a crate that is not in it:", found - crates),
        )
        for name, number in sorted(differing)
    ] + [f"{notices.NAME} of {wheel.name} lacks {name} of the standard library" for name in sorted(unnamed)]


def _in_sbom(wheel: Path, tools: environment.Environment, log: Path | None) -> set[tuple[str, str]]:
    """The crates of others in a wheel's list of crates, which must be valid CycloneDX."""
    program = ROOT / "scripts/lib/release/read_sbom.py"
    rows = [line.split() for line in run([tools.python, program, wheel], log=log).splitlines()]
    return {(name, number) for name, number in rows if name != "authalic"}


def _problems_of_sdist(sdist: Path) -> list[str]:
    with tarfile.open(str(sdist)) as archive:
        names = {member.name.partition("/")[2] for member in archive if member.isfile()}
    wanted = (
        "Cargo.lock",
        "Cargo.toml",
        "pyproject.toml",
        "rust/python/README.md",
        "CHANGELOG.md",
        *_LICENSES,
    )
    strange = sorted(name for name in names if re.search(r"__pycache__|\.(so|pyd|pyc)$|(^|/)target/", name))
    return [
        *(f"{sdist.name} lacks {name}" for name in wanted if name not in names),
        *(f"{sdist.name} has {name}, which a build made" for name in strange),
    ]
