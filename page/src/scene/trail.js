/** The way of the tool: what has passed strong, what is to come faint, its own colour where it was slowed. */

import { Color, Group, Mesh, MeshBasicMaterial, SphereGeometry } from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';

const FINEST = 4000; // segments: more of them cannot be told apart on a screen

export class Trail {
  /** `size` of the scene, m. */
  constructor(run, size) {
    this.run = run;
    this.group = new Group();
    this.frames = keptFrames(run, size / 3000);
    const [x, y, z] = run.data.frames.tool;
    this.points = this.frames.flatMap((frame) => [x[frame], y[frame], z[frame]]);
    const slowed = run.events.filter((event) => event.kind === 'slowed');
    this.slow = this.frames.map((frame) => slowed.some((event) => event.frame <= frame && frame <= event.lastFrame));
    this.coming = this.#line(1.6, 0.4);
    this.passed = this.#line(3.6, 1);
    this.ghost = new Mesh(new SphereGeometry(size / 110, 20, 12), new MeshBasicMaterial({ transparent: true, opacity: 0.65 }));
    this.ghost.visible = false;
    this.group.add(this.coming, this.passed, this.ghost);
  }

  /** Show as passed what lies before a frame. */
  show(frame) {
    let kept = 0;
    for (let [low, high] = [0, this.frames.length - 1]; low <= high; ) {
      const middle = (low + high) >> 1;
      if (this.frames[middle] <= frame) [kept, low] = [middle, middle + 1];
      else high = middle - 1;
    }
    this.passed.geometry.instanceCount = kept;
    this.passed.visible = kept > 0;
  }

  /** Mark the tool's place in another frame, null for none. */
  mark(frame) {
    this.ghost.visible = frame !== null;
    if (frame !== null) this.ghost.position.set(...[0, 1, 2].map((axis) => this.run.data.frames.tool[axis][frame]));
  }

  paint(theme) {
    const [usual, slow] = [new Color(theme.colour('trail')), new Color(theme.colour('slowed'))];
    const colours = this.slow.flatMap((isSlow) => (isSlow ? slow : usual).toArray());
    for (const line of [this.coming, this.passed]) if (this.points.length >= 6) line.geometry.setColors(colours);
    this.ghost.material.color = usual;
  }

  #line(width, opacity) {
    const geometry = new LineGeometry();
    if (this.points.length >= 6) geometry.setPositions(this.points);
    const material = new LineMaterial({ linewidth: width, vertexColors: true, transparent: opacity < 1, opacity });
    const line = new Line2(geometry, material);
    line.visible = this.points.length >= 6;
    line.frustumCulled = false;
    return line;
  }
}

/** Frames whose tool positions draw the way to within about `step` m: where it has gone that far, and the last. */
function keptFrames(run, step) {
  const [x, y, z] = run.data.frames.tool;
  const kept = [];
  const coarser = Math.max(1, run.count / (8 * FINEST));
  let last = null;
  for (let frame = 0; frame < run.count; frame += 1) {
    const way = last === null ? Infinity : Math.hypot(x[frame] - x[last], y[frame] - y[last], z[frame] - z[last]);
    if (way < step * coarser && frame < run.count - 1) continue;
    kept.push(frame);
    last = frame;
  }
  return kept;
}
