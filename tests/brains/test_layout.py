"""Layouts: the blocks of a flat genome."""

from math import prod

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.brains.layout import Layout
from primordia.errors import InputError

LAYOUT = Layout((("input", (2, 3)), ("gate-2", (4,)), ("K_3", (2, 2, 3))))


def test_a_layout_has_names_sizes_and_a_length() -> None:
    assert LAYOUT.names == ["input", "gate-2", "K_3"]
    assert LAYOUT.sizes.tolist() == [6, 4, 12]
    assert LAYOUT.length == 22


@pytest.mark.parametrize("library", [np, jnp])
def test_a_flat_genome_is_its_blocks_in_order(library) -> None:
    flat = np.random.default_rng(0).normal(size=(64, 22)).astype(np.float32)
    blocks = LAYOUT.split(library.asarray(flat))
    assert all(isinstance(block, np.ndarray | Array) for block in blocks.values())
    assert all(isinstance(block, Array) == (library is jnp) for block in blocks.values())
    assert {name: block.shape[1:] for name, block in blocks.items()} == dict(LAYOUT.blocks)
    on_host = {name: np.asarray(block) for name, block in blocks.items()}
    np.testing.assert_array_equal(LAYOUT.join(on_host), flat)
    in_order = np.concatenate([on_host[name][5].ravel() for name in LAYOUT.names])
    np.testing.assert_array_equal(in_order, flat[5])
    for name, block in LAYOUT.split(library.asarray(flat[5])).items():
        np.testing.assert_array_equal(block, on_host[name][5])


def test_an_empty_set_of_genomes_is_made_flat_too() -> None:
    empty = np.zeros((0, 22), np.float32)
    assert LAYOUT.join(LAYOUT.split(empty)).shape == (0, 22)


def test_flat_genomes_are_those_of_the_given_cells_in_their_order() -> None:
    blocks = {
        name: np.arange(5 * prod(shape), dtype=np.float32).reshape(5, *shape) + 1000 * number
        for number, (name, shape) in enumerate(LAYOUT.blocks)
    }
    shuffled = dict(reversed(blocks.items()))
    flat = np.asarray(LAYOUT.flat(shuffled, np.array([3, 0, 3])))
    expected = [np.concatenate([np.ravel(blocks[name][cell]) for name in LAYOUT.names])
                for cell in (3, 0, 3)]  # fmt: skip
    np.testing.assert_array_equal(flat, expected)


def test_the_value_of_a_block_is_repeated_for_each_of_its_weights() -> None:
    values = jax.jit(LAYOUT.per_weight)(np.array([[1, 2, 3], [7, 8, 9]]))
    expected = [[1] * 6 + [2] * 4 + [3] * 12, [7] * 6 + [8] * 4 + [9] * 12]
    assert np.asarray(values).tolist() == expected


def test_equal_layouts_are_one_value() -> None:
    again = Layout(LAYOUT.blocks)
    assert again == LAYOUT
    assert hash(again) == hash(LAYOUT)
    assert Layout(LAYOUT.blocks[::-1]) != LAYOUT
    assert sum(prod(shape) for _, shape in LAYOUT.blocks) == again.length


@pytest.mark.parametrize(
    ("blocks", "says"),
    [
        ((), r"blocks\(\) names no blocks of weights"),
        (
            (("in.put", (2,)),),
            "'in.put' cannot name a block of weights; use letters, digits, _ and -",
        ),
        ((("", (2,)),), "'' cannot name a block"),
        ((("two words", (2,)),), "'two words' cannot name a block"),
        ((("größe", (2,)),), "'größe' cannot name a block"),
        (((7, (2,)),), "7 cannot name a block"),
        ((("w", (2, 0)),), r"block 'w' has the shape \(2, 0\); use a tuple of positive integers"),
        ((("w", ()),), r"block 'w' has the shape \(\)"),
        ((("w", [2, 3]),), r"block 'w' has the shape \[2, 3\]"),
        ((("w", (2.0,)),), r"block 'w' has the shape \(2.0,\)"),
        ((("w", 3),), "block 'w' has the shape 3"),
        ((("w", (2, True)),), r"block 'w' has the shape \(2, True\)"),
        ((("w\n", (2,)),), r"'w\\n' cannot name a block"),
        ((("w", (2,)), ("v", (0, 2))), r"block 'v' has the shape \(0, 2\)"),
        ((("w", (2,)), ("u.v", (2,))), "'u.v' cannot name a block"),
    ],
)
def test_impossible_blocks_are_refused(blocks: tuple, says: str) -> None:
    with pytest.raises(InputError, match=f"^brain: .*{says}"):
        Layout(blocks)


def test_only_a_layout_with_traits_has_genes_of_a_body() -> None:
    """A brain may have a block of that name if its world has no traits."""
    own = Layout((("body", (3, 2)), ("output", (4,))))
    assert (own.genes, LAYOUT.with_body(3).genes) == (0, 3)
    assert LAYOUT.with_body(3).names[-1] == "body"
    with pytest.raises(InputError, match="'body' has the name of the block of a body's genes"):
        own.with_body(1)
