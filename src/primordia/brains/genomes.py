"""Genome files: the weights of K organisms in safetensors.

A file holds one float32 tensor (K, *shape) for each block of the brain, in the order of the blocks.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import load_file, save

from primordia import files
from primordia.brains.layout import Layout, Shape
from primordia.errors import InputError

FOUNDERS = "founders.safetensors"
"""The file in a run's directory that keeps its ancestors."""
FLOATS = ("F32", "F64", "F16")
"""The types of weights in a file, as safetensors names them; weights become float32."""
MOST_ANCESTORS = 2**16
"""The largest number of ancestors among which 32-bit arithmetic can choose one for a founder."""


def write(path: Path, layout: Layout, genomes: np.ndarray, about: dict[str, str]) -> None:
    """Write genomes (K, P) to a file, with `about` as its metadata.

    Raises:
        Trouble: the file cannot be written.
    """
    parts = layout.split(genomes).items()
    blocks = {name: np.ascontiguousarray(part, np.float32) for name, part in parts}
    content = save(blocks, metadata=about)
    files.write_bytes(path, content)


def read(paths: Sequence[str], layout: Layout) -> np.ndarray:
    """Return the genomes of some files, in the order of the files, float32 (K, P).

    Raises:
        InputError: a file cannot be read, is not a genome file, or has genomes of another brain.
    """
    genomes = np.concatenate([_read(Path(path), layout) for path in paths])
    if len(genomes) > MOST_ANCESTORS:
        raise InputError(
            f"ancestors: {len(genomes)} genomes are more than {MOST_ANCESTORS}; give fewer"
        )
    return genomes


def of_state(path: Path, layout: Layout) -> np.ndarray:
    """Return the genome of a state dictionary in a safetensors file, float32 (1, P).

    The file has a tensor (*shape) for each block of the brain, of one of the types FLOATS.

    Raises:
        InputError: the file cannot be read, or a block is missing, unknown or of another shape; the
            message says which.
    """
    state = _tensors(path)
    wanted = _described(dict(layout.blocks))
    for name, shape in layout.blocks:
        found = state[name].shape if name in state else None
        if found != shape:
            other = "is missing" if found is None else f"is {_size(found)}"
            turned = found is not None and found == shape[::-1]
            raise InputError(
                f"{path}: the block {name} {other}; this task's brain needs {wanted}"
                f"{'; transpose the block' if turned else ''}"
            )
    if unknown := sorted(set(state) - set(layout.names)):
        raise InputError(
            f"{path}: {unknown[0]} is not a block of this task's brain, which has {wanted}"
        )
    return _finite(path, layout.join({name: state[name][None] for name in layout.names}))


def about(path: Path) -> dict[str, str]:
    """Return the metadata of a genome file, such as its `task`; see `write`.

    Raises:
        InputError: the file cannot be read, or is not a genome file.
    """
    with _opening(path), safe_open(path, "numpy") as opened:
        return opened.metadata() or {}


@contextmanager
def _opening(path: Path) -> Iterator[None]:
    """Raise InputError in place of the errors of reading a file."""
    if not path.is_file():  # Opening a pipe could block for ever.
        raise InputError(f"there is no genome file {path}")
    try:
        yield
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror or error}") from None
    except (SafetensorError, KeyError, TypeError, ValueError) as error:
        raise InputError(f"{path} is not a safetensors file: {error}") from None


def _read(path: Path, layout: Layout) -> np.ndarray:
    blocks = _tensors(path)
    shapes = {name: block.shape[1:] for name, block in blocks.items()}
    if shapes != dict(layout.blocks):
        raise InputError(
            f"{path} holds genomes of another brain: {_described(shapes)}; this task's brain is "
            f"{_described(dict(layout.blocks))}"
        )
    counts = {len(block) for block in blocks.values()}
    if len(counts) != 1 or 0 in counts:
        raise InputError(f"{path} holds no complete genome; export the genomes again")
    return _finite(path, layout.join(blocks))


def _tensors(path: Path) -> dict[str, np.ndarray]:
    """Return the tensors of a file by name; raise InputError if they are not float numbers."""
    with _opening(path), safe_open(path, "numpy") as opened:
        kinds = {name: opened.get_slice(name).get_dtype() for name in opened.keys()}  # noqa: SIM118
    for name, kind in kinds.items():
        if kind not in FLOATS:
            raise InputError(
                f"{path}: {name} has the type {kind}; weights have {', '.join(FLOATS)}"
            )
    with _opening(path):
        return load_file(path)


def _finite(path: Path, genomes: np.ndarray) -> np.ndarray:
    """Return genomes as float32; raise InputError if a weight is not finite, or becomes infinite."""
    with np.errstate(over="ignore"):
        genomes = genomes.astype(np.float32)
    if not np.isfinite(genomes).all():
        raise InputError(
            f"{path} has weights that are not finite numbers in float32; use another genome"
        )
    return genomes


def _described(shapes: Mapping[str, Shape]) -> str:
    return ", ".join(f"{name} {_size(shape)}" for name, shape in shapes.items()) or "-"


def _size(shape: Shape) -> str:
    return "x".join(map(str, shape)) or "a single number"
