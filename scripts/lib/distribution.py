# SPDX-License-Identifier: MIT OR Apache-2.0
"""Builds the wheel and the extension zip; installs the wheel. Nothing here starts Blender."""

from __future__ import annotations

import json
import os
import platform as this_machine
import re
import shutil
import sysconfig
import zipfile
from pathlib import Path

import changelog
import environment
import manual
from environment import Environment
from shell import DIST, OUT, ROOT, Unavailable, content_hash, files_below, run, say, version

THIRD_PARTY = "THIRD-PARTY-LICENSES.md"
"""The licenses of the crates that are compiled into the wheel."""
WHEEL_SOURCES = (
    *("Cargo.toml", "Cargo.lock", "pyproject.toml"),
    *(THIRD_PARTY, "rust/core", "rust/python"),
)
EXTENSION_SOURCES = ("addon", "docs/blender.md", "scripts/lib/manual.py")
PORTABLE = ("--zig", "--compatibility", "manylinux_2_28")
# Blender's names of platforms by what the tags of wheels begin and end with. Blender has no build for musl.
_PLATFORMS = {
    ("linux", "x86_64"): "linux-x64",
    ("linux", "aarch64"): "linux-arm64",
    ("manylinux", "x86_64"): "linux-x64",
    ("manylinux", "aarch64"): "linux-arm64",
    ("macosx", "x86_64"): "macos-x64",
    ("macosx", "arm64"): "macos-arm64",
    ("win", "amd64"): "windows-x64",
    ("win", "arm64"): "windows-arm64",
}


# zip files have local times.
_UTC = {"TZ": "UTC0"}


def platform() -> str:
    """Blender's name of this machine's platform, e.g. "linux-x64"."""
    tag = sysconfig.get_platform().replace("-", "_")
    # The Python of python.org runs on both processors of Macs, and names neither.
    tag = re.sub(r"universal2$", this_machine.machine(), tag)
    return _platform_of_tag(tag) or tag


def platform_of(wheel: Path) -> str | None:
    """Blender's name of the platform that a wheel is for, by its name; None if there is no Blender for it."""
    return _platform_of_tag(wheel.stem.split("-")[-1].split(".")[0])


def build_wheel(dev: Environment, portable: bool = False, log: Path | None = None) -> Path:
    """The release wheel in dist/, built only if a source has changed."""
    folder = DIST / "portable" if portable else DIST
    if portable:
        environment.add(dev, "portable")
    stamp = folder / "wheel.stamp"
    wanted = content_hash(files_below(*WHEEL_SOURCES), *(PORTABLE if portable else ()))
    wheel = _keep_newest_wheel(folder)
    if wheel is None or not stamp.exists() or stamp.read_text(encoding="utf-8") != wanted:
        _maturin(dev, folder, PORTABLE if portable else (), log)
        wheel = _keep_newest_wheel(folder)
        stamp.write_text(wanted)
    if wheel is None:
        raise Unavailable(f"maturin wrote no wheel into {folder}")
    return wheel


def build_zip(wheel: Path, blender: Environment, log: Path | None = None) -> Path:
    """The extension zip in dist/: the sources of addon/, a generated manifest, and the wheel.

    It is built anew only when a source has changed.
    """
    target = DIST / f"authalic-{version()}-{platform()}.zip"
    stamp = DIST / "extension.stamp"
    wanted = content_hash([*files_below(*EXTENSION_SOURCES), wheel])
    if not target.exists() or not stamp.exists() or stamp.read_text(encoding="utf-8") != wanted:
        stamp.unlink(missing_ok=True)
        for old in DIST.glob("authalic-*.zip"):
            old.unlink()
        pack_extension(target, wheel, blender, log)
        stamp.write_text(wanted)
    return target


def pack_extension(target: Path, wheel: Path, blender: Environment, log: Path | None = None) -> None:
    """Writes the extension zip for the platform of a wheel, validated by Blender's own tool.

    The same sources and the same wheel give the same bytes.
    """
    folder = OUT / "extension"
    _lay_out_extension(folder, wheel, ROOT, version())
    _add_documents(folder, wheel)
    _settle(folder)
    target.unlink(missing_ok=True)
    blender_ext(blender, "validate", folder, log=log)
    blender_ext(blender, "build", "--source-dir", folder, "--output-filepath", target, log=log)
    blender_ext(blender, "validate", target, log=log)


def blender_ext(blender: Environment, *words: object, log: Path | None = None) -> str:
    """Runs Blender's own tool for extensions, which needs no Blender."""
    return run([blender.python, tool_for_extensions(blender), *words], _UTC, log)


def tool_for_extensions(blender: Environment) -> Path:
    """The program that is Blender's own tool for extensions."""
    tools = sorted(blender.folder.rglob("bl_pkg/cli/blender_ext.py"))
    if not tools:
        raise Unavailable(f"the bpy package in {blender.folder} has no blender_ext.py")
    return tools[0]


def build_previous(source: Path, number: str, archive: Path, dev: Environment, blender: Environment) -> None:
    """The extension zip of an earlier version, from the folder of its sources."""
    python = [dev.python, "-m", "maturin", "build", "--release", "--locked", "--interpreter", dev.python]
    manifest = source / "rust" / "python" / "Cargo.toml"
    run([*python, "--manifest-path", manifest, "--out", source / "dist"], {"VIRTUAL_ENV": str(dev.folder)})
    (wheel,) = (source / "dist").glob("*.whl")
    folder = source / "extension"
    _lay_out_extension(folder, wheel, source, number)
    blender_ext(blender, "build", "--source-dir", folder, "--output-filepath", archive)


def install_wheel(wheel: Path, target: Environment, log: Path | None = None) -> None:
    """Installs the wheel into an environment unless it is installed there already."""
    stamp = target.folder / "authalic.stamp"
    wanted = content_hash([wheel])
    if not stamp.exists() or stamp.read_text(encoding="utf-8") != wanted:
        pip = [target.python, "-m", "pip", "--disable-pip-version-check"]
        run([*pip, "install", "--quiet", "--no-deps", "--force-reinstall", wheel], log=log)
        stamp.write_text(wanted)


def fresh_profile(archive: Path, profile: Path) -> dict[str, str]:
    """Empties a folder for Blender's profile; returns the variables that select it and name the zip.

    Blender itself installs the extension's zip into it. The package `authalic` that Blender then imports is
    that of the zip, because Blender's environments never have another.
    """
    shutil.rmtree(profile, ignore_errors=True)
    profile.mkdir(parents=True)
    return {"BLENDER_USER_RESOURCES": str(profile), "AUTHALIC_EXTENSION_ZIP": str(archive)}


def announce(path: Path) -> None:
    """One line about a file that was written."""
    say(f"{path.relative_to(ROOT).as_posix()}  ({path.stat().st_size / 1e6:.1f} MB)")


def _maturin(dev: Environment, folder: Path, options: tuple[str, ...], log: Path | None) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    command = [dev.python, "-m", "maturin", "build", "--release", "--locked", "--out", folder]
    # maturin finds zig through the `python3` that is first on PATH.
    path = os.pathsep.join([str(dev.python.parent), os.environ.get("PATH", "")])
    variables = {"VIRTUAL_ENV": str(dev.folder), "PATH": path}
    run([*command, "--interpreter", dev.python, *options], variables, log)


def _keep_newest_wheel(folder: Path) -> Path | None:
    wheels = sorted(folder.glob("authalic-*.whl"), key=lambda path: path.stat().st_mtime)
    for old in wheels[:-1]:
        old.unlink()
    return wheels[-1] if wheels else None


def _lay_out_extension(folder: Path, wheel: Path, root: Path, number: str) -> None:
    """The files of the extension's zip: those of addon/ below `root`, its manifest and the wheel."""
    shutil.rmtree(folder, ignore_errors=True)
    ignored = shutil.ignore_patterns("__pycache__", "*.in", "*.pyc")
    shutil.copytree(root / "addon", folder, ignore=ignored)
    (folder / "wheels").mkdir()
    shutil.copy(wheel, folder / "wheels")
    template = (root / "addon" / "blender_manifest.toml.in").read_text(encoding="utf-8")
    platforms = json.dumps([platform_of(wheel) or platform()])
    manifest = template.replace("@VERSION@", number).replace("@PLATFORMS@", platforms)
    manifest = manifest.replace("@WHEELS@", json.dumps([f"./wheels/{wheel.name}"]))
    (folder / "blender_manifest.toml").write_text(manifest, encoding="utf-8")


def _add_documents(folder: Path, wheel: Path) -> None:
    """The manual, and the licenses of what the wheel is made of, which it has itself."""
    with zipfile.ZipFile(wheel) as archive:
        [licenses] = [name for name in archive.namelist() if name.endswith(f"/licenses/{THIRD_PARTY}")]
        (folder / THIRD_PARTY).write_bytes(archive.read(licenses))
    text = (ROOT / "docs" / "blender.md").read_text(encoding="utf-8")
    (folder / "manual.html").write_text(manual.to_html(text), encoding="utf-8")


def _settle(folder: Path) -> None:
    """Gives all files the time and the permissions that they shall have in an archive."""
    seconds = int(changelog.source_date_epoch())
    for path in folder.rglob("*"):
        path.chmod(0o755 if path.is_dir() else 0o644)
        os.utime(path, (seconds, seconds))


def _platform_of_tag(tag: str) -> str | None:
    for (system, machine), name in _PLATFORMS.items():
        if re.fullmatch(rf"{system}(?:\d+)?(?:_.+)?_{machine}", tag):
            return name
    return None
