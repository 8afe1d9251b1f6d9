// Errors of the frequencies of all models, a row a mode, against what was measured.

import { frequencyError } from "../data";
import { h, section, sized } from "../dom";
import { fixed, number } from "../format";
import type { State } from "../state";
import { strips, type Strip } from "./strips";
import type { Tip } from "./tip";

/** Makes the view. */
export function frequenciesView(state: State, tip: Tip): HTMLElement {
  const front = state.current;
  const plot = h("div", { class: "plot" });
  let update = (): void => {};
  const hasBands = front.measuredStd.some((x) => x !== null && x > 0);
  const rows = front.modes.map((mode, r): Strip => {
    const measured = front.measured[r];
    const std = front.measuredStd[r];
    const share = measured && std ? (100 * std) / measured : null;
    return {
      name: `mode ${mode}`,
      value: (i) => frequencyError(front, i, r),
      std: (i) => {
        const own = front.frequencyStd?.[i]?.[r] ?? null;
        return own === null || !measured ? null : (100 * own) / measured;
      },
      band: share ? [-share, share] : undefined,
      text: (i) => `${number(front.frequency[i][r])} Hz, ${fixed(frequencyError(front, i, r), 2, true)} %`,
    };
  });
  sized(plot, (width) => {
    state.forget("frequency");
    const chart = strips(state, rows, {
      width,
      key: "frequency",
      label: "errors of the frequencies of all models in %, a row a mode",
      shared: true,
      tip,
    });
    update = chart.update;
    plot.replaceChildren(chart.svg);
  });
  state.onChange(() => update());
  const measured = front.modes.map((mode, r) => {
    const std = front.measuredStd[r];
    const scatter = std ? ` ± ${number(std, 2)}` : "";
    return `mode ${mode}: ${number(front.measured[r])}${scatter} Hz`;
  });
  return section(
    "frequencies",
    "Frequencies",
    h(
      "p",
      { class: "lede" },
      "Errors in % of the measured frequencies; the line at 0 is the measurement",
      hasBands ? ", the band ± one standard deviation of it." : ".",
    ),
    plot,
    h("p", { class: "note" }, `Measured: ${measured.join(" · ")}.`),
  );
}
