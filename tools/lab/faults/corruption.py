"""Damaged checkpoints: a wrong byte, or a missing end."""

import subprocess
import time
from dataclasses import dataclass, field

from .kills import CHECKPOINT_MINUTES
from .render import Reference, command, render, stray_files

EVERY_SO_OFTEN = 10  # one damaged file in so many has a whole previous one beside it, another is cut off
MOST_ATTEMPTS = 10  # to catch a checkpoint


@dataclass
class Corruption:
    """What became of damaged checkpoints."""

    size: int = 0  # bytes of the checkpoint
    flipped: int = 0
    cut_off: int = 0
    refused: int = 0
    previous_used: int = 0
    faults: list = field(default_factory=list)


def make_checkpoint(program, case, directory):
    """The bytes of a checkpoint of a render under way, which is killed then. None if it was over too soon."""
    checkpoint = directory / "image.checkpoint"
    process = subprocess.Popen(command(program, case, directory / "image.exr", "--quiet", "--checkpoint-every",
                                       CHECKPOINT_MINUTES, "--threads", "1"), stderr=subprocess.DEVNULL)
    while process.poll() is None and not checkpoint.exists():
        time.sleep(0.001)
    process.kill()
    process.wait()
    data = checkpoint.read_bytes() if checkpoint.exists() else None
    for path in directory.iterdir():
        path.unlink()
    return data


def damage(data, index, random, result):
    """`data` with one byte changed, or cut off at a random place."""
    if index % EVERY_SO_OFTEN == 1:
        result.cut_off += 1
        return data[:random.randrange(len(data))]
    result.flipped += 1
    at = random.randrange(len(data))
    return data[:at] + bytes((data[at] ^ random.randint(1, 255),)) + data[at + 1:]


def try_damaged(program, case, directory, damaged, previous, reference, result):
    """Goes on with a damaged checkpoint, with the whole `previous` beside it or without."""
    output = directory / "image.exr"
    output.with_suffix(".checkpoint").write_bytes(damaged)
    if previous:
        (directory / "image.checkpoint.previous").write_bytes(previous)
    finished = render(program, case, output, "--resume", quiet=False)
    if previous:
        if finished.returncode != 0 or "damaged" not in finished.stderr:
            yield f"exit status {finished.returncode} with a whole previous checkpoint: {finished.stderr}"
        yield from reference.faults(output, finished=True)
        yield from (f"{path} is left" for path in stray_files(directory, [output]))
        result.previous_used += 1
    else:
        if finished.returncode != 3 or "damaged" not in finished.stderr:
            yield f"exit status {finished.returncode} with a damaged checkpoint only: {finished.stderr}"
        if any(path.exists() for path in (output, output.with_suffix(".png"), output.with_suffix(".json"))):
            yield "an image was made from a damaged checkpoint"
        result.refused += 1
    for path in directory.iterdir():
        path.unlink()


def torture_checkpoints(program, case, count, directory, random):
    result = Corruption()
    (directory / "reference").mkdir(parents=True)
    reference_output = directory / "reference" / "image.exr"
    render(program, case, reference_output)
    reference = Reference(reference_output)
    place = directory / "image"
    place.mkdir()
    whole = next(filter(None, (make_checkpoint(program, case, place) for _ in range(MOST_ATTEMPTS))), None)
    if whole is None:
        result.faults.append(f"{case.name}: no checkpoint was written in {MOST_ATTEMPTS} renders")
        return result
    result.size = len(whole)
    for index in range(count):
        previous = whole if index % EVERY_SO_OFTEN == 0 else None
        result.faults += try_damaged(program, case, place, damage(whole, index, random, result), previous, reference,
                                     result)
        if result.faults:
            (directory / "whole.checkpoint").write_bytes(whole)
            break
    return result
