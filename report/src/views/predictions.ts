// What every model predicts, along the front.

import type { Prediction } from "../data";
import { h, section, sized } from "../dom";
import { number, times } from "../format";
import type { State } from "../state";
import { along } from "./along";
import { bar } from "./mac";
import type { Tip } from "./tip";

/** Makes the view; null where the study has no predictions. */
export function predictionsView(state: State, tip: Tip): HTMLElement | null {
  const front = state.current;
  if (!front.predictions.length) return null;
  const grid = h("div", { class: "panels" });
  const panels = front.predictions.map((each, k) => panel(state, each, k, tip));
  grid.append(...panels);
  return section(
    "predictions",
    "Predictions",
    h(
      "p",
      { class: "lede" },
      "What each Pareto-optimal model predicts. All of them are as good as the data can tell, each with other weights ",
      "of the groups: their spread is what the choice of weights leaves open. The bar at the reference is its posterior, ",
      "what errors of the data leave open at fixed weights.",
    ),
    grid,
  );
}

function panel(state: State, prediction: Prediction, index: number, tip: Tip): HTMLElement {
  const front = state.current;
  const figure = h("figure", {});
  const plot = h("div", { class: "plot" });
  const value = h("strong", {});
  const [low, high, spread] = prediction.range;
  const unit = prediction.unit && prediction.unit !== "1" ? ` ${prediction.unit}` : "";
  const scatter = posterior(prediction, front.reference);
  const words = [
    `over the Pareto-optimal models ${number(low, 3)} to ${number(high, 3)}${unit}`,
    spread === null ? "" : `: they differ ${times(spread)}`,
    scatter ? `; posterior of ${front.label[front.reference]} ${scatter.words}` : "",
  ];
  figure.append(
    h("figcaption", {}, h("strong", {}, prediction.place), h("br"), `${prediction.quantity}${unit ? `, ${prediction.unit}` : ""}: `, value),
    plot,
    h("p", { class: "note" }, `${words.join("")}.${prediction.note ? ` ${prediction.note}` : ""}`),
  );
  let update = (): void => {};
  sized(plot, (width) => {
    const chart = along(
      state,
      [
        {
          name: prediction.quantity,
          colour: `var(--series-${(index % 6) + 1})`,
          value: (i) => prediction.values[i],
          bar: scatter?.bar ?? null,
        },
      ],
      {
        width,
        height: 210,
        key: `prediction-${index}`,
        title: `${prediction.place}: ${prediction.quantity} along the front`,
        label: unit ? prediction.unit : "",
        log: prediction.log,
        tip,
      },
    );
    state.forget(`prediction-${index}`);
    update = chart.update;
    plot.replaceChildren(chart.svg);
  });
  const refresh = (): void => {
    value.textContent = number(prediction.values[state.point]);
    update();
  };
  state.onChange(() => refresh());
  refresh();
  return figure;
}

function posterior(
  prediction: Prediction,
  reference: number,
): { bar: [number, number]; words: string } | null {
  const { drawn, std, log } = prediction;
  const middle = prediction.values[reference];
  if (drawn && drawn[0] !== null && drawn[1] !== null) {
    return {
      bar: [drawn[0], drawn[1]],
      words: `${number(drawn[0], 3)} to ${number(drawn[1], 3)} (5 to 95 % of models drawn from it)`,
    };
  }
  if (middle === null || std === null || !Number.isFinite(std)) return null;
  if (log) {
    const factor = Math.exp(std);
    return { bar: [middle / factor, middle * factor], words: `× or ÷ ${number(factor, 3)}` };
  }
  const ends = bar(middle, std);
  return ends && { bar: ends, words: `± ${number(std, 3)}` };
}
