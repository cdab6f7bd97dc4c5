"""`python -m primordia`, which imports nothing from the current folder unless a task names it."""

import sys

if not sys.flags.safe_path:
    del sys.path[0]

from primordia.cli import main

if __name__ == "__main__":
    main()
