"""Each argument of a command reaches the Python function behind it, and the result is printed."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest.mock import ANY, MagicMock, call, create_autospec, patch

import numpy as np
import pytest
from safetensors import safe_open
from safetensors.numpy import save_file

import primordia
from primordia.cli import shadow
from primordia.cli.streams import report
from tests.commands import complains, here
from tests.worlds import MEADOW, config

RUN, OUT = Path("RUN"), Path("OUT")
LIMITS: tuple[Any, ...] = ("--ticks", 90, "--births", "none", "--until", "saturation")
ENDS: dict[str, Any] = {"ticks": 90, "births": "none", "until": "saturation"}
WAYS = ("--checkpoint-every", 7, "--quiet")
WORLDS: dict[str, Any] = {"checkpoint_every": 7.0, "listen": None}
OPENED = MagicMock()
"""The records of any run, in which the longest-lived of world w is in row w and has the number 10 + w."""
OPENED.lives.oldest = lambda world, after=0.5: 3 if world is None else world
OPENED.lives.id, OPENED.lives.world = np.arange(10, 20), np.arange(10)
SUBJECTS = MagicMock(source="its name")


@pytest.fixture(scope="module")
def noted() -> MagicMock:
    """Return what takes the place of a run; to make it takes a while."""
    return create_autospec(primordia.Run(RUN), instance=True)


@pytest.fixture
def run(noted: MagicMock, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[MagicMock]:
    """Let `load` return a run that notes each call. The current folder is empty."""
    monkeypatch.chdir(tmp_path)
    noted.reset_mock()
    for name in ("ancestors", "organism", "oldest"):
        getattr(noted, name).return_value = MagicMock(id=30, world=3)
    noted.ancestors.return_value.to_dict.return_value = {}
    noted.organism.return_value.evaluate.return_value.to_dict.return_value = {}
    for name in ("standings", "lineages", "heredity", "threshold", "resume", "verify"):
        getattr(noted, name).return_value = []
    noted.shadow.return_value.to_dict.return_value = {}
    noted.info.return_value = {"births": 3}
    noted.plot.return_value = [Path("a.png"), Path("a.svg")]
    noted.oldest.return_value.replay.return_value = Path("life.mp4")
    noted.export.return_value = 7, 9
    noted.opened.return_value = OPENED
    with patch("primordia.api.load", return_value=noted) as noted.loaded:
        yield noted


@pytest.fixture
def measure(monkeypatch: pytest.MonkeyPatch) -> MagicMock:
    """Let assays measure nothing; return a log of their calls."""
    log = MagicMock()
    for name in ("garden", "ablate", "effects", "line", "compete", "transplant", "generalists"):
        monkeypatch.setattr(f"primordia.assays.{name}.{name}", getattr(log, name))
        getattr(log, name).return_value = []
    log.line.return_value = log.compete.return_value = MagicMock()
    log.line.return_value.to_dict.return_value = {}
    for kind in ("of_run", "of_file", "of_task"):
        monkeypatch.setattr(f"primordia.assays.subjects.{kind}", getattr(log, kind))
        getattr(log, kind).return_value = SUBJECTS
    return log


def does(*words: object) -> str:
    done = here(*words)
    assert done.returncode == 0, done.stderr
    return done.stdout


def words_of(words: tuple[Any, ...]) -> str:
    return " ".join(map(str, words))


CALLS: dict[tuple[Any, ...], Any] = {
    ("info", RUN, "--json"): call.info(),
    ("plot", RUN): call.plot(None, 0, ()),
    ("plot", RUN, "--out", OUT, "--world", 2, "--figure", "ages", "--figure", "my:own"):
        call.plot(OUT, 2, ("ages", "my:own")),
    ("replay", RUN): call.oldest(None).replay(None, (None, None), []),
    ("replay", RUN, "--world", 0, "--beside", 0, "--beside", "other"):
        call.oldest(0).replay(None, (None, None), [0, ANY]),
    ("replay", RUN, "--organism", 0): call.organism(0, 0).replay(None, (None, None), []),
    ("replay", RUN, "--organism", 5, "--world", 3, "--beside", 2, "--beside", 1, "--from", 4,
     "--to", 9, "--out", OUT): call.organism(5, 3).replay(OUT, (4, 9), [2, 1]),
    ("export", RUN, OUT): call.export(OUT, world=0),
    ("export", RUN, OUT, "--world", 2, "--organism", 9, "--organism", 7):
        call.export(OUT, 9, 7, world=2),
    ("verify", RUN, "--device", "cpu"): call.verify(),
    ("film", RUN, "--world", 2, "--by", "ticks", "--from", 3, "--to", 9, "--organism", 5, "--out", OUT):
        call.film(ticks=(3, 9), world=2, by="ticks", organism=5, out=OUT),
    ("film", RUN, "--from", 0, "--to", 0, "--organism", 0):
        call.film(ticks=(0, 0), world=0, by="births", organism=0, out=None),
    ("film", RUN): call.film(ticks=(None, None), world=0, by="births", organism=None, out=None),
    ("evaluate", RUN, "--world", 0, "--games", 3, "--founders", 7, "--ticks", 9, "--sticky", 0.5,
     "--open-loop", "--island", "i", "--on", "j", "--json"):
        call.standings(world=0, island="i", games=3, ticks=9, senses="ignored",
                       habitat={"sticky": 0.5}, founders=7, on="j"),
    ("evaluate", RUN, "--json"):
        call.standings(world=None, island=None, games=30, ticks=100_000, senses="live", habitat={},
                       on=None),
    ("evaluate", RUN, "--organism", 5, "--world", 2, "--freeze-senses", "--games", 3, "--json"):
        call.organism(5, 2).evaluate(games=3, ticks=100_000, senses="frozen", habitat={}, on=None),
    ("evaluate", RUN, "--organism", 0, "--json"):
        call.organism(0, 0).evaluate(games=30, ticks=100_000, senses="live", habitat={}, on=None),
    ("shadow", RUN, "--organisms", 3, "--ticks", 9, "--island", "i", "--json"):
        call.shadow(3, 9, "i"),
    ("shadow", RUN, "--json"): call.shadow(500, None, None),
    ("assay", "heredity", RUN, "--after", 0.25, "--json"): call.heredity(0.25, None),
    ("assay", "heredity", RUN, "--island", "i", "--json"): call.heredity(0.5, "i"),
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
    ("ancestors", RUN, 0, "--world", 2, "--json"): call.ancestors(0, 2, report),
    ("ancestors", RUN, "--world", 0, "--json"): call.ancestors(None, 0, report),
    ("ancestors", RUN, "--json"): call.ancestors(None, None, report),
    ("lineages", RUN, "--world", 2, "--at", 0, "--json"): call.lineages(2, 0),
    ("lineages", RUN, "--json"): call.lineages(0, None),
    ("lineages", RUN, "--world", "all", "--json"): call.lineages(None, None),
    ("resume", RUN, "--inexact", *LIMITS, *WAYS): call.resume(inexact=True, **ENDS, **WORLDS),
    ("resume", RUN, "--quiet"):
        call.resume(inexact=False, checkpoint_every=60.0, listen=None),
    ("fork", RUN, "--at", 9, "--out", OUT, "--seed", 3, "--mutation.scale", 0.5, *LIMITS, *WAYS):
        call.fork(9, OUT, {"seed": 3, "mutation": {"scale": 0.5}, "stop": ENDS}, **WORLDS),
    ("fork", "of.b", "--at", 0, "--quiet"):
        call.fork(0, Path("runs/of.b-at0"), {}, checkpoint_every=60.0, listen=None),
}  # fmt: skip
"""Words of a command -> the call that it makes of a run."""


@pytest.mark.parametrize("words", CALLS, ids=words_of)
def test_each_argument_reaches_the_function(words: tuple[Any, ...], run: MagicMock) -> None:
    does(*words)
    assert all(each in run.mock_calls for each in CALLS[words].call_list())


SHORT = ("--games", 2, "--ticks", 9, "--sticky", 0.5, "--json")
OWN: dict[str, Any] = {"habitat": {"sticky": 0.5}, "games": 2, "ticks": 9}
PLAIN: dict[str, Any] = {"habitat": {}, "games": 5, "ticks": 20_000}
FILE, TASK, DOOR = Path("a.safetensors"), "Pong-survival", "gym:Pond-v0"
ASSAYS: dict[tuple[Any, ...], list[Any]] = {
    ("garden", RUN, "--each", 3, "--after", 0.25, "--island", "i", *SHORT):
        [call.garden(OPENED, each=3, after=0.25, island="i", **OWN)],
    ("garden", RUN, "--json"): [call.garden(OPENED, each=20, after=0.5, island=None, **PLAIN)],
    ("line", RUN, 5, 6, "--world", 2, "--most", 7, *SHORT):
        [call.line(OPENED, each, 2, most=7, **OWN) for each in (5, 6)],
    ("line", RUN, 5, "--json"): [call.line(OPENED, 5, 0, most=200, **PLAIN)],
    ("line", RUN, "--json"): [call.line(OPENED, 13, 3, most=200, **PLAIN)],
    ("line", RUN, "--world", 0, "--json"): [call.line(OPENED, 10, 0, most=200, **PLAIN)],
    ("ablate", RUN, "--each-sense", *SHORT):
        [call.of_run(OPENED, [], {"sticky": 0.5}), call.ablate(SUBJECTS, True, 2, 9)],
    ("ablate", RUN, 0, 6, "--json"): [call.of_run(OPENED, [(0, 0), (6, 0)], {})],
    ("ablate", RUN, 5, 6, "--world", 2, "--json"): [call.of_run(OPENED, [(5, 2), (6, 2)], {})],
    ("ablate", RUN, "--world", 0, "--json"): [call.of_run(OPENED, [(10, 0)], {})],
    ("effects", RUN, "--mutants", 3, "--scale", 0.5, "--scale", 0.25, "--differs", 0.125, *SHORT):
        [call.effects(SUBJECTS, (0.5, 0.25), (0.125,), 3, 2, 9)],
    ("ablate", FILE, 0, 5, "--task", "T", *SHORT): [call.of_file(FILE, (0, 5), "T", {"sticky": 0.5})],
    ("ablate", FILE, "--json"): [call.of_file(FILE, (), None, {})],
    ("ablate", "a.toml", 0, 5, *SHORT): [call.of_task("a.toml", (0, 5), {"sticky": 0.5})],
    ("ablate", TASK, "--json"): [call.of_task(TASK, (), {})],
    ("ablate", DOOR, 0, "--json"): [call.of_task(DOOR, (0,), {})],
    ("compete", "runs/a", f"{FILE}:4", "--task", "T", "--worlds", 3, "--ticks", 7, "--sticky", 0.5,
     "--json"):
        [call.of_run(OPENED, [(30, 3)], {"sticky": 0.5}),
         call.of_file(FILE, (4,), "T", {"sticky": 0.5}), call.compete(SUBJECTS, SUBJECTS, 3, 7)],
    ("compete", "runs/a:17", FILE, "--json"):
        [call.of_run(OPENED, [(17, 0)], {}), call.of_file(FILE, (0,), None, {})],
    ("compete", "runs/a:0@2", f"{DOOR}:5", "--task", "T", "--json"):
        [call.of_run(OPENED, [(0, 2)], {}), call.of_task(DOOR, (5,), {})],
    ("transplant", RUN, "--each", 3, "--after", 0.25, "--games", 2, "--ticks", 9, "--json"):
        [call.transplant(OPENED, each=3, after=0.25, games=2, ticks=9)],
    ("generalists", RUN, "--most", 7, "--each", 3, "--json"):
        [call.generalists(OPENED, most=7, each=3, after=0.5, games=5, ticks=20_000)],
}  # fmt: skip
"""Words of an assay -> calls that it makes."""


@pytest.mark.usefixtures("run")
@pytest.mark.parametrize("words", ASSAYS, ids=words_of)
def test_each_argument_of_an_assay_reaches_the_function(
    words: tuple[Any, ...], measure: MagicMock
) -> None:
    does("assay", *words)
    assert all(each in measure.mock_calls for each in ASSAYS[words])


@pytest.mark.usefixtures("measure")
@pytest.mark.parametrize(
    "words",
    [
        ("replay", RUN, "--beside", "other"), ("export", RUN, OUT), ("verify", RUN), ("film", RUN),
        ("evaluate", RUN, "--json"), ("shadow", RUN, "--json"), ("report", RUN),
        ("ancestors", RUN, "--json"), ("resume", RUN, "--quiet"), ("fork", RUN, "--at", 9, "--quiet"),
        ("assay", "garden", RUN, "--json"), ("assay", "line", RUN, "--json"),
        ("assay", "ablate", RUN, "--json"), ("assay", "compete", RUN, f"{RUN}:5", "--json"),
    ],
    ids=words_of,
)  # fmt: skip
def test_code_is_trusted_only_if_asked(words: tuple[Any, ...], run: MagicMock) -> None:
    for asked in (False, True):
        run.loaded.reset_mock()
        does(*words, *(["--trust"] if asked else []))
        loads = run.loaded.call_args_list
        assert {each.args[0] for each in loads} <= {RUN, (RUN,), Path("other")}
        assert {each.args[1] for each in loads} == {asked}


def test_several_runs_are_one_arm(run: MagicMock) -> None:
    commands = "info --json", "plot", "assay heredity --json", "shadow --json", "report", "track"
    for words in commands:
        does(*words.split(), "one", "two")
        assert run.loaded.call_args.args[0] == (Path("one"), Path("two"))


PRINTED = {
    ("info", RUN, "--json"): '{"births": 3}',
    ("plot", RUN): "a.png\na.svg",
    ("replay", RUN): "life.mp4",
    ("export", RUN, OUT): "OUT: organism 7, 9",
    ("verify", RUN):
        "RUN is verified: every world was repeated from its beginning with the same result.",
}  # fmt: skip


@pytest.mark.usefixtures("run")
@pytest.mark.parametrize("words", PRINTED, ids=words_of)
def test_a_command_prints_the_result(words: tuple[Any, ...]) -> None:
    assert does(*words) == PRINTED[words] + "\n"


def test_the_first_difference_of_a_run_is_named(run: MagicMock) -> None:
    run.verify.return_value = ["tick 3 of world 1", "tick 9"]
    done = here("verify", RUN)
    complains(done, 1, "RUN differs from its records when repeated: tick 3 of world 1\n")
    assert done.stdout == ""


def test_a_comparison_is_printed_as_tables_or_json_and_drawn(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    pictures = [Path("compare.png"), Path("compare.svg")]
    with (
        patch("primordia.api.compare") as compare,
        patch("primordia.comparison.tables.comparison_tables", return_value="the tables"),
        patch("primordia.figures.comparison.save", return_value=pictures) as save,
    ):
        compare.return_value.to_dict.return_value = {"runs": 2}
        told = does("compare", "a=one", "two")
        assert told == "the tables\nFigure: compare.png and compare.svg\n"
        assert compare.call_args == call("a=one", "two", births=None, ticks=None, island=None)
        assert save.call_args == call(compare.return_value, Path())
        given = "--births", 1, "--ticks", 8, "--island", "i", "--out", "new", "--json"
        assert json.loads(does("compare", "one", "two", *given)) == {"runs": 2}
        assert compare.call_args == call("one", "two", births=1, ticks=8, island="i")
        assert save.call_args == call(compare.return_value, Path("new"))
    assert Path("new").is_dir()


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


@pytest.mark.usefixtures("run")
def test_a_life_is_lived_again_with_the_given_options() -> None:
    with patch("primordia.organism.reliving.compare.relive") as asked:
        asked.return_value.to_dict.return_value = {}
        files = ("--save", OUT, "--video", "V")
        does("relive", RUN, 5, "--world", 2, "--from", 0, *files, "--json")
        asked.assert_called_once_with(OPENED, 5, 2, since=0, save=OUT, film=Path("V"))
        does("relive", RUN, 0, "--json")
        assert asked.call_args == call(OPENED, 0, 0, since=None, save=None, film=None)


@pytest.mark.usefixtures("run")
def test_a_run_may_have_the_name_of_a_task(measure: MagicMock) -> None:
    Path(TASK).mkdir()
    does("assay", "ablate", TASK, 5, "--world", 2, "--json")
    measure.of_run.assert_called_once_with(OPENED, [(5, 2)], {})


@pytest.mark.parametrize("source", [TASK, DOOR, "a.toml", str(FILE)])
def test_only_a_run_has_worlds(source: str) -> None:
    says = f"{source} is not a run, so it has no worlds; leave out --world"
    complains(here("assay", "ablate", source, "--world", 0), 2, says)


def test_every_arm_of_an_experiment_is_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    experiment = create_autospec(primordia.Experiment, instance=True)
    experiment.arms = {name: MagicMock(path=OUT / name) for name in ("mild", "harsh")}
    for name, arm in experiment.arms.items():
        arm.heredity.return_value = [arm.shadow.return_value]
        arm.shadow.return_value.to_dict.return_value = {"of": name}
    monkeypatch.setattr(shadow, "shadow_text", lambda found: f"text of {found.to_dict()['of']}")
    with patch("primordia.api.load", return_value=experiment):
        told = json.loads(does("assay", "heredity", "OUT", "--json"))
        assert told == {"OUT/mild": [{"of": "mild"}], "OUT/harsh": [{"of": "harsh"}]}
        told = json.loads(does("shadow", "OUT", "--json"))
        assert told == {"arms": [{"of": "mild"}, {"of": "harsh"}]}
        assert does("shadow", "OUT") == "text of mild\n\ntext of harsh\n"


def test_imported_weights_name_their_task_and_the_run_that_takes_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The file of settings names the task, and `run` takes this file."""
    monkeypatch.chdir(tmp_path)
    chosen = config(MEADOW, brain={"kind": "feed-forward", "hidden": 2})
    Path("mine.toml").write_text(chosen.to_toml(), encoding="utf-8")
    layout = chosen.build_layout(chosen.build_habitat())
    save_file({name: np.ones(shape, np.float32) for name, shape in layout.blocks}, "state")
    told = does("import", "state", "genome", "--task", "mine.toml")
    assert told == "genome: primordia run mine.toml --ancestor genome\n"
    with safe_open("genome", "numpy") as genome:
        assert genome.metadata() == {"task": "meadow"}
