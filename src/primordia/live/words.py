"""The words of the live view, explained."""

from textwrap import wrap

from rich.segment import Segment

from primordia.live.paint import FAINT, Row
from primordia.live.panel import STRONG

NAME = 18
"""columns of a word, with the gap after it"""
WIDE = 100
"""largest number of columns of a word with its explanation"""
KEYS = (
    ("space", "pause", "Pause, or go on."),
    ("s", "step", "Live one tick, and pause."),
    ("- and +", "speed", "Go slower or faster. Full speed has no limit."),
    ("w", "world", "Show one world alone, then the next world, then all worlds again."),
    ("o", "organism", "Show the oldest organism beside the world, or hide it."),
    ("n", "next", "Show the next organism, from the oldest to the youngest."),
    ("?", "words", "Show these words, then the next page, then the world again."),
    ("q", "quit", "Write a checkpoint and stop the run, as Ctrl-C does."),
)
"""Each key with its name and its explanation."""
WORDS = {
    "tick": "One step of time: each organism senses and acts once.",
    "alive": "Living organisms, and the number of cells. A cell holds at most one organism.",
    "births": "Organisms born so far, founders included.",
    "deaths": "Organisms that have died so far. The row `died of` lists the causes.",
    "mean age": "Mean age of the living, in ticks.",
    "oldest": "Age of the oldest of the living, in ticks.",
    "line of descent": "Organisms that descend from one organism at an earlier moment. A line has"
    " one colour.",
    "branch": "Organisms that descend from one child of a founder.",
    "takeovers": "How often only one line was left, so that all the living descend from one ancestor.",
    "extinctions": "How often no organism was alive. Life then begins again with new founders.",
    "organism-ticks/s": "Ticks lived by the organisms of all worlds together in a second of your time.",
    "time left": "Time until the last world reaches its limit, at the present speed.",
    "calm": "Ticks for which a world has been full, without births and deaths; calmest: of all worlds.",
    "saturated": "The world has been calm for the number of ticks that the task demands.",
    "fatal": "A death because the task's own condition was met, such as a fallen pole.",
    "starved": "A death because the energy reached 0.",
    "hazard": "A death by chance, at the rate of the setting `hazard`.",
    "replaced": "A death because a neighbour's child took the cell.",
    "time-limit": "A death because the task ends a life after some ticks.",
    "fault": "A death because the simulation or the brain failed, or gave a number that is not finite.",
    "restart": "A death because the run was resumed without the body of the organism.",
    "energy": "What an organism needs to live. Life and actions take energy; food gives energy.",
    "senses": "What the organism perceives: a bar for each sense, lowest at -1, highest at 1.",
    "memory": "What the brain keeps from tick to tick, drawn as the senses are.",
    "does next": "The action that the brain chooses from these senses.",
    "outputs": "What the brain puts out for this action: a bar for each output; bright ones act.",
    "fast weights": "What the organism has learned, a row for each output: blue -, red +.",
    "changes": "How long ago the organism's world changed, if that is new; a frame shows it too.",
}

OF_ISLANDS = {
    "on NAME": "Living organisms on an island, and the number of its cells.",
    "island": "A part of the world's cells with a habitat and rates of its own.",
}


def keys(shown: str) -> Row:
    """Return the keys with their names; `shown` has the first characters of those that mean something
    now."""
    known = [(key.replace(" and ", ""), name) for key, name, _ in KEYS if key[0] in shown]
    return [
        part for key, name in known for part in (Segment(key, STRONG), Segment(f" {name}  ", FAINT))
    ]


def pages(width: int, height: int, islands: bool = False) -> list[list[Row]]:
    """Return pages of keys and words with their explanations; `height` limits the rows of a page.

    The words on islands are left out if the world has none.
    """
    room = max(min(width, WIDE) - NAME, 8)
    found: list[list[Row]] = [[]]
    keys_too = {key: text for key, _, text in KEYS}
    for name, text in {**keys_too, **WORDS, **(OF_ISLANDS if islands else {})}.items():
        lines = wrap(text, room)
        if len(found[-1]) + len(lines) > height and found[-1]:
            found.append([])
        for number, line in enumerate(lines):
            left = name if number == 0 else ""
            found[-1].append([Segment(f"{left:<{NAME}}", STRONG), Segment(line, FAINT)])
    return found
