"""The neutral shadow: it finds selection where there was some, and nothing where there was none."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import binomtest

import primordia
from primordia.comparison.shadow import Shadow, _lifespans
from primordia.runs import loop
from tests.commands import complains, here
from tests.worlds import MEADOW, config

pytestmark = pytest.mark.usefixtures("optimised")  # a pedigree is thousands of small calls


@pytest.fixture(scope="module")
def poles(tmp_path_factory: pytest.TempPathFactory, optimised: None) -> dict[str, primordia.Run]:
    """Make six worlds with heredity, and six without."""
    folder, settings = tmp_path_factory.mktemp("poles"), {"seeds": 6, "stop": {"ticks": 12_000}}
    return {
        name: primordia.run("CartPole-survival", folder / name, inheritance=name, **settings)
        for name in ("parent", "founder")
    }


def of(original: list[list[int]], shadow: list[list[int]], cut: int = 100) -> Shadow:
    """Return a result with these lives in each world."""
    world = np.repeat(np.arange(len(original)), [len(each) for each in original])
    lives = (np.concatenate(each).astype(np.int64) for each in (original, shadow))
    return Shadow("run", len(world), world.astype(np.int32), *lives, cut)  # type: ignore[call-arg]


def test_selection_is_found_where_children_inherit(poles: dict[str, primordia.Run]) -> None:
    found = poles["parent"].shadow(40, 500)
    assert found.longer == (6, 0)
    assert found.p == 2 / 2**6
    assert found.ratio_interval is not None
    assert 1.5 < found.ratio_interval[0] <= found.ratio <= found.ratio_interval[1]


def test_nothing_is_found_where_children_inherit_nothing(poles: dict[str, primordia.Run]) -> None:
    """Founders are drawn, and no draw has anything to do with those before it."""
    found = poles["founder"].shadow(40, 500)
    assert found.p > 0.05
    assert found.ratio_interval is not None
    assert found.ratio_interval[0] < 1 < found.ratio_interval[1]


def test_nothing_is_found_where_only_accidents_kill(tmp_path: Path) -> None:
    loop.start(config(MEADOW, hazard=0.05, seeds=5, stop={"ticks": 200}), tmp_path / "run")
    found = primordia.load(tmp_path / "run").shadow(20, 50)
    assert (found.original == found.shadow).all()
    assert (found.longer, found.p, found.ratio) == ((0, 0), 1.0, 1.0)


def test_a_life_is_the_same_beside_any_others(poles: dict[str, primordia.Run]) -> None:
    run = poles["parent"].opened()
    rows = np.flatnonzero(run.lives.rank < 60)[::6]
    for redrawn in (False, True):
        together = _lifespans(run, rows, redrawn, 100)
        assert len(np.unique(together)) > 10
        alone = _lifespans(run, rows[1::2], redrawn, 100)
        np.testing.assert_array_equal(alone, together[1::2])


@given(st.lists(st.tuples(st.integers(1, 9), st.integers(1, 9)), min_size=1, max_size=30))
def test_the_sign_test_is_the_binomial_test(pairs: list[tuple[int, int]]) -> None:
    found = of([[one] for one, _ in pairs], [[other] for _, other in pairs])
    more, fewer = sum(a > b for a, b in pairs), sum(a < b for a, b in pairs)
    assert found.longer == (more, fewer)
    expected = binomtest(more, more + fewer).pvalue if more + fewer else 1.0
    assert found.p == pytest.approx(expected)
    assert (found.ratio_interval is None) == (len(pairs) < 5)


def test_means_are_taken_world_by_world() -> None:
    found = of([[10, 30], [40]], [[10, 10], [20]], cut=40)
    assert [mean.tolist() for mean in found.means] == [[20, 40], [10, 20]]
    assert found.ratio == 2
    told = found.to_dict()
    assert told["original"] == {"mean": pytest.approx(80 / 3), "reached_cut": 1}
    assert told["ticks"] == 80 + 40


def test_the_command_prints_what_python_gives(poles: dict[str, primordia.Run]) -> None:
    run = poles["parent"]
    done = here("shadow", run.path, "--organisms", 10, "--ticks", 100, "--json")
    told = run.shadow(10, 100).to_dict()
    assert json.loads(done.stdout) == {"arms": [{**told, "interval": list(told["interval"])}]}
    text = here("shadow", run.path, "--organisms", 10, "--ticks", 100).stdout
    assert text.startswith("parent: 60 organisms, each born again alone, from ")
    assert "95 % interval" in text
    complains(here("shadow", run.path, "--organisms", 0), 2, "--organisms", "0")
    complains(here("shadow", run.path.parent / "no"), 2, "no")


def test_organisms_are_spread_over_all_births(poles: dict[str, primordia.Run]) -> None:
    """Each world gives the number asked for, or all that it has."""
    run = poles["parent"]
    lives = run.lives()
    assert len(run.shadow(10**6, 1).world) == len(lives) - 6  # the last of each world is left out
    assert np.bincount(run.shadow(3, 1).world).tolist() == [3] * 6
