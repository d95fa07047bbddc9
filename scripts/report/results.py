"""StepResult: what one step measured and on which machine, in a file of its own."""
import json
import os
from dataclasses import dataclass
from pathlib import Path

from .rows import Rows

FORMAT = 2
MACHINE_FIELDS = {"cpu": str, "cores": int, "compiler": str, "commit": str, "simd": str}


class ResultError(Exception):
    """A result cannot be used. The text names the file and the field."""


class NotMeasured(ResultError):
    """The file of a result does not exist."""


def error_text(error):
    """Returns one line about an error of a result or of the system.

    It names the file, if the error has one.
    """
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    return str(error)


@dataclass(frozen=True)
class Machine:
    cpu: str
    cores: int
    compiler: str
    commit: str
    simd: str

    @property
    def is_pinned(self):
        """Returns False if two different trees can have this commit's name."""
        return not (self.commit.endswith("-dirty") or self.commit == "unknown")

    def text(self):
        return f"{self.cpu}, {self.cores} cores; {self.compiler}; vectors {self.simd}; commit {self.commit}"


@dataclass(frozen=True)
class StepResult:
    step: str
    machine: Machine
    quick: bool
    luanti: str  # name and size of the real world
    measured_at: str  # UTC, as 2026-01-31T23:59:59Z
    seconds: float
    result: object  # the JSON that the benchmark wrote

    @property
    def key(self):
        """Results with equal keys may be compared."""
        return (self.machine, self.quick, self.luanti)


def field_of(content, name, kind, file, where=""):
    """Returns a field of an object. Fails if it is missing or of another type."""
    if not isinstance(content, dict):
        raise ResultError(f"{file}: {where or 'the document'} is not an object")
    if name not in content:
        raise ResultError(f"{file}: the field {where}{name} is missing")
    value = content[name]
    wanted = (int, float) if kind is float else kind
    if not isinstance(value, wanted) or (isinstance(value, bool) and kind is not bool):
        raise ResultError(f"{file}: the field {where}{name} is not of type {kind.__name__}")
    return value


def read_machine(content, file, where="machine."):
    return Machine(**{n: field_of(content, n, kind, file, where) for n, kind in MACHINE_FIELDS.items()})


def rows_of(step, result, file):
    """Returns the rows of a step's result. Fails if there are none or one lacks a field."""
    rows = field_of(result, step.rows, list, file, "result.") if step.rows else result
    if not isinstance(rows, list):
        raise ResultError(f"{file}: the field result is not of type list")
    name = f"result.{step.rows}" if step.rows else "result"
    if not rows:
        raise ResultError(f"{file}: the field {name} is empty")
    for i, row in enumerate(rows):
        for each in step.fields:
            if not isinstance(row, dict) or each not in row:
                raise ResultError(f"{file}: the field {name}[{i}].{each} is missing")
    return Rows(rows)


def result_file(folder, step_name):
    return Path(folder) / f"{step_name}.json"


def read_json(file):
    """Returns what a JSON file contains.

    Raises NotMeasured if there is no file, ResultError if it is broken.
    """
    try:
        return json.loads(Path(file).read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise NotMeasured(f"{file} is missing") from None
    except OSError as error:
        raise ResultError(error_text(error)) from None
    except ValueError as error:
        raise ResultError(f"{file}: {error}") from None


def read_result(folder, step):
    """Returns the result of a step.

    Raises NotMeasured if there is no file, ResultError if it is broken.
    """
    file = result_file(folder, step.name)
    content = read_json(file)
    if field_of(content, "format", int, file) != FORMAT:
        raise ResultError(f"{file}: the field format is {content['format']}, not {FORMAT}")
    if field_of(content, "step", str, file) != step.name:
        raise ResultError(f"{file}: the field step is {content['step']}, not {step.name}")
    machine = read_machine(field_of(content, "machine", dict, file), file)
    out = StepResult(
        step.name,
        machine,
        field_of(content, "quick", bool, file),
        field_of(content, "luanti", str, file),
        field_of(content, "measured_at", str, file),
        field_of(content, "seconds", float, file),
        content.get("result"),
    )
    rows_of(step, out.result, file)
    return out


def write_atomically(file, text):
    """Replaces a file. The file is never left half written."""
    file = Path(file)
    file.parent.mkdir(parents=True, exist_ok=True)
    unfinished = file.with_name(file.name + ".part")
    unfinished.write_text(text, encoding="utf-8")
    os.replace(unfinished, file)


def write_result(folder, result):
    content = {
        "format": FORMAT,
        "step": result.step,
        "quick": result.quick,
        "luanti": result.luanti,
        "measured_at": result.measured_at,
        "seconds": result.seconds,
        "machine": vars(result.machine),
        "result": result.result,
    }
    write_atomically(result_file(folder, result.step), json.dumps(content, indent=1) + "\n")
