/** Slider of the frames, and above it a strip of moves and events. */

import { kindOf, kindsOf } from './event-kinds.js';
import { element } from './element.js';
import { sparse } from './sparse.js';
import { seconds } from './units.js';

const EDGE = 8; // px that the middle of the slider's thumb keeps from its ends
const MOVES = 15; // px of height of the moves, ..
const LANE = 5; // .. and of a kind of events
const SHORT = 6; // px below which moves are not told apart
const NEAR = 4; // px within which the pointer finds an event

export class Timeline {
  constructor({ strip, slider, tip, run, player, theme, hover }) {
    Object.assign(this, { strip, slider, tip, run, player, theme, hover });
    this.kinds = kindsOf(run.events);
    this.height = MOVES + 2 + LANE * this.kinds.length;
    strip.style.height = `${this.height}px`;
    slider.max = String(Math.max(run.count - 1, 0));
    slider.disabled = run.count < 2;
    slider.addEventListener('input', () => player.seek(Number(slider.value)));
    this.#listen();
    theme.onChange(() => this.draw());
    new ResizeObserver(() => this.draw()).observe(strip);
    player.onChange(() => this.#show());
  }

  draw() {
    const { strip, run, theme } = this;
    const [width, scale] = [strip.clientWidth, devicePixelRatio];
    if (!width) return;
    strip.width = Math.round(width * scale);
    strip.height = Math.round(this.height * scale);
    const context = strip.getContext('2d');
    context.scale(scale, scale);
    this.#drawMoves(context, width);
    this.kinds.forEach((kind, lane) => {
      context.fillStyle = theme.colour(kindOf({ kind }).colour);
      for (const event of run.events) {
        if (event.kind !== kind) continue;
        const [from, to] = [this.#x(event.from, width), this.#x(event.to, width)];
        context.beginPath();
        context.roundRect(from - 1, MOVES + 2 + lane * LANE, Math.max(to - from + 2, 3), LANE - 1.5, 1.5);
        context.fill();
      }
    });
  }

  #drawMoves(context, width) {
    const colours = ['strip-a', 'strip-b', 'muted'].map((name) => this.theme.colour(name));
    context.font = '10px system-ui, sans-serif';
    context.textBaseline = 'middle';
    context.textAlign = 'center';
    this.#pieces(width).forEach(({ from, to, blocks }, k) => {
      context.fillStyle = colours[1 - (k % 2)];
      context.beginPath();
      context.roundRect(from + 0.5, 0, Math.max(to - from - 1, 0.5), MOVES, 3);
      context.fill();
      const [{ line, id }] = blocks;
      const label = blocks.length > 1 ? `${blocks.length} moves` : String(line || id);
      if (to - from < context.measureText(label).width + 6) return;
      context.fillStyle = colours[2];
      context.fillText(label, (from + to) / 2, MOVES / 2 + 0.5);
    });
  }

  /** What the strip is divided into, [{from, to, blocks}], px: moves, of which those too short to be told apart are one. */
  #pieces(width) {
    const { blocks, duration } = this.run;
    // Blocks that only switch something take no time.
    const moves = blocks.filter((block, k) => block.from < (blocks[k + 1]?.from ?? duration));
    const [begins, end] = [moves.map((block) => this.#x(block.from, width)), this.#x(duration, width)];
    const pieces = sparse([...begins, end], SHORT)
      .filter((from) => from < end)
      .map((from) => ({ from, blocks: [] }));
    let piece = -1;
    moves.forEach((block, k) => {
      if (begins[k] === pieces[piece + 1]?.from) piece += 1;
      pieces[piece].blocks.push(block);
    });
    pieces.forEach((it, k) => {
      it.to = pieces[k + 1]?.from ?? end;
    });
    return pieces;
  }

  #x(time, width) {
    return EDGE + (this.run.duration ? time / this.run.duration : 0) * (width - 2 * EDGE);
  }

  #timeAt(event) {
    const box = this.strip.getBoundingClientRect();
    const share = (event.clientX - box.left - EDGE) / (box.width - 2 * EDGE);
    return Math.min(1, Math.max(0, share)) * this.run.duration;
  }

  #listen() {
    const { strip } = this;
    strip.addEventListener('pointerdown', (event) => {
      strip.setPointerCapture(event.pointerId);
      this.player.seekTime(this.#timeAt(event));
    });
    strip.addEventListener('pointermove', (event) => {
      if (event.buttons & 1) this.player.seekTime(this.#timeAt(event));
      this.#tell(event);
    });
    strip.addEventListener('pointerleave', () => {
      this.tip.hidden = true;
      this.hover(null);
    });
  }

  #tell(pointer) {
    const time = this.#timeAt(pointer);
    const frame = this.run.nearestFrame(time);
    this.hover(frame);
    const near = (NEAR / this.strip.clientWidth) * this.run.duration;
    const block = this.run.blockAt(frame);
    const events = this.run.events.filter((event) => event.from - near <= time && time <= event.to + near).slice(0, 6);
    this.tip.replaceChildren(
      element('div', { class: 'tip-time' }, `${seconds(time, this.run.data.tick_s)} s`, block?.line ? `  line ${block.line}` : ''),
      ...(block ? [element('code', {}, this.run.wordsOf(block))] : []),
      ...events.map((event) => element('div', { class: 'tip-event', style: `--mark: var(--${kindOf(event).colour})` }, event.label)),
    );
    this.tip.hidden = false;
    const [half, room] = [this.tip.offsetWidth / 2, document.documentElement.clientWidth];
    this.tip.style.left = `${Math.min(room - half - 8, Math.max(half + 8, pointer.clientX))}px`;
    this.tip.style.bottom = `${window.innerHeight - this.strip.getBoundingClientRect().top + 8}px`;
  }

  #show() {
    const { slider, player, run } = this;
    slider.value = String(player.frame);
    slider.style.setProperty('--share', run.count > 1 ? player.frame / (run.count - 1) : 0);
    const line = run.data.frames.line[player.frame];
    slider.setAttribute('aria-valuetext', `${seconds(player.time, run.data.tick_s)} s${line ? `, line ${line}` : ''}`);
  }
}
