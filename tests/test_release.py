# SPDX-License-Identifier: MIT OR Apache-2.0
"""What decides whether a release is made, and the workflows that make it."""

import hashlib
import json
import os
import platform
import re
import struct
import tomllib
import zipfile
from pathlib import Path

import pytest
import yaml

import changelog
import distribution
import pythons
import shell
from environment import Environment
from release import (
    agreement,
    extensions,
    inspection,
    libraries,
    notices,
    own_crates,
    places,
    platforms,
)
from release.main import STEPS, _verdict
from shell import ROOT, Unavailable

WORKFLOWS = {
    path.stem: yaml.safe_load(path.read_text("utf-8")) for path in ROOT.glob(".github/workflows/*.yml")
}
JOBS = {f"{flow}/{name}": job for flow, text in WORKFLOWS.items() for name, job in text["jobs"].items()}
SHA = r"[0-9a-f]{40}"


@pytest.fixture
def project(monkeypatch, tmp_path):
    """A project of version 1.2.3 whose files agree."""
    for module in (shell, agreement, changelog):
        monkeypatch.setattr(module, "ROOT", tmp_path)
    lock = "".join(f'name = "{name}"\nversion = "1.2.3"\n' for name in ("authalic", "authalic-python"))
    (tmp_path / "Cargo.toml").write_text('[workspace.package]\nversion = "1.2.3"\n')
    (tmp_path / "Cargo.lock").write_text(f'{lock}name = "other"\nversion = "9.9.9"\n')
    (tmp_path / "CITATION.cff").write_text("cff-version: 1.2.0\nversion: 1.2.3\n")
    (tmp_path / "CHANGELOG.md").write_text(
        "# Changelog\n\n## 1.2.3 (2001-09-09)\n\n- New.\n\n## 1.2.2 (2000-01-01)\n\n- Old.\n"
    )
    return tmp_path


def replace(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new))


def test_this_project_agrees_with_itself():
    assert agreement.disagreements() == []


def test_a_tag_of_the_version_with_a_dated_entry_is_released(project):
    assert agreement.disagreements("v1.2.3") == []


@pytest.mark.parametrize(
    ("file", "old", "new", "sentence"),
    [
        ("Cargo.toml", "1.2.3", "1.2.4", "the tag must be v1.2.4"),
        ("Cargo.toml", "1.2.3", "1.2.3-rc1", "not of the form"),
        ("Cargo.lock", '-python"\nversion = "1.2.3', '-python"\nversion = "1.2.2', "Cargo.lock has"),
        ("CITATION.cff", "version: 1.2.3", "version: 1.2.2", "CITATION.cff has the version 1.2.2"),
        ("CHANGELOG.md", "## 1.2.3", "## 1.2.4", "the first section of CHANGELOG.md is 1.2.4"),
        ("CHANGELOG.md", "2001-09-09", "unreleased", "says `unreleased`"),
        ("CHANGELOG.md", "2001-09-09", "2001-09-31", "says `2001-09-31`"),
        ("CHANGELOG.md", "- New.", "", "is empty"),
    ],
)  # fmt: skip
def test_a_place_that_disagrees_is_named(project, file, old, new, sentence):
    replace(project / file, old, new)
    assert sentence in "; ".join(agreement.disagreements("v1.2.3"))


def test_another_tag_is_refused(project):
    assert "the tag must be v1.2.3" in agreement.disagreements("1.2.3")[0]
    assert len(agreement.disagreements("v1.2.2")) == 1


def test_a_rehearsal_may_be_unreleased_but_not_undated(project):
    replace(project / "CHANGELOG.md", "2001-09-09", "unreleased")
    assert agreement.disagreements() == []
    replace(project / "CHANGELOG.md", "unreleased", "soon")
    assert len(agreement.disagreements()) == 1


def test_the_notes_are_the_section_of_the_version(project):
    assert [(entry.version, entry.text) for entry in changelog.entries()] == [
        ("1.2.3", "- New."),
        ("1.2.2", "- Old."),
    ]
    assert changelog.entry().text == "- New."
    replace(project / "Cargo.toml", "1.2.3", "1.2.4")
    with pytest.raises(Unavailable, match=r"no section `## 1\.2\.4"):
        changelog.entry()


def test_all_that_is_built_bears_the_day_of_the_release(project):
    assert changelog.source_date_epoch() == str(1_000_000_000 - 1_000_000_000 % 86400)
    replace(project / "CHANGELOG.md", "2001-09-09", "unreleased")
    assert int(changelog.source_date_epoch()) > 315_532_800  # zip files begin in 1980


@pytest.mark.parametrize(
    ("outcomes", "alone", "rehearsed"),
    [
        (("ok",), 0, 0),
        (("not done",), 1, 0),
        (("FAILED",), 1, 1),
        (("ok", "not done"), 1, 0),
        (("not done", "FAILED"), 1, 1),
        (("FAILED", "ok"), 1, 1),
    ],
)
def test_what_was_not_done_fails_but_in_a_rehearsal(outcomes, alone, rehearsed):
    named = dict(zip(("sdist", "wheel"), outcomes, strict=False))
    assert (_verdict(named, False), _verdict(named, True)) == (alone, rehearsed)


@pytest.mark.parametrize(
    ("policy", "tag", "is_kept"),
    [
        ("manylinux_2_28_x86_64", "manylinux_2_28_x86_64", True),
        ("manylinux_2_5_x86_64", "manylinux_2_28_x86_64", True),
        ("manylinux_2_34_x86_64", "manylinux_2_28_x86_64", False),
        ("manylinux_2_17_aarch64", "manylinux_2_17_aarch64.manylinux2014_aarch64", True),
        ("manylinux_2_28_aarch64", "manylinux_2_28_x86_64", False),
        ("musllinux_1_1_x86_64", "musllinux_1_2_x86_64", True),
        ("manylinux_1_1_x86_64", "musllinux_1_2_x86_64", False),
        ("linux_x86_64", "manylinux_2_28_x86_64", False),
    ],
)
def test_a_wheel_needs_no_newer_system_than_its_name_says(policy, tag, is_kept):
    assert inspection.is_promised(policy, f"authalic-1.2.3-cp311-abi3-{tag}.whl") == is_kept


def mach_o(*commands: tuple[int, bytes]) -> bytes:
    """A made-up library of macOS with load commands: what each is, and what follows its size."""
    parts = [struct.pack("<2I", kind, 8 + len(rest)) + rest for kind, rest in commands]
    size = sum(map(len, parts))
    return struct.pack("<8I", 0xFEEDFACF, 0x0100000C, 0, 6, len(parts), size, 0, 0) + b"".join(parts)


def build_version(major: int, minor: int, sdk: int = 26) -> tuple[int, bytes]:
    """LC_BUILD_VERSION: platform, oldest macOS, SDK, no tools."""
    return 0x32, struct.pack("<4I", 1, major << 16 | minor << 8, sdk << 16, 0)


def loads(path: bytes) -> tuple[int, bytes]:
    """LC_LOAD_DYLIB: where the path begins, a time, two versions, the path."""
    return 0xC, struct.pack("<4I", 24, 0, 0, 0) + path.ljust(len(path) // 8 * 8 + 8, b"\0")


@pytest.mark.parametrize(
    ("commands", "problem"),
    [
        ([build_version(11, 0)], None),
        ([(0x19, bytes(64)), build_version(10, 12)], None),
        ([(0x24, struct.pack("<2I", 11 << 16, 15 << 16))], None),
        ([build_version(11, 0), loads(b"/usr/lib/libSystem.B.dylib")], None),
        ([build_version(11, 1)], "needs macOS 11.1"),
        ([build_version(15, 0, sdk=15)], "needs macOS 15.0"),
        ([(0x24, struct.pack("<2I", 12 << 16, 15 << 16))], "needs macOS 12.0"),
        ([(0x19, bytes(64))], "does not say which macOS"),
        (
            [build_version(11, 0), loads(b"/opt/homebrew/lib/libgomp.1.dylib")],
            "loads /opt/homebrew/lib/libgomp",
        ),
    ],
)
def test_a_wheel_for_macos_needs_what_its_name_says(commands, problem):
    name = "authalic-1.2.3-cp311-abi3-macosx_11_0_arm64.whl"
    problems = libraries.problems_on_macos(mach_o(*commands), name)
    assert (problems == []) if problem is None else (len(problems) == 1 and problem in problems[0])


def test_what_is_no_library_of_macos_is_none():
    for code in (b"", b"\x7fELF".ljust(64), mach_o()[:30]):
        [problem] = libraries.problems_on_macos(code, "authalic-1.2.3-cp311-abi3-macosx_11_0_arm64.whl")
        assert "does not say which macOS" in problem


def test_a_wheel_for_windows_loads_what_everybody_has():
    good = ["KERNEL32.dll", "ntdll.dll", "VCRUNTIME140.dll", "api-ms-win-crt-math-l1-1-0.dll"]
    stable, free = "authalic-1.2.3-cp311-abi3-win_amd64.whl", "authalic-1.2.3-cp314-cp314t-win_amd64.whl"
    assert libraries.problems_on_windows([*good, "python3.dll"], stable) == []
    assert libraries.problems_on_windows([*good, "python314t.dll"], free) == []
    for name, library in (
        *((stable, "python311.dll"), (stable, "libgcc_s_seh-1.dll"), (stable, "VCOMP140.DLL")),
        *((free, "python3.dll"), (free, "python314.dll"), (free, "msvcp140.dll")),
    ):
        [problem] = libraries.problems_on_windows([*good, library], name)
        assert problem == f"{name} loads {library}"


@pytest.mark.skipif(
    not any(shell.VENVS.glob("release/lib/*/site-packages/pefile.py")), reason="pefile is in .venv/release"
)
def test_libraries_of_windows_are_read(monkeypatch, tmp_path):
    """pip's launchers for scripts on Windows are programs whose libraries are known."""
    monkeypatch.setattr(places, "WORK", tmp_path)
    tools = Environment("release", shell.VENVS / "release", "release")
    [launcher] = tools.folder.glob("lib/*/site-packages/pip/_vendor/distlib/t64.exe")
    assert inspection.dlls(launcher.read_bytes(), tools) == ["KERNEL32.dll", "SHLWAPI.dll"]


@pytest.mark.parametrize(
    ("tag", "name"),
    [
        ("cp311-abi3-manylinux_2_28_x86_64", "linux-x64"),
        ("cp311-abi3-manylinux_2_17_aarch64.manylinux2014_aarch64", "linux-arm64"),
        ("cp311-abi3-manylinux2014_x86_64", "linux-x64"),
        ("cp311-abi3-linux_x86_64", "linux-x64"),
        ("cp311-abi3-macosx_11_0_arm64", "macos-arm64"),
        ("cp311-abi3-macosx_11_0_x86_64", "macos-x64"),
        ("cp311-abi3-win_amd64", "windows-x64"),
        ("cp311-abi3-win_arm64", "windows-arm64"),
        ("cp311-abi3-musllinux_1_2_x86_64", None),
        ("cp311-abi3-win32", None),
    ],
)
def test_wheels_are_for_platforms_of_blender(tag, name):
    assert distribution.platform_of(Path(f"authalic-1.2.3-{tag}.whl")) == name


@pytest.mark.parametrize(
    ("found", "machine", "name"),
    [
        ("linux-x86_64", "x86_64", "linux-x64"),
        ("linux-aarch64", "aarch64", "linux-arm64"),
        ("macosx-10.13-universal2", "arm64", "macos-arm64"),
        ("macosx-10.13-universal2", "x86_64", "macos-x64"),
        ("macosx-14.0-arm64", "arm64", "macos-arm64"),
        ("win-amd64", "AMD64", "windows-x64"),
        ("win-arm64", "ARM64", "windows-arm64"),
    ],
)
def test_every_machine_that_has_wheels_has_a_platform(monkeypatch, found, machine, name):
    monkeypatch.setattr(distribution.sysconfig, "get_platform", lambda: found)
    monkeypatch.setattr(distribution.this_machine, "machine", lambda: machine)
    assert distribution.platform() == name


def test_this_machine_has_a_platform():
    assert distribution.platform() in platforms.PLATFORMS
    with pytest.raises(Unavailable, match="no wheels for solaris"):
        platforms.named("solaris")


@pytest.mark.skipif(os.name == "nt", reason="a script is no program there")
def test_a_python_without_a_global_lock_is_another_version(monkeypatch, tmp_path):
    python = tmp_path / "python3.99t"
    python.write_text("#!/bin/sh\necho 3.99t\n")
    python.chmod(0o755)
    monkeypatch.setattr(pythons, "_USUAL_FOLDERS", (str(tmp_path),))
    assert pythons.find("3.99t") == (python, "3.99t")
    assert not pythons.works(python, "3.99")


@pytest.fixture
def built(monkeypatch, tmp_path):
    """A folder of a release with a wheel and its zip, both complete."""
    monkeypatch.setattr(places, "FILES", tmp_path)
    monkeypatch.setattr(places, "REPOSITORY", tmp_path / "extensions")
    wheel = tmp_path / f"authalic-{shell.version()}-cp311-abi3-manylinux_2_28_x86_64.whl"
    info = f"authalic-{shell.version()}.dist-info"
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr("authalic/_native.abi3.so", b"\x7fELF panicked at /authalic/rust/core/src/lib.rs:1")
        archive.writestr("authalic/py.typed", "")
        archive.writestr(f"{info}/METADATA", "Name: authalic\n\n[anywhere](https://example.org)\n")
        archive.writestr(f"{info}/sboms/authalic-python.cyclonedx.json", "{}")
        for name in ("LICENSE-MIT", "LICENSE-APACHE", notices.NAME):
            archive.writestr(f"{info}/licenses/{name}", name)
    places.REPOSITORY.mkdir()
    zipped = places.REPOSITORY / f"authalic-{shell.version()}-linux-x64.zip"
    with zipfile.ZipFile(zipped, "w") as archive:
        archive.write(wheel, f"wheels/{wheel.name}")
        for name in ("__init__.py", "LICENSE", "blender_manifest.toml", "manual.html", notices.NAME):
            archive.writestr(name, name)
    return wheel, zipped


def rewritten(path: Path, without: str = "", **added: bytes) -> Path:
    """The archive without the files of some name, and with further ones (`__` stands for a slash)."""
    with zipfile.ZipFile(path) as archive:
        files = {
            name: archive.read(name) for name in archive.namelist() if not without or without not in name
        }
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in {**files, **{key.replace("__", "/"): data for key, data in added.items()}}.items():
            archive.writestr(name, data)
    return path


def test_complete_wheels_and_zips_have_no_problems(built):
    wheel, zipped = built
    assert inspection.problems_of_wheel(wheel) == [] and extensions.problems_of_zip(zipped) == []


@pytest.mark.parametrize("name", ["LICENSE-MIT", notices.NAME, "py.typed", "sboms", "METADATA"])
def test_a_wheel_must_have_its_licenses_its_types_and_its_crates(built, name):
    [problem] = inspection.problems_of_wheel(rewritten(built[0], without=name))
    assert name in problem or "SBOM" in problem


@pytest.mark.parametrize(
    "path", [b"/home/runner/work/a.rs", b"/root/.cargo/registry/x", b"C:\\Users\\runner\\a.rs"]
)
def test_a_wheel_must_name_no_folder_of_the_machine_that_built_it(built, path):
    wheel = rewritten(built[0], without="_native", **{"authalic___native.abi3.so": b"panicked at " + path})
    [problem] = inspection.problems_of_wheel(wheel)
    assert path.decode() in problem


@pytest.mark.parametrize(
    "text",
    [
        "[the manual](docs/blender.md)",
        "![a badge](badge.svg)",
        '<img src="docs/a.jpg">',
        "[home]: ../README.md",
    ],
)
def test_a_description_must_lead_to_no_file_beside_it(built, text):
    metadata = f"authalic-{shell.version()}.dist-info/METADATA"
    wheel = rewritten(built[0], without="METADATA", **{metadata.replace("/", "__"): text.encode()})
    [problem] = inspection.problems_of_wheel(wheel)
    assert "the description of" in problem


def test_what_registries_show_leads_to_no_file_beside_it():
    package = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["readme"]
    for readme in (ROOT / package, ROOT / "rust" / "core" / "README.md"):
        assert inspection.relative_targets(readme.read_text(encoding="utf-8")) == []
    assert inspection.relative_targets((ROOT / "README.md").read_text(encoding="utf-8"))


def test_a_wheel_must_hold_nothing_under_another_license(built):
    code = b"\0Premature end of regular expression\0"
    wheel = rewritten(built[0], without="_native", **{"authalic___native.abi3.so": code})
    [problem] = inspection.problems_of_wheel(wheel)
    assert "LGPL" in problem


def test_what_is_too_large_is_refused(built, monkeypatch):
    monkeypatch.setattr(extensions, "LIMIT", 10)
    assert "more than 10" in extensions.problems_of_zip(built[1])[0]


def test_a_zip_must_hold_the_wheel_of_the_release(built):
    wheel, zipped = built
    [problem] = extensions.problems_of_zip(rewritten(zipped, without="LICENSE", LICENSE=b""))
    assert notices.NAME in problem
    rewritten(wheel, another=b"")
    assert "has other files than" in "; ".join(extensions.problems_of_zip(zipped))
    [problem] = [
        p for p in extensions.problems_of_zip(rewritten(zipped, without="wheels")) if "one wheel" in p
    ]
    assert "must have one wheel" in problem


def index_of(zipped: Path) -> dict:
    data = zipped.read_bytes()
    row = {
        "id": "authalic",
        "version": shell.version(),
        "archive_url": f"./{zipped.name}",
        "archive_size": len(data),
        "archive_hash": f"sha256:{hashlib.sha256(data).hexdigest()}",
        "platforms": ["linux-x64"],
    }
    return {"version": "v1", "blocklist": [], "data": [row]}


def test_the_index_agrees_with_the_zips_beside_it(built):
    path = built[1].parent / "index.json"
    index = index_of(built[1])
    path.write_text(json.dumps(index))
    assert extensions.problems_of_index(path) == []
    for key, value in {"archive_size": 7, "archive_hash": "sha256:0", "platforms": ["windows-x64"]}.items():
        path.write_text(json.dumps({**index, "data": [{**index["data"][0], key: value}]}))
        [problem] = extensions.problems_of_index(path)
        assert key in problem
    path.write_text(json.dumps({**index, "data": []}))
    assert extensions.problems_of_index(path) == [f"the index lacks {built[1].name}"]


@pytest.mark.skipif(
    not any(shell.VENVS.glob("bpy-5/lib")), reason="Blender's tool for extensions is in .venv/bpy-5"
)
def test_each_platform_has_a_zip_that_blender_finds_in_the_index(built, monkeypatch, tmp_path):
    """Wheels of some platforms, with this one, and one without Blender; Blender's tool installs its own."""
    monkeypatch.setattr(places, "WORK", tmp_path / "work")
    monkeypatch.setattr(distribution, "OUT", tmp_path / "out")
    monkeypatch.setattr(extensions, "recompressed", lambda archive, *_: archive)
    wheel, _ = built
    tags = {
        **{"linux-arm64": "manylinux_2_28_aarch64", "linux-x64": "manylinux_2_28_x86_64"},
        **{"macos-arm64": "macosx_11_0_arm64", "macos-x64": "macosx_11_0_x86_64"},
        **{"windows-arm64": "win_arm64", "windows-x64": "win_amd64"},
    }
    assert {*tags, "musl-x64"} == platforms.PLATFORMS.keys()
    packed = sorted({"linux-x64", "macos-arm64", "windows-arm64", distribution.platform()})
    for tag in (*(tags[name] for name in packed), "musllinux_1_2_x86_64"):
        wheel.with_name(wheel.name.replace("manylinux_2_28_x86_64", tag)).write_bytes(wheel.read_bytes())
    wheel.with_name(wheel.name.replace("cp311-abi3", "cp314-cp314t")).write_bytes(b"")
    names = [f"authalic-{shell.version()}-{name}.zip" for name in packed]
    assert [path.name for path in extensions.pack()] == names
    extensions.pack_again()
    rows = json.loads(extensions.index().read_text(encoding="utf-8"))["data"]
    assert sorted(row["platforms"] for row in rows) == [[name] for name in packed]


def test_the_licenses_are_those_of_the_crates_that_are_compiled():
    compiled, listed = notices.compiled(), notices.listed()
    assert ("faer", "0.24.4") in compiled and len(compiled) > 60
    assert not compiled - listed, f"run `scripts/release licenses --write`: {compiled - listed}"
    # cargo-about unites the features of all platforms, and so may list more.
    lock = re.findall(
        r'(?m)^name = "(.+)"\nversion = "(.+)"$', (ROOT / "Cargo.lock").read_text(encoding="utf-8")
    )
    assert listed <= set(lock), f"run `scripts/release licenses --write`: {listed - set(lock)}"
    assert "Regents of the University of Minnesota" in (ROOT / notices.NAME).read_text(encoding="utf-8")


@pytest.mark.skipif(platform.system() != "Linux", reason="elsewhere the standard library has other crates")
def test_the_licenses_of_the_standard_library_are_those_of_its_crates():
    """Its crates are files beside the compiler, except for what tests, tools and `panic=abort` need."""
    folder = Path(shell.run(["rustc", "--print", "target-libdir"]).strip())
    files = {re.sub(r"^lib|-[0-9a-f]+\.rlib$", "", path.name) for path in folder.glob("*.rlib")}
    unused = {"getopts", "panic_abort", "proc_macro", "profiler_builtins", "rustc_literal_escaper", "sysroot"}
    linked = {name for name in files - unused - {"test"} if not name.startswith("rustc_std_workspace")}
    assert {"std", "core", "gimli"} <= linked == notices.of_standard_library()


def test_every_wheel_has_the_licenses_of_the_standard_library(built):
    whole = (ROOT / notices.NAME).read_text(encoding="utf-8")
    narrow = notices.of([("faer", "0.24.4")], whole)
    assert notices.of_standard_library(narrow) == notices.of_standard_library(whole) > {"miniz_oxide"}
    assert "- rayon " not in narrow and "UNICODE LICENSE V3" in narrow and narrow.count("```") % 2 == 0
    template = (ROOT / "scripts" / "licenses.hbs").read_text(encoding="utf-8")
    assert whole.partition(notices._STANDARD)[2] == template.partition(notices._STANDARD)[2] != ""
    own, info = notices.compiled([platforms.PLATFORMS["linux-x64"].target]), f"authalic-{shell.version()}"
    licenses = {f"{info}.dist-info__licenses__{notices.NAME}": notices.of(own, whole).encode()}
    code = b"\x7fELF panicked at /rust/deps/rustc-demangle-0.1.27/src/v0.rs, /rust/deps/new_one-1.0/a.rs"
    wheel = rewritten(built[0], without=notices.NAME, **licenses)
    rewritten(wheel, without="_native", **{"authalic___native.abi3.so": code})
    assert inspection.problems_of_lists(wheel, own) == [
        f"{notices.NAME} of {wheel.name} lacks new_one of the standard library"
    ]


def test_the_licenses_are_gathered_for_all_platforms_that_have_wheels():
    text = notices.CONFIGURATION.read_text(encoding="utf-8")
    gathered = re.findall(r'"(.+)"', text.partition("targets = [")[2].partition("]")[0])
    assert set(gathered) == {platform.target for platform in platforms.PLATFORMS.values()}


def test_our_own_crate_is_not_among_third_parties():
    ours = "\n## MIT License\n\n- authalic 0.2.0\n\n```text\n\nOurs  \n\n```\n"
    theirs = "\n## MIT License\n\n- authalic 0.2.0\n- rayon 1.0.0\n\n```text\nTheirs\n```\n"
    assert notices._tidy(f"# Licenses\n{ours}{theirs}{ours}") == (
        "# Licenses\n\n## MIT License\n\n- rayon 1.0.0\n\n```text\nTheirs\n```\n"
    )


def components(*crates: str) -> dict:
    """An SBOM of crates in a row, each of which needs the next, as "name 1.0"."""
    parts = [{"bom-ref": each, "name": each.split()[0], "version": each.split()[1]} for each in crates]
    needs = [
        {"ref": each, "dependsOn": [*crates[place + 1 : place + 2]]} for place, each in enumerate(crates)
    ]
    first, *others = parts
    return {"bomFormat": "CycloneDX", "metadata": {"component": first}, "components": others} | {
        "dependencies": needs
    }


@pytest.mark.parametrize(
    ("tag", "has", "lacks"),
    [
        ("manylinux_2_28_x86_64", {"metis-sys", "private-gemm-x86"}, {"windows-sys", "sysctl"}),
        ("manylinux_2_28_aarch64", {"metis-sys"}, {"windows-sys", "private-gemm-x86", "sysctl"}),
        ("musllinux_1_2_x86_64", {"metis-sys"}, {"windows-sys"}),
        ("macosx_11_0_arm64", {"metis-sys", "sysctl"}, {"windows-sys", "private-gemm-x86"}),
        ("win_amd64", {"windows-sys", "windows_x86_64_msvc"}, {"metis-sys", "metis", "windows_aarch64_msvc"}),
        ("win_arm64", {"windows-sys", "windows_aarch64_msvc"}, {"metis-sys", "metis", "private-gemm-x86"}),
    ],
)
def test_a_wheel_lists_the_crates_of_its_own_platform(built, tmp_path, tag, has, lacks):
    wheel = built[0].with_name(built[0].name.replace("manylinux_2_28_x86_64", tag))
    info = f"authalic-{shell.version()}.dist-info"
    everything = (ROOT / notices.NAME).read_text(encoding="utf-8")
    crates = [f"{name} {number}" for name, number in sorted(notices.compiled())]
    bill = components("authalic-python 0.0.0", "authalic 0.0.0", *crates, "cc 1.0.0")
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr("authalic/py.typed", "")
        archive.writestr("authalic/_native.abi3.so", "")
        archive.writestr(f"{info}/licenses/{notices.NAME}", everything)
        archive.writestr(f"{info}/sboms/authalic-python.cyclonedx.json", json.dumps(bill))
        archive.writestr(f"{info}/RECORD", "")
    own = notices.compiled([platforms.of_wheel(wheel).target])
    narrow = own_crates.narrow(wheel, own, tmp_path / "narrow.whl").rename(wheel)
    with zipfile.ZipFile(narrow) as archive:
        text = archive.read(f"{info}/licenses/{notices.NAME}").decode()
        bill = json.loads(archive.read(f"{info}/sboms/authalic-python.cyclonedx.json"))
        record = archive.read(f"{info}/RECORD").decode()
        assert record.splitlines()[-1] == f"{info}/RECORD,," and len(record.splitlines()) == 5
    names = {name for name, _ in notices.listed(text)}
    assert has <= names and not lacks & names
    assert text.count("```") % 2 == 0 and ("METIS" in text or "Regents" in text) == ("metis-sys" in has)
    found = {(each["name"], each["version"]) for each in bill["components"]} - {("authalic", "0.0.0")}
    assert found == notices.listed(text) == own and inspection.problems_of_lists(narrow, found) == []
    refs = {each["bom-ref"] for each in bill["components"]} | {"authalic-python 0.0.0"}
    assert {row["ref"] for row in bill["dependencies"]} == refs
    assert all(set(row["dependsOn"]) <= refs for row in bill["dependencies"])
    faer = {crate for crate in own if crate[0] == "faer"}
    [lacking, strange] = inspection.problems_of_lists(narrow, found - faer | {("cc", "1.0.0")})
    assert "the SBOM" in lacking and "lacks faer" in lacking and "cc 1.0.0" in strange


@pytest.mark.parametrize("job", JOBS)
def test_actions_are_pinned_by_commit(job):
    for step in steps_of(job):
        if "uses" in step:
            assert re.fullmatch(rf"[\w-]+/[\w-]+@{SHA}", step["uses"])


def steps_of(job: str) -> list[dict]:
    """The steps of a job; a job that calls another workflow has none."""
    return JOBS[job].get("steps", [])


def test_an_action_has_one_commit_and_one_version_everywhere():
    lines = {
        line
        for path in ROOT.glob(".github/workflows/*.yml")
        for line in re.findall(r"uses: (?!\$/)(.+)", path.read_text("utf-8"))
    }
    names = [line.split("@")[0] for line in lines]
    assert len(names) == len(set(names)) and all(re.search(r"# v\d+\.\d+\.\d+$", line) for line in lines)


@pytest.mark.parametrize("job", JOBS)
def test_jobs_run_commands_of_the_project(job):
    steps, has_cargo = {step.name for step in STEPS} | {"notes"}, False
    for command in [step["run"] for step in steps_of(job) if "run" in step]:
        has_cargo |= command.startswith("rustup toolchain install")
        assert has_cargo or not re.match("cargo |rustup target", command), command
        for script, word in re.findall(r"(scripts/[\w/.]+)(?: ([\w-]+))?", command):
            assert (ROOT / script).is_file()
            assert script != "scripts/release" or word in steps or word == "--dry-run", command
            is_without = script == "scripts/lib/system_libraries.py" or word in WITHOUT_CARGO
            assert has_cargo or is_without, f"{command} needs cargo: install Rust in this job"


WITHOUT_CARGO = {"agree", "notes", "try", "zips", "index"}
"""The steps of scripts/release that call no cargo."""


def test_every_platform_has_its_wheel():
    rows = WORKFLOWS["release"]["jobs"]["wheels"]["strategy"]["matrix"]["include"]
    assert [row["platform"] for row in rows] == list(platforms.PLATFORMS)
    rows = WORKFLOWS["release"]["jobs"]["free-threaded"]["strategy"]["matrix"]["include"]
    without = {"musl-x64", "windows-arm64"}  # docs/releasing.md says why
    assert {row["platform"] for row in rows} == platforms.PLATFORMS.keys() - without


def needed(jobs: dict, name: str) -> set[str]:
    """The jobs that must have succeeded before a job begins."""
    needs = jobs[name].get("needs", [])
    direct = {needs} if isinstance(needs, str) else set(needs)
    return direct.union(*(needed(jobs, other) for other in direct))


def test_only_a_tag_that_agrees_is_published():
    jobs = WORKFLOWS["release"]["jobs"]
    writing = {name for name, job in jobs.items() if "write" in job["permissions"].values()}
    assert {name for name in jobs if name.startswith("publish")} | {"attest"} == writing
    for name in writing:
        assert jobs[name]["if"] == "github.ref_type == 'tag'"
        assert {"agree", "extensions"} <= needed(jobs, name)
    assert {"agree", "checks", "crates", "wheels", "free-threaded"} <= needed(jobs, "publish-package")
    assert jobs["checks"]["uses"] == "$/.github/workflows/checks.yml"
    assert {"pull_request", "workflow_call"} <= WORKFLOWS["checks"][True].keys()  # YAML reads "on" as true
    commands = [
        step.get("run") for step in jobs["agree"]["steps"] if step.get("if") == "github.ref_type == 'tag'"
    ]
    assert commands == ['python scripts/release agree --tag "$GITHUB_REF_NAME"']


def test_checks_and_releases_have_one_compiler():
    assert len({flow["env"]["RUSTUP_TOOLCHAIN"] for flow in WORKFLOWS.values()}) == 1


def test_other_workflows_write_nothing():
    for name, workflow in WORKFLOWS.items():
        assert workflow["permissions"] == {}
        if name != "release":
            for job in workflow["jobs"].values():
                assert job["permissions"] == {"contents": "read"}
