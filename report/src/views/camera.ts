// A parallel projection that is turned by hand.

/** Where one looks from: azimuth and elevation in radians, and how near. */
export class Camera {
  azimuth = -1.05;
  elevation = 0.32;
  zoom = 1;
  /** Room about the body, over its size. */
  room = 1;

  constructor(
    readonly centre: [number, number, number],
    readonly radius: number,
  ) {}

  /** Unit vectors to the right, upwards and towards the eye. */
  get frame(): [number[], number[], number[]] {
    const [ca, sa] = [Math.cos(this.azimuth), Math.sin(this.azimuth)];
    const [ce, se] = [Math.cos(this.elevation), Math.sin(this.elevation)];
    return [
      [-sa, ca, 0],
      [-se * ca, -se * sa, ce],
      [ce * ca, ce * sa, se],
    ];
  }

  /** Units of length that half of the lesser side of a panel shows. */
  get reach(): number {
    return (this.room * this.radius) / this.zoom;
  }

  /** Returns what projects points onto a panel of a size in pixels: x, y, depth. */
  projection(width: number, height: number): (x: number, y: number, z: number) => [number, number, number] {
    const [right, up, eye] = this.frame;
    const scale = Math.min(width, height) / (2 * this.reach);
    const [cx, cy, cz] = this.centre;
    return (x, y, z) => {
      const p = [x - cx, y - cy, z - cz];
      const dot = (v: number[]): number => v[0] * p[0] + v[1] * p[1] + v[2] * p[2];
      return [width / 2 + scale * dot(right), height / 2 - scale * dot(up), dot(eye)];
    };
  }

  turn(azimuth: number, elevation: number): void {
    this.azimuth += azimuth;
    this.elevation = Math.max(-1.57, Math.min(1.57, this.elevation + elevation));
  }
}
