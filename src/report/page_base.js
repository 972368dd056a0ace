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

function saveReport() {
  const url = URL.createObjectURL(new Blob([byId("report").textContent], { type: "application/json" }));
  element("a", { href: url, download: "report.json" }).click();
  URL.revokeObjectURL(url);
}
