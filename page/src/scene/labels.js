/** Names at places of the scene, as text above the canvas. */

import { Vector3 } from 'three';
import { element } from '../element.js';

export class Labels {
  #labels = [];

  constructor(view) {
    this.view = view;
    this.host = element('div', { class: 'scene-labels', 'aria-hidden': 'true' });
    view.host.append(this.host);
    view.afterDrawing((camera) => this.#place(camera));
  }

  /** Name the point that `where()` returns, a Vector3. */
  add(text, kind, where) {
    const label = element('span', { class: `scene-label ${kind}` }, text);
    this.host.append(label);
    this.#labels.push({ label, where, size: { width: label.offsetWidth, height: label.offsetHeight } });
  }

  #place(camera) {
    const { width, height } = this.view;
    const taken = [];
    for (const { label, where, size } of this.#labels) {
      const seen = new Vector3().copy(where()).project(camera);
      const [x, y] = [((seen.x + 1) / 2) * width, ((1 - seen.y) / 2) * height];
      const box = { left: x - size.width / 2, right: x + size.width / 2, top: y - size.height, bottom: y };
      // Of names that would lie over each other the first one is shown.
      const free = !taken.some((other) => overlap(box, other));
      const shown = free && seen.z < 1 && x > 0 && x < width && y > 0 && y < height;
      if (shown) taken.push(box);
      label.style.visibility = shown ? 'visible' : 'hidden';
      label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -100%)`;
    }
  }
}

function overlap(a, b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}
