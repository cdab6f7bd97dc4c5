"""Export of rebuilt organisms for other runs and other programs."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from primordia.brains import genomes
from primordia.errors import InputError
from primordia.history import pedigree
from primordia.history.islands import names_of
from primordia.organism.policy import Policy
from primordia.runs.records import Records

ONNX = ".onnx"


def export(
    run: Records, out: Path, organisms: Sequence[int] = (), world: int = 0
) -> tuple[int, ...]:
    """Write organisms to a file. Return their birth numbers.

    The file is an ONNX model of one brain if its name ends with .onnx (see `onnx.write`). Other
    files hold genomes in safetensors (see `genomes.write`). Both name the organisms, and the islands on
    which they were born if their world has islands.

    Args:
        run: the organisms' run.
        out: path of the file.
        organisms: birth numbers; by default the champion's number; see `Lives.oldest`.
        world: the organisms' world.

    Raises:
        InputError: no such organism was born, or several organisms were to be written to one ONNX model.
        Trouble: the file cannot be written.
    """
    chosen = tuple(organisms) or (int(run.lives.id[run.lives.oldest(world)]),)
    rows = np.array([run.lives.row(each, world) for each in chosen])
    rebuilt = pedigree.genomes(run, rows)
    about = {
        "task": run.config.task,
        "seed": str(run.world_seeds[world]),
        "organisms": " ".join(map(str, chosen)),
    }
    if run.config.islands.count > 1:
        about["islands"] = " ".join(names_of(run.config.islands, run.lives.cell[rows]) or ())
    if out.suffix != ONNX:
        genomes.write(out, run.layout, rebuilt, about)
    elif len(chosen) == 1:
        Policy(run.law, rebuilt[0]).to_onnx(out, about)
    else:
        raise InputError(f"{out}: an ONNX model is one brain; give one organism")
    return chosen
