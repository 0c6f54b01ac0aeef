/** The stretch of time that the curves show: all of the run, or less of it. */

const CLOSEST = 8; // frames that are left when the curves are zoomed as far as they go

export class TimeWindow {
  #listeners = [];

  constructor(run) {
    this.least = run.count > 1 ? (CLOSEST * run.duration) / (run.count - 1) : 1;
    this.whole = run.duration || 1;
    this.from = 0;
    this.to = this.whole;
  }

  /** Call `listener()` after every change. */
  onChange(listener) {
    this.#listeners.push(listener);
  }

  get isWhole() {
    return this.from <= 0 && this.to >= this.whole;
  }

  /** Show `factor` times as much, the time `at` staying where it is. */
  zoom(at, factor) {
    const length = Math.min(this.whole, Math.max(this.least, (this.to - this.from) * factor));
    const share = (at - this.from) / (this.to - this.from);
    this.#set(at - share * length, length);
  }

  /** Show what lies `seconds` later. */
  shift(seconds) {
    this.#set(this.from + seconds, this.to - this.from);
  }

  /** Show all of it. */
  reset() {
    this.#set(0, this.whole);
  }

  /** Shift so far that a time can be seen. */
  follow(time) {
    if (this.from <= time && time <= this.to) return;
    this.#set(time - 0.1 * (this.to - this.from), this.to - this.from);
  }

  #set(from, length) {
    const begin = Math.min(Math.max(0, from), Math.max(0, this.whole - length));
    if (begin === this.from && begin + length === this.to) return;
    this.from = begin;
    this.to = begin + length;
    for (const listener of this.#listeners) listener();
  }
}
