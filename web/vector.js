// vector.js — vectors as arrays of three numbers; nothing is changed in place.

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const normalize = (a) => scale(a, 1 / length(a));

/** `a` turned about the unit vector `axis`, counter-clockwise as seen against it (Rodrigues). */
export function rotate(a, axis, angle) {
  const c = Math.cos(angle);
  const s = Math.sin(angle);
  return add(add(scale(a, c), scale(cross(axis, a), s)), scale(axis, dot(axis, a) * (1 - c)));
}

/** The coordinate axis that a direction nearly follows, or the direction itself, as unit vector. */
export function snapToAxis(direction) {
  const unit = normalize(direction);
  const axis = unit.map((x) => (Math.abs(x) > 0.95 ? Math.sign(x) : 0));
  return length(axis) > 0 ? axis : unit;
}
