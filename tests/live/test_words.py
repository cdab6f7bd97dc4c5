"""The pages that explain words and keys."""

from itertools import pairwise

import pytest

from primordia.live.panel import KEYS as NAMED
from primordia.live.words import KEYS, WORDS, pages
from tests.live.drawn import text


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
