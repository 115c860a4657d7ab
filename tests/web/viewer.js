// viewer.js — what the tests need of `arris view`, the browser and the pictures.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import fs from "node:fs";
import net from "node:net";
import os from "node:os";
import path from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

export const root = fileURLToPath(new URL("../..", import.meta.url));
const program = process.env.ARRIS ?? path.join(root, "build/release/arris");
const screenshots = process.env.ARRIS_SCREENSHOTS ?? path.join(root, "build/release/web-screenshots");
// For work on the page without building the program: its files are taken from this folder instead.
const webFolder = process.env.ARRIS_WEB;
const browserProgram = process.env.CHROMIUM ?? "/usr/bin/chromium";

// Other work may share the machine: nothing here fails for being slow before this.
export const PATIENCE_MS = 90_000;

export const folder = fs.mkdtempSync(path.join(os.tmpdir(), "arris-web-"));
process.on("exit", () => fs.rmSync(folder, { recursive: true, force: true }));

export function writeModel(name, text) {
  const file = path.join(folder, name);
  fs.writeFileSync(file, text);
  return file;
}

/** Waits until `check` returns something true, and returns it. */
export async function until(what, check) {
  const end = Date.now() + PATIENCE_MS;
  for (;;) {
    const value = await check();
    if (value) return value;
    assert.ok(Date.now() < end, `never happened: ${what}`);
    await sleep(50);
  }
}

// Enough to tell pictures apart, and soon there on a busy machine.
const CHEAP = ["--shader", "direct", "--spp", "8"];

/** Starts `arris view` and waits for its address. */
export async function startServer(file, { port = "0", quality = CHEAP, options = [] } = {}) {
  const all = ["view", file, "--no-browser", "--port", String(port), ...quality, ...options];
  const child = spawn(program, all, { stdio: ["ignore", "pipe", "pipe"] });
  let output = "";
  let ended = null;
  for (const stream of [child.stdout, child.stderr]) stream.on("data", (data) => (output += data));
  const exit = new Promise((resolve) =>
    child.once("close", (code, signal) => resolve((ended = { code, signal }))),
  );
  child.once("error", (error) => (ended = { error }));
  process.once("exit", () => child.kill("SIGKILL"));
  const url = await until("the server's address", () => {
    assert.equal(ended, null, `arris view ended: ${output} ${ended?.error ?? ""}`);
    return /http:\/\/\S+\?t=[\w-]+/.exec(output)?.[0];
  });
  return {
    url,
    pid: child.pid,
    hasEnded: () => ended !== null,
    port: new URL(url).port,
    token: new URL(url).searchParams.get("t"),
    output: () => output,
    /** Asks it to end, as Ctrl-C does. */
    async stop() {
      child.kill("SIGINT");
      return exit;
    },
  };
}

/** Stands before a server, as a network does, and can be cut. */
export async function startLine(serverPort) {
  const sockets = new Set();
  const listener = net.createServer((here) => {
    const there = net.connect(serverPort, "127.0.0.1");
    for (const [from, to] of [[here, there], [there, here]]) {
      sockets.add(from);
      from.pipe(to);
      from.on("error", () => to.destroy());
      from.on("close", () => to.destroy());
    }
  });
  const listen = (port) => new Promise((resolve) => listener.listen(port, "127.0.0.1", resolve));
  await listen(0);
  const { port } = listener.address();
  return {
    port,
    cut() {
      listener.close();
      for (const socket of sockets) socket.destroy();
      sockets.clear();
    },
    mend: () => listen(port),
  };
}

let browser = null;
export async function launchBrowser() {
  browser = await chromium.launch({
    executablePath: browserProgram,
    // Root needs the first, containers with a small /dev/shm the second.
    args: [
      "--no-sandbox",
      "--disable-dev-shm-usage",
      // A page that was not loaded from this machine may not ask it otherwise.
      ...(webFolder ? ["--disable-features=LocalNetworkAccessChecks"] : []),
    ],
    timeout: PATIENCE_MS,
  });
}
export async function closeBrowser() {
  await browser?.close();
}

function serveFromFolder(route) {
  const name = new URL(route.request().url()).pathname.slice(1) || "index.html";
  const file = path.join(webFolder, name);
  return fs.existsSync(file) ? route.fulfill({ path: file }) : route.continue();
}

/** A page of its own in a window of this size, with the messages of its WebSocket. */
export async function openPage(url, { width = 760, height = 460, ...options } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, acceptDownloads: true, ...options });
  context.setDefaultTimeout(PATIENCE_MS);
  const page = await context.newPage();
  // `order`: the sequence numbers of messages sent and pictures received, as they went by.
  const traffic = { sent: [], received: [], order: [] };
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error.stack)));
  page.on("console", (message) => {
    // Refused connections are part of some tests; scripts and styles that the policy blocks are not.
    if (message.type() === "error" && !/Failed to load resource|WebSocket connection/.test(message.text())) {
      errors.push(message.text());
    }
  });
  page.on("websocket", (socket) => {
    socket.on("framesent", ({ payload }) => {
      const message = JSON.parse(payload);
      traffic.sent.push(message);
      if (message.seq) traffic.order.push({ sent: message.seq });
    });
    socket.on("framereceived", ({ payload }) => {
      if (typeof payload === "string") traffic.received.push(JSON.parse(payload));
      else traffic.order.push({ picture: payload.readUInt32LE(8) });
    });
  });
  if (webFolder) await page.route(/\/(\w+\.\w+)?(\?t=[\w-]*)?$/, serveFromFolder);
  await page.goto(url);
  return { page, context, traffic, errors };
}

export const frameOf = (page) => page.locator("#picture").evaluate((canvas) => Number(canvas.dataset.frame ?? 0));
export const seqOf = (page) => page.locator("#picture").evaluate((canvas) => Number(canvas.dataset.seq ?? 0));

/** A picture in the shape of the window. */
export const firstFrame = (page) =>
  until("a first frame", () =>
    page.locator("#picture").evaluate(({ dataset, width, height, clientWidth, clientHeight }) => {
      const shape = (width * clientHeight) / (height * clientWidth);
      return Number(dataset.frame) > 0 && Math.abs(shape - 1) < 0.02;
    }),
  );

/** The newest of the page's messages has been drawn. */
export async function shown(page, traffic) {
  const newest = () => Math.max(0, ...traffic.sent.map(({ seq }) => seq ?? 0));
  return until("the newest input in the picture", async () => (await seqOf(page)) >= newest());
}

/** Pictures that came after the newest message had left, before one that shows it. */
export function latePictures({ order }) {
  const last = order.findLastIndex(({ sent }) => sent !== undefined);
  return order.slice(last).filter(({ picture }) => picture < order[last].sent).length;
}

/** The newest input is in the picture, and what was coarse at first has gone: a dozen frames later, or finished. */
export async function settled(page, traffic) {
  await shown(page, traffic);
  const first = await frameOf(page);
  await until("a settled picture", () =>
    page
      .locator("#picture")
      .evaluate(({ dataset }, enough) => Number(dataset.frame) >= enough || dataset.converged === "true", first + 12),
  );
}

const COLUMNS = 64;
const ROWS = 48;

/** The picture's brightness in 64 by 48 cells. */
export function pictureOf(page) {
  return page.locator("#picture").evaluate(
    (canvas, [columns, rows]) => {
      const small = new OffscreenCanvas(columns, rows).getContext("2d");
      small.imageSmoothingQuality = "high";
      small.drawImage(canvas, 0, 0, columns, rows);
      const { data } = small.getImageData(0, 0, columns, rows);
      const brightness = (at) => (data[at] + data[at + 1] + data[at + 2]) / 3;
      return Array.from({ length: columns * rows }, (_, at) => brightness(4 * at));
    },
    [COLUMNS, ROWS],
  );
}

/** Mean difference of two pictures, between two columns as parts of the width. */
export function difference(a, b, from = 0, to = 1) {
  let sum = 0;
  let count = 0;
  for (let at = 0; at < a.length; ++at) {
    const column = (at % COLUMNS) / COLUMNS;
    if (column < from || column >= to) continue;
    sum += Math.abs(a[at] - b[at]);
    count += 1;
  }
  return sum / count;
}

export function deviation(picture) {
  const mean = picture.reduce((sum, x) => sum + x, 0) / picture.length;
  return Math.sqrt(picture.reduce((sum, x) => sum + (x - mean) ** 2, 0) / picture.length);
}

export async function middleOf(page, selector = "#picture") {
  const box = await page.locator(selector).boundingBox();
  return [box.x + box.width / 2, box.y + box.height / 2];
}

export async function drag(page, [x, y], [right, down], { button = "left", steps = 8 } = {}) {
  await page.mouse.move(x, y);
  await page.mouse.down({ button });
  await page.mouse.move(x + right, y + down, { steps });
  await page.mouse.up({ button });
}

export async function drop(page, name, text) {
  const files = await page.evaluateHandle(
    ([name, text]) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([text], name));
      return transfer;
    },
    [name, text],
  );
  await page.dispatchEvent("#picture", "drop", { dataTransfer: files });
  await files.dispose();
}

export async function screenshot(page, name) {
  fs.mkdirSync(screenshots, { recursive: true });
  await page.screenshot({ path: path.join(screenshots, `${name}.png`) });
}
