"""What becomes of files by chance."""

from __future__ import annotations

import re

import numpy as np

WORDS = (
    *(
        b"*",
        b"\x1a",
        b"\x00",
        b"\xff" * 8,
        b"nan",
        b"inf",
        b"1e999",
        b"-1",
        b"99999999999999999999",
    ),
    *(b"\x1b]0;x\x07", b"\xc2\x9b31m", b"\n" * 50, b"[" * 2000, b"{" * 200, b'"', b",", b"%%"),
    *(b"a" * 5000, b"\xed\xb2\x80", b"../../etc/passwd", b"/dev/zero", b"*INCLUDE, INPUT=x\n"),
)
"""What is put into files."""


NUMBER = re.compile(rb"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")

NUMBERS = (b"0", b"-1", b"1e-300", b"1e300", b"2147483648", b"18446744073709551616", b"nan", b"7")
"""What is put in place of numbers."""

LARGE = (0, 1, 2**15, 2**31 - 1, 2**31, 2**32 - 1, 2**63 - 1, 2**64 - 1)
"""What is put in place of binary numbers."""


def mutated(content: bytes, rng: np.random.Generator) -> bytes:
    """Return content of which some is flipped, cut, doubled, moved, or replaced.

    Half of all are changed in one place only, so that what lies behind the first check is met too.
    """
    out = bytearray(content)
    for _ in range(1 if rng.integers(2) else int(rng.integers(1, 5))):
        _change(out, rng)
    return bytes(out)


def _change(out: bytearray, rng: np.random.Generator) -> None:
    at = int(rng.integers(len(out) + 1))
    length = int(rng.integers(1, 40))
    kind = int(rng.integers(11))
    if kind == 0 and out:
        out[at % len(out)] ^= 1 << int(rng.integers(8))
    elif kind == 1 and out:
        out[at % len(out)] = int(rng.integers(256))
    elif kind == 2:
        del out[at:]
    elif kind == 3:
        del out[at : at + length]
    elif kind == 4:
        out[at:at] = out[at : at + length]
    elif kind == 5:
        out[at:at] = rng.bytes(length)
    elif kind < 8:
        word = WORDS[int(rng.integers(len(WORDS)))]
        out[at : at + (len(word) if kind == 6 else 0)] = word
    elif kind == 8:
        size = int(rng.choice([2, 4, 8]))
        value = LARGE[int(rng.integers(len(LARGE)))] % 256**size
        out[at : at + size] = value.to_bytes(size, "little")
    elif found := NUMBER.search(bytes(out), at):
        out[found.start() : found.end()] = NUMBERS[int(rng.integers(len(NUMBERS)))]
