"""What every part that a user can configure has in common."""

from pydantic import BaseModel, ConfigDict


class Settings(BaseModel):
    """A frozen, validated group of settings; an unknown name or a wrong type is an error.

    Parts of the law are such groups with methods, so that a setting is written down once,
    beside the code that obeys it.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)
