// Mode shapes of sensors, moving; the view is turned by dragging.

import { h, s, section, sized } from "../dom";
import { number } from "../format";
import { named, type DataSet } from "../identification";

/** Returns pairs of sensors that are joined: the shortest tree over all. */
function joined(positions: number[][]): [number, number][] {
  const out: [number, number][] = [];
  const inside = new Set([0]);
  const far = (a: number, b: number): number => Math.hypot(...positions[a].map((x, c) => x - positions[b][c]));
  while (inside.size < positions.length) {
    let best: [number, number] | null = null;
    for (const a of inside) {
      for (let b = 0; b < positions.length; b++) {
        if (!inside.has(b) && (!best || far(a, b) < far(...best))) best = [a, b];
      }
    }
    if (!best) break;
    out.push(best);
    inside.add(best[1]);
  }
  return out;
}

/** Makes the view. */
export function movingShape(set: DataSet): HTMLElement {
  const select = h("select", { "aria-label": "mode" });
  set.modes.forEach((mode, k) => select.append(h("option", { value: k }, `mode ${named(mode)}: ${number(mode.frequency, 5)} Hz`)));
  const still = h("button", { type: "button", "aria-pressed": "false" }, "Stop");
  const stage = h("div", { class: "stage" });
  stage.style.height = "320px";
  const tree = joined(set.positions);
  const count = set.positions.length;
  const middle = [0, 1, 2].map((c) => set.positions.reduce((sum, x) => sum + x[c], 0) / count);
  const size = Math.max(...set.positions.map((x) => Math.hypot(...x.map((y, c) => y - middle[c]))), 1e-9);
  // A row of sensors is seen from the side.
  const row = set.positions.every((x) => x[1] === 0 && x[2] === 0);
  let [turn, tilt, width] = row ? [0, 0, 0] : [0.5, 0.35, 0];
  const svg = s("svg", { height: 320, role: "img", "aria-label": "mode shape" });
  const [calm, lines] = ["var(--faint)", ""].map((stroke) => tree.map(() => s("line", stroke ? { stroke } : { class: "stroke" })));
  const dots = set.positions.map((_, k) => {
    const dot = s("circle", { class: "dot", r: 4 });
    dot.append(s("title", {}, set.sensors[k]));
    return dot;
  });
  svg.append(...calm, ...lines, ...dots);
  stage.append(svg);
  const draw = (phase: number): void => {
    const shape = set.modes[Number(select.value)]?.shape ?? [];
    const most = Math.max(...shape.map((x) => Math.abs(x ?? 0)), 1e-9);
    const reach = (0.3 * size * Math.sin(phase)) / most;
    const projected = ([a, b, c]: number[]): [number, number] => {
      const deep = a * Math.sin(turn) + b * Math.cos(turn);
      return [a * Math.cos(turn) - b * Math.sin(turn), c * Math.cos(tilt) + deep * Math.sin(tilt)];
    };
    // The structure at rest, with room for the motion about it, fills the stage.
    const rest = set.positions.map((x) => projected(x.map((y, axis) => y - middle[axis])));
    const half = [0, 1].map((axis) => Math.max(...rest.map((x) => Math.abs(x[axis]))) + 0.3 * size);
    const unit = Math.min((width / 2 - 8) / half[0], 152 / half[1]);
    const placed = ([across, up]: [number, number]): [number, number] => [width / 2 + unit * across, 160 - unit * up];
    const seen = set.positions.map((x, k) =>
      placed(projected(x.map((y, axis) => y - middle[axis] + reach * (shape[k] ?? 0) * set.directions[k][axis]))),
    );
    const base = rest.map(placed);
    for (const [of, at] of [[calm, base], [lines, seen]] as const) {
      tree.forEach(([a, b], k) => {
        for (const [name, value] of Object.entries({ x1: at[a][0], y1: at[a][1], x2: at[b][0], y2: at[b][1] })) {
          of[k].setAttribute(name, value.toFixed(1));
        }
      });
    }
    seen.forEach(([x, y], k) => {
      dots[k].setAttribute("cx", x.toFixed(1));
      dots[k].setAttribute("cy", y.toFixed(1));
    });
  };
  let moving = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  const label = (): void => {
    still.textContent = moving ? "Stop" : "Move";
    still.setAttribute("aria-pressed", String(!moving));
  };
  const step = (time: number): void => {
    if (!moving || !stage.isConnected) return;
    draw(time / 300);
    requestAnimationFrame(step);
  };
  still.addEventListener("click", () => {
    moving = !moving;
    label();
    if (moving) requestAnimationFrame(step);
  });
  stage.addEventListener("pointermove", (event) => {
    if (!event.buttons) return;
    turn += event.movementX / 150;
    tilt = Math.max(-1.5, Math.min(1.5, tilt + event.movementY / 150));
    if (!moving) draw(Math.PI / 2);
  });
  select.addEventListener("change", () => draw(Math.PI / 2));
  sized(stage, (to) => {
    svg.setAttribute("width", String((width = to)));
    draw(Math.PI / 2);
    if (moving) requestAnimationFrame(step);
  });
  label();
  const note = "The test file says nothing of where the sensors are: they stand in their order. [geometry] places them.";
  return section("mode shape", "Mode shapes", h("div", { class: "controls" }, select, still), stage, set.placed ? null : h("p", { class: "note" }, note));
}
