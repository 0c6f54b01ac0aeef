/** Where the replay is: a frame, and while it plays a share of the way to the next one. */

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10];

export class Player {
  #listeners = [];
  #request = 0;
  #last = 0;

  constructor(run) {
    this.run = run;
    this.frame = 0;
    this.share = 0;
    this.time = 0;
    this.speed = 1;
    this.loop = false;
    this.playing = false;
  }

  /** Call `listener(player)` after every change, and once now. */
  onChange(listener) {
    this.#listeners.push(listener);
    listener(this);
  }

  /** Show a frame, exactly. */
  seek(frame) {
    const last = Math.max(this.run.count - 1, 0);
    this.frame = Math.min(last, Math.max(0, Math.round(Number(frame)) || 0));
    this.share = 0;
    this.time = this.run.times[this.frame] ?? 0;
    this.#tell();
  }

  seekTime(time) {
    this.seek(this.run.nearestFrame(time));
  }

  /** So many frames on; stops playing. */
  step(frames) {
    this.pause();
    this.seek(this.frame + frames);
  }

  /** To the beginning of the move before (-1) or of the next one (1). */
  toMove(direction) {
    const starts = [0, ...this.run.blocks.map((block) => block.frame), this.run.count - 1];
    // Half a second into a move, "previous" means its own beginning.
    const here = direction < 0 && this.playing ? this.run.frameAt(Math.max(0, this.time - 0.5)) : this.frame;
    const found =
      direction > 0 ? starts.find((start) => start > here) : starts.filter((start) => start < here).pop();
    if (found !== undefined) this.seek(found);
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    if (this.playing || this.run.count < 2) return;
    if (this.frame >= this.run.count - 1) this.seek(0);
    this.playing = true;
    this.#last = 0;
    this.#request = requestAnimationFrame((now) => this.#go(now));
    this.#tell();
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    cancelAnimationFrame(this.#request);
    this.seek(this.frame);
  }

  setSpeed(speed) {
    this.speed = speed;
    this.#tell();
  }

  /** The next slower (-1) or faster (1) speed. */
  changeSpeed(direction) {
    const at = SPEEDS.indexOf(this.speed) + direction;
    if (at >= 0 && at < SPEEDS.length) this.setSpeed(SPEEDS[at]);
  }

  setLoop(loop) {
    this.loop = loop;
    this.#tell();
  }

  #go(now) {
    // A page that was hidden goes on where it was, not where it would be by now.
    const passed = this.#last ? Math.min((now - this.#last) / 1000, 0.25) : 0;
    this.#last = now;
    let time = this.time + passed * this.speed;
    const { duration, times } = this.run;
    if (time >= duration && this.loop) time %= duration;
    if (time >= duration) {
      this.frame = this.run.count - 1;
      this.pause();
      return;
    }
    this.time = time;
    this.frame = this.run.frameAt(time);
    const next = Math.min(this.frame + 1, this.run.count - 1);
    const step = times[next] - times[this.frame];
    this.share = step > 0 ? Math.max(0, (time - times[this.frame]) / step) : 0;
    this.#tell();
    this.#request = requestAnimationFrame((later) => this.#go(later));
  }

  #tell() {
    for (const listener of this.#listeners) listener(this);
  }
}
