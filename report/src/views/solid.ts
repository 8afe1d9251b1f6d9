// What is drawn of a mode shape: nodes with the displacement of each, lines and faces between them.

import { displacement, type Front, type Geometry } from "../data";

/** A body that can be deformed: each vertex moves with weighted nodes. */
export interface Solid {
  /** Coordinates of the vertices at rest. */
  rest: Float32Array;
  lines: Uint32Array;
  /** Corners of triangles. */
  triangles: Uint32Array;
  /** Displacement of the vertices where the nodes have displacements u. */
  moved: (u: Float32Array) => Float32Array;
  centre: [number, number, number];
  /** Half of the diagonal. */
  radius: number;
}

const EDGE = 0.7;
/** Distance from the middle of a floor at which its arrows start. */

const BEND = 10;
/** Pieces of a column, which bends between floors that do not rotate. */

/** Returns the solid of a geometry. */
export function solid(geometry: Geometry): Solid {
  if (geometry.kind === "chain") return building(geometry);
  const { nodes, faces } = geometry;
  const triangles: number[] = [];
  const edges: number[] = [...geometry.lines];
  for (let k = 0; k < faces.length; k += 4) {
    const [a, b, c, d] = faces.subarray(k, k + 4);
    triangles.push(a, b, c);
    edges.push(a, b, b, c);
    if (d >= 0) {
      triangles.push(a, c, d);
      edges.push(c, d, d, a);
    } else edges.push(c, a);
  }
  return finished(nodes, unique(edges), Uint32Array.from(triangles), (u) => u);
}

/** Floors as slabs and columns between them; the ground is the first node. */
function building(geometry: Geometry): Solid {
  const floors = geometry.nodes.length / 3;
  const height = (i: number): number => geometry.nodes[3 * i + 2];
  const half = [0.62, 0.45];
  const thick = 0.045;
  const rest: number[] = [];
  const weights: [number, number, number][] = []; // lower node, upper node, share of the upper one
  const lines: number[] = [];
  const triangles: number[] = [];
  const add = (x: number, y: number, z: number, low: number, high: number, share: number): number => {
    rest.push(x, y, z);
    weights.push([low, high, share]);
    return weights.length - 1;
  };
  for (let i = 0; i < floors; i++) {
    const wide = i === 0 ? 1.25 : 1;
    const corners = [-1, 1].flatMap((sz) =>
      [
        [-1, -1],
        [1, -1],
        [1, 1],
        [-1, 1],
      ].map(([sx, sy]) =>
        add(sx * half[0] * wide, sy * half[1] * wide, height(i) + sz * thick, i, i, 0),
      ),
    );
    const sides = [
      [0, 3, 2, 1],
      [4, 5, 6, 7],
      [0, 1, 5, 4],
      [1, 2, 6, 5],
      [2, 3, 7, 6],
      [3, 0, 4, 7],
    ];
    for (const side of sides) {
      const [a, b, c, d] = side.map((k) => corners[k]);
      triangles.push(a, b, c, a, c, d);
      lines.push(a, b, b, c, c, d, d, a);
    }
    if (i === 0) continue;
    for (const [sx, sy] of [
      [-1, -1],
      [1, -1],
      [1, 1],
      [-1, 1],
    ]) {
      let last = -1;
      for (let k = 0; k <= BEND; k++) {
        const t = k / BEND;
        const z = height(i - 1) + thick + t * (height(i) - height(i - 1) - 2 * thick);
        const share = t * t * (3 - 2 * t);
        const next = add(sx * half[0] * 0.9, sy * half[1] * 0.86, z, i - 1, i, share);
        if (last >= 0) lines.push(last, next);
        last = next;
      }
    }
  }
  const moved = (u: Float32Array): Float32Array => {
    const out = new Float32Array(3 * weights.length);
    weights.forEach(([low, high, share], v) => {
      for (let d = 0; d < 3; d++) {
        out[3 * v + d] = (1 - share) * u[3 * low + d] + share * u[3 * high + d];
      }
    });
    return out;
  };
  return finished(Float32Array.from(rest), unique(lines), Uint32Array.from(triangles), moved);
}

function finished(
  rest: Float32Array,
  lines: Uint32Array,
  triangles: Uint32Array,
  moved: (u: Float32Array) => Float32Array,
): Solid {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  rest.forEach((x, k) => {
    low[k % 3] = Math.min(low[k % 3], x);
    high[k % 3] = Math.max(high[k % 3], x);
  });
  const centre = low.map((x, d) => (x + high[d]) / 2) as [number, number, number];
  const radius = Math.hypot(...low.map((x, d) => high[d] - x)) / 2 || 1;
  return { rest, lines, triangles, moved, centre, radius };
}

function unique(edges: number[]): Uint32Array {
  const seen = new Set<string>();
  const out: number[] = [];
  for (let k = 0; k < edges.length; k += 2) {
    const [a, b] = [edges[k], edges[k + 1]];
    const key = a < b ? `${a} ${b}` : `${b} ${a}`;
    if (!seen.has(key)) {
      seen.add(key);
      out.push(a, b);
    }
  }
  return Uint32Array.from(out);
}

/** An arrow at a sensor: where it starts at rest, and the displacement that it shows. */
export interface Arrow {
  name: string;
  from: [number, number, number];
  along: [number, number, number];
}

/** Sensors in a row, for a model of which it is not known where its sensors are. */
export function row(front: Front): Geometry {
  const n = front.sensors.length;
  const nodes = new Float32Array(3 * n);
  const lines = new Int32Array(Math.max(0, 2 * (n - 1)));
  for (let i = 0; i < n; i++) nodes[3 * i] = (2 * i) / Math.max(1, n - 1);
  for (let i = 0; i < n - 1; i++) lines.set([i, i + 1], 2 * i);
  const basis = new Float32Array(n * 3 * n);
  for (let i = 0; i < n; i++) basis[i * 3 * n + 3 * i + 2] = 1;
  return {
    kind: "sensors",
    nodes,
    lines,
    faces: new Int32Array(0),
    sensorNode: front.sensors.map((_, i) => i),
    sensorDirection: front.sensors.map(() => [0, 0, 1]),
    basis,
    columns: n,
    coefficient: front.shape ?? [],
  };
}

/** Displacements of the nodes in a mode of a point; null where it has no modes. */
export function nodes(front: Front, geometry: Geometry, point: number, mode: number): Float32Array | null {
  return displacement({ ...front, geometry }, point, mode);
}

/** Measured components of a mode in the scale of the model's, by data set. */
export function measured(front: Front, point: number, mode: number): (number | null)[][] {
  const computed = front.shape?.[point]?.[mode];
  if (!computed || !front.measuredShape) return [];
  return front.measuredShape.map((set) => {
    let product = 0;
    let square = 0;
    set[mode].forEach((x, i) => {
      const y = computed[i];
      if (x === null || y === null) return;
      product += x * y;
      square += x * x;
    });
    const factor = square > 0 ? product / square : 0;
    return set[mode].map((x) => (x === null || factor === 0 ? null : x * factor));
  });
}

/** Arrows of components at the sensors; none for rotations and for what is not known. */
export function arrows(
  front: Front,
  geometry: Geometry,
  components: (number | null)[],
): Arrow[] {
  return front.sensors.flatMap((name, i) => {
    const direction = geometry.sensorDirection[i];
    const value = components[i];
    const node = geometry.sensorNode[i];
    if (value === null || !direction.some((d) => d !== 0)) return [];
    const from = [0, 1, 2].map((d) => geometry.nodes[3 * node + d]);
    // Beside a floor, on the side to which it moves.
    if (geometry.kind === "chain") from[0] += Math.sign(direction[0] * value) * EDGE;
    const along = direction.map((d) => d * value);
    return [{ name, from: from as Arrow["from"], along: along as Arrow["along"] }];
  });
}

/** Displacements of a building's floors as they were measured, straight between sensors. */
export function measuredFloors(
  geometry: Geometry,
  components: (number | null)[],
): Float32Array | null {
  const floors = geometry.nodes.length / 3;
  const known = new Map<number, number>([[0, 0]]);
  components.forEach((value, i) => {
    if (value !== null) known.set(geometry.sensorNode[i], value * geometry.sensorDirection[i][0]);
  });
  if (known.size < 2) return null;
  const heights = [...known.keys()].sort((a, b) => a - b);
  const out = new Float32Array(3 * floors);
  for (let i = 0; i < floors; i++) {
    const below = [...heights].reverse().find((k) => k <= i) ?? 0;
    const above = heights.find((k) => k >= i) ?? below;
    const t = above === below ? 0 : (i - below) / (above - below);
    out[3 * i] = (1 - t) * (known.get(below) ?? 0) + t * (known.get(above) ?? 0);
  }
  return out;
}
