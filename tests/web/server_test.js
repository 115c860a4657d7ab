// server_test.js — the viewer's page in a real browser: several pages, models that are dropped, a server that refuses, is
// out of reach or begins anew.
import assert from "node:assert/strict";
import http from "node:http";
import { after, before, test } from "node:test";
import { plateStl } from "./models.js";
import { model, pageTest, scenes, sentOf } from "./page_case.js";
import * as viewer from "./viewer.js";

before(viewer.launchBrowser);
after(viewer.closeBrowser);

pageTest("a page that finds no room is told so, and comes in when there is", {}, async ({ page, server }) => {
  await page.evaluate((url) => {
    window.others = [...Array(7)].map(() => new WebSocket(url));
    return Promise.all(window.others.map((socket) => new Promise((open) => (socket.onopen = open))));
  }, server.url.replace("http", "ws").replace("/?", "/ws?"));
  const ninth = await viewer.openPage(server.url);
  try {
    await ninth.page.locator(".message", { hasText: "8 pages look already" }).waitFor();
    await ninth.page.locator(".message", { hasText: "close one" }).waitFor();
    const retry = ninth.page.getByRole("button", { name: "Try now" });
    await retry.waitFor();
    await page.evaluate(() => window.others.forEach((socket) => socket.close()));
    // By the button, or by itself, if it has just tried again: then there is no button any more.
    await Promise.any([retry.click(), viewer.firstFrame(ninth.page)]);
    await viewer.firstFrame(ninth.page);
    await ninth.page.locator(".message", { hasText: "8 pages" }).waitFor({ state: "detached" });
  } finally {
    await ninth.context.close();
  }
});

pageTest("bevel meshes are a method, and can be compared with", { options: ["--round-method", "mesh:2"] }, async (opened) => {
  const { page, traffic } = opened;
  assert.ok(await page.locator("#method input[value=mesh]").isChecked());
  await page.locator("#compare").selectOption("none");
  await page.locator("#split").waitFor();
  assert.equal(await page.locator("#split-left").textContent(), "Bevel mesh");
  await viewer.shown(page, traffic);
  await page.setViewportSize({ width: 700, height: 500 });
  await viewer.until("another size", () => sentOf(traffic, "size").length > 0);
  await viewer.shown(page, traffic);
  assert.equal(await page.locator(".message.error").count(), 0);
});

const csgModel = viewer.writeModel("ball.csg", "sphere(r = 1);\n");
pageTest("of CSG solids there is nothing to round", { file: csgModel }, async ({ page }) => {
  await page.locator("#rounding-note").waitFor();
  for (const selector of ["#radius-slider", "#method", "#edges", "#compare"]) {
    assert.ok(await page.locator(selector).isHidden(), selector);
  }
});

/** Status of a request that a browser would not make. */
function statusOf(port, path, headers = {}) {
  return new Promise((resolve, reject) => {
    const request = http.request({ host: "127.0.0.1", port, path, headers }, (answer) => {
      answer.resume();
      resolve(answer.statusCode);
    });
    request.on("upgrade", (answer, socket) => {
      socket.destroy();
      resolve(answer.statusCode);
    });
    request.on("error", reject);
    request.end();
  });
}

pageTest("the server refuses wrong tokens, foreign origins and foreign hosts", {}, async ({ server }) => {
  const { port, token } = server;
  const upgrade = {
    connection: "Upgrade",
    upgrade: "websocket",
    "sec-websocket-version": "13",
    "sec-websocket-key": "dGhlIHNhbXBsZSBub25jZQ==",
  };
  const own = { ...upgrade, origin: `http://127.0.0.1:${port}` };
  assert.equal(await statusOf(port, `/?t=${token}`), 200);
  assert.equal(await statusOf(port, "/"), 403);
  assert.equal(await statusOf(port, "/?t=wrong"), 403);
  assert.equal(await statusOf(port, "/picture.png?t=wrong"), 403);
  assert.equal(await statusOf(port, `/?t=${token}`, { host: "example.org" }), 403);
  assert.equal(await statusOf(port, `/ws?t=${token}`, own), 101);
  assert.equal(await statusOf(port, "/ws?t=wrong", own), 403);
  assert.equal(await statusOf(port, `/ws?t=${token}`, { ...upgrade, origin: "http://example.org" }), 403);
});

pageTest("says so when models may not be dropped", {}, async ({ page }) => {
  await viewer.drop(page, "frame.stl", plateStl);
  await page.locator(".message.error", { hasText: "does not take models" }).waitFor();
  await page.getByRole("button", { name: "Dismiss this message" }).click();
  await page.locator(".message.error").waitFor({ state: "detached" });
});

test("a dropped file is opened where that is allowed", { timeout: 4 * viewer.PATIENCE_MS }, async () => {
  const other = await viewer.startServer(model, { options: ["--allow-upload"] });
  const { page, context, traffic, errors } = await viewer.openPage(other.url);
  try {
    await viewer.firstFrame(page);
    await viewer.drop(page, "frame.stl", plateStl);
    await viewer.until("the new model", async () => (await page.locator("#model-name").textContent()) === "frame.stl");
    await viewer.until("one object", () => scenes(traffic).at(-1).objects.length === 1);
    await viewer.drop(page, "broken.stl", "solid nothing");
    await page.locator(".message.error", { hasText: "broken.stl" }).waitFor();
    assert.equal(await page.locator("#model-name").textContent(), "frame.stl");
    assert.deepEqual(errors, []);
  } finally {
    await context.close();
    await other.stop();
  }
});

/** A page between which and its server a test stands: `edit` changes what the server says, `tell` adds to it. */
async function openBetween(url, edit) {
  const opened = await viewer.openPage("about:blank");
  let socket = null;
  const sent = [];
  await opened.page.routeWebSocket(/\/ws\?/, (page) => {
    socket = page;
    const server = page.connectToServer();
    page.onMessage((message) => {
      sent.push(JSON.parse(message));
      // What the program at hand may not know yet.
      if (sent.at(-1).type !== "beam_stop") server.send(message);
    });
    server.onMessage((message) => page.send(typeof message === "string" ? edit(message) : message));
  });
  await opened.page.goto(url);
  return { ...opened, sent, tell: (message) => socket.send(JSON.stringify(message)) };
}

test("follows another page's camera, shows the lightings there are, cancels a beam picture", async () => {
  const server = await viewer.startServer(model);
  let stopped;
  const edit = (text) => {
    const message = JSON.parse(text);
    if (message.type === "beam") return JSON.stringify({ ...message, done: 0.25, ready: false, stopped });
    if (message.type !== "scene") return text;
    return JSON.stringify({ ...message, lightings: ["studio", "white"], seq: message.seq ?? 0 });
  };
  const { page, context, errors, sent, tell } = await openBetween(server.url, edit);
  try {
    await viewer.firstFrame(page);
    const isShown = (name) => page.locator(`#lighting label:has([value=${name}])`).isVisible();
    await viewer.until("the lightings", async () => !(await isShown("sky")));
    assert.deepEqual([await isShown("studio"), await isShown("white"), await isShown("file")], [true, true, false]);

    const camera = { position: [0, -77, 5], target: [1, 2, 3], up: [0, 0, 1], fov: 30 };
    tell({ type: "camera", ...camera });
    await page.evaluate(() => new Promise((done) => setTimeout(done, 100)));
    await page.keyboard.press("+");
    const cameras = () => sent.filter(({ type }) => type === "camera");
    await viewer.until("a camera", () => cameras().length > 0);
    assert.deepEqual(cameras().at(-1).target.map(Math.round), camera.target);
    assert.ok(Math.abs(cameras().at(-1).fov - camera.fov) < 1e-6);

    await page.locator("#beam-start").click();
    await page.getByRole("button", { name: "Cancel the beam picture" }).click();
    await viewer.until("the end asked for", () => sent.some(({ type }) => type === "beam_stop"));
    // Of the program, which has not heard of it, more may come.
    stopped = true;
    tell({ type: "beam", done: 0, ready: false, stopped });
    await page.locator("#beam-work").waitFor({ state: "hidden" });
    assert.ok(await page.locator("#beam-start").isEnabled());
    assert.deepEqual(errors, []);
  } finally {
    await context.close();
    await server.stop();
  }
});

test("reconnects when the line is mended, and tells of a new token", { timeout: 4 * viewer.PATIENCE_MS }, async () => {
  let server = await viewer.startServer(model);
  const line = await viewer.startLine(server.port);
  const { page, context, errors } = await viewer.openPage(`http://127.0.0.1:${line.port}/?t=${server.token}`);
  const status = () => page.locator("#status").textContent();
  try {
    await viewer.firstFrame(page);
    line.cut();
    await viewer.until("no connection", async () => (await status()) === "no connection");
    await page.locator(".message", { hasText: "does not answer" }).waitFor();
    await viewer.screenshot(page, "no-connection");
    await line.mend();
    await viewer.until("connected", async () => (await status()) === "connected");
    await page.locator(".message", { hasText: "does not answer" }).waitFor({ state: "detached" });
    const frame = await viewer.frameOf(page);
    await page.keyboard.press("ArrowLeft");
    await viewer.until("a new frame", async () => (await viewer.frameOf(page)) !== frame);

    await server.stop();
    server = await viewer.startServer(model, { port: server.port });
    await page.locator(".message", { hasText: "refuses this address" }).waitFor();
    assert.deepEqual(errors, []);
  } finally {
    await context.close();
    line.cut();
    await server.stop();
  }
});
