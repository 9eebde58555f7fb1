# SPDX-License-Identifier: MIT OR Apache-2.0
"""The docstrings of the package: they keep numpydoc's rules, and their examples run."""

import doctest
import inspect
import warnings

import pytest

import authalic
import authalic.batch
import authalic.cli
import authalic.io

EVERYWHERE = {"ES01", "GL02", "SA01"}
"""Rules that count nowhere: an extended summary, the line of the closing quotes, a section "See Also".

The native module's docstrings have no quotes, and short ones need no more than their summary.
"""
OF_CALLABLES = {"EX01"}
"""Rules that count for what can be called: an example."""


def public_names() -> list[str]:
    """Every documented name, from the root of the package: functions, classes, and what classes have."""
    listed = [*authalic.__all__, "cli.main", *(f"io.{name}" for name in authalic.io.__all__)]
    listed += [f"batch.{name}" for name in authalic.batch.__all__]
    subjects = {name: documented(name) for name in listed}
    kept = [
        name for name, subject in subjects.items() if inspect.isclass(subject) or inspect.isroutine(subject)
    ]
    classes = [name for name in kept if inspect.isclass(subjects[name])]
    members = [f"{name}.{member}" for name in classes for member in own_members(subjects[name])]
    return kept + [name for name in members if not name.rsplit(".", 1)[1].startswith("_")]


def own_members(subject: type) -> list[str]:
    """The names that a class has by itself, except its fields, which its own docstring documents."""
    fields = {*getattr(subject, "__dataclass_fields__", ()), *getattr(subject, "_fields", ())}
    return [name for name in vars(subject) if name not in fields]


def documented(name: str) -> object:
    subject: object = authalic
    for part in name.split("."):
        subject = getattr(subject, part)
    return subject


def broken_rules(name: str) -> list[str]:
    validate = pytest.importorskip("numpydoc.validate").validate
    with warnings.catch_warnings(action="error"):
        errors = validate(f"authalic.{name}")["errors"]
    ignored = EVERYWHERE if inspect.isroutine(documented(name)) else EVERYWHERE | OF_CALLABLES
    return [f"{code}: {what}" for code, what in errors if code not in ignored]


@pytest.mark.parametrize("name", public_names())
def test_docstrings_keep_the_rules_of_numpydoc(name):
    assert not broken_rules(name)


def test_a_docstring_that_breaks_rules_is_found(monkeypatch):
    def scale(vertices, factor):
        """scales

        Parameters
        ----------
        vertices : (n, 3) integer array
            Positions.
        """

    monkeypatch.setattr(authalic, "scale", scale, raising=False)
    codes = {problem[:4] for problem in broken_rules("scale")}
    assert codes == {"SS02", "SS03", "SS05", "PR01", "PR06", "EX01"}


def test_every_kind_of_name_is_validated():
    names = public_names()
    assert {"disk_map", "Surface", "MeshError", "Surface.cut", "SphereMap.positions", "io.read_mesh"} <= set(
        names
    )
    assert not {"__version__", "ERROR_KINDS"} & set(names)


@pytest.mark.parametrize("name", ["", *public_names()])
def test_the_examples_in_the_docstrings_run(name):
    text = inspect.getdoc(documented(name) if name else authalic) or ""
    test = doctest.DocTestParser().get_doctest(text, {}, name or "authalic", None, 0)
    report: list[str] = []
    outcome = doctest.DocTestRunner(verbose=False).run(test, out=report.append)
    assert outcome.failed == 0, "".join(report)
    assert outcome.attempted >= 3 or not (name == "" or inspect.isroutine(documented(name)))
