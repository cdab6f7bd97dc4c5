"""Forks of invented worlds: possible ticks, organisms alive at the tick, and changes of the state.

New ratchets look back as far as the fork, and no further; old ones go on. Lives in forks are tested in
`test_fork`.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

from primordia.config import Config
from primordia.errors import InputError, Trouble
from primordia.law.events import birth_columns
from primordia.law.metabolism import ONE
from primordia.law.world import Organisms, World, Worlds
from primordia.random.wide import to_host, wide
from primordia.runs import checkpoint, fork
from primordia.runs.arrays import NEVER, world_ticks
from tests.synthetic import worlds_of
from tests.worlds import HERD, MEADOW, config, law_of

CELLS = 5


@pytest.mark.parametrize("begins", [0, 7])
def test_a_run_is_forked_at_ticks_that_all_its_worlds_have(begins: int) -> None:
    """The first tick is 1, or that of the run's own fork. The last is the end of the shortest world."""
    of = SimpleNamespace(run="before", tick=begins) if begins else None
    settings = SimpleNamespace(begins=begins, fork=of)
    source: Any = SimpleNamespace(config=settings, ends=np.array([30, 20, 25]), path=Path("run"))
    first = max(begins, 1)
    for at in (first, 20):
        fork._check_tick(source, at)
    says = f"run can be forked at any tick from {first} to 20"
    earlier = "; for an earlier tick, fork before" if begins else ""
    for at, more in ((first - 1, earlier), (21, "")):
        with pytest.raises(InputError) as raised:
            fork._check_tick(source, at)
        assert str(raised.value) == f"--at {at}: {says}{more}"


def test_the_living_at_a_tick_are_on_record_and_in_the_world() -> None:
    """An organism that is born in the tick is alive at its end. One that dies in the tick is not."""
    first = [(0, 9, True), (0, 19, True), (5, 14, True), (10, 30, False)]
    lives = worlds_of(first, [(0, 9, True), (10, 0, False), (11, 0, False)], until=40)
    expected = [1, 2, 3, 5]
    alive, number = np.zeros(2 * CELLS, bool), np.zeros(2 * CELLS, np.uint32)
    cells = lives.world[expected] * CELLS + lives.cell[expected]
    alive[cells], number[cells] = True, lives.id[expected]

    def living(alive: np.ndarray, number: np.ndarray) -> list[tuple[int, int]]:
        organisms = SimpleNamespace(alive=alive, number=SimpleNamespace(lo=number))
        state = SimpleNamespace(world=SimpleNamespace(organisms=organisms))
        settings: Any = SimpleNamespace(cells=CELLS)
        found = fork._living(lives, SimpleNamespace(state=state), settings, at=10)
        return list(zip(found.world.tolist(), found.id.tolist(), strict=True))

    assert living(alive, number) == [(0, 1), (0, 2), (0, 3), (1, 1)]
    one_less, one_other = alive.copy(), number.copy()
    one_less[cells[-1]] = False
    one_other[cells[-1]] += 1
    for change in ((one_less, number), (np.ones_like(alive), number), (alive, one_other)):
        with pytest.raises(Trouble, match="tick 10 did not repeat as recorded"):
            living(*change)


COUNTS = {"food": [100, 2**40], "organism_ticks": [300, 2**50]}
"""Counts of two worlds at a fork. All other counts are 100 and 200."""


def adapted(at: int, old: Config, new: Config) -> Worlds:
    """Return two worlds with the new settings; their `looks` are "looks" before that."""
    worlds: Any = Worlds(*[wide([100, 200])] * len(Worlds._fields))
    worlds = worlds._replace(
        **{name: wide(values) for name, values in COUNTS.items()},
        calm=jnp.array([7, 8]), sample_wait=jnp.array([1, 1]), looks="looks", climate={},
    )  # fmt: skip
    engine: Any = SimpleNamespace(law=SimpleNamespace(beginning=(), seasons=new.seasons))
    organisms: Any = "organisms"
    world = fork._adapt(World(organisms, worlds), engine, engine, old, new, at)
    assert world.organisms == organisms, "organisms keep their energy"
    return world.worlds


OWN = {"seeds": 2, "sample_every": 10, "seed": 3, "metabolism": {"store": 1000.0, "drain": 0.25}}


@pytest.mark.parametrize(
    ("at", "changes", "wait", "again"),
    [
        (10, {}, 10, False),
        (19, {"sample_every": 4, "stop": {"ticks": 500}, "about": "another"}, 1, False),
        (3, {"sample_every": 9, "seed": 4}, 6, True),
        (20, {"metabolism": {"store": 9.0, "cap": 2e3}}, 10, True),
    ],
)
def test_a_fork_is_sampled_on_time_and_must_saturate_again_if_its_lives_can_differ(
    at: int, changes: dict[str, Any], wait: int, again: bool
) -> None:
    """It is sampled at multiples of its own interval."""
    worlds = adapted(at, config(MEADOW, **OWN), config(MEADOW, **{**OWN, **changes}))
    assert worlds.sample_wait.tolist() == [wait, wait]
    assert worlds.calm.tolist() == ([0, 0] if again else [7, 8])
    for moment in (worlds.saturated, worlds.saturated_births):
        assert to_host(moment).tolist() == ([NEVER, NEVER] if again else [100, 200])
    for count in (worlds.fixed, worlds.fixed_births, worlds.births, worlds.tick):
        assert to_host(count).tolist() == [100, 200]
    seed = changes.get("seed", 3)
    assert to_host(worlds.seed).tolist() == [seed, seed + 1]
    assert worlds.looks == "looks"


def ratchet(every: int, above: float = 0.4) -> dict[str, Any]:
    """Return a season that multiplies the drain by 2 if organisms gather more food than `above`."""
    return {"kind": "ratchet", "setting": "metabolism.drain", "when": "food", "above": above,
            "factor": 2.0, "every": every}  # fmt: skip


def looks_of(at: int, old: list[dict[str, Any]], new: list[dict[str, Any]]) -> Any:
    """Return the looks of a fork that has other seasons than before."""
    before, after = (config(MEADOW, **OWN, seasons=seasons) for seasons in (old, new))
    return adapted(at, before, after).looks


def test_new_ratchets_look_at_multiples_of_their_periods_and_count_from_the_fork() -> None:
    """Three ratchets of two worlds. Ratchets go on if no season has changed, not even its place."""
    looks = looks_of(33, [], [ratchet(every) for every in (10, 7, 3)])
    assert looks.wait.tolist() == [[7, 2, 3]] * 2
    for name, counts in COUNTS.items():
        assert to_host(getattr(looks, name)).tolist() == [[each] * 3 for each in counts]
    one, other = ratchet(10), ratchet(10, above=0.5)
    assert looks_of(10, [one, other], [one, other]) == "looks"
    assert looks_of(10, [one, other], [other, one]).wait.tolist() == [[10, 10]] * 2
    assert looks_of(10, [one], []).wait.tolist() == [[]] * 2


def test_a_season_of_a_metabolism_that_there_is_not_is_refused(tmp_path: Path) -> None:
    season = {"kind": "schedule", "setting": "metabolism.gain", "at": 5, "value": 1.0}
    (tmp_path / "config.toml").write_text(config(MEADOW).to_toml())
    source: Any = SimpleNamespace(path=tmp_path, config=SimpleNamespace(on_copies=dict))
    with pytest.raises(InputError, match=r"metabolism\.gain"):
        fork._fork_config(source, {"seasons": [season]}, 3)


def test_hunger_that_is_added_to_a_world_begins_with_full_stores() -> None:
    """So organisms that are alive at the fork starve together."""
    law, nothing = law_of(HERD), [None] * len(Organisms._fields)
    before: Any = SimpleNamespace(law=SimpleNamespace(beginning=()))
    after: Any = SimpleNamespace(law=law)
    climate = dict.fromkeys(law.rates, jnp.zeros(3))
    worlds: Any = Worlds(*[wide([9] * 3)] * len(Worlds._fields))
    worlds = worlds._replace(sample_wait=jnp.ones(3, int), climate=climate, calm=jnp.zeros(3, int))
    world = World(Organisms(*nothing), worlds)
    old, new = config(HERD, metabolism=None), config(HERD)
    energy = fork._adapt(world, before, after, old, new, 9).organisms.energy
    assert energy.tolist() == [400 * ONE] * 3 * 24


def test_births_of_the_living_are_in_order_of_events_and_have_their_own_notes() -> None:
    """Births are in order of ticks, and those of one tick are in order of worlds and cells.

    They have endowments. Mates are left out, since the living are the roots of later lines.
    """
    lives = worlds_of([(9, 0, False), (4, 0, False)], [(4, 0, False), (7, 0, False)], until=40)
    lives = replace(lives, cell=np.array([3, 1, 2, 0]), parent=np.array([-1, 0, -1, 0]))
    lives = lives.take(np.array([3, 0, 2, 1]))
    mutation = SimpleNamespace(notes=("step", "way"))
    heredity = SimpleNamespace(recombination="crossover", mutation=mutation)
    organisms = SimpleNamespace(notes=np.arange(4 * CELLS).reshape(-1, 2))
    engine: Any = SimpleNamespace(
        law=SimpleNamespace(cells=CELLS, heredity=heredity, act="act"),
        state=SimpleNamespace(world=SimpleNamespace(organisms=organisms)),
    )
    source: Any = SimpleNamespace(endowments_of=lambda lives: 100 * lives.world + lives.born)
    words = fork._birth_rows(source, lives, engine)
    rows = birth_columns(True, ("step", "way"), True).unpacked(words)
    expected = {"tick": [4, 4, 7, 9], "cell": [3, 7, 5, 1], "id": [0, 0, 1, 1]}
    expected |= {"parent": [-1, -1, 0, 0], "step": [6, 14, 10, 2], "way": [7, 15, 11, 3]}
    expected |= {"mate": [-1] * 4, "endowment": [4, 104, 107, 9]}
    assert {name: rows[name].tolist() for name in rows if name != "cause"} == expected


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"mutation": {"scale": 0.5}}, {"mutation": {"probability": 0.5, "scale": 0.5}}),
        ({"hazard": 0.0, "seasons": []}, {"hazard": 0.0, "seasons": []}),
    ],
)
def test_a_fork_has_all_other_settings_of_its_source(
    changes: dict[str, Any], expected: dict[str, Any], tmp_path: Path
) -> None:
    """A setting may be changed to 0, or to an empty list."""
    own = {"seed": 3, "hazard": 0.25, "mutation": {"probability": 0.5, "scale": 0.125}}
    own["seasons"] = [{"kind": "schedule", "setting": "hazard", "at": 9, "value": 0.5}]
    (tmp_path / "config.toml").write_text(config(MEADOW, **own).to_toml())
    source: Any = SimpleNamespace(path=tmp_path, config=SimpleNamespace(on_copies=dict))
    forked = fork._fork_config(source, changes, 6)
    values = config(MEADOW, **{**own, **expected}).model_dump()
    assert forked.model_dump() == values | {"fork": {"run": str(tmp_path), "tick": 6}}


class Past:
    """An engine of two worlds that logs the loaded arrays. A call of `advance` lives 2 ticks or fewer."""

    def __init__(self, exact: bool) -> None:
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

    def engine_at(at: int, versions: Sequence[str] = (), exact: bool = True) -> Past:
        monkeypatch.setattr(fork, "Engine", lambda _: Past(exact))
        monkeypatch.setattr(checkpoint, "whole_checkpoints", lambda *_: iter(KEPT))
        source: Any = SimpleNamespace(
            config=None, path=Path("run"), fault_in=None, other_versions=versions,
            arrays_of=lambda each: each,
        )  # fmt: skip
        engine: Any = fork._engine_at(source, at, None)
        return engine

    return engine_at


@pytest.mark.parametrize(("at", "loaded"), [(12, 0), (9, 2), (8, 2), (2, None)])
def test_the_past_is_lived_again_from_the_newest_checkpoint_in_which_no_world_is_later(
    at: int, loaded: int | None, relived: Callable[..., Past]
) -> None:
    engine = relived(at)
    assert engine.loaded == ([] if loaded is None else [KEPT[loaded]])
    assert engine.ticks.tolist() == [at, at]


@pytest.mark.parametrize(
    ("versions", "exact", "says"),
    [
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
