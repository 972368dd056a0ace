"""The program as a child: its progress, its previews, stopping it. Needs nothing of Blender."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from .program import ProgramError, child_environment, messages_of

PATIENCE = 2.0  # seconds between asking the program to end and killing it
STEP = 0.05  # seconds between two looks at whether to stop
PHASES = {"load": "Loading", "resume": "Reading the checkpoint", "build": "Building", "render": "Rendering", "write": "Writing"}


@dataclass
class Progress:
    phase: str = "load"
    fraction: float = 0.0

    def words(self) -> str:
        return PHASES.get(self.phase, self.phase)


@dataclass
class Ended:
    code: int
    cancelled: bool
    messages: list[tuple[str, str]]

    def error(self) -> str:
        """Returns the errors that the program has told, or else its exit code in words."""
        errors = [text for kind, text in self.messages if kind == "error"]
        return "\n".join(errors) or f"the program ended with {self.code}"


def tied(words: Sequence[str]) -> list[str]:
    """Returns the command that ends with this process, even if that is killed, where Linux has the tool for it."""
    tool = shutil.which("setpriv")
    is_whole = tool is not None and Path(tool).resolve().name == "setpriv"  # BusyBox's does not know the option
    return [tool, "--pdeathsig", "TERM", *words] if is_whole and os.access(words[0], os.X_OK) else list(words)


class Child:
    """One run of the program. `command` is the program with its arguments; progress comes by a pipe of its own."""

    def __init__(self, command: Sequence[str], progress: bool = True):
        self.progress = Progress()
        self.lines = b""
        self.errors = tempfile.TemporaryFile()
        self.reading = -1
        writing = -1
        words = [str(word) for word in command]
        try:
            if progress:
                self.reading, writing = os.pipe()
                os.set_blocking(self.reading, False)
                words += ["--progress-fd", str(writing)]
            # A group of its own: Ctrl-C at Blender's terminal reaches Blender alone, which stops the child.
            self.process = subprocess.Popen(tied(words), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=self.errors,
                                            pass_fds=[writing] if progress else (), env=child_environment(),
                                            start_new_session=True)
        except OSError as error:
            self.close()
            raise ProgramError(f"'{words[0]}' cannot be started: {error.strerror}") from None
        finally:
            if writing >= 0:
                os.close(writing)

    def close(self) -> None:
        self.errors.close()
        if self.reading >= 0:
            os.close(self.reading)
            self.reading = -1

    def read_progress(self) -> None:
        """Takes what has come; only the last line counts."""
        if self.reading < 0:
            return
        try:
            while chunk := os.read(self.reading, 65536):
                self.lines += chunk
        except BlockingIOError:
            pass
        *whole, self.lines = self.lines.split(b"\n")
        for line in whole[-1:]:
            try:
                said = json.loads(line)
                self.progress = Progress(said["phase"], float(said["fraction"]))
            except (ValueError, KeyError, TypeError):
                continue

    def ask_for_preview(self) -> bool:
        """Has the program write a preview; only while it renders, since it does not listen before."""
        if self.progress.phase != "render" or self.progress.fraction <= 0.0 or self.process.poll() is not None:
            return False
        self.process.send_signal(signal.SIGUSR1)
        return True

    def stop(self) -> None:
        """Ends the program: asks it first, and kills it if it takes too long."""
        self.process.terminate()
        try:
            self.process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()

    def messages(self) -> list[tuple[str, str]]:
        self.errors.seek(0)
        return messages_of(self.errors.read().decode("utf-8", "replace"))


def run(command: Sequence[str], is_stopped: Callable[[], bool], on_progress: Callable[[Progress], None] = lambda _: None,
        preview: Path | None = None, on_preview: Callable[[Path], None] = lambda _: None, every: float = 2.0,
        progress: bool = True) -> Ended:
    """Runs the program to its end, or until `is_stopped`. Asks for a preview `every` so many seconds, and hands over each
    that has come."""
    child = Child(command, progress)
    try:
        asked, seen, cancelled = 0.0, 0, False
        while child.process.poll() is None:
            if is_stopped():
                cancelled = True
                child.stop()
                break
            child.read_progress()
            on_progress(child.progress)
            if preview is not None:
                now = time.monotonic()
                if now - asked >= every and child.ask_for_preview():
                    asked = now
                changed = preview.stat().st_mtime_ns if preview.exists() else 0
                if changed not in (0, seen):
                    seen = changed
                    on_preview(preview)
            time.sleep(STEP)
        return Ended(child.process.returncode, cancelled, child.messages())
    finally:
        if child.process.poll() is None:
            child.stop()
        child.close()
