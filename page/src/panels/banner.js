/** What has to be said before anything else: the run is not complete. */

import { element } from '../element.js';

export function fillBanner(host, run) {
  const { complete, diagnostics } = run.data;
  if (complete) return;
  const end = run.count ? `It ends at ${run.duration.toFixed(2)} s.` : 'It ended before anything moved.';
  const first = diagnostics[0]?.split('\n')[0];
  const summary = element(
    'summary',
    {},
    element('strong', {}, 'This run is not complete. '),
    `${end} `,
    first ? element('span', { class: 'banner-reason' }, first) : null,
  );
  host.hidden = false;
  host.append(element('details', {}, summary, ...diagnostics.map((text) => element('pre', { class: 'diagnostic' }, text))));
}
