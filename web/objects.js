// objects.js — the list of objects: select, hide, isolate, look at, own radius.

import { formatNumber } from "./panels.js";

// Longer lists are narrowed by name instead of scrolled.
const SHOWN = 200;

const byId = (id) => document.getElementById(id);

/** Whether an object is the only one that is shown, of several. */
export function isIsolated(id, objects) {
  const shown = objects.filter(({ visible }) => visible);
  return objects.length > 1 && shown.length === 1 && shown[0].id === id;
}

export class Objects extends EventTarget {
  #session;
  #chosen = null;
  #isTyping = false;

  /** Dispatches "chosen"; `lookAt(object)` moves the camera. */
  constructor(session, lookAt) {
    super();
    this.#session = session;
    session.addEventListener("scene", ({ detail }) => this.#take(detail?.isNew));
    byId("object-filter").addEventListener("input", () => this.#list());
    byId("show-all").addEventListener("click", () => this.showAll());
    byId("object-frame").addEventListener("click", () => lookAt(this.chosen));
    byId("object-isolate").addEventListener("click", () => this.isolate());
    byId("object-back").addEventListener("click", () => this.putBack());
    byId("object-radius").addEventListener("input", () => (this.#isTyping = true));
    byId("object-radius").addEventListener("blur", () => (this.#isTyping = false));
    byId("object-radius").addEventListener("change", ({ target }) => {
      const isZero = target.value !== "" && Number(target.value) === 0;
      target.setCustomValidity(isZero ? "More than 0; the method “None” makes all edges sharp" : "");
      this.#isTyping = !target.reportValidity();
      if (this.#isTyping) return;
      this.#edit(this.#chosen, { radius: target.value === "" ? null : Number(target.value) });
    });
    byId("object-radius-clear").addEventListener("click", () => this.#edit(this.#chosen, { radius: null }));
  }

  /** The chosen object or undefined. */
  get chosen() {
    return this.#session.object(this.#chosen);
  }

  choose(id) {
    this.#chosen = id;
    this.#isTyping = false;
    byId("object-radius").setCustomValidity("");
    if (id !== null) byId("objects-section").open = true;
    this.#list();
    this.#details();
    byId("object-details").scrollIntoView({ block: "nearest" });
    byId("object-list").querySelector(".chosen")?.scrollIntoView({ block: "nearest" });
    this.dispatchEvent(new Event("chosen"));
  }

  /** Only the chosen one, or all again. */
  isolate() {
    if (!this.chosen) return;
    const id = isIsolated(this.#chosen, this.#session.scene.objects) ? null : this.#chosen;
    this.#session.send("isolate", { id }, (scene) => {
      for (const object of scene.objects) object.visible = id === null || object.id === id;
    });
    this.#details();
  }

  hide(id = this.#chosen) {
    const object = this.#session.object(id);
    if (object) this.#edit(id, { visible: !object.visible });
  }

  showAll() {
    this.#session.send("isolate", { id: null }, (scene) => scene.objects.forEach((object) => (object.visible = true)));
    this.#details();
  }

  /** `by`: a vector in the scene, from where `start` says that the object was. */
  move(id, start, by) {
    const matrix = start.matrix.map((row, at) => (at < 3 ? [row[0], row[1], row[2], row[3] + by[at]] : [...row]));
    const center = start.center.map((x, at) => x + by[at]);
    this.#edit(id, { matrix }, { center });
  }

  /** To where the file has it. */
  putBack() {
    const object = this.chosen;
    if (!object) return;
    const { matrix, file_matrix: back } = object;
    const center = object.center.map((x, at) => x + back[at][3] - matrix[at][3]);
    this.#edit(object.id, { matrix: back }, { center });
  }

  /** `known`: what follows from the change, which only the server would tell otherwise. */
  #edit(id, fields, known = {}) {
    this.#session.send(
      "object",
      { id, ...fields },
      (scene) => Object.assign(scene.objects.find((object) => object.id === id) ?? {}, fields, known),
      `object ${id}`,
    );
  }

  #take(isNew) {
    const { objects } = this.#session.scene ?? {};
    if (!objects) return;
    if (isNew) {
      byId("object-filter").hidden = objects.length < 12;
      byId("object-filter").value = "";
      if (!this.chosen) this.#chosen = null;
    }
    this.#list();
    this.#details();
  }

  #list() {
    const objects = this.#session.scene?.objects ?? [];
    const sought = byId("object-filter").value.trim().toLowerCase();
    const found = objects.filter(({ name }) => name.toLowerCase().includes(sought));
    const shown = found.slice(0, SHOWN);
    byId("object-count").textContent = String(objects.length);
    const list = byId("object-list");
    if (list.children.length !== shown.length) list.replaceChildren(...shown.map(() => this.#makeRow()));
    shown.forEach((object, at) => this.#fillRow(list.children[at], object));
    const rest = byId("object-rest");
    rest.hidden = found.length <= SHOWN && found.length > 0;
    rest.textContent = found.length ? `${found.length - SHOWN} more; find them by name` : "No object has such a name";
  }

  /** Rows are kept while the list changes, so that the focus stays where it is. */
  #makeRow() {
    const row = document.createElement("li");
    const name = document.createElement("button");
    name.type = "button";
    name.className = "name";
    name.onclick = () => this.choose(Number(row.dataset.id) === this.#chosen ? null : Number(row.dataset.id));
    const eye = document.createElement("button");
    eye.type = "button";
    eye.className = "eye";
    eye.onclick = () => this.hide(Number(row.dataset.id));
    row.append(name, eye);
    return row;
  }

  #fillRow(row, { id, name, visible }) {
    const isChosen = id === this.#chosen;
    // Most scenes change nothing here.
    const state = `${id} ${isChosen} ${visible} ${name}`;
    if (row.dataset.state === state) return;
    Object.assign(row.dataset, { id, state });
    row.className = `${isChosen ? "chosen" : ""} ${visible ? "" : "gone"}`;
    const [choose, eye] = row.children;
    choose.textContent = name;
    choose.title = name;
    choose.setAttribute("aria-pressed", String(isChosen));
    eye.textContent = visible ? "Hide" : "Show";
    eye.setAttribute("aria-label", `${visible ? "Hide" : "Show"} ${name}`);
  }

  #details() {
    const object = this.chosen;
    byId("object-details").hidden = !object;
    if (!object) return;
    byId("object-name").textContent = object.name;
    const size = object.size.map((x) => formatNumber(x, 3)).join(" × ");
    const facts = [size];
    if (object.triangles > 0) facts.unshift(`${object.triangles.toLocaleString("en")} triangles`);
    if (object.rounded > 0) facts.push(`rounded by ${formatNumber(object.rounded, 3)}`);
    byId("object-facts").textContent = facts.join(", ");
    const radius = byId("object-radius");
    const own = typeof object.radius === "number" ? formatNumber(object.radius) : "";
    // What was refused is replaced by what holds, also while the field has the focus.
    if (!this.#isTyping) radius.value = own;
    radius.placeholder = typeof object.radius === "string" ? object.radius : "as all";
    byId("object-isolate").setAttribute("aria-pressed", String(isIsolated(object.id, this.#session.scene.objects)));
  }
}
