"""Errors that the user sees as one line, without a traceback."""


class InputError(Exception):
    """The user's request cannot be carried out and must be changed; exit status 2."""


class InUseError(InputError):
    """Another process is writing the same run."""


class Trouble(Exception):  # noqa: N818
    """Something outside the program failed, such as a full disk; records are safe; exit status 1."""
