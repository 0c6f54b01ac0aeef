/** The summary that irlx prints, and its diagnostics. */

import { element } from '../element.js';

const LABEL = 12; // letters of a label with what follows it

/** Rows [label, words] of the lines of a summary; what has no label goes on from the line before. */
export function summaryRows(text) {
  return text
    .split('\n')
    .filter((line) => line.trim())
    .map((line) => {
      const label = line.slice(0, LABEL);
      return label.endsWith(' ') && !label.includes(':') ? [label.trim(), line.slice(LABEL)] : ['', line];
    });
}

export function fillSummary(host, run) {
  const { summary, diagnostics, irlx } = run.data;
  const [verdict, ...rows] = summaryRows(summary.text);
  host.append(
    element('p', { class: 'verdict' }, verdict?.[1] ?? ''),
    element(
      'dl',
      { class: 'summary' },
      ...rows.map(([label, words]) => element('div', {}, element('dt', {}, label), element('dd', {}, words))),
    ),
  );
  if (diagnostics.length)
    host.append(
      element('h3', { class: 'panel-title' }, diagnostics.length === 1 ? 'Diagnostic' : 'Diagnostics'),
      ...diagnostics.map((text) => element('pre', { class: 'diagnostic' }, text)),
    );
  host.append(element('p', { class: 'made-by' }, `Made by irlx ${irlx}. This page works without a network.`));
}
