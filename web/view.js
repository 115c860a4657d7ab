// view.js — the camera between the user's hands and the server.

import { Camera, upAxis } from "./camera.js";
import { length } from "./vector.js";

// As many cameras on their way as are told apart; frames lag by far fewer.
const REMEMBERED = 256;

export class View extends EventTarget {
  #session;
  #sent = new Map();

  /** Dispatches "camera" when `shown`, the camera of the picture on the screen, has changed. */
  constructor(session) {
    super();
    this.#session = session;
    this.camera = new Camera();
    this.shown = this.camera;
    this.isActive = false;
    session.addEventListener("scene", ({ detail }) => detail?.fromServer && this.#take(detail.isNew));
  }

  /** Another page has moved the view; who drags here leads. */
  follow(camera) {
    if (this.isActive) return;
    this.camera.set(camera);
    this.#sent.clear();
    this.shown = this.camera.clone();
    this.dispatchEvent(new Event("camera"));
  }

  /** `edit` changes the camera; the new one is sent. */
  change(edit) {
    edit(this.camera);
    const seq = this.#session.send("camera", this.camera.get());
    this.#sent.set(seq, this.camera.clone());
    if (this.#sent.size > REMEMBERED) this.#sent.delete(this.#sent.keys().next().value);
  }

  /** One of the server's views; `direction` as in the protocol, or none. */
  frame(direction) {
    this.#session.send("frame_view", direction ? { direction } : {});
  }

  lookAt(object, aspect) {
    if (object) this.change((camera) => camera.frameSphere(object.center, length(object.size) / 2, aspect));
  }

  /** A frame is on the screen that shows this message and all before it. */
  setShownSeq(seq) {
    for (const [at, camera] of this.#sent) {
      if (at > seq) break;
      this.shown = camera;
      this.#sent.delete(at);
    }
    this.dispatchEvent(new Event("camera"));
  }

  #take(isNew) {
    const { scene } = this.#session;
    if (isNew) this.camera = new Camera(upAxis(scene));
    else if (this.isActive || this.#session.isPending("camera")) return;
    this.camera.set(scene.camera);
    this.camera.setLimits(scene.bounds);
    this.#sent.clear();
    this.shown = this.camera.clone();
    this.dispatchEvent(new Event("camera"));
  }
}
