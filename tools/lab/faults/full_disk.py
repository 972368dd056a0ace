"""Renders on a disk that is too small for them, and again once it is large enough."""

import errno
import os
import subprocess
from contextlib import contextmanager
from dataclasses import dataclass, field

from .batches import BOOKS, batch_command, make_references, make_shots
from .kills import CHECKPOINT_MINUTES
from .render import FINAL, Reference, render, run, stray_files, temporary_files

PAGE = 4096  # bytes by which such a disk is sized
MARGIN = 8  # pages beyond what the finished files take


@dataclass
class FullDisk:
    """What became of renders or batches on small disks."""

    what: str
    skipped: str = ""  # why
    disks: int = 0
    failed: int = 0  # with an error, as they should
    images: int = 0
    identical: int = 0  # after the disk was made larger
    stray: int = 0
    faults: list = field(default_factory=list)


@dataclass(frozen=True)
class Work:
    """Something that makes images: `run(directory)` gives the finished process."""

    what: str
    run: callable
    references: dict  # by the names of the images
    books: tuple = ()  # what else it leaves
    pages: int = 0  # that the finished files take


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


def pages_of(directory, names):
    files = (directory / f"{name}{suffix}" for name in names for suffix in FINAL)
    return sum(-(-file.stat().st_size // PAGE) for file in files)


def image_faults(work, directory, finished):
    """By the name of each image."""
    return {name: list(reference.faults(directory / f"{name}.exr", finished))
            for name, reference in work.references.items()}


def try_disk(work, directory, pages, result):
    with small_disk(directory, pages):
        result.disks += 1
        first = work.run(directory)
        if first.returncode != 0:
            result.failed += 1
            if first.returncode != 1 or os.strerror(errno.ENOSPC) not in first.stderr:
                yield f"exit status {first.returncode} on a full disk: {first.stderr}"
            yield from (f"{path} is left on the full disk" for path in temporary_files(directory))
        for faults in image_faults(work, directory, finished=first.returncode == 0).values():
            yield from faults
        mount("-o", "remount,size=64m", directory)
        last = work.run(directory)
        if last.returncode != 0:
            yield f"exit status {last.returncode} once there was room: {last.stderr}"
        faults = image_faults(work, directory, finished=True)
        result.images += len(faults)
        result.identical += sum(not found for found in faults.values())
        outputs = [directory / f"{name}.exr" for name in work.references]
        stray = [path for path in stray_files(directory, outputs) if path.name not in work.books]
        result.stray += len(stray)
        for found in faults.values():
            yield from found
        yield from (f"{path} is left" for path in stray)


def torture_full_disk(work, count, directory, random):
    result = FullDisk(work.what)
    directory.mkdir()
    try:
        for index in range(count):
            pages = random.randint(1, work.pages + MARGIN)
            result.faults += try_disk(work, directory / f"disk-{index}", pages, result)
            if result.faults:
                break
    except PermissionError as error:
        result.skipped = f"no tmpfs could be mounted: {error}"
    return result


def one_render(program, case, directory):
    """The work of rendering one image, with checkpoints."""
    directory.mkdir()
    output = directory / "image.exr"
    render(program, case, output)
    options = ("--resume", "--checkpoint-every", CHECKPOINT_MINUTES)
    return Work("a render", lambda place: render(program, case, place / "image.exr", *options),
                {"image": Reference(output)}, pages=pages_of(directory, ["image"]))


def one_batch(program, directory):
    """The work of rendering several images as a batch."""
    directory.mkdir()
    shots = make_shots(directory / "shots", 1)
    references = make_references(program, shots, directory / "reference")
    return Work("a batch", lambda place: run(batch_command(program, directory / "shots", place)), references, BOOKS,
                pages_of(directory / "reference", references))
