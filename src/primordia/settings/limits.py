"""The limits of a run in time: the end of its worlds, and the tick of a fork."""

from typing import Any, Literal

from pydantic import Field, ValidationError

from primordia.errors import InputError
from primordia.settings.base import UNREACHED, Settings
from primordia.settings.fields import first_fault
from primordia.settings.tables import NONE, replaced
from primordia.settings.values import plain


class Stop(Settings):
    """The limits of a world; a stopped world is frozen while the run's other worlds go on."""

    ticks: int | None = Field(None, ge=1, lt=UNREACHED, description="ticks until a world stops")
    births: int | None = Field(
        None, ge=1, lt=UNREACHED, description="births (founders included) until a world stops"
    )
    until: Literal["saturation"] | None = Field(
        None,
        description="saturation: a world stops once it is saturated; see saturation_ticks",
    )


class ForkedFrom(Settings):
    """The source of a fork. Its first checkpoint is in the run's directory, under `origin`."""

    run: str = Field(description="the run that was forked")
    tick: int = Field(ge=1, lt=UNREACHED, description="the tick after which the run was forked")


def checked(values: dict[str, Any]) -> dict[str, Any]:
    """Return settings of `Stop`, checked.

    Raises:
        InputError: a setting is unknown or out of range.
    """
    values = replaced(plain(values), NONE, None)
    try:
        Stop.model_validate(values)
    except ValidationError as error:
        raise InputError(first_fault(error, Stop)) from None
    return values
