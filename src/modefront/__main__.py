"""``python -m modefront``, and the command ``modefront``.

The processes of a run import this module as well, and are spared the command line.
"""

import sys
from typing import Any


def main() -> None:
    """Run the command line."""
    if "--scheduler" not in " ".join(sys.argv):
        modules: dict[str, Any] = sys.modules
        modules.setdefault("dask", None)  # xarray would import it
    from modefront.cli.main import main as command

    command()


if __name__ == "__main__":
    main()
