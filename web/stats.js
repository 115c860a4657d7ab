// stats.js — figures of the picture: a line over it, and more in the panel.

import { formatNumber } from "./panels.js";

const INTEGRATORS = { "edge-point": "edge-point", traced: "traced", path: "path tracing" };
const percent = (part) => (part > 0 && part < 0.005 ? "< 1 %" : `${Math.round(part * 100)} %`);
const count = (number) => number.toLocaleString("en");

function set(id, text, title) {
  const element = document.getElementById(id);
  if (element.textContent !== text) element.textContent = text;
  if (title) element.parentElement.title = title;
}

// Parts of seconds only while they can be read.
const formatSeconds = (seconds) => `${seconds < 10 ? seconds.toFixed(1) : Math.round(seconds)} s`;

export class Stats {
  #latency = null;
  #isMoving = false;
  #isDone = false;

  /** A frame has been drawn; latency from input to picture in milliseconds, or null. */
  setFrame(header, latency) {
    const samples = count(header.samples) + (header.converged ? " ✓" : "");
    set("stat-samples", header.moving ? "moving" : samples);
    this.#isMoving = header.moving;
    if (header.moving) set("stat-seconds", formatSeconds(0));
    if (!header.converged) this.#isDone = false;
    // No frame follows one that is finished.
    if (header.converged || (latency === null && !header.moving)) this.#forgetLatency();
    if (header.converged || latency === null) return;
    // Single frames jump about more than can be read.
    this.#latency = this.#latency === null ? latency : 0.7 * this.#latency + 0.3 * latency;
    const inServer = `${Math.round(header.serverMs)} ms in the server`;
    set("stat-latency", `${Math.round(this.#latency)} ms`, `from input to picture; ${inServer}`);
  }

  /** Nothing moves: there is no input whose picture would be late. */
  #forgetLatency() {
    this.#latency = null;
    set("stat-latency", "–", "from input to picture; nothing moves");
  }

  setState(state) {
    set("stat-integrator", INTEGRATORS[state.integrator] ?? state.integrator);
    this.#setSeconds(state);
    set("stat-fps", `${Math.round(state.fps)} fps`, `${formatNumber(state.frame_ms, 3)} ms a frame in the server`);
    set("stat-fresh", percent(state.new_samples));
    const { edges, classes } = state;
    const latency = this.#latency === null ? "–" : `${Math.round(this.#latency)} ms`;
    // Those of the line over the picture for which narrow screens have no room, too.
    this.#fill([
      ["Latency", latency],
      ["New this frame", percent(state.new_samples)],
      ["Triangles", count(state.triangles)],
      ["Rounded edges", count(state.rounded_edges)],
      ["Silhouettes", count(edges.silhouette)],
      ["Sharp edges", count(edges.sharp)],
      ["Shadow edges", count(edges.shadow)],
      ["Empty pixels", percent(classes.empty)],
      ["Simple pixels", percent(classes.simple)],
      ["Complex pixels", percent(classes.complex)],
    ]);
    this.#setLegend(state);
  }

  /** Since the view stands still, none while it moves; a picture that is done keeps the time that it took. */
  #setSeconds({ seconds, converged }) {
    if (this.#isDone) return;
    set("stat-seconds", formatSeconds(this.#isMoving ? 0 : seconds));
    this.#isDone = converged && !this.#isMoving;
  }

  #setLegend({ classes, edges: { silhouette, sharp, shadow } }) {
    const hasClasses = classes.empty + classes.simple + classes.complex > 0;
    const found = `${count(silhouette)} silhouettes, ${count(sharp)} sharp and ${count(shadow)} shadow edges`;
    const traced = "This picture is traced, which needs neither edges nor points: it is only darker.";
    set("legend-edges", hasClasses ? found : traced);
  }

  #fill(rows) {
    const list = document.getElementById("figures");
    list.replaceChildren(
      ...rows.flatMap(([name, value]) => {
        const term = document.createElement("dt");
        term.textContent = name;
        const figure = document.createElement("dd");
        figure.textContent = value;
        return [term, figure];
      }),
    );
  }
}
