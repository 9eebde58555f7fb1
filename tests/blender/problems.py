# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the library made by the tests, and a library with garbled messages."""

import functools
from collections.abc import Callable
from typing import Any

import pytest
from installed import library

GARBLED = "xyzzy face 3 of the source: 7 vertices (1, 2)"
FACTS: dict[str, Any] = {"side": None, "curve": None, "second_curve": None, "indices": (), "count": 0}
FUNCTIONS = (
    *("Surface", "cut", "disk_map", "sphere_map", "distortion", "untangle", "homotopy"),
    *("register_disks", "register_spheres", "register_hyperbolic"),
)


def made(exception: str, kind: str, message: str = GARBLED, **facts: Any) -> Any:
    """An error of the library, "MeshError" or "SolverError", with some facts."""
    error = getattr(library(), exception)(message)
    vars(error).update(FACTS | {"kind": kind} | facts)
    return error


def warned(kind: str, message: str = GARBLED, **facts: Any) -> Any:
    """A warning of the library with some facts."""
    return library().RegistrationWarning(message, kind=kind, **facts)


def garble(monkeypatch: pytest.MonkeyPatch) -> None:
    """Replaces the message of every error and warning of the library by `GARBLED`."""
    for name in FUNCTIONS:
        monkeypatch.setattr(library(), name, _garbled(getattr(library(), name)))


def _garbled(function: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(function)
    def call(*args: Any, **options: Any) -> Any:
        try:
            result = function(*(getattr(arg, "registration", arg) for arg in args), **options)
        except (library().MeshError, library().SolverError) as error:
            raise made(type(error).__name__, message=GARBLED, **vars(error)) from None
        return _Registration(result) if isinstance(result, library().Registration) else result

    return call


class _Registration:
    """A registration with garbled warnings."""

    def __init__(self, registration: Any) -> None:
        self.registration = registration

    def __getattr__(self, name: str) -> Any:
        return getattr(self.registration, name)

    @property
    def warnings(self) -> list[Any]:
        return [warned(**vars(warning)) for warning in self.registration.warnings]
