"""Export of organisms to files."""

from pathlib import Path

from primordia.runs import loop
from tests.commands import complains, here
from tests.worlds import MEADOW, config


def test_an_organism_of_no_world_is_one_line(tmp_path: Path) -> None:
    run, file = tmp_path / "run", tmp_path / "a.safetensors"
    loop.start(config({**MEADOW, "seeds": 1, "stop": {"ticks": 5}}), run)
    words = "export", run, file, "--organism", 0, "--world", 3
    complains(here(*words), 2, "no organism 0 was born in world 3")
    assert not file.exists()
