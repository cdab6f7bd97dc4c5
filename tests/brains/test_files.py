"""Genome files: types of numbers, metadata, and the largest number of ancestors."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from safetensors import SafetensorError
from safetensors.numpy import save_file

from primordia.brains import genomes
from primordia.brains.layout import Layout
from primordia.errors import InputError

LAYOUT = Layout((("input", (2, 3)), ("output", (3, 1))))
"""Genomes of 9 weights."""


def numbered(count: int, first: int = 0) -> np.ndarray:
    return np.arange(first, first + 9 * count, dtype=np.float32).reshape(count, 9)


def written(folder: Path, *counts: int) -> list[str]:
    """Write files with these numbers of genomes; all weights differ."""
    paths = [folder / f"{number}.safetensors" for number in range(len(counts))]
    for number, (path, count) in enumerate(zip(paths, counts, strict=True)):
        genomes.write(path, LAYOUT, numbered(count, 100 * number), {})
    return [str(path) for path in paths]


def test_the_number_of_ancestors_is_limited_over_all_files_together(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(genomes, "MOST_ANCESTORS", 5)
    two, three, one = written(tmp_path, 2, 3, 1)
    read = genomes.read([three, two], LAYOUT)
    np.testing.assert_array_equal(read, np.concatenate([numbered(3, 100), numbered(2)]))
    with pytest.raises(InputError, match=r"^ancestors: 6 genomes are more than 5; give fewer$"):
        genomes.read([three, two, one], LAYOUT)


@pytest.mark.parametrize("kind", [np.float16, np.float32, np.float64])
@pytest.mark.parametrize("of_state", [True, False])
def test_weights_of_each_type_of_float_become_float32(
    kind: type, of_state: bool, tmp_path: Path
) -> None:
    values: np.ndarray = (numbered(1) / 3).astype(kind)
    blocks = LAYOUT.split(values[0] if of_state else values)
    save_file({name: np.ascontiguousarray(each) for name, each in blocks.items()}, tmp_path / "x")
    read = genomes.of_state if of_state else lambda path, layout: genomes.read([str(path)], layout)
    found = read(tmp_path / "x", LAYOUT)
    assert found.dtype == np.float32
    np.testing.assert_array_equal(found, values.astype(np.float32))


@pytest.mark.parametrize("of_state", [True, False])
@pytest.mark.parametrize(
    ("weight", "accepted"),
    [
        (3.4028234e38, True),
        (-3.4028234e38, True),
        (3.5e38, False),
        (-1e300, False),
        (1e-300, True),
        (np.nan, False),
    ],
)
def test_a_weight_that_float32_cannot_hold_is_refused(
    weight: float, accepted: bool, of_state: bool, tmp_path: Path
) -> None:
    file = tmp_path / "x"
    shapes = dict(LAYOUT.blocks)
    blocks = {name: np.zeros(shape if of_state else (4, *shape)) for name, shape in shapes.items()}
    blocks["output"][-1, ..., 0] = weight
    save_file(blocks, file)
    read: Callable[[], np.ndarray] = lambda: (  # noqa: E731
        genomes.of_state(file, LAYOUT) if of_state else genomes.read([str(file)], LAYOUT)
    )
    if accepted:
        assert read()[-1, -1] == np.float32(weight)
    else:
        with pytest.raises(
            InputError, match="x has weights that are not finite numbers in float32"
        ):
            read()


def test_metadata_are_read_as_written(tmp_path: Path) -> None:
    about = {"task": "meadow", "organisms": "3, 5", "more": ""}
    genomes.write(tmp_path / "x", LAYOUT, numbered(2), about)
    assert genomes.about(tmp_path / "x") == about
    save_file(LAYOUT.split(numbered(1)), tmp_path / "bare")
    assert genomes.about(tmp_path / "bare") == {}
    with pytest.raises(InputError, match="there is no genome file"):
        genomes.about(tmp_path)


def test_blocks_may_be_in_another_order_but_further_blocks_are_refused(tmp_path: Path) -> None:
    other = Layout(LAYOUT.blocks[::-1])
    genomes.write(tmp_path / "x", other, other.join(LAYOUT.split(numbered(2))), {})
    np.testing.assert_array_equal(genomes.read([str(tmp_path / "x")], LAYOUT), numbered(2))
    more = Layout((*LAYOUT.blocks, ("bias", (1,))))
    genomes.write(tmp_path / "y", more, np.zeros((2, 10), np.float32), {})
    with pytest.raises(InputError, match=r"y holds genomes of another brain: .*bias 1"):
        genomes.read([str(tmp_path / "y")], LAYOUT)


NEEDS = "input 2x3, output 3x1"


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"input": (2, 4)}, f"the block input is 2x4; this task's brain needs {NEEDS}"),
        ({"output": ()}, f"the block output is a single number; this task's brain needs {NEEDS}"),
        (
            {"input": (3, 2)},
            f"the block input is 3x2; this task's brain needs {NEEDS}; transpose the block",
        ),
        (
            {"output": (1, 3)},
            f"the block output is 1x3; this task's brain needs {NEEDS}; transpose the block",
        ),
        ({"output": None}, f"the block output is missing; this task's brain needs {NEEDS}"),
        (
            {"c": (1,), "a": (1,), "b": (1,)},
            f"a is not a block of this task's brain, which has {NEEDS}",
        ),
    ],
)
def test_the_first_block_of_a_state_that_does_not_fit_is_named_with_its_shape(
    change: dict[str, tuple[int, ...] | None], says: str, tmp_path: Path
) -> None:
    """The message says "transpose" only if the shape is the right one in reverse."""
    shapes = {**dict(LAYOUT.blocks), **change}
    save_file(
        {name: np.zeros(shape) for name, shape in shapes.items() if shape is not None},
        tmp_path / "x",
    )
    with pytest.raises(InputError, match=rf"/x: {says}$"):
        genomes.of_state(tmp_path / "x", LAYOUT)


@pytest.mark.parametrize(
    ("error", "says"),
    [
        (PermissionError(13, "Permission denied"), "cannot be read: Permission denied"),
        (OSError("bad sector"), "cannot be read: bad sector"),
        (ValueError("a torn header"), "is not a safetensors file: a torn header"),
        (SafetensorError("no header"), "is not a safetensors file: no header"),
    ],
)
def test_a_file_that_cannot_be_opened_is_named_with_the_reason(
    error: Exception, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*_: object) -> None:
        raise error

    (path,) = written(tmp_path, 1)
    monkeypatch.setattr(genomes, "safe_open", fails)
    for read in (
        lambda: genomes.read([path], LAYOUT),
        lambda: genomes.of_state(Path(path), LAYOUT),
        lambda: genomes.about(Path(path)),
    ):
        with pytest.raises(InputError, match=f"^{path} {says}$"):
            read()
