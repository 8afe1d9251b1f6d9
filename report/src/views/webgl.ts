// Solids drawn by WebGL, one panel each, in one canvas.

import {
  BufferAttribute,
  BufferGeometry,
  DirectionalLight,
  DoubleSide,
  HemisphereLight,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  OrthographicCamera,
  Scene,
  WebGLRenderer,
} from "three";
import type { Camera } from "./camera";
import type { Renderer, Panel } from "./renderer";
import type { Solid } from "./solid";

const DENSE = 4000;
/** Lines from which a mesh is fine. */

interface Drawn {
  scene: Scene;
  positions: BufferAttribute;
  colours: BufferAttribute;
  mesh: Mesh;
  lines: LineSegments<BufferGeometry, LineBasicMaterial>;
}

/** Returns a renderer that draws with WebGL; raises where there is none. */
export function webgl(canvas: HTMLCanvasElement, solid: Solid, panels: number): Renderer {
  // What is drawn is kept, so that it is printed.
  const renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
  renderer.setScissorTest(true);
  const drawn = Array.from({ length: panels }, () => scene(solid));
  // Lines of a fine mesh would hide its faces.
  const isDense = solid.lines.length / 2 > DENSE;
  const camera = new OrthographicCamera();
  camera.up.set(0, 0, 1);

  return {
    draw(contents: Panel[], view: Camera, width: number, height: number): void {
      renderer.setSize(width * panels, height, false);
      canvas.style.width = `${width * panels}px`;
      canvas.style.height = `${height}px`;
      look(camera, view, width, height);
      contents.forEach((panel, k) => {
        const { scene: all, positions, colours, mesh, lines } = drawn[k];
        (positions.array as Float32Array).set(panel.positions);
        positions.needsUpdate = true;
        (colours.array as Float32Array).set(panel.colours);
        colours.needsUpdate = true;
        mesh.visible = panel.solid;
        lines.material.color.set(panel.ink);
        lines.material.opacity = (panel.solid ? 0.55 : 0.8) * (isDense ? 0.2 : 1);
        renderer.setViewport(k * width, 0, width, height);
        renderer.setScissor(k * width, 0, width, height);
        renderer.render(all, camera);
      });
    },
    dispose(): void {
      renderer.dispose();
      renderer.forceContextLoss();
    },
  };
}

function look(camera: OrthographicCamera, view: Camera, width: number, height: number): void {
  const unit = (2 * view.reach) / Math.min(width, height);
  camera.left = (-unit * width) / 2;
  camera.right = (unit * width) / 2;
  camera.top = (unit * height) / 2;
  camera.bottom = (-unit * height) / 2;
  const far = 10 * view.radius;
  camera.near = 0.01 * view.radius;
  camera.far = 2 * far;
  const [, up, eye] = view.frame;
  const [x, y, z] = view.centre;
  camera.up.set(up[0], up[1], up[2]);
  camera.position.set(x + far * eye[0], y + far * eye[1], z + far * eye[2]);
  camera.lookAt(x, y, z);
  camera.updateProjectionMatrix();
}

function scene(solid: Solid): Drawn {
  const positions = new BufferAttribute(new Float32Array(solid.rest), 3);
  const colours = new BufferAttribute(new Float32Array(solid.rest.length), 3);
  const surface = new BufferGeometry();
  surface.setAttribute("position", positions);
  surface.setAttribute("color", colours);
  surface.setIndex(new BufferAttribute(solid.triangles, 1));
  const material = new MeshLambertMaterial({
    vertexColors: true,
    side: DoubleSide,
    flatShading: true,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
  const mesh = new Mesh(surface, material);
  const edges = new BufferGeometry();
  edges.setAttribute("position", positions);
  edges.setIndex(new BufferAttribute(solid.lines, 1));
  const lines = new LineSegments(edges, new LineBasicMaterial({ transparent: true }));
  // What is deformed may leave the box of what is at rest.
  mesh.frustumCulled = lines.frustumCulled = false;
  const all = new Scene();
  const sun = new DirectionalLight(0xffffff, 1.4);
  sun.position.set(2, -3, 5);
  all.add(mesh, lines, new HemisphereLight(0xffffff, 0xb8bcc8, 1.9), sun);
  return { scene: all, positions, colours, mesh, lines };
}
