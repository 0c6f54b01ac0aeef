/** Values of the joints in the frame shown, each in its range, tinted where a limit holds it. */

import { element } from '../element.js';
import { fixed } from '../units.js';

export class JointsPanel {
  constructor({ host, run, player, theme, choice, colours }) {
    Object.assign(this, { run, colours });
    this.rows = run.joints.map((joint) => this.#row(joint, choice));
    host.append(element('ul', { class: `joints${run.joints.length > 12 ? ' dense' : ''}` }, ...this.rows.map((row) => row.root)));
    theme.onChange(() => this.#paint());
    this.#paint();
    player.onChange(() => this.#show(player.frame));
  }

  onJoint(listener) {
    this.joint = listener;
  }

  #row(joint, choice) {
    const marker = element('i', { class: 'joint-marker' });
    const bar = element('span', { class: 'joint-bar' }, marker);
    const value = element('span', { class: 'joint-value' });
    const root = element(
      'li',
      {},
      element(
        'button',
        {
          type: 'button',
          class: 'joint',
          click: () => choice.press(joint.index),
          pointerenter: () => this.joint?.(joint.index),
          pointerleave: () => this.joint?.(null),
        },
        element('span', { class: 'joint-swatch' }),
        element('span', { class: 'joint-name' }, joint.name),
        bar,
        value,
        element('span', { class: 'joint-unit' }, joint.shown),
      ),
    );
    return { joint, root, bar, marker, value };
  }

  #paint() {
    for (const { joint, root } of this.rows) root.style.setProperty('--joint', this.colours(joint.index));
  }

  #show(frame) {
    if (!this.run.count) return;
    const limits = this.run.limits(frame).position;
    const held = new Map();
    for (const event of this.run.eventsAt(frame)) if (event.kind === 'limit') held.set(event.joint, event);
    for (const row of this.rows) {
      const { index, factor, unit } = row.joint;
      const value = this.run.data.frames.q[index][frame];
      const [lower, upper] = limits.map((side) => side[index]);
      row.value.textContent = fixed(value * factor, unit === 'm' ? 1 : 2);
      row.bar.classList.toggle('open', lower === null || upper === null);
      const share = lower === null || upper === null || upper <= lower ? 0.5 : (value - lower) / (upper - lower);
      row.marker.style.left = `${(100 * Math.min(1, Math.max(0, share))).toFixed(2)}%`;
      const event = held.get(index);
      row.root.classList.toggle('held', event !== undefined);
      row.root.title = event ? event.label : this.#range(row.joint, lower, upper);
    }
  }

  #range(joint, lower, upper) {
    const side = (value) => (value === null ? 'no limit' : `${fixed(value * joint.factor, 1)} ${joint.shown}`);
    return `${joint.name}: ${side(lower)} to ${side(upper)}`;
  }
}
