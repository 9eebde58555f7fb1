# SPDX-License-Identifier: MIT OR Apache-2.0
"""What a registration by curves warns of."""

from typing import Literal


class RegistrationWarning(str):
    """A sign that the curves of a registration do not say what was meant; as a string, its message.

    Attributes
    ----------
    kind : str
        One of `WARNING_KINDS`, which also says what the indices are of.
    side : "source", "target" or None
        The surface that is meant, where it is one of the two.
    curve : int or None
        The curve that is meant, the first of two.
    second_curve : int or None
        The second of two.
    indices : tuple of int
        The first few elements that are meant.
    count : int
        How many elements are meant.
    value : float or None
        The figure that is too large: of "strained" the energy over that of the surface itself, of
        "distorted" the share of the surface.
    message : str
        The message.
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
        return str(self)
