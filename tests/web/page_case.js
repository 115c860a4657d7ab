// page_case.js — a test with a server and a page of its own
import assert from "node:assert/strict";
import { test } from "node:test";
import { plateAndCube } from "./models.js";
import * as viewer from "./viewer.js";

export const model = viewer.writeModel("plate_and_cube.obj", plateAndCube);

/**
 * No script of the page may fail. `of`: the page's size and such, for viewer.openPage; `file` and `options` are the
 * server's.
 */
export function pageTest(name, { file = model, options = [], ...of }, body) {
  test(name, { timeout: 4 * viewer.PATIENCE_MS }, async () => {
    const server = await viewer.startServer(file, { options });
    const opened = await viewer.openPage(server.url, of);
    try {
      await viewer.firstFrame(opened.page);
      await body({ ...opened, server });
      assert.deepEqual(opened.errors, []);
    } catch (error) {
      await viewer.screenshot(opened.page, `failed ${name}`.replace(/\W+/g, "_")).catch(() => {});
      throw error;
    } finally {
      await opened.context.close();
      await server.stop();
    }
  });
}

export const scenes = (traffic) => traffic.received.filter(({ type }) => type === "scene");
export const sentOf = (traffic, wanted) => traffic.sent.filter(({ type }) => type === wanted);
