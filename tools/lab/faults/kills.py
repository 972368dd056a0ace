"""SIGKILL at random times, and going on to the end."""

import subprocess
import time
from dataclasses import dataclass, field

from .render import TIMEOUT, Reference, command, render, stray_files, temporary_files

CHECKPOINT_MINUTES = "0.0005"  # 30 ms: writes are most of what is done
MOST_THREADS = 3
MOST_KILLS = 8  # of one image
POLL = 0.0003  # seconds between looks at the directory


@dataclass
class Kills:
    """What became of one case."""

    case: object
    kills: int = 0
    during_writes: int = 0
    resumes: int = 0
    images: int = 0
    identical: int = 0
    stray: int = 0
    faults: list = field(default_factory=list)


def wait_for_write(process, directory, suffix, count):
    """Until the `count`-th time that a temporary file of a file with this suffix is there, or the end of the process."""
    seen, was_there = 0, False
    deadline = time.monotonic() + TIMEOUT
    while process.poll() is None and time.monotonic() < deadline:
        is_there = any(suffix in path.name for path in temporary_files(directory))
        seen += is_there and not was_there
        if seen >= count:
            return
        was_there = is_there
        time.sleep(POLL)


def kill_at_random(process, directory, seconds, random):
    """Waits as chance will have it, for a time or for a write, and kills. True if the process was still there."""
    kind = random.choice(("time", "checkpoint", "checkpoint", "image"))
    if kind == "time":
        try:
            process.wait(random.uniform(0.0, seconds))
        except subprocess.TimeoutExpired:
            pass
    elif kind == "checkpoint":
        wait_for_write(process, directory, ".checkpoint", random.randint(1, 6))
    else:
        wait_for_write(process, directory, random.choice((".exr", ".png", ".json")), 1)
    if kind != "time":
        time.sleep(random.choice((0.0, random.uniform(0.0, 0.004))))
    process.kill()
    return process.wait() < 0


def torture_image(program, directory, reference, seconds, most_kills, random, result):
    """One image, killed up to `most_kills` times and resumed to its end."""
    output = directory / "image.exr"
    killed = 0
    while killed < most_kills:
        threads = str(random.randint(1, MOST_THREADS))
        process = subprocess.Popen(
            command(program, result.case, output, "--quiet", "--resume", "--checkpoint-every", CHECKPOINT_MINUTES,
                    "--threads", threads), stderr=subprocess.PIPE, text=True, errors="replace")
        with process:
            died = kill_at_random(process, directory, seconds, random)
            messages = process.stderr.read()
        result.faults += reference.faults(output, finished=False)
        if not died:
            if process.returncode != 0:
                result.faults.append(f"{result.case.name}: exit status {process.returncode}: {messages}")
            break
        killed += 1
        result.during_writes += bool(temporary_files(directory))
    result.kills += killed
    result.resumes += killed
    last = render(program, result.case, output, "--resume")
    if last.returncode != 0:
        result.faults.append(f"{result.case.name}: exit status {last.returncode}: {last.stderr}")
    faults = list(reference.faults(output, finished=True))
    stray = stray_files(directory, [output])
    result.faults += faults + [f"{path} is left" for path in stray]
    result.images += 1
    result.identical += not faults
    result.stray += len(stray)


def torture_case(program, case, kills, directory, random):
    """`kills` kills of renders of one case, and one image at least."""
    result = Kills(case)
    output = directory / "reference" / "image.exr"
    output.parent.mkdir(parents=True)
    start = time.monotonic()
    whole = render(program, case, output)
    seconds = time.monotonic() - start
    if whole.returncode != 0:
        result.faults.append(f"{case.name}: exit status {whole.returncode}: {whole.stderr}")
        return result
    reference = Reference(output)
    while (result.images == 0 or result.kills < kills) and not result.faults:
        place = directory / f"image-{result.images:03}"
        place.mkdir()
        torture_image(program, place, reference, seconds, min(MOST_KILLS, kills - result.kills), random, result)
    return result
