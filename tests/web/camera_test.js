// camera_test.js — the camera's maths, without a browser.
import assert from "node:assert/strict";
import test from "node:test";
import { Camera, upAxis } from "../../web/camera.js";
import { add, cross, dot, length, normalize, scale, subtract } from "../../web/vector.js";

function near(actual, expected, tolerance = 1e-9) {
  const difference = Array.isArray(expected) ? length(subtract(actual, expected)) : Math.abs(actual - expected);
  assert.ok(difference <= tolerance, `${JSON.stringify(actual)} is not ${JSON.stringify(expected)}`);
}

function threeQuarter() {
  const camera = new Camera();
  camera.set({ position: [3, -4, 2.5], target: [0.2, 0.1, 0.3], up: [0, 0, 1], fov: 35 });
  return camera;
}

/** Numbers in [0, 1) that are the same each time. */
function randomNumbers(seed) {
  return () => (seed = (seed * 1103515245 + 12345) % 2147483648) / 2147483648;
}

test("gives back the view that it was given", () => {
  const camera = threeQuarter();
  near(camera.position, [3, -4, 2.5]);
  near(camera.target, [0.2, 0.1, 0.3]);
  near(dot(camera.up, camera.forward), 0);
  near(dot(camera.right, camera.axis), 0);
  assert.ok(dot(camera.up, [0, 0, 1]) > 0);
});

test("gives back rolled and polar views", () => {
  const random = randomNumbers(7);
  const views = [
    { position: [0, 0, 5], target: [0, 0, 0], up: [0, 1, 0], fov: 30 },
    { position: [0, 0, -5], target: [0, 0, 0], up: [0.6, 0.8, 0], fov: 30 },
  ];
  for (let i = 0; i < 50; ++i) {
    const sight = normalize([random() - 0.5, random() - 0.5, random() - 0.5]);
    const side = normalize(cross(sight, [random(), random(), random()]));
    views.push({ position: scale(sight, 3), target: [0, 0, 0], up: cross(side, scale(sight, -1)), fov: 20 });
  }
  for (const view of views) {
    for (const axis of [[0, 0, 1], [0, 1, 0]]) {
      const camera = new Camera(axis);
      camera.set(view);
      near(camera.position, view.position, 1e-6);
      near(camera.up, view.up, 1e-6);
    }
  }
});

test("keeps distance, level and a right-handed frame while it orbits", () => {
  const camera = threeQuarter();
  const distance = camera.distance;
  const random = randomNumbers(3);
  for (let i = 0; i < 1000; ++i) {
    camera.orbit(random() - 0.5, random() - 0.5);
    near(length(subtract(camera.position, camera.target)), distance, 1e-9);
    near(dot(camera.right, camera.axis), 0);
    near(cross(camera.right, camera.forward), camera.up);
    assert.ok(dot(camera.up, camera.axis) >= -1e-12, "upside down");
  }
});

test("stops at the poles and comes back on the same side", () => {
  const camera = threeQuarter();
  const right = camera.right;
  for (let i = 0; i < 100; ++i) camera.orbit(0, 0.1);
  near(camera.forward, [0, 0, -1], 1e-9);
  near(camera.right, right, 1e-9);
  camera.orbit(0, -0.5);
  near(camera.right, right, 1e-9);
  for (let i = 0; i < 100; ++i) camera.orbit(0, -0.1);
  near(camera.forward, [0, 0, 1], 1e-9);
});

test("turns on from a view from above without a jump", () => {
  const camera = new Camera();
  camera.set({ position: [0, 0, 5], target: [0, 0, 0], up: [0, 1, 0], fov: 30 });
  const before = camera.up;
  camera.orbit(1e-4, -1e-4);
  near(camera.up, before, 1e-3);
});

test("orbiting to the right moves the front of the model to the right", () => {
  for (const roll of [0, 0.7, -2]) {
    const camera = threeQuarter();
    camera.rollBy(roll);
    const front = subtract(camera.target, scale(camera.forward, 0.2));
    camera.orbit(0.05, 0);
    const seen = camera.project(front);
    assert.ok(seen[0] > 0 && Math.abs(seen[1]) < seen[0] / 4, `roll ${roll}: ${seen}`);
    camera.orbit(-0.05, 0);
    camera.orbit(0, 0.05);
    const below = camera.project(front);
    assert.ok(below[1] > 0 && Math.abs(below[0]) < below[1] / 4, `roll ${roll}: ${below}`);
  }
});

test("the centre follows the hand exactly while panning", () => {
  for (const roll of [0, 1]) {
    const camera = threeQuarter();
    camera.rollBy(roll);
    const point = camera.target;
    camera.pan(0.13, -0.21);
    near(camera.project(point)[0], 0.13);
    near(camera.project(point)[1], -0.21);
  }
});

test("zooms towards the centre by the factor, within limits", () => {
  const camera = threeQuarter();
  const { target, distance } = camera;
  camera.zoom(2);
  near(camera.target, target);
  near(camera.distance, distance / 2);
  camera.setLimits({ lower: [-1, -1, -1], upper: [1, 1, 1] });
  for (let i = 0; i < 1000; ++i) camera.zoom(2);
  assert.ok(camera.distance > 0);
  for (let i = 0; i < 2000; ++i) camera.zoom(0.5);
  assert.ok(Number.isFinite(camera.distance));
});

test("zooms about the place under the pointer", () => {
  const camera = threeQuarter();
  const point = add(camera.target, camera.inPicturePlane(0.3, 0.2));
  camera.zoom(1.7, [0.3, 0.2]);
  near(camera.project(point)[0], 0.3);
  near(camera.project(point)[1], 0.2);
});

test("a new centre comes to the middle at its own size", () => {
  const camera = threeQuarter();
  const point = [0.5, -0.3, 0.8];
  const forward = camera.forward;
  const depth = dot(subtract(point, camera.position), forward);
  camera.centreOn(point);
  near(camera.project(point)[0], 0);
  near(camera.project(point)[1], 0);
  near(camera.forward, forward);
  near(camera.distance, depth);
});

test("parallel projection keeps the centre's size and comes back", () => {
  const camera = threeQuarter();
  const { distance, fov } = camera;
  const height = camera.heightAt();
  camera.toggleParallel();
  assert.ok(camera.isParallel);
  near(camera.heightAt(), height);
  camera.toggleParallel();
  near(camera.distance, distance);
  near(camera.fov, fov);
});

test("frames a sphere in wide and tall pictures", () => {
  for (const aspect of [16 / 9, 390 / 844]) {
    const camera = threeQuarter();
    camera.frameSphere([1, 2, 3], 0.5, aspect);
    for (const direction of [camera.up, camera.right]) {
      const seen = camera.project(add([1, 2, 3], scale(direction, 0.5)));
      assert.ok(Math.abs(seen[0]) < aspect / 2 && Math.abs(seen[1]) < 0.5, `${aspect}: ${seen}`);
    }
  }
});

test("leaves out what lies behind the eye", () => {
  const camera = threeQuarter();
  assert.equal(camera.project(add(camera.position, scale(camera.forward, -1))), null);
});

test("keeps its view when it is given one that can't be", () => {
  const camera = threeQuarter();
  const before = camera.get();
  camera.set({ position: [1, 1, 1], target: [1, 1, 1], up: [0, 0, 1], fov: 35 });
  camera.set({ position: [1, 1, 1], target: [2, 1, 1], up: [0, 0, 0], fov: 35 });
  assert.deepEqual(camera.get(), before);
});

test("a clone goes its own way", () => {
  const camera = threeQuarter();
  const copy = camera.clone();
  copy.orbit(1, 0.2);
  copy.pan(1, 1);
  near(camera.position, [3, -4, 2.5]);
  near(camera.target, [0.2, 0.1, 0.3]);
});

test("takes the up axis from the scene, or else from its first camera", () => {
  assert.deepEqual(upAxis({ up: [0, 2, 0], camera: { up: [0, 0, 1] } }), [0, 1, 0]);
  assert.deepEqual(upAxis({ camera: { up: [0.01, 0.02, 0.999] } }), [0, 0, 1]);
  near(upAxis({ up: [1, 1, 0] }), [Math.SQRT1_2, Math.SQRT1_2, 0]);
});
