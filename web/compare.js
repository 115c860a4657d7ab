// compare.js — the line in the picture, right of which the edges are rounded in another way.

const NAMES = { exact: "Exact", shader: "Bevel shader", mesh: "Bevel mesh", none: "Sharp edges" };
const STEP = 0.02;
const LARGE_STEP = 0.1;

/** Where a key on the line moves it to, or undefined. */
export function splitAfter(key, split) {
  const steps = {
    ArrowLeft: -STEP,
    ArrowDown: -STEP,
    ArrowRight: STEP,
    ArrowUp: STEP,
    PageDown: -LARGE_STEP,
    PageUp: LARGE_STEP,
    Home: -1,
    End: 1,
  };
  return key in steps ? Math.min(Math.max(split + steps[key], 0), 1) : undefined;
}

export class Compare {
  #session;
  #picture;
  #handle = document.getElementById("split");
  #select = document.getElementById("compare");

  constructor(session, picture) {
    this.#session = session;
    this.#picture = picture;
    this.#select.addEventListener("change", () => this.set(this.#select.value || null));
    this.#connectHandle();
    session.addEventListener("scene", () => this.update());
    picture.addEventListener("resized", () => this.update());
  }

  get #state() {
    return this.#session.scene?.compare ?? { method: null, split: 0.5 };
  }

  set(method, split = this.#state.split ?? 0.5) {
    this.#session.send("compare", { method, split }, (scene) => (scene.compare = { method, split }));
  }

  /** On with what is not shown anyway, or off. */
  toggle() {
    if (this.#state.method) this.set(null);
    else this.set(this.#session.scene.rounding.method === "none" ? "exact" : "none");
  }

  update() {
    const { method, split = 0.5 } = this.#state;
    this.#select.value = method ?? "";
    this.#handle.hidden = !method;
    if (!method) return;
    const { left, width } = this.#picture.rectangle;
    const stage = this.#handle.parentElement.getBoundingClientRect();
    this.#handle.style.left = `${left - stage.left + split * width}px`;
    this.#handle.setAttribute("aria-valuenow", String(Math.round(split * 100)));
    const own = NAMES[this.#session.scene.rounding.method];
    const where = `${Math.round(split * 100)} percent`;
    this.#handle.setAttribute("aria-valuetext", `${own} left, ${NAMES[method]} right of ${where}`);
    document.getElementById("split-left").textContent = own;
    document.getElementById("split-right").textContent = NAMES[method];
  }

  #moveTo(split) {
    this.set(this.#state.method, Number(Math.min(Math.max(split, 0), 1).toFixed(4)));
  }

  #connectHandle() {
    const handle = this.#handle;
    let held = null;
    handle.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      handle.setPointerCapture(event.pointerId);
      // Held where it was taken: it must not jump to the pointer.
      const line = handle.getBoundingClientRect();
      held = event.clientX - (line.left + line.width / 2);
    });
    handle.addEventListener("pointermove", (event) => {
      if (held === null) return;
      const { left, width } = this.#picture.rectangle;
      this.#moveTo((event.clientX - held - left) / width);
    });
    for (const end of ["pointerup", "pointercancel"]) handle.addEventListener(end, () => (held = null));
    handle.addEventListener("keydown", (event) => {
      const to = splitAfter(event.key, this.#state.split);
      if (to === undefined) return;
      event.preventDefault();
      this.#moveTo(to);
    });
  }
}
