/** Ground: a grid that fades out, and the shadow on it. */

import {
  BufferGeometry,
  Color,
  Float32BufferAttribute,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  PlaneGeometry,
  ShadowMaterial,
} from 'three';

const PIECES = 40; // of a line, so that it can fade

export class Ground {
  /** Below what lies within `radius` m of `centre`, at the height z. */
  constructor(centre, radius, z) {
    this.group = new Group();
    this.step = 10 ** Math.floor(Math.log10(radius * 0.8));
    if (radius / this.step < 3) this.step /= 2;
    const middle = [centre.x, centre.y].map((value) => Math.round(value / this.step) * this.step);
    this.geometry = gridGeometry(this.step, radius * 2.1);
    this.lines = new LineSegments(this.geometry, new LineBasicMaterial({ vertexColors: true, transparent: true }));
    this.lines.material.depthWrite = false;
    this.shadow = new Mesh(new PlaneGeometry(radius * 8, radius * 8), new ShadowMaterial({ depthWrite: false }));
    this.shadow.receiveShadow = true;
    this.shadow.renderOrder = -1;
    this.group.add(this.shadow, this.lines);
    this.group.position.set(...middle, z - radius * 0.0015);
  }

  paint(theme) {
    this.lines.material.color = new Color(theme.colour('grid'));
    this.shadow.material.opacity = theme.isDark ? 0.45 : 0.16;
  }
}

function gridGeometry(step, reach) {
  const count = Math.ceil(reach / step);
  const [positions, colours] = [[], []];
  const strength = (x, y) => Math.max(0, 1 - Math.hypot(x, y) / reach) ** 1.3;
  const add = (x, y) => {
    positions.push(x, y, 0);
    colours.push(1, 1, 1, 0.75 * strength(x, y));
  };
  for (let k = -count; k <= count; k += 1) {
    for (let piece = 0; piece < PIECES; piece += 1) {
      const [from, to] = [piece, piece + 1].map((p) => reach * ((2 * p) / PIECES - 1));
      add(k * step, from);
      add(k * step, to);
      add(from, k * step);
      add(to, k * step);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(positions, 3));
  geometry.setAttribute('color', new Float32BufferAttribute(colours, 4));
  return geometry;
}
