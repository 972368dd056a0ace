"""Plots as SVG, written out without any library. They bring a background of their own and follow the reader's choice of
light or dark. Lines differ by marker as well as by colour."""

import math
from dataclasses import dataclass
from xml.sax.saxutils import escape

from benchmark.tables import SUPERSCRIPTS, exponent_text

STYLE = """
  text { font: 12px system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif; fill: #24292f; }
  .page { fill: #ffffff; }
  .title { font-size: 15px; font-weight: 600; }
  .name { font-size: 12.5px; font-weight: 600; }
  .faint { fill: #57606a; }
  .grid { stroke: #dfe3e8; fill: none; }
  .axis { stroke: #8c959f; fill: none; }
  .line { fill: none; stroke-width: 2; stroke-linejoin: round; }
  .c0 { stroke: #1f6fc5; } .m0 { fill: #1f6fc5; }
  .c1 { stroke: #c2570c; } .m1 { fill: #c2570c; }
  .c2 { stroke: #1a7f5a; } .m2 { fill: #1a7f5a; }
  .c3 { stroke: #8250c4; } .m3 { fill: #8250c4; }
  @media (prefers-color-scheme: dark) {
    text { fill: #e6edf3; }
    .page { fill: #12171e; }
    .faint { fill: #9aa4af; }
    .grid { stroke: #2b323b; }
    .axis { stroke: #6b7580; }
    .c0 { stroke: #6cb0ff; } .m0 { fill: #6cb0ff; }
    .c1 { stroke: #f5a163; } .m1 { fill: #f5a163; }
    .c2 { stroke: #55c99a; } .m2 { fill: #55c99a; }
    .c3 { stroke: #bd97f5; } .m3 { fill: #bd97f5; }
  }
"""


@dataclass
class Series:
    label: str
    points: list  # (x, y)
    exponent: float | None = None  # of the power law at its end


@dataclass
class Panel:
    title: str  # quantity and unit
    x_title: str
    series: list
    log_x: bool = True
    log_y: bool = True


@dataclass
class DotRow:
    name: str
    values: list  # one for each kind of dot; None is not drawn


def linear_ticks(high, most=5):
    """From 0 to `high` or just beyond, in steps of 1, 2 or 5 times a power of ten."""
    if high <= 0.0:
        return [0.0, 1.0]
    power = 10.0 ** math.floor(math.log10(high / most))
    step = next(factor * power for factor in (1, 2, 5, 10, 20) if math.ceil(high / (factor * power) - 1e-9) <= most)
    return [i * step for i in range(math.ceil(high / step - 1e-9) + 1)]


def log_ticks(low, high):
    """From `low` or just below to `high` or just beyond: 1, 2 and 5 times powers of ten over two decades, and over more of
    them the powers alone."""
    first, last = math.floor(math.log10(low) + 1e-9), math.ceil(math.log10(high) - 1e-9)
    if math.log10(high / low) > 2.0:
        step = math.ceil((last - first) / 7)
        return [10.0 ** k for k in range(first, first + step * math.ceil((last - first) / step) + 1, step)]
    all_ticks = [factor * 10.0 ** k for k in range(first - 1, last + 2) for factor in (1, 2, 5)]
    below = max(tick for tick in all_ticks if tick <= low * (1 + 1e-9))
    above = min(tick for tick in all_ticks if tick >= high * (1 - 1e-9) and tick > below)
    return [tick for tick in all_ticks if below <= tick <= above]


def tick_text(value):
    """Few characters: powers of ten beyond 1,000 and below a thousandth as such."""
    if value and not 0.00099 < abs(value) < 10_000:
        exponent = math.floor(math.log10(abs(value)) + 1e-9)
        factor = round(value / 10.0 ** exponent)
        return ("" if factor == 1 else f"{factor}·") + "10" + str(exponent).translate(SUPERSCRIPTS)
    return f"{value:,.6g}" if abs(value) >= 1000 else f"{value:.6g}"


class Axis:
    """From values to positions between two ends."""

    def __init__(self, ticks, logarithmic, begin, end):
        self.ticks, self.logarithmic, self.begin, self.end = ticks, logarithmic, begin, end

    def at(self, value):
        low, high, value = (math.log(v) if self.logarithmic else v for v in (self.ticks[0], self.ticks[-1], value))
        return self.begin + (self.end - self.begin) * (value - low) / (high - low)


def text(x, y, content, style="", anchor="start"):
    style = f' class="{style}"' if style else ""
    return f'<text x="{x:.1f}" y="{y:.1f}"{style} text-anchor="{anchor}">{escape(content)}</text>'


def marker(kind, x, y):
    """Of the size of a circle of radius 4: circle, diamond, square or triangle."""
    if kind == 0:
        return f'<circle class="m0" cx="{x:.1f}" cy="{y:.1f}" r="4"/>'
    shape = {1: "M0 -5.3L5.3 0L0 5.3L-5.3 0Z", 2: "M-3.7 -3.7H3.7V3.7H-3.7Z", 3: "M0 -5.2L4.8 3.8H-4.8Z"}[kind]
    return f'<path class="m{kind}" transform="translate({x:.1f} {y:.1f})" d="{shape}"/>'


def document(title, description, width, height, body):
    return "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
        f'role="img" aria-labelledby="title description">',
        f'<title id="title">{escape(title)}</title>', f'<desc id="description">{escape(description)}</desc>',
        f"<style>{STYLE}</style>", f'<rect class="page" width="{width}" height="{height}" rx="6"/>',
        text(16, 26, title, "title"), *body, "</svg>", ""])


PANEL_WIDTH, PLOT_HEIGHT, LEFT, RIGHT, TOP = 300, 200, 50, 24, 64
WHOLE_WIDTH = 600  # of a panel that has no other beside it
LEGEND_LINE = 17


def y_axis(panel, bottom, top):
    """From 0, or from below the least value where it is logarithmic."""
    values = [y for series in panel.series for _, y in series.points]
    ticks = log_ticks(min(values), max(values)) if panel.log_y else linear_ticks(max(values))
    return Axis(ticks, panel.log_y, bottom, top)


def x_ticks(panel):
    """Where the points are; with a linear axis, evenly spaced."""
    xs = sorted({x for series in panel.series for x, _ in series.points})
    if not panel.log_x:
        return linear_ticks(max(xs))
    return xs if len(xs) > 1 else log_ticks(min(xs), 2 * max(xs))


def draw_panel(panel, left, width, top):
    """With the legend above the plot; `top` is where the plot begins."""
    bottom, begin, end = top + PLOT_HEIGHT, left + LEFT, left + width - RIGHT
    x, y = Axis(x_ticks(panel), panel.log_x, begin, end), y_axis(panel, bottom, top)
    out = [text(left + 16, TOP - 10, panel.title, "name")]
    for tick in y.ticks:
        out += [f'<path class="grid" d="M{begin} {y.at(tick):.1f}H{end}"/>',
                text(begin - 7, y.at(tick) + 4, tick_text(tick), "faint", "end")]
    for tick in x.ticks:
        out += [f'<path class="axis" d="M{x.at(tick):.1f} {bottom}v5"/>',
                text(x.at(tick), bottom + 19, tick_text(tick), "faint", "middle")]
    out += [f'<path class="axis" d="M{begin} {bottom}H{end}"/>',
            text((begin + end) / 2, bottom + 38, panel.x_title, "faint", "middle")]
    for kind, series in enumerate(panel.series):
        row = TOP + 8 + LEGEND_LINE * kind
        out += [marker(kind, left + 22, row - 4), legend(series, left + 34, row)]
        places = [(x.at(px), y.at(py)) for px, py in series.points]
        out.append(f'<polyline class="line c{kind}" points="{" ".join(f"{px:.1f},{py:.1f}" for px, py in places)}"/>')
        out += [marker(kind, px, py) for px, py in places]
    return out


def legend(series, x, y):
    if series.exponent is None:
        return text(x, y, series.label)
    return (f'<text x="{x:.1f}" y="{y:.1f}">{escape(series.label)} <tspan class="faint">∝ N</tspan>'
            f'<tspan class="faint" dy="-4" font-size="10">{exponent_text(series.exponent)}</tspan></text>')


def curve_plot(title, panels):
    """Panels side by side."""
    most = max(len(panel.series) for panel in panels)
    top = TOP + 10 + LEGEND_LINE * most
    each = WHOLE_WIDTH if len(panels) == 1 else PANEL_WIDTH
    width, height = len(panels) * each, top + PLOT_HEIGHT + 52
    body = [line for i, panel in enumerate(panels) for line in draw_panel(panel, i * each, each, top)]
    parts = [f"{panel.title}: {', '.join(series.label for series in panel.series)}" for panel in panels]
    return document(title, f"Against {panels[0].x_title}. " + "; ".join(parts) + ".", width, height, body)


NAMES_WIDTH, ROW = 126, 21


def draw_dots(title, rows, logarithmic, left, top, kinds):
    """One panel of a dot plot; the names of the rows are drawn by its caller."""
    begin, end, bottom = left + 14, left + 350, top + ROW * len(rows) + 6
    values = [value for row in rows for value in row.values if value is not None]
    axis = Axis(log_ticks(min(values), max(values)) if logarithmic else linear_ticks(max(values), 7), logarithmic, begin, end)
    out = [text(begin, top - 14, title, "name")]
    for tick in axis.ticks:
        out += [f'<path class="grid" d="M{axis.at(tick):.1f} {top - 4}V{bottom}"/>',
                text(axis.at(tick), bottom + 16, tick_text(tick), "faint", "middle")]
    for i, row in enumerate(rows):
        y = top + ROW * (i + 0.5)
        out.append(f'<path class="grid" d="M{begin} {y:.1f}H{end}"/>')
        out += [marker(kind, axis.at(row.values[kind]), y) for kind in kinds if row.values[kind] is not None]
    return out


def dot_plot(title, panels, kinds):
    """Panels (title, rows, logarithmic) side by side that have the rows in common; `kinds` names the dots."""
    rows = panels[0][1]
    top, width = 84, NAMES_WIDTH + 380 * len(panels)
    height = top + ROW * len(rows) + 34
    body = []
    for kind, name in enumerate(kinds):
        x = NAMES_WIDTH + 20 + 80 * kind
        body += [marker(kind, x, 44), text(x + 11, 48, name)]
    body += [text(NAMES_WIDTH - 4, top + ROW * (i + 0.5) + 4, row.name, "", "end") for i, row in enumerate(rows)]
    for i, (name, of_panel, logarithmic) in enumerate(panels):
        body += draw_dots(name, of_panel, logarithmic, NAMES_WIDTH + 380 * i, top, range(len(kinds)))
    return document(title, "; ".join(f"{name} of each scene with {' and '.join(kinds)}" for name, _, _ in panels) + ".",
                    width, height, body)
