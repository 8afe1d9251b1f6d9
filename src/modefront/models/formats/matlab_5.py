"""Files of MATLAB's version 5 (to 7.2): elements with a type, a size and values, some compressed.

Only numeric variables are read, full and sparse ones; what cells, structures and texts hold is
passed over. Sizes are compared with what is there before room is made.

A file is a header of 128 bytes and elements. An element is a tag (type, bytes) and values, padded
to 8 bytes; a small one has both in 8 bytes. An element of a variable holds elements:

==========  =============================================================
element     values
==========  =============================================================
flags       class, whether it is complex
dimensions  numbers of rows, columns, ...
name        letters
ir, jc      of a sparse variable: row of each entry, first entry of each column
real        values by columns
==========  =============================================================

Source: The MathWorks, *MAT-File Format*, chapter 1.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse

from modefront.models.formats.base import Header, check_compressed, check_growth, check_header

START = 128
"""Bytes of the header of a file."""

MATRIX, COMPRESSED = 14, 15
"""Types of elements that are variables."""

TYPES: Mapping[int, str] = {
    **{1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"},
    **{16: "u1", 17: "u2", 18: "u4"},
}
"""Types of elements that are values, as NumPy knows them."""

SPARSE, NUMERIC = 5, range(6, 16)
"""Classes of variables that are matrices of numbers."""

COMPLEX = 0x08
"""Flag of complex variables."""

HEAD = 4096
"""Bytes of a variable in which its flags, dimensions and name are sought; names have 63 letters."""

MOST_VARIABLES = 10_000
"""Variables that are looked at: a damaged file must not be read without an end."""


@dataclass(frozen=True)
class Variable:
    """A variable of a file: its name, what it announces, and the element that holds it.

    Attributes
    ----------
    name : of the variable; other than matrices have the shape that they announce as well
    header : what it announces
    is_sparse, is_complex, is_numeric : what it is
    order : "<" or ">", how bytes are ordered
    start, size : where the content of the element is in the file
    compressed : whether it is compressed
    """

    name: str
    header: Header
    is_sparse: bool
    is_complex: bool
    is_numeric: bool
    order: str
    start: int
    size: int
    compressed: bool


@dataclass(frozen=True)
class _Element:
    """An element: its type, and where its values begin and end in a buffer."""

    kind: int
    start: int
    end: int


def variables(path: Path) -> Iterator[Variable]:
    """Yield what is in a file; raises ValueError for what is no such file, or a torn one."""
    total = path.stat().st_size
    with path.open("rb") as stream:
        head = stream.read(START)
        order = {b"IM": "<", b"MI": ">"}.get(head[126:128])
        if order is None:
            raise ValueError("no file of MATLAB's version 5 to 7.3: save it with -v7")
        position = START
        for _ in range(MOST_VARIABLES):
            stream.seek(position)
            tag = stream.read(8)
            if not tag:
                return
            if len(tag) < 8:
                raise ValueError("the end of the file in a tag")
            kind, size = (int(x) for x in np.frombuffer(tag, f"{order}u4"))
            position += 8
            if size > total - position:
                raise ValueError(f"{size} bytes of a variable announced, {total - position} there")
            if kind == COMPRESSED:
                content = zlib.decompressobj().decompress(stream.read(min(size, HEAD)), HEAD)
                inside, content = content[:8], content[8:]
                if len(inside) < 8 or int(np.frombuffer(inside, f"{order}u4")[0]) != MATRIX:
                    raise ValueError("compressed content that is no variable")
                announced = int(np.frombuffer(inside, f"{order}u4")[1])
                yield _variable(content, order, announced, (position, size, True))
                position += size
            elif kind == MATRIX:
                head = stream.read(min(size, HEAD))
                yield _variable(head, order, size, (position, size, False))
                position += size + -size % 8
            else:
                raise ValueError(f"an element of the type {kind} in place of a variable")
    raise ValueError(f"more than {MOST_VARIABLES} variables")


def _variable(head: bytes, order: str, size: int, where: tuple[int, int, bool]) -> Variable:
    """Return the variable of which ``head`` are the first of ``size`` bytes."""
    elements = _elements(head, order, 3, size)
    flags = _values(head, elements[0], order, 6)
    shape = tuple(int(n) for n in _values(head, elements[1], order, 5))
    name = head[elements[2].start : elements[2].end].decode("ascii", "backslashreplace")
    if flags.size != 2 or not 2 <= len(shape) <= 32 or min(shape) < 0:
        raise ValueError(f"a variable '{name}' of the shape {shape}")
    kind = int(flags[0]) & 0xFF
    is_sparse, is_numeric = kind == SPARSE, kind in NUMERIC
    entries = int(flags[1]) if is_sparse else math.prod(shape)
    if (is_sparse or is_numeric) and entries > size:
        raise ValueError(f"{entries} entries of '{name}' announced in {size} bytes")
    is_complex = bool(int(flags[0]) >> 8 & COMPLEX)
    return Variable(
        *(name, Header(shape, entries), is_sparse, is_complex, is_sparse or is_numeric),
        *(order, *where),
    )


def read_variable(path: Path, variable: Variable) -> Any:
    """Return a variable, an array or a sparse one.

    Raises InputError where it is no matrix that can be kept, and ValueError where it is damaged.
    """
    if not variable.is_numeric:
        raise ValueError(f"'{variable.name}' is no matrix of numbers")
    check_header(path, variable.header)
    with path.open("rb") as stream:
        stream.seek(variable.start)
        content = stream.read(variable.size)
    if variable.compressed:
        announced = np.frombuffer(
            zlib.decompressobj().decompress(content, 8), f"{variable.order}u4"
        )
        size = int(announced[1])
        check_growth(path, size, variable.size)
        expander = zlib.decompressobj()
        content = expander.decompress(content, size + 9)[8:]
        if len(content) != size or not expander.eof:
            raise ValueError(f"{size} bytes of '{variable.name}' announced, {len(content)} there")
    order, shape = variable.order, variable.header.shape
    count = (6 if variable.is_sparse else 4) + variable.is_complex
    elements = _elements(content, order, count, len(content))
    if elements[-1].end + -elements[-1].end % 8 != len(content):
        raise ValueError(f"{len(content)} bytes of '{variable.name}', which has {elements[-1].end}")
    if not variable.is_sparse:
        parts = [_values(content, each, order) for each in elements[3:]]
        if any(part.size != math.prod(shape) for part in parts):
            raise ValueError(f"{parts[0].size} values of '{variable.name}', which is {shape}")
        whole = parts[0] if len(parts) == 1 else parts[0] + 1j * parts[1]
        return whole.reshape(shape, order="F")
    rows, columns, *parts = (_values(content, each, order) for each in elements[3:])
    count = int(columns[-1]) if columns.size else 0
    if not {rows.size, *(part.size for part in parts)} <= {count, variable.header.entries}:
        raise ValueError(f"the columns of '{variable.name}' do not fit its entries")
    values = parts[0][:count] if len(parts) == 1 else parts[0][:count] + 1j * parts[1][:count]
    index = rows[:count].astype(np.int64), columns.astype(np.int64)
    check_compressed(values, *index, shape[1])
    A = scipy.sparse.csc_array((values, *index), shape=shape)
    A.check_format(full_check=True)
    return A


def _elements(content: bytes, order: str, count: int, size: int) -> list[_Element]:
    """Return the first elements of a variable of ``size`` bytes, which may go on beyond these."""
    out: list[_Element] = []
    position = 0
    for _ in range(count):
        tag = content[position : position + 8]
        if len(tag) < 8:
            raise ValueError("a variable that is cut off")
        first, length = (int(x) for x in np.frombuffer(tag, f"{order}u4"))
        if first >> 16:  # small: the bytes are counted in the upper half
            kind, length, start, position = first & 0xFFFF, first >> 16, position + 4, position + 8
            if length > 4:
                raise ValueError(f"a small element of {length} bytes")
        else:
            kind, start = first, position + 8
            position = start + length + -length % 8
        if start + length > size:
            raise ValueError(f"{length} bytes of an element announced, {size - start} there")
        out.append(_Element(kind, start, start + length))
    return out


def _values(content: bytes, element: _Element, order: str, kind: int | None = None) -> Any:
    """Return the values of an element, in the order of this machine."""
    if element.kind not in TYPES or (kind is not None and element.kind not in (kind, 5, 6)):
        raise ValueError(f"an element of the type {element.kind}")
    part = content[element.start : element.end]
    if len(part) < element.end - element.start:
        raise ValueError("a variable that is cut off")
    dtype = np.dtype(order + TYPES[element.kind])
    if len(part) % dtype.itemsize:
        raise ValueError(f"{len(part)} bytes of values of {dtype.itemsize} bytes")
    return np.frombuffer(part, dtype).astype(dtype.newbyteorder("="))
