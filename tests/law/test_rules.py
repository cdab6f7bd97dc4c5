"""Worlds in which organisms die in every way, checked against the rules when their history is made."""

from collections import Counter

import pytest

from primordia.random.wide import happened, to_host
from tests.chance import binomial
from tests.chronicle import History
from tests.worlds import MILLS, Lived, config

TICKS = 400


@pytest.fixture(scope="module")
def mills() -> list[History]:
    """Make the histories of worlds, which checks them against the rules."""
    run = Lived(config(MILLS, replication=0.12), TICKS)
    return [History(run, world) for world in range(run.config.seeds)]


def test_records_obey_the_rules_of_their_world(mills: list[History]) -> None:
    """Children are mutants or copies."""
    for history in mills:
        assert history.now == TICKS
        assert len(history.lives) > 20
        origins = {life.origin for life in history.lives if life.parent}
        assert origins == {"mutant", "copy"}


def test_fixation_is_that_of_the_pedigree(mills: list[History]) -> None:
    for history in mills:
        worlds, then = history.lived.engine.state.world.worlds, history.fixation()
        assert then is not None
        assert happened(worlds.fixed)[history.world]
        assert to_host(worlds.fixed)[history.world] == then[0]
        assert to_host(worlds.fixed_births)[history.world] == then[1]


def test_hazard_strikes_its_share_of_organism_ticks(mills: list[History]) -> None:
    """An organism that dies of a graver cause may also be struck; records do not show that."""
    died = Counter(life.cause for history in mills for life in history.dead)
    at_risk = sum(history.organism_ticks for history in mills) - died["starved"] - died["fatal"]
    assert binomial(died["hazard"], at_risk, MILLS["hazard"])
    assert died["replaced"] > 100
