/** Which joints the curves show, and in which units. */

import { hasLimits } from './series.js';

const MANY = 4; // joints from which on shares of limits tell more than degrees

export class Choice {
  #listeners = [];

  constructor(run) {
    this.all = run.joints.map((joint) => joint.index);
    this.shown = new Set(this.all);
    this.canPercent = run.count > 0 && run.joints.some((joint) => hasLimits(run, 'position', joint));
    const limited = run.count > 0 && run.joints.every((joint) => hasLimits(run, 'position', joint));
    this.percent = limited && run.joints.length > MANY;
  }

  /** Call `listener(choice)` after every change. */
  onChange(listener) {
    this.#listeners.push(listener);
  }

  get isAll() {
    return this.shown.size === this.all.length;
  }

  showAll() {
    this.shown = new Set(this.all);
    this.#tell();
  }

  /** Of all joints a press picks one; of some it adds or takes one away, and the last one brings all back. */
  press(joint) {
    if (this.isAll && this.all.length > 1) this.shown = new Set([joint]);
    else if (!this.shown.delete(joint)) this.shown.add(joint);
    if (!this.shown.size) this.shown = new Set(this.all);
    this.#tell();
  }

  setPercent(percent) {
    this.percent = percent;
    this.#tell();
  }

  #tell() {
    for (const listener of this.#listeners) listener(this);
  }
}
