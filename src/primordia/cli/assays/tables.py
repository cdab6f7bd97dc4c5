"""Results of assays as tables for the terminal."""

from collections import Counter
from collections.abc import Sequence
from statistics import mean
from typing import Any, NamedTuple

import numpy as np

from primordia.cli.table import spread
from primordia.printable import counted


class Told(NamedTuple):
    """A table with its title and its notes."""

    title: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    notes: Sequence[str] = ()


def heredity(name: str, found: list[Any]) -> Told:
    """Return the table of the inheritance of lifespan in each world, `history.heredity`."""
    kinds = ("copies", "mutants", "both")
    words = {
        "slope": "slope",
        "as_long": "exactly as long",
        "longer": "a tenth longer",
        "shorter": "a third shorter",
    }
    counts = (f"{sum(getattr(each, kind).pairs for each in found):,}" for kind in kinds)
    rows = [
        (text, *(spread(getattr(getattr(each, kind), field) for each in found) for kind in kinds))
        for field, text in words.items()
    ]
    terms = [
        (field, "", "", spread(getattr(each, field) for each in found))
        for field in ("selection", "transmission")
    ]
    return Told(_title(name, found), ("", *kinds), [("pairs", *counts), *rows, *terms])


def threshold(name: str, found: list[Any]) -> Told:
    """Return the table of the error threshold in each world, `history.threshold`."""
    held = [each.held for each in found if each.held is not None]
    words = {
        "mutated": "p, share of children that mutate",
        "as_good": "v, share of good parents' mutants that are as good",
        "advantage": "s, life of good parents' copies / life of all organisms",
        "held": "s (1 - p (1 - v))",
    }
    rows = [(text, spread(getattr(each, field) for each in found)) for field, text in words.items()]
    above = f"{sum(value > 1 for value in held)} of {len(held)}"
    last = ("worlds where it is above 1: a good line persists", above)
    notes = []
    if found and all(each.mutated == 1 for each in found):
        notes.append(
            "Every child mutates, so there are no copies to compare mutants with. Set"
            " mutation.probability below 1 in a new run."
        )
    return Told(_title(name, found), ("", "median"), [*rows, last], notes)


def effects(name: str, found: list[Any]) -> Told:
    """Return the table of the effects of mutations, `assays.effects`."""
    words = {
        "as_long": "as long",
        "longer": "longer",
        "tenth_longer": "a tenth longer",
        "third_shorter": "a third shorter",
    }
    mutations = list(dict.fromkeys(each.mutation for each in found))
    rows = []
    for mutation in mutations:
        own = [each for each in found if each.mutation == mutation]
        shares = (f"{mean(getattr(each, field) for each in own):.3f}" for field in words)
        medians = spread(each.to_dict()["median"] for each in own)
        rows.append((mutation, *shares, medians))
    lived = spread(each.lifespan for each in found if each.mutation == mutations[0])
    count = len(found) // len(mutations)
    return Told(
        f"{name}: {counted(count, 'organism')}; each mutation made"
        f" {len(found[0].mutants)} mutants of each",
        ("", *words.values(), "median life"),
        rows,
        (
            f"The organisms lived {lived} ticks. Shares are means over organisms; lives are"
            " medians (quartiles).",
        ),
    )


def ablate(name: str, found: list[Any]) -> Told:
    """Return the table of lives after ablations, `assays.ablate`."""
    losses = list(dict.fromkeys(each.without for each in found))
    rows = []
    for loss in losses:
        own = [each for each in found if each.without == loss]
        rows.append((loss, spread(e.lifespan for e in own), spread(e.kept for e in own)))
    first = [each for each in found if each.without == losses[0]]
    return Told(
        f"{name}: {counted(len(first), 'organism')}, medians (quartiles)",
        ("without", "ticks lived", "share of the intact life"),
        [("nothing", spread(each.intact for each in first), "1"), *rows],
    )


def garden(name: str, found: list[Any]) -> Told:
    """Return the table of the common garden, `assays.garden`."""
    rows = []
    for group, count in Counter(each.group for each in found).items():
        own = [each for each in found if each.group == group]
        recorded = [None if each.recorded is None else each.recorded.mean() for each in own]
        rows.append(
            (
                group,
                f"{count:,}",
                f"{sum(len(each.organism) for each in own):,}",
                spread(recorded),
                spread(each.reborn.mean() for each in own),
                spread(each.kept for each in own),
            )
        )
    return Told(
        f"{name}: mean ticks lived; medians over worlds (quartiles)",
        ("", "worlds", "organisms", "in their world", "born again", "share kept"),
        rows,
    )


def line(name: str, found: list[Any]) -> Told:
    """Return the table of lines of descent, `assays.line`."""
    islands = any(each.migrations is not None for each in found)
    bodies = any(each.good_parts for each in found)
    names = (
        *("", *(("island of birth", "migrations") if islands else ())),
        *("generations", "different genomes", "born again"),
        *("ticks that the first lives", "ticks that the last lives", "as good from"),
        *(("brain as good from", "body as good from") if bodies else ()),
        "largest step",
    )
    head, *rows = zip(names, *(_of_line(each, islands) for each in found), strict=True)
    notes = [
        "As good: this genome and all later ones live at least nine tenths of the last genome's life."
    ]
    if bodies:
        notes.append("Brain: in the last organism's body. Body: with the last organism's brain.")
    if islands:
        notes.append("Migrations: births of the line on another island than the parent's.")
    return Told(f"{name}: genomes of a line, born again in the same games", head, rows, notes)


def _of_line(each: Any, islands: bool) -> tuple[str, ...]:
    """Return the column of a line in the table."""
    return (
        f"organism {each.organism} of world {each.world}",
        *((each.steps[-1].island, f"{each.migrations:,}") if islands else ()),
        *(f"{each.generations:,}", f"{each.genomes:,}", f"{len(each.steps):,}"),
        *(f"{each.steps[0].reborn:,.0f}", f"{each.steps[-1].reborn:,.0f}"),
        _birth_text(each.good),
        *(_birth_text(step) for step in each.good_parts.values()),
        _step_text(each.largest),
    )


def compete(name: str, found: list[Any]) -> Told:
    """Return the table of two genomes in one world, `assays.compete`."""
    rows = []
    for each in found:
        won, lost = each.won
        late = each.late_share.tolist()
        worlds = f"{len(each.share):,}"
        rows.append((each.one, worlds, f"{won:,}", f"{spread(late)}"))
        rows.append((each.other, worlds, f"{lost:,}", f"{spread(1 - share for share in late)}"))
    head = ("", "worlds", "won", "share of the living, late")
    notes = [
        "Late: mean over the later half of the ticks. Won: worlds in which this share is above one half."
        f" Sign test over worlds: p = {each.p:.2g}."
        for each in found
    ]
    ticks = f"{found[0].tick[-1]:,} ticks"
    return Told(
        f"{name}: each genome begins in half of the cells, {ticks}, no mutation", head, rows, notes
    )


def transplant(name: str, found: list[Any]) -> Told:
    """Return the table of lives on every island, `assays.transplant`."""
    islands = found[0].islands
    born = [f"born on {island}" for island in islands]
    natives = [f"{sum(each.natives[k] for each in found):,}" for k in range(len(islands))]
    lives = [
        (who, count, *(spread(each.lived[row, k] for each in found) for k in range(len(islands))))
        for row, (who, count) in enumerate([*zip(born, natives, strict=True), ("founders", "")])
    ]
    ratios = {"home / away": "home_away", "local / foreign": "local_foreign"}
    compared = [
        (
            text,
            "",
            *(spread(getattr(each, field)[k] for each in found) for k in range(len(islands))),
        )
        for text, field in ratios.items()
    ]
    return Told(
        f"{name}: mean ticks lived; {_worlds(found)}",
        ("", "organisms", *(f"living on {island}" for island in islands)),
        [*lives, *compared],
        (
            "Home / away: the life of an island's natives at home, as a multiple of their life on other"
            " islands.",
            "Local / foreign: the life of an island's natives at home, as a multiple of the life there"
            " of other islands' natives.",
            "Above 1 on every island, local / foreign shows local adaptation (Kawecki & Ebert 2004)."
            " Home / away alone does not: home may be an easy place.",
        ),
    )


def generalists(name: str, found: list[Any]) -> list[Told]:
    """Return the tables of generalists and of the gains of islands, `assays.generalists`."""
    islands, lived = found[0].islands, [np.median(each.lived, axis=0) for each in found]
    shares = [
        (f"masters {counted(count, 'island')}", spread(each.shares[count] for each in found))
        for count in range(len(islands) + 1)
    ]
    of_islands = [
        (island, spread(own[k] for own in lived), spread(each.best_founder[k] for each in found))
        for k, island in enumerate(islands)
    ]
    several = f"{len(found[0].organism)} late organisms of each world"
    return [
        Told(f"{name}: {several}; {_worlds(found)}", ("", "share of organisms"), shares),
        Told(
            "Ticks lived on each island",
            ("", "median organism", "best founder"),
            of_islands,
            (
                "An organism masters an island if it lives there longer than the best of as many"
                " founders.",
            ),
        ),
        _gains(found),
    ]


def _gains(found: list[Any]) -> Told:
    """Return the births since which the line of a world's most general organism masters an island."""
    rows: list[Sequence[str]] = []
    for each in found:
        for gained, island in each.gains:
            k, at = each.islands.index(island), each.line.index(gained)
            before = f"{each.line[at - 1].lived[k]:,.0f}" if at else "-"
            who = f"{gained.organism:,}", f"{gained.generation:,}", f"{gained.born:,}"
            birth = gained.island, gained.birth_cause
            rows.append(
                (f"{each.world}: {island}", *who, *birth, before, f"{gained.lived[k]:,.0f}")
            )
    return Told(
        "Births since which the line of the most general organism masters an island",
        (
            *("world: island", "organism", "generation", "tick", "born on", "birth"),
            *("lived there before", "and since"),
        ),
        rows or [["none", *[""] * 7]],
        (
            "Lived before: the ticks that the ancestor before lives on the island. Only some ancestors"
            " of a long line live again; see --most.",
        ),
    )


def _worlds(found: list[Any]) -> str:
    return f"medians over {len(found)} worlds (quartiles)" if len(found) > 1 else "1 world"


def _birth_text(step: Any) -> str:
    return f"{step.organism:,} (generation {step.generation:,}, tick {step.born:,})"


def _step_text(pair: Any) -> str:
    if pair is None:
        return "-"
    before, after = pair
    return f"{after.organism:,}: {before.reborn:,.0f} to {after.reborn:,.0f}"


def _title(name: str, found: list[Any]) -> str:
    return f"{name}: {counted(len(found), 'world')}, medians (quartiles)"
