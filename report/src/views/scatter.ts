// Models in the space of two groups: marks to click, a brush, the aspiration point.

import { brush, type D3BrushEvent } from "d3-brush";
import { select } from "d3-selection";
import { line } from "d3-shape";
import { bottom, left, scale, type Scale } from "../axes";
import type { Front } from "../data";
import { s } from "../dom";
import { number } from "../format";
import { className, colour, isBeside, isOfPart, outline } from "../marks";
import { optimal, type State } from "../state";

const FAR = 3;
/** Ranges of the front beyond which a model is shown at the margin. */

interface Options {
  width: number;
  height: number;
  key: string;
  groups: [number, number];
  tip: (text: string | null, event?: MouseEvent) => void;
  aspiration?: { at: (number | null)[]; moved: (at: [number, number]) => void };
}

/** Draws the chart and returns it with what brings it up to date. */
export function scatter(state: State, options: Options): { svg: SVGSVGElement; update: () => void } {
  const { width, height, groups } = options;
  const margin = { left: 62, right: 16, top: 30, bottom: 44 };
  const fronts = state.report.fronts;
  const isLog = state.scale === "log";
  const value = (front: Front, i: number, axis: 0 | 1): number | null =>
    front[state.quantity][i][groups[axis]];
  /** Values about the reference that differ from it by less than noise, half of what is expected. */
  const noise = (axis: 0 | 1): [number, number] | null => {
    const front = state.current;
    const expected = front.noise[groups[axis]];
    const at = front.error[front.reference]?.[groups[axis]];
    if (expected === null || at === null || at === undefined || !Number.isFinite(expected)) return null;
    const ends = [Math.max(isLog ? 0.01 * at : 0, at - expected / 2), at + expected / 2];
    return ends.map((e) =>
      state.quantity === "error" ? e : fromError(front, groups[axis], e),
    ) as [number, number];
  };
  const axes = ([0, 1] as const).map((axis) => {
    const range: [number, number] =
      axis === 0
        ? [margin.left, width - margin.right]
        : [height - margin.bottom, margin.top];
    const near = shown(fronts, (front, i) => value(front, i, axis), isLog);
    return scale([...near, ...(noise(axis) ?? [])], range, state.scale);
  }) as [Scale, Scale];
  const [x, y] = axes;
  const symbol = state.quantity === "error" ? "error of" : "J of";
  const names = groups.map((g) => `${symbol} ${state.current.groups[g]}`);
  const svg = s("svg", {
    width,
    height,
    viewBox: `0 0 ${width} ${height}`,
    role: "img",
    "aria-label": `${names[1]} over ${names[0]} of all models`,
  });
  svg.append(
    bottom(x, height - margin.bottom, margin.top, names[0]),
    left(y, margin.left, width - margin.right, names[1]),
  );
  const [across, along] = [noise(0), noise(1)];
  if (across && along) {
    const [x0, x1] = across.map((v) => x(v));
    const [y1, y0] = along.map((v) => y(v));
    svg.append(
      s("rect", { class: "band", x: x0, y: y0, width: Math.max(3, x1 - x0), height: Math.max(3, y1 - y0) }),
    );
  }
  const brushes = s("g", { class: "brush" });
  const lines = s("g", { class: "lines" });
  const marks = s("g", {});
  svg.append(brushes, lines, marks);

  const place = (front: Front, i: number): [number, number, boolean] => {
    const raw = [value(front, i, 0), value(front, i, 1)];
    let inside = true;
    const at = raw.map((v, axis) => {
      const [low, high] = axes[axis].domain();
      const known = v ?? high;
      if (known < low || known > high) inside = false;
      return axes[axis](Math.min(high, Math.max(low, known)));
    });
    return [at[0], at[1], inside];
  };

  const drawn: { front: number; point: number; node: SVGElement; at: [number, number] }[] = [];
  const ring = s("circle", { class: "ring", r: 10 });
  fronts.forEach((front, f) => {
    const paths = branches(front).map((points) =>
      s("path", {
        d: line()(points.map((i) => place(front, i).slice(0, 2) as [number, number])) ?? "",
        class: "branch",
        stroke: colour(fronts.length, f, front.piece[points[0]]),
      }),
    );
    if (front.groups.length === 2) lines.append(...paths);
    // Points of the front are drawn last: they are what is walked along.
    const behind = front.label.map((_, i) => i).filter((i) => isBeside(front.kind[i]) && !isOfPart(front.kind[i]));
    const order = [...behind, ...front.order];
    for (const i of order) {
      const [px, py, inside] = place(front, i);
      const tint = colour(fronts.length, f, front.piece[i]);
      const onFront = !isBeside(front.kind[i]);
      const words = `${fronts.length > 1 ? `${front.name}: ` : ""}${front.label[i]}`;
      const node = onFront
        ? s("circle", { cx: px, cy: py, r: front.pareto[i] ? 4.6 : 4 })
        : s("path", { d: outline(front.kind[i]), transform: `translate(${px},${py})` });
      node.setAttribute("class", onFront ? `mark ${front.pareto[i] ? "filled" : "hollow"}` : className(front.kind[i]));
      node.setAttribute("data-label", front.label[i]);
      node.style.setProperty("--tint", tint);
      if (!inside) node.classList.add("far");
      node.addEventListener("click", () => state.choose(i, f));
      node.addEventListener("mouseenter", (event) =>
        options.tip(
          `${words}\n${groups.map((g, k) => `${names[k]} ${number(front[state.quantity][i][g])}`).join("\n")}` +
            (inside ? "" : "\nbeyond the axes: shown at their margin"),
          event as MouseEvent,
        ),
      );
      node.addEventListener("mouseleave", () => options.tip(null));
      marks.append(node);
      drawn.push({ front: f, point: i, node, at: [px, py] });
    }
    for (const end of front.ends) {
      const at = groups.map((g, k) => {
        const J = end[g];
        if (J === null) return null;
        // Ends are known as J: that over its count is the square of the error.
        const raw = state.quantity === "objective" ? J : toError(front, g, J);
        return raw === null ? null : axes[k](raw);
      });
      if (at.some((v) => v === null)) continue;
      lines.append(
        s("circle", { class: "end", cx: at[0] as number, cy: at[1] as number, r: 7 }),
      );
    }
  });
  marks.append(ring);

  const area = brush<unknown>()
    .touchable(false) // fingers scroll
    .extent([
      [margin.left, margin.top],
      [width - margin.right, height - margin.bottom],
    ])
    .on("start brush end", (event: D3BrushEvent<unknown>) => {
      if (!event.sourceEvent) return;
      const selection = event.selection as [[number, number], [number, number]] | null;
      const clear = (): void => {
        select(brushes).call(area.move as never, null);
      };
      if (!selection) {
        if (event.type === "end") state.brush(options.key, null, clear);
        return;
      }
      const [[x0, y0], [x1, y1]] = selection;
      const test = (front: Front, i: number): boolean => {
        const [px, py] = place(front, i);
        return px >= x0 && px <= x1 && py >= y0 && py <= y1;
      };
      state.brush(options.key, test, clear);
    });
  select(brushes).call(area as never);

  if (options.aspiration) {
    const { at, moved } = options.aspiration;
    const goal = s("g", { class: "goal" });
    const limit = (v: number, axis: 0 | 1): number => {
      const [a, b] = axes[axis].range();
      return Math.min(Math.max(v, Math.min(a, b)), Math.max(a, b));
    };
    const [gx, gy] = groups.map((g, k) => {
      const raw = at[g] ?? axes[k].domain()[0];
      const shownValue = state.quantity === "error" ? raw : fromError(state.current, g, raw);
      return limit(axes[k](shownValue), k as 0 | 1);
    });
    const move = (px: number, py: number): void => {
      goal.setAttribute("transform", `translate(${px},${py})`);
    };
    goal.append(
      s("circle", { r: 14, class: "grip" }),
      s("path", { d: "M0,-8L8,0L0,8L-8,0Z" }),
      s("title", {}, "what would do: drag it"),
    );
    goal.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      event.stopPropagation();
      goal.setPointerCapture(event.pointerId);
      const drag = (to: PointerEvent): void => {
        const box = svg.getBoundingClientRect();
        const px = limit(to.clientX - box.left, 0);
        const py = limit(to.clientY - box.top, 1);
        move(px, py);
        const raw = [x.invert(px), y.invert(py)] as [number, number];
        const errors = groups.map((g, k) =>
          state.quantity === "error" ? raw[k] : (toError(state.current, g, raw[k]) ?? 0),
        ) as [number, number];
        moved(errors);
      };
      const end = (): void => {
        goal.removeEventListener("pointermove", drag);
        goal.removeEventListener("pointerup", end);
        goal.removeEventListener("pointercancel", end);
      };
      goal.addEventListener("pointermove", drag);
      goal.addEventListener("pointerup", end);
      goal.addEventListener("pointercancel", end);
    });
    move(gx, gy);
    svg.append(goal);
  }

  const update = (): void => {
    for (const { front, point, node, at } of drawn) {
      const isChosen = front === state.front && point === state.point;
      node.classList.toggle("chosen", isChosen);
      node.classList.toggle("dimmed", !state.within(fronts[front], point));
      if (isChosen) {
        ring.setAttribute("cx", String(at[0]));
        ring.setAttribute("cy", String(at[1]));
      }
    }
  };
  update();
  return { svg, update };
}

/** Values of models that the axes are to show: those far from the front stay at the margin. */
function shown(
  fronts: Front[],
  value: (front: Front, i: number) => number | null,
  isLog: boolean,
): number[] {
  const known = (x: number | null): x is number => x !== null && Number.isFinite(x);
  const near = fronts.flatMap((front) => front.order.map((i) => value(front, i)).filter(known));
  const all = fronts.flatMap((front) => front.label.map((_, i) => value(front, i)).filter(known));
  if (!near.length || isLog) return all;
  const low = Math.min(...near);
  const high = Math.max(...near);
  const size = high - low || Math.abs(high) || 1;
  return all.filter((v) => v >= low - FAR * size && v <= high + FAR * size);
}

/** Pareto-optimal points of each branch, in their order. */
export function branches(front: Front): number[][] {
  const out: number[][] = [];
  let last = -1;
  for (const i of optimal(front)) {
    if (front.piece[i] !== last || !out.length) out.push([]);
    out[out.length - 1].push(i);
    last = front.piece[i];
  }
  return out;
}

function counts(front: Front, g: number): number | null {
  for (const i of front.label.keys()) {
    const J = front.objective[i][g];
    const e = front.error[i][g];
    if (J !== null && e !== null && J > 0 && e > 0) return J / (e * e);
  }
  return null;
}

function toError(front: Front, g: number, J: number): number | null {
  const a = counts(front, g);
  return a === null ? null : Math.sqrt(Math.max(0, J) / a);
}

function fromError(front: Front, g: number, e: number): number {
  return (counts(front, g) ?? 1) * e * e;
}
