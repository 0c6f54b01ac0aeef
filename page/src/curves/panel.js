/** The curves of a run, one below the other, with the choice of joints above them. */

import { element } from '../element.js';
import { Plot } from './plot.js';
import { specsOf } from './specs.js';
import { TimeWindow } from './time-window.js';

const LEAST = 88; // px of height of a plot
const MOST = 190;

export class CurvesPanel {
  constructor({ host, run, player, theme, choice, colours, hover, single }) {
    Object.assign(this, { host, run, theme, choice, colours, single });
    const specs = specsOf(run, choice, colours, theme);
    const right = specs.some((spec) => spec.second) ? 46 : 12;
    const seek = (time) => player.seekTime(time);
    const shown = new TimeWindow(run);
    this.plots = specs.map((spec) => new Plot(run, spec, theme, { right, seek, hover, shown }));
    shown.onChange(() => this.plots.forEach((plot) => plot.window()));
    this.list = element('div', { class: 'plots' }, ...this.plots.map((plot) => plot.root));
    this.host.append(this.#toolbar(), this.list);
    if (single) this.#showOne(0);
    choice.onChange(() => this.#renew());
    theme.onChange(() => this.#paint());
    player.onChange(() => {
      if (player.playing) shown.follow(player.time);
      this.plots.forEach((plot) => plot.now(player.frame, player.time));
    });
    new ResizeObserver(() => this.#resize()).observe(this.list);
  }

  /** Whatever listens for the joint under the pointer. */
  onJoint(listener) {
    this.joint = listener;
  }

  #toolbar() {
    const bar = element('div', { class: 'curve-tools' });
    if (this.single) bar.append(this.#picker());
    else bar.append(this.#chips());
    if (this.choice.canPercent) bar.append(this.#units());
    return bar;
  }

  #chips() {
    const group = element('div', { class: 'chips', role: 'group', 'aria-label': 'Joints shown in the curves' });
    const all = element('button', { type: 'button', class: 'chip all', click: () => this.choice.showAll() }, 'all');
    this.chips = this.run.joints.map((joint) =>
      element(
        'button',
        {
          type: 'button',
          class: 'chip',
          title: `${joint.name}: show it alone, or with others`,
          'aria-label': joint.name,
          click: () => this.choice.press(joint.index),
          pointerenter: () => this.joint?.(joint.index),
          pointerleave: () => this.joint?.(null),
        },
        joint.short,
      ),
    );
    this.all = all;
    group.append(all, ...this.chips);
    this.#paintChips();
    return group;
  }

  #units() {
    const shown = [...new Set(this.run.joints.map((joint) => joint.shown))].join(' · ');
    const make = (percent, text, title) =>
      element('button', { type: 'button', title, 'data-percent': String(percent), click: () => this.choice.setPercent(percent) }, text);
    this.units = element(
      'div',
      { class: 'segmented', role: 'group', 'aria-label': 'Units of the joints' },
      make(false, shown, 'Joint values in their units'),
      make(true, '%', 'Joint values in percent of their limits'),
    );
    this.#paintUnits();
    return this.units;
  }

  #picker() {
    const options = this.plots?.map((plot, k) => element('option', { value: k }, plot.spec.title)) ?? [];
    return element(
      'select',
      { 'aria-label': 'Curve', change: (event) => this.#showOne(Number(event.target.value)) },
      ...options,
    );
  }

  #showOne(number) {
    this.plots.forEach((plot, k) => {
      plot.root.hidden = k !== number;
    });
    this.#resize();
  }

  #renew() {
    this.plots.forEach((plot) => plot.renew());
    if (this.chips) this.#paintChips();
    if (this.units) this.#paintUnits();
  }

  #paint() {
    this.plots.forEach((plot) => plot.paint());
    if (this.chips) this.#paintChips();
  }

  #paintChips() {
    this.all.setAttribute('aria-pressed', this.choice.isAll);
    this.chips.forEach((chip, joint) => {
      chip.style.setProperty('--joint', this.colours(joint));
      chip.setAttribute('aria-pressed', this.choice.shown.has(joint));
    });
  }

  #paintUnits() {
    for (const button of this.units.children)
      button.setAttribute('aria-pressed', String(this.choice.percent) === button.dataset.percent);
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.list;
    const shown = this.plots.filter((plot) => !plot.root.hidden);
    const heads = shown.reduce((sum, plot) => sum + plot.head, 0);
    const share = Math.floor((height - heads) / shown.length);
    const each = this.single ? Math.max(60, share) : Math.min(MOST, Math.max(LEAST, share));
    shown.forEach((plot) => plot.size(width, each));
  }
}
