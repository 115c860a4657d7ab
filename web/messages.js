// messages.js — notices that appear over the picture, are read aloud, and can be dismissed.

const PASSING_MS = 6000;

export class Messages {
  #list;

  /** `list` is a live region. */
  constructor(list) {
    this.#list = list;
  }

  /**
   * An error stays until it is dismissed or cleared; the same one is not shown twice, and of those `about` the same
   * thing only the newest. `remedy` says what to do.
   */
  error(text, remedy, about = "") {
    for (const item of this.#list.querySelectorAll("[data-about]")) {
      if (about && item.dataset.about === about && item.dataset.text !== text) item.remove();
    }
    this.#show("error", text, remedy).dataset.about = about;
  }

  /** Errors about this hold no longer; without it: no error does. Those that are `lasting` have ends of their own. */
  clear(about) {
    for (const item of this.#list.querySelectorAll("[data-about]")) {
      if (!about || item.dataset.about === about) item.remove();
    }
  }

  /** Passes by itself. */
  info(text, remedy) {
    const item = this.#show("info", text, remedy);
    setTimeout(() => item.remove(), PASSING_MS);
  }

  /**
   * Stays until it is dismissed or `remove()` is called on what is returned. `action`: a button's label and what it
   * does.
   */
  lasting(kind, text, remedy, action) {
    const item = this.#show(kind, text, remedy);
    if (action && !item.querySelector(".action")) {
      const button = document.createElement("button");
      button.type = "button";
      button.className = "action";
      button.textContent = action.label;
      button.onclick = action.run;
      item.firstElementChild.append(button);
    }
    return item;
  }

  #show(kind, text, remedy) {
    let item = [...this.#list.children].find((shown) => shown.dataset.text === text);
    if (!item) {
      item = this.#make(kind, text);
      this.#list.append(item);
    }
    const span = item.querySelector("span");
    // Written again it would be read again.
    if (span.textContent !== (remedy ?? "")) span.textContent = remedy ?? "";
    // The picture stays visible however much goes wrong.
    while (this.#list.children.length > 4) this.#list.firstElementChild.remove();
    return item;
  }

  #make(kind, text) {
    const item = document.createElement("div");
    item.className = `message ${kind}`;
    item.dataset.text = text;
    if (kind === "error") item.setAttribute("role", "alert");
    const body = document.createElement("div");
    const what = document.createElement("strong");
    what.textContent = text;
    body.append(what, document.createElement("span"));
    const dismiss = document.createElement("button");
    dismiss.type = "button";
    dismiss.className = "icon";
    dismiss.setAttribute("aria-label", "Dismiss this message");
    dismiss.textContent = "×";
    dismiss.onclick = () => item.remove();
    item.append(body, dismiss);
    return item;
  }
}
