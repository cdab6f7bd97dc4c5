"""Figures of assays: the name of each function is the assay's name."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from primordia.assays.ablate import Ablation
from primordia.assays.compete import Competition
from primordia.assays.effects import Effect
from primordia.assays.garden import Bed
from primordia.assays.line import Line
from primordia.figures import style
from primordia.figures.transplants import generalists as generalists
from primordia.figures.transplants import transplant as transplant
from primordia.history.heredity import Inherited
from primordia.history.threshold import Threshold

KEY = {"worlds": style.SKY, "median": style.BLUE}
"""Colours of strips."""
WIDTH = 0.5
"""Width of a strip of dots, as a share of the distance between strips."""
SHARES = {
    "as_long": ("as long", style.BLUE),
    "tenth_longer": ("a tenth longer", style.GREEN),
    "third_shorter": ("a third shorter", style.VERMILION),
}
"""Shares of mutants: field -> its name and colour."""
APART = {
    "brain": ("brain in the last body", style.GREEN),
    "body": ("body with the last brain", style.VERMILION),
}
"""Parts of a genome in `assays.line`: field -> its name and colour."""
GROUPS = {"oldest": style.BLUE, "late-born": style.ORANGE, "founders": style.SOFT}
"""Groups of the common garden."""


def heredity(found: list[Inherited]) -> Figure:
    """Draw Price's terms, and slopes of children's log life on their parents': a dot for each world."""
    figure = Figure(figsize=(style.PAGE, 2.6))
    slopes, shares, terms = figure.subplots(1, 3, width_ratios=(1, 1.1, 0.9))
    of_slopes = {
        "copies": [each.copies.slope for each in found],
        "mutants": [each.mutants.slope for each in found],
        "both": [each.both.slope for each in found],
    }
    of_mutants = {
        "as long": [each.mutants.as_long for each in found],
        "a tenth\nlonger": [each.mutants.longer for each in found],
        "a third\nshorter": [each.mutants.shorter for each in found],
    }
    of_terms = {
        "selection": [each.selection for each in found],
        "transmission": [each.transmission for each in found],
    }
    strips(slopes, of_slopes, "Slope of log life on the parent's")
    slopes.axhline(1, color=style.FAINT, zorder=0)
    slopes.axhline(0, color=style.FAINT, zorder=0)
    strips(shares, of_mutants, "Share of mutants")
    shares.set_ylim(-0.02, 1.02)
    strips(terms, of_terms, "Change of mean log life")
    terms.axhline(0, color=style.FAINT, zorder=0)
    return figure


def threshold(found: list[Threshold]) -> Figure:
    """Draw p, v and s of each world, and the error threshold."""
    figure = Figure(figsize=(style.PAGE, 2.6))
    shares, factors = figure.subplots(1, 2)
    of_shares = {
        "p: children\nthat mutate": [each.mutated for each in found],
        "v: mutants\nas good": [each.as_good for each in found],
    }
    of_factors = {
        "s: advantage of\ngood lines": [each.advantage for each in found],
        "s (1 - p (1 - v))": [each.held for each in found],
    }
    strips(shares, of_shares, "Shares")
    shares.set_ylim(-0.02, 1.02)
    key = {**KEY, "threshold": style.VERMILION}
    strips(factors, of_factors, "Does a good line persist?", key)
    style.logarithmic(factors.yaxis)
    factors.axhline(1, color=style.VERMILION, zorder=0)
    return figure


def effects(found: list[Effect]) -> Figure:
    """Draw, for each mutation, the shares of mutants that live as long as the parent, longer or shorter.

    Lines and bands are means and quartiles over organisms.
    """
    mutations = list(dict.fromkeys(each.mutation for each in found))
    figure = Figure(figsize=(max(style.COLUMN, 0.55 * len(mutations) + 1), 2.8))
    axes, places = figure.subplots(), np.arange(len(mutations))
    for field, (_, colour) in SHARES.items():
        values = [
            [getattr(each, field) for each in found if each.mutation == mutation]
            for mutation in mutations
        ]
        q1, q3 = np.percentile(values, (25, 75), axis=1)
        axes.vlines(places, q1, q3, color=colour, alpha=0.3, linewidth=4)
        means = np.mean(values, axis=1)
        axes.plot(places, means, "o", color=colour, markersize=3)
        for kind in ("scale", "differs"):  # the sizes of one kind of mutation are joined by a line
            some = np.array([mutation.startswith(kind) for mutation in mutations])
            axes.plot(places[some], means[some], color=colour)
    axes.set_xticks(places, [mutation.replace(" ", "\n") for mutation in mutations])
    axes.set(ylim=(-0.02, 1.02), ylabel="share of mutants")
    key = dict(SHARES.values())
    style.title(axes, "Lives of mutants compared with parents, means and quartiles", key)
    return figure


def ablate(found: list[Ablation]) -> Figure:
    """Draw the share of life that is left after each ablation: a dot for each organism, and a line
    at the median."""
    losses = list(dict.fromkeys(each.without for each in found))
    figure = Figure(figsize=(style.COLUMN, 0.9 + 0.16 * len(losses)))
    axes = figure.subplots()
    for place, loss in enumerate(losses):
        kept = [each.kept for each in found if each.without == loss]
        axes.plot(kept, [place] * len(kept), ".", color=style.SKY, markersize=4, alpha=0.8)
        axes.plot(np.median(kept), place, "|", color=style.BLUE, markersize=8)
    axes.axvline(1, color=style.FAINT, zorder=0)
    axes.set_yticks(range(len(losses)), losses)
    axes.set(ylim=(len(losses) - 0.5, -0.5), xlabel="share of the intact life")
    axes.set_xlim(0, None)
    key = {"organisms": style.SKY, "median": style.BLUE}
    style.title(axes, "Life without each part", key)
    return figure


def garden(found: list[Bed]) -> Figure:
    """Draw recorded lives against lives of genomes born again, and the survival curve of each group."""
    figure = Figure(figsize=(style.PAGE, 2.8))
    pairs, again = figure.subplots(1, 2)
    for bed in found:
        if bed.recorded is not None:
            pairs.plot(
                np.maximum(bed.recorded, 1), np.maximum(bed.reborn, 1), ".",
                color=GROUPS[bed.group], markersize=3, markeredgewidth=0, alpha=0.5,
            )  # fmt: skip
    style.logarithmic(pairs.xaxis)
    style.logarithmic(pairs.yaxis)
    pairs.axline((1, 1), (10, 10), color=style.FAINT, zorder=0)
    pairs.set(xlabel="life as recorded (ticks)", ylabel="life when born again (ticks)")
    recorded = {group: GROUPS[group] for group in ("oldest", "late-born")}
    style.title(pairs, "Organisms", recorded)
    for group, colour in GROUPS.items():
        lives = np.sort(np.concatenate([each.reborn for each in found if each.group == group]))
        left = 1 - np.arange(len(lives)) / len(lives)
        again.step(np.maximum(lives, 1), left, where="pre", color=colour)
    style.logarithmic(again.xaxis)
    again.set(
        xlabel="life when born again (ticks)",
        ylabel="share that live at least as long",
        ylim=(0, 1.02),
    )
    style.title(again, "All organisms of each group", GROUPS)
    return figure


def line(found: list[Line]) -> Figure:
    """Draw the life of each genome on each line over generations, as recorded and when born again.

    If bodies are inherited, also draw the lives of its brain and of its body, each with the other part of
    the line's last organism.
    """
    figure = Figure(figsize=(style.PAGE, 2.4 * len(found)))
    for axes, each in zip(figure.subplots(len(found), squeeze=False).flat, found, strict=True):
        generation = [step.generation for step in each.steps]
        recorded = [max(step.recorded, 1) for step in each.steps]
        reborn = [max(step.reborn, 1) for step in each.steps]
        to_the_end = [*generation, each.generations], [*reborn, reborn[-1]]
        axes.step(*to_the_end, where="post", color=style.BLUE)
        axes.plot(generation, recorded, ".", color=style.ORANGE, markersize=4, markeredgewidth=0)
        for part, (_, colour) in APART.items():
            if (spans := each.spans(part)) is not None:
                axes.step(
                    generation, np.maximum(spans, 1), where="post", color=colour, linewidth=0.8
                )
        axes.axvline(each.good.generation, color=style.FAINT, zorder=0)
        style.logarithmic(axes.yaxis)
        axes.set(xlabel="generation", ylabel="ticks lived", xlim=(0, max(each.generations, 1)))
        key = {"born again": style.BLUE, "as recorded": style.ORANGE, "as good from": style.SOFT}
        key |= dict(APART.values()) if each.good_parts else {}
        style.title(axes, f"The line of organism {each.organism} of world {each.world}", key)
    return figure


def compete(found: list[Competition]) -> Figure:
    """Draw the share of the living that descend from the first genome, in each world over time."""
    figure = Figure(figsize=(style.COLUMN, 2.6 * len(found)))
    for axes, each in zip(figure.subplots(len(found), squeeze=False).flat, found, strict=True):
        style.curves(axes, each.tick, each.share)
        axes.axhline(0.5, color=style.FAINT, zorder=0)
        style.linear(axes.xaxis)
        axes.set(xlabel="time (ticks)", ylim=(-0.02, 1.02), xlim=(0, each.tick[-1]))
        axes.set_ylabel("share of the living")
        style.title(axes, f"Descendants of {each.one}", style.worlds_key(len(each.share)))
    return figure


def strips(
    axes: Axes,
    values: Mapping[str, Sequence[float | None]],
    title: str,
    key: dict[str, str] = KEY,
) -> None:
    """Draw a panel: a strip of the known values for each name, and a line at its median."""
    for place, each in enumerate(values.values()):
        known = np.array(list(each), float)  # None is NaN
        known = known[np.isfinite(known)]
        if not len(known):
            continue
        spread = np.linspace(-WIDTH / 2, WIDTH / 2, len(known)) if len(known) > 1 else np.zeros(1)
        axes.plot(
            place + spread, known, ".", color=style.SKY, markersize=4, markeredgewidth=0, alpha=0.8
        )
        ends = place - WIDTH / 2, place + WIDTH / 2
        axes.plot(ends, [np.median(known)] * 2, color=style.BLUE)
    axes.set_xticks(range(len(values)), list(values))
    axes.set_xlim(-0.6, len(values) - 0.4)
    style.title(axes, title, key)
