// picture.js — shows the server's frames and says where in them a place on the screen is.

// So long a first picture of another shape, that of the page before, is held back: the right one is on its way.
const SHAPE_PATIENCE_MS = 8000;
const SHAPE_SLACK = 0.02;
// More than this costs more time than it shows, unless it is asked for.
const AUTOMATIC_PIXELS = 1920 * 1080;
const SMALLEST = 64;
const LARGEST = [3840, 2160];

/**
 * The size of the picture for an area in CSS pixels: `detail` is "auto", or a factor on the device's pixels. The
 * shape is kept within the bounds of the protocol.
 */
export function pictureSize(width, height, pixelRatio, detail = "auto") {
  let factor = detail === "auto" ? pixelRatio : pixelRatio * detail;
  if (detail === "auto") factor = Math.min(factor, Math.sqrt(AUTOMATIC_PIXELS / (width * height)));
  factor = Math.min(factor, LARGEST[0] / width, LARGEST[1] / height);
  const bound = (x, largest) => Math.min(Math.max(Math.round(x * factor), SMALLEST), largest);
  return [bound(width, LARGEST[0]), bound(height, LARGEST[1])];
}

/** Where a picture lies in an area that it fits into whole; all in CSS pixels. */
export function fitInto(areaWidth, areaHeight, width, height) {
  const factor = Math.min(areaWidth / width, areaHeight / height);
  const shown = [width * factor, height * factor];
  return { left: (areaWidth - shown[0]) / 2, top: (areaHeight - shown[1]) / 2, width: shown[0], height: shown[1] };
}

/** Whether a frame has the shape, width over height, of what was asked for. */
export const hasShape = ({ width, height }, aspect) => Math.abs(width / height / aspect - 1) < SHAPE_SLACK;

export class Picture extends EventTarget {
  #context;
  #newest = 0;
  #patientUntil = 0;
  #wantedAspect;

  /** Dispatches "drawn" with the frame's header; `wantedAspect()`: width over height of what was asked for. */
  constructor(canvas, acknowledge, wantedAspect) {
    super();
    this.#wantedAspect = wantedAspect;
    this.canvas = canvas;
    this.acknowledge = acknowledge;
    this.#context = canvas.getContext("2d", { alpha: false });
  }

  /** A new server counts its frames from the beginning. */
  restart() {
    this.#newest = 0;
    this.#patientUntil = performance.now() + SHAPE_PATIENCE_MS;
  }

  /** After a beginning, until a picture of the right shape is there, or has been waited for in vain. */
  #isHeldBack(header) {
    if (hasShape(header, this.#wantedAspect())) this.#patientUntil = 0;
    return performance.now() < this.#patientUntil;
  }

  async show({ header, jpeg }) {
    try {
      if (this.#isHeldBack(header)) return;
      const bitmap = await createImageBitmap(new Blob([jpeg], { type: "image/jpeg" }));
      // Decoders may overtake each other.
      if (header.frame >= this.#newest) {
        this.#newest = header.frame;
        this.#draw(bitmap);
        this.dispatchEvent(new CustomEvent("drawn", { detail: header }));
      }
      bitmap.close();
    } finally {
      // Also for a frame that could not be decoded, or none would follow.
      this.acknowledge(header.frame);
    }
  }

  #draw(bitmap) {
    if (this.canvas.width !== bitmap.width || this.canvas.height !== bitmap.height) {
      this.canvas.width = bitmap.width;
      this.canvas.height = bitmap.height;
      this.dispatchEvent(new Event("resized"));
    }
    this.#context.drawImage(bitmap, 0, 0);
  }

  /** The picture's place on the page, without the bars beside it. */
  get rectangle() {
    const area = this.canvas.getBoundingClientRect();
    const place = fitInto(area.width, area.height, this.canvas.width, this.canvas.height);
    return { ...place, left: area.left + place.left, top: area.top + place.top };
  }

  get aspect() {
    return this.canvas.width / this.canvas.height;
  }

  /** Pixel of the picture under a place on the page. */
  pixelAt(clientX, clientY) {
    const { left, top, width, height } = this.rectangle;
    const bound = (x, size) => Math.min(Math.max(x, 0), size - 1);
    return [
      bound(((clientX - left) / width) * this.canvas.width, this.canvas.width),
      bound(((clientY - top) / height) * this.canvas.height, this.canvas.height),
    ];
  }

  /** The same from the picture's middle, in picture heights, as cameras count. */
  heightsAt(clientX, clientY) {
    const { left, top, width, height } = this.rectangle;
    return [(clientX - left - width / 2) / height, (clientY - top - height / 2) / height];
  }
}
