"""Runs ``modefront`` on a drive that fails: at the call of a number, in the way of a name.

    python tests/trials/faulty.py KIND NUMBER FOLDER ARGUMENT…

Kinds are those of `ERRORS`, which calls for files and folders raise from then on, ``taken`` (the
folder of the results is moved away at that call) and ``long`` (no file gets longer than NUMBER
bytes, as where the drive is full).
"""

from __future__ import annotations

import errno
import functools
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from modefront.cli.main import main

ERRORS = {
    "full": errno.ENOSPC,
    "read-only": errno.EROFS,
    "denied": errno.EACCES,
    "broken": errno.EIO,
    "lost": errno.ESTALE,
}

CALLS = ("replace", "rename", "fsync", "mkdir", "link")


class Drive:
    """Counts calls, and fails from one of them on."""

    def __init__(self, kind: str, number: int, folder: Path) -> None:
        self.kind, self.left, self.folder = kind, number, folder

    def wrapped(self, call: Callable[..., Any]) -> Callable[..., Any]:
        """Return a call of the system that fails when its turn has come."""

        @functools.wraps(call)
        def inner(*arguments: Any, **options: Any) -> Any:
            self.left -= 1
            if self.left <= 0 and self.kind in ERRORS:
                number = ERRORS[self.kind]
                raise OSError(number, os.strerror(number), str(arguments[0]))
            if self.left == 0 and self.kind == "taken" and self.folder.is_dir():
                os.system(f"mv '{self.folder}' '{self.folder}.taken'")
            return call(*arguments, **options)

        return inner


if __name__ == "__main__":
    kind, number, folder, *arguments = sys.argv[1:]
    if kind == "long":
        import resource

        resource.setrlimit(resource.RLIMIT_FSIZE, (int(number), int(number)))
    else:
        drive = Drive(kind, int(number), Path(folder))
        for name in CALLS:
            setattr(os, name, drive.wrapped(getattr(os, name)))
    sys.argv = ["modefront", *arguments]
    main()
