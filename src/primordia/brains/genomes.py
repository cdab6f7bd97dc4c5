"""Genome files: organisms' weights by themselves, in safetensors, to keep, share and start from.

A file holds one float32 tensor (K, *shape) for each block of the brain, for K genomes, in that order.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from safetensors import SafetensorError
from safetensors.numpy import load_file, save

from primordia import files
from primordia.brains.layout import Layout, Shape
from primordia.errors import InputError

FOUNDERS = "founders.safetensors"
"""What a run that starts from ancestors keeps them in."""
MOST = 2**16
"""Ancestors of one run; the arithmetic that takes them in turn is in 32 bits."""


def write(path: Path, layout: Layout, genomes: np.ndarray, about: dict[str, str]) -> None:
    """Write genomes (K, P), with a few words about them as the file's metadata.

    Raises:
        Trouble: the file cannot be written.
    """
    parts = layout.split(genomes).items()
    blocks = {name: np.ascontiguousarray(part, np.float32) for name, part in parts}
    content = save(blocks, metadata=about)
    files.write(path, lambda temporary: temporary.write_bytes(content))


def read(paths: Sequence[str], layout: Layout) -> np.ndarray:
    """The genomes in some files, one after another, float32 (K, P).

    Raises:
        InputError: a file cannot be read, is no genome file, or is one of another brain.
    """
    found = np.concatenate([_read(Path(path), layout) for path in paths])
    if len(found) > MOST:
        raise InputError(f"ancestors: {len(found)} genomes are more than {MOST}")
    return found


def _read(path: Path, layout: Layout) -> np.ndarray:
    try:
        blocks = load_file(path)
    except FileNotFoundError:
        raise InputError(f"there is no genome file {path}") from None
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror or error}") from None
    except (SafetensorError, KeyError, TypeError, ValueError) as error:
        raise InputError(f"{path} is not a safetensors file: {error}") from None
    shapes = {name: block.shape[1:] for name, block in blocks.items()}
    if shapes != dict(layout.blocks):
        raise InputError(
            f"{path} holds genomes of another brain: {_shown(shapes)}; this task's is"
            f" {_shown(dict(layout.blocks))}"
        )
    counts = {len(block) for block in blocks.values()}
    if len(counts) != 1 or 0 in counts:
        raise InputError(f"{path} holds no whole genome")
    genomes = layout.join(blocks).astype(np.float32)
    if not np.isfinite(genomes).all():
        raise InputError(f"{path} has weights that are no finite numbers")
    return genomes


def _shown(shapes: Mapping[str, Shape]) -> str:
    return ", ".join(f"{name} {'x'.join(map(str, shape))}" for name, shape in shapes.items()) or "-"
