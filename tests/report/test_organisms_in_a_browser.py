"""Organisms in the page: how a user finds one, and what its card shows."""

import re
from pathlib import Path

import numpy as np
from selenium.webdriver.common.keys import Keys

from primordia.law.world import BirthCause, Cause
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives
from tests.pedigrees import line_to
from tests.report.browser import Page

ORIGINS = {
    BirthCause.FOUNDER: "a founder",
    BirthCause.COPY: "an exact copy",
    BirthCause.MUTANT: "with mutations",
}
CARD = """
document.getElementById("number").value = arguments[0];
document.querySelector("aside form").requestSubmit();
return [...document.querySelectorAll(".organism dl > *")].map((each) => each.textContent.trim());
"""


def card_of(lives: Lives, row: int) -> dict[str, str]:
    """Return the words that belong on the card of an organism, from the records."""
    born, ended = int(lives.born[row]), int(lives.ended[row])
    children = [int(each) for each in lives.id[lives.parent == lives.id[row]]]
    listed = ", ".join(f"{each:,}" for each in children[:10]) + (", …" if children[10:] else "")
    dead = bool(lives.died[row])
    state = f"tick {ended:,}, {Cause(int(lives.cause[row])).label}" if dead else "alive"
    return {
        "Born": f"tick {born:,}, {ORIGINS[BirthCause(int(lives.birth_cause[row]))]}",
        "Cell": f"{lives.cell[row]:,}",
        "Lived" if dead else "Age": f"{ended - born:,} ticks",
        "Died" if dead else "State": state,
        "Parent": f"{lives.parent[row]:,}" if lives.parent[row] >= 0 else "none",
        "Generation": str(len(line_to(lives, row)) - 1),
        "Children": f"{len(children)}: {listed}" if children else "0",
    }


def test_the_card_of_an_organism_shows_its_whole_record(
    torus: Path, torus_page: Path, page: Page
) -> None:
    """The cards are of founders, of the dead by each cause, of the living and of parents of many."""
    page.open_file(torus_page)
    lives = Archive(torus).lives.of_world(0)
    counts = np.bincount(lives.parent_row[lives.parent_row >= 0], minlength=len(lives))
    rows = {0, 1, int(counts.argmax()), int(lives.lifespan.argmax()), len(lives) - 1}
    rows |= {int(np.flatnonzero(lives.cause == cause)[-1]) for cause in set(lives.cause.tolist())}
    for row in sorted(rows):
        words = page.script(CARD, int(lives.id[row]))
        assert dict(zip(words[::2], words[1::2], strict=True)) == card_of(lives, row)
    first, longest = page.all(".organism .bar button")[:2]
    for button, row in ((first, 0), (longest, int(lives.lifespan.argmax()))):
        button.click()
        assert page.text(".organism h3") == f"Organism {lives.id[row]:,}"


def test_a_click_on_a_cell_shows_its_organism_and_lights_its_line(
    cart: Path, cart_page: Path, page: Page
) -> None:
    lives = Archive(cart).lives
    page.open_file(cart_page)
    canvas = page.one(".ground canvas")
    before = page.picture(canvas)
    page.hover(canvas, 0.5, 0.7)
    readout = re.fullmatch(
        r"cell (\d+), birth ([\d,]+), tick ([\d,]+): organism ([\d,]+), age ([\d,]+)",
        page.text(".ground .readout"),
    )
    assert readout, page.text(".ground .readout")
    cell, birth, tick, number, age = (int(each.replace(",", "")) for each in readout.groups())
    row = lives.row(number)
    assert lives.cell[row] == cell
    assert lives.born[birth - 1] == tick
    assert tick - lives.born[row] == age
    page.click(canvas, 0.5, 0.7)
    assert page.text(".organism h3") == f"Organism {number:,}"
    assert page.picture(canvas) != before, "its line is lit"
    assert page.script("return document.activeElement === arguments[0]", canvas)
    are_found_by_number_and_by_their_relatives(lives, page)


def are_found_by_number_and_by_their_relatives(lives: Lives, page: Page) -> None:
    row = int(np.flatnonzero(lives.parent_row >= 0)[-1])
    page.one("#number").send_keys(str(lives.id[row]), Keys.ENTER)
    assert page.text(".organism h3") == f"Organism {lives.id[row]:,}"
    page.one(".organism button.link").click()
    assert page.text(".organism h3") == f"Organism {lives.parent[row]:,}"
    page.one("#number").send_keys("999999", Keys.ENTER)
    assert "No such organism" in page.text(".organism h3")
