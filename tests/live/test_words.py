"""The pages that explain words and keys."""

from itertools import pairwise

import pytest

from primordia.law.world import Cause
from primordia.live.panel import KEYS as NAMED
from primordia.live.panel import Outlook, numbers
from primordia.live.words import KEYS, WORDS, pages
from tests.live.drawn import text
from tests.live.posed import counted


@pytest.mark.parametrize("size", [(120, 40), (100, 21), (60, 12), (20, 5), (10, 1)])
def test_pages_have_each_word_once_in_order_and_no_page_has_room_for_the_next(
    size: tuple[int, int],
) -> None:
    width, height = size
    found = [text(page) for page in pages(width, height)]
    assert all(found), "no page is empty"
    names = [row[:18].strip() for page in found for row in page]
    assert [name for name in names if name] == [*KEYS, *WORDS]
    (whole,) = (text(page) for page in pages(width, 10**6))
    assert [row for page in found for row in page] == whole
    assert max(map(len, whole)) <= max(min(width, 100), 26)
    for page, following in pairwise(found):
        entry = next((n for n, row in enumerate(following) if n and row[0] != " "), len(following))
        assert len(page) + entry > height
        assert following[0][0] != " ", "no word is divided"


def test_every_key_that_is_named_is_explained() -> None:
    explained = {"-+" if key == "- and +" else key for key in KEYS}
    assert explained == {key for key, _ in NAMED}


def test_every_number_and_every_cause_of_death_is_explained() -> None:
    named = numbers(counted(), 8, Outlook(1.0, 9.0), 1)
    assert {*named, *(cause.label for cause in Cause)} <= {*WORDS}


@pytest.mark.parametrize(("width", "height"), [(120, 40), (80, 24), (60, 15)])
def test_pages_fit_into_their_room(width: int, height: int) -> None:
    for page in pages(width, height):
        assert len(page) <= height
        assert max(map(len, text(page))) <= width
