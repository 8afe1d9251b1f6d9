"""Variables of results: dimensions, unit and meaning."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Values = Literal["number", "count", "truth", "text"]
"""Types of values of a variable."""


@dataclass(frozen=True)
class Variable:
    """A variable of the results.

    The unit is empty where there is none, or where it is that of the model; ``section`` is a
    heading of the documentation, ``together`` a name of variables of which a file has all or none.
    """

    name: str
    dimensions: tuple[str, ...]
    meaning: str
    values: Values = "number"
    unit: str = ""
    section: str = ""
    required: bool = False
    together: str = ""

    @property
    def attributes(self) -> dict[str, str]:
        """Attributes of the variable in a file (CF conventions)."""
        return {"long_name": self.meaning} | ({"units": self.unit} if self.unit else {})
