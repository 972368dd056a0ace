// ---- Accelerators ----

const measuredKind = (measure, kind) => measure.kinds.find((one) => one.kind === kind);
const acceleratorFill = (index) => (index < 6 ? `var(--v${index})` : tint("var(--v0)", 0.5));

/** A bar of each accelerator for each kind of rays, in rays per second, logarithmic. */
function acceleratorPlot(measures, kinds) {
  return (width) => {
    const left = Math.min(120, 0.3 * width), right = width - 64, bar = 13, step = bar * measures.length + 16;
    const rates = measures.flatMap((measure) => measure.kinds.map((kind) => kind.rays_per_second)).filter((rate) => rate > 0);
    const low = Math.floor(Math.log10(Math.min(...rates)) - 0.3), high = Math.log10(Math.max(...rates));
    const bottom = step * kinds.length, decades = Math.max(1, Math.ceil(high) - low);
    const x = (value) => left + (Math.log10(value) - low) / (high - low) * (right - left);
    const marks = Array.from({ length: decades }, (_, i) => 10 ** (low + i));
    return canvas(width, bottom + 24, "Rays per second by kind, logarithmic; the values are in the table",
      timeAxis(marks, x, 0, bottom, formatCount),
      kinds.map((kind, i) => [words(left - 10, step * i + step / 2 + 4, kind, { "text-anchor": "end" }),
        measures.map((measure, j) => {
          const rate = measuredKind(measure, kind)?.rays_per_second, y = step * i + 8 + bar * j;
          if (!(rate > 0)) return null;
          return [box(left, y, x(rate) - left, bar - 1, `fill: ${acceleratorFill(j)}`,
            `${kind}, ${measure.name}: ${formatRate(rate)}`),
            words(x(rate) + 5, y + 10.5, formatCount(rate), { class: "label", "font-size": 11 })];
        })]));
  };
}

/** A line of each accelerator over the number of triangles, both logarithmic; `of` reads the value from a point. */
function growthPlot(names, growth, of, show, label) {
  return (width) => {
    const points = growth.map((point) => ({ ...point, value: of(point) })).filter(({ value }) => value > 0);
    const left = 64, right = width - 110, top = 24, bottom = 230;
    const logs = (values) => [Math.log10(Math.min(...values)), Math.log10(Math.max(...values))];
    const [x0, x1] = logs(points.map(({ triangles }) => triangles)), [y0, y1] = logs(points.map(({ value }) => value));
    const x = (value) => left + (Math.log10(value) - x0) / Math.max(1e-9, x1 - x0) * (right - left);
    const y = (value) => bottom - (Math.log10(value) - y0) / Math.max(1e-9, y1 - y0) * (bottom - top);
    const powers = (from, to) => Array.from({ length: Math.max(0, Math.floor(to + 1e-9) - Math.ceil(from - 1e-9) + 1) },
      (_, i) => 10 ** (Math.ceil(from - 1e-9) + i));
    const lines = names.map((name, i) => ({ name, fill: acceleratorFill(i), list: points.filter((one) => one.name === name) }))
      .filter(({ list }) => list.length > 0);
    const ends = lines.map(({ name, fill, list }) => ({ name, fill, x: x(list.at(-1).triangles), y: y(list.at(-1).value) }))
      .sort((a, b) => a.y - b.y);
    ends.forEach((end, i) => { if (i > 0) end.y = Math.max(end.y, ends[i - 1].y + 14); });
    return canvas(width, bottom + 40, `${label} over triangles, logarithmic; the values are in the table`,
      powers(y0, y1).map((value) => [line(left, y(value), right, y(value), { class: "grid" }),
        words(left - 8, y(value) + 4, show(value), { class: "label", "text-anchor": "end" })]),
      powers(x0, x1).map((value) => [line(x(value), top, x(value), bottom, { class: "grid" }),
        words(x(value), bottom + 16, formatCount(value), { class: "label", "text-anchor": "middle" })]),
      lines.map(({ name, fill, list }) => [drawing("path", { fill: "none", style: `stroke: ${fill}`, "stroke-width": 2,
        d: list.map((p, i) => `${i === 0 ? "M" : "L"}${x(p.triangles)} ${y(p.value)}`).join("") }),
        list.map((p) => titled(drawing("circle", { cx: x(p.triangles), cy: y(p.value), r: 3.5, style: `fill: ${fill}` }),
          `${name}, ${formatCount(p.triangles)} triangles: ${show(p.value)}`))]),
      ends.map((end) => words(end.x + 8, end.y + 4, end.name, { style: `fill: ${end.fill}`, "font-weight": 600 })),
      words(0, 12, label), words((left + right) / 2, bottom + 34, "triangles", { class: "label", "text-anchor": "middle" }));
  };
}

/** Numbers of visits, of which Embree tells none. */
const visits = (value) => (known(value) ? value.toFixed(1) : UNKNOWN);

function showGrowth(part, names, growth) {
  if (growth.length === 0) return;
  const plots = [[(p) => p.rays_per_second, formatRate, "Rays per second"], [(p) => p.build_seconds, formatTime, "Time to build"],
    [(p) => p.bytes, formatBytes, "Memory"], [(p) => p.nodes_per_ray + p.triangles_per_ray, visits, "Nodes and triangles per ray"]];
  part.append(element("h3", {}, "Growth with the number of triangles"),
    element("p", { class: "hint" }, `Of a made-up hilly ground with more and more triangles, which the same rays meet.
      A straight line is a power of the number of triangles; what a tree takes for a ray grows with its logarithm.`),
    element("div", { class: "columns" }, plots.map(([of, show, label]) =>
      (growth.some((point) => of(point) > 0) ? plot(growthPlot(names, growth, of, show, label)) : null))),
    behind("Growth as a table", ["", "triangles", "build", "memory", "rays/s", "nodes/ray", "triangles/ray"],
      growth.map((p) => [p.name, formatCount(p.triangles), formatTime(p.build_seconds), formatBytes(p.bytes),
        formatRate(p.rays_per_second), visits(p.nodes_per_ray), visits(p.triangles_per_ray)])));
}

function showAccelerators() {
  const { measures = [], growth = [] } = report.accelerators ?? {};
  if (measures.length === 0) return;
  const names = measures.map(({ name }) => name), kinds = measures[0].kinds.map(({ kind }) => kind);
  const part = section("accelerators");
  part.append(
    table(["", "triangles", "build", "memory", "nodes or cells", "references", "depth"], measures.map((m) => [m.name,
      formatCount(m.triangles), formatTime(m.build_seconds), formatBytes(m.bytes), m.nodes > 0 ? formatCount(m.nodes) : null,
      m.references > 0 ? formatCount(m.references) : null, m.depth > 0 ? format(m.depth) : null])),
    element("h3", {}, "Rays per second of one thread"),
    kinds.length > 0 ? plot(acceleratorPlot(measures, kinds),
      legend(names.map((name, i) => ({ name, fill: acceleratorFill(i) })))) : null,
    element("p", { class: "hint" }, `All structures trace the same rays of the integrators, one after the other: of each kind
      as many as the slowest can in half a second. Ties are rays that met another triangle than in Embree, as far away but
      for rounding.`),
    table(["", "rays", "traced", "rays/s", "nodes/ray", "triangles/ray", "ties", "differ"], measures.flatMap((m) =>
      m.kinds.map((k) => [m.name, k.kind, formatCount(k.rays), formatRate(k.rays_per_second), visits(k.nodes_per_ray),
        visits(k.triangles_per_ray), format(k.ties), k.differ > 0 ? [format(k.differ), "alarm"] : format(k.differ)]))));
  const shown = measures.filter(({ name }) => images[`visits/${name}`]);
  if (shown.length > 0) {
    part.append(element("h3", {}, "Nodes that a camera ray through each pixel visits"),
      element("div", { class: "columns" }, shown.map((m) => element("figure", { class: "plot" },
        element("span", { class: "heat-frame" }, element("img", { src: images[`visits/${m.name}`],
          alt: `Visited nodes of each pixel, ${m.name}` })),
        element("figcaption", {}, `${m.name} · `, colourScale("0", format(m.picture_high)), " · ",
          element("code", {}, m.picture), " has the values.")))));
  }
  showGrowth(part, names, growth);
}
