"""Jobs on a Ray cluster make the same worlds, also if a node dies in the middle."""

import socket
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest

import primordia
from primordia.experiments import on_ray
from primordia.experiments.campaign import begin
from primordia.experiments.status import CampaignStatus
from primordia.runs import loop
from tests.commands import complains, here
from tests.experiments.meadows import write
from tests.worlds import digests_of

pytestmark = [
    pytest.mark.skipif(find_spec("ray") is None, reason="Ray is not installed"),
    pytest.mark.filterwarnings("ignore::ResourceWarning"),  # of Ray
    pytest.mark.filterwarnings("ignore::FutureWarning"),  # of Ray
    pytest.mark.filterwarnings("ignore:os.fork:RuntimeWarning"),  # of JAX, when Ray begins
]


def same_as_alone(out: Path) -> None:
    """Compare the worlds of an experiment with those of one run for each arm."""
    for arm in begin(out).plan.arms:
        loop.start(arm.config, out.parent / "alone" / arm.name)
        assert digests_of(out / arm.name) == digests_of(out.parent / "alone" / arm.name)


@pytest.mark.slow
def test_tasks_of_ray_make_the_same_worlds(tmp_path: Path) -> None:
    out = tmp_path / "out"
    primordia.experiment(write(tmp_path, arms=[{"name": "all"}]), out, ray="")
    assert begin(out).status().jobs["done"] == 2
    assert not list(out.glob(".seen*"))
    same_as_alone(out)


@pytest.mark.slow
def test_a_node_that_dies_in_the_middle_changes_no_world(tmp_path: Path) -> None:
    from ray.cluster_utils import Cluster

    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1})
    nodes = [cluster.add_node(num_cpus=1) for _ in range(2)]
    seen: list[int] = []

    def kill_one(status: CampaignStatus) -> None:
        lived = [entry.job for entry in status.running if entry.worlds]
        if len(lived) == 3 and not seen:
            seen.extend(lived)
            cluster.remove_node(nodes[1], allow_graceful=False)

    out = tmp_path / "out"
    file = write(tmp_path, stop={"ticks": 200_000}, seeds=3, jobs={"worlds": 1})
    try:
        primordia.experiment(file, out, ray=cluster.address, look=kill_one, checkpoint_every=1)
    finally:
        cluster.shutdown()
    assert len(seen) == 3, "three jobs were under way when the node died"
    same_as_alone(out)


@pytest.mark.slow
def test_a_folder_that_a_node_does_not_see_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(on_ray, "_sees", lambda path: False)
    file = write(tmp_path)
    complains(here("experiment", file, "--out", tmp_path / "out", "--ray"), 2, "does not see")
    assert not import_module("ray").is_initialized()


def test_a_cluster_that_is_not_there_is_one_clear_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file, out = write(tmp_path), tmp_path / "out"
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        unused = f"127.0.0.1:{taken.getsockname()[1]}"
        complains(here("experiment", file, "--out", out, "--ray", unused), 2, "no cluster answers")
    monkeypatch.setitem(sys.modules, "ray", None)
    complains(here("experiment", file, "--out", out, "--ray"), 2, "pip install 'primordia[ray]'")
