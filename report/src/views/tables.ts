// Tables to copy and a file to keep.

import { csv, download, everything, fileName, type Cell } from "../csv";
import { deviation, deviationWords, frequencyError, type Front } from "../data";
import { h, section } from "../dom";
import { fixed, number, scattered } from "../format";
import type { State } from "../state";

/** Makes the view: the chosen model beside the nominal one and the best, then all models. */
export function tablesView(state: State): HTMLElement {
  const front = state.current;
  const holder = h("div", { class: "scroll", tabindex: 0, role: "group", "aria-label": "models side by side" });
  const copied = h("span", { class: "note", "aria-live": "polite" });
  const copy = h("button", { type: "button" }, "Copy table");
  copy.addEventListener("click", () => {
    const table = holder.querySelector("table");
    if (table) void copyTable(table).then((done) => (copied.textContent = done ? "copied" : "select it, then copy"));
  });
  const keep = h("button", { type: "button" }, "Download CSV");
  keep.addEventListener("click", () =>
    download(fileName(front.study || front.name), csv(everything(front))),
  );
  const all = h("div", { class: "scroll", tabindex: 0, role: "group", "aria-label": "all models" });
  const details = h("details", {}, h("summary", {}, `All ${front.label.length} models`), all);
  details.addEventListener("toggle", () => {
    if (details.open && !all.firstChild) all.append(plain(everything(front)));
  });
  const update = (): void => {
    copied.textContent = "";
    holder.replaceChildren(sideBySide(front, state.point));
  };
  state.onChange(() => update());
  update();
  return section(
    "tables",
    "Side by side",
    h("div", { class: "controls" }, copy, keep, copied),
    holder,
    deviationWords(front) ? h("p", { class: "note" }, `±: ${deviationWords(front)}.`) : null,
    details,
  );
}

/** Returns the table of nominal, reference, edges and chosen model. */
function sideBySide(front: Front, chosen: number): HTMLElement {
  const edges = front.label.map((_, i) => i).filter((i) => front.kind[i] === "edge");
  const some = [front.nominal, front.reference, ...edges].filter((i): i is number => i !== null);
  const columns = [...new Set([chosen, ...some])];
  const head = h("tr", {}, h("td", {}), ...columns.map((i) => h("th", { scope: "col", class: i === chosen ? "chosen" : "" }, front.label[i])));
  const rows: [string, (i: number) => string][] = [
    ...front.parameters.map((name, j): [string, (i: number) => string] => [
      name,
      (i) => scattered(front.theta[i][j], deviation(front, i, j), front.bounds[j]),
    ]),
    ...front.modes.map((r, k): [string, (i: number) => string] => [
      `error of frequency ${r}, %`,
      (i) => fixed(frequencyError(front, i, k), 2, true),
    ]),
    ...front.modes.map((r, k): [string, (i: number) => string] => [
      `MAC ${r}`,
      (i) => fixed(front.mac[i][k], 4),
    ]),
    ...front.groups.map((name, g): [string, (i: number) => string] => [
      `e of ${name}`,
      (i) => number(front.error[i][g]),
    ]),
  ];
  const body = rows.map(([name, of]) =>
    h(
      "tr",
      {},
      h("th", { scope: "row" }, name),
      ...columns.map((i) => h("td", { class: i === chosen ? "chosen" : "" }, of(i))),
    ),
  );
  return h(
    "table",
    {},
    h("caption", { class: "hidden" }, "The chosen model beside the nominal one and the best"),
    h("thead", {}, head),
    h("tbody", {}, ...body),
  );
}

function plain(rows: Cell[][]): HTMLElement {
  const [head, ...body] = rows;
  const text = (cell: Cell): string =>
    typeof cell === "number" || cell === null ? number(cell) : typeof cell === "boolean" ? (cell ? "yes" : "no") : cell;
  return h(
    "table",
    {},
    h("thead", {}, h("tr", {}, ...head.map((cell) => h("th", { scope: "col" }, text(cell))))),
    h(
      "tbody",
      {},
      ...body.map((row) =>
        h(
          "tr",
          {},
          ...row.map((cell, k) => (k ? h("td", {}, text(cell)) : h("th", { scope: "row" }, text(cell)))),
        ),
      ),
    ),
  );
}

/** Copies a table as lines of cells with tabs between them; returns whether that was possible. */
async function copyTable(table: HTMLTableElement): Promise<boolean> {
  const text = [...table.rows]
    .map((row) => [...row.cells].map((cell) => cell.textContent ?? "").join("\t"))
    .join("\n");
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const range = document.createRange();
    range.selectNode(table);
    const selection = getSelection();
    selection?.removeAllRanges();
    selection?.addRange(range);
    return document.execCommand("copy");
  }
}
