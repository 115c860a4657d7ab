// pictures.js — makes the pictures of the viewer in docs/pictures: node tests/web/pictures.js [NAME…]
//
// They are taken when the picture of the model is done, or after ARRIS_SECONDS (60), whichever is first. `ARRIS` is the
// program, build/release/arris by default; ARRIS_SPP the samples of a pixel (32).
import path from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import * as viewer from "./viewer.js";

const model = path.join(viewer.root, "examples/models/keypad.obj");
const folder = path.join(viewer.root, "docs/pictures");
const quality = ["--spp", process.env.ARRIS_SPP ?? "32"];
const DONE_MS = Number(process.env.ARRIS_SECONDS ?? "60") * 1000;

const desktop = { width: 1280, height: 800 };
const phone = { width: 390, height: 844, deviceScaleFactor: 1.5, hasTouch: true, isMobile: true };

const pictures = {
  desktop: [desktop, () => {}],
  compare: [
    { width: 1100, height: 620 },
    async (page) => {
      await page.locator("#radius").fill("1.6");
      await page.locator("#radius").press("Enter");
      await page.locator("#compare").selectOption("none");
    },
  ],
  overlay: [{ width: 1100, height: 620 }, (page) => page.locator("#picture").press("e")],
  phone: [phone, () => {}],
};

/** Until it is done, as the overlay never is; its points are there after a while. */
async function finished(page, name) {
  const end = Date.now() + DONE_MS;
  const isDone = () => page.locator("#picture").evaluate(({ dataset }) => dataset.converged === "true");
  if (name === "overlay") await sleep(4000);
  else while (!(await isDone()) && Date.now() < end) await sleep(500);
}

async function make(name) {
  const [options, prepare] = pictures[name];
  const server = await viewer.startServer(model, { quality });
  const { page, context, traffic } = await viewer.openPage(server.url, { colorScheme: "light", ...options });
  try {
    await viewer.firstFrame(page);
    await page.evaluate(() => document.getElementById("hint").remove());
    await prepare(page);
    await viewer.shown(page, traffic);
    await page.evaluate(() => document.activeElement.blur());
    await finished(page, name);
    const file = path.join(folder, `view-${name}.jpg`);
    await page.screenshot({ path: file, type: "jpeg", quality: 85 });
    console.log(file);
  } finally {
    await context.close();
    await server.stop();
  }
}

await viewer.launchBrowser();
try {
  const wanted = process.argv.length > 2 ? process.argv.slice(2) : Object.keys(pictures);
  for (const name of wanted) await make(name);
} finally {
  await viewer.closeBrowser();
}
