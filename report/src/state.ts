// What is chosen and what is brushed, shared by all views.

import { isOfPart } from "./marks";
import type { Front, Report } from "./data";

export type Test = (front: Front, point: number) => boolean;

/** The state of the page; views are told of every change. */
export class State {
  front = 0;
  point: number;
  /** Axes of the view of the front. */
  quantity: "objective" | "error" = "error";
  scale: "linear" | "log" = "linear";
  private readonly tests = new Map<string, { test: Test; clear: () => void }>();
  private readonly lasting: (() => void)[] = [];
  private views: (() => void)[] = [];
  private readonly studies: (() => void)[] = [];

  constructor(readonly report: Report) {
    this.point = this.current.reference;
  }

  /** The study at hand. */
  get current(): Front {
    return this.report.fronts[this.front];
  }

  /** Position of the chosen model along the front, that of the nearest one beside it. */
  get step(): number {
    const at = this.current.order.indexOf(this.point);
    return at >= 0 ? at : this.current.order.indexOf(nearestOnFront(this.current, this.point));
  }

  /** Tells a view of every change until another study is shown. */
  onChange(view: () => void): void {
    this.views.push(view);
  }

  /** Tells what stays on the page of every change. */
  always(view: () => void): void {
    this.lasting.push(view);
  }

  onStudy(view: () => void): void {
    this.studies.push(view);
  }

  choose(point: number, front = this.front): void {
    const other = front !== this.front;
    this.front = front;
    this.point = point;
    if (other) {
      this.views = [];
      this.studies.forEach((view) => view());
    }
    this.tell();
  }

  walk(step: number): void {
    const order = this.current.order;
    this.choose(order[Math.max(0, Math.min(order.length - 1, step))]);
  }

  brush(key: string, test: Test | null, clear: () => void): void {
    if (test) this.tests.set(key, { test, clear });
    else this.tests.delete(key);
    this.tell();
  }

  get isBrushed(): boolean {
    return this.tests.size > 0;
  }

  /** Whether a model is within all brushes. */
  within(front: Front, point: number): boolean {
    for (const { test } of this.tests.values()) if (!test(front, point)) return false;
    return true;
  }

  clearBrushes(): void {
    const all = [...this.tests.values()];
    this.tests.clear();
    all.forEach(({ clear }) => clear());
    this.tell();
  }

  /** Forgets the brushes of views that are drawn again. */
  forget(prefix: string): void {
    for (const key of [...this.tests.keys()]) if (key.startsWith(prefix)) this.tests.delete(key);
  }

  tell(): void {
    [...this.lasting, ...this.views].forEach((view) => view());
  }
}

/** The point of the front that is nearest to a model, over the ranges of the errors. */
export function nearestOnFront(front: Front, point: number): number {
  if (front.order.includes(point)) return point;
  const target = front.error[point];
  return least(optimal(front), (i) =>
    excesses(front, i, target).reduce((sum, x) => sum + x * x, 0),
  );
}

/** The Pareto-optimal model with the least of the greatest excesses over an aspiration. */
export function nearestTo(front: Front, aspiration: (number | null)[]): number {
  return least(best(front), (i) => Math.max(...excesses(front, i, aspiration)));
}

/** The Pareto-optimal points of the front, in their order; all of them where none is. */
export function optimal(front: Front): number[] {
  const best = front.order.filter((i) => front.pareto[i]);
  return best.length ? best : front.order;
}

/** All Pareto-optimal models, edges and weighted ones too; the points of the front come first. */
export function best(front: Front): number[] {
  const beside = front.label
    .map((_, i) => i)
    .filter((i) => front.pareto[i] && !front.order.includes(i) && !isOfPart(front.kind[i]));
  return [...optimal(front), ...beside];
}

/** The candidate of least cost. */
export function least(candidates: number[], cost: (point: number) => number): number {
  let out = candidates[0] ?? 0;
  let lowest = Infinity;
  for (const i of candidates) {
    const value = cost(i);
    if (value < lowest) {
      lowest = value;
      out = i;
    }
  }
  return out;
}

/** Errors of a model less others, over the ranges of the front. */
function excesses(front: Front, point: number, target: (number | null)[]): number[] {
  return front.groups.map((_, g) => {
    const values = front.order.map((i) => front.error[i][g] ?? 0);
    const size = Math.max(...values) - Math.min(...values) || 1;
    return ((front.error[point][g] ?? Infinity) - (target[g] ?? 0)) / size;
  });
}
