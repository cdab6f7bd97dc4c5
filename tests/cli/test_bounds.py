"""Bounds of the numbers that options take."""

import math
import re

import click
import pytest

from primordia.cli.commands import commands

BOUNDS: list[tuple[str, tuple[float, ...], tuple[float, ...]]] = [
    ("assay heredity --after", (0, 0.999), (-0.001, 1)),
    ("assay threshold --after", (0, 0.999), (-0.001, 1)),
    ("assay garden --after", (0, 0.999), (-0.001, 1)),
    ("assay garden --each", (1, 65_536), (0, 65_537)),
    ("assay effects --mutants", (1, 65_536), (0, 65_537)),
    ("assay effects --scale", (1e-9, 1e30), (0, 1.1e30, math.nan)),
    ("assay effects --differs", (0, 5), (-0.001, math.nan, math.inf)),
    ("assay line --most", (2, 10**9), (1,)),
    ("assay compete --worlds", (1, 65_536), (0, 65_537)),
    ("assay compete --ticks", (1, 2**31 - 1), (0, 2**31)),
    ("evaluate --games", (1, 65_536), (0, 65_537)),
    ("evaluate --founders", (1, 1_048_576), (0, 1_048_577)),
    ("evaluate --ticks", (1, 2**31 - 1), (0, 2**31)),
    ("shadow --organisms", (1, 65_536), (0, 65_537)),
    ("shadow --ticks", (1, 2**31 - 1), (0, 2**31)),
    ("experiment --jobs", (1, 10**6), (0,)),
    ("compare --births", (1, 10**6), (0,)),
    ("compare --ticks", (1, 10**6), (0,)),
    ("watch --port", (0, 65_535), (-1, 65_536)),
    ("run --speed", (1e-9, 1e9), (0, 1.1e9)),
]
"""Options, numbers that each accepts, and numbers that it refuses."""


@pytest.mark.parametrize(
    ("words", "accepted", "refused"), BOUNDS, ids=[words for words, *_ in BOUNDS]
)
def test_an_option_accepts_numbers_up_to_its_bounds(
    words: str, accepted: tuple[float, ...], refused: tuple[float, ...]
) -> None:
    *names, flag = words.split()
    command: click.Command = commands
    for name in names:
        assert isinstance(command, click.Group)
        command = command.commands[name]
    (kind,) = (each.type for each in command.params if flag in each.opts)
    assert [kind.convert(str(number), None, None) for number in accepted] == list(accepted)
    for number in refused:
        with pytest.raises(click.BadParameter, match=re.escape(str(number))):
            kind.convert(str(number), None, None)
