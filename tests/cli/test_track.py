"""What `track` says: how to look at the metrics, and that nothing is lost when it is stopped."""

from unittest.mock import MagicMock, patch

import pytest

from primordia import interrupts
from tests.commands import here

WAYS = {
    ("--tensorboard", "T"): ["tensorboard --logdir T"],
    ("--wandb", "W"): ["wandb sync W/wandb/offline-run-*"],
    ("--tensorboard", "T", "--wandb", "W"): [
        "tensorboard --logdir T",
        "wandb sync W/wandb/offline-run-*",
    ],
}


@pytest.mark.parametrize("words", WAYS, ids=" ".join)
@pytest.mark.parametrize("rows", [(), (0, 0), (0, 5, 7), (5,)])
def test_the_way_to_look_at_metrics_is_printed_once_if_there_are_any(
    words: tuple[str, ...], rows: tuple[int, ...]
) -> None:
    run = MagicMock()
    run.track.side_effect = lambda *_, seen, **__: [seen(count) for count in rows]
    with patch("primordia.api.load", return_value=run):
        done = here("track", "RUN", *words)
    lines = [f"Look at the metrics with: {way}" for way in WAYS[words]]
    assert done.stdout.splitlines() == (lines if any(rows) else [])


def test_a_command_that_is_stopped_says_that_nothing_is_lost() -> None:
    run = MagicMock()
    run.track.side_effect = KeyboardInterrupt
    with patch("primordia.api.load", return_value=run):
        done = here("track", "RUN", "--wandb", "W", "--follow")
    says = "primordia: stopped; everything read so far is written\n"
    assert (done.returncode, done.stdout, done.stderr) == (interrupts.STATUS, "", says)
