"""The manifest of a checkpoint: checksums, the segments that count, and progress."""

import hashlib
import json
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field
from pydantic.dataclasses import dataclass

from primordia import files
from primordia.brains.genomes import FOUNDERS
from primordia.runs.code import FOLDER as CODE
from primordia.runs.description import FILE as DESCRIPTION
from primordia.runs.kept import FOLDER as FILES
from primordia.runs.schema import TABLES
from primordia.settings.limits import Stop

INPUTS = ("config.toml", DESCRIPTION, FOUNDERS)
"""Files that a run needs to go on, except checkpoints, own code, and files that settings name."""
SEGMENT_ROWS = 2**20
"""Largest number of rows of a segment."""
DEEPEST = 16
"""Largest number of names in the path of a file below the folder `code` or `files`."""
MOST_INPUTS = 4096
"""Largest number of inputs. Each may need DEEPEST folders, which a bundle does not hold itself."""
Word = Annotated[int, Field(ge=0, lt=2**64)]


def _is_input(name: str) -> str:
    folder, *parts = name.split("/")
    if name not in INPUTS and (
        folder not in (CODE, FILES) or not 0 < len(parts) <= DEEPEST or ".." in parts
    ):
        raise ValueError(f"{name} is not a file of a run")
    return name


Input = Annotated[str, AfterValidator(_is_input)]
Table = Annotated[str, Field(pattern=f"^({'|'.join(TABLES)})$")]


class Part(BaseModel):
    """Values of one kind in a manifest; unknown names and other types are refused."""

    model_config = ConfigDict(extra="forbid", strict=True)


@dataclass(slots=True, config=Part.model_config)
class Seal:
    """Size and checksum of a file; see `files.seal`.

    The class has slots, since an arm of 10,000 runs holds 100,000 seals.
    """

    bytes: int = Field(ge=0)
    sha256: str = Field(pattern="^[0-9a-f]{64}$")


@dataclass(slots=True, config=Part.model_config)
class Segment(Seal):
    """A closed segment of a table."""

    name: str = Field(pattern=r"^[0-9]{6,18}\.parquet$")
    rows: int = Field(ge=0, le=SEGMENT_ROWS)


class Progress(Part):
    """The progress of a whole run."""

    limits: Stop
    """the limits that were requested last: `ticks`, `births` and `until`"""
    wall_s: float = Field(ge=0, allow_inf_nan=False)
    """seconds spent so far"""
    exact: bool
    """whether the whole run can be repeated bit for bit"""
    restarts: int = Field(0, ge=0)
    """number of resumes at which the living got new bodies, since the habitat cannot save them"""

    def gone_on(self, exact: bool) -> "Progress":
        """Return the progress of a resumed run; if not `exact`, it counts one more restart."""
        return self.model_copy(update={"restarts": self.restarts + (not exact)})


class Manifest(Part):
    """The content of `manifest.json`, without the checksum of the content."""

    progress: Progress
    inputs: dict[Input, Seal] = Field(max_length=MOST_INPUTS)
    """files that a run needs to go on, except checkpoints, by their path below the run"""
    state: Seal
    segments: dict[Table, list[Segment]] = Field(min_length=len(TABLES))
    digests: dict[Table, list[tuple[Word, Word]]] = Field(min_length=len(TABLES))
    """sums of the row hashes of each table, for each world"""

    def text(self) -> str:
        """Return the content of the file."""
        content = self.model_dump(mode="json")
        return json.dumps({**content, "sha256": _checksum(content)}, indent=1)


def read(path: Path) -> Manifest:
    """Return the manifest in a file.

    Raises:
        OSError: the file cannot be read.
        ValueError: the file holds no manifest, or was changed.
    """
    return parsed(files.read(path))


def parsed(text: bytes) -> Manifest:
    """Return the manifest in a text; raise ValueError if there is no manifest, or it was changed."""
    try:
        content = json.loads(text)
        recorded = content.pop("sha256")
    except (RecursionError, AttributeError, KeyError, TypeError, ValueError):
        raise ValueError("one of its manifests cannot be read") from None
    if recorded != _checksum(content):
        raise ValueError("one of its manifests was changed")
    try:
        return Manifest.model_validate_json(json.dumps(content))
    except ValueError:
        raise ValueError("one of its manifests is not that of a run") from None


def _checksum(content: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
