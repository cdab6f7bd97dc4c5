"""Run `python -m primordia`; modules of the current folder are imported only if a task names them."""

import sys

if not sys.flags.safe_path:
    del sys.path[0]

from primordia.cli import main

if __name__ == "__main__":
    main()
