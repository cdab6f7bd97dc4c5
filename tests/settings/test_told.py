"""What is said of faulty settings: which fault, of how many, and which name may have been meant."""

from typing import Any, Literal

import pytest
from pydantic import Field, ValidationError, field_validator

from primordia.config import Config
from primordia.settings.base import Rate, Settings
from primordia.settings.fields import choices, first_fault, rates_of, setting_fields
from primordia.settings.tables import did_you_mean
from primordia.settings.values import SHOWN, shown


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


def said(values: dict[str, Any], group: str = "", model: type[Settings] = Pool, **more: Any) -> str:
    with pytest.raises(ValidationError) as error:
        model.model_validate(values)
    return first_fault(error.value, model, group, **more)


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({}, "size is missing"),
        ({"inner": {"depth": "x"}}, "size is missing (and 1 more)"),
        ({"shape": 1, "inner": {"depth": "x", "width": "y"}}, "size is missing (and 3 more)"),
        ({"size": 0}, "size: input should be greater than or equal to 1, not 0"),
        (
            {"size": 1, "inner": {"depth": "x"}},
            "inner.depth: input should be a valid number, not 'x'",
        ),
        (
            {"size": 0, "slope": 0.25},
            "size: input should be greater than or equal to 1, not 0 (and 1 more)",
        ),
        ({"size": 1, "slope": 0.25}, "slope: is too steep"),
        ({"size": 1, "siez": 1}, "there is no setting 'siez'; did you mean 'size'?"),
        ({"size": 1, "depht": 1}, "there is no setting 'depht'; did you mean 'inner.depth'?"),
        ({"size": 1, "qqqq": 1, "zzzz": 2}, "there is no setting 'qqqq' (and 1 more)"),
    ],
    ids=range(10),
)
def test_the_first_fault_is_told_with_the_number_of_the_others(
    values: dict[str, Any], says: str
) -> None:
    assert said(values) == says


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({}, "pond.size is missing"),
        ({"size": 1, "slope": 0.25}, "pond.slope: is too steep"),
        ({"size": 0}, "pond.size: input should be greater than or equal to 1, not 0"),
        ({"size": 1, "siez": 1}, "there is no setting 'pond.siez'; did you mean 'pond.size'?"),
    ],
    ids=["missing", "ours", "too small", "unknown"],
)
def test_a_fault_in_a_table_is_told_with_the_name_of_the_table(
    values: dict[str, Any], says: str
) -> None:
    assert said(values, "pond") == says


def test_no_setting_of_a_fork_is_suggested_but_other_settings_are() -> None:
    values = {"task": "x", "habitat": {}, "tikc": 1}
    assert said(values, model=Config) == "there is no setting 'tikc'; did you mean 'stop.ticks'?"
    values = {"task": "x", "habitat": {}, "fork.tikc": 1}
    assert "'fork.tick'" not in said(values, model=Config)
    values = {"task": "x", "habitat": {}, "paddels": 1}
    told = said(values, model=Config, others=["habitat.paddles"])
    assert told == "there is no setting 'paddels'; did you mean 'habitat.paddles'?"


@pytest.mark.parametrize(
    ("name", "known", "nearest"),
    [
        ("a.dept", ["a.depth", "b.breadth"], "a.depth"),
        (f"{'x' * 30}.deepth", ["pond.depth", "lake.depth"], "pond.depth"),
        (f"{'x' * 30}.deepth", ["lake.depth", "pond.depth"], "lake.depth"),
        ("cells", ["hazard", "seed"], ""),
        ("cells", [], ""),
    ],
)
def test_the_first_of_equally_near_names_is_meant(
    name: str, known: list[str], nearest: str
) -> None:
    assert did_you_mean(name, known) == (f"; did you mean {nearest!r}?" if nearest else "")


def test_settings_have_dotted_names_and_only_some_are_rates() -> None:
    assert list(setting_fields(Pool, "a.")) == [
        "a.size",
        "a.shape",
        "a.inner.depth",
        "a.inner.width",
        "a.slope",
    ]
    assert setting_fields(int) == {}
    assert rates_of(Pool(size=1, slope=0.125), "a.") == {"a.slope": 0.125}
    assert rates_of(Inner(depth=9.0)) == {"depth": 9.0}


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
def test_the_possible_values_of_a_choice(annotation: Any, values: tuple[Any, ...]) -> None:
    assert choices(annotation) == values


@pytest.mark.parametrize("more", [-1, 0, 1, 50])
def test_a_value_of_the_largest_length_is_shown_whole(more: int) -> None:
    value = "".join(chr(ord("a") + n % 26) for n in range(SHOWN - 2 + more))
    whole = f"'{value}'"
    assert shown(value) == (whole if more <= 0 else f"{whole[: SHOWN - 3]}...")


def test_a_large_number_is_shown_in_hexadecimal() -> None:
    assert shown(2**100 - 1) == "1267650600228229401496703205375"
    assert shown(2**100) == "0x10000000000000000000000000"
