// What draws solids: WebGL, or SVG where there is none.

import { s } from "../dom";
import type { Camera } from "./camera";
import type { Solid } from "./solid";

/** What one panel shows. */
export interface Panel {
  positions: Float32Array;
  /** Red, green, blue of each vertex, from 0 to 1. */
  colours: Float32Array;
  /** Whether faces are drawn, or lines alone. */
  solid: boolean;
  /** Colour of the lines. */
  ink: string;
}

/** Draws panels beside each other. */
export interface Renderer {
  draw: (panels: Panel[], camera: Camera, width: number, height: number) => void;
  dispose: () => void;
}

const FACES = 2500;
const LINES = 6000;
/** What SVG draws at most: of more, every second or third one is left out. */

/** Returns a renderer that draws polygons, those farther away first. */
export function flat(svg: SVGSVGElement, solid: Solid): Renderer {
  const step = Math.max(1, Math.ceil(solid.lines.length / 2 / LINES));
  const filled = solid.triangles.length / 3 <= FACES;
  return {
    draw(panels, camera, width, height): void {
      svg.setAttribute("width", String(width * panels.length));
      svg.setAttribute("height", String(height));
      const project = camera.projection(width, height);
      const groups = panels.map((panel, k) => {
        const group = s("g", { transform: `translate(${k * width},0)` });
        const at = (v: number): [number, number, number] => {
          const p = panel.positions;
          return project(p[3 * v], p[3 * v + 1], p[3 * v + 2]);
        };
        const pieces: { depth: number; node: SVGElement }[] = [];
        if (panel.solid && filled) {
          for (let t = 0; t < solid.triangles.length; t += 3) {
            const corners = [...solid.triangles.subarray(t, t + 3)];
            const points = corners.map(at);
            const node = s("path", {
              d: `M${points.map(([x, y]) => `${x.toFixed(1)},${y.toFixed(1)}`).join("L")}Z`,
            });
            node.style.fill = rgb(panel.colours, corners);
            node.style.stroke = node.style.fill;
            pieces.push({ depth: points.reduce((sum, p) => sum + p[2], 0) / 3, node });
          }
        }
        for (let e = 0; e < solid.lines.length; e += 2 * step) {
          const [a, b] = [at(solid.lines[e]), at(solid.lines[e + 1])];
          const node = s("line", {
            x1: a[0].toFixed(1),
            y1: a[1].toFixed(1),
            x2: b[0].toFixed(1),
            y2: b[1].toFixed(1),
          });
          node.style.stroke = panel.ink;
          // Just before the faces that it is an edge of.
          pieces.push({ depth: (a[2] + b[2]) / 2 + 1e-3 * camera.radius, node });
        }
        pieces.sort((a, b) => a.depth - b.depth);
        group.append(...pieces.map((piece) => piece.node));
        return group;
      });
      svg.replaceChildren(...groups);
    },
    dispose(): void {
      svg.replaceChildren();
    },
  };
}

function rgb(colours: Float32Array, corners: number[]): string {
  const mean = [0, 1, 2].map((c) =>
    Math.round((255 * corners.reduce((sum, v) => sum + colours[3 * v + c], 0)) / corners.length),
  );
  return `rgb(${mean.join(",")})`;
}
