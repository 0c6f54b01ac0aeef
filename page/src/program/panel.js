/** The program, its line in execution lit; a press on a line seeks to where it begins. */

import { element } from '../element.js';
import { kindOf } from '../event-kinds.js';
import { colouredLines } from './colouring.js';

export class ProgramPanel {
  constructor({ host, run, player, theme }) {
    Object.assign(this, { host, run, player });
    const { program } = run.data;
    this.firstFrames = firstFrames(run);
    this.rows = program.text === null ? this.#blockRows() : this.#textRows(program, theme);
    this.list = element('ol', { class: 'program', style: `--digits: ${String(this.rows.length).length}` }, ...this.rows);
    host.append(this.list);
    player.onChange(() => this.#show(player.frame));
  }

  /** Scroll to the lit line, as when the panel appears. */
  reveal() {
    this.lit?.scrollIntoView({ block: 'nearest' });
  }

  #textRows(program, theme) {
    const marks = this.#marks();
    return colouredLines(program.text.replace(/\n$/, ''), program.keywords).map((pieces, index) => {
      const line = index + 1;
      const code = element('code', {}, ...pieces.map(([kind, text]) => (kind ? element('span', { class: kind }, text) : text)));
      return this.#row(line, String(line), code, this.firstFrames.get(line), marks.get(line));
    });
  }

  #blockRows() {
    return this.run.blocks.map((block) =>
      this.#row(`block ${block.id}`, String(block.id), element('code', {}, block.text), block.frame),
    );
  }

  #row(key, number, code, frame, marks = []) {
    const dots = marks.map((event) =>
      element('i', { class: 'mark', style: `--mark: var(--${kindOf(event).colour})`, title: event.text || event.label }),
    );
    const row = element('li', { 'data-line': key }, element('span', { class: 'number' }, number), code, element('span', { class: 'marks' }, ...dots));
    if (frame === undefined) return row;
    row.classList.add('runs');
    row.tabIndex = 0;
    row.title = `Go to ${this.run.times[frame].toFixed(2)} s`;
    row.addEventListener('click', () => {
      if (String(getSelection()) === '') this.player.seek(frame);
    });
    row.addEventListener('keydown', (event) => {
      if (event.key === 'Enter') this.player.seek(frame);
    });
    return row;
  }

  /** Of each line one event of each kind that happens in it. */
  #marks() {
    const found = new Map();
    for (const event of this.run.events) {
      if (!event.line) continue;
      const marks = found.get(event.line) ?? [];
      if (!marks.some((mark) => mark.kind === event.kind)) marks.push(event);
      found.set(event.line, marks);
    }
    return found;
  }

  #show(frame) {
    const row = this.#rowAt(frame);
    if (row === this.lit) return;
    this.lit?.classList.remove('lit');
    this.lit?.removeAttribute('aria-current');
    this.lit = row;
    if (!row) return;
    row.classList.add('lit');
    row.setAttribute('aria-current', 'step');
    this.#scrollTo(row);
  }

  #rowAt(frame) {
    if (this.run.data.program.text !== null) return this.rows[this.run.data.frames.line[frame] - 1] ?? null;
    return this.rows[this.run.blocks.indexOf(this.run.blockAt(frame))] ?? null;
  }

  /** Scroll only this panel, and only where the line is near or beyond its edge. */
  #scrollTo(row) {
    const { host } = this;
    const top = row.offsetTop - this.list.offsetTop;
    const [seenTop, seenBottom] = [host.scrollTop + 40, host.scrollTop + host.clientHeight - 60];
    if (top < seenTop || top > seenBottom) host.scrollTop = Math.max(0, top - host.clientHeight * 0.4);
  }
}

/** First frame in which each line is in execution. */
function firstFrames(run) {
  const found = new Map();
  run.data.frames.line.forEach((line, frame) => {
    if (line && !found.has(line)) found.set(line, frame);
  });
  return found;
}
