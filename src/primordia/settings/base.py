"""The base class of every part that a user can configure."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict

UNREACHED = 2**53
"""More ticks or births than any world reaches; below it, float64 numbers, as in figures, are exact."""

SEASONAL = "seasonal"
Rate = Annotated[float, SEASONAL]
"""A setting that seasons may change while a run goes on. The setting is part of every world's
climate and a column of the metrics, under its dotted name in settings."""


class Settings(BaseModel):
    """A frozen, validated group of settings; an unknown name or a wrong type is an error.

    Parts of the law are such groups with methods: a setting is declared once, beside the code that
    uses the setting.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)
