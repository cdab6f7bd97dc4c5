"""What do a reward and generations find with the same brains in the same habitat, in as many ticks?

    python experiments/baselines.py experiments/atari/pong.toml

Nothing has to be run before. The task is that of the experiment's first arm, and the reward is the length
of a life. Three methods search for long lives, each from SEEDS seeds: the longest-lived of random
founders, a genetic algorithm (Such et al. 2017, arXiv:1712.06567) and OpenAI's evolution strategy
(Salimans et al. 2017, arXiv:1703.03864; by evosax). Each may live as many ticks as the cells of one world
could in the experiment. A life begins with random bits that no other has, and is cut at LONGEST ticks.

What each method has chosen plays GAMES games in the ways of `games.py`; no game that chose it is among
them, unless all games of the task are the same. The table goes to `results/` beside the file, as Markdown
and CSV; if the experiment's own games are there, its organisms stand in the same table.

    python experiments/baselines.py --seed 0 --seeds 5 experiments/atari/pong.toml
    python experiments/baselines.py --reward score experiments/robots/halfcheetah-ratchet.toml

The first prints the same for other seeds and writes no table. The second rewards the score of the game
of which the task is made, without hunger, in its first SHORT ticks. It writes a table of its own.
`--method` leaves the other methods out. Each search is kept in `results/searches`, or in `runs/searches`
if its seed is below 1,000. So an interrupted command goes on where it was. A search is made again if the
task's settings change; delete its file after changes of this script.

The strategy's settings below were chosen in a few trials on seeds below 1,000 of MinAtar. CartPole's
table, which names its settings, is older.
"""

import argparse
import json
import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path
from typing import Any, NamedTuple
from zlib import crc32

import jax
import numpy as np
import optax
import pandas as pd
from evosax.algorithms import Open_ES
from founders import per_weight
from games import GAMES, WAYS, write_rows

from primordia import device
from primordia.comparison.tables import spread_text
from primordia.config import Config
from primordia.experiments.file import read
from primordia.experiments.results import table
from primordia.files import write_text
from primordia.law.genesis import initial_climate
from primordia.law.metabolism import Rates
from primordia.organism.playing.evaluation import judged
from primordia.organism.playing.games import Players, lifespans, play
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide

SEED, SEEDS = 1000, 10
LONGEST = 20_000
"""Ticks at which a life is cut, in the search and in games."""
SHORT = 250
"""Ticks at which a game is cut in which the score is rewarded."""
POPULATION, PARENTS = 256, 10
"""Genomes of a generation; the longest-lived of them that have children, in the genetic algorithm."""
AGAIN = 5
"""Further lives of each parent, which choose the elite, where lives are not all the same."""
SPREAD, RATE = 0.3, 0.05
"""The evolution strategy's noise and Adam's rate, in standard deviations of founders' weights."""
COLUMNS = ("lifespan", "score", "length")
WORDS = {"life": "length of life", "score": "score of the game that the task is made of"}
"""The rewards."""


class Search:
    """A task's habitat and brains, and the ticks that one search may still live."""

    def __init__(self, config: Config, seed: int, ticks: int, reward: str) -> None:
        """Take the task's settings, the seed of all random bits, the ticks of all lives together, and
        the reward, `life` or `score`."""
        self.config, self.seed, self.ticks, self.reward = config, seed, ticks, reward
        self.law = config.build_law(config.build_habitat())
        self.noise = np.random.default_rng(seed)
        self.founders_scale = per_weight(self.law, "founder_scale")
        self.lived = self.lives = 0

    @property
    def over(self) -> bool:
        """Whether all ticks have been lived."""
        return self.lived >= self.ticks

    @property
    def repeats(self) -> bool:
        """Whether all lives of a genome are the same."""
        return self.players(np.zeros((1, len(self.founders_scale)))).deterministic

    def founders(self, count: int) -> np.ndarray:
        """Return new founders, float32 (count, P)."""
        return self.founders_scale * self.noise.standard_normal((count, len(self.founders_scale)))

    def rewards(self, genomes: np.ndarray) -> np.ndarray:
        """Let each genome (K, P) live once, or play the game, and return the reward (K,)."""
        players = self.players(genomes)
        if self.reward == "score":
            game = players.habitat.original()
            players = players._replace(habitat=game, law=replace(players.law, metabolism=None))
            games = play(players, 1, SHORT)
            ticks, found = games.ticks[:, 0], games.food[:, 0]
        else:
            ticks = found = lifespans(players, LONGEST)
        self.lived, self.lives = self.lived + int(ticks.sum()), self.lives + len(genomes)
        return found

    def players(self, genomes: np.ndarray) -> Players:
        """Return genomes as players; their random bits follow from the number of lives before."""
        numbers = wide(self.lives + np.arange(len(genomes)))
        keys = stream(wide(np.full(len(genomes), self.seed)), Purpose.EVALUATION, numbers)
        rates = Rates.of(initial_climate(self.law, len(genomes)))
        habitat = self.config.build_habitat()
        return Players(self.law, habitat, genomes.astype(np.float32), keys, rates)


def best_founder(search: Search) -> np.ndarray:
    """Return the best of as many founders as the ticks suffice for."""
    best, highest = search.founders(1)[0], -np.inf
    while not search.over:
        some = search.founders(POPULATION)
        found = search.rewards(some)
        if found.max() > highest:
            best, highest = some[found.argmax()], found.max()
    return best


def genetic_algorithm(search: Search) -> np.ndarray:
    """Return the elite of the last generation; all children are mutants by the task's own mutation."""
    scales, density = per_weight(search.law, "scale"), search.law.heredity.mutation.density
    choice = np.random.default_rng([search.seed, 1])
    generation = search.founders(POPULATION)
    found = search.rewards(generation)
    while True:
        parents = generation[np.argsort(-found, kind="stable")[:PARENTS]]
        elite = parents[0] if search.repeats else parents[again(search, parents).argmax()]
        if search.over:
            return elite
        chosen = parents[search.noise.integers(PARENTS, size=POPULATION - 1)]
        changes = scales * search.noise.standard_normal(chosen.shape)
        children = chosen + np.where(choice.random(chosen.shape) < density, changes, 0)
        generation = np.concatenate([elite[None], children])
        found = search.rewards(generation)


def again(search: Search, genomes: np.ndarray) -> np.ndarray:
    """Let genomes (K, P) live or play AGAIN times each and return their mean rewards (K,)."""
    return search.rewards(np.repeat(genomes, AGAIN, axis=0)).reshape(-1, AGAIN).mean(axis=1)


def evolution_strategy(search: Search) -> np.ndarray:
    """Return the last mean of the strategy, which begins with a founder."""
    start = search.founders(1)[0] / search.founders_scale
    strategy = Open_ES(
        POPULATION,
        start,
        optimizer=optax.adam(RATE),
        std_schedule=optax.constant_schedule(SPREAD),
    )
    key = jax.random.key(search.seed)
    state = strategy.init(key, start, strategy.default_params)
    while not search.over:
        key, to_ask, to_tell = jax.random.split(key, 3)
        asked, state = strategy.ask(to_ask, state, strategy.default_params)
        found = search.rewards(search.founders_scale * np.asarray(asked))
        # evosax minimises.
        state, _ = strategy.tell(to_tell, asked, -found, state, strategy.default_params)
    return search.founders_scale * np.asarray(state.mean)


METHODS: dict[str, Callable[[Search], np.ndarray]] = {
    "random founders": best_founder,
    "genetic algorithm": genetic_algorithm,
    "evolution strategy": evolution_strategy,
}


class Trial(NamedTuple):
    """One search."""

    file: Path
    method: str
    seed: int
    reward: str


def rows_of(trial: Trial) -> list[dict[str, Any]]:
    """Return what a search found, a row for each way of playing; it is kept for the next time."""
    folder = trial.file.parent / "results" if trial.seed >= SEED else Path("runs")
    of = "" if trial.reward == "life" else f"{trial.reward}-"
    name = f"{trial.file.stem}-{of}{trial.method.replace(' ', '-')}-{trial.seed}.json"
    kept = folder / "searches" / name
    settings = signature(reference(trial.file))
    known = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
    if known.get("settings") != settings:
        known = {"settings": settings, "rows": searched(trial)}
        kept.parent.mkdir(parents=True, exist_ok=True)
        write_text(kept, json.dumps(known) + "\n")
    return known["rows"]


def signature(config: Config) -> str:
    """Return a checksum of what a search depends on: all settings, but cells and ticks as a product."""
    cells = Config.model_fields["cells"].default
    stop = config.stop.model_copy(update={"ticks": budget(config) // cells})
    one = config.model_copy(update={"cells": cells, "stop": stop})
    return f"{crc32(one.to_toml().encode()):08x}"


def budget(config: Config) -> int:
    """Return the organism-ticks of a world whose cells are always full."""
    return config.cells * (config.stop.ticks or 0)


def searched(trial: Trial) -> list[dict[str, Any]]:
    """Search, let the chosen genome play, and return a row for each way of playing."""
    device.prepare()
    config = reference(trial.file)
    search = Search(config, trial.seed, budget(config), trial.reward)
    players = search.players(METHODS[trial.method](search)[None])
    who = {"who": trial.method, "seed": trial.seed, "lives": search.lives, "ticks": search.lived}
    rows = []
    for way, options in WAYS[str(config.habitat["name"])].items():
        how = {"senses": "live", "habitat": {}, "games": GAMES, "ticks": LONGEST} | options
        found = judged(config, players, [(0, 0)], **how)[0].to_dict()
        medians = {name: round(found[name]["median"], 2) for name in COLUMNS if name in found}
        rows.append({**who, "way": way, **medians})
    return rows


def reference(file: Path) -> Config:
    """Return the settings of an experiment's first arm."""
    return read(file, Path("runs", file.stem)).arms[0].config


def searches(
    file: Path, seed: int, seeds: int, reward: str, methods: list[str]
) -> list[dict[str, Any]]:
    """Return the rows of methods from a number of seeds, on all cores."""
    trials = [Trial(file, method, seed + k, reward) for k in range(seeds) for method in methods]
    os.environ["PRIMORDIA_CORES"] = "1"
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        return [row for rows in pool.map(rows_of, trials) for row in rows]


def summary(file: Path, rows: pd.DataFrame, reward: str) -> str:
    """Return a table of medians and quartiles over seeds, beside the experiment's organisms."""
    lines = []
    beside = evolved(file, rows)
    for (who, way), group in pd.concat([rows, beside]).groupby(["who", "way"], sort=False):
        cells = [spread_text(group[name].tolist()) for name in COLUMNS if name in rows]
        ticks = spread_text(group["ticks"].tolist()) if group["ticks"].notna().all() else ""
        lines.append([who, way, len(group), ticks, *cells])
    seeds = f"{rows.seed.min()} to {rows.seed.max()}"
    cut = f", and games that were rewarded at {SHORT}" if reward == "score" else ""
    note = (
        f"Medians over seeds {seeds} (quartiles) of the median of {GAMES} games, or of the one game where"
        f" nothing is drawn at random. The reward is the {WORDS[reward]}. Lives and games were cut at"
        f" {LONGEST:,} ticks{cut}. Generations have {POPULATION} genomes; the genetic algorithm has"
        f" {PARENTS} parents and the task's mutation; the strategy's noise is {SPREAD:g} of founders' and"
        f" Adam's rate {RATE:g}. Rows without ticks are worlds of the experiment with these seeds."
    )
    head = ["who", "plays", "seeds", "ticks lived", *(name for name in COLUMNS if name in rows)]
    return f"{table(head, lines)}\n\n{note}"


def evolved(file: Path, rows: pd.DataFrame) -> pd.DataFrame:
    """Return games of the experiment's first arm and of its founders, in the seeds and ways of rows."""
    games = file.parent / "results" / f"{file.stem}-games.csv"
    if not games.exists():
        return rows[:0]
    known, arm = pd.read_csv(games), read(file, Path("runs", file.stem)).arms[0].name
    names = [f"{arm}: champion", f"{arm}: all alive", "best founder", "founder"]
    return known[known.who.isin(names) & known.seed.isin(rows.seed) & known.way.isin(rows.way)]


def main() -> None:
    """Search for each experiment that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("files", nargs="+", type=Path, help="experiments")
    parser.add_argument("--seed", type=int, default=SEED, help="the first seed")
    parser.add_argument("--seeds", type=int, default=SEEDS, help="number of seeds of each method")
    parser.add_argument("--reward", choices=WORDS, default="life")
    parser.add_argument("--method", choices=METHODS, action="append", help="one of the methods")
    own = parser.parse_args()
    for file in own.files:
        rows = searches(file, own.seed, own.seeds, own.reward, own.method or [*METHODS])
        text = summary(file, pd.DataFrame(rows), own.reward)
        print(text)
        if (own.seed, own.seeds) == (SEED, SEEDS):
            of = "baselines" if own.reward == "life" else f"{own.reward}-baselines"
            write_rows(file.parent / "results" / f"{file.stem}-{of}", rows, text)


if __name__ == "__main__":
    main()
