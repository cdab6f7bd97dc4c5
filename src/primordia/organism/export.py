"""Export: genomes of organisms, rebuilt from the records, in a file that a run can start from."""

from collections.abc import Sequence
from pathlib import Path

from primordia.brains import genomes
from primordia.history.lineage import rebuild_all
from primordia.runs.records import Records


def export(
    run: Records, out: Path, organisms: Sequence[int] = (), world: int = 0
) -> tuple[int, ...]:
    """Write genomes of organisms to a safetensors file -> their birth numbers; see `genomes`.

    Args:
        run: the organisms' run.
        out: path of the file.
        organisms: birth numbers; by default that of the champion; see `Lives.oldest`.
        world: the organisms' world.

    Raises:
        InputError: no such organism was born.
        Trouble: the file cannot be written.
    """
    chosen = tuple(organisms) or (int(run.lives.id[run.lives.oldest(world)]),)
    about = {
        "task": run.config.task,
        "seed": str(run.world_seeds[world]),
        "organisms": " ".join(map(str, chosen)),
    }
    genomes.write(out, run.layout, rebuild_all(run, [(each, world) for each in chosen]), about)
    return chosen
