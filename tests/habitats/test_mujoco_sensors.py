"""What organisms perceive of sensors, activations, time and forces is what MuJoCo says."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.robots import SENSES, born, opened, write_model

mujoco = pytest.importorskip("mujoco")

WIDTHS = {
    "qpos[2]": 1,
    "qvel": 14,
    "act": 1,
    "time": 1,
    "gyro": 3,
    "acceleration": 3,
    "cfrc_ext": 6,
}


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_model(tmp_path_factory.mktemp("model"))


def walkers(file: Path, bodies: int = 3) -> Any:
    habitat = opened(bodies, file=str(file), senses=SENSES, position_noise=0.01)
    return habitat


def lived(habitat: Any, bodies: int = 3, ticks: int = 40) -> list[np.ndarray]:
    rng, alive = np.random.default_rng(5), np.ones(bodies, bool)
    actions = rng.uniform(-1, 1, (ticks, 3, 2)).astype(np.float32)
    return [habitat.step(action[:bodies], alive)[0].copy() for action in actions]


def test_senses_are_those_of_mujoco_at_the_end_of_the_tick(file: Path) -> None:
    """The bodies fall on the ground, so there are contacts."""
    habitat = walkers(file)
    born(habitat, 3)
    model = mujoco.MjModel.from_xml_path(str(file))
    data = mujoco.MjData(model)
    data.qpos[:] = habitat._bodies.views["qpos"][1]
    mujoco.mj_forward(model, data)
    rng, touched = np.random.default_rng(5), False
    for senses in lived(habitat):
        data.ctrl[:] = rng.uniform(-1, 1, (3, 2)).astype(np.float32)[1]
        mujoco.mj_step(model, data, 5)
        mujoco.mj_forward(model, data)
        mujoco.mj_rnePostConstraint(model, data)
        found = [data.sensor("gyro").data, data.sensor("acceleration").data]
        parts = [
            data.qpos[2:3],
            data.qvel,
            data.act,
            [data.time],
            *found,
            data.body("leg0").cfrc_ext,
        ]
        assert np.array_equal(senses[1], np.concatenate(parts).astype(np.float32))
        touched |= bool(data.body("leg0").cfrc_ext.any())
    assert touched
    assert senses.shape[1] == sum(WIDTHS.values())


def test_all_sensors_in_one_list_are_those_of_the_model(file: Path) -> None:
    """The sensor that lets MuJoCo compute forces is not among them."""
    habitat = opened(2, file=str(file), senses=["sensordata", 'cfrc_ext["leg0"][3:]'])
    assert habitat.senses_size == mujoco.MjModel.from_xml_path(str(file)).nsensordata + 3
    assert born(habitat, 2).shape == (2, habitat.senses_size)


def test_bodies_go_on_exactly_and_do_not_depend_on_others(file: Path) -> None:
    habitat, alone, again = walkers(file), walkers(file, 1), walkers(file)
    words = np.random.default_rng(0).integers(0, 2**32, (3, habitat.words), np.uint32)
    habitat.reset(np.arange(3), words)
    alone.reset(np.arange(1), words[:1])
    lived(habitat)
    again.load({name: each.copy() for name, each in habitat.save().items()})
    after = lived(habitat)
    assert np.array_equal(after, lived(again))
    lived(alone, 1)
    assert np.array_equal([senses[0] for senses in after], [each[0] for each in lived(alone, 1)])


@pytest.mark.parametrize(
    ("senses", "fault"),
    [
        ('sensor["gyr"]', "sensor has the parts hip, gyro, acceleration, touch"),
        ("sensor", "say which: sensor"),
        ("sensordata[11]", "sensordata goes from sensordata[0] to sensordata[10]"),
    ],
)
def test_a_wrong_name_is_an_error_that_says_what_there_is(
    file: Path, senses: str, fault: str
) -> None:
    with pytest.raises(ValueError, match=fault.replace("[", r"\[")):
        opened(file=str(file), senses=[senses])


def test_a_model_without_sensors_has_none() -> None:
    with pytest.raises(ValueError, match="there is no 'sensor'"):
        opened(senses=['sensor["gyro"]'])
