"""Fields of settings: their names and choices, and messages about faults in their values."""

from typing import Any, Literal

import pytest
from pydantic import Field, ValidationError, field_validator

from primordia.config import Config
from primordia.settings.base import Rate, Settings
from primordia.settings.fields import choices, first_fault, rates_of, setting_fields


class Inner(Settings):
    """A group in a group."""

    depth: Rate = 2.0
    width: float = 3.0


class Pool(Settings):
    """Settings of several kinds."""

    size: int = Field(ge=1)
    shape: Literal["round", "square"] | None = None
    inner: Inner | None = None
    slope: Rate = 0.5

    @field_validator("slope")
    @classmethod
    def _whole(cls, slope: float) -> float:
        if slope == 0.25:
            raise ValueError("is too steep")
        return slope


def message_of(
    values: dict[str, Any], group: str = "", model: type[Settings] = Pool, **more: Any
) -> str:
    with pytest.raises(ValidationError) as error:
        model.model_validate(values)
    return first_fault(error.value, model, group, **more)


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({}, "size is missing"),
        ({"shape": 1, "inner": {"depth": "x", "width": "y"}}, "size is missing (and 3 more)"),
        ({"size": 0}, "size: input should be greater than or equal to 1, not 0"),
        (
            {"size": 1, "inner": {"depth": "x"}},
            "inner.depth: input should be a valid number, not 'x'",
        ),
        ({"size": 1, "slope": 0.25}, "slope: is too steep"),
        ({"size": 1, "siez": 1}, "there is no setting 'siez'; did you mean 'size'?"),
        ({"size": 1, "depht": 1}, "there is no setting 'depht'; did you mean 'inner.depth'?"),
        ({"size": 1, "qqqq": 1, "zzzz": 2}, "there is no setting 'qqqq' (and 1 more)"),
    ],
    ids=range(8),
)
def test_a_message_has_the_first_fault_and_the_number_of_the_others(
    values: dict[str, Any], says: str
) -> None:
    assert message_of(values) == says


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({}, "pond.size is missing"),
        ({"size": 1, "siez": 1}, "there is no setting 'pond.siez'; did you mean 'pond.size'?"),
    ],
    ids=["missing", "unknown"],
)
def test_a_message_about_a_table_has_the_name_of_the_table(
    values: dict[str, Any], says: str
) -> None:
    assert message_of(values, "pond") == says


def test_all_settings_but_those_of_a_fork_are_suggested() -> None:
    values = {"task": "x", "habitat": {}, "tikc": 1}
    assert (
        message_of(values, model=Config) == "there is no setting 'tikc'; did you mean 'stop.ticks'?"
    )
    values = {"task": "x", "habitat": {}, "fork.tikc": 1}
    assert "'fork.tick'" not in message_of(values, model=Config)
    values = {"task": "x", "habitat": {}, "paddels": 1}
    message = message_of(values, model=Config, others=["habitat.paddles"])
    assert message == "there is no setting 'paddels'; did you mean 'habitat.paddles'?"


def test_fields_have_dotted_names_and_some_are_rates() -> None:
    names = "a.size", "a.shape", "a.inner.depth", "a.inner.width", "a.slope"
    assert tuple(setting_fields(Pool, "a.")) == names
    assert setting_fields(int) == {}
    assert rates_of(Pool(size=1, slope=0.125), "a.") == {"a.slope": 0.125}
    assert rates_of(Inner(depth=0.0)) == {"depth": 0.0}


@pytest.mark.parametrize(
    ("annotation", "values"),
    [
        (bool, (False, True)),
        (bool | None, (False, True, None)),
        (Literal["a", "b"], ("a", "b")),
        (Literal["a", "b"] | None, ("a", "b", None)),
        (tuple[Literal["x", "y"], ...], ("x", "y")),
        (int | None, ()),
        (float, ()),
    ],
)
def test_a_choice_has_its_possible_values(annotation: Any, values: tuple[Any, ...]) -> None:
    assert choices(annotation) == values
