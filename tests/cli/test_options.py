"""Each argument and option of a command reaches the Python function behind it."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest.mock import ANY, MagicMock, call, create_autospec, patch

import numpy as np
import pytest

import primordia
from primordia.cli.streams import report
from tests.commands import complains, here

RUN, OUT = Path("RUN"), Path("OUT")
LIMITS: tuple[Any, ...] = ("--ticks", 90, "--births", "none", "--until", "saturation")
ENDS: dict[str, Any] = {"ticks": 90, "births": "none", "until": "saturation"}
WAYS = ("--checkpoint-every", 7, "--quiet")
WORLDS: dict[str, Any] = {"checkpoint_every": 7.0, "listen": None}


@pytest.fixture
def run() -> Iterator[MagicMock]:
    """Let `load` return a run that notes each call."""
    noted = create_autospec(primordia.Run(RUN), instance=True)
    for name in ("ancestors", "organism"):
        getattr(noted, name).return_value = MagicMock()
    noted.ancestors.return_value.to_dict.return_value = {}
    noted.organism.return_value.evaluate.return_value.to_dict.return_value = {}
    for name in ("standings", "lineages", "heredity", "threshold", "resume"):
        getattr(noted, name).return_value = []
    noted.shadow.return_value.to_dict.return_value = {}
    with patch("primordia.api.load", return_value=noted) as noted.loaded:
        yield noted


def does(*words: object) -> None:
    done = here(*words)
    assert done.returncode == 0, done.stderr


CALLS: dict[tuple[Any, ...], Any] = {
    ("film", RUN, "--world", 2, "--by", "ticks", "--from", 3, "--to", 9, "--organism", 5, "--out", OUT):
        call.film(ticks=(3, 9), world=2, by="ticks", organism=5, out=OUT),
    ("film", RUN, "--from", 0, "--to", 0, "--organism", 0):
        call.film(ticks=(0, 0), world=0, by="births", organism=0, out=None),
    ("film", RUN): call.film(ticks=(None, None), world=0, by="births", organism=None, out=None),
    ("evaluate", RUN, "--world", 2, "--games", 3, "--founders", 7, "--ticks", 9, "--sticky", 0.5,
     "--open-loop", "--island", "i", "--on", "j", "--json"):
        call.standings(world=2, island="i", games=3, ticks=9, senses="ignored",
                       habitat={"sticky": 0.5}, founders=7, on="j"),
    ("evaluate", RUN, "--world", 0, "--json"):
        call.standings(world=0, island=None, games=30, ticks=100_000, senses="live", habitat={},
                       on=None),
    ("evaluate", RUN, "--json"):
        call.standings(world=None, island=None, games=30, ticks=100_000, senses="live", habitat={},
                       on=None),
    ("shadow", RUN, "--organisms", 3, "--ticks", 9, "--island", "i", "--json"):
        call.shadow(3, 9, "i"),
    ("shadow", RUN, "--json"): call.shadow(500, None, None),
    ("assay", "heredity", RUN, "--after", 0.25, "--json"): call.heredity(0.25, None),
    ("assay", "heredity", RUN, "--island", "i", "--json"): call.heredity(0.5, "i"),
    ("assay", "threshold", RUN, "--json"): call.threshold(0.5, None),
    ("assay", "threshold", RUN, "--island", "i", "--json"): call.threshold(0.5, "i"),
    ("track", RUN, "--tensorboard", OUT, "--wandb", "W", "--follow", "--every", 5):
        call.track(OUT, Path("W"), seen=ANY, follow=True, every=5.0),
    ("track", RUN): call.track(None, None, seen=ANY, follow=False, every=30.0),
    ("report", RUN, "--out", OUT): call.report(OUT),
    ("watch", RUN, "--port", 0): call.watch(0, ANY),
    ("phylogeny", RUN, 5, "--out", OUT, "--world", 2, "--extant"):
        call.phylogeny(5, out=OUT, say=report, world=2, extant=True, collapse=False, traits=False),
    ("phylogeny", RUN, 0, "--out", OUT, "--world", 0):
        call.phylogeny(0, out=OUT, say=report, world=0, extant=False, collapse=False, traits=False),
    ("phylogeny", RUN, "--out", OUT, "--collapse", "--traits"):
        call.phylogeny(None, out=OUT, say=report, world=None, extant=False, collapse=True, traits=True),
    ("ancestors", RUN, 5, "--world", 2, "--json"): call.ancestors(5, 2, report),
    ("ancestors", RUN, 0, "--world", 0, "--json"): call.ancestors(0, 0, report),
    ("ancestors", RUN, "--world", 0, "--json"): call.ancestors(None, 0, report),
    ("ancestors", RUN, "--json"): call.ancestors(None, None, report),
    ("lineages", RUN, "--world", 2, "--at", 9, "--json"): call.lineages(2, 9),
    ("lineages", RUN, "--world", 0, "--at", 0, "--json"): call.lineages(0, 0),
    ("lineages", RUN, "--json"): call.lineages(0, None),
    ("lineages", RUN, "--world", "all", "--json"): call.lineages(None, None),
    ("resume", RUN, "--inexact", *LIMITS, *WAYS): call.resume(inexact=True, **ENDS, **WORLDS),
    ("resume", RUN, "--quiet"):
        call.resume(inexact=False, checkpoint_every=60.0, listen=None),
    ("fork", RUN, "--at", 9, "--out", OUT, "--seed", 3, "--mutation.scale", 0.5, *LIMITS, *WAYS):
        call.fork(9, OUT, {"seed": 3, "mutation": {"scale": 0.5}, "stop": ENDS}, **WORLDS),
    ("fork", "of.b", "--at", 0, "--quiet"):
        call.fork(0, Path("runs/of.b-at0"), {}, checkpoint_every=60.0, listen=None),
    ("fork", RUN, "--at", 9, "--quiet"):
        call.fork(9, Path("runs/RUN-at9"), {}, checkpoint_every=60.0, listen=None),
}  # fmt: skip
"""Words of a command -> the call that it makes."""


@pytest.mark.parametrize("words", CALLS, ids=lambda words: " ".join(map(str, words)))
def test_each_argument_reaches_the_function(
    words: tuple[Any, ...], run: MagicMock, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    does(*words)
    assert CALLS[words] in run.mock_calls


@pytest.mark.parametrize(
    "words",
    [
        ("film", RUN), ("evaluate", RUN, "--json"), ("shadow", RUN, "--json"), ("report", RUN),
        ("ancestors", RUN, "--json"), ("resume", RUN, "--quiet"), ("fork", RUN, "--at", 9, "--quiet"),
    ],
    ids=lambda words: words[0],
)  # fmt: skip
def test_code_is_trusted_only_if_asked(
    words: tuple[Any, ...], run: MagicMock, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for asked in (False, True):
        does(*words, *(["--trust"] if asked else []))
        place = (RUN,) if words[0] in ("shadow", "report") else RUN
        assert run.loaded.call_args == call(place, asked)


def test_a_run_is_begun_with_the_settings_of_its_flags(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    task, flags = "CartPole-survival", ("--cells", 8, "--ancestor", "a", "--ancestor", "b")
    given = {"cells": 8, "ancestors": ["a", "b"], "stop": ENDS}
    with patch("primordia.api.run") as asked:
        ways = (*WAYS, "--device", "gpu")
        does("run", task, "--out", OUT, "--resume", *flags, *LIMITS, *ways)
        asked.assert_called_once_with(task, OUT, given, resume=True, device="gpu", **WORLDS)
        does("run", task, "--seed", 3, "--quiet")
        own = {"checkpoint_every": 60.0, "device": "cpu", "listen": None}
        place = Path("runs", f"{task}-seed3")
        assert asked.call_args == call(task, place, {"seed": 3}, resume=False, **own)


def test_a_life_is_lived_again_with_the_given_options(run: MagicMock) -> None:
    with patch("primordia.organism.reliving.compare.relive") as asked:
        asked.return_value.to_dict.return_value = {}
        files = ("--save", OUT, "--video", "V")
        does("relive", RUN, 5, "--world", 2, "--from", 3, *files, "--trust", "--json")
        opened = run.opened.return_value
        asked.assert_called_once_with(opened, 5, 2, since=3, save=OUT, film=Path("V"))
        does("relive", RUN, 0, "--world", 0, "--from", 0, "--json")
        assert asked.call_args == call(opened, 0, 0, since=0, save=None, film=None)
        does("relive", RUN, 5, "--json")
        assert asked.call_args == call(opened, 5, 0, since=None, save=None, film=None)


def test_one_organism_is_evaluated_in_its_world(run: MagicMock) -> None:
    for organism, world, number in ((5, (), 0), (5, ("--world", 2), 2), (0, ("--world", 0), 0)):
        asked = ("--organism", organism, *world, "--freeze-senses", "--games", 3, "--json")
        does("evaluate", RUN, *asked)
        run.organism.assert_called_with(organism, number)
        options = {"games": 3, "ticks": 100_000, "senses": "frozen", "habitat": {}, "on": None}
        run.organism.return_value.evaluate.assert_called_with(**options)


SHORT = ("--games", 2, "--ticks", 9, "--sticky", 0.5, "--json")


def test_the_options_of_assays_reach_their_functions(run: MagicMock) -> None:
    own: dict[str, Any] = {"habitat": {"sticky": 0.5}, "games": 2, "ticks": 9}
    opened = run.opened.return_value
    with patch("primordia.assays.garden.garden", return_value=[]) as garden:
        does("assay", "garden", RUN, "--each", 3, "--after", 0.25, *SHORT)
        garden.assert_called_once_with(opened, each=3, after=0.25, island=None, **own)
        does("assay", "garden", RUN, "--island", "i", *SHORT)
        assert garden.call_args == call(opened, each=20, after=0.5, island="i", **own)
    with patch("primordia.assays.line.line") as line:
        line.return_value.to_dict.return_value = {}
        does("assay", "line", RUN, 5, 6, "--world", 2, "--most", 7, *SHORT)
        assert line.call_args_list == [call(opened, each, 2, most=7, **own) for each in (5, 6)]
        does("assay", "line", RUN, 5, "--json")
        plain = {"most": 200, "habitat": {}, "games": 5, "ticks": 20_000}
        assert line.call_args == call(opened, 5, 0, **plain)
        lives = opened.lives
        lives.oldest = lambda world, after: 3 if world is None else world
        lives.id, lives.world = np.arange(10, 20), np.arange(10)
        for words, number in (((), 3), (("--world", 2), 2), (("--world", 0), 0)):
            does("assay", "line", RUN, *words, "--json")
            assert line.call_args == call(opened, 10 + number, number, **plain)


@pytest.mark.parametrize(
    ("words", "numbers"),
    [
        ((), []),
        ((5, 6), [(5, 0), (6, 0)]),
        ((5, 6, "--world", 2), [(5, 2), (6, 2)]),
        (("--world", 2), [(12, 2)]),
        (("--world", 0), [(10, 0)]),
        ((0,), [(0, 0)]),
    ],
    ids=str,
)
def test_assays_are_of_the_organisms_that_are_named(
    words: tuple[Any, ...], numbers: list[tuple[int, int]], run: MagicMock
) -> None:
    """The longest-lived of world w is in row w and has the number 10 + w."""
    lives = run.opened.return_value.lives
    lives.oldest = lambda world: world
    lives.id = np.arange(10, 20)
    with (
        patch("primordia.assays.subjects.of_run") as of_run,
        patch("primordia.assays.ablate.ablate", return_value=[]) as ablate,
        patch("primordia.assays.effects.effects", return_value=[]) as effects,
    ):
        subjects = of_run.return_value
        subjects.source = "RUN"
        does("assay", "ablate", RUN, *words, "--each-sense", *SHORT)
        of_run.assert_called_with(run.opened.return_value, numbers, {"sticky": 0.5})
        ablate.assert_called_once_with(subjects, True, 2, 9)
        more = ("--mutants", 3, "--scale", 0.5, "--scale", 0.25, "--differs", 0.125)
        does("assay", "effects", RUN, *words, *more, *SHORT)
        effects.assert_called_once_with(subjects, (0.5, 0.25), (0.125,), 3, 2, 9)


@pytest.mark.parametrize("asked", [False, True])
def test_code_of_assays_is_trusted_only_if_asked(asked: bool, run: MagicMock) -> None:
    run.opened.return_value.lives.oldest = lambda world, after: 0
    run.opened.return_value.lives.id = run.opened.return_value.lives.world = np.arange(1)
    places = {"garden": (RUN,), "line": RUN, "ablate": RUN}
    with (
        patch("primordia.assays.subjects.of_run") as of_run,
        patch("primordia.assays.garden.garden", return_value=[]),
        patch("primordia.assays.line.line") as line,
        patch("primordia.assays.ablate.ablate", return_value=[]),
    ):
        line.return_value.to_dict.return_value, of_run.return_value.source = {}, "RUN"
        for name, place in places.items():
            does("assay", name, RUN, "--json", *(["--trust"] if asked else []))
            assert run.loaded.call_args == call(place, asked)


@pytest.mark.parametrize(
    ("words", "kind", "given"),
    [
        (("a.safetensors", 0, 5, "--task", "T"), "file", (Path("a.safetensors"), (0, 5), "T")),
        (("a.safetensors",), "file", (Path("a.safetensors"), (), None)),
        (("a.toml", 0, 5), "task", ("a.toml", (0, 5))),
        (("Pong-survival",), "task", ("Pong-survival", ())),
        (("gym:Pond-v0", 0), "task", ("gym:Pond-v0", (0,))),
    ],
    ids=str,
)
def test_assays_are_of_the_genomes_of_a_file_or_of_founders_of_a_task(
    words: tuple[Any, ...], kind: str, given: tuple[Any, ...]
) -> None:
    with (
        patch(f"primordia.assays.subjects.of_{kind}") as of,
        patch("primordia.assays.ablate.ablate", return_value=[]),
    ):
        of.return_value.source = "its name"
        does("assay", "ablate", *words, "--sticky", 0.5, "--json")
    of.assert_called_once_with(*given, {"sticky": 0.5})


def test_a_run_may_have_the_name_of_a_task(
    run: MagicMock, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("Pong-survival").mkdir()
    with (
        patch("primordia.assays.subjects.of_run") as of_run,
        patch("primordia.assays.ablate.ablate", return_value=[]),
    ):
        of_run.return_value.source = "a run"
        does("assay", "ablate", "Pong-survival", 5, "--world", 2, "--json")
    of_run.assert_called_once_with(run.opened.return_value, [(5, 2)], {})


@pytest.mark.parametrize("source", ["Pong-survival", "gym:Pond-v0", "a.toml", "a.safetensors"])
@pytest.mark.parametrize("world", [0, 2])
def test_only_a_run_has_worlds(source: str, world: int) -> None:
    says = f"{source} is not a run, so it has no worlds; leave out --world"
    complains(here("assay", "ablate", source, "--world", world), 2, says)


@pytest.mark.parametrize(
    ("words", "side"),
    [
        ("runs/a", ("runs/a", (30,), 3, None)),
        ("runs/a:17", ("runs/a", (17,), None, None)),
        ("runs/a:17@2", ("runs/a", (17,), 2, None)),
        ("runs/a:0@0", ("runs/a", (0,), 0, None)),
        ("gym:Pond-v0:5", ("gym:Pond-v0", (5,), None, None)),
        ("b.safetensors", ("b.safetensors", (0,), None, "T")),
        ("b.safetensors:4", ("b.safetensors", (4,), None, "T")),
        ("Pong-survival:5", ("Pong-survival", (5,), None, None)),
    ],
)
def test_a_side_of_a_competition_is_the_organism_that_is_named(
    words: str, side: tuple[Any, ...], run: MagicMock
) -> None:
    run.oldest.return_value.id, run.oldest.return_value.world = 30, 3
    place, organisms, world, task = side
    with (
        patch("primordia.cli.assays.of_pairs.subjects_of") as subjects_of,
        patch("primordia.assays.compete.compete") as compete,
    ):
        compete.return_value.to_dict.return_value = {}
        asked = ("--task", "T", "--worlds", 3, "--ticks", 9, "--sticky", 0.5, "--json", "--trust")
        does("assay", "compete", words, "other.safetensors", *asked)
        expected = call({"sticky": 0.5}, Path(place), organisms, world, task, True)
        assert subjects_of.call_args_list[0] == expected
        compete.assert_called_once_with(subjects_of(), subjects_of(), 3, 9)
