// view_test.js — the viewer's page in a real browser: what people do with it.
import assert from "node:assert/strict";
import fs from "node:fs";
import { after, before } from "node:test";
import { plateStl } from "./models.js";
import { pageTest, scenes, sentOf } from "./page_case.js";
import * as viewer from "./viewer.js";

before(viewer.launchBrowser);
after(viewer.closeBrowser);

pageTest("draws a picture that is not empty", {}, async ({ page }) => {
  assert.ok(viewer.deviation(await viewer.pictureOf(page)) > 5);
  assert.equal(await page.locator("#model-name").textContent(), "plate_and_cube.obj");
  assert.equal(await page.locator("#status").textContent(), "connected");
  await viewer.until("figures", async () => (await page.locator("#stat-integrator").textContent()) !== "–");
});

pageTest("orbit, pan, zoom and roll change the picture", {}, async ({ page, traffic }) => {
  const gestures = [
    ["orbit", () => viewer.middleOf(page).then((at) => viewer.drag(page, at, [120, 30]))],
    ["pan", () => viewer.middleOf(page).then((at) => viewer.drag(page, at, [80, -60], { button: "middle" }))],
    ["zoom", () => viewer.middleOf(page).then((at) => viewer.drag(page, at, [0, -80], { button: "right" }))],
    ["wheel", () => page.mouse.wheel(0, 400)],
    [
      "roll",
      async () => {
        const [x, y] = await viewer.middleOf(page);
        await page.keyboard.down("Control");
        await viewer.drag(page, [x + 100, y], [0, 90]);
        await page.keyboard.up("Control");
      },
    ],
  ];
  for (const [name, act] of gestures) {
    const before = await viewer.pictureOf(page);
    const sent = sentOf(traffic, "camera").length;
    await act();
    await viewer.until(`cameras sent by ${name}`, () => sentOf(traffic, "camera").length > sent);
    await viewer.shown(page, traffic);
    const change = viewer.difference(before, await viewer.pictureOf(page));
    assert.ok(change > 1.5, `${name} changed the picture by ${change} only`);
  }
});

pageTest("the radius slider changes the picture while it is dragged", {}, async ({ page, traffic }) => {
  await viewer.settled(page, traffic);
  const before = await viewer.pictureOf(page);
  const box = await page.locator("#radius-slider").boundingBox();
  await page.mouse.move(box.x + box.width * 0.2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.9, box.y + box.height / 2, { steps: 10 });
  await viewer.until("radii sent", () => sentOf(traffic, "rounding").length > 1);
  await viewer.settled(page, traffic);
  const change = viewer.difference(before, await viewer.pictureOf(page));
  assert.ok(change > 0.5, `changed by ${change} only`);
  await page.mouse.up();
  assert.ok(Number(await page.locator("#radius").inputValue()) > 0.5);

  await page.locator("#radius").fill("8%");
  await page.locator("#radius").press("Enter");
  await viewer.until("a radius in percent", () => sentOf(traffic, "rounding").at(-1).radius === "8%");
  await page.locator("#radius-auto").click();
  await viewer.until("automatic again", () => sentOf(traffic, "rounding").at(-1).radius === "auto");
  await viewer.shown(page, traffic);
});

pageTest("a split view differs left and right of its line", {}, async ({ page, traffic }) => {
  await page.locator("#radius").fill("1.4");
  await page.locator("#radius").press("Enter");
  await page.locator("#compare").selectOption("none");
  await page.locator("#split").waitFor();
  await viewer.settled(page, traffic);
  const half = await viewer.pictureOf(page);
  await viewer.screenshot(page, "split");
  // To the right end by hand: then all is rounded.
  const { width } = await page.locator("#stage").boundingBox();
  await viewer.drag(page, await viewer.middleOf(page, "#split"), [width, 0]);
  await viewer.settled(page, traffic);
  const whole = await viewer.pictureOf(page);
  const left = viewer.difference(half, whole, 0, 0.48);
  const right = viewer.difference(half, whole, 0.52, 1);
  assert.ok(right > 2 * left + 0.2, `left ${left}, right ${right}`);
  assert.equal(await page.locator("#split").getAttribute("aria-valuenow"), "100");
});

pageTest("click selects an object, and dragging with Alt moves it", {}, async ({ page, traffic }) => {
  await page.keyboard.press("7");
  const isTop = ({ type, direction }) => type === "frame_view" && direction === "top";
  await viewer.until("the view from above", () => traffic.sent.some(isTop));
  await viewer.shown(page, traffic);
  const { left, top, height } = await page.locator("#picture").evaluate((canvas) => {
    const area = canvas.getBoundingClientRect();
    return { left: area.left + area.width / 2, top: area.top + area.height / 2, height: area.height };
  });
  // The cube stands at the plate's lower left corner.
  const isAbove = ({ position, target }) => Math.hypot(position[0] - target[0], position[1] - target[1]) < 1e-6;
  const camera = await viewer.until("the camera above", () => {
    const newest = scenes(traffic).at(-1).camera;
    return isAbove(newest) && newest;
  });
  const depth = camera.position[2] - 8;
  const perUnit = height / (2 * depth * Math.tan((camera.fov * Math.PI) / 360));
  const cube = [left - 6.75 * perUnit, top + 6.75 * perUnit];
  await page.mouse.click(...cube);
  await viewer.until("the cube is selected", async () => (await page.locator("#object-name").textContent()) === "cube");
  await page.locator("#object-details").waitFor();
  await viewer.screenshot(page, "chosen");

  const cameras = sentOf(traffic, "camera").length;
  await page.mouse.dblclick(...cube);
  await viewer.until("another centre", () => sentOf(traffic, "camera").length > cameras);
  const { target } = sentOf(traffic, "camera").at(-1);
  assert.ok(Math.hypot(target[0] + 6.75, target[1] + 6.75, target[2] - 8) < 0.5, `centre ${target}`);
  const framed = sentOf(traffic, "frame_view").length;
  await page.keyboard.press("7");
  await viewer.until("the view from above again", () => sentOf(traffic, "frame_view").length > framed);
  await viewer.shown(page, traffic);

  const before = await viewer.pictureOf(page);
  await page.keyboard.down("Alt");
  await page.mouse.move(...cube);
  await page.mouse.down();
  await page.mouse.move(cube[0] + 4 * perUnit, cube[1], { steps: 5 });
  await viewer.until("a move", () => sentOf(traffic, "object").length > 0);
  await page.mouse.up();
  await page.keyboard.up("Alt");
  await viewer.shown(page, traffic);
  const { matrix } = sentOf(traffic, "object").at(-1);
  assert.ok(Math.abs(matrix[0][3] - 4) < 0.3, `moved by ${matrix[0][3]}`);
  assert.ok(viewer.difference(before, await viewer.pictureOf(page)) > 0.5);

  // The file knows where it was, also after the page has been loaded again.
  traffic.sent.length = 0;
  await page.reload();
  await viewer.firstFrame(page);
  await page.locator("#objects-section summary").click();
  await page.locator("#object-list .name", { hasText: "cube" }).click();
  await page.locator("#object-back").click();
  await viewer.until("put back", () => sentOf(traffic, "object").at(-1)?.matrix[0][3] === 0);
  await viewer.shown(page, traffic);
});

pageTest("objects can be hidden and isolated", {}, async ({ page, traffic }) => {
  await page.locator("#objects-section summary").click();
  await page.getByRole("button", { name: "Hide cube" }).click();
  await viewer.until("hidden", () => scenes(traffic).at(-1)?.objects.some(({ visible }) => !visible));
  await page.locator("#show-all").click();
  await viewer.until("shown", () => scenes(traffic).at(-1).objects.every(({ visible }) => visible));
  await page.locator("#object-list .name", { hasText: "cube" }).click();
  await page.locator("#object-isolate").click();
  await viewer.until("isolated", () => {
    const objects = scenes(traffic).at(-1).objects;
    return objects.length > 1 && objects.every(({ name, visible }) => visible === (name === "cube"));
  });
  await page.locator("#object-isolate").click();
  await viewer.until("all again", () => scenes(traffic).at(-1).objects.every(({ visible }) => visible));
  await viewer.shown(page, traffic);
});

pageTest("light, material, ground and overlay change the picture", {}, async ({ page, traffic }) => {
  const changes = [
    ["lighting", () => page.locator("#lighting input[value=sky]").check()],
    ["material", () => page.locator("#material").selectOption({ index: 1 })],
    ["ground", () => page.locator("#ground").click()],
    ["overlay", () => page.keyboard.press("e")],
  ];
  for (const [name, act] of changes) {
    const before = await viewer.pictureOf(page);
    const sent = traffic.sent.filter(({ type }) => type !== "ack").length;
    await act();
    await viewer.until(`${name} sent`, () => traffic.sent.filter(({ type }) => type !== "ack").length > sent);
    await viewer.shown(page, traffic);
    const change = viewer.difference(before, await viewer.pictureOf(page));
    assert.ok(change > 0.5, `${name} changed the picture by ${change} only`);
  }
});

pageTest("saves the picture and the scene", {}, async ({ page }) => {
  for (const [button, ending, begin] of [
    ["#save-picture", ".png", "\x89PNG"],
    ["#save-scene", ".toml", ""],
  ]) {
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator(button).click()]);
    assert.equal(download.suggestedFilename(), `plate_and_cube${ending}`);
    const bytes = fs.readFileSync(await download.path());
    assert.ok(bytes.length > 100);
    assert.ok(bytes.toString("latin1").startsWith(begin));
  }
});

pageTest("makes a beam picture and shows it", {}, async ({ page }) => {
  await page.locator("#beam-start").click();
  await page.locator("#beam-show").click();
  const picture = page.locator("#beam-picture");
  await viewer.until("the beam picture", () => picture.evaluate((image) => image.complete && image.naturalWidth > 60));
  await viewer.screenshot(page, "beam");
  await page.getByRole("button", { name: "Close" }).click();
  await picture.waitFor({ state: "hidden" });
});

pageTest("200 rapid inputs build no queue", {}, async ({ page, traffic }) => {
  const [x, y] = await viewer.middleOf(page);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 200, y + 20, { steps: 200 });
  await page.mouse.up();
  await viewer.until("cameras", () => sentOf(traffic, "camera").length > 0);
  await viewer.shown(page, traffic);
  const late = viewer.latePictures(traffic);
  assert.ok(late <= 3, `${late} pictures came before the newest`);
  assert.ok(sentOf(traffic, "camera").length <= 202);

  // All within one frame of the browser: one message.
  const sent = sentOf(traffic, "camera").length;
  await page.evaluate(() => {
    const press = () => document.body.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true }));
    for (let i = 0; i < 200; ++i) press();
  });
  await viewer.until("a camera", () => sentOf(traffic, "camera").length > sent);
  await viewer.shown(page, traffic);
  assert.ok(sentOf(traffic, "camera").length - sent <= 2);
});

pageTest("can be used with the keyboard alone", {}, async ({ page, traffic }) => {
  const focused = () => page.evaluate(() => document.activeElement.id);
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press("Tab");
  assert.equal(await focused(), "picture");
  const before = await viewer.pictureOf(page);
  for (let i = 0; i < 6; ++i) await page.keyboard.press("ArrowRight");
  await page.keyboard.press("+");
  await viewer.until("cameras", () => sentOf(traffic, "camera").length > 0);
  await viewer.shown(page, traffic);
  assert.ok(viewer.difference(before, await viewer.pictureOf(page)) > 1.5);

  for (let i = 0; (await focused()) !== "radius-slider"; ++i) {
    assert.ok(i < 20, "the radius is out of reach of the tabulator");
    await page.keyboard.press("Tab");
  }
  await page.keyboard.press("ArrowRight");
  await viewer.until("a radius", () => typeof sentOf(traffic, "rounding").at(-1)?.radius === "number");
  for (const [opens, closes] of [["h", "h"], ["?", "?"], ["H", "Escape"]]) {
    await page.keyboard.press(opens);
    await page.locator("#help").waitFor();
    if (closes === "Escape") await viewer.screenshot(page, "help");
    await page.keyboard.press(closes);
    await page.locator("#help").waitFor({ state: "hidden" });
  }
});

/** Roles whose elements one acts on, as a screen reader is told of them. */
const CONTROLS = /^\s*- '?(button|checkbox|radio|slider|textbox|searchbox|spinbutton|combobox|progressbar)\b(.*)$/;

pageTest("a screen reader is told the name of every control", {}, async ({ page }) => {
  await page.evaluate(() => document.querySelectorAll("details").forEach((section) => (section.open = true)));
  await page.locator("#compare").selectOption("none");
  await page.locator("#split").waitFor();
  await page.locator("#object-list .name").first().click();
  const snapshot = await page.locator("body").ariaSnapshot();
  const controls = snapshot.split("\n").filter((line) => CONTROLS.test(line));
  assert.ok(controls.length > 35, snapshot);
  for (const line of controls) assert.match(line, /^\s*- '?\w+ "[^"]+"/, "a control without a name");
  for (const part of ["slider \"Radius, slider\"", "button \"Save picture\"", "complementary \"Settings\"", "main"]) {
    assert.ok(snapshot.includes(part), `${part} is missing in\n${snapshot}`);
  }
  // Names tell things apart.
  const names = controls.map((line) => line.trim().replace(/( \[[\w=]+\])*:?.*$/, (rest) => rest.split(":")[0]));
  const doubled = names.filter((name, at) => names.indexOf(name) !== at);
  assert.deepEqual(doubled, []);
});

pageTest("every control has a name", {}, async ({ page }) => {
  await page.evaluate(() => document.querySelectorAll("details").forEach((section) => (section.open = true)));
  const unnamed = await page.evaluate(() =>
    [...document.querySelectorAll("button, input, select, [role=slider], progress")]
      .filter((element) => element.type !== "file" && element.checkVisibility())
      .filter((element) => !element.labels?.length && !element.ariaLabel && !element.textContent.trim())
      .map((element) => element.outerHTML),
  );
  assert.deepEqual(unnamed, []);
});

pageTest("Enter is the first view after a click on a button, and the button after the tabulator", {}, async (opened) => {
  const { page, traffic } = opened;
  const directions = () => sentOf(traffic, "frame_view").map(({ direction }) => direction);
  const top = page.locator("[data-view=top]");
  await top.click();
  await viewer.until("the view from above", () => directions().at(-1) === "top");
  await page.keyboard.press("Enter");
  await viewer.until("the first view", () => directions().at(-1) === "first");
  await top.focus();
  await page.keyboard.press("Enter");
  await viewer.until("the button", () => directions().at(-1) === "top");
  await page.locator("#help-button").click();
  await page.getByRole("button", { name: "Close" }).click();
  await page.keyboard.press("Enter");
  await viewer.until("the first view again", () => directions().at(-1) === "first");
});

pageTest("an error goes when a value that fits was given", {}, async ({ page, traffic }) => {
  const enter = async (radius) => {
    await page.locator("#radius").fill(radius);
    await page.locator("#radius").press("Enter");
  };
  const errors = page.locator(".message.error");
  await enter("999");
  await errors.filter({ hasText: "999" }).waitFor();
  await enter("998");
  await errors.filter({ hasText: "998" }).waitFor();
  assert.equal(await errors.count(), 1);
  await enter("0.5");
  await errors.waitFor({ state: "detached" });
  await enter("0");
  await viewer.until("sharp edges", () => scenes(traffic).at(-1).rounding.method === "none");
  await viewer.until("None", () => page.locator("#method input[value=none]").isChecked());
  const box = await page.locator("#radius-slider").boundingBox();
  await page.mouse.click(box.x + box.width - 2, box.y + box.height / 2);
  await viewer.until("rounded again", () => scenes(traffic).at(-1).rounding.method === "exact");
  await viewer.shown(page, traffic);
  const { rounding, radius_limit: limit } = scenes(traffic).at(-1);
  assert.ok(rounding.radius < limit && rounding.radius > 0.9 * limit, `${rounding.radius} of ${limit}`);
  assert.equal(await errors.count(), 0);
});

pageTest("4 and 6 roll the camera as in F3D", {}, async ({ page, traffic }) => {
  const dot = (a, b) => a.reduce((sum, x, at) => sum + x * b[at], 0);
  const { up, position, target } = scenes(traffic).at(-1).camera;
  const forward = position.map((x, at) => target[at] - x);
  const right = [0, 1, 2].map((at) => {
    const [b, c] = [(at + 1) % 3, (at + 2) % 3];
    return forward[b] * up[c] - forward[c] * up[b];
  });
  for (const [key, isLeft] of [["4", true], ["6", false], ["6", false]]) {
    const sent = sentOf(traffic, "camera").length;
    await page.keyboard.press(key);
    await viewer.until("a camera", () => sentOf(traffic, "camera").length > sent);
    const along = dot(sentOf(traffic, "camera").at(-1).up, right) / Math.hypot(...right);
    const turned = Math.abs(along) > 0.9 ? along < 0 : null;
    assert.equal(turned, sent === 1 ? null : isLeft);
  }
});

pageTest("a number that is out of range is said to be, and replaced", {}, async ({ page, traffic }) => {
  for (const [id, typed] of [["strength", "-1"], ["rotation", "9999"], ["min-angle", "200"]]) {
    const field = page.locator(`#${id}`);
    const before = await field.inputValue();
    const sent = traffic.sent.filter(({ seq }) => seq).length;
    await field.fill(typed);
    await field.press("Enter");
    assert.notEqual(await field.evaluate((input) => input.validationMessage), "");
    await field.blur();
    assert.equal(await field.inputValue(), before);
    assert.equal(traffic.sent.filter(({ seq }) => seq).length, sent);
  }
});

pageTest("the light can be rotated where that is seen", {}, async ({ page }) => {
  assert.ok(await page.locator("#rotation-slider").isEnabled());
  await page.locator("#lighting input[value=white]").check();
  await page.locator("#rotation-note", { hasText: "from all sides alike" }).waitFor();
  assert.ok(await page.locator("#rotation-slider").isDisabled());
  assert.ok(await page.locator("#rotation").isDisabled());
});

for (const width of [800, 1000, 1090, 1130]) {
  pageTest(`nothing lies on the figures at ${width}`, { width, height: 600 }, async ({ page }) => {
    await page.locator("#hint").waitFor();
    const bottom = async (selector) => {
      const box = await page.locator(selector).boundingBox();
      return box.y + box.height;
    };
    await viewer.until("figures", async () => (await page.locator("#stat-integrator").textContent()) !== "–");
    const top = (await page.locator("#stats").boundingBox()).y;
    assert.ok((await bottom("#hint")) <= top);
    await page.keyboard.press("e");
    await page.locator("#legend").waitFor();
    assert.ok((await bottom("#legend")) <= top);
    await page.keyboard.press("e");
    await viewer.drop(page, "frame.stl", plateStl);
    await page.locator(".message.error").waitFor();
    assert.ok((await bottom("#messages")) <= top);
  });
}

pageTest("there is no dark square before the first picture, and no motion where none is wanted", {
  reducedMotion: "reduce",
}, async ({ page }) => {
  const shown = await page.evaluate(() => {
    document.getElementById("stage").classList.add("stale");
    document.getElementById("picture").removeAttribute("data-frame");
    document.getElementById("busy").hidden = false;
    const style = (selector) => getComputedStyle(document.querySelector(selector));
    return [style("#picture").opacity, style(".spinner").animationName];
  });
  assert.deepEqual(shown, ["0", "none"]);
});

pageTest("the overlay says what its colours mean", {}, async ({ page }) => {
  await page.locator("#hint", { hasText: "Drag to turn" }).waitFor();
  assert.ok(await page.locator("#legend").isHidden());
  await page.keyboard.press("e");
  await page.getByRole("region", { name: "What the overlay shows" }).waitFor();
  await viewer.until("figures of edges", async () => (await page.locator("#legend-edges").textContent()) !== "");
  await viewer.screenshot(page, "overlay");
  await page.keyboard.press("e");
  await page.locator("#legend").waitFor({ state: "hidden" });
  await viewer.drag(page, await viewer.middleOf(page), [60, 0]);
  await page.locator("#hint").waitFor({ state: "hidden" });
});

pageTest("at 200 % zoom nothing is cut off", { width: 640, height: 400, deviceScaleFactor: 2 }, async ({ page }) => {
  const cut = () =>
    page.evaluate(() =>
      [...document.querySelectorAll("button, input, select")]
        .filter((element) => element.type !== "file" && element.checkVisibility())
        .filter((element) => {
          const { left, right } = element.getBoundingClientRect();
          return left < 0 || right > window.innerWidth;
        })
        .map((element) => element.outerHTML),
    );
  assert.deepEqual(await cut(), []);
  await page.locator("#sheet-button").click();
  await page.locator("#lighting").waitFor();
  assert.deepEqual(await cut(), []);
  await page.locator("#save-scene").scrollIntoViewIfNeeded();
  await viewer.screenshot(page, "zoom-200");
  // The picture is still there beside the settings.
  assert.ok((await page.locator("#picture").boundingBox()).height > 100);
});

for (const [scheme, width, height] of [
  ["light", 1280, 800],
  ["dark", 1280, 800],
  ["light", 1920, 1080],
]) {
  const options = { width, height, colorScheme: scheme };
  pageTest(`looks right in ${scheme} at ${width}`, options, async ({ page, traffic }) => {
    await viewer.settled(page, traffic);
    await page.waitForFunction(() => document.documentElement.scrollWidth <= window.innerWidth);
    assert.ok(await page.locator("#save-picture").isVisible());
    await viewer.screenshot(page, `${scheme}-${width}`);
  });
}

const phone = { width: 390, height: 844, deviceScaleFactor: 2, hasTouch: true, isMobile: true };
pageTest("a phone shows all without overflow, and fingers turn the model", phone, async (opened) => {
  const { page, context, traffic } = opened;
  const overflow = () =>
    page.evaluate(() => ({
      page: document.documentElement.scrollWidth - window.innerWidth,
      panel: document.getElementById("panel").scrollWidth - document.getElementById("panel").clientWidth,
    }));
  assert.deepEqual(await overflow(), { page: 0, panel: 0 });
  assert.ok(await page.locator("#radius-slider").isVisible());
  const away = ({ camera: { position, target } }) => Math.hypot(...position.map((x, at) => x - target[at]));
  await viewer.until("the model fitted into the narrow picture", () => {
    const [first, ...later] = scenes(traffic);
    return later.length > 0 && later.at(-1).size[0] < later.at(-1).size[1] && away(later.at(-1)) > 1.3 * away(first);
  });
  await viewer.settled(page, traffic);
  await viewer.screenshot(page, "phone");
  await page.locator("#sheet-button").tap();
  await page.locator("#lighting").waitFor();
  assert.deepEqual(await overflow(), { page: 0, panel: 0 });
  await viewer.screenshot(page, "phone-settings");
  await page.locator("#sheet-button").tap();

  const touch = await context.newCDPSession(page);
  const fingers = (type, ...points) =>
    touch.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const before = await viewer.pictureOf(page);
  await fingers("touchStart", [150, 400]);
  for (let i = 1; i <= 6; ++i) await fingers("touchMove", [150 + 20 * i, 400]);
  await fingers("touchEnd");
  await viewer.until("cameras", () => sentOf(traffic, "camera").length > 0);
  await viewer.shown(page, traffic);
  const turned = await viewer.pictureOf(page);
  assert.ok(viewer.difference(before, turned) > 1.5);

  const sent = sentOf(traffic, "camera").length;
  const distance = ({ position, target }) => Math.hypot(...position.map((x, at) => x - target[at]));
  const far = distance(sentOf(traffic, "camera").at(-1));
  await fingers("touchStart", [180, 400]);
  await fingers("touchStart", [180, 400], [210, 400]);
  for (let i = 1; i <= 6; ++i) await fingers("touchMove", [180 - 10 * i, 400], [210 + 10 * i, 400]);
  await fingers("touchEnd");
  await viewer.until("nearer cameras", () => sentOf(traffic, "camera").length > sent);
  await viewer.shown(page, traffic);
  assert.ok(distance(sentOf(traffic, "camera").at(-1)) < 0.7 * far);
});
