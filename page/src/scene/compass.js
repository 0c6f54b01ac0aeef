/** Directions of the world's axes, in a corner of the scene. */

import { Vector3 } from 'three';

const AXES = { x: new Vector3(1, 0, 0), y: new Vector3(0, 1, 0), z: new Vector3(0, 0, 1) };
const LENGTH = 17;
const SVG = 'http://www.w3.org/2000/svg';

export class Compass {
  constructor(view) {
    this.svg = document.createElementNS(SVG, 'svg');
    this.svg.setAttribute('viewBox', '-28 -28 56 56');
    this.svg.setAttribute('class', 'compass');
    this.svg.setAttribute('aria-hidden', 'true');
    this.parts = Object.keys(AXES).map((name) => this.#part(name));
    view.host.append(this.svg);
    view.afterDrawing((camera) => this.#turn(camera));
  }

  #part(name) {
    const group = document.createElementNS(SVG, 'g');
    group.setAttribute('class', `axis-${name}`);
    const line = document.createElementNS(SVG, 'line');
    const text = document.createElementNS(SVG, 'text');
    text.textContent = name;
    group.append(line, text);
    this.svg.append(group);
    return { group, line, text, axis: AXES[name] };
  }

  #turn(camera) {
    const turn = camera.quaternion.clone().invert();
    const seen = this.parts.map((part) => ({ ...part, at: part.axis.clone().applyQuaternion(turn) }));
    // What points to the camera is drawn last, above the others.
    for (const { group, line, text, at } of seen.sort((a, b) => a.at.z - b.at.z)) {
      this.svg.append(group);
      line.setAttribute('x2', (at.x * LENGTH).toFixed(2));
      line.setAttribute('y2', (-at.y * LENGTH).toFixed(2));
      text.setAttribute('x', (at.x * (LENGTH + 7)).toFixed(2));
      text.setAttribute('y', (-at.y * (LENGTH + 7)).toFixed(2));
    }
  }
}
