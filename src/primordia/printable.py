"""Printable text: escapes for control characters, so that no name can act on a terminal; counts."""

KEPT = "\n\t"
"""Control characters that are kept, since they lay out text."""


def printable(text: str, kept: str = KEPT) -> str:
    r"""Return a text in which each character that cannot be shown is an escape, such as `\x1b`."""
    if text.isprintable():
        return text
    return "".join(
        each if each.isprintable() or each in kept else repr(each)[1:-1] for each in text
    )


def counted(number: int, noun: str) -> str:
    """Return a number with its noun, such as `1 world` or `2,000 worlds`."""
    return f"{number:,} {noun}{'' if number == 1 else 's'}"


def often(times: int) -> str:
    """Return how often something has happened, such as `once` or `3 times`."""
    return "once" if times == 1 else f"{times:,} times"
