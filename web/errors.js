// errors.js — which of the server's errors still hold: of each kind the newest, until what it was about has worked.

export class Errors {
  #connection;
  #messages;
  #failed = new Map();

  /** `refused(seq)` is called for each error. */
  constructor({ connection, session, messages, refused }) {
    this.#connection = connection;
    this.#messages = messages;
    connection.addEventListener("error", ({ detail }) => {
      if (!detail.text) return this.#clear(detail.about);
      refused(detail.seq);
      if (detail.about) this.#failed.set(detail.about, detail.seq ?? 0);
      messages.error(detail.text, detail.remedy, detail.about);
    });
    session.addEventListener("scene", ({ detail }) => detail?.fromServer && this.#clearMended(session.scene));
    // What still holds of the time before, the server says again.
    connection.addEventListener("status", ({ detail }) => detail.state === "open" && this.#clear());
  }

  /** A later message of the same kind is in the scene. */
  #clearMended({ seq }) {
    for (const [about, failedSeq] of this.#failed) {
      const newest = this.#connection.newestSeq(about);
      if (newest > failedSeq && newest <= seq) this.#clear(about);
    }
  }

  #clear(about) {
    if (about) this.#failed.delete(about);
    else this.#failed.clear();
    this.#messages.clear(about);
  }
}
