/** Which of many places are marked, so that marks do not become a grey area. */

/**
 * Of rising places those that are marked: where some follow each other by less than `least`, the first of them, and the
 * last where that is not as near.
 */
export function sparse(places, least) {
  const found = [];
  for (let k = 0; k < places.length; ) {
    let end = k;
    while (end + 1 < places.length && places[end + 1] - places[end] < least) end += 1;
    found.push(places[k]);
    if (places[end] - places[k] >= least) found.push(places[end]);
    k = end + 1;
  }
  return found;
}
