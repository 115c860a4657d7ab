// page_test.js — the page's rules that need no browser: gestures, keys, numbers, sizes, frame headers.
import assert from "node:assert/strict";
import test from "node:test";
import { splitAfter } from "../../web/compare.js";
import { parseHeader, retryDelay } from "../../web/connection.js";
import { Errors } from "../../web/errors.js";
import { savedPicture } from "../../web/files.js";
import { clickAction, dragAction } from "../../web/input.js";
import { keyName } from "../../web/keys.js";
import { isIsolated } from "../../web/objects.js";
import { formatNumber, logScale, parseRadius, radiusChange, radiusScale, usedRadius } from "../../web/panels.js";
import { fitInto, hasShape, pictureSize } from "../../web/picture.js";
import { Session } from "../../web/session.js";
import { Stats } from "../../web/stats.js";

const press = (button, keys = {}) => ({ button, ...keys });

test("drags do what they do in F3D", () => {
  const drag = (...given) => dragAction("f3d", press(...given));
  assert.equal(drag(0), "orbit");
  assert.equal(drag(0, { shiftKey: true }), "pan");
  assert.equal(drag(0, { ctrlKey: true }), "roll");
  assert.equal(drag(0, { altKey: true }), "move");
  assert.equal(drag(1), "pan");
  assert.equal(drag(2), "zoom");
  assert.equal(drag(2, { ctrlKey: true }), "zoomThere");
  assert.equal(drag(2, { shiftKey: true }), "light");
  assert.equal(drag(4), null);
});

test("drags do what they do in Blender", () => {
  const drag = (...given) => dragAction("blender", press(...given));
  assert.equal(drag(1), "orbit");
  assert.equal(drag(1, { shiftKey: true }), "pan");
  assert.equal(drag(1, { ctrlKey: true }), "zoom");
  assert.equal(drag(0), null);
  assert.equal(drag(0, { altKey: true }), "orbit");
});

test("the left button moves objects while Move is on, and the view still pans and rolls", () => {
  assert.equal(dragAction("f3d", press(0), true), "move");
  assert.equal(dragAction("f3d", press(0, { shiftKey: true }), true), "pan");
  assert.equal(dragAction("f3d", press(2), true), "zoom");
  assert.equal(dragAction("blender", press(0), true), "move");
  assert.equal(dragAction("blender", press(1), true), "orbit");
});

test("clicks choose, and centre with F3D's middle button", () => {
  assert.equal(clickAction("f3d", press(0)), "select");
  assert.equal(clickAction("f3d", press(1)), "centre");
  assert.equal(clickAction("blender", press(1)), null);
  assert.equal(clickAction("f3d", press(2)), null);
});

test("names keys independently of capitals", () => {
  assert.equal(keyName({ key: "e" }), "E");
  assert.equal(keyName({ key: "E" }), "E");
  assert.equal(keyName({ key: "L", shiftKey: true }), "Shift+L");
  assert.equal(keyName({ key: "+", shiftKey: true }), "+");
  assert.equal(keyName({ key: "ArrowUp", shiftKey: true }), "Shift+ArrowUp");
  assert.equal(keyName({ key: "s", ctrlKey: true }), "Ctrl+S");
  assert.equal(keyName({ key: "s", metaKey: true }), "Ctrl+S");
});

test("reads radii as people type them", () => {
  assert.equal(parseRadius("0.5"), 0.5);
  assert.equal(parseRadius(" 0,5 "), 0.5);
  assert.equal(parseRadius(".5"), 0.5);
  assert.equal(parseRadius("1e-3"), 0.001);
  assert.equal(parseRadius("8%"), "8%");
  assert.equal(parseRadius("8 %"), "8%");
  assert.equal(parseRadius("Auto"), "auto");
  for (const wrong of ["", "-1", "x", "1 mm", "%", "1e999", "NaN", "Infinity"]) {
    assert.equal(parseRadius(wrong), undefined, wrong);
  }
});

test("the radius that is shown is that of the most rounded object without one of its own", () => {
  const objects = [
    { radius: null, rounded: 0.5 },
    { radius: null, rounded: 0.6 },
    { radius: 2, rounded: 2 },
  ];
  assert.equal(usedRadius("auto", objects), 0.6);
  assert.equal(usedRadius("8%", objects), 0.6);
  assert.equal(usedRadius(0.1, objects), 0.1);
  assert.equal(usedRadius("auto", []), null);
});

test("a logarithmic slider reaches its ends and comes back to its values", () => {
  const { toSlider, fromSlider } = logScale(0.05, 20);
  assert.equal(fromSlider(0), 0.05);
  assert.equal(fromSlider(1000), 20);
  assert.equal(toSlider(1), 500);
  assert.equal(fromSlider(500), 1);
  assert.equal(toSlider(0), 0);
  assert.equal(toSlider(1e9), 1000);
  for (let at = 0; at <= 1000; at += 50) assert.ok(Math.abs(toSlider(fromSlider(at)) - at) <= 1);
});

test("the radius slider's range goes with the model's size", () => {
  const small = radiusScale({ lower: [0, 0, 0], upper: [1, 1, 1] });
  const large = radiusScale({ lower: [0, 0, 0], upper: [1000, 1000, 1000] });
  assert.ok(Math.abs(large.fromSlider(700) / small.fromSlider(700) - 1000) < 10);
  // A model without extent must not make numbers that are none.
  assert.ok(Number.isFinite(radiusScale({ lower: [0, 0, 0], upper: [0, 0, 0] }).fromSlider(3)));
});

test("the radius slider ends just below what is possible, where that is known", () => {
  const bounds = { lower: [0, 0, 0], upper: [1, 1, 1] };
  for (const limit of [0.5, 0.123456, 1e-4, 3]) {
    const { fromSlider } = radiusScale(bounds, limit);
    assert.ok(fromSlider(1000) < limit && fromSlider(1000) > 0.97 * limit, `${limit}: ${fromSlider(1000)}`);
    assert.ok(fromSlider(0) < limit / 50);
  }
  assert.equal(radiusScale(bounds, null).fromSlider(1000), radiusScale(bounds).fromSlider(1000));
});

test("radius 0 makes edges sharp, and another one rounds sharp ones", () => {
  const change = (radius, method, compared = null) =>
    radiusChange(radius, { rounding: { method }, compare: compared && { method: compared } });
  assert.deepEqual(change(0, "exact"), { method: "none" });
  assert.deepEqual(change("0%", "shader"), { method: "none" });
  assert.deepEqual(change(0.5, "shader"), { radius: 0.5 });
  assert.deepEqual(change("8%", "none"), { radius: "8%", method: "exact" });
  assert.deepEqual(change(0.5, "none", "exact"), { radius: 0.5 });
});

test("only the single visible one of several objects is isolated", () => {
  const objects = (...visible) => visible.map((each, id) => ({ id, visible: each }));
  assert.ok(isIsolated(1, objects(false, true, false)));
  assert.ok(!isIsolated(0, objects(false, true, false)));
  assert.ok(!isIsolated(1, objects(true, true, false)));
  assert.ok(!isIsolated(0, objects(true)));
});

test("says of a saved picture whether it is a draft", () => {
  assert.deepEqual(savedPicture("a.png", { samples: 64, converged: true }, 64), ["Saved a.png"]);
  const [text, remedy] = savedPicture("a.png", { samples: 0, converged: false }, 64);
  assert.equal(text, "Saved a.png: a draft, 0 of 64 samples");
  assert.match(remedy, /tick/);
});

test("writes numbers with as few digits as they need", () => {
  assert.equal(formatNumber(0.1 + 0.2), "0.3");
  assert.equal(formatNumber(1234.5678), "1235");
  assert.equal(formatNumber(0.62446752, 3), "0.624");
});

test("asks for pictures of the window's shape, within the protocol's bounds and its own", () => {
  assert.deepEqual(pictureSize(1280, 720, 1), [1280, 720]);
  for (const [width, height, ratio] of [[1920, 1080, 2], [3840, 2160, 1], [390, 744, 3], [5000, 400, 1], [10, 10, 1]]) {
    for (const detail of ["auto", 1, 0.5]) {
      const size = pictureSize(width, height, ratio, detail);
      assert.ok(size[0] >= 64 && size[0] <= 3840 && size[1] >= 64 && size[1] <= 2160, String(size));
      if (detail === "auto") assert.ok(size[0] * size[1] <= 1920 * 1080 * 1.01, String(size));
      if (width > 64) assert.ok(Math.abs(size[0] / size[1] / (width / height) - 1) < 0.02, String(size));
    }
  }
});

test("fits a picture into an area whole and in the middle", () => {
  assert.deepEqual(fitInto(100, 100, 200, 100), { left: 0, top: 25, width: 100, height: 50 });
  assert.deepEqual(fitInto(100, 50, 10, 10), { left: 25, top: 0, width: 50, height: 50 });
});

test("a first picture of another window's shape is told from one of this window's", () => {
  assert.ok(hasShape({ width: 968, height: 800 }, 968 / 800));
  assert.ok(hasShape({ width: 967, height: 801 }, 968 / 800));
  assert.ok(!hasShape({ width: 1280, height: 720 }, 968 / 800));
});

/** What Session needs of a connection. */
class FakeConnection extends EventTarget {
  lastSeq = 0;
  #newest = new Map();
  send(type) {
    this.#newest.set(type, ++this.lastSeq);
    return this.lastSeq;
  }
  newestSeq(type) {
    return this.#newest.get(type) ?? 0;
  }
  tell(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}

function openSession() {
  const connection = new FakeConnection();
  const session = new Session(connection);
  const tell = (radius, seq, fields = {}) => {
    connection.tell("scene", { name: "a", objects: [], rounding: { radius }, strength: 1, seq, ...fields });
  };
  const drag = (radius) => session.send("rounding", { radius }, (scene) => (scene.rounding = { radius }));
  return { connection, session, tell, drag, radius: () => session.scene.rounding.radius };
}

test("a slider that is dragged does not jump back to what scenes say that do not know of it", () => {
  const { session, tell, drag, radius } = openSession();
  tell(1, 0);
  drag(2);
  const newest = drag(3);
  tell(2, newest - 1, { strength: 5 });
  assert.equal(radius(), 3);
  assert.equal(session.scene.strength, 5, "what has not been changed here is taken over");
  tell(2.9, newest);
  assert.equal(radius(), 2.9, "the server's word on it");
});

test("a change that was refused, or another model, gives the server the word again", () => {
  const { session, tell, drag, radius } = openSession();
  tell(1, 0);
  session.setRefused(drag(-1));
  tell(1, 0);
  assert.equal(radius(), 1);
  drag(4);
  tell(0.5, 0, { name: "b" });
  assert.equal(radius(), 0.5);
});

test("a file of the same name that was opened again is another model", () => {
  const { session, tell, drag, radius } = openSession();
  tell(1, 0, { model: 1 });
  const isNew = [];
  session.addEventListener("scene", ({ detail }) => detail?.fromServer && isNew.push(detail.isNew));
  drag(4);
  tell(0.5, 0, { model: 1 });
  tell(0.5, 0, { model: 2 });
  assert.deepEqual(isNew, [false, true]);
  assert.equal(radius(), 0.5);
});

/** Stats with elements that keep what they are told. */
function openStats(context) {
  const elements = {};
  const make = () => ({ textContent: "", parentElement: {}, replaceChildren() {} });
  globalThis.document = { getElementById: (id) => (elements[id] ??= make()), createElement: make };
  context.after(() => delete globalThis.document);
  return { stats: new Stats(), text: (name) => elements[`stat-${name}`].textContent };
}

test("the latency of a picture that is finished is forgotten, as no later frame says that nothing moves", (context) => {
  const { stats, text } = openStats(context);
  const frame = { samples: 64, serverMs: 10, moving: true, converged: false };
  stats.setFrame(frame, 20);
  assert.equal(text("latency"), "20 ms");
  stats.setFrame({ ...frame, moving: false }, null);
  assert.equal(text("latency"), "–");
  stats.setFrame({ ...frame, moving: false, converged: true }, 500);
  assert.equal(text("latency"), "–");
});

test("says which integrator runs, and what the overlay shows then", (context) => {
  const { stats, text } = openStats(context);
  const state = { fps: 1, frame_ms: 1, seconds: 1, new_samples: 0, triangles: 12, rounded_edges: 0, converged: false };
  const edges = { silhouette: 1, sharp: 2, shadow: 3 };
  const classes = { empty: 0.5, simple: 0.5, complex: 0 };
  const none = { empty: 0, simple: 0, complex: 0 };
  const legend = (integrator, of) => {
    stats.setState({ ...state, edges, integrator, classes: of });
    return [text("integrator"), document.getElementById("legend-edges").textContent.includes("traced")];
  };
  assert.deepEqual(legend("edge-point", classes), ["edge-point", false]);
  assert.deepEqual(legend("path", classes), ["path tracing", false]);
  assert.deepEqual(legend("path", none), ["path tracing", true]);
  assert.deepEqual(legend("traced", none), ["traced", true]);
});

test("keys move the line of a comparison", () => {
  for (const key of ["ArrowRight", "ArrowUp"]) assert.ok(Math.abs(splitAfter(key, 0.5) - 0.52) < 1e-9);
  for (const key of ["ArrowLeft", "ArrowDown"]) assert.ok(Math.abs(splitAfter(key, 0.5) - 0.48) < 1e-9);
  assert.ok(Math.abs(splitAfter("PageUp", 0.5) - 0.6) < 1e-9);
  assert.equal(splitAfter("PageDown", 0.05), 0);
  assert.deepEqual([splitAfter("Home", 0.3), splitAfter("End", 0.3)], [0, 1]);
  assert.equal(splitAfter("a", 0.3), undefined);
});

test("an error goes when a later message of its kind has worked, or the server says so", () => {
  const { connection, session, tell, drag } = openSession();
  const shown = new Map();
  const messages = {
    error: (text, remedy, about = "") => shown.set(about, text),
    clear: (about) => (about ? shown.delete(about) : shown.clear()),
  };
  new Errors({ connection, session, messages, refused: (seq) => session.setRefused(seq) });
  const fail = (about, seq, text = "no") => connection.tell("error", { about, seq, text });
  tell(1, 0);
  const first = drag(5);
  fail("rounding", first, "5 is too large");
  tell(1, first);
  assert.equal(shown.get("rounding"), "5 is too large");
  const second = drag(6);
  fail("rounding", second, "6 is too large");
  assert.equal(shown.size, 1);
  const light = session.send("light", { strength: 2 });
  tell(1, light);
  assert.equal(shown.get("rounding"), "6 is too large", "light has nothing to do with it");
  const third = drag(0.5);
  tell(1, light);
  assert.equal(shown.size, 1, "not there yet");
  tell(0.5, third);
  assert.equal(shown.size, 0);

  fail("file", undefined, "deleted");
  fail("rounding", third);
  connection.tell("error", { text: "", about: "file" });
  assert.deepEqual([...shown.keys()], ["rounding"]);
  connection.tell("error", { text: "" });
  assert.equal(shown.size, 0);
});

test("reads the header of a frame, and nothing from other bytes", () => {
  const bytes = new DataView(new ArrayBuffer(40));
  bytes.setUint32(0, 0x46525241, true);
  bytes.setUint32(4, 7, true);
  bytes.setUint32(8, 41, true);
  bytes.setUint16(12, 1280, true);
  bytes.setUint16(14, 720, true);
  bytes.setFloat32(16, 12.5, true);
  bytes.setUint32(20, 2, true);
  bytes.setUint32(24, 64, true);
  assert.deepEqual(parseHeader(bytes.buffer), {
    frame: 7, seq: 41, width: 1280, height: 720, serverMs: 12.5, moving: false, converged: true, samples: 64,
  });
  assert.equal(parseHeader(bytes.buffer.slice(0, 32)), null);
  bytes.setUint8(0, 0);
  assert.equal(parseHeader(bytes.buffer), null);
});

test("tries to reconnect with growing delays, to a limit", () => {
  const delays = [...Array(20).keys()].map(retryDelay);
  assert.ok(delays[0] <= 1000);
  for (let i = 1; i < delays.length; ++i) assert.ok(delays[i] >= delays[i - 1]);
  assert.equal(delays.at(-1), 15000);
});
