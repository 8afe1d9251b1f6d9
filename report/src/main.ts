// The page: a bar to walk along the front, and views that follow.

import { read, type Report, type Sentence } from "./data";
import { h, section } from "./dom";
import { number } from "./format";
import { isOfPart } from "./marks";
import { State } from "./state";
import { themeButton } from "./theme";
import { Aspiration, aspirationView } from "./views/aspiration";
import { frequenciesView } from "./views/frequencies";
import { frontView } from "./views/front";
import { macView } from "./views/mac";
import { parametersView } from "./views/parameters";
import { predictionsView } from "./views/predictions";
import { shapeView } from "./views/shape";
import { tablesView } from "./views/tables";
import { tooltip } from "./views/tip";

function page(report: Report): void {
  const state = new State(report);
  const aspiration = new Aspiration(state);
  const { node, tip } = tooltip();
  const bar = walker(state);
  const views = h("div", { class: "views" });
  const build = (): void => {
    aspiration.reset();
    state.clearBrushes();
    const left = [frontView(state, aspiration, tip), aspirationView(state, aspiration)];
    const right = [shapeView(state)];
    const below = [parametersView(state, tip), frequenciesView(state, tip), macView(state, tip)];
    const predictions = predictionsView(state, tip);
    if (predictions) predictions.classList.add("wide");
    const tables = tablesView(state);
    tables.classList.add("wide");
    views.replaceChildren(
      h("div", { class: "column" }, ...left, below[2]),
      h("div", { class: "column" }, ...right, ...below.slice(0, 2)),
      ...(predictions ? [predictions] : []),
      tables,
    );
  };
  const words = h("div", { class: "words" });
  const say = (): void => words.replaceChildren(summary(state));
  state.onStudy(build);
  state.onStudy(say);
  say();
  build();
  document.body.replaceChildren(
    h(
      "header",
      {},
      h(
        "div",
        { class: "title" },
        h("p", { class: "kicker" }, "modefront · Pareto-optimal models"),
        h("h1", {}, report.title),
      ),
      themeButton(),
    ),
    h("main", {}, words, bar, views, colophon(state)),
    node,
  );
  keys(state);
  printing();
  state.tell();
}

/** Makes the bar with the slider, the label of the chosen model and models beside the front. */
function walker(state: State): HTMLElement {
  const slider = h("input", { type: "range", id: "model", name: "model", min: 1, step: 1 });
  const status = h("strong", { role: "status", id: "chosen" });
  const facts = h("span", { class: "facts" });
  const back = h("button", { type: "button", "aria-label": "previous model" }, "‹");
  const forth = h("button", { type: "button", "aria-label": "next model" }, "›");
  const chips = h("div", { class: "chips", role: "group", "aria-label": "models beside the front" });
  const brushed = h("button", { type: "button", class: "brushed", hidden: true });
  brushed.addEventListener("click", () => state.clearBrushes());
  const studies = h("select", { id: "study", "aria-label": "study" });
  const chosen = (): number => Number(slider.value) - 1;
  slider.addEventListener("input", () => state.walk(chosen()));
  slider.addEventListener("keydown", (event) => {
    // Where a model beside the front is chosen, keys lead back to the front.
    const to: Record<string, number> = { Home: 0, End: state.current.order.length - 1 };
    if (event.key in to) {
      event.preventDefault();
      state.walk(to[event.key]);
    }
  });
  back.addEventListener("click", () => state.walk(state.step - 1));
  forth.addEventListener("click", () => state.walk(state.step + 1));
  studies.addEventListener("change", () => {
    const front = Number(studies.value);
    const order = state.report.fronts[front].order;
    state.choose(order[Math.min(state.step, order.length - 1)] ?? 0, front);
  });
  const build = (): void => {
    const front = state.current;
    slider.max = String(front.order.length);
    studies.value = String(state.front);
    const beside = front.label
      .map((_, i) => i)
      .filter((i) => !front.order.includes(i) && !isOfPart(front.kind[i]));
    chips.replaceChildren(
      ...beside.map((i) => {
        const chip = h("button", { type: "button", "data-point": i }, front.label[i]);
        chip.addEventListener("click", () => state.choose(i));
        return chip;
      }),
    );
  };
  const update = (): void => {
    const front = state.current;
    const i = state.point;
    slider.value = String(state.step + 1);
    slider.setAttribute("aria-valuetext", front.label[front.order[state.step] ?? i]);
    if (status.textContent !== front.label[i]) status.textContent = front.label[i];
    const marks = [
      front.pareto[i] ? "Pareto optimal" : "dominated by another model",
      front.converged[i] ? "" : "not converged",
    ].filter(Boolean);
    facts.textContent =
      front.groups.map((name, g) => `e of ${name} ${number(front.error[i][g], 3)}`).join(" · ") +
      ` · ${marks.join(", ")}`;
    for (const chip of chips.querySelectorAll("button")) {
      chip.setAttribute("aria-pressed", String(Number(chip.dataset.point) === i));
    }
    brushed.hidden = !state.isBrushed;
    if (state.isBrushed) {
      const inside = front.order.filter((k) => state.within(front, k)).length;
      brushed.textContent = `${inside} of ${front.order.length} selected – clear`;
    }
  };
  state.report.fronts.forEach((front, f) => studies.append(h("option", { value: f }, front.name)));
  state.onStudy(build);
  state.always(update);
  build();
  return h(
    "div",
    { class: "walker", role: "group", "aria-label": "choice of the model" },
    state.report.fronts.length > 1 ? h("label", { for: "study", class: "study" }, "study ", studies) : null,
    h("div", { class: "walk" }, back, h("label", { for: "model" }, "model"), slider, forth, status),
    facts,
    chips,
    brushed,
  );
}

/** Opens all that is folded before the page is printed, splits wide tables, and undoes it after. */
function printing(): void {
  const WIDTH = 600; // of what A4 shows, in px
  let opened: HTMLDetailsElement[] = [];
  let wide: HTMLTableElement[] = [];
  let copies: HTMLTableElement[] = [];
  window.addEventListener("beforeprint", () => {
    opened = [...document.querySelectorAll<HTMLDetailsElement>("details:not([open])")];
    for (const details of opened) {
      details.open = true;
      details.dispatchEvent(new Event("toggle")); // what is filled when it is opened, is filled now
    }
    wide = [...document.querySelectorAll<HTMLTableElement>(".scroll table")].filter((table) => table.scrollWidth > WIDTH);
    copies = wide.flatMap((table) => {
      const blocks = split(table, WIDTH);
      table.after(...blocks);
      table.hidden = true;
      return blocks;
    });
  });
  window.addEventListener("afterprint", () => {
    opened.forEach((details) => (details.open = false));
    copies.forEach((table) => table.remove());
    wide.forEach((table) => (table.hidden = false));
  });
}

/** Returns copies of a table with as many columns as fit a width, the first one in each. */
function split(table: HTMLTableElement, width: number): HTMLTableElement[] {
  const [first, ...widths] = [...table.rows[0].cells].map((cell) => cell.offsetWidth);
  const blocks: number[][] = [];
  let room = 0;
  widths.forEach((needed, k) => {
    if (!blocks.length || needed > room) {
      blocks.push([0]);
      room = width - first;
    }
    blocks[blocks.length - 1].push(k + 1);
    room -= needed;
  });
  return blocks.map((columns) => {
    const copy = table.cloneNode(true) as HTMLTableElement;
    for (const row of copy.rows) [...row.cells].filter((_, k) => !columns.includes(k)).forEach((cell) => cell.remove());
    return copy;
  });
}

/** Arrow keys walk along the front wherever they mean nothing else; Escape clears selections. */
function keys(state: State): void {
  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.altKey || event.ctrlKey || event.metaKey) return;
    if (event.key === "Escape") state.clearBrushes();
    const target = event.target as Element | null;
    if (target?.closest("input, select, textarea, .stage, .scroll")) return;
    if (event.key === "ArrowRight") state.walk(state.step + 1);
    else if (event.key === "ArrowLeft") state.walk(state.step - 1);
    else return;
    event.preventDefault();
  });
}

function summary(state: State): HTMLElement {
  const front = state.current;
  const several = state.report.fronts.length > 1;
  const view = section("summary", several ? front.study || front.name : "In words");
  for (const { heading, sentences } of front.words) {
    if (!heading) {
      view.append(h("div", { class: "answer" }, ...sentences.map((each) => explained("div", each))));
      continue;
    }
    const count = shown(sentences.map((each) => each.text));
    const list = (some: Sentence[]): HTMLElement => h("ul", {}, ...some.map((each) => explained("li", each)));
    view.append(
      h(
        "div",
        { class: "topic" },
        h("h3", {}, heading),
        list(sentences.slice(0, count)),
        sentences.length > count
          ? h(
              "details",
              {},
              h("summary", {}, `${sentences.length - count} more`),
              list(sentences.slice(count)),
            )
          : null,
      ),
    );
  }
  view.append(h("p", { class: "note" }, "A sentence opens at a click: what it means, and what to do."));
  return view;
}

/** Returns a sentence that opens to what it means and what to do. */
function explained(tag: "div" | "li", { text, meaning }: Sentence): HTMLElement {
  if (!meaning.length) return h(tag, {}, text);
  const parts = meaning.map((each) =>
    each.startsWith("```") ? h("pre", {}, each.split("\n").slice(1, -1).join("\n")) : h("p", {}, each),
  );
  return h(tag, {}, h("details", { class: "meaning" }, h("summary", {}, text), ...parts));
}

/** Returns how many sentences of a topic are shown at once: three, fewer long ones. */
function shown(sentences: string[]): number {
  const [MOST, LETTERS] = [3, 420];
  let letters = sentences[0]?.length ?? 0;
  let count = 1;
  while (count < Math.min(MOST, sentences.length) && letters + sentences[count].length <= LETTERS) {
    letters += sentences[count].length;
    count += 1;
  }
  return count;
}

function colophon(state: State): HTMLElement {
  const { cite, version, fronts } = state.report;
  return section(
    "how to cite",
    "How to cite",
    ...cite.map((text) => h("p", {}, text)),
    h(
      "dl",
      {},
      ...fronts.flatMap((front) => [
        h("dt", {}, front.name),
        h(
          "dd",
          {},
          "hash of all inputs ",
          h("code", {}, front.inputs || "none: the study was made in Python"),
          `; results by modefront ${front.version}`,
        ),
      ]),
    ),
    h("p", { class: "note" }, `This page was made by modefront ${version}. It holds all its data and loads nothing.`),
  );
}

const data = document.getElementById("data");
read(data?.textContent ?? "")
  .then(page)
  .catch((error: unknown) => {
    document.body.append(
      h("p", { role: "alert" }, `This page needs a browser of 2023 or later: ${String(error)}`),
    );
  });
