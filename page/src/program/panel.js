/** The program, the statement in execution lit; a press on a line seeks to where it begins. */

import { element } from '../element.js';
import { KINDS, kindOf } from '../event-kinds.js';
import { colouredLines } from './colouring.js';
import { lastLines } from './statements.js';

const DOTS = 3; // beside a number: there is no room for more
const WEIGHT = ['stop', ...Object.keys(KINDS)]; // kinds, those first that are told where there are too many

export class ProgramPanel {
  constructor({ host, run, player, theme }) {
    Object.assign(this, { host, run, player });
    const { program } = run.data;
    this.firstFrames = firstFrames(run);
    this.lastLines = new Map();
    this.lit = [];
    this.rows = program.text === null ? this.#blockRows() : this.#textRows(program, theme);
    this.list = element('ol', { class: 'program', style: `--digits: ${String(this.rows.length).length}` }, ...this.rows);
    host.append(this.list);
    player.onChange(() => this.#show(player.frame));
  }

  /** Scroll to the lit line, as when the panel appears. */
  reveal() {
    this.lit[0]?.scrollIntoView({ block: 'nearest' });
  }

  #textRows(program, theme) {
    const marks = this.#marks();
    const lines = colouredLines(program.text.replace(/\n$/, ''), program.keywords);
    this.lastLines = lastLines(lines, [...this.firstFrames.keys()]);
    const begins = this.#begins();
    return lines.map((pieces, index) => {
      const line = index + 1;
      const code = element('code', {}, ...pieces.map(([kind, text]) => (kind ? element('span', { class: kind }, text) : text)));
      const row = this.#row(line, String(line), code, this.firstFrames.get(begins.get(line)), marks.get(line));
      row.classList.toggle('goes-on', begins.has(line) && begins.get(line) !== line);
      return row;
    });
  }

  /** Of each line of a statement that moves the one that it begins on. */
  #begins() {
    const found = new Map();
    for (const begin of [...this.lastLines.keys()].sort((a, b) => a - b))
      for (let line = begin; line <= this.lastLines.get(begin); line += 1) found.set(line, begin);
    return found;
  }

  #blockRows() {
    return this.run.blocks.map((block) =>
      this.#row(`block ${block.id}`, String(block.id), element('code', {}, block.text), block.frame),
    );
  }

  #row(key, number, code, frame, marks = []) {
    const weight = (event) => WEIGHT.indexOf(event.kind);
    const told = [...marks].sort((a, b) => weight(a) - weight(b)).slice(0, DOTS);
    const dots = told.map((event) =>
      element('i', { class: 'mark', style: `--mark: var(--${kindOf(event).colour})`, title: event.text || event.label }),
    );
    const beside = element('span', { class: 'number' }, element('span', { class: 'marks' }, ...dots), number);
    const row = element('li', { 'data-line': key }, beside, code);
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
    const rows = this.#rowsAt(frame);
    if (rows[0] === this.lit[0]) return;
    for (const row of this.lit) row.classList.remove('lit');
    this.lit[0]?.removeAttribute('aria-current');
    this.lit = rows;
    if (!rows.length) return;
    for (const row of rows) row.classList.add('lit');
    rows[0].setAttribute('aria-current', 'step');
    this.#scrollTo(rows[0]);
  }

  /** Rows of the statement in execution. */
  #rowsAt(frame) {
    if (this.run.data.program.text !== null) {
      const line = this.run.data.frames.line[frame];
      return line ? this.rows.slice(line - 1, this.lastLines.get(line)) : [];
    }
    const block = this.run.blocks.indexOf(this.run.blockAt(frame));
    return block < 0 ? [] : [this.rows[block]];
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
