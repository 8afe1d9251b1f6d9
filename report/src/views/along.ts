// Values along the front: the number of the point on the abscissa, other models beside it.

import { brushX, type D3BrushEvent } from "d3-brush";
import { scaleLinear } from "d3-scale";
import { select } from "d3-selection";
import { line } from "d3-shape";
import { left, scale } from "../axes";
import { s } from "../dom";
import { number } from "../format";
import { className, isBeside, isOfPart, outline } from "../marks";
import type { State } from "../state";

/** A line: its name, its values, and what is known of them at the reference. */
export interface Along {
  name: string;
  colour: string;
  value: (point: number) => number | null;
  /** Ends of the bar at the reference. */
  bar?: [number, number] | null;
}

interface Options {
  width: number;
  height: number;
  key: string;
  title: string;
  label: string;
  log?: boolean;
  measured?: number | null;
  tip: (text: string | null, event?: MouseEvent) => void;
}

/** Draws the chart and returns it with what brings it up to date. */
export function along(
  state: State,
  lines: Along[],
  options: Options,
): { svg: SVGSVGElement; update: () => void } {
  const front = state.current;
  const { width, height } = options;
  const margin = { left: 58, right: lines.length > 1 ? 70 : 14, top: 26, bottom: 34 };
  const beside = front.label
    .map((_, i) => i)
    .filter((i) => isBeside(front.kind[i]) && front.kind[i] !== "edge" && !isOfPart(front.kind[i]));
  const count = front.order.length;
  const gap = beside.length ? 18 * beside.length + 12 : 0;
  const x = scaleLinear([0.5, count + 0.5], [margin.left, width - margin.right - gap]);
  const at = (i: number): number | null => {
    const step = front.order.indexOf(i);
    if (step >= 0) return x(step + 1);
    const k = beside.indexOf(i);
    return k >= 0 ? width - margin.right - gap + 12 + 18 * (k + 0.5) : null;
  };
  const values = lines.flatMap((each) => [
    ...[...front.order, ...beside].map(each.value),
    ...(each.bar ?? []),
  ]);
  const y = scale([...values, options.measured ?? null], [height - margin.bottom, margin.top], options.log ? "log" : "linear");
  const svg = s("svg", {
    width,
    height,
    viewBox: `0 0 ${width} ${height}`,
    role: "img",
    "aria-label": options.title,
  });
  const steps = x.ticks(Math.min(count, Math.floor(width / 60))).filter((t) => Number.isInteger(t) && t >= 1 && t <= count);
  svg.append(
    left(y, margin.left, width - margin.right, options.label),
    s(
      "g",
      { class: "axis", "aria-hidden": "true" },
      s("line", { class: "base", x1: margin.left, x2: width - margin.right, y1: height - margin.bottom, y2: height - margin.bottom }),
      ...steps.map((t) =>
        s("text", { x: x(t), y: height - margin.bottom + 16, "text-anchor": "middle" }, String(t)),
      ),
      s("text", { class: "label", x: margin.left, y: height - 4 }, "point of the front"),
    ),
  );
  if (options.measured !== undefined && options.measured !== null) {
    const m = y(options.measured);
    svg.append(s("line", { class: "measured", x1: margin.left, x2: width - margin.right, y1: m, y2: m }));
  }
  const cursor = s("line", { class: "cursor", y1: margin.top, y2: height - margin.bottom });
  const holder = s("g", { class: "brush" });
  svg.append(cursor, holder);
  const area = brushX<unknown>()
    .touchable(false) // fingers scroll
    .extent([
      [margin.left, margin.top],
      [width - margin.right - gap, height - margin.bottom],
    ])
    .on("start brush end", (event: D3BrushEvent<unknown>) => {
      if (!event.sourceEvent) return;
      const clear = (): void => {
        select(holder).call(area.move as never, null);
      };
      const selection = event.selection as [number, number] | null;
      if (!selection) {
        if (event.type === "end") state.brush(options.key, null, clear);
        return;
      }
      const [a, b] = selection;
      state.brush(
        options.key,
        (other, i) => {
          const px = other === front ? at(i) : null;
          return px !== null && px >= a && px <= b;
        },
        clear,
      );
    });
  select(holder).call(area as never);

  const nodes: { point: number; node: SVGElement }[] = [];
  const ends: { y: number; each: Along }[] = [];
  for (const each of lines) {
    const known = (i: number): number | null => {
      const v = each.value(i);
      return v === null || !Number.isFinite(v) || (options.log && v <= 0) ? null : v;
    };
    const path = line<number>()
      .defined((i) => front.pareto[i] && known(i) !== null)
      .x((i) => at(i) as number)
      .y((i) => y(known(i) as number));
    // Neighbours in number are neighbours on the front of two groups alone.
    if (front.groups.length === 2) {
      const stroke = s("path", { class: "series", d: path(front.order) ?? "" });
      stroke.style.setProperty("--tint", each.colour);
      svg.append(stroke);
    }
    for (const i of [...front.order, ...beside]) {
      const v = known(i);
      const px = at(i);
      if (v === null || px === null) continue;
      const special = isBeside(front.kind[i]);
      const node = special
        ? s("path", { d: outline(front.kind[i], 0.6), transform: `translate(${px},${y(v)})` })
        : s("circle", { cx: px, cy: y(v), r: 3.4 });
      node.setAttribute("class", special ? className(front.kind[i]) : `mark ${front.pareto[i] ? "filled" : "hollow"}`);
      node.setAttribute("data-label", front.label[i]);
      node.style.setProperty("--tint", each.colour);
      node.addEventListener("click", () => state.choose(i));
      node.addEventListener("mouseenter", (event) =>
        options.tip(`${front.label[i]}\n${each.name} ${number(v)}`, event as MouseEvent),
      );
      node.addEventListener("mouseleave", () => options.tip(null));
      if (each.bar && i === front.reference) {
        const [low, high] = each.bar.map((b) => y(b));
        const bar = s("path", { class: "bar", d: `M${px},${low}V${high}M${px - 4},${low}h8M${px - 4},${high}h8` });
        bar.style.setProperty("--tint", each.colour);
        svg.append(bar);
      }
      svg.append(node);
      nodes.push({ point: i, node });
    }
    const last = [...front.order].reverse().find((i) => known(i) !== null);
    if (lines.length > 1 && last !== undefined) ends.push({ y: y(known(last) as number), each });
  }
  // Names beside the ends of the lines, moved apart where they would cover each other.
  ends.sort((a, b) => a.y - b.y);
  let lowest = margin.top - 20;
  for (const end of ends) {
    const at = Math.max(end.y, lowest + 14);
    lowest = at;
    const name = s("text", { class: "name series-name", x: width - margin.right + 8, y: at + 4 }, end.each.name);
    name.style.setProperty("--tint", end.each.colour);
    svg.append(name);
  }

  const update = (): void => {
    const px = at(state.point) ?? at(front.order[state.step]);
    cursor.toggleAttribute("hidden", px === null);
    if (px !== null) {
      cursor.setAttribute("x1", String(px));
      cursor.setAttribute("x2", String(px));
    }
    for (const { point, node } of nodes) {
      node.classList.toggle("chosen", point === state.point);
      node.classList.toggle("dimmed", !state.within(front, point));
    }
  };
  update();
  return { svg, update };
}
