"""Sets up everything in .venv, then does one of the project's tasks.

python3 tasks.py demo    the three-story study, both configurations, beside the published numbers
python3 tasks.py test    the tests, but for those that are marked as slow
python3 tasks.py lint    formatting, lint and types
python3 tasks.py docs    the pages, as docs/_build/html/index.html
python3 tasks.py trials  the tests that are marked as slow (minutes)
python3 tasks.py verify  docs/verification.md: what is compared with others (a quarter of an hour)
python3 tasks.py spoil   inputs that are spoilt by chance and runs that are killed (hours)

Needs Python 3.11 or newer and nothing else. Packages are those pinned in requirements.txt for the
demo, and in requirements-docs.txt for the pages and requirements-dev.txt for all else, which add
to them.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parent
ENVIRONMENT = ROOT / ".venv"
RUNTIME, DEVELOPMENT, PAGES = (
    "requirements.txt",
    "requirements-dev.txt",
    "requirements-docs.txt",
)
PYTEST = ["-m", "pytest", "-q", "-n", "auto"]
NEEDS = {"demo": RUNTIME, "docs": PAGES}
TASKS = {
    "demo": [["examples/three_story.py", "demo"]],
    "test": [[*PYTEST, "--dist", "worksteal", "-m", "not slow"]],
    "trials": [[*PYTEST, "--dist", "loadfile", "--no-loadscope-reorder", "-m", "slow"]],
    "verify": [["benchmarks/verify.py"]],
    "spoil": [["tests/trials/trials.py"]],
    "docs": [
        ["-m", "sphinx", "-q", "-j", "auto", "-W", "--keep-going", "docs", "docs/_build/html"]
    ],
    "lint": [
        ["-m", "ruff", "format", "--check", "."],
        ["-m", "ruff", "check", "."],
        ["-m", "mypy"],
    ],
}


def python() -> Path:
    """Return the interpreter of the environment."""
    return ENVIRONMENT / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


def run(*arguments: str) -> None:
    """Run the environment's Python; leave with its status where that is not 0."""
    # Without bytecode, each of the hundreds of processes of the tests would compile the package.
    kept = {key: x for key, x in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    command = [str(python()), *arguments]
    status = subprocess.run(command, cwd=ROOT, env=kept, check=False).returncode
    if status:
        sys.exit(status)


def set_up(requirements: str) -> None:
    """Create the environment, renew it if pinned packages have changed, or add what it lacks."""
    files = (RUNTIME, DEVELOPMENT, PAGES, "pyproject.toml")
    pinned = b"".join((ROOT / name).read_bytes() for name in files)
    digest = hashlib.sha256(pinned + str(ROOT).encode()).hexdigest()
    stamp = ENVIRONMENT / "installed"
    found, *installed = stamp.read_text().split() if stamp.is_file() else [""]
    if found == digest and requirements in installed:
        return
    print("setting up .venv (once; about a minute)", file=sys.stderr)
    if found != digest:
        venv.create(ENVIRONMENT, with_pip=True, clear=True)
    # What is used is compiled where it is imported first: most of what is installed never is.
    pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-compile"]
    run(*pip, "--require-hashes", "--only-binary=:all:", "-r", str(ROOT / requirements))
    if found != digest:
        run(*pip, "--no-deps", "--no-build-isolation", "--editable", str(ROOT))
    stamp.write_text(" ".join([digest, RUNTIME, requirements]))


def main() -> None:
    """Do the task that the command line names; further arguments go to its last command."""
    if sys.version_info < (3, 11):
        sys.exit(f"modefront needs Python 3.11 or newer; this is {sys.version.split()[0]}")
    if len(sys.argv) < 2 or sys.argv[1] not in TASKS:
        sys.exit(__doc__)
    set_up(NEEDS.get(sys.argv[1], DEVELOPMENT))
    *first, last = TASKS[sys.argv[1]]
    for command in first:
        run(*command)
    run(*last, *sys.argv[2:])


if __name__ == "__main__":
    main()
