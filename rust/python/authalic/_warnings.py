# SPDX-License-Identifier: MIT OR Apache-2.0
"""The warnings of a registration by curves."""

from typing import Literal


class RegistrationWarning(str):
    """A sign that the curves of a registration do not say what was meant.

    As a string it is its message. The attributes have the names of the parameters.

    Parameters
    ----------
    message : str
        The message.
    kind : str
        One of `WARNING_KINDS`, which says what the indices number.
    side : "source", "target" or None
        The surface concerned, if it is one of the two.
    curve : int or None
        The curve concerned, or the first of two.
    second_curve : int or None
        The second of two curves.
    indices : tuple of int
        The first few elements concerned.
    count : int
        The number of elements concerned.
    value : float or None
        The figure that is too large: for "strained" the energy over that of the surface itself, for
        "distorted" the share of the surface.
    """

    kind: str
    side: Literal["source", "target"] | None
    curve: int | None
    second_curve: int | None
    indices: tuple[int, ...]
    count: int  # type: ignore[assignment]
    value: float | None

    def __new__(
        cls,
        message: str,
        *,
        kind: str = "",
        side: Literal["source", "target"] | None = None,
        curve: int | None = None,
        second_curve: int | None = None,
        indices: tuple[int, ...] = (),
        count: int = 0,
        value: float | None = None,
    ) -> "RegistrationWarning":
        warning = super().__new__(cls, message)
        warning.kind, warning.side = kind, side
        warning.curve, warning.second_curve = curve, second_curve
        warning.indices, warning.count, warning.value = indices, count, value
        return warning

    @property
    def message(self) -> str:
        """The message, as a plain string."""
        return str(self)
