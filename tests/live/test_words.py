"""The pages that explain words and keys."""

from itertools import pairwise

import pytest

from primordia.law.world import Cause
from primordia.live.panel import Outlook, numbers
from primordia.live.words import KEYS, OF_ISLANDS, WORDS, keys, pages
from tests.live.drawn import text
from tests.live.posed import counted


@pytest.mark.parametrize("islands", [False, True])
@pytest.mark.parametrize("size", [(120, 40), (60, 12), (10, 1)])
def test_pages_have_each_word_once_in_order_and_no_page_has_room_for_the_next(
    size: tuple[int, int], islands: bool
) -> None:
    """A page is higher than its room only if it has a single word."""
    width, height = size
    found = [text(page) for page in pages(width, height, islands)]
    assert all(found), "no page is empty"
    names = [[name for row in page if (name := row[:18].strip())] for page in found]
    assert [name for own in names for name in own] == [
        *(key for key, *_ in KEYS),
        *WORDS,
        *(OF_ISLANDS if islands else ()),
    ]
    (whole,) = (text(page) for page in pages(width, 10**6, islands))
    assert [row for page in found for row in page] == whole
    assert max(map(len, whole)) <= max(min(width, 100), 26)
    assert all(len(page) <= height or len(own) == 1 for page, own in zip(found, names, strict=True))
    for page, following in pairwise(found):
        entry = next((n for n, row in enumerate(following) if n and row[0] != " "), len(following))
        assert len(page) + entry > height
        assert following[0][0] != " ", "no word is divided"


def test_only_the_given_keys_are_named() -> None:
    """The first character of `space` is an s, too."""
    assert text([keys("s-o?q")]) == ["space pause  s step  -+ speed  o organism  ? words  q quit  "]


def test_every_number_and_every_cause_of_death_is_explained() -> None:
    named = numbers(counted(), 8, Outlook(1.0, 9.0), 1)
    assert {*named, *(cause.label for cause in Cause)} <= {*WORDS}
