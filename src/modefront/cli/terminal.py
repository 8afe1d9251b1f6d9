"""Output to the terminal: in characters that it has, and without control sequences."""

import io
import sys

from modefront.errors import MOST_CHARACTERS
from modefront.text import SPELL, clean, shortened


def prepare() -> None:
    """Spell characters that the streams' encodings lack, such as ± where there is ASCII only."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=SPELL)


def say(text: str, *, err: bool = False) -> None:
    """Print one line, on standard error where that is wanted."""
    print(clean(text), file=sys.stderr if err else sys.stdout)


def command(*words: object) -> str:
    """Return a command to be pasted.

    >>> command("show", "my results", "--all")
    'modefront show "my results" --all'
    """
    quoted = [f'"{word}"' if " " in str(word) else str(word) for word in words]
    return " ".join(["modefront", *quoted])


def say_next(*words: object) -> None:
    """Print the next command, in one line that can be pasted."""
    say(f"next: {command(*words)}")


def complain(text: str) -> None:
    """Print a message on standard error: lines of clean text, of limited length."""
    lines = shortened(text, MOST_CHARACTERS).split("\n")
    print("\n".join(clean(line) for line in lines), file=sys.stderr)
