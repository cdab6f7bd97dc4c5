"""What impure parts give: a number that differs from call to call."""

CALLS: list[int] = []


def counted() -> int:
    """Return the number of calls so far."""
    CALLS.append(0)
    return len(CALLS)
