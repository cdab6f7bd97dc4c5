"""The JSON files of a run directory, each of which has a model that says what it may hold."""

from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from primordia import files
from primordia.errors import InputError

Model = TypeVar("Model", bound=BaseModel)


def read(path: Path, model: type[Model], otherwise: str) -> Model:
    """Return the content of a file; raise InputError with the words of `otherwise` if it has no such."""
    try:
        return model.model_validate_json(files.read(path))
    except (OSError, ValidationError):
        raise InputError(otherwise) from None
