// Marks of models: one shape for each reason why a model is reported.

import {
  symbol,
  symbolCircle,
  symbolCross,
  symbolDiamond,
  symbolSquare,
  symbolStar,
  symbolTriangle,
  symbolWye,
  type SymbolType,
} from "d3-shape";
import type { Front } from "./data";
import { s } from "./dom";

const SHAPES: Record<string, [SymbolType, number]> = {
  front: [symbolCircle, 60],
  edge: [symbolSquare, 110],
  "given-weights": [symbolDiamond, 70],
  "equal-weights": [symbolTriangle, 70],
  "optimal-weights": [symbolWye, 90],
  "most-probable": [symbolStar, 110],
  "identifiable-part": [symbolWye, 40],
  "identifiable-edge": [symbolSquare, 50],
  nominal: [symbolCross, 70],
};

const WORDS: Record<string, string> = {
  edge: "edges: best in one group",
  "given-weights": "given weights",
  "equal-weights": "equal weights",
  "optimal-weights": "optimal weights",
  "most-probable": "most probable",
  "identifiable-part": "front without flat parts",
  "identifiable-edge": "its edges",
  nominal: "nominal",
};

/** Kinds that stand beside the front, in the order in which they are drawn. */
export const BESIDE = Object.keys(WORDS).filter((kind) => !isOfPart(kind));

/** Returns the colour of a model: of its front where there are several, else of its branch. */
export function colour(fronts: number, front: number, piece: number): string {
  const index = fronts > 1 ? front : Math.max(0, piece - 1);
  return `var(--series-${(index % 6) + 1})`;
}

/** Returns the outline of the mark of a kind of models. */
export function outline(kind: string, factor = 1): string {
  const [type, size] = SHAPES[kind] ?? SHAPES["given-weights"];
  return symbol(type, size * factor)() ?? "";
}

/** Returns the entries of a legend: a mark and what it stands for. */
export function legend(front: Front): HTMLElement[] {
  const kinds = BESIDE.filter((kind) => front.kind.includes(kind));
  const entries: [string, string, string][] = [["front", "Pareto optimal", "mark filled"]];
  if (front.order.some((i) => !front.pareto[i])) {
    entries.push(["front", "dominated", "mark hollow"]);
  }
  entries.push(...kinds.map((kind): [string, string, string] => [kind, WORDS[kind], className(kind)]));
  return entries.map(([kind, words, name]) => {
    const path = s("path", { d: outline(kind, 0.8), class: name });
    const svg = s(
      "svg",
      { width: 16, height: 16, viewBox: "-8 -8 16 16", "aria-hidden": "true" },
      path,
    );
    const item = document.createElement("span");
    item.append(svg, words);
    return item;
  });
}

/** Returns the class of the mark of a kind beside the front. */
export function className(kind: string): string {
  if (kind === "edge" || kind === "identifiable-edge") return "mark outline";
  return kind === "nominal" ? "mark nominal" : "mark special";
}

/** Whether a kind stands out beside the front: all but the front itself. */
export function isBeside(kind: string): boolean {
  return kind !== "front";
}

/** Whether a kind is of the front without its flat parts, which is close to the front itself. */
export function isOfPart(kind: string): boolean {
  return kind.startsWith("identifiable");
}
