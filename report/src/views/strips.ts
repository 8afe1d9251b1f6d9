// Rows of strips: a value of every model on each.

import { brushX, type D3BrushEvent } from "d3-brush";
import { scaleLinear } from "d3-scale";
import { select } from "d3-selection";
import { scale, ticks, type Scale } from "../axes";
import { s } from "../dom";
import { tick } from "../format";
import { className, colour, isBeside, isOfPart, outline } from "../marks";
import type { State } from "../state";

/** A row: what it is called, its values, and how it is read. */
export interface Strip {
  name: string;
  /** Value of each point; null where there is none. */
  value: (point: number) => number | null;
  /** Standard deviation at each point. */
  std?: (point: number) => number | null;
  /** Band that is marked, such as the error of a measurement. */
  band?: [number, number];
  /** Text beside the strip for a point. */
  text: (point: number) => string;
  log?: boolean;
  /** Ends of the axis; those of the values unless given. */
  domain?: [number, number];
  /** Ends of an interval that is drawn as a broad line. */
  interval?: [number, number] | null;
}

interface Options {
  width: number;
  key: string;
  label: string;
  /** Whether all rows share one axis. */
  shared?: boolean;
  /** Whether lines of all models are drawn across the rows. */
  lines?: boolean;
  tip: (text: string | null, event?: MouseEvent) => void;
}

const ROW = 40;
const LINE = 14;
const LINES = 8; // of a name that is longer than any one reads
const LETTER = 7.2; // mean width in px

/** Draws the rows and returns them with what brings them up to date. */
export function strips(
  state: State,
  rows: Strip[],
  options: Options,
): { svg: SVGSVGElement; update: () => void } {
  const front = state.current;
  const points = front.label.map((_, i) => i);
  const narrow = options.width < 460;
  const longest = Math.max(8, ...rows.map((row) => row.name.length));
  const most = narrow ? 92 : Math.max(112, 0.3 * options.width);
  const widest = Math.max(8, ...rows.flatMap((row) => points.map((i) => row.text(i).length)));
  const right = Math.min(14 + 6.8 * widest, 0.45 * options.width);
  const margin = { left: Math.min(most, 20 + LETTER * longest), right, top: 8 };
  const names = rows.map((row) => wrapped(row.name, Math.floor((margin.left - 16) / LETTER)));
  const high = Math.max(ROW, ...names.map((lines) => LINE * lines.length + 8));
  const height = margin.top + rows.length * high + (options.shared ? 30 : 8);
  const span: [number, number] = [margin.left, options.width - margin.right];
  const pool = (some: Strip[]): (number | null)[] =>
    some.flatMap((row) => [
      ...points.map(row.value),
      ...(row.band ?? []),
      ...(options.shared ? [0] : []),
    ]);
  const axes: Scale[] = rows.map((row) =>
    row.domain
      ? scaleLinear(row.domain, span)
      : scale(pool(options.shared ? rows : [row]), span, row.log ? "log" : "linear"),
  );
  const svg = s("svg", {
    width: options.width,
    height,
    viewBox: `0 0 ${options.width} ${height}`,
    role: "img",
    "aria-label": options.label,
  });
  const across = s("g", {});
  svg.append(across);
  const nodes: { point: number; node: SVGElement }[] = [];
  const texts: SVGTextElement[] = [];
  const bars: SVGLineElement[] = [];
  const dots: SVGCircleElement[] = [];
  const middle = (k: number): number => margin.top + k * high + high / 2;

  rows.forEach((row, k) => {
    const axis = axes[k];
    const y = middle(k);
    const g = s("g", {});
    svg.append(g);
    if (row.band) {
      const [a, b] = row.band.map((v) => axis(v));
      g.append(s("rect", { class: "band", x: a, y: y - 13, width: Math.max(1, b - a), height: 26 }));
    }
    g.append(s("line", { class: "base", x1: span[0], x2: span[1], y1: y, y2: y }));
    if (row.interval) {
      const [a, b] = row.interval.map((v) => axis(v));
      g.append(
        s("line", { class: "interval", x1: a, x2: Math.max(b, a + 3), y1: y, y2: y, "data-name": row.name }),
      );
    }
    if (row.domain) {
      row.domain.forEach((t, end) =>
        g.append(
          s("line", { class: "tick", x1: axis(t), x2: axis(t), y1: y - 5, y2: y + 5 }),
          s("text", { class: "tiny", x: axis(t), y: y + 18, "text-anchor": end ? "end" : "start" }, tick(t)),
        ),
      );
    } else if (options.shared) {
      g.append(s("line", { class: "zero", x1: axis(0), x2: axis(0), y1: y - 15, y2: y + 15 }));
    } else {
      for (const t of ticks(axis, 84)) {
        g.append(
          s("line", { class: "tick", x1: axis(t), x2: axis(t), y1: y, y2: y + 4 }),
          s("text", { class: "tiny", x: axis(t), y: y + 16, "text-anchor": "middle" }, tick(t)),
        );
      }
    }
    const first = y + 4 - (LINE / 2) * (names[k].length - 1);
    const name = s(
      "text",
      { class: "name", "text-anchor": "end" },
      ...names[k].map((line, n) => s("tspan", { x: margin.left - 12, y: first + n * LINE }, line)),
    );
    if (names[k].length > 1) name.append(s("title", {}, row.name));
    const text = s("text", { class: "value", x: options.width - 2, y: y + 4, "text-anchor": "end" });
    texts.push(text);
    g.append(name, text);

    const key = `${options.key}-${k}`;
    const holder = s("g", { class: "brush" });
    const area = brushX<unknown>()
      .touchable(false) // fingers scroll
      .extent([
        [span[0], y - 15],
        [span[1], y + 15],
      ])
      .on("start brush end", (event: D3BrushEvent<unknown>) => {
        if (!event.sourceEvent) return;
        const clear = (): void => {
          select(holder).call(area.move as never, null);
        };
        const selection = event.selection as [number, number] | null;
        if (!selection) {
          if (event.type === "end") state.brush(key, null, clear);
          return;
        }
        state.brush(
          key,
          (other, i) => {
            const v = other === front ? row.value(i) : null;
            return v !== null && axis(v) >= selection[0] && axis(v) <= selection[1];
          },
          clear,
        );
      });
    select(holder).call(area as never);
    g.append(holder);

    const order = [...front.order, ...points.filter((i) => isBeside(front.kind[i]) && !isOfPart(front.kind[i]))];
    for (const i of order) {
      const v = row.value(i);
      if (v === null || !Number.isFinite(v)) continue;
      const x = axis(v);
      const beside = isBeside(front.kind[i]);
      const node = beside
        ? s("path", { d: outline(front.kind[i], 0.7), transform: `translate(${x},${y})` })
        : s("line", { x1: x, x2: x, y1: y - 8, y2: y + 8 });
      node.setAttribute(
        "class",
        beside ? className(front.kind[i]) : `stroke ${front.pareto[i] ? "" : "faint"}`,
      );
      node.setAttribute("data-label", front.label[i]);
      node.style.setProperty("--tint", colour(state.report.fronts.length, state.front, front.piece[i]));
      node.addEventListener("click", () => state.choose(i));
      node.addEventListener("mouseenter", (event) =>
        options.tip(`${front.label[i]}\n${row.name} ${row.text(i)}`, event as MouseEvent),
      );
      node.addEventListener("mouseleave", () => options.tip(null));
      g.append(node);
      nodes.push({ point: i, node });
    }
    bars.push(s("line", { class: "bar", y1: y, y2: y }));
    dots.push(s("circle", { class: "dot", r: 5.5, cy: y }));
    g.append(bars[k], dots[k]);
  });

  if (options.shared) {
    const y = margin.top + rows.length * high;
    for (const t of ticks(axes[0] ?? scale([], span), 64)) {
      svg.append(
        s("text", { class: "tiny", x: axes[0](t), y: y + 12, "text-anchor": "middle" }, tick(t)),
      );
    }
  }
  const path = s("path", { class: "joined" });
  const others = options.lines
    ? front.order.map((i) => {
        const node = s("path", { class: `across ${front.pareto[i] ? "" : "faint"}`, d: joined(i) });
        node.style.setProperty(
          "--tint",
          colour(state.report.fronts.length, state.front, front.piece[i]),
        );
        nodes.push({ point: i, node });
        return node;
      })
    : [];
  across.append(...others, path);

  function joined(i: number): string {
    const parts = rows.flatMap((row, k) => {
      const v = row.value(i);
      return v === null || !Number.isFinite(v) ? [] : [`${axes[k](v)},${middle(k)}`];
    });
    return parts.length > 1 ? `M${parts.join("L")}` : "";
  }

  const update = (): void => {
    for (const { point, node } of nodes) {
      node.classList.toggle("dimmed", !state.within(front, point));
    }
    rows.forEach((row, k) => {
      const v = row.value(state.point);
      const known = v !== null && Number.isFinite(v);
      dots[k].toggleAttribute("hidden", !known);
      texts[k].textContent = row.text(state.point);
      const std = row.std?.(state.point) ?? null;
      const hasBar = known && std !== null && Number.isFinite(std);
      bars[k].toggleAttribute("hidden", !hasBar);
      if (!known) return;
      dots[k].setAttribute("cx", String(axes[k](v)));
      if (!hasBar) return;
      const [low, high] = axes[k].domain();
      bars[k].setAttribute("x1", String(axes[k](Math.max(low, v - (std as number)))));
      bars[k].setAttribute("x2", String(axes[k](Math.min(high, v + (std as number)))));
    });
    // Rows are joined where there are lines of all models; else a line would mean nothing.
    if (options.lines) path.setAttribute("d", joined(state.point));
  };
  update();
  return { svg, update };
}

/** Returns a text in lines of so many letters: at words where that is possible. */
function wrapped(text: string, letters: number): string[] {
  const lines = [""];
  for (const word of text.split(/\s+/)) {
    const last = lines[lines.length - 1];
    const joined = last ? `${last} ${word}` : word;
    if (joined.length <= letters) {
      lines[lines.length - 1] = joined;
      continue;
    }
    const pieces = word.match(new RegExp(`.{1,${letters}}`, "gsu")) ?? [""];
    if (last) lines.push(pieces.shift() ?? "");
    else lines[lines.length - 1] = pieces.shift() ?? "";
    lines.push(...pieces);
  }
  return lines.length > LINES ? [...lines.slice(0, LINES - 1), "…"] : lines;
}
