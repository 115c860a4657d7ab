// view.js — the camera between the user's hands and the server.

import { Camera, showsBox, upAxis } from "./camera.js";
import { length } from "./vector.js";

// As many cameras on their way as are told apart; frames lag by far fewer.
const REMEMBERED = 256;
// What models are framed for before a page has asked for a size.
const FIRST_ASPECT = 16 / 9;
// Corners of the bounds stick out of a picture that shows all of the model.
const BOX_SLACK = 1.3;

export class View extends EventTarget {
  #session;
  #sent = new Map();
  #wantedAspect;
  #isFitting = false;

  /**
   * Dispatches "camera" when `shown`, the camera of the picture on the screen, has changed. `wantedAspect()` is the
   * width over height of the picture that this page has asked for.
   */
  constructor(session, wantedAspect) {
    super();
    this.#session = session;
    this.#wantedAspect = wantedAspect;
    this.camera = new Camera();
    this.shown = this.camera;
    this.first = null;
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

  /** One of the server's views. */
  frame(direction) {
    this.#session.send("frame_view", direction ? { direction } : {});
  }

  /** To where the model was first seen from. */
  reset() {
    if (this.first) this.change((camera) => Object.assign(camera, this.first.clone()));
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

  /** A model that was framed for a wide picture would be cut in a narrow one. A view cut in both is meant so. */
  #fit({ bounds }) {
    const isCut = !showsBox(this.camera, bounds, this.#wantedAspect());
    if (!isCut || !showsBox(this.camera, bounds, FIRST_ASPECT, BOX_SLACK)) return;
    this.#isFitting = true;
    this.frame("");
  }

  #take(isNew) {
    const { scene } = this.#session;
    if (isNew) this.camera = new Camera(upAxis(scene));
    else if (this.isActive || this.#session.isPending("camera")) return;
    this.camera.set(scene.camera);
    this.camera.setLimits(scene.bounds);
    if (isNew || this.#isFitting) this.first = this.camera.clone();
    this.#isFitting = false;
    if (isNew) this.#fit(scene);
    this.#sent.clear();
    this.shown = this.camera.clone();
    this.dispatchEvent(new Event("camera"));
  }
}
