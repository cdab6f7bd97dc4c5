"""What `track` says: how to look at the metrics, and that nothing is lost when it is stopped."""

from unittest.mock import MagicMock, patch

import pytest

from primordia import interrupts
from tests.commands import here


@pytest.mark.parametrize("rows", [(), (0, 0), (0, 5, 7)])
def test_the_way_to_look_at_metrics_is_printed_once_if_there_are_any(rows: tuple[int, ...]) -> None:
    run = MagicMock()
    run.track.side_effect = lambda *_, seen, **__: [seen(count) for count in rows]
    with patch("primordia.api.load", return_value=run):
        both = here("track", "RUN", "--tensorboard", "T", "--wandb", "W").stdout.splitlines()
        one = here("track", "RUN", "--wandb", "W").stdout.splitlines()
    ways = "tensorboard --logdir T", "wandb sync W/wandb/offline-run-*"
    lines = [f"Look at the metrics with: {way}" for way in ways]
    assert both == (lines if any(rows) else [])
    assert one == (lines[1:] if any(rows) else [])


def test_a_command_that_is_stopped_says_that_nothing_is_lost() -> None:
    run = MagicMock()
    run.track.side_effect = KeyboardInterrupt
    with patch("primordia.api.load", return_value=run):
        done = here("track", "RUN", "--wandb", "W", "--follow")
    says = "primordia: stopped; everything read so far is written\n"
    assert (done.returncode, done.stdout, done.stderr) == (interrupts.STATUS, "", says)
