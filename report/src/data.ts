// The data of a report: what modefront.reports.payload writes, read back.

export type Row = (number | null)[];

/** Values of an array that is kept in the binary part. */
interface Stored {
  at: number;
  type: "int16" | "int32" | "float32";
  shape: number[];
  scale?: number;
}

/** One quantity that every model predicts. */
export interface Prediction {
  title: string;
  place: string;
  quantity: string;
  unit: string;
  log: boolean;
  values: Row;
  range: Row;
  std: number | null;
  drawn: Row | null;
  note: string;
}

/** Nodes and what is between them, with the basis of all mode shapes. */
export interface Geometry {
  kind: "chain" | "mesh" | "sensors";
  nodes: Float32Array;
  lines: Int32Array;
  faces: Int32Array;
  sensorNode: number[];
  sensorDirection: number[][];
  basis: Float32Array;
  columns: number;
  coefficient: (number | null)[][][];
}

/** A sentence, with what it means and what to do in paragraphs. */
export interface Sentence {
  text: string;
  meaning: string[];
}

/** The results of one study. */
export interface Front {
  name: string;
  study: string;
  inputs: string;
  version: string;
  method: string;
  reference: number;
  nominal: number | null;
  groups: string[];
  parameters: string[];
  modes: number[];
  sensors: string[];
  sets: string[];
  label: string[];
  kind: string[];
  pareto: boolean[];
  converged: boolean[];
  piece: number[];
  order: number[];
  theta: Row[];
  objective: Row[];
  error: Row[];
  frequency: Row[];
  mac: Row[];
  thetaStd: Row[] | null;
  frequencyStd: Row[] | null;
  macStd: Row[] | null;
  posterior: { theta: Row; frequency: Row; mac: Row } | null;
  bounds: Row[];
  /** Ends of the 90 % interval of each parameter. */
  interval: Row[] | null;
  /** Error that is expected of each group. */
  noise: Row;
  measured: Row;
  measuredStd: Row;
  ends: Row[];
  macMatrix: Row[][] | null;
  pairedMode: (number | null)[][] | null;
  modelFrequency: Row[] | null;
  shape: Row[][] | null;
  measuredShape: Row[][] | null;
  geometry: Geometry | null;
  predictions: Prediction[];
  words: { heading: string; sentences: Sentence[] }[];
}

/** All that a report shows. */
export interface Report {
  title: string;
  version: string;
  cite: string[];
  fronts: Front[];
}

/** Returns what gzip in base64 holds. */
export async function inflated(text: string): Promise<ArrayBuffer> {
  const packed = Uint8Array.from(atob(text.trim()), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

/** Reads the data that the page carries. */
export async function read(text: string): Promise<Report> {
  const bytes = await inflated(text);
  const length = new DataView(bytes).getUint32(0, true);
  const report = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  const start = 4 + length;
  for (const front of report.fronts) {
    const stored = front.geometry;
    if (!stored) continue;
    for (const key of ["nodes", "lines", "faces", "basis"]) {
      stored[key] = unpacked(bytes, start, stored[key]);
    }
  }
  return report as Report;
}

function unpacked(bytes: ArrayBuffer, start: number, stored: Stored): Float32Array | Int32Array {
  const count = stored.shape.reduce((a, b) => a * b, 1);
  const at = start + stored.at;
  if (stored.type === "int32") return new Int32Array(bytes.slice(at, at + 4 * count));
  if (stored.type === "float32") return new Float32Array(bytes.slice(at, at + 4 * count));
  const whole = new Int16Array(bytes.slice(at, at + 2 * count));
  return Float32Array.from(whole, (x) => x * (stored.scale ?? 1));
}

/** Displacements x, y, z of all nodes in a mode of a point; null where it has no modes. */
export function displacement(front: Front, point: number, mode: number): Float32Array | null {
  const geometry = front.geometry;
  const coefficients = geometry?.coefficient[point]?.[mode];
  if (!geometry || !coefficients || coefficients.some((c) => c === null)) return null;
  const size = geometry.nodes.length;
  const out = new Float32Array(size);
  coefficients.forEach((c, b) => {
    const offset = b * size;
    for (let i = 0; i < size; i++) out[i] += (c as number) * geometry.basis[offset + i];
  });
  return out;
}

/** Standard deviation of a parameter: of the posterior at the reference, else by errors of the data, linearised. */
export function deviation(front: Front, point: number, parameter: number): number | null {
  const posterior = point === front.reference ? front.posterior?.theta[parameter] : null;
  return posterior ?? front.thetaStd?.[point]?.[parameter] ?? null;
}

/** What `deviation` returns, in words; empty where it has nothing. */
export function deviationWords(front: Front): string {
  const linear = front.thetaStd ? "standard deviation by errors of the data, linearised" : "";
  if (!front.posterior) return linear;
  const posterior = `standard deviation of the posterior at ${front.label[front.reference]}`;
  return linear ? `${posterior}; at other models ${linear}` : posterior;
}

/** Error of a predicted frequency in %; null where it is not measured. */
export function frequencyError(front: Front, point: number, mode: number): number | null {
  const f = front.frequency[point][mode];
  const measured = front.measured[mode];
  return f === null || measured === null || measured === 0 ? null : 100 * (f / measured - 1);
}

/** Greatest error of the frequencies in %; null where none is known. */
export function worstFrequency(front: Front, point: number): number | null {
  const known = front.modes
    .map((_, r) => frequencyError(front, point, r))
    .filter((x): x is number => x !== null);
  return known.length ? Math.max(...known.map(Math.abs)) : null;
}

/** Least MAC; null where none is known. */
export function leastMac(front: Front, point: number): number | null {
  const known = front.mac[point].filter((x): x is number => x !== null);
  return known.length ? Math.min(...known) : null;
}
