// panels.js — the settings of the whole scene: rounding, light, material, ground, shader, overlay.

import { length, subtract } from "./vector.js";

const byId = (id) => document.getElementById(id);

/** A number as people write it: 4 digits at most, no trailing zeros. */
export const formatNumber = (x, digits = 4) => String(Number(Number(x).toPrecision(digits)));

/** A slider of 0 to 1000 that counts in factors between two values. */
export function logScale(low, high) {
  const span = Math.log(high / low);
  return {
    toSlider: (value) => Math.round((1000 * Math.log(Math.min(Math.max(value, low), high) / low)) / span),
    fromSlider: (at) => Number((low * Math.exp((at / 1000) * span)).toPrecision(3)),
  };
}
const sameScale = { toSlider: (value) => value, fromSlider: (at) => at };

/** From a hair to the largest radius: just below the `limit` that the server knows, or what parts of such a size take. */
export function radiusScale({ lower, upper }, limit = null) {
  const diagonal = length(subtract(upper, lower)) || 1;
  const high = limit > 0 ? limit * 0.99 : diagonal * 0.1;
  return logScale(Math.min(diagonal * 2e-4, high / 100), high);
}

/** The protocol's radius of what was typed: a number, "8%", "auto", or undefined. */
export function parseRadius(text) {
  const typed = text.trim().replace(",", ".");
  if (/^auto$/i.test(typed)) return "auto";
  const [, number, percent] = /^(\d*\.?\d+(?:e[+-]?\d+)?)\s*(%?)$/i.exec(typed) ?? [];
  if (number === undefined || !Number.isFinite(Number(number))) return undefined;
  return percent ? `${Number(number)}%` : Number(number);
}

/** What a radius comes to: that of the most rounded object, or null if none is rounded. */
export function usedRadius(radius, objects) {
  if (typeof radius === "number") return radius;
  const largest = Math.max(0, ...objects.filter((object) => object.radius === null).map(({ rounded }) => rounded ?? 0));
  return largest > 0 ? largest : null;
}

/**
 * What a radius that was given changes: 0 makes edges sharp, any other rounds those that are, unless it is that of the
 * rounding which they are compared with.
 */
export function radiusChange(radius, { rounding, compare }) {
  if (radius === 0 || radius === "0%") return { method: "none" };
  const isSeen = rounding.method !== "none" || (compare?.method ?? "none") !== "none";
  return isSeen ? { radius } : { radius, method: "exact" };
}

const formatRadius = (radius) => (typeof radius === "number" ? formatNumber(radius, 3) : radius);

/** `getScale` may change with the scene; `change` is called while the slider moves and when a number is entered. */
function connectNumber(id, getScale, change) {
  const slider = byId(`${id}-slider`);
  const field = byId(id);
  slider.addEventListener("input", () => {
    const value = getScale().fromSlider(Number(slider.value));
    field.value = formatNumber(value);
    change(value);
  });
  let shown = "";
  // What is out of range is said, and replaced by what holds when the field is left.
  field.addEventListener("change", () => {
    if (field.reportValidity() && field.value !== "") change(Number(field.value));
  });
  field.addEventListener("blur", () => (field.value = shown));
  return (value) => {
    shown = formatNumber(value);
    slider.value = getScale().toSlider(value);
    slider.setAttribute("aria-valuetext", shown);
    if (document.activeElement !== field) field.value = shown;
  };
}

function connectChoice(id, change) {
  byId(id).addEventListener("change", (event) => change(event.target.value));
  return (value) => {
    for (const input of byId(id).querySelectorAll("input")) input.checked = input.value === value;
  };
}

function connectCheck(id, change) {
  byId(id).addEventListener("change", (event) => change(event.target.checked));
  return (value) => (byId(id).checked = value);
}

function connectSelect(id, change) {
  byId(id).addEventListener("change", (event) => change(event.target.value));
  return (value) => (byId(id).value = value);
}

export class Panels {
  #session;
  #show = {};
  #radiusScale = logScale(1e-3, 1);
  #isTyping = false;

  constructor(session) {
    this.#session = session;
    this.#connectRounding();
    this.#connectRest();
    session.addEventListener("scene", () => this.#update());
  }

  #connectRounding() {
    const round = (fields) => this.#session.send("rounding", fields, (scene) => Object.assign(scene.rounding, fields));
    const slider = byId("radius-slider");
    const field = byId("radius");
    const setRadius = (radius) => this.#session.scene && round(radiusChange(radius, this.#session.scene));
    slider.addEventListener("input", () => setRadius(this.#radiusScale.fromSlider(Number(slider.value))));
    field.addEventListener("input", () => (this.#isTyping = true));
    field.addEventListener("blur", () => {
      this.#isTyping = false;
      field.setCustomValidity("");
      this.#update();
    });
    field.addEventListener("change", () => {
      const radius = parseRadius(field.value);
      this.#isTyping = radius === undefined;
      field.setCustomValidity(radius === undefined ? "A length as 0.5, or in percent of what fits as 8%" : "");
      if (field.reportValidity()) setRadius(radius);
    });
    byId("radius-auto").addEventListener("click", () => setRadius("auto"));
    this.#show.method = connectChoice("method", (method) => round({ method }));
    this.#show.edges = connectChoice("edges", (edges) => round({ edges }));
    this.#show.minAngle = connectNumber("min-angle", () => sameScale, (value) => round({ min_angle: value }));
  }

  #connectRest() {
    const session = this.#session;
    const light = (fields) => session.send("light", fields, (scene) => Object.assign(scene, fields));
    this.#show.lighting = connectChoice("lighting", (lighting) => light({ lighting }));
    const strengths = logScale(0.05, 20);
    this.#show.strength = connectNumber("strength", () => strengths, (strength) => light({ strength }));
    this.#show.rotation = connectNumber("rotation", () => sameScale, (rotation) => light({ rotation }));
    this.#show.shader = connectSelect("shader", (name) =>
      session.send("shader", { name }, (scene) => (scene.shader = name)),
    );
    this.#show.material = connectSelect("material", (value) => {
      const name = value || null;
      session.send("material", { name }, (scene) => (scene.material = name));
    });
    this.#show.ground = connectCheck("ground", (on) => session.send("ground", { on }, (scene) => (scene.ground = on)));
    this.#show.overlay = connectCheck("overlay", (on) => this.setOverlay(on));
  }

  setOverlay(on) {
    this.#session.send("overlay", { on }, (scene) => (scene.overlay = on));
  }

  /** In degrees; kept between -180 and 180. */
  rotateLight(degrees) {
    if (!this.#session.scene?.rotates) return;
    const rotation = (((this.#session.scene.rotation + degrees + 180) % 360) + 360) % 360 - 180;
    this.#session.send("light", { rotation }, (scene) => (scene.rotation = rotation));
  }

  brighten(factor) {
    const strength = Number((this.#session.scene.strength * factor).toPrecision(3));
    this.#session.send("light", { strength }, (scene) => (scene.strength = strength));
  }

  #update() {
    const scene = this.#session.scene;
    if (!scene) return;
    this.#updateRounding(scene);
    this.#show.lighting(scene.lighting);
    this.#updateLightings(scene);
    this.#show.strength(scene.strength);
    this.#show.rotation(scene.rotation);
    this.#updateRotation(scene);
    this.#show.shader(scene.shader);
    this.#show.ground(scene.ground);
    this.#show.overlay(scene.overlay);
    this.#updateMaterials(scene);
  }

  #updateRotation({ rotates, lighting }) {
    for (const id of ["rotation", "rotation-slider"]) byId(id).disabled = !rotates;
    const note = byId("rotation-note");
    note.hidden = rotates;
    note.textContent =
      lighting === "white"
        ? "White light comes from all sides alike: there is nothing to rotate."
        : "The file’s lamps stay where they are: there is nothing to rotate.";
  }

  /** Only those that the model has. */
  #updateLightings({ lightings }) {
    for (const input of byId("lighting").querySelectorAll("input")) {
      input.closest("label").hidden = !lightings.includes(input.value);
    }
  }

  #updateRounding({ rounding, bounds, objects, radius_limit: limit }) {
    this.#radiusScale = radiusScale(bounds, limit);
    // Of solids that stay sharp there is nothing to set.
    const isSharp = objects.length > 0 && objects.every(({ csg }) => csg);
    byId("rounding-note").hidden = !isSharp;
    for (const row of byId("rounding-section").querySelectorAll(".row")) row.hidden = isSharp;
    if (rounding.method === "mesh") byId("method-mesh").hidden = false;
    const { radius } = rounding;
    const used = usedRadius(radius, objects);
    const slider = byId("radius-slider");
    if (used !== null) slider.value = this.#radiusScale.toSlider(used);
    const text = radius === "auto" && used !== null ? formatNumber(used, 3) : formatRadius(radius);
    slider.setAttribute("aria-valuetext", text);
    const field = byId("radius");
    if (!this.#isTyping) field.value = text;
    byId("radius-auto").setAttribute("aria-pressed", String(radius === "auto"));
    this.#show.method(rounding.method);
    this.#show.edges(rounding.edges);
    this.#show.minAngle(rounding.min_angle);
  }

  #updateMaterials({ material, materials }) {
    const select = byId("material");
    const names = [...select.options].slice(1).map((option) => option.value);
    if (names.join("\n") !== materials.join("\n")) {
      while (select.options.length > 1) select.options[1].remove();
      for (const name of materials) select.add(new Option(name.replaceAll("_", " "), name));
    }
    this.#show.material(material ?? "");
  }
}
