"""Runner: measures steps with runstone-bench and continues an interrupted run."""
import base64
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from .results import (
    Machine,
    ResultError,
    StepResult,
    error_text,
    read_json,
    read_machine,
    read_result,
    rows_of,
    write_result,
)
from .steps import PictureStep

MACHINE_SECONDS = 1


def world_name(folder):
    """Returns the folder's name and the size of its content, which distinguishes worlds of one name."""
    path = Path(folder).resolve()
    map_file = path / "map.sqlite"
    return f"{path.name} of {map_file.stat().st_size if map_file.exists() else 0} bytes"


def duration_text(seconds):
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.1f} min"


class Runner:
    def __init__(self, bench, out, luanti, quick, again):
        self.bench, self.luanti, self.quick, self.again = Path(bench).resolve(), luanti, quick, again
        self.out, self.data = Path(out), Path(out) / "data"

    def call(self, step_name, seconds, arguments, log):
        """Runs runstone-bench, which is expected to take so many seconds.

        Raises ResultError with its last line if it fails, or if it does not end in far more than
        these seconds.
        """
        limit = 10 * seconds + 600
        try:
            done = subprocess.run(
                [self.bench, *arguments], stdout=log, stderr=subprocess.PIPE, text=True, check=False, timeout=limit
            )
        except subprocess.TimeoutExpired:
            raise ResultError(
                f"{self.bench.name} {arguments[0]} of the step {step_name} did not end in {duration_text(limit)}"
            ) from None
        log.write(done.stderr)
        log.flush()
        if done.returncode != 0:
            lines = done.stderr.strip().splitlines() or ["no message"]
            raise ResultError(f"{self.bench.name} {arguments[0]} ended with code {done.returncode}: {lines[-1]}")

    def machine(self):
        """Returns the machine and the commit of runstone-bench."""
        with tempfile.TemporaryDirectory() as folder, open(self.out / "run.log", "a", encoding="utf-8") as log:
            file = Path(folder) / "machine.json"
            self.call("machine", MACHINE_SECONDS, ["machine", "--json", file], log)
            return read_machine(read_json(file), file, "")

    def is_measured(self, step, machine: Machine):
        """Returns True if the folder has a comparable result."""
        if self.again or not machine.is_pinned:
            return False
        try:
            return read_result(self.data, step).key == (machine, self.quick, world_name(self.luanti))
        except ResultError:
            return False

    def objection(self, steps):
        """Returns why a quick run must not begin, or None."""
        if not self.quick or self.again:
            return None
        for step in steps:
            try:
                if not read_result(self.data, step).quick:
                    return (
                        f"{self.out} has results of a full run, which a quick one would replace: "
                        "name another folder or give --again"
                    )
            except ResultError:
                continue
        return None

    def _measure_json(self, step, folder, log):
        file = Path(folder) / "result.json"
        luanti = ["--luanti", self.luanti] if step.uses_luanti else []
        self.call(step.name, step.seconds, [*step.arguments, *luanti, "--json", file], log)
        return read_json(file)

    def _measure_pictures(self, step, folder, log):
        rows = []
        for scenario in step.scenarios:
            file = Path(folder) / f"{scenario}.png"
            self.call(step.name, step.seconds, [*step.picture_arguments(scenario), "--out", file], log)
            rows.append({"scenario": scenario, "png": base64.b64encode(file.read_bytes()).decode("ascii")})
        return {"rows": rows}

    def measure(self, step, machine):
        """Measures a step and writes its result. Returns the seconds it took."""
        start = time.monotonic()
        with tempfile.TemporaryDirectory() as folder, open(self.out / "run.log", "a", encoding="utf-8") as log:
            log.write(f"\n== {step.name} ==\n")
            log.flush()
            measure = self._measure_pictures if isinstance(step, PictureStep) else self._measure_json
            result = measure(step, folder, log)
        rows_of(step, result, f"result of {step.name}")
        seconds = time.monotonic() - start
        at = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
        write_result(
            self.data,
            StepResult(step.name, machine, self.quick, world_name(self.luanti), at, round(seconds, 2), result),
        )
        return seconds

    def run(self, steps, failures, err=sys.stderr):
        """Measures what is not measured yet.

        Adds the errors of the steps that fail to `failures`, by name.
        """
        machine = self.machine()
        left = sum(step.seconds for step in steps)
        for i, step in enumerate(steps):
            print(
                f"[{i + 1}/{len(steps)}] {step.name}, about {duration_text(left)} left: ", end="", file=err, flush=True
            )
            left -= step.seconds
            if self.is_measured(step, machine):
                print("is there", file=err)
                continue
            try:
                print(duration_text(self.measure(step, machine)), file=err)
            except (ResultError, OSError) as error:
                failures[step.name] = error_text(error)
                print(f"failed: {failures[step.name]}", file=err)
