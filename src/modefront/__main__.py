"""``python -m modefront``."""

from modefront.cli.main import main

if __name__ == "__main__":
    main()
