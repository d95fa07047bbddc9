"""Evidence: the results of all steps from this machine and from others, and what is wrong with them.

A report folder has the results of this machine in data/. The data folder of another machine's report
may be copied to data/NAME: the page then shows the ratios of both.
"""
from collections import Counter
from pathlib import Path

from .results import NotMeasured, ResultError, read_result, rows_of
from .rows import Rows


class Results:
    """The results of one folder."""

    def __init__(self, folder, steps, failures=None):
        self.folder = Path(folder)
        self.errors, self._found, self._rows = {}, {}, {}
        self.failures = failures or {}
        for step in steps:
            try:
                self._found[step.name] = read_result(folder, step)
                self._rows[step.name] = rows_of(step, self._found[step.name].result, folder)
            except NotMeasured:
                continue
            except ResultError as error:
                self.errors[step.name] = str(error)
        keys = Counter(r.key for r in self._found.values())
        self.common = next((r for r in self._found.values() if r.key == keys.most_common(1)[0][0]), None)

    def find(self, step):
        return self._found.get(step)

    def rows(self, step):
        """Returns the rows of a step; none if it was not measured."""
        return self._rows.get(step, Rows())

    def all_rows(self, steps):
        return sum((self.rows(step) for step in steps), Rows())

    def has_any(self, steps):
        return any(step in self._found for step in steps)

    def doubts(self, steps):
        """Returns what a reader must know about these results: missing, failed, broken, other
        machine.
        """
        out, absent = [], []
        for step in steps:
            found = self.find(step)
            if step in self.failures:
                older = " The older result is shown." if found else ""
                out.append(f"The step {step} failed in this run: {self.failures[step]}.{older}")
            elif step in self.errors:
                out.append(f"The result of the step {step} cannot be used: {self.errors[step]}.")
            elif found is None:
                absent.append(step)
            elif found.key != self.common.key:
                length = "a quick run" if found.quick else "a full run"
                out.append(
                    f"The step {step} was measured differently from the rest: {found.machine.text()}; "
                    f"world {found.luanti}; {length}."
                )
        if absent:
            out.append(f"Not measured: {', '.join(absent)}.")
        return out


class Evidence:
    def __init__(self, out, steps, thesis, failures=None):
        data = Path(out) / "data"
        self.steps, self.thesis = steps, thesis
        self.here = Results(data, steps, failures)
        folders = sorted(f for f in data.iterdir() if f.is_dir()) if data.is_dir() else []
        self.others = [Results(f, steps) for f in folders]
        self.machines = [r for r in (self.here, *self.others) if r.common]

    def machine_name(self, results):
        """Returns a name for a row of a chart: the processor, and the folder if two have the same."""
        cpu = results.common.machine.cpu
        twice = sum(r.common.machine.cpu == cpu for r in self.machines) > 1
        return f"{cpu} ({results.folder.name})" if twice and results is not self.here else cpu

    def errors(self):
        """Returns the errors of all results, also of a machine of which no result can be read."""
        return [e for r in (self.here, *self.others) for e in r.errors.values()]

    def doubts(self, steps):
        """Returns the doubts about the results of all machines.

        The folder of another machine is named.
        """
        out = self.here.doubts(steps)
        for results in self.others:
            if results.common or results.errors:
                out += [f"In data/{results.folder.name}: {doubt}" for doubt in results.doubts(steps)]
        return out
