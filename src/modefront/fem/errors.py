"""The one exception of the finite-element room, and its collection."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")


class FemError(ValueError):
    """A model that cannot be built: says where, what was expected and what was found.

    Attributes
    ----------
    messages : one for each thing that is wrong
    """

    def __init__(self, *messages: str) -> None:
        self.messages = messages
        super().__init__("\n".join(messages))


@dataclass(frozen=True)
class Checks:
    """Checks that go on after one of them fails, so that all that is wrong is said at once.

    Attributes
    ----------
    messages : what is wrong
    """

    messages: list[str] = field(default_factory=list)

    def attempt(self, check: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T | None:
        """Return the result of a function; None, with its messages noted, where it fails."""
        try:
            return check(*args, **kwargs)
        except FemError as error:
            self.messages.extend(m for m in error.messages if m not in self.messages)
            return None

    def close(self) -> None:
        """Raise FemError with everything that is wrong, if anything is."""
        if self.messages:
            raise FemError(*self.messages)
