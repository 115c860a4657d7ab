// move.js — picks objects under the pointer, and moves them in the picture plane.

import { add, dot, subtract } from "./vector.js";

// Parts of the picture's height that an arrow key moves.
const STEP = 0.01;

export class Move {
  #session;
  #objects;
  #view;
  #picture;
  #messages;
  #waiting = new Map();
  #drag = null;

  /** `view.camera` is the camera as it is now. */
  constructor({ session, objects, view, picture, messages, connection }) {
    this.#session = session;
    this.#objects = objects;
    this.#view = view;
    this.#picture = picture;
    this.#messages = messages;
    connection.addEventListener("picked", ({ detail }) => {
      this.#waiting.get(detail.seq)?.(detail);
      this.#waiting.delete(detail.seq);
    });
    connection.addEventListener("status", () => this.#waiting.clear());
  }

  /** Asks what is at a place on the page; `answer` gets the protocol's `picked`. */
  pick(x, y, answer) {
    const seq = this.#session.send("pick", { at: this.#picture.pixelAt(x, y) });
    // A newer question replaces the older, which may never be answered.
    this.#waiting.clear();
    this.#waiting.set(seq, answer);
  }

  begin(x, y) {
    const drag = { right: 0, down: 0, object: null };
    this.#drag = drag;
    this.pick(x, y, ({ id, position }) => {
      const object = this.#session.object(id);
      if (!object) {
        this.#messages.info("Nothing to move there", "Begin on an object.");
        return;
      }
      if (this.#objects.chosen?.id !== id) this.#objects.choose(id);
      const camera = this.#view.camera;
      drag.depth = dot(subtract(position, camera.position), camera.forward);
      drag.object = { id, matrix: object.matrix, center: object.center };
      this.#apply(drag);
    });
  }

  /** In picture heights; what comes before the answer is made up for. */
  by(right, down) {
    if (!this.#drag) return;
    this.#drag.right += right;
    this.#drag.down += down;
    this.#apply(this.#drag);
  }

  end() {
    this.#drag = null;
  }

  /** The chosen object by steps in the picture. */
  step(right, down) {
    const object = this.#objects.chosen;
    if (!object) {
      this.#messages.info("No object is selected", "Click one in the picture or in the list.");
      return;
    }
    const camera = this.#view.camera;
    const depth = dot(subtract(object.center, camera.position), camera.forward);
    this.#objects.move(object.id, object, camera.inPicturePlane(right * STEP, down * STEP, depth));
  }

  #apply({ object, right, down, depth }) {
    if (object) this.#objects.move(object.id, object, this.#view.camera.inPicturePlane(right, down, depth));
  }
}

const EDGES = [
  [0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7],
];

/** Draws the box about an object over the picture, as `camera` sees it; nothing without an object. */
export function drawBox(canvas, picture, camera, object) {
  const ratio = window.devicePixelRatio || 1;
  const area = canvas.getBoundingClientRect();
  // Also clears it.
  canvas.width = Math.max(Math.round(area.width * ratio), 1);
  canvas.height = Math.max(Math.round(area.height * ratio), 1);
  if (!object || !camera) return;
  const { left, top, width, height } = picture.rectangle;
  const corners = [...Array(8).keys()].map((at) => {
    const half = object.size.map((size, axis) => ((at >> axis) & 1 ? size / 2 : -size / 2));
    const seen = camera.project(add(object.center, half));
    return seen && [
      (left - area.left + width / 2 + seen[0] * height) * ratio,
      (top - area.top + height / 2 + seen[1] * height) * ratio,
    ];
  });
  const context = canvas.getContext("2d");
  context.beginPath();
  for (const [from, to] of EDGES) {
    if (!corners[from] || !corners[to]) continue;
    context.moveTo(...corners[from]);
    context.lineTo(...corners[to]);
  }
  // Light on dark, to be seen on any picture.
  for (const [color, lineWidth] of [["rgb(10 20 35 / 55%)", 3], ["#8fc1ff", 1.25]]) {
    context.strokeStyle = color;
    context.lineWidth = lineWidth * ratio;
    context.stroke();
  }
}
