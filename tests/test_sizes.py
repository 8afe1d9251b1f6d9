"""Long functions, many arguments and many fields have a reason, in a comment above them."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import modefront

SOURCE = Path(modefront.__file__).parent
LINES, ARGUMENTS, FIELDS = 60, 6, 10


def beyond(node: ast.AST) -> Iterator[str]:
    """Yield what is beyond the limits, as ``7 arguments``."""
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
        documented = ast.get_docstring(node)
        text = len(documented.splitlines()) + 2 if documented else 0
        lines = (node.end_lineno or node.lineno) - node.lineno + 1 - text
        names = [x.arg for x in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)]
        count = len(names) - (names[:1] in (["self"], ["cls"]))
        if lines > LINES:
            yield "lines"
        if count > ARGUMENTS:
            yield f"{count} arguments"
    if isinstance(node, ast.ClassDef):
        annotated = [item for item in node.body if isinstance(item, ast.AnnAssign)]
        fields = sum(not ast.unparse(item.annotation).startswith("ClassVar") for item in annotated)
        if fields > FIELDS:
            yield f"{fields} fields"


def test_what_is_large_says_why() -> None:
    for file in SOURCE.rglob("*.py"):
        lines = file.read_text(encoding="utf-8").splitlines()
        for node in ast.walk(ast.parse("\n".join(lines))):
            for text in beyond(node):
                assert isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef)
                first = min([node.lineno, *(each.lineno for each in node.decorator_list)])
                reason = rf"\s*# .*\b{text}\b.*: \w.*\."
                assert re.fullmatch(reason, lines[first - 2]), f"{file}: {node.name}: {text}"
