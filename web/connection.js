// connection.js — the WebSocket to the server, as docs/view-protocol.md describes it.
//
// Messages are collected until the next animation frame and only the newest of each kind is sent, so that a fast
// mouse never builds a queue. A lost connection is sought again with growing delays.
//
// Events: "status" {state, reason?, retryInSeconds?}, "frame" {header, jpeg}, and each of the server's message types.

const FIRST_DELAY_MS = 500;
const LONGEST_DELAY_MS = 15000;
// With more than this unsent, the network is the bottleneck and newer input waits to replace the older.
const BUFFERED_BYTES = 16384;
const MAGIC = 0x46525241;
const HEADER_BYTES = 32;

/** The 32 bytes before each picture, or null if they are none. */
export function parseHeader(buffer) {
  if (buffer.byteLength <= HEADER_BYTES) return null;
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== MAGIC) return null;
  const flags = view.getUint32(20, true);
  return {
    frame: view.getUint32(4, true),
    seq: view.getUint32(8, true),
    width: view.getUint16(12, true),
    height: view.getUint16(14, true),
    serverMs: view.getFloat32(16, true),
    moving: (flags & 1) !== 0,
    converged: (flags & 2) !== 0,
    samples: view.getUint32(24, true),
  };
}

/** Delay before the n-th attempt in a row. */
export const retryDelay = (attempt) => Math.min(FIRST_DELAY_MS * 1.6 ** attempt, LONGEST_DELAY_MS);

export class Connection extends EventTarget {
  #socket = null;
  #waiting = new Map();
  #scheduled = false;
  #attempt = 0;
  #retryTimer = null;
  #seq = 0;
  #newest = new Map();
  #sentAt = new Map();

  /** `hello` returns the first message's keys: they change with the window. */
  constructor(token, hello) {
    super();
    this.token = token;
    this.hello = hello;
  }

  url(path) {
    return `${path}?t=${encodeURIComponent(this.token)}`;
  }

  get isOpen() {
    return this.#socket?.readyState === WebSocket.OPEN;
  }

  connect() {
    if (this.#socket) return;
    clearTimeout(this.#retryTimer);
    this.#tell("status", { state: "connecting" });
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}${this.url("/ws")}`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.#attempt = 0;
      this.#waiting.clear();
      this.#sentAt.clear();
      // What went to a connection before is in the scene that comes first, or lost.
      this.#newest.clear();
      socket.send(JSON.stringify({ type: "hello", ...this.hello() }));
      this.#tell("status", { state: "open" });
    };
    socket.onmessage = ({ data }) => this.#receive(data);
    socket.onclose = () => this.#lost();
    this.#socket = socket;
  }

  /**
   * Sends a message soon; a later one with the same key replaces it while it waits. Returns its sequence number.
   * Without a connection it is dropped, because the server tells its own state anew afterwards.
   */
  send(type, fields = {}, key = type) {
    const seq = ++this.#seq;
    if (!this.isOpen) return seq;
    const earlier = this.#waiting.get(key);
    // Deleted first, so that messages leave in the order of their numbers.
    this.#waiting.delete(key);
    this.#waiting.set(key, { ...earlier, type, seq, ...fields });
    this.#newest.set(type, seq);
    this.#schedule();
    return seq;
  }

  get lastSeq() {
    return this.#seq;
  }

  /** The newest number sent for a type, or 0. */
  newestSeq(type) {
    return this.#newest.get(type) ?? 0;
  }

  /** Milliseconds since a message was sent, once for each; null if it is not known. */
  takeLatency(seq) {
    const at = this.#sentAt.get(seq);
    for (const older of this.#sentAt.keys()) if (older <= seq) this.#sentAt.delete(older);
    return at === undefined ? null : performance.now() - at;
  }

  acknowledge(frame) {
    if (this.isOpen) this.#socket.send(JSON.stringify({ type: "ack", frame }));
  }

  #schedule() {
    if (this.#scheduled) return;
    this.#scheduled = true;
    requestAnimationFrame(() => {
      this.#scheduled = false;
      this.#flush();
    });
  }

  #flush() {
    if (!this.isOpen) return;
    if (this.#socket.bufferedAmount > BUFFERED_BYTES) {
      this.#schedule();
      return;
    }
    for (const message of this.#waiting.values()) {
      this.#socket.send(JSON.stringify(message));
      this.#sentAt.set(message.seq, performance.now());
    }
    this.#waiting.clear();
  }

  #receive(data) {
    if (data instanceof ArrayBuffer) {
      const header = parseHeader(data);
      if (header) this.#tell("frame", { header, jpeg: data.slice(HEADER_BYTES) });
      return;
    }
    const message = JSON.parse(data);
    this.#tell(message.type, message);
  }

  async #lost() {
    this.#socket = null;
    const trouble = await this.#findTrouble();
    // Meanwhile the user may have asked for another attempt.
    if (this.#socket) return;
    const delay = trouble.state === "refused" ? LONGEST_DELAY_MS : retryDelay(this.#attempt++);
    this.#tell("status", { ...trouble, retryInSeconds: delay / 1000 });
    this.#retryTimer = setTimeout(() => this.connect(), delay);
  }

  /** A WebSocket does not say why it failed; its address does, when it is asked for as a page. */
  async #findTrouble() {
    try {
      const answer = await fetch(this.url("/ws"), { cache: "no-store", redirect: "error" });
      if (answer.status === 403) return { state: "refused" };
      if (answer.status === 503) return { state: "busy", reason: (await answer.text()).trim() };
    } catch {
      // It is not there.
    }
    return { state: "lost" };
  }

  #tell(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}
