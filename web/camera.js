// camera.js — a camera that turns about an axis and a centre, without the DOM.
//
// The view is kept as a turntable: `side` is the horizontal direction to the picture's right, `elevation` the height
// of the eye above the horizon, `roll` the turn about the line of sight. Unlike an up vector and a position these
// hold at the poles too, so a view from straight above can be turned on without a jump. Angles are radians; `fov`
// is the vertical angle of view in degrees, as in the protocol.

import { add, cross, dot, length, normalize, rotate, scale, snapToAxis, subtract } from "./vector.js";

const RIGHT_ANGLE = Math.PI / 2;
// Closer to an axis than this, the picture's right is taken from the camera's own up vector.
const POLE = 1e-6;
// Narrow enough to pass for a parallel projection, wide enough for distances that floats resolve.
const PARALLEL_FOV = 2;

const toRadians = (degrees) => (degrees * Math.PI) / 180;
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

export class Camera {
  /** `axis`: what is up in the scene. */
  constructor(axis = [0, 0, 1]) {
    this.axis = normalize(axis);
    this.target = [0, 0, 0];
    this.side = normalize(Math.abs(this.axis[0]) < 0.9 ? cross([1, 0, 0], this.axis) : cross([0, 1, 0], this.axis));
    this.elevation = 0;
    this.roll = 0;
    this.distance = 1;
    this.fov = 35;
    this.perspectiveFov = 35;
    this.limits = [1e-6, 1e9];
  }

  /** Takes over the protocol's `{position, target, up, fov}`; a view that can't be one is left out. */
  set({ position, target, up, fov }) {
    const sight = subtract(target, position);
    const distance = length(sight);
    if (!(distance > 0) || !(length(up) > 0)) return;
    const forward = scale(sight, 1 / distance);
    this.target = [...target];
    this.distance = distance;
    this.fov = fov;
    if (fov > PARALLEL_FOV) this.perspectiveFov = fov;
    this.elevation = Math.asin(clamp(-dot(forward, this.axis), -1, 1));
    let side = cross(forward, this.axis);
    if (length(side) < POLE) {
      side = cross(forward, up);
      side = subtract(side, scale(this.axis, dot(side, this.axis)));
      this.elevation = Math.sign(this.elevation) * RIGHT_ANGLE;
    }
    if (!(length(side) > 0)) return;
    this.side = normalize(side);
    const level = this.#levelUp();
    this.roll = Math.atan2(dot(cross(level, up), forward), dot(level, up));
  }

  /** What the protocol calls the camera. */
  get() {
    return { position: this.position, target: [...this.target], up: this.up, fov: this.fov };
  }

  clone() {
    return Object.assign(new Camera(this.axis), this, { target: [...this.target], side: [...this.side] });
  }

  get forward() {
    const horizontal = cross(this.axis, this.side);
    return add(scale(horizontal, Math.cos(this.elevation)), scale(this.axis, -Math.sin(this.elevation)));
  }

  get up() {
    return rotate(this.#levelUp(), this.forward, this.roll);
  }

  get right() {
    return rotate(this.side, this.forward, this.roll);
  }

  get position() {
    return subtract(this.target, scale(this.forward, this.distance));
  }

  #levelUp() {
    return cross(this.side, this.forward);
  }

  /**
   * Turns the model by angles to the picture's right and downwards, as if the hand lay on it. In a rolled picture
   * these are turned back first, so that it still follows the hand.
   */
  orbit(right, down) {
    const c = Math.cos(this.roll);
    const s = Math.sin(this.roll);
    const around = right * c - down * s;
    const over = right * s + down * c;
    this.side = normalize(rotate(this.side, this.axis, -around));
    this.elevation = clamp(this.elevation + over, -RIGHT_ANGLE, RIGHT_ANGLE);
  }

  /** Turns the picture counter-clockwise. */
  rollBy(angle) {
    this.roll = Math.atan2(Math.sin(this.roll + angle), Math.cos(this.roll + angle));
  }

  /** Lengths in the scene of one picture height at `depth` before the eye; the centre's, unless told. */
  heightAt(depth = this.distance) {
    return 2 * depth * Math.tan(toRadians(this.fov) / 2);
  }

  /** The move in the scene that a move in the picture stands for; right and down in picture heights. */
  inPicturePlane(right, down, depth = this.distance) {
    const height = this.heightAt(depth);
    return add(scale(this.right, right * height), scale(this.up, -down * height));
  }

  /** Shifts the picture's content, in picture heights; what lies at the centre's depth follows the hand. */
  pan(right, down) {
    this.target = subtract(this.target, this.inPicturePlane(right, down));
  }

  /** Makes the model `factor` times larger; `at`, if given, is the place that stays: from the middle, in heights. */
  zoom(factor, at = [0, 0]) {
    const distance = clamp(this.distance / factor, ...this.limits);
    const kept = 1 - distance / this.distance;
    this.target = add(this.target, this.inPicturePlane(at[0] * kept, at[1] * kept));
    this.distance = distance;
  }

  /** Looks at another centre from where the eye is by moving sideways only, so that the size stays. */
  centreOn(point) {
    this.distance = clamp(dot(subtract(point, this.position), this.forward), ...this.limits);
    this.target = [...point];
  }

  get isParallel() {
    return this.fov <= PARALLEL_FOV;
  }

  /** Between perspective and (nearly) parallel projection; the centre keeps its size. */
  toggleParallel() {
    const height = this.heightAt();
    this.fov = this.isParallel ? this.perspectiveFov : PARALLEL_FOV;
    this.distance = height / (2 * Math.tan(toRadians(this.fov) / 2));
  }

  /** Shows a sphere whole in a picture of this width over height. */
  frameSphere(center, radius, aspect) {
    const half = toRadians(this.fov) / 2;
    const narrow = Math.min(half, Math.atan(Math.tan(half) * aspect));
    this.target = [...center];
    this.distance = clamp((1.1 * radius) / Math.sin(narrow), ...this.limits);
  }

  /** How near and far zooming goes, from the scene's bounds. */
  setLimits({ lower, upper }) {
    const diagonal = length(subtract(upper, lower));
    if (!(diagonal > 0)) return;
    // The far end leaves room for the distances of parallel projection.
    this.limits = [diagonal * 1e-4, diagonal * 1e4];
  }

  /** Where a point appears, from the middle to the right and down in picture heights, or null behind the eye. */
  project(point) {
    const offset = subtract(point, this.position);
    const depth = dot(offset, this.forward);
    if (depth <= this.distance * 1e-6) return null;
    const height = this.heightAt(depth);
    return [dot(offset, this.right) / height, -dot(offset, this.up) / height];
  }
}

/** What is up in a scene, or what its first camera takes for it. */
export const upAxis = (scene) => snapToAxis(scene.up ?? scene.camera.up);
