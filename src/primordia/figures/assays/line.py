"""The figure of the lives along lines of descent."""

from matplotlib.figure import Figure

from primordia.assays.line import Line
from primordia.figures import style


def draw(found: list[Line]) -> Figure:
    """Draw the life of each genome on each line over generations, as recorded and when born again."""
    figure = Figure(figsize=(style.PAGE, 2.4 * len(found)))
    for axes, line in zip(figure.subplots(len(found), squeeze=False).flat, found, strict=True):
        generation = [step.generation for step in line.steps]
        recorded = [max(step.recorded, 1) for step in line.steps]
        reborn = [max(step.reborn, 1) for step in line.steps]
        to_the_end = [*generation, line.generations], [*reborn, reborn[-1]]
        axes.step(*to_the_end, where="post", color=style.BLUE)
        axes.plot(generation, recorded, ".", color=style.ORANGE, markersize=4, markeredgewidth=0)
        axes.axvline(line.good.generation, color=style.FAINT, zorder=0)
        style.logarithmic(axes.yaxis)
        axes.set(xlabel="generation", ylabel="ticks lived", xlim=(0, max(line.generations, 1)))
        key = {"born again": style.BLUE, "as recorded": style.ORANGE, "as good from": style.SOFT}
        style.title(axes, f"The line of organism {line.organism} of world {line.world}", key)
    return figure
