# SPDX-License-Identifier: MIT OR Apache-2.0
"""The numbered cases of the search for failures, each judged in a process that may crash or hang."""

import multiprocessing
import time
import traceback
from dataclasses import dataclass

import numpy as np
from api import random_checks, random_meshes

SIZES, SHARES = (60, 300, 1500, 5000), (0.4, 0.4, 0.17, 0.03)
"""The sizes of the meshes in vertices, and the shares of the cases that have them."""


@dataclass(frozen=True)
class Done:
    """A case that has run; `failure` is empty if all is as it must be."""

    number: int
    kind: str
    """ "sound" (default options), "options", or "hostile"."""
    name: str
    status: str
    deviation: float
    failure: str
    seconds: float


def kind_of(number):
    """The kind of a case: the three kinds take turns."""
    return ("sound", "options", "hostile")[number % 3]


def case_of(number):
    """The mesh and the options of a case."""
    size = int(np.random.default_rng([number, 2]).choice(SIZES, p=SHARES))
    if kind_of(number) == "hostile":
        case = random_meshes.hostile_case(number, min(size, 1500))
    else:
        case = random_meshes.sound_case(number, size)
    options = {} if kind_of(number) == "sound" else random_checks.random_options(number, case)
    return case, options


def judged(case, options):
    """The outcome of a case; raises if something is wrong with it."""
    if case.kind == "hostile":
        return random_checks.assert_hostile_case(case, **options)
    return random_checks.assert_sound_case(case, **options)


def run(number):
    """The outcome of a case; an exception is a failure."""
    began = time.perf_counter()
    name, status, deviation, failure = "", "", np.nan, ""
    try:
        case, options = case_of(number)
        name = case.name
        status, deviation = judged(case, options)
    except Exception as problem:
        place = traceback.extract_tb(problem.__traceback__)[-1]
        failure = " ".join(f"{type(problem).__name__} at `{place.line}`: {problem}".split())[:400]
    return Done(number, kind_of(number), name, status, deviation, failure, time.perf_counter() - began)


class Worker:
    """Judges cases in a process of its own; a new one follows if it crashes or hangs."""

    def __init__(self, limit):
        self.limit = limit
        self._context = multiprocessing.get_context("spawn")
        self._process = None

    def __call__(self, number):
        """The case, run within the limit."""
        if self._process is None:
            self._start()
        began = time.perf_counter()
        try:
            self._line.send(number)
            if self._line.poll(self.limit):
                return self._line.recv()
            failure = f"not done after {self.limit:g} s"
        except (EOFError, OSError):
            self._process.join(5)
            failure = f"crashed: the process ended with code {self._process.exitcode}"
        self.stop()
        return Done(number, kind_of(number), "", "", np.nan, failure, time.perf_counter() - began)

    def stop(self):
        """Ends the process."""
        if self._process is not None:
            self._process.kill()
            self._process.join()
            self._process = None

    def _start(self):
        self._line, far_end = self._context.Pipe()
        self._process = self._context.Process(target=answer, args=(far_end,), daemon=True)
        self._process.start()
        far_end.close()


def answer(line):
    """Runs in the process: answers each number with its case, until the line is closed."""
    while True:
        try:
            number = line.recv()
        except EOFError:
            return
        line.send(run(number))
