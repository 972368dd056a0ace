"""Renders on a disk that is too small for them, and again once it is large enough."""

import os
import subprocess
from contextlib import contextmanager
from dataclasses import dataclass, field

from .kills import CHECKPOINT_MINUTES
from .render import FINAL, Reference, render, stray_files, temporary_files

PAGE = 4096  # bytes by which such a disk is sized
MARGIN = 4  # pages beyond what the finished files take


@dataclass
class FullDisk:
    """What became of renders on small disks."""

    case: object
    skipped: str = ""  # why
    disks: int = 0
    failed: int = 0  # with an error, as they should
    identical: int = 0  # after the disk was made larger
    stray: int = 0
    faults: list = field(default_factory=list)


def mount(*arguments):
    return subprocess.run(["mount", *map(str, arguments)], capture_output=True, text=True, check=False)


@contextmanager
def small_disk(directory, pages):
    """Makes `directory` a tmpfs of so many pages. Raises PermissionError with the reason if that is not allowed."""
    directory.mkdir()
    done = mount("-t", "tmpfs", "-o", f"size={pages * PAGE},mode=700", "tmpfs", directory)
    if done.returncode != 0:
        raise PermissionError(done.stderr.strip() or "mount failed")
    try:
        yield
    finally:
        subprocess.run(["umount", str(directory)], check=True)


def pages_of(output):
    return sum(-(-output.with_suffix(suffix).stat().st_size // PAGE) for suffix in FINAL)


def try_disk(program, case, directory, pages, reference, result):
    output = directory / "image.exr"
    options = ("--resume", "--checkpoint-every", CHECKPOINT_MINUTES)
    with small_disk(directory, pages):
        result.disks += 1
        first = render(program, case, output, *options)
        if first.returncode != 0:
            result.failed += 1
            if first.returncode != 1 or os.strerror(28) not in first.stderr:
                yield f"exit status {first.returncode} on a full disk: {first.stderr}"
            yield from (f"{path} is left on the full disk" for path in temporary_files(directory))
        yield from reference.faults(output, finished=first.returncode == 0)
        mount("-o", "remount,size=64m", directory)
        last = render(program, case, output, *options)
        if last.returncode != 0:
            yield f"exit status {last.returncode} once there was room: {last.stderr}"
        faults = list(reference.faults(output, finished=True))
        stray = stray_files(directory, [output])
        result.identical += not faults
        result.stray += len(stray)
        yield from faults
        yield from (f"{path} is left" for path in stray)


def torture_full_disk(program, case, count, directory, random):
    result = FullDisk(case)
    (directory / "reference").mkdir(parents=True)
    output = directory / "reference" / "image.exr"
    render(program, case, output)
    reference = Reference(output)
    try:
        for index in range(count):
            pages = random.randint(1, pages_of(output) + MARGIN)
            result.faults += try_disk(program, case, directory / f"disk-{index}", pages, reference, result)
            if result.faults:
                break
    except PermissionError as error:
        result.skipped = f"no tmpfs could be mounted: {error}"
    return result
