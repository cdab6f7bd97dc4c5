"""The turns of a chunk on the host: their lengths, and the order of calls before and after a reset."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.engine.calls import Decision, Unsettled
from primordia.engine.hosted import HostedChunks
from primordia.engine.state import State
from primordia.law.events import Events, Rows

SENSES = np.arange(8, dtype=np.float32).reshape(4, 2)
"""Senses in four cells."""


def mask(*cells: int) -> Any:
    return np.isin(np.arange(4), cells)


def decided(due: int, **changes: Any) -> Decision:
    """Return a decision after a tick in which nothing happened; cell 3 rests, and cell 0 is empty."""
    quiet: dict[str, Any] = {
        "alive": mask(1, 2, 3), "active": mask(1, 2), "died": mask(), "newborn": mask(),
        "ran": np.ones(1, bool), "remembered": np.bool_(False),
        "go_on": np.bool_(True), "due": np.int32(due),
    }  # fmt: skip
    return Decision(**{**quiet, **changes})


class Scripted:
    """Calls, habitat, tallies and messages of a chunk, with given decisions and a log of all calls."""

    def __init__(self, first: Decision, *turns: tuple[int, Decision]) -> None:
        """Take the first decision, and for each turn its ticks and the decision after it."""
        self.first, self.turns, self.log = first, list(turns), list[tuple]()

    def hold(self, world: Any) -> str:
        return "held"

    def survey(self, *_: Any) -> Decision:
        return self.first

    def think(self, genome: Any, held: Any, senses: np.ndarray) -> str:
        self.log.append(("think", senses[:, 0].tolist()))
        return "thought"

    def quiet(self, *given: Any) -> tuple:
        *_, senses, active, most = given
        ticks = min(most, self.turns[0][0])
        self.log.append(("live", np.flatnonzero(active).tolist(), most))
        return (
            Unsettled("later", "fates", np.int32(ticks)),
            "next",
            np.full_like(senses, 90) if most else senses,
        )

    def words(self, genome: Any, held: Any) -> np.ndarray:
        self.log.append(("words",))
        return np.arange(8).reshape(4, 2)

    def settle(self, bulk: Any, events: Any, held: Any, unsettled: Any, limits: Any) -> tuple:
        self.log.append(("settle", int(unsettled.ticks)))
        return bulk, events, held, self.turns.pop(0)[1]

    def remember(self, bulk: Any, held: Any, senses: np.ndarray, ran: Any) -> Any:
        self.log.append(("remember", senses[:, 0].tolist()))
        self.ran = ran
        return bulk

    def begin(self) -> None:
        self.log.append(("begin",))

    def note_deaths(self, died: np.ndarray) -> None:
        self.log.append(("deaths", np.flatnonzero(died).tolist()))

    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        self.log.append(("reset", cells.tolist(), words.tolist()))
        return np.full((len(cells), 2), 70, np.float32)

    def note_samples(self, alive: np.ndarray, samples: Any) -> None:
        self.log.append(("samples", np.flatnonzero(alive).tolist()))

    def added_to(self, events: Any) -> str:
        return "with tallies"


def advanced(scripted: Scripted, ticks: int) -> tuple[Any, list[float], int]:
    """Advance a chunk; return it, the first sense in each cell at its end, and the ticks done."""
    chunks: Any = object.__new__(HostedChunks)
    chunks._calls = chunks._habitat = chunks._tallies = chunks._messages = scripted
    chunks._quiet, chunks._release = scripted.quiet, lambda bulk, held: "world"
    chunks._lists = Events(*(Rows(np.zeros((2, 2)), np.int32(1)) for _ in range(3)))
    world: Any = SimpleNamespace(organisms=SimpleNamespace(genome={}, moments=None))
    state, done = chunks.advance(State(world, SENSES), "limits", ticks)
    assert (state.world, chunks.events) == ("world", "with tallies")
    return chunks, state.bodies[:, 0].tolist(), done


def test_deaths_are_noted_before_a_reset_and_samples_after_it() -> None:
    """Cell 2 has a death and a birth in one tick. Cell 3, which rests, keeps its senses."""
    reborn = decided(
        50, died=mask(1, 2), newborn=mask(0, 2), alive=mask(0, 2, 3), active=mask(0, 2)
    )
    scripted = Scripted(decided(4), (3, reborn), (9, decided(1, remembered=np.bool_(True))))
    _, senses, done = advanced(scripted, 10)
    noted = [("deaths", [1, 2])] * 2  # of tallies and of messages
    assert scripted.log == [
        ("begin",), ("begin",), ("think", [0, 2, 4, 6]),
        ("live", [1, 2], 4), ("settle", 3), *noted, ("words",), ("reset", [0, 2], [[0, 1], [4, 5]]),
        ("think", [70, 90, 70, 6]), ("samples", [0, 2, 3]),
        ("live", [0, 2], 7), ("settle", 7), ("deaths", []), ("deaths", []),
        ("remember", [90, 90, 90, 6]), ("samples", [1, 2, 3]),
    ]  # fmt: skip
    assert (senses, done) == ([90, 90, 90, 6], 10)
    assert SENSES[:, 0].tolist() == [0, 2, 4, 6], "the given state is unchanged"


def test_the_newborn_remember_the_senses_of_their_own_bodies() -> None:
    """Organisms remember in the worlds that ran, after the newborn have their senses."""
    ran, yes = np.array([True, False]), np.bool_(True)
    born = decided(50, newborn=mask(2), remembered=yes, go_on=np.bool_(False), ran=ran)
    scripted = Scripted(decided(4), (4, born))
    advanced(scripted, 9)
    assert scripted.log[-4:] == [
        ("reset", [2], [[4, 5]]), ("think", [90, 90, 70, 6]), ("remember", [90, 90, 70, 6]),
        ("samples", [1, 2, 3]),
    ]  # fmt: skip
    assert scripted.ran is ran


def test_genesis_takes_no_tick_and_leaves_the_given_state_unchanged() -> None:
    born = decided(5, newborn=mask(1, 2, 3))
    _, senses, done = advanced(scripted := Scripted(decided(0), (0, born), (5, decided(9))), 5)
    assert [each[1:] for each in scripted.log if each[0] == "live"] == [([1, 2], 0), ([1, 2], 5)]
    assert (senses, done) == ([90, 90, 90, 70], 5)
    assert SENSES[:, 0].tolist() == [0, 2, 4, 6]


@pytest.mark.parametrize(("ticks", "most", "done"), [(5, [3, 2], 5), (3, [3], 3), (20, [3, 8], 11)])
def test_a_turn_ends_when_a_change_is_due_the_ticks_are_over_or_all_worlds_stop(
    ticks: int, most: list[int], done: int
) -> None:
    over = decided(99, go_on=np.bool_(False))
    scripted = Scripted(decided(3), (9, decided(8)), (9, over))
    assert advanced(scripted, ticks)[2] == done
    assert [each[2] for each in scripted.log if each[0] == "live"] == most
    nothing = Scripted(over)
    assert advanced(nothing, ticks)[1:] == ([0, 2, 4, 6], 0)


@pytest.mark.parametrize(
    ("most", "eventful", "lived"), [(5, 3, 3), (3, 3, 3), (2, 3, 2), (0, 3, 0)]
)
def test_a_quiet_time_ends_with_its_first_eventful_tick(
    most: int, eventful: int, lived: int
) -> None:
    """Each tick acts on the thought of the tick before it, and only active organisms act."""
    acted: list[tuple] = []

    def step(action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, str]:
        acted.append((int(action), alive.tolist()))
        return SENSES + len(acted), f"outcome {len(acted)}"

    def live(genome: Any, now: int, thought: Any, senses: np.ndarray, *given: Any) -> tuple:
        outcome, _, passed = given
        assert (now, int(thought.action)) == (passed - 1, passed - 1 + 20)
        assert (senses[0, 0], outcome) == (passed, f"outcome {passed}")
        fates = SimpleNamespace(eventful=np.bool_(passed == eventful))
        return now + 1, SimpleNamespace(action=np.int32(20 + passed)), fates

    chunks: Any = object.__new__(HostedChunks)
    chunks._habitat, chunks._calls = SimpleNamespace(step=step), SimpleNamespace(live=live)
    chunks._no_fates = SimpleNamespace(eventful=np.bool_(False))
    first = SimpleNamespace(action=np.int32(20))
    unsettled, thought, senses = chunks._quiet({}, 0, first, SENSES, mask(1, 2), most)
    assert acted == [(20 + tick, mask(1, 2).tolist()) for tick in range(lived)]
    assert (unsettled.held, int(unsettled.ticks), int(thought.action)) == (lived, lived, 20 + lived)
    assert senses[0, 0] == lived
    assert bool(unsettled.fates.eventful) == (lived == eventful)
