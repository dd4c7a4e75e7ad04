"use strict";
// Asks for the state of the run once a second and shows it. All text goes in as text, never as HTML.
const at = (id) => document.getElementById(id);
const svgName = "http://www.w3.org/2000/svg";
let frame = 0, over = false, fields = "";

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

function choices(list) {
  if (list.join() === fields || list.length === 0) return;
  fields = list.join();
  const chosen = at("colour").value;
  at("colour").replaceChildren(...[""].concat(list).map((name) => new Option(name === "" ? "plain blocks" : name, name)));
  at("colour").value = list.includes(chosen) ? chosen : list.includes("displacement.magnitude") ? "displacement.magnitude" : "";
}

function show(status) {
  at("case").textContent = status.case;
  document.title = "cdem: " + status.case;
  at("line").textContent = status.line;
  if (status.ended) at("state").textContent = status.ended.text;
  else if (status.stopping) at("state").textContent = "stopping at the next step";
  else at("state").textContent = status.seconds_left >= 0 ? "running, about " + duration(status.seconds_left) + " left in this stage" : "running";
  at("done").style.width = 100 * (status.ended ? 1 : Math.max(0, status.fraction)) + "%";
  at("stop").hidden = !status.can_stop || Boolean(status.ended);
  at("stop").disabled = status.stopping;
  const log = at("log"), below = log.scrollTop + log.clientHeight >= log.scrollHeight - 4;
  log.textContent = status.log.join("\n");
  if (below) log.scrollTop = log.scrollHeight;
  choices(status.fields);
  if (frame === 0 && status.frame > 0)
    for (const name of ["view", "up", "deformation"]) at(name).value = status.shown[name];
  if (status.frame !== frame) {
    frame = status.frame;
    at("frame").src = "frame.png?" + frame;
    at("frame").hidden = false;
    at("no-frame").hidden = true;
  }
  at("charts").replaceChildren(...status.charts.map(chart).filter((made) => made !== null));
  over = Boolean(status.ended);
}

async function ask() {
  try {
    const answer = await fetch("status", { cache: "no-store" });
    if (!answer.ok) throw new Error(answer.status);
    show(await answer.json());
  } catch (error) {
    if (!over) at("state").textContent = "cdem does not answer any more: the run has ended or was stopped";
    at("stop").hidden = true;
    over = true;
  }
  if (!over) setTimeout(ask, 1000);
}

async function send(what, words) {
  try {
    await fetch(what, { method: "POST", body: new URLSearchParams(words) });
  } catch (error) {
    at("state").textContent = "cdem does not answer any more";
  }
}

at("stop").addEventListener("click", () => { at("stop").disabled = true; send("stop", {}); });
at("show").addEventListener("submit", (event) => event.preventDefault());
at("show").addEventListener("change", () =>
  send("show", { colour: at("colour").value, view: at("view").value, up: at("up").value, deformation: at("deformation").value }));
ask();
