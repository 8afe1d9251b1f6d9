// All models as a table, to be kept and to be copied.

import type { Front, Row } from "./data";
import { frequencyError } from "./data";

export type Cell = string | number | boolean | null;

/** Returns the head and a row for each model, of all that is known of them. */
export function everything(front: Front): Cell[][] {
  const columns: [string, (i: number) => Cell][] = [
    ["model", (i) => front.label[i]],
    ["kind", (i) => front.kind[i]],
    ["pareto", (i) => front.pareto[i]],
    ["converged", (i) => front.converged[i]],
  ];
  const add = (names: string[], values: Row[] | null): void => {
    names.forEach((name, k) => values && columns.push([name, (i) => values[i][k]]));
  };
  add(front.groups.map((g) => `J ${g}`), front.objective);
  add(front.groups.map((g) => `e ${g}`), front.error);
  add(front.parameters, front.theta);
  add(front.parameters.map((p) => `${p} std`), front.thetaStd);
  add(front.modes.map((r) => `f${r} Hz`), front.frequency);
  front.modes.forEach((r, k) => columns.push([`error f${r} %`, (i) => frequencyError(front, i, k)]));
  add(front.modes.map((r) => `f${r} std Hz`), front.frequencyStd);
  add(front.modes.map((r) => `MAC ${r}`), front.mac);
  for (const each of front.predictions) {
    columns.push([`${each.quantity}, ${each.place}`, (i) => each.values[i]]);
  }
  return [columns.map(([name]) => name), ...front.label.map((_, i) => columns.map(([, of]) => of(i)))];
}

/** Returns a table as CSV (RFC 4180). */
export function csv(rows: Cell[][]): string {
  return rows.map((row) => row.map(quoted).join(",")).join("\r\n") + "\r\n";
}

/** Texts that a spreadsheet would take for a formula get an apostrophe before them. */
function quoted(cell: Cell): string {
  if (cell === null) return "";
  if (typeof cell !== "string") return String(cell);
  const text = /^[=+\-@\t\r]/.test(cell) ? `'${cell}` : cell;
  return /[",\r\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
}

/** Hands a file to the reader. */
export function download(name: string, text: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "text/csv;charset=utf-8" }));
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** Returns a name of a file that every system takes. */
export function fileName(title: string): string {
  return `${title.replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-+|-+$/g, "").slice(0, 80) || "models"}.csv`;
}
