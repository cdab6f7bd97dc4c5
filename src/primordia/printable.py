"""Printable text: control characters are escaped, so that no name can act on a terminal."""

KEPT = "\n\t"
"""Control characters that are kept, since they lay out text."""


def printable(text: str, kept: str = KEPT) -> str:
    r"""Return a text in which each character that cannot be shown is an escape, such as `\x1b`."""
    if text.isprintable():
        return text
    return "".join(
        each if each.isprintable() or each in kept else repr(each)[1:-1] for each in text
    )
