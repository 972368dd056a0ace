// ---- What the program says ----

const state = { status: null, ending: false, ended: false, failures: 0 };
const POLL = 400;  // milliseconds between two questions

async function ask(path, options = {}) {
  const answer = await fetch(path, { cache: "no-store", ...options });
  if (!answer.ok) throw Object.assign(new Error((await answer.text()).trim()), { status: answer.status });
  return answer;
}
const post = (path, body = {}) => ask(path, { method: "POST", body: JSON.stringify(body) });
const tell = (text) => { byId("told").textContent = text; };
const pause = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));

const PHASES = { plan: "planning", load: "loading the scene", resume: "reading what was kept", build: "building", render: "rendering",
  write: "writing files", measure: "measuring", finished: "finished", stopped: "stopped" };
const ENDS = ["finished", "stopped"];

// ---- Images on the stage ----

const canvas = byId("canvas");
const context = canvas.getContext("2d");
const pictures = [{}, {}];  // of each side: bitmap, and the version that it shows
const stage = { zoom: null, x: 0, y: 0, split: 0.5, isExposureChosen: false };  // no zoom: the image fits; x, y: its middle's place in it

/** The full size of the image that is shown, in its own pixels. */
function imageSize() {
  const facts = state.status?.images?.[0];
  return facts ? [facts.full_width ?? facts.width, facts.full_height ?? facts.height] : [16, 9];
}

/** Where the image lies on the stage, in pixels of the page. */
function placed() {
  const [width, height] = imageSize();
  const { clientWidth: w, clientHeight: h } = canvas;
  const fit = Math.min(w / width, h / height);
  const zoom = stage.zoom ?? fit;
  const x = stage.zoom === null ? width / 2 : stage.x;
  const y = stage.zoom === null ? height / 2 : stage.y;
  return { zoom, fit, left: w / 2 - x * zoom, top: h / 2 - y * zoom, width: width * zoom, height: height * zoom };
}

function draw() {
  const density = window.devicePixelRatio || 1;
  const [w, h] = [Math.round(canvas.clientWidth * density), Math.round(canvas.clientHeight * density)];
  if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
  context.setTransform(density, 0, 0, density, 0, 0);
  context.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
  const box = placed();
  const both = Boolean(pictures[1].bitmap);
  const at = stage.split * canvas.clientWidth;
  pictures.forEach(({ bitmap }, side) => {
    if (!bitmap) return;
    context.save();
    context.beginPath();
    if (both) context.rect(side === 0 ? 0 : at, 0, side === 0 ? at : canvas.clientWidth - at, canvas.clientHeight);
    else context.rect(0, 0, canvas.clientWidth, canvas.clientHeight);
    context.clip();
    context.imageSmoothingEnabled = box.width < bitmap.width;
    context.drawImage(bitmap, box.left, box.top, box.width, box.height);
    context.restore();
  });
  const split = byId("split");
  split.hidden = !both;
  split.style.left = `${100 * stage.split}%`;
  split.setAttribute("aria-valuenow", Math.round(100 * stage.split));
  for (const name of ["name-a", "name-b"]) byId(name).hidden = !both;
}

function look() {
  const view = new URLSearchParams({ display: byId("display").value, view: byId("view").value });
  // Until it is moved, the image's own holds, which the slider may have rounded.
  if (stage.isExposureChosen) view.set("exposure", byId("exposure").value);
  if (byId("layer").value) view.set("layer", byId("layer").value);
  return view;
}

/** Loads the newest picture of a side, if there is a newer one or it is to be shown in another way. */
async function load(side) {
  const facts = state.status?.images?.[side];
  const picture = pictures[side];
  if (!facts) {
    if (picture.bitmap) pictures[side] = {};
    return;
  }
  const query = look();
  query.set("side", side);
  const wanted = `${facts.version} ${query}`;
  if (picture.shown === wanted || picture.loading) return;
  picture.loading = true;
  try {
    query.set("version", facts.version);
    const bitmap = await createImageBitmap(await (await ask(`image.png?${query}`)).blob());
    picture.bitmap?.close();
    Object.assign(picture, { bitmap, shown: wanted, count: (picture.count ?? 0) + 1 });
  } finally {
    picture.loading = false;
  }
  draw();
  showPixel();
}

/** Loads what is new. That a picture is not there yet says nothing, and that nobody answers is said elsewhere. */
async function loadAll() {
  try {
    await Promise.all([load(0), load(1)]);
  } catch (error) {
    if (error.status !== 404 && !(error instanceof TypeError)) tell(error.message);
  }
}

// ---- Zoom and the numbers of a pixel ----

function zoomTo(zoom, at = null) {
  const box = placed();
  const [px, py] = at ?? [canvas.clientWidth / 2, canvas.clientHeight / 2];
  const [ix, iy] = [(px - box.left) / box.zoom, (py - box.top) / box.zoom];
  if (zoom === null) {
    stage.zoom = null;
  } else {
    stage.zoom = Math.min(64, Math.max(Math.min(box.fit, 1) / 2, zoom));
    stage.x = ix - (px - canvas.clientWidth / 2) / stage.zoom;
    stage.y = iy - (py - canvas.clientHeight / 2) / stage.zoom;
  }
  draw();
}

const pointer = { at: null, asked: false, again: false };

async function showPixel() {
  if (!pointer.at || !state.status?.images?.[0]) return;
  if (pointer.asked) { pointer.again = true; return; }
  const [px, py] = pointer.at;
  const box = placed();
  const side = pictures[1].bitmap && px > stage.split * canvas.clientWidth ? 1 : 0;
  const facts = state.status.images[side];
  const [u, v] = [(px - box.left) / box.width, (py - box.top) / box.height];
  if (u < 0 || v < 0 || u >= 1 || v >= 1) return;
  pointer.asked = true;
  try {
    const query = new URLSearchParams({ u, v, side, layer: byId("layer").value });
    const pixel = await (await ask(`pixel?${query}`)).json();
    const values = pixel.values.map((value, i) => `${pixel.channels[i] ?? ""} ${value === null ? "–" : value.toPrecision(5)}`);
    byId("pixel").textContent = `x ${pixel.x}  y ${pixel.y}   ${values.join("  ")}   ${byId("layer").value ? "" : facts.space}`;
  } catch {
    byId("pixel").textContent = "\u00a0";
  } finally {
    pointer.asked = false;
    if (pointer.again) { pointer.again = false; showPixel(); }
  }
}

function place(event) {
  const box = canvas.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

/** Moves a zoomed image by pixels of the page. */
function pan(dx, dy) {
  stage.x -= dx / stage.zoom;
  stage.y -= dy / stage.zoom;
  draw();
}

let drag = null;
canvas.addEventListener("pointerdown", (event) => {
  // The middle and right buttons pan, so they do nothing where there is no camera to move.
  if (event.button > (camera.pose ? 2 : 0)) return;
  canvas.setPointerCapture(event.pointerId);
  drag = { at: place(event), pans: event.button !== 0 || event.shiftKey, moves: false };
});
canvas.addEventListener("pointermove", (event) => {
  pointer.at = place(event);
  if (!drag) { showPixel(); return; }
  const [dx, dy] = [pointer.at[0] - drag.at[0], pointer.at[1] - drag.at[1]];
  if (dx === 0 && dy === 0) return;  // a click moves nothing
  drag.at = pointer.at;
  if (camera.pose) moveCamera(drag.pans ? "pan" : "orbit", dx, dy);
  else if (stage.zoom !== null) pan(dx, dy);
});
for (const end of ["pointerup", "pointercancel"])
  canvas.addEventListener(end, () => { if (drag?.moves) restCamera(); drag = null; });
canvas.addEventListener("contextmenu", (event) => event.preventDefault());
canvas.addEventListener("pointerleave", () => { pointer.at = null; byId("pixel").textContent = "\u00a0"; });
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  if (event.deltaY === 0) return;  // sideways
  const steps = -event.deltaY / (event.deltaMode === 0 ? 100 : 3);
  if (camera.pose) moveCamera("dolly", 0, steps);
  else zoomTo(placed().zoom * 1.25 ** steps, place(event));
}, { passive: false });

byId("zoom-in").addEventListener("click", () => zoomTo(placed().zoom * 1.5));
byId("zoom-out").addEventListener("click", () => zoomTo(placed().zoom / 1.5));
byId("zoom-one").addEventListener("click", () => zoomTo(1 / (window.devicePixelRatio || 1)));
byId("zoom-fit").addEventListener("click", () => zoomTo(null));
window.addEventListener("resize", draw);

const split = byId("split");
split.addEventListener("pointerdown", (event) => split.setPointerCapture(event.pointerId));
split.addEventListener("pointermove", (event) => {
  if (!split.hasPointerCapture(event.pointerId)) return;
  stage.split = Math.min(1, Math.max(0, place(event)[0] / canvas.clientWidth));
  draw();
});
split.addEventListener("keydown", (event) => {
  const step = { ArrowLeft: -0.02, ArrowRight: 0.02 }[event.key];
  if (!step) return;
  event.preventDefault();
  event.stopPropagation();
  stage.split = Math.min(1, Math.max(0, stage.split + step));
  draw();
});

document.addEventListener("keydown", (event) => {
  if (event.target.matches("input, select, textarea") || event.ctrlKey || event.metaKey || event.altKey) return;
  const zoom = { "+": () => zoomTo(placed().zoom * 1.5), "=": () => zoomTo(placed().zoom * 1.5),
    "-": () => zoomTo(placed().zoom / 1.5), 0: () => zoomTo(null), 1: () => byId("zoom-one").click() }[event.key];
  if (zoom) { zoom(); return; }
  const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  if (arrow && !camera.pose && stage.zoom !== null) {
    event.preventDefault();
    pan(...times(arrow, -40));
  }
  if (!camera.pose) return;
  if (arrow) {
    event.preventDefault();
    moveCamera(event.shiftKey ? "pan" : "orbit", ...times(arrow, 12));
  } else if (event.key === "w" || event.key === "s") {
    moveCamera("dolly", 0, event.key === "w" ? 1 : -1);
  } else if (event.key === "r") {
    resetCamera();
  }
});

// ---- How the image is shown ----

function options(select, names, chosen) {
  const before = [...select.options].map((option) => option.value).join("\n");
  if (before === names.map(([value]) => value).join("\n")) return;
  const kept = names.some(([value]) => value === select.value) ? select.value : chosen;
  select.replaceChildren(...names.map(([value, text]) => element("option", { value }, text ?? value)));
  select.value = names.some(([value]) => value === kept) ? kept : names[0][0];
}

let displays = null;

/** Offers displays and views once they are known, and what the render itself would write first. */
function offerViews(facts) {
  const label = byId("layer-label");
  label.hidden = facts.layers.length === 0;
  options(byId("layer"), [["", "image"], ...facts.layers.map((name) => [name])], "");
  if (!stage.isExposureChosen) {  // the program chooses it anew for each image
    byId("exposure").value = facts.exposure;
    showExposure();
  }
  if (!displays || byId("display").options.length > 0) return;
  options(byId("display"), displays.map(({ name }) => [name]), facts.display);
  byId("display").value = facts.display;
  offerViewsOfDisplay(facts.view);
}

function offerViewsOfDisplay(chosen) {
  const views = displays.find(({ name }) => name === byId("display").value)?.views ?? [];
  byId("view").replaceChildren(...views.map((name) => element("option", { value: name }, name)));
  byId("view").value = views.includes(chosen) ? chosen : views[0];
}

function showExposure() {
  const stops = Number(byId("exposure").value);
  byId("exposure-text").textContent = `${stops > 0 ? "+" : ""}${format(stops)}`;
}

byId("display").addEventListener("change", () => { offerViewsOfDisplay(byId("view").value); loadAll(); });
for (const id of ["view", "layer"]) byId(id).addEventListener("change", loadAll);
byId("exposure").addEventListener("input", () => { stage.isExposureChosen = true; showExposure(); loadAll(); });

// ---- What is said of the render ----

function figure(name, value, more = null) {
  return element("div", {}, element("dt", {}, name), element("dd", {}, value), more === null ? null : element("dd", {}, more));
}

function showRender(status) {
  const facts = status.images[0];
  const spp = facts ? `${format(facts.spp)}${status.spp_requested ? ` of ${format(status.spp_requested)}` : ""}` : UNKNOWN;
  const left = status.phase === "render" && status.fraction > 0
    ? status.seconds * (1 - status.fraction) / status.fraction : null;
  byId("bar").value = ENDS.includes(status.phase) && status.phase === "finished" ? 1 : status.fraction;
  byId("keys").textContent = "The wheel zooms, dragging moves the zoomed image. Keys: +, −, 1 and 0 for the zoom; " +
    "arrows to move what is zoomed.";
  byId("figures").replaceChildren(
    figure("samples per pixel", spp, facts ? `${facts.width} × ${facts.height} pixels` : null),
    figure("relative error", status.error === null ? UNKNOWN : format(status.error),
      status.error === null ? "known with --error" : "estimated"),
    figure("time", formatSeconds(status.seconds), left === null ? null : `${formatSeconds(left)} left at most`),
    figure("rays", formatRate(status.seconds > 0 ? status.rays / status.seconds : null),
      `${formatCount(status.rays)} in all`),
    figure("integrator", facts?.integrator ?? UNKNOWN),
    ...(status.output ? [figure("file", status.output)] : []));
}

const percent = (fraction) => `${Math.floor(100 * fraction)}%`;

function showState(status) {
  const phase = PHASES[status.phase] ?? status.phase;
  const share = status.phase === "render" && known(status.fraction) ? percent(status.fraction) : null;
  byId("state").textContent = share ? `${phase}, ${share}` : phase;
  byId("state").classList.remove("alarm");
  byId("title").textContent = status.title;
  document.title = `${share ? `${share} ` : ""}${status.title}: Etendue`;
}

/** Lets what the program has to answer be asked for, or not. */
function allowLooks(isAllowed) {
  for (const id of ["layer", "display", "view", "exposure"]) byId(id).disabled = !isAllowed;
  for (const side of byId("sides").children) side.disabled = !isAllowed;
}

function show(status) {
  state.status = status;
  for (const id of ["stop", "preview"]) byId(id).disabled = ENDS.includes(status.phase);
  allowLooks(true);
  showState(status);
  if (status.kind === "render") {
    byId("preview").hidden = !status.output;
    showRender(status);
  } else if (status.kind === "explore") {
    showExplorer(status);
  } else {
    showBatch(status);
  }
  if (status.images[0]) offerViews(status.images[0]);
}

/** Says that the program does not answer: it has ended, if it had come to an end before or was asked to. */
function showNoAnswer() {
  const phase = state.status?.phase;
  const isFinished = ENDS.includes(phase);
  state.ended = isFinished || state.ending;
  for (const id of ["stop", "preview"]) byId(id).disabled = true;
  allowLooks(false);
  byId("state").textContent = isFinished ? `${PHASES[phase]}; the program has ended` : state.ended ? "ended"
    : "no answer: the program has ended, or cannot be reached";
  byId("state").classList.toggle("alarm", !state.ended);
}

byId("stop").addEventListener("click", async () => {
  try {
    await post("stop");
    state.ending = state.status?.kind === "explore";  // which tells of no phase at its end
    tell(state.ending ? "" : "Stopping: what there is is being written.");
  } catch (error) { tell(error.message); }
});
byId("preview").addEventListener("click", async () => {
  try {
    await post("preview");
    tell(`The preview is written beside ${state.status?.output ?? "the image"}.`);
  } catch (error) { tell(error.message); }
});

// ---- A camera to move, and integrators to choose ----

const camera = { pose: null, first: null, sent: false, again: null, timer: null, changes: 0 };
const add = (a, b, factor = 1) => a.map((value, i) => value + factor * b[i]);
const minus = (a, b) => add(a, b, -1);
const times = (a, factor) => a.map((value) => value * factor);
const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => times(a, 1 / Math.hypot(...a));

/** `v` turned by an angle around a unit axis (Rodrigues). */
function turned(v, axis, angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return add(add(times(v, c), cross(axis, v), s), axis, dot(axis, v) * (1 - c));
}

function moveCamera(way, dx, dy) {
  let { eye, target } = camera.pose;
  const up = unit(camera.pose.up);
  let arm = minus(eye, target);
  const right = unit(cross(up, arm));
  const upwards = unit(cross(arm, right));
  if (way === "orbit") {
    arm = turned(arm, up, -dx * 0.008);
    const side = unit(cross(up, arm));
    const height = Math.asin(Math.min(1, Math.max(-1, dot(unit(arm), up))));
    const turn = Math.min(1.53, Math.max(-1.53, height + dy * 0.008)) - height;
    arm = turned(arm, side, -turn);
    eye = add(target, arm);
  } else if (way === "pan") {
    const step = 1.2 * Math.hypot(...arm) / canvas.clientHeight;
    const shift = add(times(right, -dx * step), upwards, dy * step);
    [eye, target] = [add(eye, shift), add(target, shift)];
  } else {
    eye = add(target, times(arm, 0.9 ** dy));
  }
  camera.pose = { eye, target, up };
  sendCamera(true);
  clearTimeout(camera.timer);
  if (drag) drag.moves = true;
  else camera.timer = setTimeout(restCamera, 200);
}

const restCamera = () => sendCamera(false);

function resetCamera() {
  camera.pose = structuredClone(camera.first);
  sendCamera(false);
}

/** Sends the newest pose only: what the program cannot keep up with is left out. */
async function sendCamera(moves) {
  camera.again = { place: [...camera.pose.eye, ...camera.pose.target, ...camera.pose.up], moves };
  camera.changes += 1;
  if (camera.sent) return;
  camera.sent = true;
  try {
    while (camera.again) {
      const next = camera.again;
      camera.again = null;
      await post("camera", next);
    }
  } catch (error) {
    tell(error.message);
  } finally {
    camera.sent = false;
    camera.changes += 1;
  }
}

const poseOf = (place) => ({ eye: place.slice(0, 3), target: place.slice(3, 6), up: place.slice(6, 9) });

/** Takes over where the camera stands, which another page may have moved, unless it has been moved here since `asked`. */
function followCamera(status, asked) {
  camera.first ??= poseOf(status.own_camera);
  if (!drag && !camera.sent && camera.changes === asked) camera.pose = poseOf(status.camera);
}

const sides = [null, null];

function makeSide(index, side, integrators) {
  const choice = element("select", { id: `integrator-${index}` }, integrators.map((name) => element("option", { value: name }, name)));
  const depth = element("input", { type: "number", id: `depth-${index}`, min: "1", max: "1000", step: "1" });
  const more = element("input", { type: "text", id: `more-${index}`, spellcheck: "false", autocomplete: "off",
    placeholder: "--clamp-indirect 10" });
  const fault = element("p", { class: "alarm", role: "alert" });
  const figures = element("p", { class: "muted" });
  const isOn = index === 1 ? element("input", { type: "checkbox", id: "compare" }) : null;
  let accepted = { integrator: side.integrator, depth: String(side.depth), more: side.more };
  const body = element("div", {}, element("div", { class: "controls" },
    element("label", {}, "Integrator ", choice), element("label", {}, "Longest paths ", depth),
    element("label", { class: "wide" }, "Other options ", more)), fault, figures);
  const send = async () => {
    fault.textContent = "";
    const shown = isOn ? isOn.checked : true;
    body.hidden = !shown;
    // What was refused must not keep the image from being taken away.
    const wanted = shown ? { integrator: choice.value, depth: depth.value, more: more.value } : accepted;
    try {
      await post("side", { index, shown, ...wanted });
      accepted = wanted;
    } catch (error) { fault.textContent = error.message; }
  };
  for (const input of [choice, depth, more, ...(isOn ? [isOn] : [])]) input.addEventListener("change", send);
  choice.value = side.integrator;
  depth.value = side.depth;
  more.value = side.more;
  body.hidden = isOn !== null && !side.shown;
  if (isOn) isOn.checked = side.shown;
  const legend = isOn ? element("legend", {}, element("label", {}, isOn, " Compare with, at equal time"))
    : element("legend", {}, "Image");
  byId("sides").append(element("fieldset", {}, legend, body));
  sides[index] = { figures };
}

function showExplorer(status) {
  byId("bar").hidden = true;
  byId("sides").hidden = false;
  byId("commands").hidden = false;
  byId("stop").textContent = "End";
  canvas.classList.add("orbits");
  byId("keys").textContent = "Drag to orbit, Shift-drag or the right button to pan, wheel to come nearer. " +
    "Keys: arrows, Shift and arrows, w and s; r for the scene's own camera; +, −, 1 and 0 for the zoom.";
  status.sides.forEach((side, index) => { if (!sides[index]) makeSide(index, side, status.integrators); });
  status.sides.forEach((side, index) => {
    const facts = status.images[index];
    sides[index].figures.textContent = facts
      ? `${format(facts.spp)} samples per pixel in ${formatSeconds(side.seconds)} of processor time, ` +
        `${formatCount(side.seconds > 0 ? side.rays / side.seconds : null)} rays in each second of it` : "";
    byId(index === 0 ? "name-a" : "name-b").textContent = facts ? `${side.integrator}, ${format(facts.spp)} spp` : "";
  });
  const commands = status.sides.filter(({ shown }) => shown).map((side) => side.command);
  if (commands.join("\n") !== state.commands) {
    state.commands = commands.join("\n");
    byId("command-list").replaceChildren(...commands.map(command));
  }
  byId("figures").replaceChildren();
}

// ---- A batch ----

const MARKS = { rendered: "✓", "up to date": "=", failed: "✕", interrupted: "‖", running: "▸", "running elsewhere": "▸",
  "not started": "·", "not chosen": "·" };

/** A card for each image, in the order of the plan; pictures are loaded when they come into view. */
function unitCard(unit, index) {
  const hasPicture = unit.preview && ["rendered", "up to date", "interrupted"].includes(unit.outcome);
  const version = `${unit.outcome} ${unit.seconds?.total ?? ""}`;
  const picture = hasPicture
    ? element("img", { src: `picture.png?${new URLSearchParams({ unit: index, version })}`, loading: "lazy", alt: "" })
    : unit.outcome;
  const progress = unit.outcome === "running" && known(unit.fraction)
    ? ` ${percent(unit.fraction)}${known(unit.seconds_left) ? `, ${formatSeconds(unit.seconds_left)} left` : ""}` : "";
  const more = unit.outcome === "failed" ? unit.error
    : unit.seconds ? `${formatSeconds(unit.seconds.total)}, ${format(unit.spp)} spp, ${unit.integrator ?? ""}` : "";
  return element("article", { class: "unit-card" }, element("div", { class: "shot" }, picture),
    element("div", {}, `${MARKS[unit.outcome] ?? ""} `, named(unit.name)),
    element("div", { class: unit.outcome === "failed" ? "alarm" : "muted" }, `${unit.outcome}${progress}${more ? `: ${more}` : ""}`));
}

function showBatch(status) {
  byId("stage").hidden = true;
  byId("pixel").hidden = true;
  for (const control of byId("view-controls").children) control.hidden = control.id !== "actions";
  const report = status.report;
  if (!report) return;
  const totals = report.totals;
  const done = totals.rendered + totals.up_to_date + totals.failed + totals.interrupted;
  const chosen = totals.units - totals.not_chosen;
  byId("bar").value = chosen > 0 ? done / chosen : 0;
  byId("figures").replaceChildren(
    figure("images", `${format(done)} of ${format(chosen)}`, `${format(totals.up_to_date)} were up to date`),
    figure("failed", format(totals.failed)),
    figure("time", formatSeconds(report.seconds), known(report.seconds_left) ? `about ${formatSeconds(report.seconds_left)} left` : null),
    figure("rays", formatCount(totals.rays)),
    figure("directory", report.output_directory));
  const units = byId("units");
  units.hidden = false;
  report.units.forEach((unit, index) => {
    const text = JSON.stringify([unit.outcome, unit.fraction, unit.seconds_left, unit.error, unit.seconds, unit.name]);
    const old = units.children[index];
    if (old?.told === text) return;
    const card = unitCard(unit, index);
    card.told = text;
    if (old) old.replaceWith(card); else units.append(card);
  });
  while (units.children.length > report.units.length) units.lastChild.remove();
}

// ---- All together ----

/** Asks how the program is. Of a camera that moves it answers when there is another image; of a batch, in full when
 * something has changed. */
async function askStatus() {
  const newest = state.status?.serial ?? state.status?.version;
  const asked = camera.changes;
  const status = await (await ask(newest === undefined ? "status" : `status?after=${newest}`)).json();
  if (status.camera) followCamera(status, asked);
  if (!status.is_same) show(status);
  else if (state.failures > 0) show(state.status);
}

async function follow() {
  try { displays = await (await ask("displays")).json(); } catch { displays = []; }
  while (!state.ended) {
    try {
      await askStatus();
      state.failures = 0;
      await loadAll();
      if (state.status.kind !== "explore") await pause(POLL);
    } catch (error) {
      if (error.status === 404) continue;
      // A tunnel may be down for a while: it is asked again, less and less often.
      state.failures += 1;
      if (state.failures > 2 || state.ending) showNoAnswer();
      await pause(Math.min(200 * state.failures, 5000));
    }
  }
}

draw();
follow();
