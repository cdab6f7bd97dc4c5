"""How long do founders live, and how much of it do their mutants inherit?

Short trials. They choose the scales of weights before a run evolves anything.

    python experiments/founders.py experiments/atari/founders/*.toml

A file has a `question`, the settings that all arms share, and `[[arms]]` with other settings of
`[mutation]`. In each arm many founders live once, alone; then mutants of the longest-lived founders live
once. The realised heritability of lifespan is the gain of the mutants over the gain of their parents,
both measured from the mean founder (Falconer & Mackay 1996, chapter 11). It is 1 if mutants live as long
as their parents, and 0 if they live as long as founders. The table goes to `results/` beside the folder.
"""

import tomllib
from pathlib import Path
from typing import Any

import named
import numpy as np

from primordia import config
from primordia.config import Config
from primordia.experiments.results import table
from primordia.law.genesis import initial_climate
from primordia.law.law import Law
from primordia.law.metabolism import Rates
from primordia.organism.playing.games import Players, play
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from primordia.settings.tables import merged

FOUNDERS, PARENTS, MUTANTS = 512, 16, 16
TICKS = 8_000
HEAD = ("", "founders: median", "mean", "longest", "parents: mean", "mutants: mean", "heritability")


def report(file: Path) -> None:
    """Run the trial of each arm of a file and write the table."""
    values = tomllib.loads(file.read_text(encoding="utf-8"))
    question, arms = values.pop("question"), values.pop("arms")
    rows = [trial(arm.pop("name"), merged(values, arm)) for arm in arms]
    note = (
        f"{FOUNDERS} founders lived once each; {MUTANTS} mutants each of the {PARENTS} that lived"
        f" longest. Lives were cut at {TICKS:,} ticks."
    )
    path = file.parent.parent / "results" / f"{file.stem}-founders.md"
    path.parent.mkdir(exist_ok=True)
    path.write_text(f"# {question}\n\n{table(list(HEAD), rows)}\n\n{note}\n", encoding="utf-8")
    print(path)


def trial(name: str, settings: dict[str, Any]) -> list[str]:
    """Run the trial of one arm and return its row of the table."""
    chosen = config.load(settings.pop("task"), settings)
    law = chosen.build_law(chosen.build_habitat())
    scales, spread = per_weight(law, "scale"), per_weight(law, "founder_scale")
    noise = np.random.default_rng(0)
    founders = spread * noise.standard_normal((FOUNDERS, len(scales)))
    lived = lifespans(chosen, founders)
    best = np.argsort(-lived, kind="stable")[:PARENTS]
    steps = scales * noise.standard_normal((PARENTS * MUTANTS, len(scales)))
    mutants = lifespans(chosen, np.repeat(founders[best], MUTANTS, axis=0) + steps, FOUNDERS).mean()
    advantage = lived[best].mean() - lived.mean()
    heritability = (mutants - lived.mean()) / advantage if advantage else np.nan
    ticks = (np.median(lived), lived.mean(), lived.max(), lived[best].mean(), mutants)
    row = [name, *(f"{value:,.0f}" for value in ticks), f"{heritability:.2f}"]
    print(*row, flush=True)
    return row


def per_weight(law: Law, field: str) -> np.ndarray:
    """Return a setting of the mutation for each weight of a genome, float32 (P,)."""
    return np.repeat(
        np.array(law.heredity.mutation.per_block(field, law.heredity.layout), np.float32),
        law.heredity.layout.sizes,
    )


def lifespans(chosen: Config, genomes: np.ndarray, first: int = 0) -> np.ndarray:
    """Return the lifespans in ticks (K,) of organisms with these genomes (K, P), one life each.

    Organisms are numbered from `first`. Their random draws follow from their numbers.
    """
    habitat, numbers = chosen.build_habitat(), first + np.arange(len(genomes))
    law = chosen.build_law(habitat)
    keys = stream(wide([chosen.seed]), Purpose.EVALUATION, wide(numbers))
    rates = Rates.of(initial_climate(law, len(genomes)))
    players = Players(law, habitat, genomes.astype(np.float32), keys, rates)
    return play(players, 1, TICKS).ticks[:, 0]


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
