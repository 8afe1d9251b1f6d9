// Aspirations: limits that one would like to meet, and the model that comes nearest.

import { frequencyError, leastMac, worstFrequency } from "../data";
import { h, section } from "../dom";
import { fixed, number } from "../format";
import { best, least, nearestTo, optimal, type State } from "../state";

/** An aspiration in the space of errors, shared by its form and the view of the front. */
export class Aspiration {
  errors: (number | null)[];
  private listeners: (() => void)[] = [];

  constructor(private readonly state: State) {
    this.errors = ideal(state);
  }

  /** Starts over for another study. */
  reset(): void {
    this.errors = ideal(this.state);
    this.listeners = [];
  }

  onMove(listener: () => void): void {
    this.listeners.push(listener);
  }

  /** Moves the aspiration and chooses the nearest model; views draw it again unless it is theirs. */
  place(errors: (number | null)[], isDragged = true): void {
    this.errors = errors;
    this.state.choose(nearestTo(this.state.current, errors));
    if (!isDragged) this.listeners.forEach((listener) => listener());
  }
}

function ideal(state: State): (number | null)[] {
  const front = state.current;
  return front.groups.map((_, g) => {
    const values = optimal(front).map((i) => front.error[i][g] ?? Infinity);
    const low = Math.min(...values);
    return Number.isFinite(low) ? low : null;
  });
}

/** Makes the form. */
export function aspirationView(state: State, aspiration: Aspiration): HTMLElement {
  const front = state.current;
  const answer = h("p", { class: "answer" });
  const percent = h("input", { type: "number", id: "within", min: 0, step: 0.1, value: 2 });
  const mac = h("input", { type: "number", id: "above", min: 0, max: 1, step: 0.01, value: 0.98 });
  const button = h("button", { type: "button" }, "Find the nearest model");
  const seek = (): void => {
    const limit = Math.max(1e-6, Number(percent.value) || 0);
    const floor = Math.min(1, Math.max(0, Number(mac.value) || 0));
    const room = Math.max(1e-6, 1 - floor);
    const excess = (i: number): number => {
      const f = worstFrequency(front, i);
      const m = leastMac(front, i);
      const parts = [f === null ? 0 : f / limit, m === null ? 0 : (1 - m) / room];
      return parts.some((x) => Number.isNaN(x)) ? Infinity : Math.max(...parts);
    };
    const chosen = least(best(front), excess);
    state.choose(chosen);
    const f = worstFrequency(front, chosen);
    const m = leastMac(front, chosen);
    const meets = excess(chosen) <= 1 + 1e-12;
    answer.textContent =
      `${front.label[chosen]} ${meets ? "meets this" : "comes nearest; no Pareto-optimal model meets this"}: ` +
      `frequencies within ${fixed(f, 2)} %${m === null ? "" : `, MAC above ${fixed(m, 4)}`}.`;
  };
  button.addEventListener("click", seek);
  for (const input of [percent, mac]) {
    input.addEventListener("keydown", (event) => {
      if (event.key === "Enter") seek();
    });
  }
  const inputs = front.groups.map((name, g) => {
    const input = h("input", {
      type: "number",
      id: `aspiration-${g}`,
      min: 0,
      step: "any",
      value: aspiration.errors[g] === null ? "" : Number((aspiration.errors[g] as number).toPrecision(3)),
    });
    input.addEventListener("change", () => {
      const next = [...aspiration.errors];
      const value = Number(input.value);
      next[g] = Number.isFinite(value) ? value : null;
      aspiration.place(next, false);
      tell();
    });
    return { input, label: h("label", { for: `aspiration-${g}` }, `e of ${name} `, input) };
  });
  const tell = (): void => {
    const i = state.point;
    answer.textContent =
      `Nearest to the aspiration point: ${front.label[i]}, with ` +
      front.groups.map((name, g) => `e of ${name} = ${number(front.error[i][g], 3)}`).join(", ") +
      ".";
  };
  const hasFrequencies = front.modes.some((_, r) => frequencyError(front, front.order[0] ?? 0, r) !== null);
  const view = section(
    "aspiration",
    "What would do?",
    h(
      "div",
      { class: "controls" },
      hasFrequencies ? h("label", { for: "within" }, "frequencies within ", percent, " %") : null,
      h("label", { for: "above" }, "MAC above ", mac),
      button,
    ),
    h(
      "details",
      {},
      h("summary", {}, "Errors of the groups instead"),
      h(
        "p",
        { class: "note" },
        front.groups.length === 2
          ? "The same as dragging the diamond in the view of the front."
          : "The model with the least of the greatest excesses is chosen.",
      ),
      h("div", { class: "controls" }, ...inputs.map((each) => each.label)),
    ),
    answer,
  );
  let last = aspiration.errors;
  state.onChange(() => {
    if (aspiration.errors === last) return;
    last = aspiration.errors;
    inputs.forEach(({ input }, g) => {
      const value = aspiration.errors[g];
      input.value = value === null ? "" : String(Number(value.toPrecision(3)));
    });
    tell();
  });
  return view;
}
