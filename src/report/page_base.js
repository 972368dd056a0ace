const byId = (id) => document.getElementById(id);
const known = (value) => typeof value === "number" && Number.isFinite(value);

// ---- Elements ----

/** An element; children are nodes or text, and null is left out. Data reach the page only as text and attributes. */
function element(tag, attributes = {}, ...children) {
  return filled(document.createElement(tag), attributes, children);
}

function drawing(tag, attributes = {}, ...children) {
  return filled(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
}

function filled(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") node.addEventListener(name, value);
    else if (value !== null) node.setAttribute(name, value);
  }
  node.append(...children.flat(Infinity).filter((child) => child !== null));
  return node;
}

const named = (name) => element("bdi", { class: "name" }, name);

/** The section `id`, shown. */
function section(id) {
  byId(id).hidden = false;
  return byId(id);
}

/** A table; `rows` are arrays of cells, each null, text, a node or [text, class]; the first heads its row. */
function table(heads, rows) {
  const cell = (content, column) => {
    const [value, style] = Array.isArray(content) && content.length === 2 && typeof content[1] === "string"
      ? content : [content, null];
    const attributes = { class: style || null, scope: column === 0 ? "row" : null };
    return element(column === 0 ? "th" : "td", attributes, value ?? UNKNOWN);
  };
  return element("div", { class: "scroll", tabindex: "0", role: "group", "aria-label": "Table" },
    element("table", {},
      element("thead", {}, element("tr", {}, heads.map((head) => element("th", { scope: "col" }, head)))),
      element("tbody", {}, rows.map((row) => element("tr", {}, row.map(cell))))));
}

function facts(rows) {
  const shown = rows.filter(([, value]) => value !== null && value !== undefined && value !== "");
  return element("dl", { class: "facts" },
    shown.map(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
}

// ---- Numbers: three significant digits ----

const UNKNOWN = "–";
const grouped = (text) => text.replace("-", "−").replace(/\B(?=(\d{3})+(?!\d|\.))(?<!\.\d*)/g, "\u202f");
const raised = (exponent) => String(exponent).replace(/./g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]));
const exponentOf = (value) => (value === 0 ? 0 : Number(value.toExponential(2).split("e")[1]));
const isPlain = (exponent) => exponent >= -3 && exponent < 6;

function format(value) {
  if (!known(value)) return UNKNOWN;
  if (Number.isInteger(value) && Math.abs(value) < 1e6) return grouped(String(value));
  const exponent = exponentOf(value);
  if (isPlain(exponent)) return grouped(value.toFixed(Math.max(0, 2 - exponent)));
  return `${grouped((value / 10 ** exponent).toFixed(2))}\u202f×\u202f10${raised(exponent)}`;
}

/** Without the zeros at the end that make columns line up. */
function brief(value) {
  return known(value) && isPlain(exponentOf(value)) ? grouped(String(Number(value.toPrecision(3)))) : format(value);
}

function formatCount(value) {
  if (!known(value) || Math.abs(value) < 1e4) return format(value);
  const prefixes = [[1e12, "T"], [1e9, "G"], [1e6, "M"], [1e3, "k"]];
  const [unit, prefix] = prefixes.find(([size]) => Math.abs(value) >= 0.9995 * size);
  return `${format(value / unit)}\u202f${prefix}`;
}

function formatSeconds(value) {
  if (!known(value)) return UNKNOWN;
  const units = [[86400, "days"], [3600, "h"], [60, "min"]];
  const [unit, name] = units.find(([size]) => value >= 2 * size) ?? [1, "s"];
  return `${format(value / unit)}\u202f${name}`;
}

function formatBytes(value) {
  if (!known(value)) return UNKNOWN;
  const [size, name] = [[2 ** 40, "TiB"], [2 ** 30, "GiB"], [2 ** 20, "MiB"]].find(([unit]) => value >= unit) ??
    [2 ** 10, "KiB"];
  const amount = value / size;
  return `${amount.toFixed(amount < 10 ? 2 : amount < 100 ? 1 : 0)}\u202f${name}`;
}

const formatRate = (value) => (known(value) ? `${formatCount(value)}/s` : UNKNOWN);
const formatDate = (text) => (text ?? "").replace("T", " ").replace(/(\.\d+)?Z$/, " UTC");
const counted = (count, noun) => `${format(count)} ${count === 1 ? noun : `${noun}s`}`;

// ---- Drawings ----

const line = (x1, y1, x2, y2, attributes) => drawing("line", { x1, y1, x2, y2, ...attributes });
const words = (x, y, text, attributes = {}) => drawing("text", { x, y, ...attributes }, text);

function shortened(text, length) {
  const letters = [...text];
  return letters.length > length ? `${letters.slice(0, length - 1).join("")}…` : text;
}

const MAGMA = ["#000004", "#140e36", "#3b0f70", "#641a80", "#8c2981", "#b73779", "#de4968", "#f7705c", "#fe9f6d",
  "#fecf92", "#fcfdbf"];

/** A bar of colours between two texts. */
function colourScale(low, high, colours = MAGMA) {
  const style = `background: linear-gradient(to right, ${colours.join(",")})`;
  return element("span", { class: "scale" }, low,
    element("span", { class: "bar", role: "img", "aria-label": "colour scale", style }), high);
}

// ---- Commands and files ----

async function copy(code, button) {
  window.getSelection().selectAllChildren(code);
  try {
    await navigator.clipboard.writeText(code.textContent);
    button.textContent = "Copied";
  } catch {
    button.textContent = "Selected";  // some browsers lend local files no clipboard
  }
}

function command(text) {
  const code = element("code", {}, text);
  const button = element("button", { click: () => copy(code, button) }, "Copy");
  return element("div", { class: "command" }, code, button);
}

function saveReport(name) {
  const url = URL.createObjectURL(new Blob([byId("report").textContent], { type: "application/json" }));
  element("a", { href: url, download: name }).click();
  URL.revokeObjectURL(url);
}

const saveButton = (name) => element("p", {},
  element("button", { id: "save", click: () => saveReport(name) }, `Save the figures as ${name}`));
