// Parameters of all models, a row each.

import { deviation, deviationWords } from "../data";
import { h, section, sized } from "../dom";
import { between, number, scattered } from "../format";
import type { State } from "../state";
import { strips, type Strip } from "./strips";
import type { Tip } from "./tip";

/** Makes the view. */
export function parametersView(state: State, tip: Tip): HTMLElement {
  const front = state.current;
  const plot = h("div", { class: "plot" });
  let update = (): void => {};
  const rows = front.parameters.map((name, j): Strip => {
    const [low, high] = front.interval?.[j] ?? [null, null];
    const interval: [number, number] | null = low === null || high === null ? null : [low, high];
    const [from, to] = front.bounds[j];
    return {
      name,
      value: (i) => front.theta[i][j],
      std: (i) => (interval && i === front.reference ? null : deviation(front, i, j)),
      domain: from === null || to === null ? undefined : [from, to],
      interval,
      text: (i) => {
        const value = front.theta[i][j];
        if (interval && i === front.reference) return `${number(value)} (${between(interval)})`;
        return scattered(value, deviation(front, i, j), front.bounds[j]);
      },
    };
  });
  sized(plot, (width) => {
    state.forget("parameter");
    const chart = strips(state, rows, {
      width,
      key: "parameter",
      label: "values of the parameters of all models, a row a parameter",
      tip,
    });
    update = chart.update;
    plot.replaceChildren(chart.svg);
  });
  state.onChange(() => update());
  return section(
    "parameters",
    "Parameters",
    h(
      "p",
      { class: "lede" },
      "Each line goes from bound to bound. ",
      front.interval
        ? `The broad one is the 90 % interval of the data around ${front.label[front.reference]}; s`
        : "S",
      "hort ones are points of the front, the dot is the chosen model",
      deviationWords(front)
        ? `. ±: ${deviationWords(front)}; “open” is what no data determine.`
        : ". Nothing is known of the errors of the data, so there are no standard deviations.",
    ),
    plot,
  );
}
