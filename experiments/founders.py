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
from primordia.keys import Purpose, stream
from primordia.law.genesis import climate
from primordia.organism.games import Player, play
from primordia.wide import wide
from results import table

FOUNDERS, PARENTS, MUTANTS = 512, 16, 16
AT_ONCE = 128
TICKS = 8_000
HEAD = ("", "founders: median", "mean", "longest", "parents: mean", "mutants: mean", "heritability")


def report(file: Path) -> None:
    """Let all live, and write what came out."""
    values = tomllib.loads(file.read_text(encoding="utf-8"))
    question, arms = values.pop("question"), values.pop("arms")
    rows = [trial(arm.pop("name"), config.merged(values, arm)) for arm in arms]
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
    player, scales = alone(settings)
    noise = np.random.default_rng(0)
    length = len(player.law.founder_scale)
    founders = player.law.founder_scale * noise.standard_normal((FOUNDERS, length))
    lived = lifespans(player, founders)
    best = np.argsort(-lived, kind="stable")[:PARENTS]
    steps = scales * noise.standard_normal((PARENTS * MUTANTS, length))
    mutants = lifespans(player, np.repeat(founders[best], MUTANTS, axis=0) + steps).mean()
    heritability = (mutants - lived.mean()) / (lived[best].mean() - lived.mean())
    ticks = (np.median(lived), lived.mean(), lived.max(), lived[best].mean(), mutants)
    row = [name, *(f"{value:,.0f}" for value in ticks), f"{heritability:.2f}"]
    print(*row, flush=True)
    return row


def alone(settings: dict[str, Any]) -> tuple[Player, np.ndarray]:
    """Somebody without a genome yet, and the scale of mutations of each weight, (P,)."""
    shared = {key: value for key, value in settings.items() if key != "task"}
    chosen = config.load(settings["task"], shared)
    habitat = chosen.build_habitat()
    law = chosen.build_law(habitat)
    key = stream(wide([chosen.seed]), Purpose.EVALUATION, wide([0]))
    player = Player(law, habitat, np.empty(0), key, climate(law, 1).metabolism)
    scales = law.mutation.of_blocks("scale", law.blocks)
    return player, np.repeat(scales, law.block_sizes)


def lifespans(player: Player, genomes: np.ndarray) -> np.ndarray:
    """Of organisms with these genomes (K, P), one life each: (K,)."""
    groups = np.split(genomes.astype(np.float32), range(AT_ONCE, len(genomes), AT_ONCE))
    lived = [play(player._replace(genome=group), len(group), TICKS) for group in groups]
    return np.concatenate([each.ticks for each in lived])


if __name__ == "__main__":
    files.each(report, __doc__)
