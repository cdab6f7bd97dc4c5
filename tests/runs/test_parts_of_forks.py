"""Forks of invented worlds: possible ticks, organisms alive at the tick, and changes of the state."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

from primordia.errors import InputError, Trouble
from primordia.law.events import birth_columns
from primordia.law.world import Worlds
from primordia.random.wide import to_host
from primordia.runs import checkpoint, fork
from primordia.runs.arrays import NEVER, world_ticks
from tests.runs.forking import adapted
from tests.synthetic import worlds_of
from tests.worlds import MEADOW, config

FIRST = [(0, 9, True), (0, 19, True), (5, 14, True), (10, 30, False)]
SECOND = [(0, 9, True), (10, 0, False), (11, 0, False)]
CELLS = 5


@pytest.mark.parametrize("begins", [0, 7])
def test_a_run_is_forked_at_ticks_that_all_its_worlds_have(begins: int) -> None:
    """The first tick is 1, or that of the run's own fork. The last is the end of the shortest world."""
    of = SimpleNamespace(run="before", tick=begins) if begins else None
    settings = SimpleNamespace(begins=begins, fork=of)
    source: Any = SimpleNamespace(config=settings, ends=np.array([30, 20, 25]), path=Path("run"))
    first = max(begins, 1)
    for at in (first, first + 1, 20):
        fork._check_tick(source, at)
    says = f"run can be forked at any tick from {first} to 20"
    earlier = "; for an earlier tick, fork before" if begins else ""
    for at, more in ((first - 1, earlier), (21, ""), (30, "")):
        with pytest.raises(InputError) as raised:
            fork._check_tick(source, at)
        assert str(raised.value) == f"--at {at}: {says}{more}"


@pytest.mark.parametrize("at", [1, 9, 10, 11, 20])
def test_the_living_at_a_tick_are_on_record_and_in_the_world(at: int) -> None:
    """An organism that is born in the tick is alive at its end. One that dies in the tick is not."""
    lives = worlds_of(FIRST, SECOND, until=40)
    expected = [
        row
        for row in range(len(lives))
        if lives.born[row] <= at and (not lives.died[row] or lives.ended[row] > at)
    ]
    alive, number = np.zeros(2 * CELLS, bool), np.zeros(2 * CELLS, np.uint32)
    for row in expected:
        cell = lives.world[row] * CELLS + lives.cell[row]
        alive[cell], number[cell] = True, lives.id[row]

    def living(alive: np.ndarray, number: np.ndarray) -> list[int]:
        organisms = SimpleNamespace(alive=alive, number=SimpleNamespace(lo=number))
        state = SimpleNamespace(world=SimpleNamespace(organisms=organisms))
        settings: Any = SimpleNamespace(cells=CELLS)
        found = fork._living(lives, SimpleNamespace(state=state), settings, at)
        return list(zip(found.world.tolist(), found.id.tolist(), strict=True))

    who = [(int(lives.world[row]), int(lives.id[row])) for row in expected]
    assert living(alive, number) == who
    for change in (
        alive ^ (np.arange(2 * CELLS) == np.flatnonzero(alive)[-1]),
        np.ones_like(alive),
    ):
        with pytest.raises(Trouble, match=f"tick {at} did not repeat as recorded"):
            living(change, number)
    with pytest.raises(Trouble, match="did not repeat"):
        living(alive, number + np.arange(2 * CELLS, dtype=np.uint32) // CELLS)


def with_changes(at: int, changes: dict[str, Any]) -> Worlds:
    """Return the worlds of a fork of a meadow with two worlds at a tick, with some changed settings."""
    own = {"seeds": 2, "sample_every": 10, "seed": 3}
    return adapted(at, config(MEADOW, **own), config(MEADOW, **{**own, **changes}))


@pytest.mark.parametrize(
    ("at", "every", "wait"),
    [(3, 10, 7), (10, 10, 10), (19, 10, 1), (19, 4, 1), (20, 4, 4), (3, 9, 6)],
)
def test_a_fork_is_sampled_at_multiples_of_its_own_interval(at: int, every: int, wait: int) -> None:
    assert with_changes(at, {"sample_every": every}).sample_wait.tolist() == [wait, wait]


@pytest.mark.parametrize(
    ("changes", "again"),
    [
        ({}, False),
        ({"sample_every": 4}, False),
        ({"stop": {"ticks": 500}}, False),
        ({"about": "another"}, False),
        ({"seed": 4}, True),
        ({"hazard": 0.5}, True),
        ({"saturation_ticks": 77}, True),
    ],
)
def test_a_fork_must_saturate_again_only_if_its_lives_can_differ(
    changes: dict[str, Any], again: bool
) -> None:
    worlds, seed = with_changes(20, changes), changes.get("seed", 3)
    assert worlds.calm.tolist() == ([0, 0] if again else [7, 8])
    for moment in (worlds.saturated, worlds.saturated_births):
        assert to_host(moment).tolist() == ([NEVER, NEVER] if again else [100, 200])
    for count in (worlds.fixed, worlds.fixed_births, worlds.births, worlds.tick):
        assert to_host(count).tolist() == [100, 200]
    assert to_host(worlds.seed).tolist() == [seed, seed + 1]
    assert worlds.looks == "looks"


def test_a_changed_setting_replaces_the_value_that_seasons_left() -> None:
    before: Any = SimpleNamespace(law=SimpleNamespace(beginning=(("hazard", 0.5), ("gain", 2.0))))
    after: Any = SimpleNamespace(
        law=SimpleNamespace(beginning=(("hazard", 0.5), ("gain", 3.0), ("store", 9.0)))
    )
    now = {"hazard": jnp.array([0.25, 0.75]), "gain": jnp.array([1.0, 7.0]), "store": jnp.zeros(2)}
    climate = fork._climate(now, before, after)
    assert {name: values.tolist() for name, values in climate.items()} == {
        "hazard": [0.25, 0.75],
        "gain": [3.0, 3.0],
        "store": [9.0, 9.0],
    }


def test_the_length_of_saved_states_is_no_part_of_the_form_of_an_array() -> None:
    arrays = {"bodies.states": np.zeros((4, 9)), "bodies.other": np.zeros((4, 9))}
    assert fork._form("bodies.states", arrays) == (4,)
    assert fork._form("bodies.other", arrays) == (4, 9)
    assert fork._form("bodies.none", arrays) == ()


@pytest.mark.parametrize(("mates", "endowed"), [(False, False), (True, False), (True, True)])
def test_births_of_the_living_are_in_order_of_events_and_have_their_own_notes(
    mates: bool, endowed: bool
) -> None:
    """Births are in order of ticks, and those of one tick are in order of worlds and cells.

    Their mates are left out, since the living are the roots of later lines.
    """
    lives = worlds_of([(9, 0, False), (4, 0, False)], [(4, 0, False), (7, 0, False)], until=40)
    lives = replace(lives, cell=np.array([3, 1, 4, 0]), parent=np.array([-1, 0, -1, 0]))
    lives = lives.take(np.array([3, 0, 2, 1]))
    notes = np.arange(4 * CELLS).reshape(-1, 2)
    heredity = SimpleNamespace(
        recombination="crossover" if mates else None,
        mutation=SimpleNamespace(notes=("step", "way")),
    )
    organisms = SimpleNamespace(notes=notes)
    engine: Any = SimpleNamespace(
        law=SimpleNamespace(cells=CELLS, heredity=heredity, act="act" if endowed else None),
        state=SimpleNamespace(world=SimpleNamespace(organisms=organisms)),
    )
    source: Any = SimpleNamespace(endowments_of=lambda lives: 100 * lives.world + lives.born)
    words = fork._birth_rows(source, lives, engine)
    rows = birth_columns(mates, ("step", "way"), endowed).unpacked(words)
    assert rows["tick"].tolist() == [4, 4, 7, 9]
    assert rows["cell"].tolist() == [3, 9, 5, 1]
    assert rows["id"].tolist() == [0, 0, 1, 1]
    assert rows["parent"].tolist() == [-1, -1, 0, 0]
    assert rows["step"].tolist() == [6, 18, 10, 2]
    assert rows["way"].tolist() == [7, 19, 11, 3]
    assert rows.get("mate", np.zeros(0)).tolist() == ([-1] * 4 if mates else [])
    assert rows.get("endowment", np.zeros(0)).tolist() == ([4, 104, 107, 9] if endowed else [])


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({}, {}),
        ({"hazard": 0.0}, {"hazard": 0.0}),
        ({"mutation": {"scale": 0.5}}, {"mutation": {"probability": 0.5, "scale": 0.5}}),
        ({"sample_every": 7, "seed": 0}, {"sample_every": 7, "seed": 0}),
        ({"seasons": []}, {"seasons": []}),
    ],
)
def test_a_fork_has_all_other_settings_of_its_source(
    changes: dict[str, Any], expected: dict[str, Any], tmp_path: Path
) -> None:
    """A setting may be changed to 0, or to an empty list."""
    own = {"seed": 3, "hazard": 0.25, "mutation": {"probability": 0.5, "scale": 0.125}}
    own["seasons"] = [{"kind": "schedule", "setting": "hazard", "at": 9, "value": 0.5}]
    (tmp_path / "config.toml").write_text(config(MEADOW, **own).to_toml())
    source: Any = SimpleNamespace(path=tmp_path, config=SimpleNamespace(kept={}))
    forked = fork._fork_config(source, changes, 6)
    values = config(MEADOW, **{**own, **expected}).model_dump()
    assert forked.model_dump() == values | {"fork": {"run": str(tmp_path), "tick": 6}}


class Past:
    """An engine of two worlds that logs the loaded arrays. A call of `advance` lives 2 ticks or fewer."""

    def __init__(self, exact: bool = True) -> None:
        self.ticks, self.loaded = np.array([0, 0]), list[dict]()
        self.chunks = SimpleNamespace(exact=exact)

    def limits(self, stop: dict[str, int]) -> int:
        return stop["ticks"]

    def any_running(self, limit: int) -> bool:
        return bool((self.ticks < limit).any())

    def advance(self, limit: int) -> None:
        self.ticks = np.minimum(self.ticks + 2, limit)

    def load(self, arrays: dict) -> None:
        self.loaded.append(arrays)
        self.ticks = world_ticks(arrays).astype(np.int64)


def stored(*ticks: int) -> dict[str, np.ndarray]:
    """Return the arrays of a checkpoint in which worlds have these ticks."""
    low = np.array(ticks, np.uint32)
    return {"world.worlds.tick.lo": low, "world.worlds.tick.hi": np.zeros_like(low)}


KEPT = [stored(9, 12), stored(8, 10), stored(8, 8), stored(3, 3)]
"""Checkpoints, newest first. In some of them one world is ahead of the other."""


@pytest.fixture
def relived(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Past]:
    """Return a function that returns an engine at a tick of a run that has the checkpoints KEPT."""

    def engine_at(
        at: int, versions: Sequence[str] = (), exact: bool = True, listen: Any = None
    ) -> Past:
        monkeypatch.setattr(fork, "Engine", lambda _: Past(exact))
        monkeypatch.setattr(checkpoint, "whole_checkpoints", lambda *_: iter(KEPT))
        source: Any = SimpleNamespace(
            config=None, path=Path("run"), fault_in=None, other_versions=versions,
            arrays_of=lambda each: each,
        )  # fmt: skip
        engine: Any = fork._engine_at(source, at, listen)
        return engine

    return engine_at


@pytest.mark.parametrize(
    ("at", "loaded", "reported"),
    [(12, 0, [11, 12]), (11, 1, [10, 11]), (9, 2, [9]), (8, 2, []), (5, 3, [5]), (2, None, [2])],
)
def test_the_past_is_lived_again_from_the_newest_checkpoint_in_which_no_world_is_later(
    at: int, loaded: int | None, reported: list[int], relived: Callable[..., Past]
) -> None:
    """The listener is called with the engine after each advance."""
    ticks: list[int] = []
    engine = relived(at, listen=lambda now: ticks.append(int(now.engine.ticks.min())))
    assert engine.loaded == ([] if loaded is None else [KEPT[loaded]])
    assert engine.ticks.tolist() == [at, at]
    assert ticks == reported


@pytest.mark.parametrize(
    ("versions", "exact", "says"),
    [
        (["jax 1 then, 2 now"], True, "run cannot be lived again up to tick 9: jax 1 then, 2 now"),
        (["a", "b"], True, "run cannot be lived again up to tick 9: a; b"),
        ([], False, "run is not exact, so it cannot be lived again up to tick 9"),
    ],
)
def test_a_past_that_does_not_repeat_is_not_lived_again(
    versions: list[str], exact: bool, says: str, relived: Callable[..., Past]
) -> None:
    """At the tick of a checkpoint, nothing must be lived again."""
    with pytest.raises(InputError) as raised:
        relived(9, versions, exact)
    assert str(raised.value) == says
    assert relived(8, versions, exact).ticks.tolist() == [8, 8]
