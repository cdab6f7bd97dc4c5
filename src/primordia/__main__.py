"""`python -m primordia`."""

from primordia.cli import main

if __name__ == "__main__":
    main()
