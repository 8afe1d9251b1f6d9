"""Names of a package that are imported when they are first used, so that importing it is quick."""

import re
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

IMPORT = re.compile(r"^    from (modefront\S*) import (\w+) as \2$", re.MULTILINE)
"""A line that says where a public name is, for people and checkers of types."""


def lazy(
    package: str, file: str
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return ``__getattr__``, ``__dir__`` and ``__all__`` of a package, given its file.

    Its names are those that it imports ``if TYPE_CHECKING``.
    """
    homes = {name: home for home, name in IMPORT.findall(Path(file).read_text(encoding="utf-8"))}

    def load(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        home = homes[name]
        module = import_module(f"{package}.{name}" if home == package else home)
        return module if home == package else getattr(module, name)

    return load, lambda: sorted(homes), sorted(homes)
