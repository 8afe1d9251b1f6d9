"""Examples that ``modefront init`` writes: one folder each."""

from importlib import resources
from pathlib import Path

from modefront.errors import Fault, InputError, refuse, suggestion, writing
from modefront.outputs import write_bytes


def names() -> list[str]:
    """Return the names of the examples."""
    folder = resources.files(__package__)
    return sorted(item.name for item in folder.iterdir() if item.joinpath("study.toml").is_file())


def write_example(name: str, directory: Path) -> list[Path]:
    """Write the files of an example into a folder and return their paths.

    Raises InputError for an unknown example, and where a file is already there: nothing is
    overwritten.
    """
    if name not in names():
        expected = "one of " + ", ".join(names())
        raise InputError(Fault("modefront init", "--example", expected, suggestion(name, names())))
    sources = resources.files(__package__).joinpath(name).iterdir()
    files = {directory / source.name: source for source in sources}
    with writing(directory):
        directory.mkdir(parents=True, exist_ok=True)
        expected = "a new file, as nothing is overwritten"
        refuse(
            Fault(str(path), "file", expected, "an existing one")
            for path in sorted(files)
            if path.exists() or path.is_symlink()
        )
        for path, source in files.items():
            write_bytes(path, source.read_bytes())
    return sorted(files)
