"""Settings of mutations for single blocks of weights, such as input, recurrent and output."""

from collections.abc import Mapping

from pydantic import BaseModel, Field

from primordia.brains.layout import Layout
from primordia.settings.base import Settings


class FounderBlock(Settings):
    """Founders' weights in one block. None stands for the whole genome's value."""

    founder_scale: float | None = Field(
        None, ge=0, description="standard deviation of a founder's weights in the block"
    )


def check_blocks(blocks: Mapping[str, Settings], layout: Layout) -> None:
    """Raise ValueError if a setting names a block that genomes of this layout do not have."""
    for name in blocks:
        if name not in layout.names:
            known = ", ".join(layout.names)
            raise ValueError(f"blocks: this brain has no block {name!r}; it has {known}")


def per_block(
    whole: BaseModel, blocks: Mapping[str, Settings], field: str, layout: Layout
) -> list[float]:
    """Return a setting's value for each block: the block's own value, or the whole genome's value."""
    own = [getattr(blocks.get(block), field, None) for block in layout.names]
    return [getattr(whole, field) if value is None else value for value in own]
