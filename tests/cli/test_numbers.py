"""Numbers as values of options."""

import click
import pytest

from primordia.cli.numbers import COUNT, TICKS, Finite


@pytest.mark.parametrize(
    ("kind", "least", "most"),
    [(TICKS, 1, 2_147_483_647), (COUNT, 1, 65_536)],
    ids=["ticks", "count"],
)
def test_only_numbers_within_the_bounds_are_accepted(
    kind: click.IntRange, least: int, most: int
) -> None:
    for number in (least, most):
        assert kind.convert(str(number), None, None) == number
    for number in (least - 1, most + 1):
        with pytest.raises(click.BadParameter, match=str(number)):
            kind.convert(str(number), None, None)


def test_a_finite_number_is_a_number_in_its_range() -> None:
    kind = Finite(min=0, min_open=True, max=3)
    assert [kind.convert(text, None, None) for text in ("1e-9", "2", "3")] == [1e-9, 2.0, 3.0]
    for text in ("0", "3.1", "nan", "inf", "-inf", "x"):
        with pytest.raises(click.BadParameter, match=text):
            kind.convert(text, None, None)
    with pytest.raises(click.BadParameter, match="'inf' is not a finite number"):
        Finite().convert("inf", None, None)
