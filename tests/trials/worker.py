"""Runs commands that it is given, one a line of JSON, and says how each of them ended."""

from __future__ import annotations

import contextlib
import io
import json
import sys
import warnings

from modefront.cli.main import main
from modefront.isolated import limit

MEMORY = 6 * 10**9


def command(arguments: list[str]) -> tuple[int, str, str]:
    """Return exit status, output and messages of a command."""
    raw = [io.BytesIO(), io.BytesIO()]
    streams = [io.TextIOWrapper(each, encoding="utf-8") for each in raw]
    sys.argv = ["modefront", *arguments]
    status = -1
    with contextlib.redirect_stdout(streams[0]), contextlib.redirect_stderr(streams[1]):
        try:
            main()
        except SystemExit as left:
            status = left.code if isinstance(left.code, int) else -1
        for stream in streams:
            stream.flush()
    return status, raw[0].getvalue().decode(), raw[1].getvalue().decode()


if __name__ == "__main__":
    limit(MEMORY)
    warnings.simplefilter("ignore")
    for line in sys.stdin:
        status, out, err = command(json.loads(line))
        print(json.dumps([status, out[-5000:], err[-5000:], len(err)]), flush=True)
