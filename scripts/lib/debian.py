# SPDX-License-Identifier: MIT OR Apache-2.0
"""Debian systems of their own, with what this machine's lacks: a newer compiler, wine, Blender's window.

Each is a folder that is made on first use and kept in the user's cache. That needs root and Debian's package
tools.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
from pathlib import Path
from typing import Mapping, Sequence

from shell import CommandFailed, Unavailable, run, say, tail

CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "authalic"
_KEYRING = "/usr/share/keyrings/debian-archive-keyring.gpg"
_APT_OPTIONS = ('Apt::Install-Recommends "false"', 'Acquire::Check-Valid-Until "false"')
# What a system needs of this one to reach the network as it does.
_NETWORK = (Path("/etc/resolv.conf"), Path("/etc/ssl/certs/ca-certificates.crt"))
_VARIABLES = {"PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root"}


def system(name: str, suite: str, packages: Sequence[str], log: Path) -> Path:
    """The folder of a Debian system with packages, which is made on first use.

    `name` tells systems apart, and `suite` is the release of Debian, e.g. "sid". A system that lacks a
    package is made anew. Packages that others only recommend are left out. Raises Unavailable where there can
    be none.
    """
    folder = CACHE / f"chroot-{name}"
    if not hasattr(os, "geteuid") or os.geteuid() != 0:
        raise Unavailable("a Debian system of its own needs root")
    if not shutil.which("apt-get"):
        raise Unavailable("a Debian system of its own needs Debian's package tools, which are not here")
    CACHE.mkdir(parents=True, exist_ok=True)
    import fcntl  # Windows has none, and does not come here

    with open(str(CACHE / f"{folder.name}.lock"), "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not set(packages) <= installed(folder):
            _make(folder, suite, packages, log)
    return folder


def installed(root: Path) -> set[str]:
    """The names of the packages in a system; none where there is no system."""
    status = root / "var" / "lib" / "dpkg" / "status"
    text = status.read_text(encoding="utf-8") if status.exists() else ""
    return set(re.findall(r"(?m)^Package: (\S+)\nStatus: install ok installed$", text))


def command(
    root: Path,
    words: Sequence[object],
    bind: Sequence[Path] = (),
    variables: Mapping[str, str] | None = None,
    folder: Path = Path("/"),
) -> list[str]:
    """The command that runs a command in a system, for `shell.run`; more words may follow it.

    The files and folders to `bind` have the same place within the system and are shared with it; `folder` is
    where it runs. It sees this process's variables, and further ones, but the system's own PATH and HOME. All
    that it has started ends with it.
    """
    places = [*bind, *(place for place in _NETWORK if place.exists())]
    for place in places:
        _make_place(root, place)
    mounts = [f"mount -t proc proc {_quoted(root, 'proc')}", f"mount --rbind /dev {_quoted(root, 'dev')}"]
    mounts += [
        f"mount --bind {shlex.quote(str(place.resolve()))} {_quoted(root, str(place))}" for place in places
    ]
    assignments = [f"{name}={value}" for name, value in {**_VARIABLES, **(variables or {})}.items()]
    inner = ["chroot", root, "env", "-u", "TMPDIR", *assignments, "sh", "-c", 'cd "$0" && exec "$@"', folder]
    script = " && ".join([*mounts, f'{shlex.join(map(str, inner))} "$@"'])
    spaces = ["unshare", "--mount", "--pid", "--fork", "--kill-child"]
    return [*spaces, "sh", "-c", script, "sh", *map(str, words)]


def _quoted(root: Path, place: str) -> str:
    return shlex.quote(str(root / place.lstrip("/")))


def _make_place(root: Path, place: Path) -> None:
    """An empty file or folder within a system, over which another is mounted."""
    inside = root / str(place).lstrip("/")
    if inside.is_symlink():  # it would lead out of the system
        inside.unlink()
    inside.parent.mkdir(parents=True, exist_ok=True)
    if place.is_dir():
        inside.mkdir(exist_ok=True)
    else:
        inside.touch()


def _make(folder: Path, suite: str, packages: Sequence[str], log: Path) -> None:
    say(f"making a Debian system ({suite}) in {folder} ...")
    shutil.rmtree(str(folder), ignore_errors=True)
    new = folder.with_suffix(".new")
    shutil.rmtree(str(new), ignore_errors=True)
    try:
        if not shutil.which("mmdebstrap"):
            env = {"DEBIAN_FRONTEND": "noninteractive"}
            run(["apt-get", "update"], env, log)
            run(["apt-get", "-o", "DPkg::Lock::Timeout=300", "install", "-y", "-qq", "mmdebstrap"], env, log)
        options = [f"--aptopt={option}" for option in _APT_OPTIONS]
        words = ["mmdebstrap", "--variant=minbase", "--skip=check/empty", *options]
        words += [f"--include={','.join(packages)}", f"--keyring={_KEYRING}", suite, str(new)]
        run([*words, *_mirror()], None, log)
    except CommandFailed as failure:
        shutil.rmtree(str(new), ignore_errors=True)
        reason = tail(failure.output, 3)
        raise Unavailable(f"Debian {suite} could not be installed into {folder}:\n{reason}") from failure
    new.rename(folder)


def _mirror() -> list[str]:
    """Where this machine's own Debian has its packages from; empty on another system: the usual place."""
    listing = ["apt-get", "indextargets", "--format", "$(REPO_URI)", "Created-By: Packages"]
    return run([*listing, "Origin: Debian", "Label: Debian"]).split()[:1]
