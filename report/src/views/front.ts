// The front in the space of objectives: one group, two, or more.

import { choice, h, section, sized } from "../dom";
import { number } from "../format";
import { legend } from "../marks";
import type { State } from "../state";
import type { Aspiration } from "./aspiration";
import { scatter } from "./scatter";
import { strips, type Strip } from "./strips";
import type { Tip } from "./tip";

/** Makes the view. */
export function frontView(state: State, aspiration: Aspiration, tip: Tip): HTMLElement {
  const plot = h("div", { class: "plot" });
  const groups = state.current.groups;
  let updates: (() => void)[] = [];
  let width = 0;

  function draw(): void {
    if (!width) return;
    state.forget("front");
    updates = [];
    const children: Element[] = [];
    if (groups.length === 2) {
      const height = Math.max(300, Math.min(460, Math.round(0.72 * width)));
      const chart = scatter(state, {
        width,
        height,
        key: "front",
        groups: [0, 1],
        tip,
        aspiration: { at: aspiration.errors, moved: (at) => aspiration.place(at) },
      });
      children.push(chart.svg);
      updates.push(chart.update);
    } else {
      const rows = groups.map((name, g): Strip => {
        const value = (i: number): number | null => state.current[state.quantity][i][g];
        return { name, value, text: (i) => number(value(i)), log: state.scale === "log" };
      });
      const label = `${state.quantity === "error" ? "errors" : "J"} of all groups, a row a group`;
      const lines = strips(state, rows, { width, key: "front-group", label, lines: true, tip });
      children.push(lines.svg);
      updates.push(lines.update);
      if (groups.length > 2) {
        const columns = width > 640 ? 3 : width > 420 ? 2 : 1;
        const size = Math.floor((width - 12 * (columns - 1)) / columns);
        const pairs = h("div", { class: "pairs" });
        for (let a = 0; a < groups.length; a++) {
          for (let b = a + 1; b < groups.length; b++) {
            const chart = scatter(state, {
              width: size,
              height: Math.round(0.85 * size),
              key: `front-pair-${a}-${b}`,
              groups: [a, b],
              tip,
            });
            pairs.append(chart.svg);
            updates.push(chart.update);
          }
        }
        children.push(pairs);
      }
    }
    plot.replaceChildren(...children);
  }

  const controls = h(
    "div",
    { class: "controls" },
    choice("quantity", [["error", "error e"], ["objective", "objective J"]], state.quantity, (value) => {
      state.quantity = value as State["quantity"];
      draw();
      state.tell();
    }),
    choice("scale", [["linear", "linear"], ["log", "log"]], state.scale, (value) => {
      state.scale = value as State["scale"];
      draw();
      state.tell();
    }),
  );
  const fronts = state.report.fronts;
  const series =
    fronts.length > 1
      ? fronts.map((front, f) => swatch(front.name, f))
      : [...new Set(state.current.order.map((i) => state.current.piece[i]))]
          .filter((piece) => piece > 0)
          .sort((a, b) => a - b)
          .map((piece, _, all) => (all.length > 1 ? swatch(`branch ${piece}`, piece - 1) : null))
          .filter((node) => node !== null);
  const view = section(
    "front",
    "Front",
    h(
      "p",
      { class: "lede" },
      "Every mark is a model. e = √(J / a) is the root mean square error of a group, a the number of its measured properties; ",
      `better models lie towards the ${groups.length === 2 ? "lower left" : "left"}. `,
      state.current.noise.every((x) => x !== null)
        ? "Within the shaded field, models differ from the reference by less than noise. "
        : "",
      "Click a model, or drag across the chart to select a range.",
    ),
    controls,
    plot,
    h(
      "p",
      { class: "legend" },
      ...series,
      ...legend(state.current),
      groups.length === 2 ? h("span", { class: "goal-word" }, "◇ what would do: drag it") : null,
    ),
  );
  sized(plot, (w) => {
    width = w;
    draw();
  });
  aspiration.onMove(draw);
  state.onChange(() => updates.forEach((update) => update()));
  return view;
}

function swatch(text: string, index: number): HTMLElement {
  const line = h("span", { class: "swatch" });
  line.style.background = `var(--series-${(index % 6) + 1})`;
  return h("span", {}, line, text);
}
