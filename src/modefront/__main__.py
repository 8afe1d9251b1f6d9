"""``python -m modefront``, and the command ``modefront``.

The processes of a run import this module as well, and are spared the command line.
"""


def main() -> None:
    """Run the command line."""
    from modefront.cli.main import main as command

    command()


if __name__ == "__main__":
    main()
