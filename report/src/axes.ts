// Scales and axes, drawn as plain SVG.

import { scaleLinear, scaleLog, type ScaleContinuousNumeric } from "d3-scale";
import { s } from "./dom";
import { tick } from "./format";

export type Scale = ScaleContinuousNumeric<number, number>;

/** Returns a scale over some values, with room beside them. */
export function scale(
  values: Iterable<number | null>,
  range: [number, number],
  kind: "linear" | "log" = "linear",
): Scale {
  let known = [...values].filter((x): x is number => x !== null && Number.isFinite(x));
  if (kind === "log") known = known.filter((x) => x > 0);
  if (!known.length) known = kind === "log" ? [0.1, 1] : [0, 1];
  const low = Math.min(...known);
  const high = Math.max(...known);
  if (kind === "log") {
    const room = Math.max(1.08, (high / low) ** 0.06);
    return scaleLog([low / room, high * room], range).clamp(true);
  }
  const room = 0.06 * (high - low) || 0.05 * Math.abs(high) || 1;
  return scaleLinear([low - room, high + room], range);
}

/** Returns ticks that leave room for their texts. */
export function ticks(axis: Scale, space: number): number[] {
  const [a, b] = axis.range();
  const count = Math.max(2, Math.floor(Math.abs(b - a) / space));
  const all = axis.ticks(count);
  if (all.length <= count + 2) return all;
  const decades = all.filter((x) => Math.abs(Math.log10(x) % 1) < 1e-9);
  return decades.length >= 2 ? decades : all.filter((_, i) => i % Math.ceil(all.length / count) === 0);
}

/** Draws the axis below a chart. */
export function bottom(
  axis: Scale,
  y: number,
  top: number,
  label: string,
  format: (x: number) => string = tick,
): SVGGElement {
  const [left, right] = axis.range();
  return s(
    "g",
    { class: "axis", "aria-hidden": "true" },
    ...ticks(axis, 70).flatMap((x) => [
      s("line", { class: "grid", x1: axis(x), x2: axis(x), y1: top, y2: y }),
      s("text", { x: axis(x), y: y + 17, "text-anchor": "middle" }, format(x)),
    ]),
    s("line", { class: "base", x1: left, x2: right, y1: y, y2: y }),
    s("text", { class: "label", x: right, y: y + 36, "text-anchor": "end" }, label),
  );
}

/** Draws the axis to the left of a chart, with its label above it. */
export function left(axis: Scale, x: number, right: number, label: string): SVGGElement {
  const top = Math.min(...axis.range());
  return s(
    "g",
    { class: "axis", "aria-hidden": "true" },
    ...ticks(axis, 44).flatMap((y) => [
      s("line", { class: "grid", x1: x, x2: right, y1: axis(y), y2: axis(y) }),
      s("text", { x: x - 7, y: axis(y) + 4, "text-anchor": "end" }, tick(y)),
    ]),
    s("text", { class: "label", x: 2, y: top - 12 }, label),
  );
}
