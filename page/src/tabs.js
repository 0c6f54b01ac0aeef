/** Panels that share a place; arrows go from tab to tab, as readers of the screen expect it. */

import { element } from './element.js';

export class Tabs {
  #tabs = new Map();

  constructor(list, place) {
    Object.assign(this, { list, place });
    list.addEventListener('keydown', (event) => this.#key(event));
  }

  /** Add a panel (an element with an id) at the end, or at a position. */
  add(panel, title, position = this.#tabs.size, opened = () => {}) {
    const tab = element(
      'button',
      { type: 'button', role: 'tab', id: `tab-${panel.id}`, 'aria-controls': panel.id, click: () => this.open(panel.id) },
      title,
    );
    panel.setAttribute('role', 'tabpanel');
    panel.setAttribute('aria-labelledby', tab.id);
    this.#tabs.set(panel.id, { tab, panel, opened });
    this.list.insertBefore(tab, this.list.children[position] ?? null);
    this.place.append(panel);
    this.open(this.current ?? panel.id);
  }

  /** Take a panel out; it is shown wherever it goes. */
  remove(id) {
    const found = this.#tabs.get(id);
    if (!found) return null;
    found.tab.remove();
    this.#tabs.delete(id);
    found.panel.hidden = false;
    found.panel.removeAttribute('role');
    found.panel.removeAttribute('aria-labelledby');
    if (this.current === id) this.open(this.#tabs.keys().next().value);
    return found.panel;
  }

  open(id) {
    this.current = id;
    for (const [name, { tab, panel, opened }] of this.#tabs) {
      const isOpen = name === id;
      tab.setAttribute('aria-selected', isOpen);
      tab.tabIndex = isOpen ? 0 : -1;
      panel.hidden = !isOpen;
      if (isOpen) opened();
    }
  }

  #key(event) {
    const tabs = [...this.list.children];
    const at = tabs.indexOf(document.activeElement);
    const to = { ArrowLeft: at - 1, ArrowRight: at + 1, Home: 0, End: tabs.length - 1 }[event.key];
    if (to === undefined || at < 0) return;
    event.preventDefault();
    const tab = tabs[(to + tabs.length) % tabs.length];
    tab.focus();
    tab.click();
  }
}
