// The page of an identification: poles are chosen by a click, and the lines for the test file follow.

import { scaleLinear } from "d3-scale";
import { bottom, left, type Scale } from "./axes";
import { inflated } from "./data";
import { choice, h, s, section, sized } from "./dom";
import { fixed, number } from "./format";
import { mixed, themeButton } from "./theme";
import { tooltip, type Tip } from "./views/tip";
import { movingShape } from "./views/moving";

type Row = (number | null)[];

interface Mode {
  /** That of the table without choices by hand; none where a seed alone has the mode. */
  number: number | null;
  seed: number | null;
  frequency: number;
  frequencyStd: number;
  damping: number;
  dampingStd: number;
  evidence: number | null;
  orders: number | null;
  seen: number | null;
  collinearity: number;
  flags: string[];
  shape: Row;
}

/** What was identified of one data set. */
export interface DataSet {
  name: string;
  band: [number, number];
  quantity: string;
  modes: Mode[];
  poles: { frequency: number[]; damping: number[]; order: number[]; stable: number[] };
  lines: number[];
  complexIndicators: Row[];
  multivariateIndicators: Row[];
  functions: { name: string; residual: number; measured: Row; synthesised: Row }[];
  mac: number[][];
  sensors: string[];
  /** Whether the positions are those of the test file; else the sensors stand in a row. */
  placed: boolean;
  positions: number[][];
  directions: number[][];
}

interface Identified {
  title: string;
  version: string;
  warnings: string[];
  chosen: { keep: number[]; drop: number[]; seed: number[] };
  sets: DataSet[];
}

const TOP = 28;
const BOTTOM = 44;
const LEFT = 56;

/** Which modes are left out and which poles are added, and the lines of the test file that say so. */
class Choice {
  drop: Set<number>;
  seed: Set<number>;
  changed: (() => void)[] = [];

  constructor(readonly report: Identified) {
    this.drop = new Set(report.chosen.drop);
    this.seed = new Set(report.chosen.seed);
  }

  toggle(of: Set<number>, value: number): void {
    if (!of.delete(value)) of.add(value);
    for (const call of this.changed) call();
  }

  isOut(mode: Mode): boolean {
    return mode.number === null ? !this.seed.has(mode.seed!) : this.drop.has(mode.number);
  }

  leave(mode: Mode): void {
    if (mode.number === null) this.toggle(this.seed, mode.seed!);
    else this.toggle(this.drop, mode.number);
  }

  lines(): string {
    const out = ["[identify]"];
    const sorted = (of: Set<number>): string => [...of].sort((a, b) => a - b).join(", ");
    if (this.report.chosen.keep.length) out.push(`keep = [${this.report.chosen.keep.join(", ")}]`);
    if (this.drop.size) out.push(`drop = [${sorted(this.drop)}]`);
    if (this.seed.size) out.push(`seed = [${sorted(this.seed)}]`);
    return out.length > 1 ? out.join("\n") : "# click on a line to leave out its mode, on a pole to add one";
  }
}

/** Returns the points of a curve, with gaps where nothing is known. */
function curve(x: number[], y: Row, across: Scale, up: Scale): string {
  let pen = "M";
  return x
    .map((f, k) => {
      const value = y[k];
      if (value === null) {
        pen = "M";
        return "";
      }
      const text = `${pen}${across(f).toFixed(1)},${up(value).toFixed(1)}`;
      pen = "L";
      return text;
    })
    .join("");
}

/** Returns a chart of curves over frequency with the modes as lines. */
function chart(
  set: DataSet,
  width: number,
  height: number,
  label: string,
  curves: { values: Row; colour: string; name: string }[],
): { svg: SVGSVGElement; across: Scale } {
  const across = scaleLinear(set.band, [LEFT, width - 12]);
  const known = curves.flatMap((each) => each.values.filter((x): x is number => x !== null));
  const low = known.length ? Math.min(...known) : 0;
  const high = known.length ? Math.max(...known) : 1;
  const up = scaleLinear([low, high === low ? low + 1 : high], [height - BOTTOM, TOP]);
  const svg = s("svg", { width, height, role: "img", "aria-label": label });
  svg.append(
    bottom(across, height - BOTTOM, TOP, "frequency in Hz"),
    left(up, LEFT, width - 12, label),
    ...set.modes.map((mode) =>
      s("line", { class: "cursor", x1: across(mode.frequency), x2: across(mode.frequency), y1: TOP, y2: height - BOTTOM }),
    ),
    ...curves.map((each) => {
      const path = s("path", { class: "series", d: curve(set.lines, each.values, across, up) });
      path.style.setProperty("--tint", each.colour);
      path.append(s("title", {}, each.name));
      return path;
    }),
  );
  return { svg, across };
}

const decibel = (values: Row): Row => values.map((x) => (x === null ? null : x / 100));
/** Returns the number of a mode, or the seed that it is at. */
export const named = (mode: Mode): string => (mode.number === null ? `at ${mode.seed} Hz` : String(mode.number));
const tint = (k: number): string => `var(--series-${(k % 6) + 1})`;

function diagramView(set: DataSet, chosen: Choice, tip: Tip): HTMLElement {
  const plot = h("div", { class: "plot" });
  const lines = h("pre", { role: "status", "aria-label": "lines for the test file" });
  const copy = h("button", { type: "button" }, "Copy");
  copy.addEventListener("click", () => void navigator.clipboard?.writeText(chosen.lines()));
  const most = Math.max(2, ...set.poles.order);
  let width = 0;
  const draw = (): void => {
    if (!width) return;
    const height = 420;
    const { svg, across } = chart(set, width, height, "CMIF in dB", [
      { values: decibel(set.complexIndicators[0] ?? []), colour: "var(--faint)", name: "CMIF" },
    ]);
    const up = scaleLinear([0, most], [height - BOTTOM, TOP]);
    const reach = 0.005;
    set.poles.frequency.forEach((f, k) => {
      const stable = set.poles.stable[k] === 1;
      const r = stable ? 3 : 1.8;
      const dot = s("circle", { class: `mark ${stable ? "filled" : "hollow"}`, cx: across(f), cy: up(set.poles.order[k]), r });
      const rounded = Number(f.toPrecision(5));
      const near = set.modes.find((mode) => Math.abs(mode.frequency - f) < Math.max(reach, mode.damping) * f);
      dot.addEventListener("click", () =>
        near ? chosen.leave(near) : chosen.toggle(chosen.seed, rounded),
      );
      dot.addEventListener("mousemove", (event) =>
        tip(`${number(f, 5)} Hz, damping ${fixed(100 * set.poles.damping[k], 2)} %\norder ${set.poles.order[k]}`, event),
      );
      dot.addEventListener("mouseleave", () => tip(null));
      svg.append(dot);
    });
    for (const mode of set.modes) {
      const x = across(mode.frequency);
      const gone = chosen.isOut(mode);
      const mark = s(
        "g",
        { class: "mark", role: "button", tabindex: 0, "aria-pressed": gone ? "true" : "false", "aria-label": `leave out mode ${named(mode)}` },
        s("line", { x1: x, x2: x, y1: TOP, y2: height - BOTTOM, stroke: "transparent", "stroke-width": 9 }),
        s("text", { class: "label", x, y: TOP - 6, "text-anchor": "middle", "text-decoration": gone ? "line-through" : "none" }, named(mode)),
      );
      const toggle = (): void => chosen.leave(mode);
      mark.addEventListener("click", toggle);
      mark.addEventListener("keydown", (event) => {
        if (event.key === "Enter" || event.key === " ") {
          event.preventDefault();
          toggle();
        }
      });
      svg.append(mark);
    }
    for (const f of chosen.seed) {
      if (f < set.band[0] || f > set.band[1]) continue;
      svg.append(s("line", { class: "base goal", x1: across(f), x2: across(f), y1: TOP, y2: height - BOTTOM, stroke: "var(--goal)", "stroke-width": 2 }));
    }
    plot.replaceChildren(svg);
  };
  sized(plot, (to) => {
    width = to;
    draw();
  });
  const tell = (): void => {
    lines.textContent = chosen.lines();
    draw();
  };
  chosen.changed.push(tell);
  tell();
  return section(
    "stabilisation diagram",
    "Stabilisation diagram",
    h("p", { class: "lede" }, "Poles by order, stable ones filled, over the first mode indicator function; numbered lines are accepted modes. Click on a number to leave a mode out, on another pole to place one there."),
    plot,
    h("div", { class: "controls" }, h("span", {}, "For the test file:"), copy),
    lines,
  );
}

function tableView(set: DataSet): HTMLElement {
  const heads = ["mode", "frequency Hz", "std", "damping %", "std", "evidence", "orders", "seen", "MPC", "look at"];
  const rows = set.modes.map((mode) => {
    const cells = [
      number(mode.frequency, 6),
      number(mode.frequencyStd, 2),
      number(100 * mode.damping, 4),
      number(100 * mode.dampingStd, 2),
      number(mode.evidence, 3),
      mode.orders === null ? "–" : `${fixed(100 * mode.orders, 0)} %`,
      mode.seen === null ? "–" : `${fixed(100 * mode.seen, 0)} %`,
      fixed(mode.collinearity, 2),
      mode.flags.join("; "),
    ];
    return h("tr", {}, h("th", { scope: "row" }, named(mode)), ...cells.map((text) => h("td", {}, text)));
  });
  const head = h("tr", {}, ...heads.map((text) => h("th", { scope: "col" }, text)));
  const table = h("table", {}, h("thead", {}, head), h("tbody", {}, ...rows));
  return section("modes", "Modes", h("div", { class: "scroll", tabindex: 0, role: "group", "aria-label": "table of modes" }, table));
}

function indicatorsView(set: DataSet): HTMLElement {
  const plot = h("div", { class: "plot" });
  sized(plot, (width) => {
    const curves = (of: Row[]): { values: Row; colour: string; name: string }[] =>
      of.map((values, k) => ({ values, colour: tint(k), name: `${k + 1}` }));
    const complex = chart(set, width, 240, "CMIF in dB", curves(set.complexIndicators.map(decibel)));
    const others = set.multivariateIndicators.length
      ? [chart(set, width, 200, "multivariate MIF", curves(set.multivariateIndicators)).svg]
      : [];
    plot.replaceChildren(complex.svg, ...others);
  });
  return section("mode indicators", "Mode indicator functions", plot);
}

function functionsView(set: DataSet): HTMLElement | null {
  if (!set.functions.length) return null;
  const plot = h("div", { class: "plot" });
  const select = h("select", { "aria-label": "function" });
  set.functions.forEach((each, k) =>
    select.append(h("option", { value: k }, `${each.name}: residual ${fixed(100 * each.residual, 1)} %`)),
  );
  let width = 0;
  const draw = (): void => {
    const each = set.functions[Number(select.value)];
    if (!width || !each) return;
    const { svg } = chart(set, width, 280, `${set.quantity} in dB`, [
      { values: decibel(each.measured), colour: "var(--faint)", name: "measured" },
      { values: decibel(each.synthesised), colour: tint(1), name: "synthesised" },
    ]);
    plot.replaceChildren(svg);
  };
  select.addEventListener("change", draw);
  sized(plot, (to) => {
    width = to;
    draw();
  });
  const note = h("p", { class: "note" }, "Measured grey, synthesised orange; the greatest residuals first.");
  return section("functions", "Functions", h("div", { class: "controls" }, select), plot, note);
}

function macView(set: DataSet): HTMLElement {
  const name = (k: number): string => `${number(set.modes[k].frequency, 4)}`;
  const head = h("tr", {}, h("td", {}, "Hz"), ...set.modes.map((_, k) => h("th", { scope: "col" }, name(k))));
  const rows = set.mac.map((row, r) => {
    const cells = row.map((value) => {
      const cell = h("td", {}, fixed(value, 2));
      const { background, ink } = mixed(Math.max(0, Math.min(1, value)));
      cell.style.background = background;
      cell.style.color = ink;
      return cell;
    });
    return h("tr", {}, h("th", { scope: "row" }, name(r)), ...cells);
  });
  const table = h("table", { class: "matrix" }, h("thead", {}, head), h("tbody", {}, ...rows));
  return section("MAC", "Auto-MAC", h("div", { class: "scroll", tabindex: 0, role: "group", "aria-label": "matrix of MAC" }, table));
}

function page(report: Identified): void {
  const chosen = new Choice(report);
  const { node, tip } = tooltip();
  const views = h("div", {});
  const show = (k: number): void => {
    const set = report.sets[k];
    chosen.changed = [];
    const functions = functionsView(set);
    views.replaceChildren(
      diagramView(set, chosen, tip),
      tableView(set),
      indicatorsView(set),
      ...(functions ? [functions] : []),
      ...(set.modes.length ? [movingShape(set), macView(set)] : []),
    );
  };
  const sets = choice("data set", report.sets.map((set, k) => [String(k), set.name]), "0", (k) => show(Number(k)));
  const kicker = h("p", { class: "kicker" }, "modefront · identified modes");
  const title = h("div", { class: "title" }, kicker, h("h1", {}, report.title));
  const warnings = h("ul", {}, ...report.warnings.map((text) => h("li", {}, text)));
  document.body.replaceChildren(
    h("header", {}, title, themeButton()),
    h("main", {}, report.sets.length > 1 ? sets : null, views, report.warnings.length ? section("warnings", "What to look at", warnings) : null),
    node,
  );
  show(0);
}

inflated(document.getElementById("data")?.textContent ?? "")
  .then((bytes) => page(JSON.parse(new TextDecoder().decode(bytes)) as Identified))
  .catch((error: unknown) => {
    document.body.append(h("p", { role: "alert" }, `This page needs a browser of 2023 or later: ${String(error)}`));
  });
