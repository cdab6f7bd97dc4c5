"""What are founders worth, and how much of it do their mutants inherit? Short trials, by which scales of
weights are chosen before anything is left to evolve.

    python experiments/founders.py experiments/atari/founders/*.toml

A file has a `question`, the settings that all arms share, and `[[arms]]` with other settings of
`[mutation]`. In each arm many founders live once, alone; then mutants of the longest-lived do. How much
longer these live than founders, over how much longer their parents lived, is the realised heritability
of lifespan (Falconer & Mackay 1996, chapter 11): 1 if mutants live as long as their parents, 0 if they
might as well be founders. The table goes to `results/` beside the folder.
"""

import tomllib
from pathlib import Path
from typing import Any

import files
import numpy as np

from primordia import config
from primordia.config import Config
from primordia.law.genesis import climate
from primordia.organism.games import Players, play
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from primordia.settings.tables import merged
from results import table

FOUNDERS, PARENTS, MUTANTS = 512, 16, 16
TICKS = 8_000
HEAD = ("", "founders: median", "mean", "longest", "parents: mean", "mutants: mean", "heritability")


def report(file: Path) -> None:
    """Let all live, and write what came out."""
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
    """A row of the table."""
    chosen = config.load(settings.pop("task"), settings)
    law = chosen.build_law(chosen.build_habitat())
    scales, spread = (
        np.repeat(np.array(law.mutation.per_block(field, law.layout), np.float32), law.layout.sizes)
        for field in ("scale", "founder_scale")
    )
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


def lifespans(chosen: Config, genomes: np.ndarray, first: int = 0) -> np.ndarray:
    """Of organisms with these genomes (K, P), numbered from `first`, one life each: (K,)."""
    habitat, numbers = chosen.build_habitat(), first + np.arange(len(genomes))
    law = chosen.build_law(habitat)
    keys = stream(wide([chosen.seed]), Purpose.EVALUATION, wide(numbers))
    rates = climate(law, len(genomes)).metabolism
    players = Players(law, habitat, genomes.astype(np.float32), keys, rates)
    return play(players, 1, TICKS).ticks[:, 0]


if __name__ == "__main__":
    files.each(report, __doc__)
