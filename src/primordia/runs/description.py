"""The description of a run: properties of its habitat, brain and mutation at its beginning.

The description is written into the run, so that records can be read without these parts' code.
"""

from pathlib import Path
from typing import Annotated, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from primordia import files
from primordia.errors import InputError
from primordia.habitats.checks import RATES
from primordia.habitats.contract import AnyHabitat
from primordia.law.law import Law
from primordia.settings.values import LARGEST

FILE = "description.json"
Model = TypeVar("Model", bound=BaseModel)


class Description(BaseModel):
    """The properties that a reader of the records needs."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    rate: float | None = Field(ge=RATES[0], le=RATES[1])
    """ticks in a second of the habitat; None if the habitat has no clock"""
    tallies: tuple[str, ...]
    """names of the habitat's counts"""
    notes: tuple[str, ...]
    """names of the mutation's notes"""
    mates: bool = False
    """whether children may have a second parent"""
    endowed: bool = False
    """whether parents pay an endowment for each child"""
    moments: int = Field(0, ge=0, le=2**16)
    """number of moments that an organism remembers for the mutation"""
    beginning: dict[str, Annotated[float, Field(ge=-LARGEST, le=LARGEST)]]
    """the settings that seasons may change: dotted name -> value at the beginning"""
    blocks: dict[str, tuple[Annotated[int, Field(ge=1, lt=2**31)], ...]]
    """shape of each block of weights in a genome"""
    code: dict[str, str] = Field({})
    """SHA-256 of each file of the user's own code, by its path below `code`"""
    files: dict[str, str] = Field({})
    """SHA-256 of each file that the habitat's settings name or need, by its path below `files`"""
    files_from: str = ""
    """the folder in which these files were found when the run began"""

    @classmethod
    def of(
        cls,
        law: Law,
        habitat: AnyHabitat,
        code: dict[str, str],
        files_from: str,
        files: dict[str, str],
    ) -> "Description":
        """Return the description of a run."""
        return cls(
            rate=habitat.rate,
            tallies=habitat.tallies,
            notes=law.heredity.mutation.notes,
            mates=law.heredity.recombination is not None,
            endowed=law.act is not None,
            moments=0
            if law.heredity.mutation.moments is None
            else law.heredity.mutation.moments.kept,
            beginning=dict(law.beginning),
            blocks=dict(law.heredity.layout.blocks),
            code=code,
            files=files,
            files_from=files_from,
        )

    def write(self, run: Path) -> None:
        """Write the description into a run's directory.

        Raises:
            Trouble: the file cannot be written.
        """
        files.write_text(run / FILE, self.model_dump_json(indent=1))


def read(run: Path) -> Description:
    """Return the description in a run's directory.

    Raises:
        InputError: the description is missing or damaged.
    """
    return from_json(run / FILE, Description, f"{run / FILE} is missing or damaged; put it back")


def from_json(path: Path, model: type[Model], otherwise: str) -> Model:
    """Return the content of a JSON file; if it is invalid, raise InputError with the text `otherwise`."""
    try:
        return model.model_validate_json(files.read(path))
    except (OSError, ValidationError):
        raise InputError(otherwise) from None
