"""A process that plays a game in one way, on request: `hosted.py` and `jobs.py` compare several of them.

    python benchmarks/contender.py WAY GAME CELLS WORLDS

It first writes a line of JSON that says that it is ready, or what it lacks. It then reads lines such as
`play 1.5`, which asks for 1.5 seconds of play, and answers each with a line of JSON. It ends when its
standard input ends. JAX is loaded late, since Gymnasium forks.
"""

import json
import os
import sys
from collections.abc import Callable
from functools import partial
from typing import Any

from contenders import arcade, environments, robots
from contenders.loop import ENVIRONMENTS, NO_DEATH, ROBOTS, TASKS, Lacking, Loop


def _ours(game: str, cells: int, worlds: int) -> Any:
    from hosted_world import Ours

    return Ours(TASKS[game], cells, NO_DEATH[game], worlds)


def _gymnasium(mode: str, game: str, cells: int) -> Loop:
    if game in ENVIRONMENTS:
        return environments.Gymnasium(mode, game, cells)
    return (robots if game in ROBOTS else arcade).Gymnasium(mode, game, cells)


def _envpool(game: str, cells: int) -> Loop:
    return (robots if game in ROBOTS else arcade).Pool(game, cells)


OTHERS: dict[str, Callable[[str, int], Any]] = {
    "bare": arcade.Bare,
    "in step": arcade.InStep,
    "batch": robots.Batch,
    "async": partial(_gymnasium, "async"),
    "sync": partial(_gymnasium, "sync"),
    "published": arcade.Published,
    "envpool": _envpool,
}
"""Ways of playing with as many cells as our worlds have together."""


def main() -> None:
    """Prepare the way of playing, then answer requests until standard input ends."""
    way, game, *numbers = sys.argv[1:]
    cells, worlds = map(int, numbers)
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)  # what libraries print is not an answer
    try:
        ours = way == "ours"
        player = _ours(game, cells, worlds) if ours else OTHERS[way](game, cells * worlds)
    except Lacking as lacking:
        print(json.dumps({"not available": str(lacking)}), file=answers)
        return
    player.play(0.5)
    print(json.dumps({"about": player.about}), file=answers)
    for line in sys.stdin:
        request, seconds = line.split()
        print(json.dumps(getattr(player, request)(float(seconds))), file=answers)


if __name__ == "__main__":
    main()
