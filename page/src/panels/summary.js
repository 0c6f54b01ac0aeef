/** The summary that irlx prints, and its diagnostics. */

import { element } from '../element.js';

/** Rows [key, value]: lines with the same key as the one before them share it. */
export function summaryRows(text) {
  return text
    .split('\n')
    .filter((line) => line.trim())
    .map((line) => {
      const found = line.match(/^(\S(?:.*?\S)?)\s{2,}(.*)$/);
      return found ? [found[1], found[2]] : ['', line.trim()];
    });
}

export function fillSummary(host, run) {
  const { summary, diagnostics, irlx } = run.data;
  let before = null;
  const rows = summaryRows(summary.text).map(([key, value]) => {
    const shown = key === before ? '' : key;
    before = key;
    return element('div', {}, element('dt', {}, shown), element('dd', {}, value));
  });
  host.append(element('dl', { class: 'summary' }, ...rows));
  if (diagnostics.length)
    host.append(
      element('h3', { class: 'panel-title' }, diagnostics.length === 1 ? 'Diagnostic' : 'Diagnostics'),
      ...diagnostics.map((text) => element('pre', { class: 'diagnostic' }, text)),
    );
  host.append(element('p', { class: 'made-by' }, `Made by irlx ${irlx}. This page works without a network.`));
}
