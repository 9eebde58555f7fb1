# SPDX-License-Identifier: MIT OR Apache-2.0
"""The steps of a release, each a command of its own, and the rehearsal that runs all of them."""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import changelog
import distribution
from release import (
    advisories,
    agreement,
    crate,
    extensions,
    inspection,
    notices,
    places,
    smoke,
    sources,
    wheels,
)
from release.problems import Refused, refuse_any
from shell import CommandFailed, Unavailable, say, tail, version

Options = argparse.Namespace
LOGS = places.WORK / "logs"


@dataclass(frozen=True)
class Step:
    """A step of a release; `run` takes the options and the file for its log."""

    name: str
    what: str
    run: Callable[[Options, Path], None]


def agree(options: Options, log: Path) -> None:
    refuse_any(agreement.disagreements(options.tag))


def make_sdist(options: Options, log: Path) -> None:
    distribution.announce(sources.build(log))
    sources.build_again(log)


def make_wheel(options: Options, log: Path) -> None:
    distribution.announce(wheels.build(options.platform, options.free_threaded, log))


def make_wheel_again(options: Options, log: Path) -> None:
    wheels.build_again(options.platform, options.free_threaded, log)


def try_wheel(options: Options, log: Path) -> None:
    smoke.test(options.free_threaded, log)


def inspect(options: Options, log: Path) -> None:
    inspection.inspect(log)


def check_licenses(options: Options, log: Path) -> None:
    if options.write:
        distribution.announce(notices.write(log))
    else:
        notices.check(log)


def check_advisories(options: Options, log: Path) -> None:
    advisories.check(log)


def make_zips(options: Options, log: Path) -> None:
    for path in extensions.pack(log):
        distribution.announce(path)
    extensions.pack_again(log)


def make_index(options: Options, log: Path) -> None:
    distribution.announce(extensions.index(log))


def check_crate(options: Options, log: Path) -> None:
    crate.check(log)


STEPS = (
    Step("agree", "the version is the same everywhere, and that of the tag", agree),
    Step("licenses", "the licenses of the crates in the wheel are accepted, and listed", check_licenses),
    Step("advisories", "no crate has a known vulnerability", check_advisories),
    Step("sdist", "the sdist, from a clean copy of the sources; twice: the same bytes", make_sdist),
    Step("wheel", "the wheel of a platform, from the unpacked sdist, without git", make_wheel),
    Step("again", "the wheel a second time: the same bytes", make_wheel_again),
    Step("try", "the wheel, installed in empty environments, maps", try_wheel),
    Step("inspect", "sdist and wheels by twine, abi3audit, auditwheel and CycloneDX", inspect),
    Step("zips", "the extension zip of each wheel, validated; twice: the same bytes", make_zips),
    Step("index", "the index from which Blender updates the extension", make_index),
    Step("crate", "the crate as it would be published", check_crate),
)


def main(words: list[str], doc: str | None) -> int:
    options = _options(words, doc)
    if options.step == "notes":
        say(changelog.entry().text)
        return 0
    chosen = STEPS if options.dry_run else [step for step in STEPS if step.name == options.step]
    outcomes = {step.name: _perform(step, options) for step in chosen}
    return _verdict(outcomes, options.dry_run)


def _options(words: list[str], doc: str | None) -> Options:
    listing = "\n".join(f"  {step.name:<11} {step.what}" for step in STEPS)
    parser = argparse.ArgumentParser(
        prog="scripts/release",
        description=f"{doc}\nSteps:\n{listing}\n  notes       prints the changelog of the version",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("step", nargs="?", choices=[*(step.name for step in STEPS), "notes"], metavar="STEP")
    parser.add_argument("--dry-run", action="store_true", help="all steps that this machine can do")
    parser.add_argument("--tag", help="agree: the tag that is to be released, e.g. v1.2.3")
    parser.add_argument("--platform", help="wheel, again: the platform, by default this machine's")
    parser.add_argument(
        "--free-threaded", action="store_true", help="wheel, again, try: for Python without a global lock"
    )
    parser.add_argument("--write", action="store_true", help="licenses: write the file anew")
    options = parser.parse_args(words)
    if options.dry_run == (options.step is not None):
        parser.error("name a step, or say --dry-run")
    return options


def _perform(step: Step, options: Options) -> str:
    """Runs a step and prints its outcome: "ok", "not done" or "FAILED"."""
    LOGS.mkdir(parents=True, exist_ok=True)
    log = LOGS / f"{step.name}.log"
    log.write_text("")
    say(f"-------- {step.name}: {step.what}")
    began, outcome, remarks = time.monotonic(), "ok", []
    try:
        step.run(options, log)
    except Unavailable as reason:
        outcome, remarks = "not done", [str(reason)]
    except Refused as refusal:
        outcome, remarks = "FAILED", refusal.problems
    except CommandFailed as failure:
        outcome, remarks = "FAILED", [tail(failure.output, 40), str(failure)]
    say("\n".join([f"{outcome:<8} {time.monotonic() - began:6.1f} s  {step.name}", *remarks]))
    return outcome


def _verdict(outcomes: dict[str, str], rehearsal: bool) -> int:
    """0 if nothing failed. A step that was asked for by name must be done; a rehearsal may leave some out."""
    left_out = [name for name, outcome in outcomes.items() if outcome == "not done"]
    failed = [name for name, outcome in outcomes.items() if outcome == "FAILED"]
    if rehearsal:
        say(f"\n======== version {version()}: nothing was published")
        say(
            f"NOT DONE here, and left to the workflow: {', '.join(left_out)}"
            if left_out
            else "every step was done"
        )
    if failed:
        say(f"FAILED: {', '.join(failed)}")
    return 1 if failed or (left_out and not rehearsal) else 0
