"""The Python interface to an experiment."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.console import Console

from primordia.api.runs import Run
from primordia.comparison.comparison import Comparison, compare
from primordia.experiments import campaign
from primordia.experiments.status import CampaignStatus
from primordia.experiments.view import table
from primordia.runs.records import Records
from primordia.tracking.track import Sources


class Experiment(Run):
    """The directory of an experiment. Its runs are in `arms`.

    Methods of a run, such as `oldest` or `table`, are called on an arm:
    `experiment.arms["heredity"]`.
    """

    @property
    def question(self) -> str:
        """The question that the experiment answers."""
        return self._recorded().plan.question

    @property
    def arms(self) -> dict[str, Run]:
        """The arms by name, each as a `Run`; the reference comes first."""
        return {name: Run(folder) for name, folder in self._recorded().arms.items()}

    def _summary(self) -> str:
        console = Console(highlight=False, color_system=None, width=100)
        with console.capture() as captured:
            console.print(table(self.status()))
        return captured.get()

    def directories(self) -> tuple[Path, ...]:
        """Return the directories of the runs that have a checkpoint."""
        return tuple(path for runs in self._recorded().runs().values() for path in runs)

    def records(self) -> list[Records]:
        """Open the records of each arm for reading."""
        return self._recorded().opened()

    def status(self) -> CampaignStatus:
        """Return the number of jobs in each state and the counts of each arm, without opening a run."""
        return self._recorded().status()

    def info(self) -> dict[str, Any]:
        """Return the question, the number of jobs in each state, and the worlds of each arm."""
        return self._recorded().info()

    def compare(
        self, births: int | None = None, ticks: int | None = None, island: str | None = None
    ) -> Comparison:
        """Compare the arms; see `comparison.compare`."""
        return compare(self.records(), births, ticks, island)

    def plot(
        self, out: str | Path | None = None, world: int = 0, figures: Sequence[str] = ()
    ) -> list[Path]:
        """Draw the comparison of the arms, and the figures of each arm in a folder named like the arm."""
        from primordia.figures.comparison import save  # Matplotlib takes a second to load

        folder = Path(out) if out is not None else self.path / "figures"
        drawn = [
            path
            for name, arm in self.arms.items()
            for path in arm.plot(folder / name, world, figures)
        ]
        return [*save(self.compare(), folder), *drawn]

    def report(self, out: str | Path | None = None) -> Path:
        """Write a page that compares the arms, by default `report.html` in the experiment's directory."""
        from primordia.report.report import report  # Matplotlib takes a second to load

        return report(self._recorded(), Path(out) if out is not None else None)

    def sources(self) -> Sources:
        """Return the directories of each arm's runs, and whether jobs are left."""
        recorded = self._recorded()
        jobs, runs = recorded.status().jobs, recorded.runs()
        named = {name if len(runs) > 1 else "": paths for name, paths in runs.items()}
        return Sources(named, jobs["running"] + jobs["waiting"] > 0)

    def _recorded(self) -> campaign.Campaign:
        return campaign.recorded(self.path)
