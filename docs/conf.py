"""How the pages are made: ``python3 tasks.py docs`` writes them to ``docs/_build/html``."""

from __future__ import annotations

import sys
from pathlib import Path

from sphinx.application import Sphinx

from modefront import __version__

sys.path.append(str(Path(__file__).parent / "_extensions"))

project = "modefront"
author = "The modefront developers"
version = release = __version__
extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_click",
    "docstrings",
    "mathml",
]
exclude_patterns = ["_build", "_extensions"]
myst_enable_extensions = ["dollarmath", "colon_fence", "deflist"]
myst_heading_anchors = 3
html_theme = "furo"
html_title = f"modefront {version}"
html_math_renderer = "mathml"
html_static_path: list[str] = []
nb_execution_mode = "force"  # a cache is no place for pages that are made at once
nb_execution_raise_on_error = True
nb_execution_timeout = 600
nb_merge_streams = True
autodoc_typehints = "description"
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_rtype = False
suppress_warnings = ["ref.python"]  # shapes such as (modes,) are no names to link


def spread(_app: object, _env: object, names: list[str]) -> None:
    """Part pages that are neighbours, as most of those that run code are, between processes."""
    names[:] = [name for k in range(12) for name in names[k::12]]


def setup(app: Sphinx) -> None:
    """Have Sphinx read the pages in that order."""
    app.connect("env-before-read-docs", spread)
