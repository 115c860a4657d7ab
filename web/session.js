// session.js — the scene as this page knows it, between the controls and the connection.
//
// A change is shown at once and sent; what the server tells of the same thing is not taken over while a change is on
// its way, or a slider would jump back under the hand. A scene says by its `seq` which changes are in it.

export class Session extends EventTarget {
  #connection;
  #refusedSeq = 0;

  /** Dispatches "scene" when controls should show `scene` anew. */
  constructor(connection) {
    super();
    this.#connection = connection;
    this.scene = null;
    connection.addEventListener("scene", ({ detail }) => this.#take(detail));
    connection.addEventListener("camera", ({ detail: { position, target, up, fov } }) => {
      if (this.scene) this.scene.camera = { position, target, up, fov };
    });
  }

  /** A change was refused: what the server tells next counts. */
  setRefused(seq) {
    this.#refusedSeq = Math.max(this.#refusedSeq, Math.min(seq ?? Infinity, this.#connection.lastSeq));
  }

  /** Whether a message of this type has left that a scene, the newest one unless given, knows nothing of. */
  isPending(type, scene = this.scene) {
    return this.#connection.newestSeq(type) > Math.max(scene?.seq ?? 0, this.#refusedSeq);
  }

  /** Sends a message of this type; `change` makes the same change in the page's own scene. */
  send(type, fields, change = null, key = type) {
    const seq = this.#connection.send(type, fields, key);
    if (this.scene && change) {
      change(this.scene);
      this.dispatchEvent(new Event("scene"));
    }
    return seq;
  }

  object(id) {
    return this.scene?.objects.find((object) => object.id === id);
  }

  #take(scene) {
    const before = this.scene;
    const isNew =
      !before ||
      before.model !== scene.model ||
      before.name !== scene.name ||
      before.objects.length !== scene.objects.length;
    if (!isNew) {
      for (const [type, names] of Object.entries(KEYS_OF)) {
        if (!this.isPending(type, scene)) continue;
        for (const name of names) scene[name] = before[name];
      }
    }
    this.scene = scene;
    this.dispatchEvent(new CustomEvent("scene", { detail: { isNew, fromServer: true } }));
  }
}

/** What each message changes in a scene. */
const KEYS_OF = {
  rounding: ["rounding"],
  light: ["lighting", "strength", "rotation"],
  material: ["material"],
  ground: ["ground"],
  shader: ["shader"],
  compare: ["compare"],
  overlay: ["overlay"],
  object: ["objects"],
  isolate: ["objects"],
};
