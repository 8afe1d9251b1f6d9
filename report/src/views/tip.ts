// A note beside the pointer.

import { h } from "../dom";

export type Tip = (text: string | null, event?: MouseEvent) => void;

/** Returns the note and what shows it; null hides it. */
export function tooltip(): { node: HTMLElement; tip: Tip } {
  const node = h("div", { class: "tip", hidden: true, "aria-hidden": "true" });
  const tip: Tip = (text, event) => {
    node.hidden = text === null;
    if (text === null || !event) return;
    node.replaceChildren(
      ...text.split("\n").map((line, k) => h("div", { class: k ? "" : "strong" }, line)),
    );
    const room = document.documentElement.clientWidth - node.offsetWidth - 8;
    node.style.left = `${Math.max(4, Math.min(room, event.clientX + 14))}px`;
    node.style.top = `${event.clientY + 16}px`;
  };
  return { node, tip };
}
