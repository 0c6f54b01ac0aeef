/** List of the run's events; a press on one seeks to it. */

import { element } from '../element.js';
import { KINDS, kindOf, kindsOf } from '../event-kinds.js';
import { seconds } from '../units.js';

const MOST = 1500; // rows: a list beyond that is for nobody

export class EventsPanel {
  constructor({ host, run, player }) {
    Object.assign(this, { run, player });
    this.hidden = new Set();
    if (!run.events.length) {
      host.append(element('p', { class: 'empty' }, 'Nothing happened: no limit held a joint back, and nothing slowed the tool.'));
      return;
    }
    this.rows = run.events.slice(0, MOST).map((event) => this.#row(event));
    const left = run.events.length - this.rows.length;
    host.append(this.#kinds(), element('ol', { class: 'events' }, ...this.rows));
    if (left > 0) host.append(element('p', { class: 'empty' }, `${left} more are on the timeline.`));
    player.onChange(() => this.#show(player.frame));
  }

  #kinds() {
    const buttons = kindsOf(this.run.events).map((kind) => {
      const count = this.run.events.filter((event) => event.kind === kind).length;
      return element(
        'button',
        {
          type: 'button',
          class: 'chip',
          style: `--joint: var(--${KINDS[kind].colour})`,
          'aria-pressed': 'true',
          click: (event) => this.#toggle(kind, event.currentTarget),
        },
        `${KINDS[kind].name} ${count}`,
      );
    });
    return element('div', { class: 'chips', role: 'group', 'aria-label': 'Kinds of events' }, ...buttons);
  }

  #row(event) {
    const span = event.first === event.last ? `${this.#time(event.from)} s` : `${this.#time(event.from)}–${this.#time(event.to)} s`;
    const more = event.text && event.text !== event.label ? element('span', { class: 'event-text' }, event.text) : null;
    return element(
      'li',
      { 'data-kind': event.kind, style: `--mark: var(--${kindOf(event).colour})` },
      element(
        'button',
        { type: 'button', click: () => this.player.seek(event.frame) },
        element('span', { class: 'event-time' }, span),
        element('span', { class: 'event-label' }, event.label, event.line ? element('span', { class: 'event-line' }, `line ${event.line}`) : null),
        more,
      ),
    );
  }

  #time(value) {
    return seconds(value, this.run.data.tick_s);
  }

  #toggle(kind, button) {
    if (!this.hidden.delete(kind)) this.hidden.add(kind);
    button.setAttribute('aria-pressed', !this.hidden.has(kind));
    for (const row of this.rows) row.hidden = this.hidden.has(row.dataset.kind);
  }

  #show(frame) {
    this.rows.forEach((row, k) => {
      const event = this.run.events[k];
      row.classList.toggle('now', event.frame <= frame && frame <= event.lastFrame);
    });
  }
}
