"""`python -m primordia`: it imports modules of the current folder only if a task names them."""

import sys

if not sys.flags.safe_path:
    del sys.path[0]

from primordia.cli import main

if __name__ == "__main__":
    main()
