"""Errors that are told to the user in one line, without a traceback."""


class InputError(Exception):
    """What the user asked for cannot be done as asked; exit status 2."""


class Trouble(Exception):  # noqa: N818
    """Something outside went wrong, such as a full disk; nothing recorded is lost; exit status 1."""
