"""Runs commands of the program within limits."""

import os
import resource
import signal
import socket
import struct
import subprocess
import time
from dataclasses import dataclass

PAUSE = 0.004  # seconds between looks at a process
PATIENCE = 5  # times as long as it may work, a command may take by the clock
LARGEST_FILE = 1 << 28
START, HAS_ENDED, WAIT = range(3)  # requests, and all else of the protocol: tests/program/program_requests.h
REQUESTS = 3


@dataclass
class Ended:
    """How a command ended: its exit code, or minus the signal; None where it took too long."""

    code: int | None
    seconds: float
    error: str


def limit_this_process(memory, processor):
    """Address space for this process and all that it starts, which run on one processor and so with few threads."""
    os.sched_setaffinity(0, {processor})
    for what, most in ((resource.RLIMIT_AS, memory), (resource.RLIMIT_CORE, 0), (resource.RLIMIT_FSIZE, LARGEST_FILE)):
        hard = resource.getrlimit(what)[1]
        most = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(what, (most, most))


class Program:
    """The program, started anew for every command."""

    def __init__(self, path, seconds):
        self.path, self.seconds = path, seconds

    def run(self, words, folder, log):
        """Runs in `folder`; what is printed goes into the files `log`.out and `log`.err."""
        started = time.monotonic()
        with open(f"{log}.out", "wb") as out, open(f"{log}.err", "wb") as err:
            process = subprocess.Popen([self.path, *words], cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=err)
        is_late = stop_if_late(process.pid, self.seconds, lambda: process.poll() is not None)
        return Ended(None if is_late else process.wait(), time.monotonic() - started, read_text(f"{log}.err"))

    def close(self):
        pass


def stop_if_late(pid, seconds, has_ended):
    """Waits until a process has ended, and kills it after `seconds` on its processor; true if it did that."""
    started, is_late = time.monotonic(), False
    while not has_ended():
        # Busy machines make it wait, and that is no fault of the program.
        if not is_late and max(processor_seconds(pid), (time.monotonic() - started) / PATIENCE) > seconds:
            os.kill(pid, signal.SIGKILL)
            is_late = True
        time.sleep(PAUSE)
    return is_late


def processor_seconds(pid):
    try:
        with open(f"/proc/{pid}/stat", encoding="latin-1") as file:
            numbers = file.read().rpartition(")")[2].split()
    except (FileNotFoundError, ProcessLookupError):
        return 0.0
    return (int(numbers[11]) + int(numbers[12])) / os.sysconf("SC_CLK_TCK")


class ServedProgram:
    """etendue_served, which runs commands in copies of itself: those need not load its libraries."""

    def __init__(self, path, seconds):
        self.path, self.seconds = path, seconds
        self.process = None
        self.start()

    def start(self):
        self.socket, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)

        def prepare():
            os.dup2(theirs.fileno(), REQUESTS)
            os.set_inheritable(REQUESTS, True)

        # Whatever it inherits beyond the requests does no harm: they are files of this program only.
        self.process = subprocess.Popen([self.path, "--serve-tests"], close_fds=False, preexec_fn=prepare,
                                        stdin=subprocess.DEVNULL)
        theirs.close()

    def ask(self, request, pid=0, strings=(), words=0, variables=0):
        text = b"".join(one.encode("utf-8", "surrogateescape") + b"\0" for one in strings)
        self.socket.send(struct.pack("4i", request, pid, words, variables) + text)
        answer = self.socket.recv(4)
        if len(answer) != 4:
            raise OSError(f"{self.path} does not answer")
        return struct.unpack("i", answer)[0]

    def run(self, words, folder, log):
        started = time.monotonic()
        words = ["etendue", *words]
        variables = [f"{name}={value}" for name, value in os.environ.items()]
        pid = self.ask(START, strings=(str(folder), f"{log}.out", f"{log}.err", *words, *variables), words=len(words),
                       variables=len(variables))
        if pid <= 0:
            raise OSError(f"{self.path} cannot copy itself")
        is_late = stop_if_late(pid, self.seconds, lambda: self.ask(HAS_ENDED, pid))
        status = self.ask(WAIT, pid)
        return Ended(None if is_late else os.waitstatus_to_exitcode(status), time.monotonic() - started,
                     read_text(f"{log}.err"))

    def close(self):
        self.socket.close()
        self.process.wait()


def read_text(path):
    try:
        with open(path, "rb") as file:
            return file.read().decode("utf-8", "replace")
    except FileNotFoundError:
        return ""
