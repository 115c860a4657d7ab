// models.js — small models that the tests show.

/** A box's 8 corners and 12 triangles, seen counter-clockwise from outside. */
function box([x0, y0, z0], [x1, y1, z1]) {
  const vertices = [...Array(8).keys()].map((at) => [at & 1 ? x1 : x0, at & 2 ? y1 : y0, at & 4 ? z1 : z0]);
  const quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
  return { vertices, triangles: quads.flatMap(([a, b, c, d]) => [[a, b, c], [a, c, d]]) };
}

/** A square plate with a square hole: two rings of four corners, below and above. */
function plate(outer, inner, height) {
  const ring = (half, z) => [[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]];
  const vertices = [...ring(outer, 0), ...ring(inner, 0), ...ring(outer, height), ...ring(inner, height)];
  const quads = [0, 1, 2, 3].flatMap((at) => {
    const next = (at + 1) % 4;
    return [
      [at, next, 8 + next, 8 + at],
      [4 + next, 4 + at, 12 + at, 12 + next],
      [8 + at, 8 + next, 12 + next, 12 + at],
      [next, at, 4 + at, 4 + next],
    ];
  });
  return { vertices, triangles: quads.flatMap(([a, b, c, d]) => [[a, b, c], [a, c, d]]) };
}

function objText(objects) {
  let first = 1;
  const lines = [];
  for (const [name, { vertices, triangles }] of Object.entries(objects)) {
    lines.push(`o ${name}`, ...vertices.map((v) => `v ${v.join(" ")}`));
    lines.push(...triangles.map((t) => `f ${t.map((at) => at + first).join(" ")}`));
    first += vertices.length;
  }
  return `${lines.join("\n")}\n`;
}

function stlText(name, { vertices, triangles }) {
  const facets = triangles.map((triangle) => {
    const corners = triangle.map((at) => `vertex ${vertices[at].join(" ")}`);
    return `facet normal 0 0 0\nouter loop\n${corners.join("\n")}\nendloop\nendfacet`;
  });
  return `solid ${name}\n${facets.join("\n")}\nendsolid ${name}\n`;
}

/** A plate with a hole, and a cube that stands on it. */
export const plateAndCube = objText({
  plate: plate(10, 4, 3),
  cube: box([-9, -9, 3.5], [-4.5, -4.5, 8]),
});

/** The plate alone, higher. */
export const plateStl = stlText("frame", plate(10, 5, 8));
