"""Several batches on one output directory, whose processes are killed and started again."""

import json
import os
import signal
import subprocess
import time
from dataclasses import dataclass, field
from pathlib import Path

from .kills import CHECKPOINT_MINUTES
from .render import TIMEOUT, Case, Reference, make_scenes, render, run, stray_files

BOOKS = ("ledger.jsonl", "report.json", "index.html")
SCENES = ("cornell-box", "caustic-ring", "veach-bidir", "many-lights")
OPTIONS = ("--size", "40x30", "--spp", "96", "--float")
LONGEST_PAUSE = 1.5  # seconds between kills


@dataclass
class Batches:
    """What became of one output directory."""

    processes: int
    images: int = 0
    kills: int = 0
    renders_killed: int = 0  # the process of one image, and not the batch
    started: int = 0
    identical: int = 0
    rendered_twice: int = 0  # finished more than once
    stray: int = 0
    faults: list = field(default_factory=list)


def make_shots(directory, copies):
    """Directories of scenes, each `copies` times with other seeds."""
    make_scenes(set(SCENES), directory)
    shots = []
    for name in SCENES:
        settings = json.loads((directory / name / "render.json").read_text())
        for seed in range(copies):
            shot = directory / f"{name}-{seed}"
            shot.mkdir()
            for file in (directory / name).iterdir():
                (shot / file.name).write_bytes(file.read_bytes())
            (shot / "render.json").write_text(json.dumps({**settings, "seed": seed}))
            shots.append(shot)
        for file in (directory / name).iterdir():
            file.unlink()
        (directory / name).rmdir()
    return shots


def batch_command(program, shots, out, *more):
    return [str(program), "batch", str(shots), "-o", str(out), *OPTIONS, "--checkpoint-every", CHECKPOINT_MINUTES,
            "--no-probe", "--threads", "1", "--quiet", *more]


def children_of(pid):
    try:
        with open(f"/proc/{pid}/task/{pid}/children", encoding="ascii") as file:
            return [int(child) for child in file.read().split()]
    except OSError:
        return []  # it has just ended


def still_at_work(directory):
    """The command lines of processes that name something below the directory."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            line = path.read_bytes()
        except OSError:
            continue  # it has just ended
        if f"{directory}/".encode() in line:
            found.append(line.replace(b"\0", b" ").decode(errors="replace"))
    return found


def kill_one(processes, random, result):
    """A batch, or the process that renders for it."""
    process = random.choice(processes)
    renders = children_of(process.pid)
    if renders and random.random() < 0.3:
        try:
            os.kill(random.choice(renders), signal.SIGKILL)
            result.renders_killed += 1
        except ProcessLookupError:
            pass
        return
    process.kill()
    if process.wait() < 0:
        result.kills += 1


def finished_units(out):
    """How many times each unit was finished, by the ledger; lines that a kill has torn are none."""
    finished = {}
    for line in (out / "ledger.jsonl").read_bytes().split(b"\n"):
        try:
            event = json.loads(line)
        except ValueError:
            continue
        if event["event"] == "unit finished":
            finished[event["unit"]] = finished.get(event["unit"], 0) + 1
    return finished


def check_output(out, references, result):
    outputs = [out / f"{name}.exr" for name in references]
    for output, reference in zip(outputs, references.values()):
        faults = list(reference.faults(output, finished=True))
        result.identical += not faults
        result.faults += faults
    stray = [path for path in stray_files(out, outputs) if path.relative_to(out).as_posix() not in BOOKS]
    result.stray = len(stray)
    result.faults += [f"{path} is left" for path in stray]
    finished = finished_units(out)
    result.rendered_twice = sum(count - 1 for count in finished.values())
    result.faults += [f"{unit} was rendered {count} times" for unit, count in finished.items() if count > 1]
    report = json.loads((out / "report.json").read_text())
    there = report["totals"]["rendered"] + report["totals"]["up_to_date"]
    if there != len(references):
        result.faults.append(f"{out}/report.json knows of {there} images, where {len(references)} are")


def make_references(program, shots, directory):
    """Images that were rendered one by one, by the names of their scenes."""
    directory.mkdir()
    references = {}
    for shot in shots:
        output = directory / f"{shot.name}.exr"
        settings = json.loads((shot / "render.json").read_text())
        render(program, Case(shot, settings["integrator"]["type"], OPTIONS), output)
        references[shot.name] = Reference(output)
    return references


def take_ended(processes, result):
    """Takes those that have ended out of the list; returns the exit statuses of those that were not killed."""
    ended = [process for process in processes if process.poll() is not None]
    for process in ended:
        processes.remove(process)
        messages = process.stderr.read()
        process.stderr.close()
        if process.returncode > 0:
            result.faults.append(f"a batch: exit status {process.returncode}: {messages}")
    return [process.returncode for process in ended if process.returncode >= 0]


def kill_and_restart(command, kills, random, result):
    """Keeps as many batches at work as there are to be, until so many were killed or one is done; lets the others end."""
    running, statuses = [], []
    deadline = time.monotonic() + TIMEOUT
    while result.kills < kills and not statuses and time.monotonic() < deadline:
        while len(running) < result.processes:
            running.append(subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                            errors="replace"))
            result.started += 1
        time.sleep(random.uniform(0.0, LONGEST_PAUSE))
        kill_one(running, random, result)
        statuses = take_ended(running, result)
    for process in running:
        process.wait(TIMEOUT)
    take_ended(running, result)


def torture_batches(program, processes, kills, copies, directory, random):
    """`processes` batches at a time, until `kills` of them have been killed or all is done; then one to the end."""
    result = Batches(processes)
    directory.mkdir()
    shots = make_shots(directory / "shots", copies)
    references = make_references(program, shots, directory / "reference")
    result.images = len(references)
    out = directory / "out"
    command = batch_command(program, directory / "shots", out, "--retries", "100")
    kill_and_restart(command, kills, random, result)
    last = run(command)
    result.started += 1
    if last.returncode != 0:
        result.faults.append(f"the last batch: exit status {last.returncode}: {last.stderr}")
    check_output(out, references, result)
    result.faults += [f"still at work: {line}" for line in still_at_work(directory)]
    return result
