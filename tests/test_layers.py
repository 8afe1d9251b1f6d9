"""Imports point one way: from the command line through the study to the mathematics."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import modefront

LAYERS = (
    ("_lazy", "_typing", "_version", "outputs", "rounding", "text"),
    ("errors",),
    ("complete", "datasets", "families", "inputs"),
    ("hdf5", "options"),
    ("linalg", "work"),
    ("data", "fem", "modes", "optim"),
    ("front", "identification", "pairing"),
    ("models",),
    ("programs",),
    ("residuals",),
    ("identifiability", "predictions", "uncertainty"),
    ("findings",),
    ("analysis", "diagnosis"),
    ("plots",),
    ("results",),
    ("reports",),
    ("study",),
    ("cli",),
    ("__init__", "__main__"),
)
"""Parts of the package, the lowest first: a part imports from those of lower layers, and itself."""

SOURCE = Path(modefront.__file__).parent


def part(name: str) -> int:
    """Return the layer of a part of the package."""
    result = [i for i, names in enumerate(LAYERS) if name in names]
    assert len(result) == 1, f"{name}: expected in one layer, found in {len(result)}"
    return result[0]


@cache
def tree(file: Path) -> ast.Module:
    return ast.parse(file.read_text(encoding="utf-8"))


def imported(file: Path) -> Iterator[str]:
    """Yield the parts of the package that a file imports, wherever in it."""
    for node in ast.walk(tree(file)):
        names: list[str] = []
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{file}: expected absolute imports, found a relative one"
            root = node.module or ""
            names = (
                [f"{root}.{name.name}" for name in node.names] if root == "modefront" else [root]
            )
        elif isinstance(node, ast.Import):
            names = [name.name for name in node.names]
        for name in names:
            package, _, rest = name.partition(".")
            if package == "modefront":
                yield rest.partition(".")[0] or "__init__"


FILES = sorted(SOURCE.rglob("*.py"))


def test_no_part_imports_from_one_beside_or_above_it() -> None:
    for file in FILES:
        chosen = file.relative_to(SOURCE).parts[0].removesuffix(".py")
        for name in imported(file):
            assert name == chosen or part(name) < part(chosen), f"{file} imports {name}"


def test_no_modules_import_each_other() -> None:
    names = {
        ".".join(["modefront", *file.relative_to(SOURCE).with_suffix("").parts]).removesuffix(
            ".__init__"
        ): file
        for file in FILES
    }
    graph: dict[str, set[str]] = {name: set() for name in names}
    for name, file in names.items():
        for node in _executed(tree(file)):
            if isinstance(node, ast.ImportFrom):
                root = node.module or ""
                inner = {f"{root}.{name.name}" for name in node.names}
                graph[name] |= {module if module in names else root for module in inner}
            elif isinstance(node, ast.Import):
                graph[name] |= {alias.name for alias in node.names}
    known = {name: imports & names.keys() for name, imports in graph.items()}
    list(TopologicalSorter(known).static_order())  # raises CycleError


def _executed(node: ast.AST) -> Iterator[ast.AST]:
    """Yield what is executed of a module, in functions too: all but imports for types only."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.If) and ast.unparse(child.test).endswith("TYPE_CHECKING"):
            yield from (each for other in child.orelse for each in (other, *_executed(other)))
        else:
            yield child
            yield from _executed(child)
