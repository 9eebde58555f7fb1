# SPDX-License-Identifier: MIT OR Apache-2.0
"""A run of libFuzzer, which both the crate's targets and atheris consist of."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Mapping, Sequence

from fuzz.report import Finding, Line, problem_in, runs_and_coverage
from shell import CommandFailed, run

_LONGEST_INPUT = 400  # bytes: a few dozen vertices, so that a run takes milliseconds
_SECONDS_FOR_ONE = 60
_MEGABYTES = 4000
_MOST_FINDINGS = 10


def run_for(
    name: str,
    command: Sequence[object],
    variables: Mapping[str, str],
    places: tuple[Path, Path],
    seconds: float,
) -> tuple[Line, list[Finding]]:
    """Searches for some time, from the inputs in the first place and those that the second one keeps.

    A target that has failed starts again, since libFuzzer ends with the first failure.
    """
    seeds, folder = places
    corpus, kept = folder / f"{name}.corpus", folder / f"{name}.findings"
    corpus.mkdir(exist_ok=True)
    kept.mkdir(exist_ok=True)
    began, runs, coverage = time.monotonic(), 0, 0
    findings: list[Finding] = []
    while time.monotonic() - began < seconds and len(findings) < _MOST_FINDINGS:
        left = max(1, int(seconds - (time.monotonic() - began)))
        options = [
            *(f"-max_total_time={left}", f"-timeout={_SECONDS_FOR_ONE}", f"-rss_limit_mb={_MEGABYTES}"),
            *(f"-max_len={_LONGEST_INPUT}", "-len_control=0", f"-artifact_prefix={kept}/"),
        ]
        before = set(kept.iterdir())
        log = folder / f"{name}.log"
        log.write_text("", encoding="utf-8")
        try:
            run([*command, *options, corpus, *([seeds] if seeds.exists() else [])], variables, log)
        except CommandFailed as failure:
            file = next(iter(set(kept.iterdir()) - before), kept)
            findings.append(Finding(name, file, problem_in(failure.output)))
        done, reached = runs_and_coverage(log.read_text(encoding="utf-8"))
        runs, coverage = runs + done, max(coverage, reached)
    return Line(name, time.monotonic() - began, runs, coverage), findings
