"""Makes mutants by their number, has the program inspect and render them, and judges what it did."""

import re
import shutil
import signal
from dataclasses import dataclass, field
from random import Random

from . import data, structure
from .images import nonfinite_colors

MUTATIONS = structure.MUTATIONS | data.MUTATIONS
# Most of the others are refused at once, and tell nothing of what comes after the loader.
WEIGHTS = {kind: 1 for kind in MUTATIONS} | {"number": 5, "graft": 5, "accessor": 3, "transform": 2, "setting": 4, "values": 4, "values scaled": 3, "index": 2,
                                             "enumeration": 2, "extension": 2, "array": 2, "key deleted": 2}
INTEGRATORS = ("path", "bdpt", "light", "whitted", "direct", "naive")
OK, REFUSED = 0, 3
TRIES = 50
LONGEST_PATH = 64  # edges


@dataclass
class Mutant:
    """A model and how it was made."""

    number: int
    base: str
    kinds: list
    changes: list
    options: list  # of render
    model: object = field(repr=False)


def make_mutant(number, seed, bases, size, kinds=None):
    """Equal for equal number, seed, bases and kinds, whichever others are made."""
    random = Random(f"{seed} {number}")
    model = random.choice(bases).copy()
    prepare(model, number, random)
    wanted = random.choices((1, 2, 4), (7, 2, 1))[0]
    used, changes, choices = [], [], list(kinds or MUTATIONS)
    weights = [WEIGHTS[kind] for kind in choices]
    for _ in range(TRIES):
        (kind,) = random.choices(choices, weights)
        change = MUTATIONS[kind](model, random, bases)
        if change is not None:
            used.append(kind)
            changes.append(change)
        if len(used) == wanted:
            break
    make_small(model.settings, size)
    return Mutant(number, model.name, used, changes, moment_of(model, number), model)


def prepare(model, number, random):
    """All integrators take turns, and half of what can move does so while the shutter is open."""
    integrator = model.settings.setdefault("integrator", {})
    integrator["type"] = INTEGRATORS[number % len(INTEGRATORS)]
    if model.document.get("animations") and random.random() < 0.5:
        model.settings |= {"time_code": 0.3, "shutter": [0, 0.2]}


def moment_of(model, number):
    """Options for another moment than that of render.json: whatever moves has to be sound at all of them."""
    moves = isinstance(model.document.get("animations"), list) and model.document["animations"]
    return ["--time-code", "0.3", "--shutter", "0:0.2"] if moves and number // len(INTEGRATORS) % 2 else []


def make_small(settings, size):
    """No large images and no long paths, which anybody may ask for; numbers that are not allowed stay."""
    if is_in(settings.get("spp", 1), 1 << 24):
        settings["spp"] = 1
    resolution = settings.get("size", list(size))
    if isinstance(resolution, list) and len(resolution) == 2 and all(is_in(one, 1 << 16) for one in resolution):
        settings["size"] = list(size)
    integrator = settings.get("integrator")
    for key in ("max_depth", "roulette_depth"):
        if isinstance(integrator, dict) and is_in(integrator.get(key), (1 << 31) - 1):
            integrator[key] = min(integrator[key], LONGEST_PATH)


def is_in(value, last):
    return isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= last


@dataclass
class Outcome:
    """What became of a mutant."""

    number: int
    base: str
    kinds: list
    changes: list
    seconds: float
    faults: list
    result: str  # rendered, refused or fault
    said: str  # why it is refused, or how it failed


def signal_name(code):
    try:
        return signal.Signals(-code).name
    except ValueError:
        return f"signal {-code}"


def last_line(text):
    lines = [line for line in text.splitlines() if line.strip()]
    return lines[-1][:300] if lines else "nothing on stderr"


def faults_of_command(name, ended, seconds):
    if ended.code is None:
        return [f"{name}: runs for more than {seconds:g} s"]
    if ended.code < 0:
        return [f"{name}: {signal_name(ended.code)}: {last_line(ended.error)}"]
    if ended.code not in (OK, REFUSED):
        return [f"{name}: exit code {ended.code}: {last_line(ended.error)}"]
    return []


def listing(folder):
    """Every file below, and what changes when it is written to."""
    return {str(path.relative_to(folder)): (path.lstat().st_size, path.lstat().st_mtime_ns)
            for path in folder.rglob("*") if not path.is_dir()}


def faults_of_image(path):
    try:
        count = nonfinite_colors(path)
    except (OSError, ValueError) as error:
        return [] if "one part" in str(error) else [f"render: no image that can be read: {error}"]
    return [f"render: {count} values of the image are not finite"] if count else []


class Laboratory:
    """Tries mutants in folders below `scratch`."""

    def __init__(self, program, scratch, keep=None):
        self.program, self.scratch, self.keep = program, scratch, keep

    def attempt(self, mutant, keep_always=False):
        # Deep, so that a file that is written to ../.. is seen.
        top = self.scratch / f"mutant-{mutant.number}"
        scene, out, logs = top / "in/a/scene", top / "in/a/out", top / "logs"
        for folder in (scene, out, logs):
            folder.mkdir(parents=True)
        mutant.model.write(scene)
        outcome = self.judge(mutant, top, scene, out, logs)
        if self.keep is not None and (outcome.faults or keep_always):
            kept = self.keep / str(mutant.number)
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(scene, kept)
        shutil.rmtree(top)
        return outcome

    def judge(self, mutant, top, scene, out, logs):
        before = listing(top / "in")
        words = ["render", str(scene), "-o", str(out / "image.exr"), "--threads", "1", *mutant.options]
        inspected = self.program.run(["inspect", str(scene), *mutant.options], out, logs / "inspect")
        rendered = self.program.run(words, out, logs / "render")
        faults = faults_of_command("inspect", inspected, self.program.seconds) + \
            faults_of_command("render", rendered, self.program.seconds)
        if {inspected.code, rendered.code} == {OK, REFUSED}:
            which = "render" if rendered.code == REFUSED else "inspect"
            said = rendered.error if rendered.code == REFUSED else (logs / "inspect.out").read_text(errors="replace")
            faults.append(f"only {which} refuses it: {error_line(said)}")
        after = listing(top / "in")
        own = {name for name in after if name.startswith("a/out/")}
        faults += [f"{name} was written" for name in after if name not in own and after[name] != before.get(name)]
        faults += [f"{name} is gone" for name in before if name not in after]
        if rendered.code == OK:
            faults += faults_of_image(out / "image.exr")
        elif rendered.code == REFUSED and own:
            faults.append(f"render: refuses it and writes {len(own)} files")
        if rendered.code == REFUSED and not rendered.error.strip():
            faults.append("render: does not say why it refuses it")
        result = "fault" if faults else "refused" if rendered.code == REFUSED else "rendered"
        return Outcome(mutant.number, mutant.base, mutant.kinds, mutant.changes,
                       round(inspected.seconds + rendered.seconds, 2), faults, result,
                       error_line(rendered.error) if rendered.code != OK else "")


def error_line(text):
    """The first that begins as errors do."""
    return next((line[:300] for line in text.splitlines() if "error" in line), last_line(text))


def signature(fault):
    """A fault without what differs between mutants that have it: paths, numbers, quoted names."""
    fault = re.sub(r"/\S*/(in|logs)/\S*", "FILE", fault)
    fault = re.sub(r"(#|at )?(/[\w.~%-]+){1,}", "POINTER", fault)
    return re.sub(r"-?\d[\d.,e+-]*", "N", re.sub(r"'[^']*'|\"[^\"]*\"", "'...'", fault))[:160]
