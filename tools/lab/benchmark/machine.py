"""What else ran while something was measured."""

import os
import resource
import time
from pathlib import Path


def ticks():
    """Clock ticks of all processors since they started: at work, and taken by the host of a virtual machine."""
    # Fields of proc_stat(5): user nice system idle iowait irq softirq steal.
    fields = [int(field) for field in Path("/proc/stat").read_text().splitlines()[0].split()[1:9]]
    user, nice, system, _, _, irq, soft_irq, stolen = fields
    return user + nice + system + irq + soft_irq, stolen


def own_seconds():
    """Processor seconds of this process and of its children that have ended."""
    usages = (resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN))
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


class Watch:
    """From its making to conditions()."""

    def __init__(self):
        self.load_before = os.getloadavg()[0]
        self.ticks, self.own, self.clock = ticks(), own_seconds(), time.monotonic()

    def conditions(self):
        """Seconds that have passed, the load of the minute before, processors that others used on average, and those that
        the host withheld."""
        seconds = time.monotonic() - self.clock
        hertz = os.sysconf("SC_CLK_TCK")
        busy, stolen = ((now - before) / hertz for now, before in zip(ticks(), self.ticks))
        others = max(0.0, busy - (own_seconds() - self.own))
        return {"seconds": seconds, "load_before": self.load_before, "others": others / seconds, "withheld": stolen / seconds}


def between(values, digits):
    low, high = (f"{value:.{digits}f}" for value in (min(values), max(values)))
    return low if low == high else f"{low} to {high}"


def conditions_text(conditions):
    """A sentence on one or more of what conditions() returns."""
    seconds = sum(each["seconds"] for each in conditions)
    others, withheld = (sum(each[key] * each["seconds"] for each in conditions) / seconds for key in ("others", "withheld"))
    load = between([each["load_before"] for each in conditions], 1)
    text = f"Load of the machine before: {load}. Meanwhile other programs used {others:.2f} of {os.cpu_count()} processors"
    # A hundredth of a processor is what the clock ticks cannot tell.
    if withheld > 0.01:
        text += f", and the host of the virtual machine withheld {withheld:.2f}"
    return text + "."
