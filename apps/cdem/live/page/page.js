"use strict";
// Asks for the state of the run or of the files, which answers when there is a new frame or after a second, and shows it.
// All text goes in as text, never as HTML.
const at = (id) => document.getElementById(id);
const svgName = "http://www.w3.org/2000/svg";
let frame = 0, over = false, fields = "", shown = {}, files = [];
// wish: words of the next request; sent: those of the last one; drawing: its frame has not come; played: the last step that
// was played, -1: none.
let wish = {}, sent = {}, drawing = false, playing = false, played = -1;

function duration(seconds) {
  if (seconds < 60) return Math.ceil(seconds) + " s";
  if (seconds < 3600) return Math.ceil(seconds / 60) + " min";
  return (seconds / 3600).toFixed(1) + " h";
}

function short(x) {
  const size = Math.abs(x);
  return size !== 0 && (size < 1e-3 || size >= 1e5) ? x.toExponential(1) : String(+x.toPrecision(3));
}

function element(name, attributes, parent, text) {
  const made = document.createElementNS(svgName, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  parent.append(made);
  return made;
}

// One line over seconds of computing.
function chart(given) {
  const width = 560, height = 220, left = 64, right = 12, top = 10, bottom = 42;
  const points = [];
  for (let i = 0; i < given.x.length; ++i) {
    const y = given.log ? Math.log10(given.y[i]) : given.y[i];
    if (given.y[i] !== null && Number.isFinite(y)) points.push([given.x[i], y]);
  }
  if (points.length < 2) return null;
  const section = document.createElement("div");
  section.className = "chart";
  const heading = document.createElement("h2");
  heading.textContent = given.name;
  section.append(heading);
  const svg = document.createElementNS(svgName, "svg");
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", given.name);
  section.append(svg);
  const xs = points.map((p) => p[0]), ys = points.map((p) => p[1]);
  const x0 = Math.min(...xs), x1 = Math.max(...xs, x0 + 1e-9);
  let y0 = Math.min(...ys), y1 = Math.max(...ys);
  if (!given.log) y0 = Math.min(0, y0);
  if (y1 - y0 < 1e-12) y1 = y0 + 1;
  const px = (x) => left + (width - left - right) * (x - x0) / (x1 - x0);
  const py = (y) => height - bottom - (height - top - bottom) * (y - y0) / (y1 - y0);
  element("path", { class: "axis", d: `M${left},${top}V${height - bottom}H${width - right}` }, svg);
  for (const t of [0, 0.5, 1]) {
    const y = y0 + t * (y1 - y0), x = x0 + t * (x1 - x0);
    element("text", { x: left - 6, y: py(y) + 4, "text-anchor": "end" }, svg, short(given.log ? 10 ** y : y));
    element("text", { x: px(x), y: height - bottom + 16, "text-anchor": t === 0 ? "start" : t === 1 ? "end" : "middle" },
            svg, short(x));
  }
  element("text", { x: (left + width - right) / 2, y: height - 6, "text-anchor": "middle" }, svg, given.x_label);
  element("path", { class: "line", d: "M" + points.map((p) => px(p[0]).toFixed(1) + "," + py(p[1]).toFixed(1)).join("L") }, svg);
  return section;
}

function options(select, names, values) {
  select.replaceChildren(...names.map((name, i) => new Option(name, values[i])));
}

function choices(status) {
  if (status.fields.length > 0 && status.fields.join() !== fields) {
    fields = status.fields.join();
    options(at("colour"), ["plain blocks", ...status.fields], ["", ...status.fields]);
  }
  if (files.length === 0 && status.files.length > 0) {
    files = status.files;
    options(at("file"), files.map((f) => f.name), files.map((f, i) => i));
    at("file-label").hidden = files.length < 2;
  }
}

// What is drawn goes into the form, but for a field that somebody is typing into.
function show_drawn(drawn) {
  shown = drawn;
  const range = drawn.range || ["", ""];
  const values = { ...drawn, low: range[0], high: range[1] };
  for (const name of ["file", "colour", "view", "up", "deformation", "low", "high"])
    if (at(name) !== document.activeElement || at(name).tagName === "SELECT") at(name).value = values[name];
  const steps = files.length > 0 ? files[drawn.file].steps : 1;
  at("series").hidden = steps < 2;
  at("step").max = steps - 1;
  if (!("step" in wish)) at("step").value = drawn.step;
  at("step-text").value = (drawn.step + 1) + " of " + steps;
}

function show(status) {
  at("case").textContent = status.case;
  document.title = "cdem: " + status.case;
  at("line").textContent = status.line;
  if (status.ended) at("state").textContent = status.ended.text;
  else if (status.stopping) at("state").textContent = "stopping";
  else if (status.files.length > 0) at("state").textContent = "";
  else at("state").textContent = status.seconds_left >= 0 ? "running, about " + duration(status.seconds_left) + " left in this stage" : "running";
  at("done").style.width = 100 * (status.ended ? 1 : Math.max(0, status.fraction)) + "%";
  at("stop").textContent = status.stop;
  at("stop").hidden = Boolean(status.ended);
  at("stop").disabled = status.stopping;
  at("bar").hidden = status.files.length > 0;
  const log = at("log"), below = log.scrollTop + log.clientHeight >= log.scrollHeight - 4;
  log.textContent = status.log.join("\n");
  if (below) log.scrollTop = log.scrollHeight;
  at("log-section").hidden = status.log.length === 0;
  choices(status);
  if (status.frame !== frame) {
    frame = status.frame;
    show_drawn(status.shown);
    at("frame").src = "frame.png?" + frame;
    at("frame").hidden = false;
    at("no-frame").hidden = true;
  }
  at("charts").replaceChildren(...status.charts.map(chart).filter((made) => made !== null));
  at("charts").hidden = at("charts").children.length === 0;
  over = Boolean(status.ended);
}

async function ask() {
  try {
    const answer = await fetch("status?seen=" + frame, { cache: "no-store" });
    if (!answer.ok) throw new Error(answer.status);
    show(await answer.json());
  } catch (error) {
    if (!over) at("state").textContent = "cdem does not answer any more: it has ended or was stopped";
    at("stop").hidden = true;
    over = true;
  }
  if (!over) ask();
}

async function send(what, words) {
  try {
    await fetch(what, { method: "POST", body: new URLSearchParams(words) });
  } catch (error) {
    at("state").textContent = "cdem does not answer any more";
  }
}

// One request at a time: the next goes when the frame of the last has come, with all that was wished in between.
async function request() {
  if (drawing || Object.keys(wish).length === 0 || over) return;
  sent = wish;
  wish = {};
  drawing = true;
  try {
    const answer = await fetch("show", { method: "POST", body: new URLSearchParams(sent) });
    if (answer.ok) return; // the frame answers
    at("line").textContent = "cannot be drawn: " + Object.entries(sent).map(([k, v]) => k + " " + v).join(", ");
  } catch (error) {
    at("state").textContent = "cdem does not answer any more";
  }
  drawing = false;
  sent = {};
  play(false);
}

function ask_for(words) {
  Object.assign(wish, words);
  request();
}

// A turn of the camera adds to what is asked for already.
const value_of = (name) => name in wish ? wish[name] : name in sent ? sent[name] :
  name === "right" ? shown.shift[0] : name === "upwards" ? shown.shift[1] : shown[name];
const turn_by = (turn, tilt) => ask_for({ turn: value_of("turn") + turn, tilt: value_of("tilt") + tilt });
const zoom_by = (factor) => ask_for({ zoom: Math.min(100, Math.max(0.05, value_of("zoom") * factor)) });
const straight = { turn: 0, tilt: 0, zoom: 1, right: 0, upwards: 0 };

function next_step() {
  const last = files.length > 0 ? files[shown.file].steps - 1 : 0;
  if (shown.step >= last || shown.step === played) play(false); // the end, or a step that cannot be drawn
  if (!playing) return;
  played = shown.step;
  ask_for({ step: shown.step + 1 });
}

function play(on) {
  playing = on;
  played = -1;
  at("play").textContent = on ? "⏸" : "▶";
}

at("frame").addEventListener("load", () => {
  drawing = false;
  sent = {};
  request();
  if (playing && !drawing) next_step();
});
at("stop").addEventListener("click", () => { at("stop").disabled = true; send("stop", {}); });
at("show").addEventListener("submit", (event) => event.preventDefault());
at("show").addEventListener("change", (event) => {
  const name = event.target.id, value = event.target.value;
  if (name === "low" || name === "high") {
    const both = (at("low").value === "") === (at("high").value === "");
    if (both) ask_for({ low: at("low").value, high: at("high").value });
  } else if (name === "view" || name === "up") ask_for({ [name]: value, ...straight });
  else if (name === "file") { play(false); ask_for({ file: value, step: 0 }); }
  else ask_for({ [name]: value });
});
at("show").addEventListener("click", (event) => {
  const { turn, tilt, zoom } = event.target.dataset;
  if (turn) turn_by(Number(turn), 0);
  if (tilt) turn_by(0, Number(tilt));
  if (zoom) zoom_by(Number(zoom));
  if (event.target.id === "reset") ask_for(straight);
});
at("step").addEventListener("input", () => { play(false); ask_for({ step: at("step").value }); });
at("play").addEventListener("click", () => {
  play(!playing);
  if (playing && shown.step >= files[shown.file].steps - 1) ask_for({ step: 0 });
  else next_step();
});
at("frame").addEventListener("pointermove", (event) => {
  if (event.buttons !== 1) return;
  const height = at("frame").clientHeight;
  if (event.shiftKey)
    ask_for({ right: value_of("right") + event.movementX / height, upwards: value_of("upwards") - event.movementY / height });
  else turn_by(-event.movementX * 0.4, event.movementY * 0.4);
});
at("frame").addEventListener("pointerdown", (event) => at("frame").setPointerCapture(event.pointerId));
at("frame").addEventListener("wheel", (event) => {
  event.preventDefault();
  zoom_by(event.deltaY < 0 ? 1.1 : 1 / 1.1);
}, { passive: false });
ask();
