// keys.js — the keyboard: one table that both acts and is shown as help.

/** Controls that need a key themselves keep it. */
function isTaken(event) {
  const target = event.target;
  const key = event.key;
  if (document.querySelector("dialog[open]")) return true;
  if (target.matches("select, textarea, input[type=text], input[type=number], input[type=search]")) return true;
  if (target.matches("input[type=range], input[type=radio], [role=slider]")) {
    return key.startsWith("Arrow") || ["Home", "End", "PageUp", "PageDown", "+", "-", "="].includes(key);
  }
  if (target.matches("button, summary, a")) return key === "Enter" || key === " ";
  if (target.matches("input")) return key === " ";
  return false;
}

/** "Shift+L" of an event: letters as capitals, Shift only where it does not make another character. */
export function keyName({ key, shiftKey, ctrlKey, metaKey, altKey }) {
  const isLetter = /^[a-z]$/i.test(key);
  const shift = shiftKey && (isLetter || key.length > 1) ? "Shift+" : "";
  const control = ctrlKey || metaKey ? "Ctrl+" : "";
  return control + (altKey ? "Alt+" : "") + shift + (isLetter ? key.toUpperCase() : key);
}

export class Keys {
  #actions = new Map();
  #rows = [];

  constructor() {
    window.addEventListener("keydown", (event) => {
      if (isTaken(event)) return;
      const action = this.#actions.get(keyName(event));
      if (!action) return;
      event.preventDefault();
      action();
    });
  }

  /** `actions`: key name → what it does; `shown` and `text` are its line in the help. */
  add(shown, text, actions) {
    for (const [key, action] of Object.entries(actions)) this.#actions.set(key, action);
    this.#rows.push([shown, text]);
  }

  fill(body) {
    fillTable(body, this.#rows, keyboardHead);
  }
}

const MOUSE = {
  f3d: [
    ["Left drag", "turn about the centre"],
    ["Middle drag, Shift + left", "shift"],
    ["Right drag, wheel", "zoom"],
    ["Ctrl + wheel, Ctrl + right", "zoom to the pointer"],
    ["Ctrl + left drag", "roll"],
    ["Shift + right drag", "rotate the light"],
    ["Double click, middle click", "centre of turning"],
    ["Click", "select an object"],
    ["Alt + left drag", "move an object"],
  ],
  blender: [
    ["Middle drag, Alt + left", "turn about the centre"],
    ["Shift + middle drag", "shift"],
    ["Ctrl + middle drag, wheel", "zoom"],
    ["Ctrl + wheel", "zoom to the pointer"],
    ["Double click", "centre of turning"],
    ["Click", "select an object"],
    ["M, then left drag", "move an object"],
  ],
};
const FINGERS = [
  ["One finger", "turn"],
  ["Two fingers", "zoom, shift, roll"],
  ["Tap, double tap", "select, centre of turning"],
];

/** What the device has comes first. */
export function fillMouseHelp(body, preset) {
  const isTouched = window.matchMedia("(pointer: coarse)").matches;
  const rows = isTouched ? [...FINGERS, ...MOUSE[preset]] : [...MOUSE[preset], ...FINGERS];
  fillTable(body, rows, (text) => [text]);
}

/** "1 · 3" as two keys. */
function keyboardHead(shown) {
  return shown.split(" · ").flatMap((key) => {
    const element = document.createElement("kbd");
    element.textContent = key;
    return [element, " "];
  });
}

function fillTable(body, rows, makeHead) {
  body.replaceChildren(
    ...rows.map(([shown, text]) => {
      const row = document.createElement("tr");
      const head = document.createElement("th");
      head.scope = "row";
      head.append(...makeHead(shown));
      const cell = document.createElement("td");
      cell.textContent = text;
      row.append(head, cell);
      return row;
    }),
  );
}
