"""Runs side by side: against brute force and SciPy, and what must hold whatever the worlds did."""

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

import primordia
from primordia import loop
from primordia.comparison import Comparison
from primordia.contrast import Figures, contrast
from primordia.errors import InputError
from primordia.lives import ALIVE, Lives
from primordia.resample import interval, resamples
from primordia.survival import survival
from tests.commands import complains, here
from tests.worlds import MEADOW, config

pytestmark = pytest.mark.usefixtures("compiled_once")

WORLDS = 5
QUICK: dict[str, Any] = {
    **MEADOW,
    "brain": {"hidden": 1},
    "seeds": WORLDS,
    "replication": 0.2,
    "hazard": 0.02,
    "saturation_ticks": 12,
    "stop": {"ticks": 600, "until": "saturation"},
}
"""Some worlds saturate by the end, some do not."""


@pytest.fixture(scope="module")
def runs(compiled_once: None, tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Three of one task; in the last, worlds live until they saturate."""
    folder = tmp_path_factory.mktemp("runs")
    changes: dict[str, dict[str, Any]] = {
        "one": {},
        "another": {"seed": 100},
        "patient": {"seed": 200, "stop": {"until": "saturation"}},
    }
    for name, change in changes.items():  # seeds and limits only, so all share compiled code
        loop.start(config({**QUICK, **change}), folder / name)
    return [folder / name for name in changes]


@pytest.fixture(scope="module")
def compared(runs: list[Path]) -> Comparison:
    return primordia.compare(*runs)


def test_figures_of_worlds_are_what_brute_force_finds(
    runs: list[Path], compared: Comparison
) -> None:
    seen = 0
    for path, arm in zip(runs, compared.arms, strict=True):
        run = primordia.Run(path)
        worlds = run.info()["worlds"]
        born, died = (run.table(name).to_pylist() for name in ("births", "deaths"))
        for number, world in enumerate(worlds):
            moment = world["saturation"]
            for unit, key in (("births", "births"), ("ticks", "tick")):
                value = arm.figures[unit].value[number]
                assert arm.figures[unit].known[number] == (moment is not None)
                assert value == (moment[key] if moment else world[unit])
            ends = {row["id"]: row["tick"] for row in died if row["world"] == number}
            lives = [
                (ends.get(row["id"], world["ticks"]) - row["tick"], row["id"] in ends)
                for row in born
                if row["world"] == number
            ]
            age = QUICK["saturation_ticks"]
            long = [lived >= age for lived, _ in lives]
            undecided = [lived < age and not dead for lived, dead in lives]
            first = arm.figures["first"]
            before = int(first.value[number]) - 1
            assert not any(long[:before] + undecided[:before])
            assert long[before] if first.known[number] else [*undecided, True][before]
            mean = restricted_mean(lives, age)
            assert arm.figures["lifespan"].value[number] == pytest.approx(mean)
            seen += len(lives)
        assert arm.saturated == sum(world["saturation"] is not None for world in worlds)
    assert seen > 500
    assert [arm.worlds for arm in compared.arms] == [WORLDS] * 3
    assert compared.arms[2].saturated == WORLDS
    assert any(0 < arm.saturated < WORLDS for arm in compared.arms[:2])


def restricted_mean(lives: list[tuple[int, bool]], limit: int) -> float:
    """One age after the other: who reaches it, and who of those dies at it."""
    alive, area = 1.0, 0.0
    for age in range(limit):
        area += alive
        reach = [died and lived == age + 1 for lived, died in lives if lived >= age + 1]
        alive *= 1 - sum(reach) / len(reach) if reach else 1.0
    return area


def test_settings_that_differ_are_named(compared: Comparison) -> None:
    assert compared.arms[0].settings == {"seed": 0, "stop.ticks": 600}
    assert [arm.settings["seed"] for arm in compared.arms] == [0, 100, 200]


LIFE = st.tuples(st.integers(1, 30), st.booleans())
LIVED = st.lists(st.lists(LIFE, min_size=1, max_size=12), min_size=1, max_size=6)


def made(worlds: list[list[tuple[int, bool]]]) -> Lives:
    """Lives of given lengths, each dead or not."""
    rows = [(world, *life) for world, lives in enumerate(worlds) for life in lives]
    world, lifespan, died = (np.array(column) for column in zip(*rows, strict=True))
    nothing = np.zeros(len(rows), np.int64)
    cause = np.where(died, 0, ALIVE).astype(np.int8)
    return Lives(world, nothing, nothing - 1, nothing, nothing, nothing, lifespan, cause)


@given(LIVED, st.integers(1, 40))
def test_survival_is_kaplan_and_meiers(worlds: list[list[tuple[int, bool]]], limit: int) -> None:
    lives = made(worlds)
    found = survival(lives, len(worlds), limit)
    split = stats.CensoredData(lives.lifespan[lives.died], right=lives.lifespan[~lives.died])
    expected = stats.ecdf(split).sf.evaluate(found.ages)
    np.testing.assert_allclose(found.curve, expected, atol=1e-12)
    for lived, mean in zip(worlds, found.restricted_mean, strict=True):
        assert mean == pytest.approx(restricted_mean(lived, limit))


def test_band_is_that_of_worlds_drawn_again() -> None:
    draws = np.random.default_rng(1)
    worlds = [
        [(int(life), True) for life in draws.geometric(rate, 40)] for rate in (0.1, 0.2, 0.3, 0.5)
    ]
    found = survival(made(worlds), 4, 20)
    curves = []
    for drawn in resamples(4):
        lifespans = np.array([life for world in drawn for life, _ in worlds[world]])
        curves.append([(lifespans > age).mean() for age in found.ages])
    low, high = interval(np.array(curves))
    np.testing.assert_allclose(found.band[0], low, atol=1e-6)
    np.testing.assert_allclose(found.band[1], high, atol=1e-6)
    assert (low < found.curve).any()
    assert (found.curve < high).any()


WORLD = st.tuples(st.integers(1, 20), st.booleans())
SOME = st.lists(WORLD, min_size=1, max_size=12)


def figures(worlds: list[tuple[int, bool]]) -> Figures:
    value, known = (np.array(column) for column in zip(*worlds, strict=True))
    return Figures(value.astype(float), known)


@given(SOME, SOME)
def test_delta_counts_pairs_whose_order_is_known(run: list, reference: list) -> None:
    found = contrast(figures(run), figures(reference))
    balance = decided = 0
    for value, known in run:
        for other, other_known in reference:
            larger, smaller = other_known and value > other, known and value < other
            balance += larger - smaller
            decided += larger or smaller or (known and other_known)
    pairs = len(run) * len(reference)
    assert found.delta == pytest.approx(balance / pairs)
    assert found.decided == pytest.approx(decided / pairs)


@given(SOME, SOME)
def test_delta_turns_round_with_the_runs(run: list, reference: list) -> None:
    one, other = figures(run), figures(reference)
    assert contrast(one, other).delta == -contrast(other, one).delta
    assert contrast(one, one).delta == 0
    assert contrast(one, one).word == "negligible"


@given(SOME, SOME, st.integers(1, 20))
def test_delta_grows_with_the_figures(run: list, reference: list, by: int) -> None:
    more = [(value + by, known) for value, known in run]
    base = figures(reference)
    assert contrast(figures(more), base).delta >= contrast(figures(run), base).delta
    beyond = [(value + 20, known) for value, known in run]
    if all(known for _, known in reference):
        assert contrast(figures(beyond), base).delta == 1


@given(SOME, st.lists(st.integers(0, 30), min_size=12, max_size=12))
def test_bounds_hold_however_worlds_would_have_gone_on(run: list, on: list[int]) -> None:
    later = [value + more * (not known) for (value, known), more in zip(run, on, strict=False)]
    for q in (0.25, 0.5, 0.75):
        low, high = figures(run).quantile(q)
        assert low <= np.quantile(later, q, method="inverted_cdf") <= high
    known = Figures(np.array(later, float), np.ones(len(later), bool))
    base = figures([(5, True), (9, True), (12, True)])
    sure, unsure = contrast(known, base), contrast(figures(run), base)
    assert unsure.ratio[0] <= sure.ratio[0] == sure.ratio[1] <= unsure.ratio[1]
    assert abs(sure.delta - unsure.delta) <= 1 - unsure.decided + 1e-9


@given(SOME, st.integers(1, 25))
def test_a_horizon_forgets_what_lies_beyond(run: list, horizon: int) -> None:
    whole = figures(run)
    if any(not known and value < horizon for value, known in run):
        with pytest.raises(InputError, match="nothing can be said"):
            whole.before(horizon)
        return
    near = whole.before(horizon)
    assert near.known.sum() == sum(known and value < horizon for value, known in run)
    assert near.value.max() <= horizon
    others = figures([(value if value < horizon else horizon + 7, True) for value, _ in run])
    assert contrast(near, others.before(horizon)).delta == 0


def test_intervals_hold_the_true_ratio() -> None:
    draws = np.random.default_rng(0)
    held = 0
    for _ in range(200):
        one, other = (Figures(draws.lognormal(mean, 0.5, 40), np.ones(40, bool)) for mean in (1, 0))
        low, high = contrast(one, other).interval
        held += low <= np.e <= high
    assert 180 <= held <= 200  # of 190 expected


def test_resamples_are_even_and_independent() -> None:
    drawn = resamples(20)
    assert drawn.shape == (1000, 20)
    counts = np.bincount(drawn.ravel(), minlength=20)
    assert stats.chisquare(counts).pvalue > 0.001
    assert (drawn == resamples(20)).all()
    assert (drawn == resamples(20, stream=1)).mean() == pytest.approx(0.05, abs=0.01)


@pytest.mark.parametrize(
    ("delta", "word"), [(0.1, "negligible"), (0.2, "small"), (-0.4, "medium"), (-0.9, "large")]
)
def test_words_for_sizes(delta: float, word: str) -> None:
    share = round((1 + delta) / 2 * 100)
    run = figures([(3, True)] * share + [(1, True)] * (100 - share))
    found = contrast(run, figures([(2, True)]))
    assert found.delta == pytest.approx(delta, abs=0.02)
    assert found.word == word


def test_the_command_shows_tables_and_draws_a_figure(runs: list[Path], tmp_path: Path) -> None:
    done = here("compare", *runs, "--out", tmp_path / "new")
    assert done.returncode == 0, done.stderr
    for word in ("one", "another", "patient", "births to saturation", "mean lifespan", "reference"):
        assert word in done.stdout
    for name in ("compare.png", "compare.svg"):
        assert (tmp_path / "new" / name).stat().st_size > 10_000
        assert str(tmp_path / "new" / name) in done.stdout


def test_json_is_one_object_and_is_the_same_each_time(runs: list[Path], tmp_path: Path) -> None:
    one, two = (here("compare", *runs[:2], "--json", "--out", tmp_path) for _ in range(2))
    assert one.stdout == two.stdout
    found = json.loads(one.stdout)
    assert [run["name"] for run in found["runs"]] == ["one", "another"]
    assert found["runs"][1]["births"]["against"]["word"] in (
        "small",
        "medium",
        "large",
        "negligible",
    )


def test_a_horizon_that_all_worlds_were_followed_to(runs: list[Path], tmp_path: Path) -> None:
    found = primordia.compare(*runs, ticks=600)
    for arm, whole in zip(found.arms, primordia.compare(*runs).arms, strict=True):
        within = whole.figures["ticks"].known & (whole.figures["ticks"].value < 600)
        assert arm.saturated == within.sum()
    early = primordia.compare(*runs, ticks=100)
    assert early.arms[0].saturated <= found.arms[0].saturated
    assert (
        "saturated within 100 ticks"
        in here("compare", *runs, "--ticks", 100, "--out", tmp_path).stdout
    )


def test_what_cannot_be_compared(runs: list[Path], tmp_path: Path) -> None:
    other = shutil.copytree(runs[0], tmp_path / "other")
    settings = (other / "config.toml").read_text().replace('task = "meadow"', 'task = "pasture"')
    (other / "config.toml").write_text(settings)
    complains(here("compare"), 2, "two runs or more")
    complains(here("compare", runs[0]), 2, "two runs or more")
    complains(here("compare", runs[0], runs[0]), 2, "given twice")
    complains(here("compare", runs[0], other), 2, "meadow", "pasture")
    complains(here("compare", runs[0], tmp_path / "none"), 2, "none")
    complains(here("compare", *runs, "--ticks", 601), 2, "--ticks 601", "stopped at 600")
    complains(here("compare", *runs, "--births", 0), 2, "--births")


def test_a_run_cut_off_before_anything_lived(runs: list[Path], tmp_path: Path) -> None:
    empty = tmp_path / "empty"
    empty.mkdir()
    for name in ("config.toml", "versions.json"):
        (empty / name).write_bytes((runs[0] / name).read_bytes())
    complains(here("compare", runs[0], empty), 2, "no checkpoint yet")
