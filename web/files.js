// files.js — saving pictures and scenes, opening models, and the beam picture.

const byId = (id) => document.getElementById(id);

/** What the server says of a request that it did not fulfil; the cause is what to do. */
async function problemOf(answer) {
  const text = (await answer.text()).trim() || `the server answered ${answer.status}`;
  const end = text.indexOf("; ");
  return end < 0 ? new Error(text) : new Error(text.slice(0, end), { cause: text.slice(end + 2) });
}

/** What is said of a picture that was saved as it is in this frame; `wanted`: samples of one that is done. */
export function savedPicture(name, header, wanted) {
  if (!header || header.converged) return [`Saved ${name}`];
  const samples = wanted ? `, ${header.samples} of ${wanted} samples` : "";
  return [`Saved ${name}: a draft${samples}`, "Wait for the tick for a finished one."];
}

export class Files {
  #session;
  #frame = null;
  #connection;
  #messages;

  constructor({ session, connection, messages }) {
    this.#session = session;
    this.#connection = connection;
    this.#messages = messages;
    byId("save-picture").addEventListener("click", () => this.savePicture());
    byId("save-scene").addEventListener("click", () => this.saveScene());
    byId("open-file").addEventListener("click", () => (this.#mayOpen() ? byId("file").click() : undefined));
    byId("file").addEventListener("change", ({ target }) => {
      this.#open([...target.files]);
      target.value = "";
    });
    this.#connectDrop();
    this.#connectBeam();
  }

  /** The header of the frame that is drawn. */
  setFrame(header) {
    this.#frame = header;
  }

  savePicture() {
    const header = this.#frame;
    const said = (name) => savedPicture(name, header, this.#session.scene?.samples);
    return this.#save("/picture.png", "png", "picture", said);
  }

  saveScene() {
    return this.#save("/scene.toml", "toml", "scene");
  }

  /** Fetched rather than linked to, so that an error becomes a message instead of a file. */
  async #save(path, extension, what, said = (name) => [`Saved ${name}`]) {
    try {
      const link = document.createElement("a");
      const stem = (this.#session.scene?.name ?? "arris").replace(/\.[^.]*$/, "").replace(/[^\w.-]+/g, "_");
      link.download = `${stem || "arris"}.${extension}`;
      // A scene file tells how it is rendered, by the name that it will have.
      const url = `${this.#connection.url(path)}&name=${encodeURIComponent(link.download)}`;
      const answer = await fetch(url, { cache: "no-store" });
      if (!answer.ok) throw await problemOf(answer);
      link.href = URL.createObjectURL(await answer.blob());
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
      this.#messages.clear(path);
      this.#messages.info(...said(link.download));
    } catch (error) {
      const remedy = error.cause ?? "Try again when the server answers.";
      this.#messages.error(`The ${what} could not be saved: ${error.message}`, remedy, path);
    }
  }

  #mayOpen() {
    if (this.#session.scene?.upload) return true;
    this.#messages.error("This server does not take models", "Start it with: arris view FILE --allow-upload", "open");
    return false;
  }

  async #open(files) {
    if (files.length === 0 || !this.#mayOpen()) return;
    if (files.length > 1) {
      this.#messages.error("One file at a time", "Models of several files: put them into one .glb.", "open");
      return;
    }
    const [file] = files;
    const opening = this.#messages.lasting("info", `Opening ${file.name} …`);
    try {
      const url = `${this.#connection.url("/model")}&name=${encodeURIComponent(file.name)}`;
      const answer = await fetch(url, { method: "POST", body: file });
      if (!answer.ok) throw await problemOf(answer);
      this.#messages.clear("open");
    } catch (error) {
      const remedy = error.cause ?? "The model shown before stays.";
      this.#messages.error(`${file.name} was not opened: ${error.message}`, remedy, "open");
    } finally {
      opening.remove();
    }
  }

  #connectDrop() {
    const hint = byId("drop-hint");
    // Entering a child leaves its parent: only the depth tells when the pointer has left the page.
    let depth = 0;
    const hasFiles = (event) => event.dataTransfer?.types.includes("Files");
    window.addEventListener("dragenter", (event) => {
      if (!hasFiles(event)) return;
      depth += 1;
      const takes = this.#session.scene?.upload;
      byId("drop-text").textContent = takes ? "Drop the model to open it" : "This server does not take models";
      hint.classList.toggle("refused", !takes);
      hint.hidden = false;
    });
    window.addEventListener("dragleave", (event) => {
      if (hasFiles(event) && (depth -= 1) <= 0) hint.hidden = true;
    });
    window.addEventListener("dragover", (event) => event.preventDefault());
    window.addEventListener("drop", (event) => {
      event.preventDefault();
      depth = 0;
      hint.hidden = true;
      this.#open([...(event.dataTransfer?.files ?? [])]);
    });
  }

  #connectBeam() {
    const work = byId("beam-work");
    const progress = byId("beam-progress");
    const look = byId("beam-show");
    const start = byId("beam-start");
    const stop = byId("beam-stop");
    /** `state`: "working", "done" or null. */
    const show = (state) => {
      const hadFocus = work.contains(document.activeElement);
      work.hidden = !state;
      progress.parentElement.hidden = state !== "working";
      look.hidden = state !== "done";
      start.disabled = state === "working";
      if (!hadFocus || work.contains(document.activeElement)) return;
      (state === "done" ? look : start).focus();
    };
    start.addEventListener("click", () => {
      this.#messages.clear("beam");
      this.#session.send("beam");
      progress.value = 0;
      show("working");
      work.scrollIntoView({ block: "nearest" });
    });
    stop.addEventListener("click", () => this.#session.send("beam_stop"));
    this.#connection.addEventListener("beam", ({ detail }) => {
      progress.value = detail.done;
      const isStopped = detail.stopped && !detail.ready;
      show(detail.error || isStopped ? null : detail.ready ? "done" : "working");
      if (isStopped) this.#messages.info("The beam picture was cancelled");
      if (detail.error) this.#messages.error(`No beam picture: ${detail.error}`, detail.remedy, "beam");
      if (detail.ready) this.#messages.info("The beam picture is done", "Open it under “Picture and file”.");
    });
    this.#connection.addEventListener("status", ({ detail }) => {
      if (detail.state !== "connecting" && !work.hidden && look.hidden) show(null);
    });
    look.addEventListener("click", () => this.#showBeam());
    byId("beam-save").addEventListener("click", () => this.#save("/beam.png", "beam.png", "beam picture"));
  }

  #showBeam() {
    // A number that never repeats: the picture before has the same address.
    byId("beam-picture").src = `${this.#connection.url("/beam.png")}&at=${Date.now()}`;
    byId("beam-dialog").showModal();
  }
}
