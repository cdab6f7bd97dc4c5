"""What every part that a user can configure has in common."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict

SEASONAL = "seasonal"
Rate = Annotated[float, SEASONAL]
"""A setting that seasons may change while a run goes on. It is then part of every world's climate, and a
column of the metrics, under the dotted name it has in settings."""


class Settings(BaseModel):
    """A frozen, validated group of settings; an unknown name or a wrong type is an error.

    Parts of the law are such groups with methods, so that a setting is written down once,
    beside the code that obeys it.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)
