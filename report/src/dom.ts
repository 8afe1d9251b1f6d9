// Elements made from text that is never taken for markup.

type Child = Node | string | null | undefined;
type Attributes = Record<string, string | number | boolean | null | undefined>;

const SVG = "http://www.w3.org/2000/svg";

function filled<E extends Element>(element: E, attributes: Attributes, children: Child[]): E {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) continue;
    element.setAttribute(name, value === true ? "" : String(value));
  }
  for (const child of children) {
    if (child !== null && child !== undefined) element.append(child);
  }
  return element;
}

/** Returns an element of HTML. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  return filled(document.createElement(tag), attributes, children);
}

/** Returns an element of SVG. */
export function s<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): SVGElementTagNameMap[K] {
  return filled(document.createElementNS(SVG, tag) as SVGElementTagNameMap[K], attributes, children);
}

/** Returns a section with its name, its heading and what is in it. */
export function section(name: string, heading: string, ...children: Child[]): HTMLElement {
  return h("section", { "aria-label": name, class: "card" }, h("h2", {}, heading), ...children);
}

/** Returns a set of exclusive choices; `chosen` is called with the one that is taken. */
export function choice(
  legend: string,
  options: [string, string][],
  current: string,
  chosen: (value: string) => void,
): HTMLElement {
  const name = `choice-${legend.replace(/\W+/g, "-")}-${Math.random().toString(36).slice(2, 8)}`;
  return h(
    "fieldset",
    { class: "choice" },
    h("legend", { class: "hidden" }, legend),
    ...options.map(([value, text]) => {
      const input = h("input", { type: "radio", name, value, checked: value === current });
      input.addEventListener("change", () => chosen(value));
      return h("label", {}, input, h("span", {}, text));
    }),
  );
}

/** Calls `draw` with the width of an element, now and whenever it changes. */
export function sized(element: Element, draw: (width: number) => void): void {
  let last = 0;
  new ResizeObserver(() => {
    const width = Math.floor(element.getBoundingClientRect().width);
    if (width > 0 && width !== last) draw((last = width));
  }).observe(element);
}
