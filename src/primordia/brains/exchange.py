"""Changes of a task's settings, which may exchange its brain."""

from typing import Any

from primordia.brains.contract import find
from primordia.brains.layout import BODY
from primordia.errors import InputError
from primordia.settings.making import make
from primordia.settings.tables import NONE, merged, names_another, replaced


def changed(task: dict[str, Any], change: dict[str, Any]) -> dict[str, Any]:
    """Return all settings of a task with the values of `change`, none of them validated.

    If `change` names another brain, the task's mutation settings for blocks that this brain lacks are
    dropped. Nobody could remove them otherwise, since tables are merged.
    """
    values, blocks = merged(task, change), _blocks(task)
    if not blocks or not names_another("brain", task.get("brain", {}), change.get("brain")):
        return values
    try:
        brain = make("brain", replaced(values["brain"], NONE, None), find)
    except InputError:  # `config.validated` refuses such a brain, in better words
        return values
    try:
        own = tuple(brain.blocks(senses=1, outputs=1))
    except Exception:  # the user's own brain may refuse these sizes; a later check reports it
        own = ()
    kept = {name: each for name, each in blocks.items() if name in (*own, BODY)}
    return merged({**task, "mutation": {**task["mutation"], "blocks": kept}}, change)


def _blocks(task: dict[str, Any]) -> dict[str, Any]:
    """Return the mutation's settings for single blocks; none if they are no table."""
    mutation = task.get("mutation")
    blocks = mutation.get("blocks") if isinstance(mutation, dict) else None
    return blocks if isinstance(blocks, dict) else {}
