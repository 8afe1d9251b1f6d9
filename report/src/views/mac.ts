// MAC: every measured mode with every model mode of the chosen model, and the pairs along the front.

import { h, section, sized } from "../dom";
import { fixed, number } from "../format";
import type { State } from "../state";
import { mixed } from "../theme";
import { along } from "./along";
import type { Tip } from "./tip";

/** Makes the view. */
export function macView(state: State, tip: Tip): HTMLElement {
  const front = state.current;
  const matrix = h("div", { class: "scroll", tabindex: 0, role: "group", "aria-label": "matrix of MAC" });
  const plot = h("div", { class: "plot" });
  let update = (): void => {};

  function table(): HTMLElement {
    const of = front.macMatrix?.[state.point];
    if (!of) return h("p", { class: "note" }, "These results hold the MAC of the pairs alone.");
    const count = of[0]?.length ?? 0;
    const paired = front.pairedMode?.[state.point];
    const head = h("tr", {}, h("td", {}, "model"));
    for (let q = 0; q < count; q++) {
      const f = front.modelFrequency?.[state.point]?.[q];
      head.append(
        h(
          "th",
          { scope: "col" },
          `${q + 1}`,
          h("small", {}, number(f, 3)),
        ),
      );
    }
    const body = of.map((row, r) => {
      const cells = row.map((value, q) => {
        const cell = h("td", {}, value === null ? "–" : fixed(value, 2));
        const { background, ink } = mixed(Math.max(0, Math.min(1, value ?? 0)));
        cell.style.background = background;
        cell.style.color = ink;
        if (paired?.[r] === q + 1) cell.classList.add("paired");
        return cell;
      });
      const name = h(
        "th",
        { scope: "row" },
        `measured ${front.modes[r]}`,
        h("small", {}, `${number(front.measured[r], 3)} Hz`),
      );
      return h("tr", {}, name, ...cells);
    });
    return h(
      "table",
      { class: `matrix${count > 9 ? " tiny" : ""}` },
      h("caption", { class: "hidden" }, "MAC of measured and model modes"),
      h("thead", {}, head),
      h("tbody", {}, ...body),
    );
  }

  const known = front.modes.map((_, r) => r).filter((r) => front.order.some((i) => front.mac[i][r] !== null));
  const lines = known.map((r) => ({
    name: `mode ${front.modes[r]}`,
    colour: `var(--series-${(r % 6) + 1})`,
    value: (i: number) => front.mac[i][r],
    bar: bar(front.mac[front.reference][r], front.posterior?.mac[r] ?? null),
  }));
  if (lines.length && front.order.length) {
    sized(plot, (width) => {
      state.forget("mac");
      const chart = along(state, lines, {
        width,
        height: Math.max(240, 60 + 14 * lines.length),
        key: "mac",
        title: "MAC of each mode along the front",
        label: "MAC",
        tip,
      });
      update = chart.update;
      plot.replaceChildren(chart.svg);
    });
  }
  const refresh = (): void => {
    matrix.replaceChildren(table());
    update();
  };
  state.onChange(() => refresh());
  document.addEventListener("themechange", () => matrix.isConnected && refresh());
  refresh();
  return section(
    "MAC",
    "MAC",
    h(
      "p",
      { class: "lede" },
      "How alike shapes are, from 0 to 1, for the chosen model; outlined are the pairs that the study compares.",
    ),
    matrix,
    plot,
  );
}

/** Returns the ends of a bar of one standard deviation to either side. */
export function bar(value: number | null, std: number | null): [number, number] | null {
  if (value === null || std === null || !Number.isFinite(std)) return null;
  return [value - std, value + std];
}
