// The mode shape of the chosen model, and the measured one beside it.

import { h, s, section, sized } from "../dom";
import { fixed, number } from "../format";
import type { State } from "../state";
import { palette } from "../theme";
import { Camera } from "./camera";
import { flat, type Panel, type Renderer } from "./renderer";
import { arrows, measured, measuredFloors, nodes, row, solid, type Arrow } from "./solid";
import { webgl } from "./webgl";

const PERIOD = 2400;
/** Milliseconds of one cycle of the animation. */

/** Makes the view. */
export function shapeView(state: State): HTMLElement {
  const front = state.current;
  if (!front.shape) {
    return section(
      "mode shape",
      "Mode shape",
      h("p", { class: "note" }, "These results hold no mode shapes: run the study again with this version."),
    );
  }
  const geometry = front.geometry ?? row(front);
  const isRow = geometry.kind === "sensors";
  const body = solid(geometry);
  const camera = new Camera(body.centre, body.radius);
  if (geometry.kind === "chain") camera.room = 1.02; // names of sensors stand beside the floors
  let mode = 0;
  let amplitude = 1;
  let isPlaying = false;
  let started = 0;
  let request = 0;

  const modes = h("select", { id: "mode-number", name: "mode" });
  front.modes.forEach((r, i) => modes.append(h("option", { value: i }, `mode ${r}`)));
  const size = h("input", { type: "number", id: "amplitude", min: 0, max: 10, step: 0.25, value: 1 });
  const play = h("button", { type: "button", class: "play", "aria-pressed": "false" }, "Animate");
  const titles = [h("figcaption", {}), h("figcaption", {})];
  const canvas = h("canvas", { "aria-hidden": "true" });
  const plain = s("svg", { class: "plain", "aria-hidden": "true" });
  const overlay = s("svg", { class: "overlay", "aria-hidden": "true" });
  const stage = h("div", {
    class: "stage",
    tabindex: 0,
    role: "img",
    "aria-label": isRow ? "mode shape; arrows of each sensor" : "mode shape; arrow keys turn it",
  });
  stage.append(canvas, plain, overlay);
  const views = h("div", { class: "buttons" });
  for (const [name, azimuth, elevation] of [
    ["3-D", -1.05, 0.32],
    ["front", -Math.PI / 2, 0],
    ["side", 0, 0],
    ["top", -Math.PI / 2, 1.57],
  ] as const) {
    const button = h("button", { type: "button", "aria-label": `look from: ${name}` }, name);
    button.addEventListener("click", () => {
      camera.azimuth = azimuth;
      camera.elevation = elevation;
      camera.zoom = 1;
      draw();
    });
    views.append(button);
  }
  for (const [name, words, factor] of [
    ["+", "nearer", 1.25],
    ["−", "farther", 0.8],
  ] as const) {
    const button = h("button", { type: "button", "aria-label": words }, name);
    button.addEventListener("click", () => {
      camera.zoom = Math.min(20, Math.max(0.2, camera.zoom * factor));
      draw();
    });
    views.append(button);
  }
  const note = h("p", { class: "note" });
  const table = h("div", { class: "scroll", tabindex: 0, role: "group", "aria-label": "components" });
  const view = section(
    "mode shape",
    "Mode shape",
    h(
      "div",
      { class: "controls" },
      h("label", { for: "mode-number" }, "measured mode ", modes),
      play,
      ...(isRow ? [] : [h("label", { for: "amplitude" }, "amplitude ", size), views]),
    ),
    h("div", { class: "captions" }, ...titles),
    stage,
    note,
    h("details", {}, h("summary", {}, "Components at the sensors"), table),
  );

  let renderer: Renderer | null = null;
  const useSvg = (): void => {
    renderer?.dispose();
    canvas.remove();
    renderer = flat(plain, body);
    view.dataset.renderer = "svg";
  };
  const begin = (): void => {
    try {
      if (!document.createElement("canvas").getContext("webgl2")) throw new Error("no WebGL");
      renderer = webgl(canvas, body, 2);
      view.dataset.renderer = "webgl";
      canvas.addEventListener("webglcontextlost", (event) => {
        event.preventDefault();
        useSvg();
        draw();
      });
    } catch {
      useSvg();
    }
  };

  let width = 0;
  let height = 0;
  let panelWidth = 0;

  function content(factor: number): { panels: Panel[]; pointers: { arrows: Arrow[]; kind: string }[][] } {
    const colours = palette();
    const point = state.point;
    const u = nodes(front, geometry, point, mode);
    const scale = 0.16 * body.radius * amplitude * factor * (geometry.kind === "chain" ? 1.5 : 1);
    const sets = measured(front, point, mode);
    const at = (v: Float32Array | null): Float32Array => {
      const out = new Float32Array(body.rest);
      if (v) body.moved(v).forEach((x, k) => (out[k] += scale * x));
      return out;
    };
    const tinted = (v: Float32Array | null, to: [number, number, number]): Float32Array => {
      const out = new Float32Array(body.rest.length);
      const moved = v ? body.moved(v) : null;
      for (let k = 0; k < out.length; k += 3) {
        const t = moved ? Math.min(1, Math.hypot(moved[k], moved[k + 1], moved[k + 2])) : 0;
        for (let c = 0; c < 3; c++) out[k + c] = (1 - t) * colours.body[c] + t * to[c];
      }
      return out;
    };
    const floors = geometry.kind === "chain" && sets.length ? measuredFloors(geometry, sets[0]) : null;
    const panels: Panel[] = [
      { positions: at(u), colours: tinted(u, colours.model), solid: true, ink: colours.ink },
      {
        positions: at(floors),
        colours: tinted(floors, colours.data),
        solid: floors !== null || geometry.kind === "chain",
        ink: floors ? colours.ink : colours.faint,
      },
    ];
    const scaled = (components: (number | null)[]): Arrow[] =>
      arrows(front, geometry, components).map((arrow) => ({
        ...arrow,
        along: arrow.along.map((x) => scale * x) as Arrow["along"],
      }));
    const computed = front.shape?.[point]?.[mode] ?? [];
    return {
      panels,
      pointers: [
        [{ arrows: scaled(computed), kind: "computed" }],
        sets.map((set) => ({ arrows: scaled(set), kind: "measured" })),
      ],
    };
  }

  /** Arrows of each sensor in a line of its own: of the model, and what was measured below it. */
  function rows(factor: number): void {
    const sets = measured(front, state.point, mode);
    const shapes = [front.shape?.[state.point]?.[mode] ?? [], ...sets];
    const pitch = 10 * shapes.length + 12;
    const full = pitch * front.sensors.length;
    stage.style.height = `${Math.min(560, full)}px`;
    const w = stage.clientWidth; // without the bar of one that scrolls
    const letters = Math.floor(Math.min(0.4 * w, 8 * Math.max(...front.sensors.map((x) => x.length))) / 8);
    const left = 8 * letters + 8;
    const zero = (left + w) / 2;
    const most = Math.max(...shapes.flat().map((x) => Math.abs(x ?? 0))) || 1;
    const scale = (factor * ((w - left) / 2 - 10)) / most;
    overlay.setAttribute("width", String(w));
    overlay.setAttribute("height", String(full));
    overlay.setAttribute("viewBox", `0 0 ${w} ${full}`);
    overlay.replaceChildren(
      s("g", { class: "axis" }, s("line", { class: "base", x1: zero, x2: zero, y1: 0, y2: full })),
      ...front.sensors.flatMap((name, i) => {
        const shown = name.length > letters ? `${name.slice(0, letters - 1)}…` : name;
        const middle = pitch * (i + 0.5);
        const first = middle - 5 * (shapes.length - 1);
        const pointers = shapes.flatMap((shape, k) => {
          const value = shape[i] ?? null;
          const y = first + 10 * k;
          return value === null ? [] : [pointer([zero, y], [zero + scale * value, y], k ? "measured" : "computed")];
        });
        return [s("text", { x: 0, y: middle + 4 }, shown), ...pointers];
      }),
    );
  }

  function draw(factor = 1): void {
    if (!width) return;
    if (isRow) return rows(factor);
    if (!renderer) return;
    const { panels, pointers } = content(factor);
    renderer.draw(panels, camera, panelWidth, height);
    overlay.setAttribute("width", String(width));
    overlay.setAttribute("height", String(height));
    for (const svg of [plain, overlay]) svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const project = camera.projection(panelWidth, height);
    overlay.replaceChildren(
      ...pointers.map((sets, k) => {
        const group = s("g", { transform: `translate(${k * panelWidth},0)` });
        const named = new Set<string>();
        const taken: [number, number][] = [];
        for (const { arrows: some, kind } of sets) {
          for (const arrow of some) {
            // Arrows of a floor start at its displaced edge, others where the sensor is at rest.
            const start = geometry.kind === "chain" ? 1 : 0;
            const from = arrow.from.map((x, d) => x + start * arrow.along[d]) as Arrow["from"];
            const a = project(...from);
            const tip = from.map((x, d) => x + arrow.along[d]) as Arrow["from"];
            const b = project(...tip);
            group.append(pointer(a, b, kind));
            if (named.has(arrow.name)) continue;
            named.add(arrow.name);
            // Names that would cover each other are left to the table below.
            const room = 7.5 * arrow.name.length;
            const x = Math.max(
              2,
              Math.min(panelWidth - room - 2, b[0] >= a[0] ? b[0] + 8 : b[0] - 8 - room),
            );
            const y = b[1] + 4;
            if (taken.some(([tx, ty]) => Math.abs(tx - x) < 60 && Math.abs(ty - y) < 12)) continue;
            taken.push([x, y]);
            const text = s("text", b[0] >= a[0] ? { x, y } : { x: x + room, y, "text-anchor": "end" });
            text.textContent = arrow.name;
            group.append(text);
          }
        }
        return group;
      }),
    );
  }

  function pointer(a: number[], b: number[], kind: string): SVGElement {
    const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    const length = Math.hypot(dx, dy);
    if (length < 3) return s("circle", { class: `pointer ${kind}`, cx: a[0], cy: a[1], r: 2.5 });
    const head = Math.min(9, 0.6 * length);
    const [ux, uy] = [dx / length, dy / length];
    const [hx, hy] = [b[0] - head * ux, b[1] - head * uy];
    const wing = 0.45 * head;
    return s("path", {
      class: `pointer ${kind}`,
      d:
        `M${a[0]},${a[1]}L${hx},${hy}` +
        `M${b[0]},${b[1]}L${hx - wing * uy},${hy + wing * ux}L${hx + wing * uy},${hy - wing * ux}Z`,
    });
  }

  function components(): HTMLElement {
    const computed = front.shape?.[state.point]?.[mode] ?? [];
    const sets = measured(front, state.point, mode);
    const head = h("tr", {}, h("th", { scope: "col" }, "sensor"), h("th", { scope: "col" }, "model"));
    sets.forEach((_, k) =>
      head.append(h("th", { scope: "col" }, sets.length > 1 ? `measured, ${front.sets[k]}` : "measured")),
    );
    const rows = front.sensors.map((name, i) =>
      h(
        "tr",
        {},
        h("th", { scope: "row" }, name),
        h("td", {}, fixed(computed[i], 4)),
        ...sets.map((set) => h("td", {}, fixed(set[i], 4))),
      ),
    );
    return h("table", {}, h("thead", {}, head), h("tbody", {}, ...rows));
  }

  function update(): void {
    const f = front.frequency[state.point][mode];
    const mac = front.mac[state.point][mode];
    titles[0].replaceChildren(
      h("strong", {}, front.label[state.point]),
      ` ${number(f)} Hz`,
    );
    titles[1].replaceChildren(
      h("strong", {}, "measured"),
      ` ${number(front.measured[mode])} Hz`,
      mac === null ? "" : ` · MAC ${fixed(mac, 4)}`,
    );
    const unknown = f === null ? "This model has no modes. " : "";
    const why =
      geometry.kind === "sensors"
        ? "The study says nothing of where the sensors are: they stand in their order, each with the model's arrow above the measured ones. "
        : geometry.kind === "chain"
          ? "Floors and columns; where no sensor is, the measured shape is drawn straight between its neighbours. "
          : "Arrows are displacements at the sensors. ";
    note.textContent = `${unknown}${why}Measured shapes have the scale of the model's (modal scale factor).${isRow ? "" : " Drag, or use arrow keys, to turn."}`;
    table.replaceChildren(components());
    if (!isPlaying) draw();
  }

  function frame(now: number): void {
    if (!isPlaying || !view.isConnected) return;
    draw(Math.cos((2 * Math.PI * (now - started)) / PERIOD));
    request = requestAnimationFrame(frame);
  }

  play.addEventListener("click", () => {
    isPlaying = !isPlaying;
    play.setAttribute("aria-pressed", String(isPlaying));
    play.textContent = isPlaying ? "Stop" : "Animate";
    cancelAnimationFrame(request);
    started = performance.now();
    if (isPlaying) request = requestAnimationFrame(frame);
    else draw();
  });
  modes.addEventListener("change", () => {
    mode = Number(modes.value);
    update();
  });
  size.addEventListener("input", () => {
    const value = Number(size.value);
    if (Number.isFinite(value)) amplitude = Math.max(0, Math.min(10, value));
    draw();
  });
  if (isRow) stage.classList.add("rows");
  stage.addEventListener("pointerdown", (event) => {
    if (isRow) return;
    stage.setPointerCapture(event.pointerId);
    let [x, y] = [event.clientX, event.clientY];
    const move = (to: PointerEvent): void => {
      camera.turn(-0.008 * (to.clientX - x), 0.008 * (to.clientY - y));
      [x, y] = [to.clientX, to.clientY];
      if (!isPlaying) draw();
    };
    const end = (): void => {
      stage.removeEventListener("pointermove", move);
      stage.removeEventListener("pointerup", end);
      stage.removeEventListener("pointercancel", end);
    };
    stage.addEventListener("pointermove", move);
    stage.addEventListener("pointerup", end);
    stage.addEventListener("pointercancel", end);
  });
  stage.addEventListener("keydown", (event) => {
    const turns: Record<string, [number, number]> = {
      ArrowLeft: [0.1, 0],
      ArrowRight: [-0.1, 0],
      ArrowUp: [0, -0.1],
      ArrowDown: [0, 0.1],
    };
    const turn = turns[event.key];
    if (!turn || isRow) return;
    event.preventDefault();
    event.stopPropagation();
    camera.turn(...turn);
    if (!isPlaying) draw();
  });
  if (!isRow) begin();
  sized(stage, (w) => {
    width = w;
    panelWidth = Math.floor(w / 2);
    height = Math.max(220, Math.min(560, Math.round(1.08 * panelWidth)));
    stage.style.height = `${height}px`;
    draw();
  });
  state.onChange(() => update());
  document.addEventListener("themechange", () => view.isConnected && draw());
  update();
  return view;
}
