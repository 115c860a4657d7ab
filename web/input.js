// input.js — mouse, pen and fingers over the picture, as actions on the view.
//
// Lengths are in picture heights, to the right and down. What each button does is a table for each preset, after
// F3D and Blender.

// A press that moves less is a click.
const CLICK_PX = 5;
// Two fingers that turn less than this only pinch and pan.
const ROLL_THRESHOLD = 0.15;
const WHEEL_LINE_PX = 33;

/** What a drag does: an action's name or null. `moving`: objects are moved instead of the view. */
export function dragAction(preset, { button, shiftKey, ctrlKey, metaKey, altKey }, moving = false) {
  const control = ctrlKey || metaKey;
  if (preset === "blender") {
    if (button === 1 || (button === 0 && altKey)) return shiftKey ? "pan" : control ? "zoom" : "orbit";
    if (button === 0 && moving) return "move";
    return null;
  }
  if (button === 0) {
    if (altKey || (moving && !shiftKey && !control)) return "move";
    return shiftKey ? "pan" : control ? "roll" : "orbit";
  }
  if (button === 1) return "pan";
  if (button === 2) return shiftKey ? "light" : control ? "zoomThere" : "zoom";
  return null;
}

/** What a click does. */
export function clickAction(preset, { button }) {
  if (button === 0) return "select";
  return button === 1 && preset === "f3d" ? "centre" : null;
}

export class Input {
  #pointers = new Map();
  #drag = null;
  #pinch = null;

  /**
   * `actions`: orbit(right, down), pan(right, down), zoom(factor, at), roll(angle), light(right), select(x, y),
   * centre(x, y), moveBegin(x, y), moveBy(right, down), moveEnd(), active(isActive); x and y on the page.
   * `settings`: preset, moving; read at each press.
   */
  constructor(canvas, picture, actions, settings) {
    Object.assign(this, { canvas, picture, actions, settings });
    canvas.addEventListener("pointerdown", (event) => this.#press(event));
    canvas.addEventListener("pointermove", (event) => this.#move(event));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
      canvas.addEventListener(end, (event) => this.#release(event));
    }
    canvas.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    // The browser's own middle button scrolls.
    canvas.addEventListener("mousedown", (event) => event.button === 1 && event.preventDefault());
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("dblclick", (event) => actions.centre(event.clientX, event.clientY));
  }

  #press(event) {
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(event.pointerId);
    this.#pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (event.pointerType === "touch" && this.#pointers.size === 2) {
      this.#endDrag(event);
      this.#pinch = { ...this.#spread(), turned: 0 };
      return;
    }
    if (this.#drag || this.#pinch) return;
    const { preset, moving } = this.settings;
    const touch = event.pointerType === "touch";
    this.#drag = {
      id: event.pointerId,
      action: dragAction(touch ? "f3d" : preset, event, moving),
      click: clickAction(touch ? "f3d" : preset, event),
      from: [event.clientX, event.clientY],
      last: [event.clientX, event.clientY],
      begun: false,
    };
  }

  #move(event) {
    if (!this.#pointers.has(event.pointerId)) return;
    this.#pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (this.#pinch) {
      this.#movePinch();
      return;
    }
    const drag = this.#drag;
    if (drag?.id !== event.pointerId) return;
    const place = [event.clientX, event.clientY];
    if (!drag.begun) {
      if (Math.hypot(place[0] - drag.from[0], place[1] - drag.from[1]) < CLICK_PX) return;
      drag.begun = true;
      if (drag.action) this.canvas.classList.add("dragging");
      this.actions.active(true);
      if (drag.action === "move") this.actions.moveBegin(...drag.from);
    }
    this.#dragTo(drag, place);
    drag.last = place;
  }

  #dragTo(drag, place) {
    const { width, height } = this.picture.rectangle;
    const right = (place[0] - drag.last[0]) / height;
    const down = (place[1] - drag.last[1]) / height;
    const actions = this.actions;
    switch (drag.action) {
      case "orbit": {
        // Half a turn for the picture's shorter side.
        const perHeight = (Math.PI * height) / Math.min(width, height);
        actions.orbit(right * perHeight, down * perHeight);
        break;
      }
      case "pan":
        actions.pan(right, down);
        break;
      case "zoom":
        actions.zoom(Math.exp(-4 * down));
        break;
      case "zoomThere":
        actions.zoom(Math.exp(-4 * down), this.picture.heightsAt(...drag.from));
        break;
      case "roll":
        actions.roll(this.#angleAt(drag.last) - this.#angleAt(place));
        break;
      case "light":
        actions.light(right);
        break;
      case "move":
        actions.moveBy(right, down);
        break;
    }
  }

  /** Of a place about the picture's middle. */
  #angleAt(place) {
    const [right, down] = this.picture.heightsAt(...place);
    return Math.atan2(down, right);
  }

  #release(event) {
    if (!this.#pointers.delete(event.pointerId)) return;
    if (this.#pinch) {
      // The finger that stays must not turn the model by where it happens to lie.
      if (this.#pointers.size === 0) {
        this.#pinch = null;
        this.actions.active(false);
      }
      return;
    }
    if (this.#drag?.id === event.pointerId) this.#endDrag(event);
  }

  #endDrag(event) {
    const drag = this.#drag;
    this.#drag = null;
    this.canvas.classList.remove("dragging");
    if (!drag) return;
    if (drag.begun) {
      if (drag.action === "move") this.actions.moveEnd();
      this.actions.active(false);
    } else if (event.type === "pointerup" && drag.click) {
      this.actions[drag.click](...drag.from);
    }
  }

  /** Where two fingers are: middle, distance, angle. */
  #spread() {
    const [a, b] = [...this.#pointers.values()];
    return {
      middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2],
      distance: Math.max(Math.hypot(b[0] - a[0], b[1] - a[1]), 1),
      angle: Math.atan2(b[1] - a[1], b[0] - a[0]),
    };
  }

  #movePinch() {
    if (this.#pointers.size !== 2) return;
    this.actions.active(true);
    const before = this.#pinch;
    const now = this.#spread();
    const { height } = this.picture.rectangle;
    this.actions.pan((now.middle[0] - before.middle[0]) / height, (now.middle[1] - before.middle[1]) / height);
    this.actions.zoom(now.distance / before.distance, this.picture.heightsAt(...now.middle));
    const angle = now.angle - before.angle;
    const turn = Math.atan2(Math.sin(angle), Math.cos(angle));
    const turned = before.turned + turn;
    if (Math.abs(turned) > ROLL_THRESHOLD) this.actions.roll(-turn);
    this.#pinch = { ...now, turned };
  }

  #wheel(event) {
    event.preventDefault();
    const pixels = event.deltaMode === 0 ? event.deltaY : event.deltaY * WHEEL_LINE_PX;
    // With the control key: towards the pointer. Browsers report pinching on a touchpad like this, in small steps.
    const there = event.ctrlKey || event.metaKey;
    const speed = there && Math.abs(pixels) < 40 ? 0.01 : 0.0015;
    const at = there ? this.picture.heightsAt(event.clientX, event.clientY) : undefined;
    this.actions.zoom(Math.exp(-pixels * speed), at);
  }
}
