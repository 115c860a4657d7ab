// soak.js — uses the viewer for a long time as people do, and watches what it costs: node tests/web/soak.js MINUTES [MODEL]
//
// Every 30 s a line: the server's resident memory, the page's heap, frames, errors. Ends with 1 if a script of the page
// failed, the server ended, no frames came any more, or the server's memory in the last third of the time is above
// that in the first third by more than 5 % and 20 MB; under 10 minutes caches still fill, and memory is told but not
// judged. `ARRIS` is the program, build/release/arris by default.
import fs from "node:fs";
import path from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { plateAndCube, plateStl } from "./models.js";
import * as viewer from "./viewer.js";

const REPORT_MS = 30_000;
const SAMPLE_MS = 2000;
const GROWTH = 1.05;
const GROWTH_BYTES = 20e6;
const JUDGED_MINUTES = 10;
// Caches fill at first.
const SETTLING_PART = 0.1;
const ACTION_MS = 60_000;

const minutes = Number(process.argv[2]);
if (!(minutes > 0)) {
  console.error("usage: node tests/web/soak.js MINUTES [MODEL]");
  process.exit(2);
}
const model = process.argv[3] ?? path.join(viewer.root, "examples/models/keypad.obj");
const lasting = minutes * 60_000;

const server = await viewer.startServer(model, { options: ["--allow-upload"] });
// To be cut.
const line = await viewer.startLine(server.port);
await viewer.launchBrowser();
const opened = await viewer.openPage(`http://127.0.0.1:${line.port}/?t=${server.token}`, { width: 1000, height: 640 });
const { page, context, errors, traffic } = opened;
const devtools = await context.newCDPSession(page);
await viewer.firstFrame(page);
await page.evaluate(() => document.querySelectorAll("details").forEach((section) => (section.open = true)));

// Numbers that are the same in each run.
let state = 1;
const random = (low, high) => {
  state = (state * 48271) % 2147483647;
  return low + ((high - low) * state) / 2147483647;
};
const oneOf = (values) => values[Math.floor(random(0, values.length * 0.999))];
const middle = async () => {
  const [x, y] = await viewer.middleOf(page);
  return [x + random(-120, 120), y + random(-80, 80)];
};

async function open(name, text) {
  await viewer.drop(page, name, text);
  await viewer.until(`${name} opened`, async () => (await page.locator("#model-name").textContent()) === name);
}

async function save(button) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator(button).click()]);
  await download.delete();
}

const actions = {
  orbit: async () => viewer.drag(page, await middle(), [random(-300, 300), random(-120, 120)], { steps: 60 }),
  pan: async () => viewer.drag(page, await middle(), [random(-40, 40), random(-40, 40)], { button: "middle" }),
  zoom: async () => {
    await page.mouse.move(...(await middle()));
    await page.mouse.wheel(0, random(-200, 200));
  },
  view: () => page.keyboard.press(oneOf(["1", "3", "7", "9", "Enter"])),
  radius: async () => {
    await page.locator("#radius-slider").scrollIntoViewIfNeeded();
    const box = await page.locator("#radius-slider").boundingBox();
    const from = [box.x + box.width * random(0.2, 0.8), box.y + box.height / 2];
    await viewer.drag(page, from, [random(-80, 80), 0], { steps: 30 });
  },
  automatic: () => page.locator("#radius-auto").click(),
  method: () => page.locator(`#method input[value=${oneOf(["exact", "exact", "shader", "none"])}]`).check(),
  compare: () => page.locator("#compare").selectOption(oneOf(["", "none", "shader"])),
  overlay: () => page.locator("#overlay").click(),
  ground: () => page.locator("#ground").click(),
  light: async () => {
    await page.locator(`#lighting input[value=${oneOf(["studio", "sky", "white"])}]`).check();
    await page.locator("#rotation").fill(String(Math.round(random(-180, 180))));
    await page.locator("#rotation").press("Enter");
  },
  material: () => page.locator("#material").selectOption({ index: Math.floor(random(0, 3)) }),
  pick: async () => page.mouse.click(...(await middle())),
  move: async () => {
    await page.keyboard.down("Alt");
    await viewer.drag(page, await middle(), [random(-60, 60), random(-40, 40)], { steps: 20 });
    await page.keyboard.up("Alt");
  },
  hide: async () => {
    await page.locator("#object-list .eye").first().click();
    await page.locator("#show-all").click();
  },
  size: async () => {
    await page.setViewportSize({ width: Math.round(random(760, 1300)), height: Math.round(random(480, 800)) });
    await sleep(500);
  },
  secondPage: async () => {
    const second = await viewer.openPage(server.url, { width: 760, height: 500 });
    try {
      await viewer.until("a frame", async () => (await viewer.frameOf(second.page)) > 0);
      await viewer.drag(second.page, await viewer.middleOf(second.page), [120, 20]);
      await sleep(500);
      errors.push(...second.errors);
    } finally {
      await second.context.close();
    }
  },
  open: () => oneOf([() => open("frame.stl", plateStl), () => open("plate_and_cube.obj", plateAndCube)])(),
  savePicture: () => save("#save-picture"),
  saveScene: () => save("#save-scene"),
  reconnect: async () => {
    const status = () => page.locator("#status").textContent();
    line.cut();
    await viewer.until("no connection", async () => (await status()) === "no connection");
    await line.mend();
    await viewer.until("connected", async () => (await status()) === "connected");
  },
};
// What costs much or changes the model comes less often.
const rare = new Set(["secondPage", "open", "reconnect", "savePicture", "saveScene", "size"]);
const schedule = Object.keys(actions).flatMap((name) => (rare.has(name) ? [name] : [name, name, name]));

const residentBytes = () => {
  const status = fs.readFileSync(`/proc/${server.pid}/status`, "utf8");
  return Number(/VmRSS:\s+(\d+)/.exec(status)[1]) * 1024;
};
const heapBytes = async () => {
  const { usedSize } = await devtools.send("Runtime.getHeapUsage");
  return usedSize;
};
const megabytes = (bytes) => `${(bytes / 1e6).toFixed(0)} MB`;
const mean = (values) => values.reduce((sum, x) => sum + x, 0) / Math.max(values.length, 1);

const begin = Date.now();
const samples = [];
const counts = {};
const problems = [];
let frames = 0;
const failedActions = [];

const sampling = setInterval(() => {
  if (!server.hasEnded()) samples.push({ at: Date.now() - begin, bytes: residentBytes() });
}, SAMPLE_MS);

async function report() {
  const fresh = traffic.order.filter(({ picture }) => picture !== undefined).length;
  frames += fresh;
  const done = Object.values(counts).reduce((sum, x) => sum + x, 0);
  const at = `${Math.round((Date.now() - begin) / 1000)} s`;
  const memory = `server ${megabytes(residentBytes())}, page ${megabytes(await heapBytes())}`;
  const failed = failedActions.length > 0 ? `, ${failedActions.length} actions not done` : "";
  console.log(`${at}: ${memory}, ${frames} frames, ${done} actions, ${errors.length} errors${failed}`);
  if (fresh === 0) problems.push(`no frame came between ${at} and 30 s before`);
  // What the tests keep for their checks would grow for hours here.
  for (const list of Object.values(traffic)) list.length = 0;
}

let reported = begin;
while (Date.now() - begin < lasting && !server.hasEnded() && errors.length === 0) {
  const name = oneOf(schedule);
  try {
    await Promise.race([actions[name](), sleep(ACTION_MS).then(() => Promise.reject(new Error("took too long")))]);
    counts[name] = (counts[name] ?? 0) + 1;
  } catch (error) {
    failedActions.push(`${name}: ${String(error.message).split("\n")[0]}`);
    console.log(failedActions.at(-1));
  }
  await sleep(random(50, 400));
  if (Date.now() - reported >= REPORT_MS && !server.hasEnded()) {
    reported = Date.now();
    await report();
  }
}
clearInterval(sampling);

const settled = samples.filter(({ at }) => at > lasting * SETTLING_PART).map(({ bytes }) => bytes);
const third = Math.floor(settled.length / 3);
const first = mean(settled.slice(0, third));
const last = mean(settled.slice(-third));
if (server.hasEnded()) problems.push(`the server ended: ${server.output().slice(-2000)}`);
if (minutes >= JUDGED_MINUTES && last > first * GROWTH + GROWTH_BYTES) problems.push("the server's memory grows");
problems.push(...errors.map((error) => `in the page: ${error}`));
if (failedActions.length > 0.05 * Object.values(counts).reduce((sum, x) => sum + x, 0) + 1) {
  problems.push(`${failedActions.length} actions could not be done`);
}
console.log(`memory of the server: ${megabytes(first)} in the first third, ${megabytes(last)} in the last`);
console.log(Object.entries(counts).map(([name, count]) => `${name} ${count}`).join(", "));
for (const problem of problems) console.log(`PROBLEM ${problem}`);
await context.close();
await viewer.closeBrowser();
line.cut();
if (!server.hasEnded()) await server.stop();
process.exit(problems.length > 0 ? 1 : 0);
