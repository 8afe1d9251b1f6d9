"""Files that are written: whole or not at all, under another name first, never through a link."""

import csv
import io
import os
import stat
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

ENDING = ".tmp"  # ending of files that are not yet written to the end


@contextmanager
def output(path: Path, *, lasting: bool = False) -> Iterator[io.BufferedRandom]:
    """Open a file that takes the place of ``path`` when all of it is written.

    It has the permissions of the file that was there, or those of any new file. A ``lasting`` one
    is on the drive before it takes its place. Raises OSError where it cannot be written.
    """
    unfinished = path.with_name(f".{path.name[:40]}-{os.urandom(6).hex()}{ENDING}")
    try:
        with unfinished.open("xb+") as stream:
            with suppress(OSError):  # no earlier file, or a drive without permissions
                if stat.S_ISREG(mode := path.lstat().st_mode):
                    unfinished.chmod(mode & 0o777)
            yield stream
            stream.flush()
            if lasting:
                os.fsync(stream.fileno())
        unfinished.replace(path)
    except BaseException:  # a full disk or an interrupt
        unfinished.unlink(missing_ok=True)
        raise


@contextmanager
def output_by_name(path: Path) -> Iterator[Path]:
    """Yield a name for packages that open files themselves; what they write is for ``path``."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "copy"
        yield copy
        write_bytes(path, copy.read_bytes())


def write_bytes(path: Path, content: bytes, *, lasting: bool = False) -> None:
    """Write bytes, as `output` does."""
    with output(path, lasting=lasting) as stream:
        stream.write(content)


def write_text(path: Path, text: str, *, lasting: bool = False) -> None:
    """Write a text in UTF-8, as `output` does; bytes that were no UTF-8 are as they were."""
    write_bytes(path, text.encode("utf-8", "surrogateescape"), lasting=lasting)


def write_table(path: Path, rows: Iterable[Sequence[object]]) -> None:
    """Write rows as CSV, as `output` does."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    write_text(path, text.getvalue())


def remove_unfinished(folder: Path, name: str = "") -> None:
    """Remove what processes that were killed have not written to the end, of a file or of all."""
    for path in folder.glob(f".{name}*{ENDING}"):
        path.unlink(missing_ok=True)
