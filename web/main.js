// main.js — puts the page together.

import { Compare } from "./compare.js";
import { Connection } from "./connection.js";
import { Errors } from "./errors.js";
import { Files } from "./files.js";
import { Input } from "./input.js";
import { Keys, fillMouseHelp, keyName } from "./keys.js";
import { Messages } from "./messages.js";
import { Move, drawBox } from "./move.js";
import { Objects } from "./objects.js";
import { Panels } from "./panels.js";
import { Picture, pictureSize } from "./picture.js";
import { Session } from "./session.js";
import { Stats } from "./stats.js";
import { View } from "./view.js";

const RESIZE_MS = 200;
const HINT_MS = 20000;
const KEY_ANGLE = Math.PI / 36;
const FIRST_PICTURE = "The first picture is being made";

const byId = (id) => document.getElementById(id);
const stage = byId("stage");
const canvas = byId("picture");

const settings = { preset: remembered("mouse", "f3d"), detail: remembered("detail", "auto"), moving: false };
const messages = new Messages(byId("messages"));
const token = new URLSearchParams(location.search).get("t") ?? "";
const connection = new Connection(token, () => ({ size: wantedSize() }));
const session = new Session(connection);
const wantedAspect = () => {
  const [width, height] = wantedSize();
  return width / height;
};
const picture = new Picture(canvas, (frame) => connection.acknowledge(frame), wantedAspect);
const stats = new Stats();
const view = new View(session);
const panels = new Panels(session);
const compare = new Compare(session, picture);
const objects = new Objects(session, (object) => view.lookAt(object, picture.aspect));
const move = new Move({ session, objects, view, picture, messages, connection });
const files = new Files({ session, connection, messages });
new Errors({ connection, session, messages, refused: (seq) => session.setRefused(seq) });

function remembered(name, otherwise) {
  try {
    return localStorage.getItem(`arris.${name}`) ?? otherwise;
  } catch {
    // Browsers may forbid it.
    return otherwise;
  }
}

function remember(name, value) {
  try {
    localStorage.setItem(`arris.${name}`, value);
  } catch {
    return;
  }
}

// The picture and its size

function wantedSize() {
  const { width, height } = stage.getBoundingClientRect();
  const detail = settings.detail === "auto" ? "auto" : Number(settings.detail);
  return pictureSize(Math.max(width, 1), Math.max(height, 1), window.devicePixelRatio || 1, detail);
}

let resizeTimer = null;
let askedSize = "";
function resize() {
  clearTimeout(resizeTimer);
  resizeTimer = setTimeout(() => {
    const size = wantedSize();
    if (String(size) === askedSize || !connection.isOpen) return;
    askedSize = String(size);
    session.send("size", { size });
  }, RESIZE_MS);
  compare.update();
  drawMarks();
}
new ResizeObserver(resize).observe(stage);

function drawMarks() {
  const { chosen } = objects;
  drawBox(byId("marks"), picture, view.shown, chosen?.visible ? chosen : null);
}

picture.addEventListener("drawn", ({ detail: header }) => {
  view.setShownSeq(header.seq);
  stats.setFrame(header, connection.takeLatency(header.seq));
  files.setFrame(header);
  Object.assign(canvas.dataset, { frame: header.frame, seq: header.seq, converged: header.converged });
});
view.addEventListener("camera", drawMarks);
objects.addEventListener("chosen", drawMarks);
session.addEventListener("scene", drawMarks);

// The connection

const STATUS = {
  connecting: "connecting",
  open: "connected",
  lost: "no connection",
  refused: "refused",
  busy: "no room",
};
let trouble = { state: null, message: null };

connection.addEventListener("status", ({ detail: { state, reason } }) => {
  const status = byId("status");
  status.className = state;
  if (state !== "connecting") stage.classList.toggle("stale", state !== "open");
  if (status.textContent !== STATUS[state]) status.textContent = STATUS[state];
  if (state === "connecting") return;
  if (state !== trouble.state) trouble.message?.remove();
  trouble = { state, message: state === "open" ? null : tellTrouble(state, reason) };
  showBusy(null);
  if (state === "open") {
    if (!canvas.dataset.frame) showBusy(FIRST_PICTURE);
    askedSize = String(wantedSize());
    picture.restart();
  }
});

function showBusy(what) {
  byId("busy").hidden = !what;
  byId("busy-text").textContent = what ?? "";
}

function tellTrouble(state, reason) {
  const retry = { label: "Try now", run: () => connection.connect() };
  if (state === "refused") {
    const remedy = "Its token is not, or no longer, valid. Open the address that arris view has printed last.";
    return messages.lasting("error", "The server refuses this address", remedy, retry);
  }
  if (state === "busy") {
    const [text, remedy = ""] = reason.split("; ");
    return messages.lasting("error", `No room: ${text}`, `${remedy}. The page tries again by itself.`, retry);
  }
  const remedy = "Is arris view still running? The page tries again by itself.";
  return messages.lasting("error", "The server does not answer", remedy, retry);
}

connection.addEventListener("frame", ({ detail }) => picture.show(detail));
connection.addEventListener("state", ({ detail }) => stats.setState(detail));
connection.addEventListener("camera", ({ detail }) => view.follow(detail));
connection.addEventListener("busy", ({ detail }) => showBusy(detail.what));
picture.addEventListener("drawn", () => byId("busy-text").textContent === FIRST_PICTURE && showBusy(null));
session.addEventListener("scene", ({ detail }) => {
  if (!detail?.fromServer) return;
  const { name } = session.scene;
  byId("model-name").textContent = name;
  byId("model-name").title = name;
  document.title = `${name} – Arris`;
});
session.addEventListener("scene", () => (byId("legend").hidden = !session.scene?.overlay));

// Mouse, fingers and keys

function setMoving(on) {
  settings.moving = on;
  byId("move-mode").setAttribute("aria-pressed", String(on));
  canvas.classList.toggle("moving", on);
}

function setPreset(preset) {
  settings.preset = preset;
  byId("mouse").value = preset;
  remember("mouse", preset);
  fillMouseHelp(byId("help-mouse").tBodies[0], preset);
}

// What the picture answers to, until something has been tried

function showHint() {
  if (remembered("hinted", "")) return;
  const isTouched = window.matchMedia("(pointer: coarse)").matches;
  const turn = settings.preset === "blender" ? "Drag with the middle button to turn" : "Drag to turn";
  byId("hint").textContent = isTouched
    ? "One finger turns, two zoom and shift"
    : `${turn}, wheel to zoom, click to select · H for all keys`;
  byId("hint").hidden = false;
  setTimeout(endHint, HINT_MS);
  for (const trial of ["wheel", "touchstart"]) canvas.addEventListener(trial, endHint, { passive: true });
  window.addEventListener("keydown", endHint);
}

function endHint() {
  if (byId("hint").hidden) return;
  byId("hint").hidden = true;
  remember("hinted", "yes");
}

function setActive(on) {
  view.isActive = on;
  if (on) endHint();
}

function centreOn(x, y) {
  move.pick(x, y, ({ position }) => {
    if (position) view.change((camera) => camera.centreOn(position));
  });
}

new Input(
  canvas,
  picture,
  {
    orbit: (right, down) => view.change((camera) => camera.orbit(right, down)),
    pan: (right, down) => view.change((camera) => camera.pan(right, down)),
    zoom: (factor, at) => view.change((camera) => camera.zoom(factor, at)),
    roll: (angle) => view.change((camera) => camera.rollBy(angle)),
    light: (right) => panels.rotateLight(right * 360),
    select: (x, y) => move.pick(x, y, ({ id }) => objects.choose(id)),
    centre: centreOn,
    moveBegin: (x, y) => move.begin(x, y),
    moveBy: (right, down) => move.by(right, down),
    moveEnd: () => move.end(),
    active: setActive,
  },
  settings,
);

/** What an arrow key does: move the chosen object, or turn the view. */
function arrow(right, down) {
  if (settings.moving) move.step(right, down);
  else view.change((camera) => camera.orbit(right * KEY_ANGLE, down * KEY_ANGLE));
}
const shift = (right, down) => view.change((camera) => camera.pan(right * 0.05, down * 0.05));
const zoom = (factor) => () => view.change((camera) => camera.zoom(factor));
const turn = (right, down) => () => view.change((camera) => camera.orbit(right, down));
const roll = (angle) => () => view.change((camera) => camera.rollBy(angle));
const click = (id) => () => byId(id).click();

const keys = new Keys();
keys.add("1 · 3 · 7 · 9", "front, right, top, isometric view", {
  1: () => view.frame("front"),
  3: () => view.frame("right"),
  7: () => view.frame("top"),
  9: () => view.frame("iso"),
});
keys.add("2 · 8", "a quarter turn up, down", { 2: turn(0, Math.PI / 2), 8: turn(0, -Math.PI / 2) });
// The camera, as in F3D: the picture turns the other way.
keys.add("4 · 6", "roll a quarter left, right", { 4: roll(-Math.PI / 2), 6: roll(Math.PI / 2) });
keys.add("5", "perspective or parallel projection", { 5: () => view.change((camera) => camera.toggleParallel()) });
keys.add("Enter", "the view as it was at first", { Enter: () => view.frame("first") });
keys.add("Arrows", "turn; move the object while Move is on", {
  ArrowLeft: () => arrow(-1, 0),
  ArrowRight: () => arrow(1, 0),
  ArrowUp: () => arrow(0, -1),
  ArrowDown: () => arrow(0, 1),
});
keys.add("Shift + arrows", "shift", {
  "Shift+ArrowLeft": () => shift(-1, 0),
  "Shift+ArrowRight": () => shift(1, 0),
  "Shift+ArrowUp": () => shift(0, -1),
  "Shift+ArrowDown": () => shift(0, 1),
});
keys.add("+ · −", "zoom", { "+": zoom(1.1), "=": zoom(1.1), "-": zoom(1 / 1.1) });
keys.add("E", "edges found, classes of pixels", { E: () => panels.setOverlay(!session.scene?.overlay) });
keys.add("C", "compare with sharp edges", { C: () => session.scene && compare.toggle() });
keys.add("G", "ground", { G: click("ground") });
keys.add("L · Shift+L", "more, less light", {
  L: () => session.scene && panels.brighten(1.25),
  "Shift+L": () => session.scene && panels.brighten(0.8),
});
keys.add("F", "look at the selected object", { F: () => view.lookAt(objects.chosen, picture.aspect) });
keys.add("I", "isolate it, or show all", { I: () => objects.isolate() });
keys.add("X", "hide or show it", { X: () => objects.hide() });
keys.add("M", "move objects with the left button", { M: () => setMoving(!settings.moving) });
keys.add("K", "mouse as in F3D or Blender", { K: () => setPreset(settings.preset === "f3d" ? "blender" : "f3d") });
keys.add("Z", "figures", { Z: () => (byId("stats").hidden = !byId("stats").hidden) });
keys.add("N", "panel", { N: () => togglePanel() });
keys.add("H · ?", "this help, or close it", { H: () => byId("help").showModal(), "?": () => byId("help").showModal() });
keys.add("F12 · Ctrl+S", "save the picture", { F12: () => files.savePicture(), "Ctrl+S": () => files.savePicture() });
keys.add("Esc", "select nothing, end Move", {
  Escape: () => {
    setMoving(false);
    objects.choose(null);
  },
});
keys.fill(byId("help-keys").tBodies[0]);

function togglePanel() {
  const hidden = document.body.classList.toggle("no-panel");
  byId("panel-button").setAttribute("aria-expanded", String(!hidden));
}

byId("views").addEventListener("click", ({ target }) => {
  if (target.dataset.view !== undefined) view.frame(target.dataset.view);
});
byId("save-button").addEventListener("click", () => files.savePicture());
byId("help-button").addEventListener("click", () => byId("help").showModal());
// Keys are the picture's again after the mouse was used elsewhere. Before the click acts: a dialog that it opens gives
// the focus back to where it was.
document.addEventListener(
  "click",
  ({ target, detail }) => {
    const isByMouse = detail > 0 && !document.querySelector("dialog[open]");
    if (isByMouse && target.closest?.("button, summary")) canvas.focus({ preventScroll: true });
  },
  true,
);
// What has opened it closes it; the key must not open it again.
byId("help").addEventListener("keydown", (event) => {
  if (!["H", "?"].includes(keyName(event))) return;
  event.stopPropagation();
  byId("help").close();
});
byId("panel-button").addEventListener("click", togglePanel);
byId("move-mode").addEventListener("click", () => setMoving(!settings.moving));
byId("mouse").addEventListener("change", ({ target }) => setPreset(target.value));
byId("detail").addEventListener("change", ({ target }) => {
  settings.detail = target.value;
  remember("detail", target.value);
  resize();
});
byId("sheet-button").addEventListener("click", () => {
  const drawn = document.body.classList.toggle("drawn");
  byId("panel").scrollTop = 0;
  byId("sheet-button").setAttribute("aria-expanded", String(drawn));
  byId("sheet-label").textContent = drawn ? "Less" : "All settings";
});

setPreset(settings.preset);
byId("detail").value = settings.detail;
picture.addEventListener("drawn", showHint, { once: true });
connection.connect();
