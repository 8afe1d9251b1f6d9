"""Tables that benchmarks add to the study files of the examples."""

from __future__ import annotations

PUSHED = """
[[predict.frf]]
name = "pushed"
force = { floor3 = 1.0 }
response = { top = "floor3" }
band = [0.5, 20.0]
damping = 0.02
"""
"""A peak of the frequency response of the three-story building."""


def uncertainty(draws: int, bootstrap: int | None = None, source: str | None = None) -> str:
    """Return the table of the uncertainty with so many draws and bootstrap samples."""
    options = {"source": source and f'"{source}"', "bootstrap": bootstrap, "draws": draws}
    lines = [f"{name} = {value}" for name, value in options.items() if value]
    return "\n".join(["\n[uncertainty]", *lines]) + "\n"
