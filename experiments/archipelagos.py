"""Who fills the islands of an archipelago, who came from elsewhere, and are there generalists?

    python experiments/archipelagos.py experiments/archipelago/minatar.toml

The experiment must have been run (`primordia experiment`). In each world EACH late-born natives of each
island live again on every island, GAMES games of at most TICKS ticks without accidents; so do as many
founders. On the host, where a game takes a thousand times as long, FEWER play, and their results are kept
in the experiment's directory. The best founder of an island plays FRESH other games, since it was lucky
in those in which it was chosen. An organism masters an island if it lives there longer than this founder.
The line of one of the living is foreign if its ancestor at half of the ticks was born on another island.
What is not known of an island that died out is left empty. Two tables for each island, and one for each
world, go to `results/` beside the file.
"""

import zlib
from collections.abc import Callable
from pathlib import Path

import named
import numpy as np
from by_world import Row, measure

import primordia
from primordia.assays.transplant import everywhere
from primordia.history.series import spaced
from primordia.organism.playing.games import Players, lifespans_in_games
from primordia.organism.playing.players import founders_of, moved, players_of
from primordia.printable import counted
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from primordia.runs.records import Records

EACH, GAMES, FRESH, TICKS, LATE = 10, 3, 10, 1_000, 0.5
FEWER = 5, 1
"""EACH and GAMES on the host."""
NOTE = (
    "Natives: ticks that {} late-born natives of the island live there, in {} of at most"
    f" {TICKS:,} ticks. Best founder: the best of as many founders as natives of all islands, in"
    f" {FRESH} other games than those in which it was chosen."
    " Foreigners: natives of the other islands. Masters: organisms that live longer than the best"
    " founder. Foreign lines: share of the living whose ancestor at half of the ticks was born on"
    " another island."
)
OF_WORLDS = (
    "Of {} late-born natives of each island, in {} on each: the share that masters a number of"
    " islands, and the largest number that one organism masters."
)
OF_ORIGINS = (
    "Living: organisms at the end. From elsewhere: share of them whose first ancestor was born on"
    " another island. Founders: number of first ancestors that they have."
)


def report(file: Path) -> None:
    """Measure all arms of an experiment, and write the tables."""
    kept: dict[Path, list[_World]] = {}
    best: dict[int, np.ndarray] = {}

    def worlds(run: Records) -> list["_World"]:
        if run.path not in kept:
            kept[run.path] = [_World(run, world, best) for world in range(run.config.seeds)]
        return kept[run.path]

    def of(rows: Callable[["_World"], list[Row]]) -> Callable[[Records], list[Row]]:
        return lambda run: [row for each in worlds(run) for row in rows(each)]

    each, games = _sample(primordia.load(named.arms(file)[0]).opened())
    number = each, counted(games, "game")
    measure(file, "islands", of(_World.by_island), NOTE.format(*number))
    measure(file, "generalists", of(_World.generality), OF_WORLDS.format(*number))
    measure(file, "origins", of(_World.origins), OF_ORIGINS)


def _sample(run: Records) -> tuple[int, int]:
    """Return how many natives of each island play, and how many games on each."""
    return (EACH, GAMES) if run.habitat.kind == "jax" else FEWER


class _World:
    """The late-born natives and the founders of a world, on every island."""

    def __init__(self, run: Records, world: int, best: dict[int, np.ndarray]) -> None:
        """`best`: of each seed, since worlds of one seed have the same founders."""
        self._run, self._world, islands = run, world, run.config.islands
        lives, (each, self._games) = run.lives, _sample(run)
        late = np.flatnonzero(lives.late(LATE) & (lives.world == world))
        home = islands.of_cells(lives.cell[late])
        rows = np.concatenate([spaced(late[home == k], each) for k in range(islands.count)])
        self.home = islands.of_cells(lives.cell[rows])
        self.lived = self._kept(
            f"{run.path.name}-{world}-{zlib.crc32(rows.tobytes()):08x}-{self._games}-{TICKS}",
            lambda: everywhere(run, players_of(run, rows), world, self._games, TICKS),
        )
        if self.seed not in best:
            count = np.array([each * islands.count])
            best[self.seed] = self._kept(
                f"founders-{self.seed}-{count[0]}-{self._games}-{FRESH}-{TICKS}",
                lambda: self._in_fresh_games(founders_of(run, np.array([world]), count)[2]),
            )
        self.best = best[self.seed]
        self.mastered = self.lived > self.best

    def _kept(self, name: str, played: Callable[[], np.ndarray]) -> np.ndarray:
        """Return what was played before, or play it; on the host it is kept."""
        if self._run.habitat.kind == "jax":
            return played()
        file = self._run.path.parent / "played" / f"{name}.npy"
        if not file.exists():
            file.parent.mkdir(exist_ok=True)
            np.save(file, played())
        return np.load(file)

    def _in_fresh_games(self, founders: Players) -> np.ndarray:
        """Return the mean ticks that the best founder of each island lives there, float64 (K,)."""
        run, world = self._run, self._world
        chosen = everywhere(run, founders, world, self._games, TICKS).argmax(axis=0)
        seeds = wide(np.repeat(run.world_seeds[[world]], len(chosen)))
        keys = stream(seeds, Purpose.REBIRTH, wide(chosen))
        best, number = founders.take(chosen)._replace(keys=keys), np.array([world])
        games = 1 if best.deterministic else FRESH
        lived = [
            lifespans_in_games(moved(run, best.take(np.array([k])), number, k), games, TICKS).mean()
            for k in range(len(chosen))
        ]
        return np.array(lived)

    @property
    def seed(self) -> int:
        """The seed of the world."""
        return int(self._run.world_seeds[self._world])

    def by_island(self) -> list[Row]:
        """Return a row for each island."""
        until = int(self._run.lives.ended[self._living()].max())
        now, then = self._islands_of(self._line(until // 2))
        found: list[Row] = []
        for number, name in enumerate(self._run.config.islands.names):
            here = self.home == number
            lived, mastered = self.lived[:, number], self.mastered[:, number]
            best = self.best[number]
            row: Row = {
                "natives": _mean(lived[here]),
                "best founder": _mean(best),
                "natives / best founder": _mean(lived[here] / best),
                "foreigners": _mean(lived[~here]),
                "masters among natives": _mean(mastered[here]),
                "masters among foreigners": _mean(mastered[~here]),
                "foreign lines": _mean(then[now == number] != number),
            }
            found.append({"island": name, "seed": self.seed, **row})
        return found

    def origins(self) -> list[Row]:
        """Return a row for each island: how many live there, and where their first ancestors did."""
        line = self._line(-1)
        now, then = self._islands_of(line)
        found: list[Row] = []
        for number, name in enumerate(self._run.config.islands.names):
            here = now == number
            row: Row = {
                "living": int(here.sum()),
                "from elsewhere": _mean(then[here] != number),
                "founders": len(np.unique(line[here])),
            }
            found.append({"island": name, "seed": self.seed, **row})
        return found

    def generality(self) -> list[Row]:
        """Return how many islands natives master."""
        count = self.mastered.sum(axis=1)
        shares = {f"{k} or more": float((count >= k).mean()) for k in range(1, self.best.size + 1)}
        return [{"seed": self.seed, **shares, "most": int(count.max())}]

    def _living(self) -> np.ndarray:
        lives = self._run.lives
        return np.flatnonzero(~lives.died & (lives.world == self._world))

    def _line(self, tick: int) -> np.ndarray:
        """Return the row of the nearest ancestor of each of the living that was born up to a tick."""
        lives, line = self._run.lives, self._living().copy()
        while (young := (lives.born[line] > tick) & (lives.parent_row[line] >= 0)).any():
            line[young] = lives.parent_row[line[young]]
        return line

    def _islands_of(self, line: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the islands of the living, and of their ancestors."""
        lives, islands = self._run.lives, self._run.config.islands
        return islands.of_cells(lives.cell[self._living()]), islands.of_cells(lives.cell[line])


def _mean(values: np.ndarray) -> float | str:
    """Return a mean as it stands in a table; "" of nothing."""
    return round(float(np.mean(values)), 3) if np.size(values) else ""


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
