/** Light or dark, and the colours that canvases need to know. */

const dark = matchMedia('(prefers-color-scheme: dark)');

export class Theme {
  #listeners = [];
  #colours = new Map();

  constructor() {
    this.root = document.documentElement;
    this.choice = stored();
    this.#apply();
    dark.addEventListener('change', () => this.#apply());
  }

  get isDark() {
    return this.choice ? this.choice === 'dark' : dark.matches;
  }

  /** Call `listener(theme)` after every change. */
  onChange(listener) {
    this.#listeners.push(listener);
  }

  toggle() {
    this.choice = this.isDark ? 'light' : 'dark';
    store(this.choice);
    this.#apply();
  }

  /** Value of a colour of the style sheet, `--name`. */
  colour(name) {
    if (!this.#colours.has(name))
      this.#colours.set(name, getComputedStyle(this.root).getPropertyValue(`--${name}`).trim());
    return this.#colours.get(name);
  }

  #apply() {
    this.#colours.clear();
    this.root.dataset.theme = this.isDark ? 'dark' : 'light';
    for (const listener of this.#listeners) listener(this);
  }
}

// A page of a file or of a notebook may have no storage; the choice then lasts as long as the page.
function stored() {
  try {
    return localStorage.getItem('irlx-theme');
  } catch {
    return null;
  }
}

function store(choice) {
  try {
    localStorage.setItem('irlx-theme', choice);
  } catch {
    /* see above */
  }
}
