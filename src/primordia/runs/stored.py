"""The JSON files of a run directory; a model defines the content of each."""

from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from primordia import files
from primordia.errors import InputError

Model = TypeVar("Model", bound=BaseModel)


def read(path: Path, model: type[Model], otherwise: str) -> Model:
    """Return the content of a file; if it is not valid, raise InputError with the text `otherwise`."""
    try:
        return model.model_validate_json(files.read(path))
    except (OSError, ValidationError):
        raise InputError(otherwise) from None
