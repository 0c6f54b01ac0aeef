/** Which panel is where: beside and over the scene on a large screen, as tabs on a small one. */

import { byId } from './element.js';
import { Tabs } from './tabs.js';

const WIDE = '(min-width: 900px) and (min-height: 560px)';

export class Layout {
  /** `fitted({width, height})` is told how much of the scene's corner the joints cover, px; `small` is the page of a notebook. */
  constructor({ small, program, events, fitted }) {
    Object.assign(this, { small, fitted });
    this.joints = byId('joints');
    this.curves = byId('curves');
    document.body.classList.toggle('small', small);
    this.tabs = new Tabs(byId('tabs'), byId('tab-panels'));
    this.tabs.add(byId('program'), 'Program', 0, () => program.reveal());
    this.tabs.add(byId('events'), events ? `Events ${events}` : 'Events');
    this.tabs.add(byId('summary'), 'Summary');
    this.tabs.open('program');
    this.showJoints = !small;
    const wide = matchMedia(WIDE);
    wide.addEventListener('change', () => this.#arrange(wide.matches || small));
    this.#arrange(wide.matches || small);
    this.#connectSplitter(byId('splitter'));
  }

  /** Show or hide the values of the joints. */
  toggleJoints() {
    if (!this.isWide) {
      this.tabs.open('joints');
      return;
    }
    this.showJoints = !this.showJoints;
    this.#placeJoints();
  }

  #arrange(isWide) {
    this.isWide = isWide;
    document.body.classList.toggle('wide', isWide);
    document.body.classList.toggle('narrow', !isWide);
    if (isWide) {
      this.tabs.remove('joints');
      this.tabs.remove('curves');
      byId('scene').append(this.joints);
      byId('side').append(this.curves);
    } else {
      this.tabs.add(this.curves, 'Curves', 1);
      this.tabs.add(this.joints, 'Joints', 2);
    }
    this.#placeJoints();
  }

  #placeJoints() {
    const over = this.isWide && this.showJoints;
    if (this.isWide) this.joints.hidden = !over;
    byId('show-joints').setAttribute('aria-pressed', over);
    byId('show-joints').hidden = !this.isWide;
    const size = (length) => (over ? length + 12 : 0);
    this.fitted({ width: size(this.joints.offsetWidth), height: size(this.joints.offsetHeight) });
  }

  #connectSplitter(splitter) {
    const set = (width) => {
      const most = Math.max(320, window.innerWidth * 0.7);
      document.body.style.setProperty('--side', `${Math.min(most, Math.max(300, width))}px`);
    };
    splitter.addEventListener('pointerdown', (event) => {
      splitter.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    splitter.addEventListener('pointermove', (event) => {
      if (event.buttons & 1) set(window.innerWidth - event.clientX);
    });
    splitter.addEventListener('dblclick', () => document.body.style.removeProperty('--side'));
    splitter.addEventListener('keydown', (event) => {
      const step = { ArrowLeft: 24, ArrowRight: -24 }[event.key];
      if (!step) return;
      event.stopPropagation();
      set(byId('side').offsetWidth + step);
    });
  }
}
