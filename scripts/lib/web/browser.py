# SPDX-License-Identifier: MIT OR Apache-2.0
"""A browser that tests drive: this machine's if it has chromedriver, else that of a Debian system."""

from __future__ import annotations

import contextlib
import shutil
import socket
import subprocess
import time
from pathlib import Path
from typing import Iterator

from shell import Unavailable
from web import system

_SECONDS = 60
# chromedriver asks for the browser on "localhost".
_HOSTS = Path("/etc/hosts")


@contextlib.contextmanager
def driver(log: Path) -> Iterator[str]:
    """Starts chromedriver; its address. It ends with the context, and its browsers with it."""
    port = _free_port()
    words = ["chromedriver", f"--port={port}"]
    command = words if shutil.which("chromedriver") else system.command(words, log, [_HOSTS])
    with open(str(log), "a", encoding="utf-8") as sink:
        process = subprocess.Popen(command, stdout=sink, stderr=subprocess.STDOUT)
    try:
        _wait_for(port, process)
        yield f"http://127.0.0.1:{port}"
    finally:
        process.kill()  # `unshare` ignores milder signals, and all within ends with it
        process.wait()


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def _wait_for(port: int, process: subprocess.Popen[bytes]) -> None:
    until = time.monotonic() + _SECONDS
    while time.monotonic() < until and process.poll() is None:
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1):
            return
        time.sleep(0.2)
    raise Unavailable("chromedriver did not start; its output is in out/web/site.log")
