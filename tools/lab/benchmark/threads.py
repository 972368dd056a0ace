"""How rendering speeds up with threads, and how soon a first sample of every pixel is there: both on cornell-box."""

import statistics

from benchmark import etendue, standard
from benchmark.curves import FIXED_SCENE
from benchmark.plots import Panel, Series, curve_plot
from benchmark.tables import figure, table


def thread_counts(processors):
    """Powers of two below the number of processors, and that."""
    counts = []
    while 2 ** len(counts) < processors:
        counts.append(2 ** len(counts))
    return counts + [processors]


def measure(setup):
    """Repetitions of all numbers of threads take turns."""
    mode = setup.mode
    threads = ",".join(map(str, thread_counts(setup.processors)))
    setup.say(f"threads, {threads}")
    size = ["--size", mode.size] if mode.size else []
    data = etendue.profile(setup.program, setup.scenes / FIXED_SCENE, setup.folder / "profile",
                           ["--integrators", ",".join(standard.INTEGRATORS), "--threads", threads, "--seconds", mode.seconds,
                            "--repeat", mode.thread_repeat, *size])
    # All runs of a profile are of one process; peaks of memory are of renders by themselves.
    for run in data["runs"]:
        run["peak"] = etendue.render(setup.program, setup.scenes / FIXED_SCENE, setup.folder / "image.exr",
                                     ["--integrator", run["integrator"], "--threads", run["threads"], "--spp", mode.spp,
                                      *size])["peak"]
    return data


def seconds_per_sample(run):
    return [seconds / run["samples"] for seconds in run["seconds"]]


def speed_ups(data, integrator, threads):
    """Of each repetition over that of one thread which was made beside it, in ascending order; empty if not measured."""
    one, many = (standard.run_of(data, integrator, count) for count in (1, threads))
    if one is None or many is None:
        return []
    return sorted(a / b for a, b in zip(seconds_per_sample(one), seconds_per_sample(many)))


def speed_up_text(values):
    if len(values) < 2:
        return figure(values[0]) if values else figure(None)
    return f"{statistics.median(values):.2f}, {values[0]:.2f} to {values[-1]:.2f}"


def threads_table(data):
    rows = []
    for run in data["runs"]:
        values = speed_ups(data, run["integrator"], run["threads"]) if run["threads"] > 1 else []
        rows.append([f"`{run['integrator']}`", str(run["threads"]), figure(run["samples_per_second"] / 1e6),
                     figure(statistics.median(run["cpu_seconds"]) / run["samples"] * 1e6), speed_up_text(values),
                     figure(run["peak"] / 1e6)])
    return table(["integrator", "threads", "Msamples/s", "CPU µs a sample", "speed-up: median, least to most", "peak, MB"],
                 rows, words=(0, 4))


def plot(data):
    speeds, costs, peaks = [], [], []
    for integrator in standard.INTEGRATORS:
        runs = [run for run in data["runs"] if run["integrator"] == integrator]
        speeds.append(Series(integrator, [(run["threads"], run["samples_per_second"] / 1e6) for run in runs]))
        costs.append(Series(integrator, [(run["threads"], statistics.median(run["cpu_seconds"]) / run["samples"] * 1e6)
                                         for run in runs]))
        peaks.append(Series(integrator, [(run["threads"], run["peak"] / 1e6) for run in runs]))
    return curve_plot("Threads: cornell-box", [Panel("million samples a second", "threads", speeds, True, False),
                                               Panel("CPU µs a sample", "threads", costs, True, False),
                                               Panel("peak memory, MB", "threads", peaks, True, False)])


def measure_start(setup):
    """Seconds from the start of the process to the end of a first sample of every pixel, by processes of their own."""
    seconds = []
    for turn in range(setup.mode.starts):
        setup.say(f"start {turn + 1} of {setup.mode.starts}")
        data = etendue.profile(setup.program, setup.scenes / FIXED_SCENE, setup.folder / "profile",
                               ["--integrators", "path", "--threads", setup.processors, "--spp", 1, "--repeat", 1])
        seconds.append(data["first_pixel"])
    return {"first_pixel": seconds, "width": data["scene"]["width"], "height": data["scene"]["height"]}
